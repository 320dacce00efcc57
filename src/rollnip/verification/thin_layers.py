"""Layers much thinner than the nip, elastic: compressible, of nu = 0.5, with friction."""

from __future__ import annotations

from functools import partial

from rollnip.closed_forms import (
    simplified_rolling,
    thin_compressible_layer,
    thin_incompressible_layer,
    winkler_contact,
)
from rollnip.materials import Elastic
from rollnip.model import Model
from rollnip.nip import LineLoad, Nip, Traction
from rollnip.rollers import Roller
from rollnip.solution import Solution
from rollnip.verification._nips import (
    approach,
    bed,
    coated,
    creepage,
    half_width,
    longest_zone,
    peak_pressure,
    solved,
)
from rollnip.verification.case import SOLVER, AllowedError, Experiment, VerificationCase
from rollnip.verification.sources import KALKER_SIMPLIFIED, THIN_LAYER

# So large a radius presses the thinnest layer in by 2 % of its thickness.
_RADIUS, _WIDTH, _MODULUS, _FRICTION = 1e4, 2.0, 2.0, 0.3
_FINE = Model(geometry="linear", tolerance=1e-4)


def thin_layers() -> tuple[VerificationCase, ...]:
    """Johnson's two thin layers and Kalker's simplified theory."""
    rolling = [case for share in (0.3, 0.7) for case in _simplified(share)]
    return (*_compressible(0.0), *_compressible(0.3), *_incompressible(), *rolling)


def _foundation(poisson: float, thickness: float) -> float:
    confined = (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson))
    return _MODULUS * confined / thickness


def _compressible(poisson: float) -> tuple[VerificationCase, ...]:
    thickness = 0.01 * _WIDTH
    load = 2.0 * _foundation(poisson, thickness) * _WIDTH**3 / (3.0 * _RADIUS)
    figure = Experiment(
        f"Thin compressible layer, nu {poisson:g}, a/h = 100",
        THIN_LAYER,
        partial(_solve, load, poisson, thickness),
    ).figure
    exact = thin_compressible_layer(
        load=load, radius=_RADIUS, modulus=_MODULUS, poisson=poisson, thickness=thickness
    )
    theory = AllowedError(
        5e-3, "leading term: a is too large by 0.1 to 0.2 h, and the solver's 0.3 %"
    )
    return (
        figure("half-width", "mm", exact.half_width, half_width, theory),
        figure("peak pressure", "MPa", exact.peak_pressure, peak_pressure),
        figure("approach", "mm", exact.approach, approach),
    )


def _incompressible() -> tuple[VerificationCase, ...]:
    thickness = _WIDTH / 40.0
    load = 2.0 * _MODULUS * _WIDTH**5 / (45.0 * _RADIUS * thickness**3)
    figure = Experiment(
        "Thin layer of nu 0.5, a/h = 40", THIN_LAYER, partial(_solve, load, 0.5, thickness)
    ).figure
    exact = thin_incompressible_layer(
        load=load, radius=_RADIUS, modulus=_MODULUS, thickness=thickness
    )
    theory = AllowedError(6e-3, "leading term: 0.2 to 0.3 % at a/h = 40, and the solver's 0.3 %")
    edge = AllowedError(
        SOLVER.value,
        "the leading term less 1.46 h, the next term, read from the collocation of "
        "tests/verification/test_bonded_layers.py; the solver's 0.3 %",
    )
    shortened = exact.half_width - 1.46 * thickness
    return (
        figure("half-width (a - 1.46 h)", "mm", shortened, half_width, edge),
        figure("peak pressure", "MPa", exact.peak_pressure, peak_pressure, theory),
        figure("approach", "mm", exact.approach, approach, theory),
    )


def _solve(load: float, poisson: float, thickness: float) -> Solution:
    return solved(
        Nip(
            upper=Roller(radius=_RADIUS),
            lower=bed(thickness, Elastic(modulus=_MODULUS, poisson=poisson)),
            normal=LineLoad(load),
            friction=0.0,
        )
    )


def _simplified(share: float) -> tuple[VerificationCase, ...]:
    """Return the figures of two alike rollers, whose springs act in series."""
    poisson, thickness = 0.3, _WIDTH / 200.0
    foundation = 0.5 * _foundation(poisson, thickness)
    load = 2.0 * foundation * _WIDTH**3 / (3.0 * _RADIUS)
    traction = share * _FRICTION * load
    figure = Experiment(
        f"Simplified theory, traction {share:g} mu F, a/h = 200",
        KALKER_SIMPLIFIED,
        partial(_solve_rolling, load, traction, poisson, thickness),
    ).figure
    exact = simplified_rolling(
        load=load,
        radius=_RADIUS,
        foundation=foundation,
        flexibility=4.0 * thickness * (1.0 + poisson) / _MODULUS,
        friction=_FRICTION,
        traction=traction,
    )
    bed_of_springs = winkler_contact(load=load, radius=_RADIUS, foundation=foundation)
    theory = AllowedError(
        6e-3, "leading term in h/a: 1.2 % at a/h = 50, 0.6 at 100, 0.3 to 0.4 at 200"
    )
    return (
        figure("creepage", "", exact.creepage, creepage, theory),
        figure(
            "trailing end of stick",
            "mm",
            exact.stick_from,
            lambda s: longest_zone(s, "stick").start,
            AllowedError(theory.value, f"of a; {theory.reason}"),
            scale=_WIDTH,
        ),
        figure("peak pressure", "MPa", bed_of_springs.peak_pressure, peak_pressure),
    )


def _solve_rolling(load: float, traction: float, poisson: float, thickness: float) -> Solution:
    roller = coated(2.0 * _RADIUS, thickness, Elastic(modulus=_MODULUS, poisson=poisson))
    nip = Nip(
        upper=roller,
        lower=roller,
        normal=LineLoad(load),
        tangential=Traction(traction),
        friction=_FRICTION,
    )
    return solved(nip, _FINE)  # so that the theory's own error is what is seen
