"""Heat of rollers: conduction in closed form, energy, growth, perfect cooling, runaway."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from math import e, exp, log, pi, sqrt
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rollnip.cooling import Core, Held, Insulated
from rollnip.heat import (
    Branch,
    Cooling,
    Exchange,
    HeatBalance,
    HeatSolution,
    RadialGrid,
    exchange,
    radial_growth,
    roller_grid,
    solve_heat,
)
from rollnip.heat.conduction import Conduction, Sources
from rollnip.heat.follow import follow
from rollnip.materials import TYPICAL, WLF, Elastic, StandardLinearSolid, Thermal
from rollnip.nip import LineLoad, Nip
from rollnip.rollers import Layer, Roller
from rollnip.verification._nips import LINEAR
from rollnip.verification.case import ROUNDING, AllowedError, Experiment, VerificationCase
from rollnip.verification.sources import (
    CONDUCTION,
    CONTACT_OF_HALF_SPACES,
    ENERGY_OF_ROLLERS,
    EXPANSION,
    PERFECT_COOLING,
    SEMENOV,
)

Array = NDArray[np.float64]

_RING = Thermal(conductivity=0.25, density=1150.0, heat_capacity=1900.0, expansion=2e-4)
_POWER, _FILM, _INNER, _OUTER = 500.0, 30.0, 88.9, 101.6  # W/m, W/(m2 K), mm, mm
_CELLS = AllowedError(1e-4, "48 cells in a layer leave the square of 1/48 of its parabola, halved")
_BETA, _LOSS = 0.05, 0.01  # 1/K; K of rise per mm/s when cold


def heat() -> tuple[VerificationCase, ...]:
    """Rings and a slab in closed form, half-spaces in contact, growth, energy, runaway."""
    return (*_rings(), *_slab(), *_contact(), *_growth(), *_energy(), *_cooling(), *_runaway())


class Warm(NamedTuple):
    """A roller with given heat, and its temperatures."""

    conduction: Conduction
    values: Array


def _ring(core: Core, radius: float, thickness: float, film: float, power: float) -> Warm:
    """Return a covering with even heat [W/m], ambient 0, beside a cold roller it does not touch."""
    rubber = Elastic(modulus=2.0, poisson=0.5, thermal=_RING)
    roller = Roller(radius=radius, layers=[Layer(thickness, rubber)])
    grid = roller_grid("upper", roller, Cooling(film=film, core=core), 0.0)
    other = roller_grid("lower", Roller(radius=50.0), Cooling(film=0.0, core=Held(0.0)), 0.0)
    conduction = Conduction((grid, other), 0.0)
    apart = Exchange(np.zeros((2, 2)), np.zeros(2), np.zeros(2), 0.0)
    cells = power * grid.volumes / grid.volumes.sum()
    return Warm(conduction, conduction.steady(Sources(cells, np.array([power, 0.0]), apart)))


def _surface(warm: Warm) -> float:
    return warm.conduction.surface(warm.values, 0)


def _inside(warm: Warm) -> float:
    return warm.conduction.inner_face(warm.values, 0)


def _rings() -> tuple[VerificationCase, ...]:
    a, b, k = _INNER, _OUTER, _RING.conductivity
    per_volume = _POWER / (pi * (b**2 - a**2))
    film = 2e-3 * pi * b * _FILM
    surface = _POWER / film
    inside = surface + per_volume / (4.0 * k) * (b**2 - a**2 - 2.0 * a**2 * log(b / a))
    insulated = Experiment(
        "Ring with even heat, insulated core",
        CONDUCTION,
        partial(_ring, Insulated(), b, b - a, _FILM, _POWER),
    ).figure
    # Core at ambient: T = c ln(r/a) - s (r^2 - a^2)/(4 k), and the film takes 2 pi (s b^2/2 - k c)
    fall = per_volume * (b**2 - a**2) / (4.0 * k)
    rise = (pi * per_volume * b**2 + film * fall) / (2.0 * pi * k + film * log(b / a))
    held = Experiment(
        "Ring with even heat, core at ambient",
        CONDUCTION,
        partial(_ring, Held(0.0), b, b - a, _FILM, _POWER),
    ).figure
    return (
        insulated("surface over ambient", "K", surface, _surface, ROUNDING),
        insulated("core over ambient", "K", inside, _inside, _CELLS),
        held("surface over ambient", "K", rise * log(b / a) - fall, _surface, _CELLS),
    )


def _slab() -> tuple[VerificationCase, ...]:
    thickness, radius, film = 2.0, 1e5, 40.0
    power = 1e-3 * 2.0 * pi * radius * thickness  # 1 mW/cm3
    surface = 0.5e-3 * thickness**2 / _RING.conductivity
    surface /= 1.0 + 1e-3 * film * thickness / _RING.conductivity
    figure = Experiment(
        "Slab with even heat between a cold wall and a film",
        CONDUCTION,
        partial(_ring, Held(0.0), radius, thickness, film, power),
    ).figure
    return (figure("surface over ambient", "K", surface, _surface, AllowedError(5e-4, "48 cells")),)


def _contact() -> tuple[VerificationCase, ...]:
    upper, lower = TYPICAL["natural-rubber"].effusivity, TYPICAL["steel"].effusivity
    both = upper * lower / (upper + lower)
    figure = Experiment(
        "Two planes that touch for 20 ms",
        CONTACT_OF_HALF_SPACES,
        partial(exchange, (upper, lower), 8.0, 400.0, (float("inf"), float("inf")), 0.0),
    ).figure
    expected = 400.0 * 2.0 * both * sqrt(0.02 / pi)
    return (figure("conductance", "W/(m K)", expected, lambda found: found.matrix[0, 1], ROUNDING),)


def _growth() -> tuple[VerificationCase, ...]:
    figure = Experiment(
        "Thick incompressible covering, 10 K warmer", EXPANSION, _thick_covering
    ).figure
    volume = 3.0 * _RING.expansion * 10.0 * (100.0**2 - 50.0**2) / (2.0 * 100.0)
    return (figure("growth of the radius", "mm", volume, _grown, ROUNDING),)


def _thick_covering() -> RadialGrid:
    rubber = Elastic(modulus=2.0, poisson=0.5, thermal=_RING)
    roller = Roller(radius=100.0, layers=[Layer(50.0, rubber)])
    return roller_grid("upper", roller, Cooling(film=1.0), 0.0)


def _grown(grid: RadialGrid) -> float:
    return radial_growth(grid, np.full(grid.size, 10.0), 0.0)


def _press() -> Nip:
    rubber = StandardLinearSolid(
        modulus=3.0,
        stiffening=3.0,
        relaxation_time=1e-3,
        poisson=0.49,
        temperature=23.0,
        shift=WLF(8.86, 101.6, 23.0),
        thermal=replace(TYPICAL["natural-rubber-filled"], expansion=0.0),
    )
    return Nip(
        upper=Roller(radius=100.0, layers=[Layer(10.0, rubber)]),
        lower=Roller(radius=100.0),
        normal=LineLoad(20.0),
        friction=0.3,
        speed=3000.0,
    )


def _warm_press(film: float, core: Core) -> HeatSolution:
    cooling = Cooling(film=film, core=core)
    balance = HeatBalance(ambient=23.0, upper=cooling, lower=cooling)
    return solve_heat(_press(), balance, LINEAR)


def _energy() -> tuple[VerificationCase, ...]:
    figure = Experiment(
        "Warm press in thermal balance", ENERGY_OF_ROLLERS, partial(_warm_press, 50.0, Insulated())
    ).figure
    closed = AllowedError(1e-4, "the balance that the heat of a nip is solved to")
    return (
        figure("heat to the air over all heat", "", 1.0, _to_air, closed),
        figure("heat in all depths over the viscous loss", "", 1.0, _in_depths, closed),
    )


def _to_air(found: HeatSolution) -> float:
    return (found.upper.to_air + found.lower.to_air) / found.power


def _in_depths(found: HeatSolution) -> float:
    return float(found.state.sources.cells.sum()) / float(found.warm.dissipation_viscous or 0.0)


def _cooling() -> tuple[VerificationCase, ...]:
    thin = Experiment("Thin covering, cooled without limit", PERFECT_COOLING, _cooled).figure
    left = AllowedError(5e-3, "half a tenth of a kelvin is left in the middle of the covering")
    return (thin("viscous loss over that of the cold nip", "", 1.0, _over_cold, left),)


def _cooled() -> HeatSolution:
    press = _press()
    layer = press.upper.layers[0]
    nip = replace(press, upper=Roller(radius=100.0, layers=[replace(layer, thickness=0.25)]))
    cooling = Cooling(film=1e7, core=Held(23.0))
    return solve_heat(nip, HeatBalance(ambient=23.0, upper=cooling, lower=cooling), LINEAR)


def _over_cold(found: HeatSolution) -> float:
    return (found.warm.dissipation_viscous or 0.0) / (found.cold.dissipation_viscous or 1.0)


@dataclass(frozen=True)
class _UniformState:
    """A state of one temperature, as the branch reads it."""

    temperatures: Array
    rise: Array

    @property
    def base(self) -> Array:
        return np.zeros(2)

    @property
    def new(self) -> Array:
        return self.rise

    @property
    def hottest(self) -> float:
        return float(self.rise.max())

    @property
    def solution(self) -> Any:
        return self

    @property
    def dissipation_viscous(self) -> float:
        return self.hottest

    @property
    def dissipation_friction(self) -> float:
        return 0.0


class _Lumped:
    """One temperature: theta = loss v e^(beta theta), in the place of a nip with its heat."""

    def __init__(self) -> None:
        grid = roller_grid("upper", Roller(radius=10.0), Cooling(film=1.0), 0.0)
        self.conduction = Conduction((grid, grid), 0.0)
        self.heat = HeatBalance(ambient=0.0, upper=grid.cooling, lower=grid.cooling)
        self.solves = 0

    def with_parameter(self, _parameter: str, value: float) -> float:
        return value

    def whole(self) -> None:
        return None

    def divided(self, *_: object) -> None:
        return None

    def at(self, temperatures: Array, _cut: None, value: float) -> _UniformState:
        self.solves += 1
        rise = _LOSS * value * exp(_BETA * float(np.max(temperatures)))
        return _UniformState(temperatures, np.full(2, rise))


def _runaway() -> tuple[VerificationCase, ...]:
    figure = Experiment("Heat that grows as e^(T/20 K)", SEMENOV, _branch).figure
    top = AllowedError(1e-3, "what the branch is solved to; the value is flat at the top")
    near = AllowedError(3e-2, "the place of a flat top is known to the root of its value")
    return (
        figure("speed of runaway", "mm/s", 1.0 / (e * _BETA * _LOSS), _turning_value, top),
        figure("rise at runaway", "K", 1.0 / _BETA, _turning_rise, near),
    )


def _branch() -> Branch:
    lumped: Any = _Lumped()
    return follow(lumped, "speed", 100.0, 5000.0)


def _turning_value(found: Branch) -> float:
    return float("nan") if found.turning is None else found.turning.value


def _turning_rise(found: Branch) -> float:
    return float("nan") if found.turning is None else found.turning.rise
