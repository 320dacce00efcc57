"""A nip in thermal balance: temperatures, powers, growth, and the warm nip beside the cold one."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rollnip._results.summary import one_line
from rollnip._sealed import Sealed
from rollnip.cooling import HeatBalance
from rollnip.heat.conduction import Conduction, Outflow
from rollnip.heat.figures import COURSES, TEMPERATURE
from rollnip.heat.grid import RadialGrid
from rollnip.heat.state import ThermalState
from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.reservation import Reservation, texts
from rollnip.rollers import SIDES, Side
from rollnip.solution import Solution

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class RollerHeat(Sealed):
    """One roller in thermal balance; temperatures in degC, powers in W/m = mW/mm.

    Attributes
    ----------
    r : (n,) radii from the inside to the surface [mm]; only the surface where there are no cells.
    temperature : (n,) at these radii.
    surface_temperature : mean over a turn.
    bond_temperature : at the bond of the coverings to a rigid core; None without a bond.
    hot_spot, hot_spot_depth : highest temperature of the coverings down to their bond, and its
        depth [mm]; for a roller without coverings, of the whole roller.
    power : all heat generated in it.
    viscous, friction : the two parts of ``power``.
    to_air, to_core, to_nip : where it goes; to_nip: across the nip, into the other roller or a
        sheet; negative where heat comes in.
    carried : what a plane, a belt or rail, carries away: all heat generated in it and all that
        enters it across the nip, for it never comes back; 0 for a roller.
    growth : of the radius [mm].
    """

    r: Array
    temperature: Array
    surface_temperature: float
    bond_temperature: float | None
    hot_spot: float
    hot_spot_depth: float
    power: float
    viscous: float
    friction: float
    to_air: float
    to_core: float
    to_nip: float
    carried: float
    growth: float

    def at_depth(self, depth: float) -> float:
        """Return the temperature at a depth below the surface [mm]."""
        return float(np.interp(self.r[-1] - depth, self.r, self.temperature))


def profile(conduction: Conduction, values: Array, side: int) -> tuple[Array, Array]:
    """Return radii from the inside to the surface, and the temperatures there, (n,) each."""
    grid = conduction.grids[side]
    surface = conduction.surface(values, side)
    if grid.size == 0:
        return np.array([grid.roller.radius]), np.array([surface])
    cells = conduction.part(values, side)[::-1]
    r = np.concatenate([grid.radii[-1:], grid.middles[::-1], grid.radii[:1]])
    inside = conduction.inner_face(values, side)
    return r, np.concatenate([[inside], cells, [surface]])


def bond_temperature(conduction: Conduction, values: Array, side: int) -> float | None:
    """Return the temperature at the bond of coverings to a rigid core; None without a bond."""
    grid = conduction.grids[side]
    if grid.size == 0 or not grid.roller.layers or grid.roller.core is not None:
        return None
    inner = int(np.flatnonzero(grid.covering)[-1])
    if inner == grid.size - 1:
        return conduction.inner_face(values, side)
    cells = conduction.part(values, side)
    above, below = _halves(grid, inner)
    return float((above * cells[inner] + below * cells[inner + 1]) / (above + below))


def _halves(grid: RadialGrid, cell: int) -> tuple[float, float]:
    """Return the conductances from the lower face of a cell to its middle and the next middle."""
    face = grid.radii[cell + 1]
    above = grid.conductivity[cell] / np.log(grid.middles[cell] / face)
    below = grid.conductivity[cell + 1] / np.log(face / grid.middles[cell + 1])
    return float(above), float(below)


@dataclass(frozen=True, eq=False, repr=False)
class HeatSolution:
    """A nip in thermal balance. Units mm, N, MPa, s, degC; powers in W/m = mW/mm.

    Attributes
    ----------
    nip, heat, model : the problem.
    converged : whether the temperatures settled and the warm nip was verified.
    status : a sentence that says so, or what is wrong.
    reservations : on the warm nip, and on materials that do not follow the temperature.
    error : "temperature" [K]: what the iteration and the sub-layers leave, and what the errors of
        the losses make of the rise.
    cold : the nip with everything at the ambient temperature.
    stable : whether a small disturbance dies out; None where no steady state was found.
    solves : number of nips that were solved.
    sublayers : number of sub-layers into which the layers of both rollers were divided.
    """

    nip: Nip
    heat: HeatBalance
    model: Model
    converged: bool
    status: str
    reservations: tuple[Reservation, ...]
    error: dict[str, float]
    cold: Solution = field(repr=False)
    stable: bool | None
    solves: int
    sublayers: int
    state: ThermalState = field(repr=False)
    conduction: Conduction = field(repr=False)

    def __repr__(self) -> str:
        upper, lower = (TEMPERATURE.text(one.hot_spot) for one in (self.upper, self.lower))
        heat = COURSES["power"]
        shown = (
            f"{TEMPERATURE.label} {upper} (upper) and {lower} (lower)",
            f"{heat.label} {heat.text(self.power)}",
        )
        return one_line(self, self.nip.title, f", geometry {self.model.geometry}", *shown)

    @property
    def warnings(self) -> tuple[str, ...]:
        """The sentences of the reservations."""
        return texts(self.reservations)

    @property
    def warm(self) -> Solution:
        """The solution of the nip between the warm rollers."""
        return self.state.solution

    @cached_property
    def upper(self) -> RollerHeat:
        """The upper roller."""
        return self._roller("upper")

    @cached_property
    def lower(self) -> RollerHeat:
        """The lower roller."""
        return self._roller("lower")

    def of(self, side: Side) -> RollerHeat:
        """Return the "upper" or the "lower" roller."""
        return self.upper if side == "upper" else self.lower

    @property
    def power(self) -> float:
        """All heat of the nip, viscous and frictional [W/m]."""
        return (self.warm.dissipation_viscous or 0.0) + (self.warm.dissipation_friction or 0.0)

    @property
    def to_sheet(self) -> float:
        """Heat that a sheet carries away [W/m]; 0 without a sheet."""
        if self.heat.sheet is None:
            return 0.0
        return self.upper.to_nip + self.lower.to_nip + self.state.sources.over.to_sheet

    @property
    def balance(self) -> float:
        """Heat generated minus heat that leaves, over all heat; 0 where it is balanced."""
        out = self.to_sheet
        for roller in (self.upper, self.lower):
            out += roller.to_air + roller.to_core + roller.carried
        return (self.power - out) / self.power if self.power > 0.0 else 0.0

    def _roller(self, side: Side) -> RollerHeat:
        index, values = SIDES.index(side), self.state.new
        r, temperature = profile(self.conduction, values, index)
        flow: Outflow = self.conduction.outflow(values, self.state.sources, index)
        bond = bond_temperature(self.conduction, values, index)
        depth, hottest = _hottest(self.conduction.grids[index], r, temperature, bond)
        return RollerHeat(
            r=r,
            temperature=temperature,
            surface_temperature=self.conduction.surface(values, index),
            bond_temperature=bond,
            hot_spot=hottest,
            hot_spot_depth=depth,
            power=flow.viscous + flow.friction,
            viscous=flow.viscous,
            friction=flow.friction,
            to_air=flow.to_air,
            to_core=flow.to_core,
            to_nip=flow.to_nip,
            carried=flow.carried,
            growth=self.state.growth[index].total,
        )


def _hottest(
    grid: RadialGrid, r: Array, temperature: Array, bond: float | None
) -> tuple[float, float]:
    """Return depth and temperature of the hottest place of the coverings, their bond included."""
    if r.size == 1:
        return 0.0, float(temperature[0])
    depth = r[-1] - r
    if bond is not None:
        thick = grid.roller.coating_thickness
        covering = depth < thick
        depth = np.append(thick, depth[covering])
        temperature = np.append(bond, temperature[covering])
    hottest = int(np.argmax(temperature))
    return float(depth[hottest]), float(temperature[hottest])
