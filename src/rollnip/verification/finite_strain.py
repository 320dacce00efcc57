"""Finite elements at finite strain, against `finite` (the default), `second` and `curved`."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import numpy as np

from rollnip.materials import Elastic
from rollnip.model import Geometry, Model
from rollnip.nip import LineLoad, Nip, Traction
from rollnip.rollers import Roller
from rollnip.solution import Solution
from rollnip.verification._nips import (
    approach,
    coated,
    creepage,
    half_width,
    peak_pressure,
    solved,
)
from rollnip.verification.case import AllowedError, Experiment, VerificationCase
from rollnip.verification.sources import FINITE_ELEMENTS


class Coating(NamedTuple):
    """Coated upper roller on a bare lower one: radii, layer, load."""

    radius: float
    thickness: float
    modulus: float
    lower_radius: float
    load: float


class Reference(NamedTuple):
    """Results of finite elements; creepage and stretch in stick are None without friction."""

    name: str
    coating: Coating
    friction: float
    traction: float
    approach: float
    edges: tuple[float, float]
    peak_pressure: float
    creepage: float | None = None
    stretch: float | None = None


_ONE = Coating(50.0, 2.0, 0.91, 25.0, 0.74)
_BLACK = Coating(25.0, 2.7, 2.04, 50.0, 1.78)
REFERENCES = (
    Reference("I frictionless", _ONE, 0.0, 0.0, 0.142735, (-2.40864, 2.40864), 0.210587),
    Reference(
        "I free", _ONE, 2.7, 0.0, 0.135818, (-2.35364, 2.35364), 0.216789, -0.0413343, 1.0422065
    ),
    Reference(
        "I, T -0.05",
        _ONE,
        2.7,
        -0.05,
        0.139170,
        (-2.42830, 2.32615),
        0.214825,
        -0.0499022,
        1.0511792,
    ),
    Reference(
        "I, T +0.05",
        _ONE,
        2.7,
        0.05,
        0.132539,
        (-2.25954, 2.38173),
        0.218688,
        -0.0326010,
        1.0331413,
    ),
    Reference("IIb frictionless", _BLACK, 0.0, 0.0, 0.201469, (-2.73172, 2.73172), 0.437542),
    Reference(
        "IIb free", _BLACK, 2.8, 0.0, 0.195090, (-2.69176, 2.69176), 0.446361, -0.0428791, 1.0438186
    ),
)


class Tolerances(NamedTuple):
    """Tolerances of one geometry; the creepage counts against that of free rolling."""

    approach: AllowedError
    half_width: AllowedError
    peak_pressure: AllowedError
    creepage: AllowedError


_THIRD = "the finite elements' own error, and terms of third order, which the model leaves out"
_ALL = "the finite elements' own error, and that of the elements of the model"
_SECOND = "the model keeps only some terms of second order, at strains of 5 to 10 %"
TOLERANCES: dict[Geometry, Tolerances] = {
    "finite": Tolerances(*(AllowedError(t, _ALL) for t in (1e-3, 2e-3, 1e-3, 5e-3))),
    "second": Tolerances(*(AllowedError(t, _THIRD) for t in (4e-3, 6e-3, 3e-3, 1.5e-2))),
    "curved": Tolerances(*(AllowedError(t, _SECOND) for t in (2e-2, 2.5e-2, 3e-2, 4e-2))),
}


def finite_strain() -> tuple[VerificationCase, ...]:
    """Return every finite-element figure, for each geometry."""
    return tuple(
        case
        for geometry in TOLERANCES
        for reference in REFERENCES
        for case in _figures(reference, geometry)
    )


def _figures(reference: Reference, geometry: Geometry) -> tuple[VerificationCase, ...]:
    figure = Experiment(
        f"Finite strain, {reference.name}, {geometry}",
        FINITE_ELEMENTS,
        partial(_solve, reference, geometry),
    ).figure
    allowed = TOLERANCES[geometry]
    trailing, leading = reference.edges
    half = 0.5 * (leading - trailing)
    cases = [
        figure("approach", "mm", reference.approach, approach, allowed.approach),
        figure("half-width", "mm", half, half_width, allowed.half_width),
        figure(
            "peak pressure", "MPa", reference.peak_pressure, peak_pressure, allowed.peak_pressure
        ),
    ]
    if reference.creepage is not None and reference.stretch is not None:
        free = 0.0413343 if reference.coating is _ONE else 0.0428791
        of_free = AllowedError(
            allowed.creepage.value, f"of the creepage in free rolling; {allowed.creepage.reason}"
        )
        strain = reference.stretch - 1.0
        cases += [
            figure("creepage", "", reference.creepage, creepage, of_free, scale=free),
            figure("strain in stick", "", strain, _stick_strain, of_free, scale=free),
        ]
    return tuple(cases)


def _stick_strain(solution: Solution) -> float:
    profiles = solution.profiles
    return float(np.interp(0.0, profiles.x, profiles.strain_upper))


def _solve(reference: Reference, geometry: Geometry) -> Solution:
    coating = reference.coating
    rubber = Elastic(modulus=coating.modulus, poisson=0.5)
    nip = Nip(
        upper=coated(coating.radius, coating.thickness, rubber),
        lower=Roller(radius=coating.lower_radius),
        normal=LineLoad(coating.load),
        tangential=Traction(reference.traction),
        friction=reference.friction,
    )
    return solved(nip, Model(geometry=geometry))
