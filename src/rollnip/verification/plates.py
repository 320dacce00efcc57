"""A stiff thin top layer: the paper's figure 4, and a plate on a bed of springs."""

from __future__ import annotations

from math import inf

import numpy as np

from rollnip.closed_forms import plate_on_foundation, plate_stiffness
from rollnip.materials import Elastic
from rollnip.nip import LineLoad, Nip
from rollnip.rollers import Layer, Roller
from rollnip.solution import Solution
from rollnip.verification._nips import approach, half_width, solved
from rollnip.verification.case import AllowedError, Experiment, VerificationCase
from rollnip.verification.sources import FIGURE_FOUR, PLATE_ON_SPRINGS

# A hundredth of the load on a hundred times the radius: the same width, small strain.
_LOAD, _RADIUS = 0.05, 5000.0
_TOP = Layer(0.1, Elastic(modulus=5500.0, poisson=0.3))


def plates() -> tuple[VerificationCase, ...]:
    """Figure 4 of the paper and the plate's closed form."""
    return (*_figure_four(), *_on_springs())


def _figure_four() -> tuple[VerificationCase, ...]:
    figure = Experiment("Figure 4, stiff top layer", FIGURE_FOUR, _solve_figure_four).figure
    inside = AllowedError(
        0.03, "just inside: within the thickness of the top layer, 0.1 mm of 3.44"
    )
    whole = AllowedError(0.0, "a count")
    return (
        figure("approach", "mm", 0.38266, approach),
        figure("half-width", "mm", 3.44, half_width),
        figure("pressure at x = 0", "MPa", 0.8038, _central_pressure),
        figure("pressure peaks beyond 0.9 a", "", 2.0, _outer_peaks, whole),
        figure("place of the highest peak |x|/a", "", 1.0, _peak_place, inside),
    )


def _solve_figure_four() -> Solution:
    soft = Layer(4.0, Elastic(modulus=2.0, poisson=0.5))
    return solved(
        Nip(
            upper=Roller(radius=50.0, layers=(_TOP, soft)),
            lower=Roller(radius=25.0),
            normal=LineLoad(5.0),
            friction=0.0,
        )
    )


def _central_pressure(solution: Solution) -> float:
    return float(np.interp(0.0, solution.nodes, solution.pressure))


def _peak_place(solution: Solution) -> float:
    return abs(solution.peak_pressure_x) / half_width(solution)


def _outer_peaks(solution: Solution) -> float:
    p = solution.pressure
    peaks = 1 + np.flatnonzero((p[1:-1] > p[:-2]) & (p[1:-1] >= p[2:]))
    outer = np.abs(solution.nodes[peaks]) > 0.9 * half_width(solution)
    return float(np.count_nonzero(outer & (p[peaks] > 2.0 * _central_pressure(solution))))


def _on_springs() -> tuple[VerificationCase, ...]:
    """A soft layer of nu 0, 1 mm on a rigid base: springs of E/h; bending length 2.5 mm."""
    figure = Experiment("Plate on a soft thin layer", PLATE_ON_SPRINGS, _solve_on_springs).figure
    exact = plate_on_foundation(
        load=_LOAD,
        radius=_RADIUS,
        stiffness=plate_stiffness(modulus=5500.0, poisson=0.3, thickness=0.1),
        foundation=0.05,
    )
    theory = AllowedError(6e-3, "thin-plate theory, (h/bending length)^2 = 0.2 %, and 0.3 %")
    spread = AllowedError(2e-2, "the edge force is spread over some thicknesses of 0.1 mm")
    return (
        figure("approach", "mm", exact.approach, approach, theory),
        figure("half-width", "mm", exact.half_width, half_width, theory),
        figure("pressure at x = 0", "MPa", exact.peak_pressure, _central_pressure, theory),
        figure("force at each edge", "N/mm", exact.edge_force, _edge_force, spread),
    )


def _solve_on_springs() -> Solution:
    soft = Layer(1.0, Elastic(modulus=0.05, poisson=0.0))
    return solved(
        Nip(
            upper=Roller(radius=_RADIUS),
            lower=Roller(radius=inf, layers=(_TOP, soft)),
            normal=LineLoad(_LOAD),
            friction=0.0,
        )
    )


def _edge_force(solution: Solution) -> float:
    """Half of the load that the springs do not carry: F less int k (delta - x^2/(2 R)) dx."""
    a, delta = half_width(solution), approach(solution)
    carried = 0.05 * (2.0 * a * delta - a**3 / (3.0 * _RADIUS))
    return 0.5 * (float(solution.load) - carried)
