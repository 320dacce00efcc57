"""A nip at given temperatures: its solution, its heat, and the temperatures this leads to."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError, require_instance
from rollnip.cooling import HeatBalance, PassingSheet
from rollnip.heat.conduction import Conduction, Sources
from rollnip.heat.grid import RadialGrid, roller_grid
from rollnip.heat.nip_exchange import exchange
from rollnip.heat.warm import Divided, Growth, divided, follows, growths, undivided, warm_nip
from rollnip.influence import KernelCache
from rollnip.model import Model
from rollnip.nip import LineLoad, Nip
from rollnip.rollers import SIDES, Side
from rollnip.solution import Solution
from rollnip.solver import solve

Array = NDArray[np.float64]
Parameter = Literal["speed", "load"]


@dataclass(frozen=True)
class ThermalState:
    """A nip at given temperatures.

    Attributes
    ----------
    temperatures : (n+2,) at which it was solved [degC].
    solution : of the warm nip.
    sources : its heat.
    growth : of both rollers.
    new : (n+2,) steady temperatures to which this heat leads [degC].
    base : (n+2,) steady temperatures without the heat of the nip [degC].
    """

    temperatures: Array
    solution: Solution
    sources: Sources
    growth: tuple[Growth, Growth]
    new: Array
    base: Array

    @cached_property
    def rise(self) -> Array:
        """Rise of the new temperatures over those without heat, (n+2,) [K]."""
        return self.new - self.base

    @property
    def hottest(self) -> float:
        """Largest rise [K]."""
        return float(np.max(self.rise))


class HeatProblem:
    """A nip with its heat balance; it counts the nips that it solves.

    Parameters
    ----------
    nip, heat, model : the problem.
    cache : influence functions of earlier solves.

    Raises
    ------
    InvalidInputError
        where the speed is missing, a material has no thermal properties, no heat can leave, or a
        part of the problem does not go with a heat balance.
    """

    def __init__(
        self, nip: Nip, heat: HeatBalance, model: Model, cache: KernelCache | None = None
    ) -> None:
        _check(nip, heat)
        self.passing = _passing(nip, heat)
        self.nip, self.heat, self.model = nip, heat, model
        self.cache = KernelCache() if cache is None else cache
        grids: list[RadialGrid] = [
            roller_grid(side, getattr(nip, side), heat.of(side), heat.ambient) for side in SIDES
        ]
        self.conduction = Conduction((grids[0], grids[1]), heat.ambient)
        self.solves = 0
        self._last: Solution | None = None

    @property
    def follows(self) -> bool:
        """Whether anything in the nip changes with temperature."""
        rollers = (self.nip.upper, self.nip.lower)
        materials = [material for roller in rollers for material in roller.materials]
        grows = any(m.thermal is not None and m.thermal.expansion != 0.0 for m in materials)
        shells = (self.heat.of(side).shell for side in SIDES)
        grows = grows or any(one is not None and one.thermal.expansion != 0.0 for one in shells)
        return grows or any(follows(material) for material in materials)

    def whole(self) -> Divided:
        """Return the division in which every layer is one sub-layer."""
        return undivided(self.conduction)

    def divided(self, temperatures: Array, solution: Solution, allowed: float) -> Divided:
        """Return sub-layers for given temperatures, at the frequency of a solution.

        Parameters
        ----------
        temperatures : (n+2,) of cells and surfaces [degC].
        solution : of a similar nip.
        allowed : largest change of ln E* inside a sub-layer, for storage and loss part.
        """
        width = solution.nip_width
        return divided(self.conduction, temperatures, solution.nip, width, allowed)

    def with_parameter(self, parameter: Parameter, value: float) -> Nip:
        """Return the nip at another speed [mm/s] or line load [N/mm]."""
        if parameter == "speed":
            return replace(self.nip, speed=value)
        return replace(self.nip, normal=LineLoad(value))

    def at(self, temperatures: Array, cut: Divided, nip: Nip | None = None) -> ThermalState:
        """Return the nip at given temperatures, and the temperatures to which its heat leads.

        Parameters
        ----------
        temperatures : (n+2,) of cells and surfaces [degC].
        cut : sub-layers.
        nip : the cold nip, where it differs from that of the problem in speed or load.
        """
        cold = self.nip if nip is None else nip
        grown = growths(self.conduction, temperatures, self.heat.ambient)
        warm = warm_nip(cold, self.conduction, temperatures, cut, grown)
        solution = self._last = solve(warm, self.model, cache=self.cache, near=self._last)
        self.solves += 1
        sources = self._sources(solution, grown)
        return ThermalState(
            temperatures,
            solution,
            sources,
            grown,
            self.conduction.steady(sources),
            self.conduction.base(sources.over),
        )

    def _sources(self, solution: Solution, grown: tuple[Growth, Growth]) -> Sources:
        grids, speed = self.conduction.grids, solution.nip.speed
        assert speed is not None
        cells = [
            _cells(grid, solution, side, one)
            for grid, side, one in zip(grids, SIDES, grown, strict=True)
        ]
        over = exchange(
            (grids[0].effusivity, grids[1].effusivity),
            solution.nip_width,
            speed,
            (solution.nip.upper.radius, solution.nip.lower.radius),
            _rubbed(solution),
            self.passing,
        )
        lost = np.array([_lost(solution, side) for side in SIDES])
        return Sources(np.concatenate(cells), lost, over)


def _cells(grid: RadialGrid, solution: Solution, side: Side, grown: Growth) -> Array:
    """Return the power in each cell of a roller, (n,) [mW/mm]."""
    covering = grid.covering
    powers = np.zeros(grid.size)
    if not covering.any():
        return powers
    faces = grid.depth[: int(covering.sum()) + 1] * grown.thicker(grid.roller)
    roller = solution.nip.upper if side == "upper" else solution.nip.lower
    if roller.core is None:
        faces[-1] = min(faces[-1], roller.coating_thickness)
    below = solution.heat_below(side, faces)
    assert below is not None
    below[-1] = 0.0  # heat that a half-space generates below the axis goes to the innermost cell
    powers[covering] = below[:-1] - below[1:]
    return powers


def _rubbed(solution: Solution) -> float | tuple[float, float]:
    """Return the friction heat [mW/mm]; with a sheet, that on its upper and on its lower side."""
    if solution.sheet is None:
        return solution.dissipation_friction or 0.0
    return solution.sheet.friction_upper or 0.0, solution.sheet.friction_lower or 0.0


def _lost(solution: Solution, side: Side) -> float:
    below = solution.heat_below(side, 0.0)
    assert below is not None
    return float(below[0])


def _passing(nip: Nip, heat: HeatBalance) -> PassingSheet | None:
    """Return what runs between the rollers, with its thickness; None where they touch."""
    own = None if nip.sheet is None else nip.sheet.thickness
    if heat.sheet is None:
        if own is None:
            return None
        raise InvalidInputError(
            "`sheet` of the heat balance must be given where the nip has a sheet, which takes heat "
            "along: `rn.PassingSheet(thermal=..., temperature=...)`, got None."
        )
    thickness = own if heat.sheet.thickness is None else heat.sheet.thickness
    if thickness is None:
        raise InvalidInputError(
            "`thickness` of the sheet must be given for a nip without a sheet of its own, got None."
        )
    if own is not None and thickness != own:
        raise InvalidInputError(
            f"`thickness` of the sheet must be left out, or that of the nip's sheet, {own:g} mm, "
            f"got {thickness:g}."
        )
    return replace(heat.sheet, thickness=thickness)


def _check(nip: Nip, heat: HeatBalance) -> None:
    require_instance("nip", nip, Nip)
    require_instance("heat", heat, HeatBalance)
    if nip.speed is None:
        raise InvalidInputError("`speed` must be given for a heat balance, got None.")
    if nip.has_profile:
        raise InvalidInputError(
            "`profile` must be left out for a heat balance: a measured profile is a snapshot "
            "without losses."
        )
    planes = [getattr(nip, side).curvature == 0.0 for side in SIDES]
    closed = [heat.of(side).is_closed for side in SIDES]
    if not any(planes) and all(closed) and heat.sheet is None:
        raise InvalidInputError(
            "`film` must be positive for at least one roller, or a core held or cooled: with film "
            "0 and insulated cores no heat can leave, got 0 for both."
        )
