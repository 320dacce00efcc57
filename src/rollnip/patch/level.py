"""One patch on one grid: pressure and shear in turn, until neither changes the other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rollnip.nip import Approach, Creepage
from rollnip.patch.coefficients import Array, Grid
from rollnip.patch.convolution import Convolutions
from rollnip.patch.kernels import waves_of
from rollnip.patch.lossy import solve_lossy
from rollnip.patch.normal import NormalProblem, NormalState, solve_symmetric
from rollnip.patch.preconditioner import symbols
from rollnip.patch.rolling import RollingProblem, RollingState, solve_rolling
from rollnip.patch.tables import PairTables
from rollnip.patches import Force, Patch
from rollnip.rollers import Roller

Mask = NDArray[np.bool_]

_WAVES = 24
"""Number of wave numbers at which the compliance to shear is evaluated for its largest value."""
_SAME = 10.0
"""Pressure and shear agree where one more turn changes p by less than this times the tolerance."""
_TURNS = 40
"""Largest number of turns in which pressure and shear are computed."""


@dataclass(frozen=True)
class Level:
    """A patch solved on one grid.

    Attributes
    ----------
    products : the grid, and displacements under tractions on it.
    normal : pressure and approach.
    rolling : shear and creepages; None without friction.
    turns : number of times that pressure and shear were computed.
    change : largest change of the pressure in the last turn, over the peak pressure.
    settled : whether all iterations met their tolerances.
    """

    products: Convolutions
    normal: NormalState
    rolling: RollingState | None
    turns: int
    change: float
    settled: bool

    @property
    def grid(self) -> Grid:
        """Rectangles of the grid."""
        return self.products.grid

    @property
    def shear(self) -> Array:
        """Shear tractions on the upper roller, (2, ny, nx) [MPa]; zero without friction."""
        if self.rolling is None:
            return np.zeros((2, *self.normal.pressure.shape))
        return self.rolling.shear


def solve_level(
    patch: Patch, grid: Grid, tolerance: float, start: Level | None, tables: PairTables
) -> Level:
    """Return a patch solved on one grid.

    Parameters
    ----------
    patch : the problem.
    grid : rectangles over more than the contact.
    tolerance : of the iterations, relative.
    start : the solution on another grid to start from.
    tables : kernels of the rollers.
    """
    products = tables.products(grid)
    clearance = patch.clearance(grid.x, grid.y)
    pressure = None if start is None else resampled(start.normal.pressure, start.grid, grid)
    shear = None
    if start is not None and start.rolling is not None:
        shear = np.stack([resampled(part, start.grid, grid) for part in start.shear])
    closed: Array | float = 0.0
    if products.couples and shear is not None:
        closed = _closed_by(products, shear)
    creepages = _creepages(patch, start)
    force = patch.normal.force if isinstance(patch.normal, Force) else None
    approach = patch.normal.approach if isinstance(patch.normal, Approach) else None
    rolling, change, turns = None, 0.0, 0
    while True:
        turns += 1
        problem = NormalProblem(products, clearance + closed, force, approach)
        normal = _pressed(patch, grid, problem, tolerance, pressure)
        peak = float(np.max(normal.pressure))
        if pressure is not None and turns > 1:
            change = float(np.max(np.abs(normal.pressure - pressure))) / max(peak, 1e-300)
        pressure = normal.pressure
        if patch.friction == 0.0 or peak == 0.0:
            break
        rolling = _rolled(patch, products, normal, (creepages, shear), tolerance)
        creepages, shear = rolling.creepages, rolling.shear
        is_same = turns > 1 and change < _SAME * tolerance
        if not products.couples or is_same or turns == _TURNS:
            break
        closed = _closed_by(products, shear)
    settled = normal.settled and (rolling is None or rolling.settled)
    settled = settled and (not products.couples or change < _SAME * tolerance)
    return Level(products, normal, rolling, turns, change, settled)


def _pressed(
    patch: Patch, grid: Grid, problem: NormalProblem, tolerance: float, start: Array | None
) -> NormalState:
    """Return the pressure under a given clearance."""
    if not patch.is_viscoelastic:
        return solve_symmetric(problem, tolerance, start)
    near = np.isfinite(problem.clearance) if start is None else start > 0.0
    factors = symbols((patch.upper, patch.lower), grid, near, patch.speed or 0.0)
    return solve_lossy(problem, tolerance, start, factors.normal)


def _rolled(
    patch: Patch,
    products: Convolutions,
    normal: NormalState,
    start: tuple[tuple[float, float, float], Array | None],
    tolerance: float,
) -> RollingState:
    """Return shear and creepages under given pressures."""
    contact = normal.pressure > 0.0
    rollers = (patch.upper, patch.lower)
    softness = _softness(rollers, products.grid)
    problem = RollingProblem(
        products=products,
        bound=patch.friction * normal.pressure,
        pressure=normal.pressure,
        creepages=start[0],
        forces=(_force_of(patch.along), _force_of(patch.across)),
        symbols=symbols(rollers, products.grid, contact, patch.speed or 0.0).rolling,
        stiffness=1.0 / softness,
    )
    return solve_rolling(problem, tolerance, start[1])


def _softness(rollers: tuple[Roller, Roller], grid: Grid) -> float:
    """Return the largest creep per unit shear of any wave that the grid can hold [1/MPa]."""
    k = np.geomspace(np.pi / (grid.nx * grid.hx), np.pi / min(grid.hx, grid.hy), _WAVES)
    made = sum(waves_of(roller, k).s * k for roller in rollers if not roller.is_rigid)
    return float(np.max(made))


def _force_of(drive: Creepage | Force) -> float | None:
    return drive.force if isinstance(drive, Force) else None


def _creepages(patch: Patch, start: Level | None) -> tuple[float, float, float]:
    """Return the creepages, prescribed or from which to start."""
    found = (0.0, 0.0, 0.0)
    if start is not None and start.rolling is not None:
        found = start.rolling.creepages
    along, across = (
        drive.creepage if isinstance(drive, Creepage) else found[i]
        for i, drive in enumerate((patch.along, patch.across))
    )
    return along, across, patch.spin


def _closed_by(products: Convolutions, shear: Array) -> Array:
    """Return the sum of the inward u_z of both surfaces due to shear, (ny, nx) [mm]."""
    spectrum = sum(
        1j * part * products.forward(q) for part, q in zip(products.coupling, shear, strict=True)
    )
    return -products.back(np.asarray(spectrum))


def resampled(values: Array, old: Grid, new: Grid) -> Array:
    """Return values on another grid, linear between the middles of the old rectangles."""
    along = np.stack([np.interp(new.x, old.x, row, left=0.0, right=0.0) for row in values])
    columns = [np.interp(new.y, old.y, column, left=0.0, right=0.0) for column in along.T]
    return np.stack(columns, axis=1)
