"""Heat conduction along the radii of both rollers: a linear system for given sources.

(1/r) d(r k dT/dr)/dr + s(r) = rho c dT/dt is discretised by finite volumes. The unknowns are the
temperatures of the cells of the upper roller, of the lower roller, and of both surfaces, as rises
over the temperature of the air; a surface stores no heat. What flows out of one cell flows into the
next, so that the powers add up to rounding; without heat every rise is exactly zero.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rollnip.cooling import Coolant, Held, Insulated
from rollnip.heat.grid import RadialGrid
from rollnip.heat.nip_exchange import Exchange

Array = NDArray[np.float64]
Grids = tuple[RadialGrid, RadialGrid]


@dataclass(frozen=True, slots=True)
class Sources:
    """Heat of the nip: in every cell of both rollers, and at their surfaces.

    Attributes
    ----------
    cells : (n,) powers in the cells of the upper, then of the lower roller [mW/mm].
    lost : (2,) viscous losses of both rollers [mW/mm]; that of a plane is in no cell.
    over : heat exchange across the nip.
    """

    cells: Array
    lost: Array
    over: Exchange


@dataclass(frozen=True, slots=True)
class Outflow:
    """Powers that are generated in and leave one roller [mW/mm].

    Attributes
    ----------
    viscous, friction : generated in it.
    to_air, to_core, to_nip : that leave it; to_nip: across the nip, into the other surface or a
        sheet.
    carried : that a plane carries away with it: what is generated in it and enters it; 0 for a
        roller.
    """

    viscous: float
    friction: float
    to_air: float
    to_core: float
    to_nip: float
    carried: float


@dataclass(frozen=True, slots=True)
class Conduction:
    """Linear system for the temperatures of both rollers.

    Attributes
    ----------
    grids : of the upper and the lower roller.
    ambient : temperature of the air [degC].
    """

    grids: Grids
    ambient: float

    @property
    def sizes(self) -> tuple[int, int]:
        """Numbers of cells of the upper and the lower roller."""
        return self.grids[0].size, self.grids[1].size

    @property
    def cells(self) -> int:
        """Number of all cells; in arrays, the two surfaces follow them."""
        return sum(self.sizes)

    @property
    def capacity(self) -> Array:
        """Heat capacities of all cells, (n,) [mJ/(mm K)]."""
        return np.concatenate([grid.capacity for grid in self.grids])

    def part(self, values: Array, side: int) -> Array:
        """Return the values in the cells of the upper (0) or the lower roller (1)."""
        first = 0 if side == 0 else self.sizes[0]
        return values[first : first + self.sizes[side]]

    def surface(self, values: Array, side: int) -> float:
        """Return the temperature of a surface [degC]."""
        return float(values[self.cells + side])

    def uniform(self, temperature: float) -> Array:
        """Return the same temperature everywhere, (n+2,)."""
        return np.full(self.cells + 2, temperature)

    def system(self, over: Exchange) -> tuple[Array, Array]:
        """Return matrix (n+2, n+2) and right-hand side (n+2,), without the sources in cells.

        The unknowns are the rises over the temperature of the air.
        """
        n = self.cells
        matrix, right = np.zeros((n + 2, n + 2)), np.zeros(n + 2)
        for side, grid in enumerate(self.grids):
            first = 0 if side == 0 else self.sizes[0]
            self._inside(grid, first, n + side, matrix, right)
        matrix[n:, n:] -= over.matrix
        right[n:] += self._into_surfaces(over, np.zeros(2))
        for side in range(2):
            held = self._held_surface(side)
            if held is not None:
                matrix[n + side] = 0.0
                matrix[n + side, n + side], right[n + side] = 1.0, held - self.ambient
        return matrix, right

    def _inside(
        self, grid: RadialGrid, first: int, surface: int, matrix: Array, right: Array
    ) -> None:
        matrix[surface, surface] += grid.film_conductance
        if grid.size == 0:
            at, to_core = surface, _core_conductance(grid)
        else:
            between = grid.conductances[:-1]
            rows = np.concatenate([[surface], np.arange(first, first + grid.size)])
            above, below = rows[:-1], rows[1:]
            matrix[above, above] += between
            matrix[below, below] += between
            matrix[above, below] -= between
            matrix[below, above] -= between
            at, to_core = int(rows[-1]), _core_conductance(grid)
        if to_core > 0.0:
            matrix[at, at] += to_core
            right[at] += to_core * (_core_temperature(grid) - self.ambient)

    def _into_surfaces(self, over: Exchange, rises: Array) -> Array:
        """Return the powers into both surfaces across the nip, (2,), from their rises."""
        still = self.ambient * over.matrix.sum(axis=1) + over.offset
        return np.asarray(over.matrix @ rises + still)

    def _held_surface(self, side: int) -> float | None:
        """Return the temperature of a surface if it is prescribed; otherwise None."""
        grid = self.grids[side]
        if grid.plane is not None:
            return grid.plane
        if grid.size == 0 and isinstance(grid.cooling.core, Held):
            return grid.cooling.core.temperature
        return None

    def steady(self, sources: Sources) -> Array:
        """Return the steady temperatures, (n+2,) [degC]."""
        matrix, right = self.system(sources.over)
        right[: self.cells] += sources.cells
        return np.asarray(self.ambient + np.linalg.solve(matrix, right))

    def base(self, over: Exchange) -> Array:
        """Return the steady temperatures without the heat of the nip, (n+2,) [degC]."""
        cold = Exchange(over.matrix, over.offset - over.friction, np.zeros(2), 0.0)
        return self.steady(Sources(np.zeros(self.cells), np.zeros(2), cold))

    def outflow(self, values: Array, sources: Sources, side: int) -> Outflow:
        """Return the powers that are generated in and leave one roller."""
        grid, n = self.grids[side], self.cells
        surface = self.surface(values, side)
        into = float(self._into_surfaces(sources.over, values[n:] - self.ambient)[side])
        friction = float(sources.over.friction[side])
        to_air = grid.film_conductance * (surface - self.ambient)
        viscous = float(sources.lost[side])
        if grid.plane is not None:
            return Outflow(viscous, friction, 0.0, 0.0, friction - into, viscous + into)
        held = self._held_surface(side)
        if held is not None:
            return Outflow(viscous, friction, to_air, into - to_air, friction - into, 0.0)
        inner = self.part(values, side)[-1] if grid.size else surface
        to_core = _core_conductance(grid) * (float(inner) - _core_temperature(grid))
        return Outflow(viscous, friction, to_air, to_core, friction - into, 0.0)

    def inner_face(self, values: Array, side: int) -> float:
        """Return the temperature at the boundary with the core [degC]."""
        grid = self.grids[side]
        if grid.size == 0:
            return self.surface(values, side)
        core, last = grid.cooling.core, float(self.part(values, side)[-1])
        if isinstance(core, Insulated):
            return last
        if isinstance(core, Held):
            return core.temperature
        flow = _core_conductance(grid) * (last - core.temperature)
        return core.temperature + flow / _film_inside(grid, core)


def _film_inside(grid: RadialGrid, core: Coolant) -> float:
    return 2e-3 * np.pi * grid.inner_radius * core.film


def _core_conductance(grid: RadialGrid) -> float:
    """Return the conductance from the innermost cell to the core [mW/(mm K)]."""
    core = grid.cooling.core
    if isinstance(core, Insulated):
        return 0.0
    wall = 1.0 / float(grid.conductances[-1]) if grid.size else 0.0
    if isinstance(core, Held):
        return 1.0 / wall if wall else 0.0  # a bare surface held at a temperature is an equation
    return 1.0 / (wall + 1.0 / _film_inside(grid, core))


def _core_temperature(grid: RadialGrid) -> float:
    core = grid.cooling.core
    return 0.0 if isinstance(core, Insulated) else core.temperature
