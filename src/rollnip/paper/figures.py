"""Figures 4 to 8 of the paper as numbers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rollnip.interior import InteriorField
from rollnip.lda import (
    Comparison,
    Instrument,
    Seeding,
    compare,
    estimate_profile,
    simulate_scan,
)
from rollnip.model import Geometry, Model
from rollnip.nip import Nip
from rollnip.paper.cases import (
    FIGURE_4_THICKNESSES,
    Number,
    configuration,
    figure_4,
    figure_5_elastic,
    figure_5_viscoelastic,
)
from rollnip.paper.measures import stress_centre
from rollnip.solution import Solution
from rollnip.solver import solve

Array = NDArray[np.float64]
GEOMETRIES: tuple[Geometry, ...] = ("linear", "corrected", "curved")
_SEEDING = Seeding(bursts=40, snr=30.0, spread=0.01)
_DEPTHS, _PLACES = 81, 301


@dataclass(frozen=True, slots=True)
class PressureFigure:
    """Figure 4: thicknesses of the top layer [mm] and their solutions."""

    thicknesses: tuple[float, ...]
    solutions: tuple[Solution, ...]


@dataclass(frozen=True, slots=True)
class ContourFigure:
    """Figure 5: two nips and the field inside the coating of their upper roller.

    Attributes
    ----------
    solutions : elastic and driven, viscoelastic and free.
    fields : inside the coating of each.
    centres : of the normal stress at the depths of each field [mm].
    """

    solutions: tuple[Solution, Solution]
    fields: tuple[InteriorField, InteriorField]
    centres: tuple[Array, Array]


@dataclass(frozen=True, slots=True)
class StrainPanel:
    """Half of a figure 6 to 8.

    Attributes
    ----------
    solutions : of "linear", "corrected" and "curved".
    points : simulated bursts of the "curved" one, aligned with it.
    """

    solutions: dict[Geometry, Solution]
    points: Comparison


@dataclass(frozen=True, slots=True)
class StrainFigure:
    """Figures 6 to 8: strain of the glass roller's surface, free (A) and driven (B)."""

    number: Number
    free: StrainPanel
    driven: StrainPanel


def pressure_figure(model: Model | None = None) -> PressureFigure:
    """Figure 4: pressure for the four thicknesses of the top layer; "curved" by default.

    Raises ConvergenceError where a solution could not be verified.
    """
    solutions = tuple(_solved(figure_4(d), model) for d in FIGURE_4_THICKNESSES)
    return PressureFigure(FIGURE_4_THICKNESSES, solutions)


def contour_figure(model: Model | None = None) -> ContourFigure:
    """Figure 5: stress in the coating, elastic and driven (A), viscoelastic and free (B).

    "curved" by default.
    """
    elastic, viscous = (_solved(n, model) for n in (figure_5_elastic(), figure_5_viscoelastic()))
    fields = _field(elastic), _field(viscous)
    centres = _centre(elastic, fields[0]), _centre(viscous, fields[1])
    return ContourFigure((elastic, viscous), fields, centres)


def _centre(solution: Solution, field: InteriorField) -> Array:
    """Return where the centre of s_zz lies at the depths of a field [mm]."""
    first, last = solution.contact[0][0], solution.contact[-1][1]
    return 0.5 * (first + last) + 0.5 * (last - first) * stress_centre(solution, field.z)


def strain_figure(number: Number, *, seed: int = 1993, positions: int = 41) -> StrainFigure:
    """Figures 6, 7, 8 for configurations 1, 2, 3, with simulated points.

    The points are bursts synthesised from the "curved" solution, not a measurement: the paper's
    own are not available. ``seed`` fixes them.
    """
    return StrainFigure(
        number,
        _panel(configuration(number, driven=False), seed, positions),
        _panel(configuration(number, driven=True), seed + 1, positions),
    )


def _panel(nip: Nip, seed: int, positions: int) -> StrainPanel:
    solutions = {geometry: _solved(nip, Model(geometry=geometry)) for geometry in GEOMETRIES}
    curved, instrument = solutions["curved"], Instrument()
    scan = simulate_scan(curved, instrument, _SEEDING, positions=positions, seed=seed)
    measured = estimate_profile(scan.x, scan.velocity)
    points = compare(
        measured, curved, width=instrument.averaging_width, blur=instrument.largest_blur
    )
    return StrainPanel(solutions, points)


def _solved(nip: Nip, model: Model | None) -> Solution:
    return solve(nip, model or Model(geometry="curved"), on_failure="raise")


def _field(solution: Solution) -> InteriorField:
    depth = solution.nip.upper.coating_thickness
    reach = 0.9 * solution.nip_width
    return solution.interior(
        "upper", np.linspace(0.0, depth, _DEPTHS), np.linspace(-reach, reach, _PLACES)
    )
