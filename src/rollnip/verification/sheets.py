"""Sheets in the nip: their limit without stiffness, a direct program, power."""

from __future__ import annotations

from functools import cache, partial

from rollnip.materials import Elastic
from rollnip.nip import LineLoad, Nip, Traction
from rollnip.rollers import Layer, Roller
from rollnip.sheets import Sheet
from rollnip.solution import Solution
from rollnip.verification._nips import creepage, peak_pressure, solved
from rollnip.verification.case import AllowedError, Experiment, VerificationCase
from rollnip.verification.sources import DIRECT_SHEET, ENERGY, NO_SHEET

_UPPER = Roller(radius=50.0, layers=(Layer(2.0, Elastic(modulus=0.91, poisson=0.5)),))
_LOWER = Roller(radius=25.0, layers=(Layer(2.7, Elastic(modulus=2.04, poisson=0.5)),))

Pair = tuple[Solution, Solution]


def sheets() -> tuple[VerificationCase, ...]:
    """Return the figures of nips with a sheet."""
    return (*_without_stiffness(), *_direct(), *_power())


def _nip(sheet: Sheet | None, traction: float, friction: float) -> Nip:
    return Nip(
        upper=_UPPER,
        lower=_LOWER,
        normal=LineLoad(1.78),
        tangential=Traction(traction),
        friction=friction,
        speed=100.0,
        sheet=sheet,
    )


def _without_stiffness() -> tuple[VerificationCase, ...]:
    figure = Experiment("Sheet of E h = 0.001 N/mm over none", NO_SHEET, _soft).figure
    near = AllowedError(3e-3, "stiffness left and meshes, 1e-3 each")
    return (
        figure("creepage", "", 1.0, lambda pair: creepage(pair[0]) / creepage(pair[1]), near),
        figure(
            "peak pressure", "", 1.0, lambda pair: peak_pressure(pair[0]) / peak_pressure(pair[1])
        ),
    )


@cache
def _soft() -> Pair:
    sheet = Sheet(thickness=1e-7, modulus=1e4, poisson=0.5, friction_upper=0.8, friction_lower=0.3)
    return solved(_nip(sheet, 0.2, 0.3)), solved(_nip(None, 0.2, 0.3))


def _direct() -> tuple[VerificationCase, ...]:
    figure = Experiment("Paper between two coverings, driven", DIRECT_SHEET, _driven).figure
    slope = 0.5 * 7.135 * (1.0 / 50.0 + 1.0 / 25.0)
    near = AllowedError(2e-3, "of the slope of the gap at its edge: elements of the program")
    wanted = _STORED
    return (
        figure("approach", "mm", wanted["approach"], lambda one: one.approach),
        figure(
            "creepage_upper", "", wanted["upper"], partial(_sheet, "creepage_upper"), near,
            scale=slope,
        ),
        figure(
            "creepage_lower", "", wanted["lower"], partial(_sheet, "creepage_lower"), near,
            scale=slope,
        ),
    )  # fmt: skip


def _sheet(name: str, solution: Solution) -> float:
    return float(getattr(solution.sheet, name))


def _paper(tension_in: float, tension_out: float) -> Sheet:
    return Sheet(
        thickness=0.1,
        modulus=3500.0,
        poisson=0.3,
        modulus_thickness=1e9,
        tension_in=tension_in,
        tension_out=tension_out,
        bending=False,  # the program's sheet bends freely
    )


@cache
def _driven() -> Solution:
    return solved(_nip(_paper(0.0, 0.0), 0.3, 0.5))


def _power() -> tuple[VerificationCase, ...]:
    figure = Experiment("Power of both axles with a pulled sheet", ENERGY, _pulled).figure
    near = AllowedError(1e-4, "meshes of elastic layers; of the power in")
    return (figure("losses and the sheet's share over power in", "", 1.0, _balance, near),)


@cache
def _pulled() -> Solution:
    return solved(_nip(_paper(0.2, 0.05), 0.0, 0.3))


def _balance(solution: Solution) -> float:
    sheet = solution.sheet
    spent = sheet.friction_upper + sheet.friction_lower + solution.dissipation_viscous
    return float((spent + sheet.power) / solution.power_in)


_STORED = {"approach": 0.273898, "upper": -0.001936, "lower": 0.042211}
