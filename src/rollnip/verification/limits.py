"""Limits in which one problem becomes another: plies, one material throughout, speed."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import NDArray

from rollnip.closed_forms import hertz_line
from rollnip.compliance import SurfaceCompliance, flat_compliance, ring_compliance
from rollnip.materials import Elastic, Material, StandardLinearSolid
from rollnip.nip import LineLoad, Nip, Traction
from rollnip.rollers import Layer, Roller
from rollnip.solution import Solution
from rollnip.verification._nips import (
    approach,
    creepage,
    half_width,
    leading_edge,
    peak_pressure,
    solved,
    trailing_edge,
)
from rollnip.verification.case import ROUNDING, AllowedError, Experiment, VerificationCase
from rollnip.verification.sources import CORRESPONDENCE, ONE_MATERIAL, PLIES

_RUBBER = Elastic(modulus=0.91, poisson=0.5)

Pair = tuple[Solution, Solution]
Compliances = tuple[SurfaceCompliance, SurfaceCompliance]


def limits() -> tuple[VerificationCase, ...]:
    """Plies, half-space of one material, slow and fast rolling."""
    slow = _speed("V -> 0", 1e-6, 2.0)
    fast = _speed("V -> infinity", 1e9, 5.0)
    return (*_plies(), *_one_material(), *slow, *fast)


def _wave_numbers() -> NDArray[np.float64]:
    return np.logspace(-3.0, 3.0, 61)


def _plies() -> tuple[VerificationCase, ...]:
    experiments = (
        Experiment("Layer in three plies, flat", PLIES, _flat_plies),
        Experiment("Layer in three plies, ring", PLIES, _ring_plies),
    )
    claimed = AllowedError(1.0, "within the error the solution claims")
    figure = Experiment("Configuration I in plies", PLIES, _solved_plies).figure
    return (
        *(
            e.figure("largest change of C over |C|", "", 0.0, _change, ROUNDING, scale=1.0)
            for e in experiments
        ),
        figure("creepage, change/claimed error", "", 0.0, _claim(creepage), claimed, scale=1.0),
        figure("approach, change/claimed error", "", 0.0, _claim(approach), claimed, scale=1.0),
    )


def _flat_plies() -> Compliances:
    k = _wave_numbers()
    whole = flat_compliance(k, [2.0], [0.91], [0.5])
    return whole, flat_compliance(k, [0.3, 0.7, 1.0], [0.91] * 3, [0.5] * 3)


def _ring_plies() -> Compliances:
    k = _wave_numbers()
    whole = ring_compliance(k, 25.0, [2.0], [0.91], [0.5])
    return whole, ring_compliance(k, 25.0, [0.3, 0.7, 1.0], [0.91] * 3, [0.5] * 3)


def _change(pair: Compliances) -> float:
    whole, cut = pair
    size = np.abs(whole.xx) + np.abs(whole.zz)
    differences = [np.abs(a - b) / size for a, b in zip(whole, cut, strict=True)]
    return float(np.max(differences))


def _solved_plies() -> Pair:
    return _solve_one((2.0,)), _solve_one((0.3, 0.7, 1.0))


def _solve_one(thicknesses: tuple[float, ...]) -> Solution:
    layers = tuple(Layer(thickness, _RUBBER) for thickness in thicknesses)
    return solved(
        Nip(
            upper=Roller(radius=50.0, layers=layers),
            lower=Roller(radius=25.0),
            normal=LineLoad(0.74),
            tangential=Traction(0.05),
            friction=2.7,
        )
    )


def _claim(read: Callable[[Solution], float]) -> Callable[[Pair], float]:
    name = read.__name__
    return lambda pair: abs(read(pair[1]) - read(pair[0])) / float(pair[0].error[name])


def _one_material() -> tuple[VerificationCase, ...]:
    compliance = Experiment(
        "Layers on a half-space of the same", ONE_MATERIAL, _same_compliance
    ).figure
    figure = Experiment("Hertz on layers of the core's material", ONE_MATERIAL, _solve_same).figure
    exact = hertz_line(load=5.0, radius=25.0, contact_modulus=2.0 / 0.84)
    return (
        compliance("largest change of C over |C|", "", 0.0, _change, ROUNDING, scale=1.0),
        figure("half-width", "mm", exact.half_width, half_width),
        figure("peak pressure", "MPa", exact.peak_pressure, peak_pressure),
    )


def _same_compliance() -> Compliances:
    k = _wave_numbers()
    bare = flat_compliance(k, [], [], [], 2.0, 0.4)
    return bare, flat_compliance(k, [0.5, 3.0], [2.0, 2.0], [0.4, 0.4], 2.0, 0.4)


def _solve_same() -> Solution:
    same = Elastic(modulus=2.0, poisson=0.4)
    return solved(
        Nip(
            upper=Roller(radius=25.0),
            lower=Roller(
                radius=float("inf"), layers=(Layer(0.5, same), Layer(3.0, same)), core=same
            ),
            normal=LineLoad(5.0),
            friction=0.0,
        )
    )


def _speed(name: str, speed: float, modulus: float) -> tuple[VerificationCase, ...]:
    figure = Experiment(
        f"Viscoelastic covering, {name}", CORRESPONDENCE, partial(_at_speed, speed, modulus)
    ).figure
    return (
        figure("approach over elastic", "", 1.0, _ratio(approach)),
        figure("creepage over elastic", "", 1.0, _ratio(creepage)),
        figure("leading edge over elastic", "", 1.0, _ratio(leading_edge)),
        figure("trailing edge over elastic", "", 1.0, _ratio(trailing_edge)),
        figure("peak pressure over elastic", "", 1.0, _ratio(peak_pressure)),
        figure(
            "rolling resistance R/a",
            "",
            0.0,
            lambda pair: float(pair[1].rolling_resistance * 50.0 / 3.0 / half_width(pair[0])),
            AllowedError(1e-4, "vanishes as V tau/a or its inverse, 1e-6 to 1e-5 here; of R/a"),
            scale=1.0,
        ),
    )


def _at_speed(speed: float, modulus: float) -> Pair:
    rubber = StandardLinearSolid(modulus=2.0, stiffening=3.0, relaxation_time=0.007, poisson=0.5)
    elastic = Elastic(modulus=modulus, poisson=0.5)
    return _covered(elastic, None), _covered(rubber, speed)


def _covered(material: Material, speed: float | None) -> Solution:
    return solved(
        Nip(
            upper=Roller(radius=50.0, layers=(Layer(4.0, material),)),
            lower=Roller(radius=25.0),
            normal=LineLoad(5.0),
            tangential=Traction(1.0),
            friction=0.8,
            speed=speed,
        )
    )


def _ratio(read: Callable[[Solution], float]) -> Callable[[Pair], float]:
    return lambda pair: read(pair[1]) / read(pair[0])
