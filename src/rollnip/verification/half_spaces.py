"""Elastic half-spaces: Hertz, McEwen, Carter, Bentall & Johnson."""

from __future__ import annotations

from functools import partial

from rollnip.closed_forms import (
    carter,
    contact_modulus,
    effective_radius,
    free_rolling_full_stick,
    free_rolling_vanishing_friction,
    hertz_line,
)
from rollnip.materials import Elastic
from rollnip.nip import Creepage, LineLoad, Nip, Traction
from rollnip.solution import Solution
from rollnip.verification._nips import (
    creepage,
    half_space,
    half_width,
    peak_pressure,
    solved,
    stick_length,
)
from rollnip.verification.case import AllowedError, Experiment, VerificationCase
from rollnip.verification.sources import BENTALL_JOHNSON, CARTER, HERTZ

_STEEL = Elastic(modulus=210e3, poisson=0.3)
_FRICTION = 0.3
_LOAD = 500.0


def half_spaces() -> tuple[VerificationCase, ...]:
    """Hertz, Carter at four tractions and at a creepage, Bentall & Johnson's two limits."""
    rolling = [case for share in (0.1, 0.36, 0.64, 0.9) for case in carter_cases(share)]
    return (*_hertz(), *rolling, *_carter_backwards(), *_slipping(), *_sticking())


def _hertz() -> tuple[VerificationCase, ...]:
    figure = Experiment("Hertz, steel on bronze", HERTZ, _solve_hertz).figure
    exact = hertz_line(
        load=_LOAD,
        radius=effective_radius(50.0, 25.0),
        contact_modulus=contact_modulus(210e3, 0.3, 110e3, 0.34),
    )
    return (
        figure("half-width", "mm", exact.half_width, half_width),
        figure("peak pressure", "MPa", exact.peak_pressure, peak_pressure),
        figure(
            "mean over peak pressure",
            "",
            0.7853981634,
            lambda s: float(s.mean_pressure / s.peak_pressure),
        ),
    )


def _solve_hertz() -> Solution:
    return solved(
        Nip(
            upper=half_space(50.0, _STEEL),
            lower=half_space(25.0, Elastic(modulus=110e3, poisson=0.34)),
            normal=LineLoad(_LOAD),
            friction=0.0,
        )
    )


def carter_cases(share: float) -> tuple[VerificationCase, ...]:
    """Carter at a traction of ``share`` mu F."""
    figure = Experiment(
        f"Carter, traction {share:g} mu F",
        CARTER,
        partial(_solve_carter, Traction(share * _FRICTION * _LOAD)),
    ).figure
    exact = carter(
        load=_LOAD,
        radius=25.0,
        contact_modulus=contact_modulus(210e3, 0.3, 210e3, 0.3),
        friction=_FRICTION,
        traction=share * _FRICTION * _LOAD,
    )
    return (
        figure("creepage", "", exact.creepage, creepage),
        figure("stick length", "mm", 2.0 * exact.stick_half_width, stick_length),
    )


def _carter_backwards() -> tuple[VerificationCase, ...]:
    exact = carter(
        load=_LOAD,
        radius=25.0,
        contact_modulus=contact_modulus(210e3, 0.3, 210e3, 0.3),
        friction=_FRICTION,
        traction=-0.5 * _FRICTION * _LOAD,
    )
    figure = Experiment(
        "Carter, creepage of -0.5 mu F prescribed",
        CARTER,
        partial(_solve_carter, Creepage(exact.creepage)),
    ).figure
    slides = Experiment(
        "Carter, twice the creepage of sliding prescribed",
        CARTER,
        partial(_solve_carter, Creepage(2.0 * _FRICTION * exact.hertz.half_width / 25.0)),
    ).figure
    return (
        figure("traction", "N/mm", exact.traction, lambda s: float(s.traction)),
        figure("stick length", "mm", 2.0 * exact.stick_half_width, stick_length),
        slides("traction", "N/mm", _FRICTION * _LOAD, lambda s: float(s.traction)),
    )


def _solve_carter(tangential: Traction | Creepage) -> Solution:
    roller = half_space(50.0, _STEEL)
    return solved(
        Nip(
            upper=roller,
            lower=roller,
            normal=LineLoad(_LOAD),
            tangential=tangential,
            friction=_FRICTION,
        )
    )


_PAIR = {
    "load": 16.2019,
    "radius": 25.0,
    "shear_modulus_upper": 23000.0,
    "poisson_upper": 0.31,
    "shear_modulus_lower": 82000.0,
    "poisson_lower": 0.28,
}


def _slipping() -> tuple[VerificationCase, ...]:
    figure = Experiment(
        "Bentall & Johnson, friction 1e-4", BENTALL_JOHNSON, partial(_solve_dissimilar, 1e-4)
    ).figure
    exact = free_rolling_vanishing_friction(**_PAIR)
    finite = AllowedError(1e-2, "friction is small, not zero: it moves the places by 1 % of c")
    return (
        figure("creepage, as printed", "", 5.26e-4, creepage),
        figure("creepage, closed form", "", exact.creepage, creepage),
        figure("half-width", "mm", exact.hertz.half_width, half_width),
        figure("|x| where slip reverses, mean", "mm", exact.reversal, _reversal, finite),
    )


def _reversal(solution: Solution) -> float:
    """Half of the distance between the two places where slip reverses: the middles of stick."""
    middles = [0.5 * (z.start + z.stop) for z in solution.zones if z.state == "stick"]
    if len(middles) != 2:
        raise LookupError(f"2 reversals of slip expected, got {len(middles)}")
    return 0.5 * (middles[1] - middles[0])


def _sticking() -> tuple[VerificationCase, ...]:
    figure = Experiment(
        "Bentall & Johnson, friction 10 (full stick)",
        BENTALL_JOHNSON,
        partial(_solve_dissimilar, 10.0),
    ).figure
    exact = free_rolling_full_stick(**_PAIR)
    return (
        figure("creepage", "", exact.creepage, creepage),
        figure("half-width", "mm", exact.half_width, half_width),
        figure("peak pressure", "MPa", exact.peak_pressure, peak_pressure),
        figure("stick length", "mm", 2.0 * exact.half_width, stick_length),
    )


def _solve_dissimilar(friction: float) -> Solution:
    return solved(
        Nip(
            upper=half_space(50.0, Elastic.from_shear_modulus(23000.0, 0.31)),
            lower=half_space(50.0, Elastic.from_shear_modulus(82000.0, 0.28)),
            normal=LineLoad(16.2019),
            friction=friction,
        )
    )
