"""The paper's configuration II: two coated rollers, free and driven."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from rollnip.materials import Elastic
from rollnip.nip import LineLoad, Nip, Traction
from rollnip.solution import Solution
from rollnip.verification._nips import (
    approach,
    coated,
    creepage,
    leading_edge,
    peak_pressure,
    slip_length,
    solved,
    trailing_edge,
)
from rollnip.verification.case import AllowedError, Experiment, VerificationCase
from rollnip.verification.sources import CONFIGURATION_TWO

_PRINTED = AllowedError(1e-2, "three digits printed, and a small difference of large strains")
_BALANCE = AllowedError(3e-3, "three digits printed (0.1 %), and the solver's 0.1 %")


def configuration_two() -> tuple[VerificationCase, ...]:
    """Free rolling, the lower roller driving, the upper roller driving."""
    return (*_free(), *_lower_drives(), *_upper_drives())


def nip_two(traction: float, *, scale: float = 1.0, swapped: bool = False) -> Nip:
    """Configuration II with lengths and moduli times ``scale``, rollers swapped on request."""
    glass = coated(50.0 * scale, 2.0 * scale, Elastic(modulus=0.91 * scale, poisson=0.5))
    black = coated(25.0 * scale, 2.7 * scale, Elastic(modulus=2.04 * scale, poisson=0.5))
    return Nip(
        upper=black if swapped else glass,
        lower=glass if swapped else black,
        normal=LineLoad(1.78 * scale**2),
        tangential=Traction(traction * scale**2),
        friction=2.8,
        speed=100.0,
    )


def solve_two(traction: float) -> Solution:
    """Solve configuration II under a traction [N/mm]."""
    return solved(nip_two(traction))


def _free() -> tuple[VerificationCase, ...]:
    figure = Experiment(
        "Configuration II, rolling freely", CONFIGURATION_TWO, partial(solve_two, 0.0)
    ).figure
    return (
        figure("approach", "mm", 0.29396, approach),
        figure("creepage", "", -0.0161, creepage, _PRINTED),
        figure("trailing edge", "mm", -3.696, trailing_edge),
        figure("leading edge", "mm", 3.696, leading_edge),
        figure("peak pressure", "MPa", 0.3434, peak_pressure),
    )


def _lower_drives() -> tuple[VerificationCase, ...]:
    figure = Experiment(
        "Configuration II, traction -0.53 (lower drives)",
        CONFIGURATION_TWO,
        partial(solve_two, -0.53),
    ).figure
    return (
        figure("approach", "mm", 0.30594, approach),
        figure("creepage", "", -0.0960, creepage),
        figure("trailing edge", "mm", -3.883, trailing_edge),
        figure("leading edge", "mm", 3.679, leading_edge),
        figure("peak pressure", "MPa", 0.3352, peak_pressure),
        figure("length of the slip zone", "mm", 0.456, slip_length),
    )


def _upper_drives() -> tuple[VerificationCase, ...]:
    figure = Experiment(
        "Configuration II, traction +0.53 (upper drives)",
        CONFIGURATION_TWO,
        partial(solve_two, 0.53),
    ).figure
    return (
        figure("torque on the upper axle", "N", 27.80, _of("torque_upper")),
        figure("torque on the lower axle", "N", -13.62, _of("torque_lower")),
        figure("power in", "N/s", 4.78, _of("power_in"), _BALANCE),
        figure("friction dissipation", "N/s", 4.78, _of("dissipation_friction"), _BALANCE),
    )


def _of(name: str) -> Callable[[Solution], float]:
    return lambda solution: float(getattr(solution, name))
