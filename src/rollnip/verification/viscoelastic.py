"""The standard linear solid in rolling: half-space, thin strip, two rollers with friction."""

from __future__ import annotations

from functools import partial
from math import pi

from rollnip.closed_forms import ViscoelasticStrip, carter, hunter, viscoelastic_strip_of_width
from rollnip.materials import StandardLinearSolid
from rollnip.nip import LineLoad, Nip, Traction
from rollnip.rollers import Roller
from rollnip.solution import Solution
from rollnip.verification._nips import (
    bed,
    creepage,
    half_space,
    half_width,
    leading_edge,
    peak_pressure,
    solved,
    trailing_edge,
)
from rollnip.verification.case import AllowedError, Experiment, VerificationCase
from rollnip.verification.sources import HUNTER, MAY_MORRIS_ATACK, WANG_KNOTHE

_RADIUS, _MODULUS = 10.0, 4.0  # E*; the relaxed Hertz half-width a0 is 1 under _LOAD
_LOAD = pi * _MODULUS / (4.0 * _RADIUS)
_PEAK = 2.0 * _LOAD / pi
_TIME = 0.01
_STRIP_RADIUS = 1e4  # presses the strip in by 1 % of its thickness


def viscoelastic() -> tuple[VerificationCase, ...]:
    """Hunter at three Deborah numbers, the strip, Wang & Knothe at two creep times."""
    rows = (
        (0.1, 0.99911, 0.95099, 1.0021, 0.04626),
        (1.0, 0.94834, 0.65846, 1.2476, 0.19684),
        (10.0, 0.77915, 0.64086, 1.4087, 0.07539),
    )
    rolling = [case for row in rows for case in _hunter(*row)]
    return (*rolling, *_hunter_form(), *_strip(), *_thin_layer(), *_relaxed(), *_glassy())


def _hunter(
    deborah: float, leading: float, trailing: float, peak: float, resistance: float
) -> tuple[VerificationCase, ...]:
    figure = Experiment(f"Hunter, De = {deborah:g}", HUNTER, partial(_solve_hunter, deborah)).figure
    return (
        figure("leading edge/a0", "", leading, leading_edge),
        figure("trailing edge/a0", "", trailing, lambda s: -trailing_edge(s)),
        figure("peak pressure/p0", "", peak, lambda s: peak_pressure(s) / _PEAK),
        figure(
            "rolling resistance R/a0",
            "",
            resistance,
            lambda s: float(s.rolling_resistance * _RADIUS),
        ),
    )


def _solve_hunter(deborah: float) -> Solution:
    relaxed = 0.75 * _MODULUS  # E_r = E* (1 - nu^2), nu = 0.5
    rubber = StandardLinearSolid(
        modulus=relaxed, stiffening=relaxed, relaxation_time=_TIME, poisson=0.5
    )
    return solved(
        Nip(
            upper=Roller(radius=_RADIUS),
            lower=half_space(float("inf"), rubber),
            normal=LineLoad(_LOAD),
            friction=0.0,
            speed=0.5 * deborah / _TIME,  # De = V tau E_g/E_r over a0
        )
    )


def _hunter_form() -> tuple[VerificationCase, ...]:
    """The closed form the package offers, against the printed figures."""
    contact = partial(
        hunter,
        load=_LOAD,
        radius=_RADIUS,
        contact_modulus=_MODULUS,
        stiffening_ratio=1.0,
        relaxation_time=_TIME,
        speed=0.5 / _TIME,
    )
    figure = Experiment("Closed form of Hunter, De = 1", HUNTER, contact).figure
    printed = AllowedError(1e-4, "five digits printed, four of the peak")
    return (
        figure("leading edge/a0", "", 0.94834, lambda c: float(c.leading), printed),
        figure("peak pressure/p0", "", 1.2476, lambda c: float(c.peak_pressure / _PEAK), printed),
    )


def _strip_form() -> ViscoelasticStrip:
    return viscoelastic_strip_of_width(
        leading=2.0,
        radius=_STRIP_RADIUS,
        foundation=100.0,
        stiffening_ratio=1.0,
        relaxation_time=0.02,
        speed=100.0,
    )


def _strip() -> tuple[VerificationCase, ...]:
    figure = Experiment(
        "Viscoelastic strip, V tau = a, f = 1", MAY_MORRIS_ATACK, _strip_form
    ).figure
    printed = AllowedError(5e-6, "six digits printed: half a unit of the last one")
    return (
        figure("trailing/leading edge", "", 0.833125, lambda c: float(c.trailing / 2.0), printed),
        figure(
            "F R h/(E_r a^3)",
            "",
            0.959420,
            lambda c: float(c.load * _STRIP_RADIUS / 800.0),
            printed,
        ),
        figure("centroid/a", "", 0.108875, lambda c: float(c.centroid / 2.0), printed),
    )


def _thin_layer() -> tuple[VerificationCase, ...]:
    figure = Experiment(
        "Thin viscoelastic layer, nu 0, a/h = 100", MAY_MORRIS_ATACK, _solve_thin_layer
    ).figure
    exact = _strip_form()
    theory = AllowedError(6e-3, "the strip has no shear: 0.2 to 0.3 % of a at a/h = 100, and 0.3 %")
    return (
        figure("leading edge", "mm", 2.0, leading_edge, theory),
        figure("trailing edge", "mm", -exact.trailing, trailing_edge, theory),
        figure("peak pressure", "MPa", exact.peak_pressure, peak_pressure),
        figure(
            "rolling resistance",
            "",
            exact.rolling_resistance,
            lambda s: float(s.rolling_resistance),
        ),
    )


def _solve_thin_layer() -> Solution:
    rubber = StandardLinearSolid(modulus=2.0, stiffening=2.0, relaxation_time=0.02, poisson=0.0)
    return solved(
        Nip(
            upper=Roller(radius=_STRIP_RADIUS),
            lower=bed(0.02, rubber),
            normal=LineLoad(_strip_form().load),
            friction=0.0,
            speed=100.0,
        )
    )


def _relaxed() -> tuple[VerificationCase, ...]:
    figure = Experiment(
        "Wang & Knothe, creep time 0", WANG_KNOTHE, partial(_solve_knothe, 1e-6)
    ).figure
    exact = carter(
        load=600.0,
        radius=50.0,
        contact_modulus=0.5 * 1600.2 / 0.84,
        friction=0.3,
        traction=-108.0,
    )
    return (
        figure("half-width", "mm", 6.333, half_width),
        figure("peak pressure", "MPa", 60.32, peak_pressure),
        figure("creepage (Carter, relaxed)", "", exact.creepage, creepage),
    )


def _glassy() -> tuple[VerificationCase, ...]:
    figure = Experiment(
        "Wang & Knothe, creep time 2 s", WANG_KNOTHE, partial(_solve_knothe, 1.0)
    ).figure
    return (figure("peak pressure", "MPa", 85.31, peak_pressure),)


def _solve_knothe(relaxation_time: float) -> Solution:
    relaxed = 1143.0 * 1.4  # E_r = E_g/2, E_g = 2 G_g (1 + nu), nu = 0.4
    rubber = StandardLinearSolid(
        modulus=relaxed, stiffening=relaxed, relaxation_time=relaxation_time, poisson=0.4
    )
    roller = half_space(100.0, rubber)
    return solved(
        Nip(
            upper=roller,
            lower=roller,
            normal=LineLoad(600.0),
            tangential=Traction(-108.0),
            friction=0.3,
            speed=1000.0,
        )
    )
