"""Warming up: temperatures over time, starting from one temperature everywhere.

rho c dT/dt follows from conduction and from the heat of the nip, which adapts to the temperatures
within a turn. This heat is tabulated over theta, the mean rise of the coverings relative to the
steady state (0 to 1), from nips at the temperatures of the warming path itself; path and table are
computed in turn until they agree. The equations are integrated by scipy's BDF.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import ConvergenceError, InvalidInputError, require_positive
from rollnip._sealed import Sealed
from rollnip.cooling import HeatBalance
from rollnip.heat.conduction import Conduction
from rollnip.heat.figures import RISE
from rollnip.heat.nip_exchange import Exchange
from rollnip.heat.solution import HeatSolution, bond_temperature, profile
from rollnip.heat.state import HeatProblem, ThermalState
from rollnip.heat.steady import solve_heat
from rollnip.influence import KernelCache
from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.rollers import SIDES, Side

Array = NDArray[np.float64]

_NODES = (0.0, 0.03, 0.1, 0.2, 0.35, 0.55, 0.75, 1.0)
_ALLOWED = 0.25  # largest change of ln E* inside a sub-layer
_SWEEPS = 5
_SHARE = 5.0  # allowed change of the path over the largest rise, over the model's tolerance
_TIMES, _LATER = 121, 25  # times while it warms up, and after that
_LONG = 5.0  # duration over the slowest time constant
_UNMOVED = 0.1  # over the allowed change of the path: the nip is that of the sweep before
_RTOL, _ATOL = 1e-6, 1e-4  # tolerances of the integration: relative, and absolute [K]
_RUNAWAY = 200.0  # rise over the start up to which the table extends without a steady state [K]


@dataclass(frozen=True, eq=False, repr=False)
class WarmUp(Sealed):
    """Temperatures of both rollers over time.

    Attributes
    ----------
    time : (nt,) from the start [s].
    converged, status : whether path and heat agree, and a sentence about it.
    steady : the state to which it leads.
    error : change in the last sweep [K].
    solves : number of nips that were solved.
    values : (nt, n+2) temperatures of cells and surfaces [degC].
    power : (nt,) heat of the nip [W/m].
    """

    time: Array
    converged: bool
    status: str
    steady: HeatSolution
    error: float
    solves: int
    values: Array = field(repr=False)
    power: Array = field(repr=False)

    @property
    def conduction(self) -> Conduction:
        """The cells to which the temperatures belong."""
        return self.steady.conduction

    def profile(self, side: Side, time: float) -> tuple[Array, Array]:
        """Return radii from the inside to the surface [mm] and temperatures there [degC]."""
        now = np.array([np.interp(time, self.time, column) for column in self.values.T])
        return profile(self.conduction, now, SIDES.index(side))

    def hot_spot(self, side: Side) -> Array:
        """Return the highest temperature of a roller over time, (nt,) [degC]."""
        index = SIDES.index(side)
        return np.array([profile(self.conduction, row, index)[1].max() for row in self.values])

    def surface(self, side: Side) -> Array:
        """Return the temperature of a surface over time, (nt,) [degC]."""
        return np.asarray(self.values[:, self.conduction.cells + SIDES.index(side)])

    def bond(self, side: Side) -> Array | None:
        """Return the temperature of the bond to a rigid core, (nt,) [degC]; None without a bond."""
        index = SIDES.index(side)
        rows = [bond_temperature(self.conduction, row, index) for row in self.values]
        return None if rows[0] is None else np.array(rows, dtype=float)

    @cached_property
    def half_time(self) -> float | None:
        """Time at which the hottest place has half of its final rise [s]; None if not reached."""
        hottest = np.max(self.values, axis=1)
        goal = 0.5 * (hottest[0] + float(np.max(self.steady.state.new)))
        if hottest[-1] <= goal:
            return None
        return float(np.interp(goal, hottest, self.time))


def warm_up(
    nip: Nip,
    heat: HeatBalance,
    model: Model | None = None,
    *,
    duration: float | None = None,
    steady: HeatSolution | None = None,
    cache: KernelCache | None = None,
) -> WarmUp:
    """Return the temperatures of both rollers over time, from ``heat.start``.

    Parameters
    ----------
    nip, heat, model, cache : as for `solve_heat`.
    duration : [s]; None: five times the slowest time constant of conduction.
    steady : what `solve_heat` returned for the same problem; None: it is solved here.

    Raises
    ------
    InvalidInputError
        as `solve_heat`, and where neither roller can store heat.
    ConvergenceError
        where the integration fails.
    """
    model = Model() if model is None else model
    if duration is not None:
        duration = require_positive("duration", duration)
    cache = KernelCache() if cache is None else cache
    steady = solve_heat(nip, heat, model, cache=cache) if steady is None else steady
    thermal = HeatProblem(nip, heat, model, cache)
    if thermal.conduction.cells == 0:
        raise InvalidInputError(
            "`shell` must be given for at least one roller that has no layers: without it there is "
            "nothing that could warm up."
        )
    path = _WarmingPath(thermal, steady)
    path.tabulate([path.guess(f) for f in _NODES])
    time = _times(duration, _LONG * path.slowest)
    values, change = path.integrate(time), 0.0
    converged = not thermal.follows
    for _ in range(0 if converged else _SWEEPS):
        allowed = _SHARE * model.tolerance * float(np.ptp(values))
        left = path.follow(values, _UNMOVED * allowed)
        new = path.integrate(time)
        change = max(float(np.max(np.abs(new - values))), left)
        values = new
        if change <= _SHARE * model.tolerance * float(np.ptp(values)):
            converged = True
            break
    status = (
        f"Path and heat agree to {RISE.text(max(change, 1e-9), 1)}."
        if converged
        else f"Path and heat still differ by {RISE.text(change, 2)}."
    )
    if not steady.converged:
        status += f" {steady.status}"
    return WarmUp(
        time,
        converged,
        status,
        steady,
        change,
        thermal.solves + steady.solves,
        values,
        path.power(values),
    )


def _times(duration: float | None, settled: float) -> Array:
    """Return times from 0 to a duration [s], most of them until all has nearly settled."""
    length = settled if duration is None else duration
    time = min(length, settled) * np.linspace(0.0, 1.0, _TIMES) ** 2
    if length <= settled:
        return time
    return np.concatenate([time, np.geomspace(settled, length, _LATER)[1:]])


class _WarmingPath:
    """The table of heat over theta, and the integration with it."""

    def __init__(self, thermal: HeatProblem, steady: HeatSolution) -> None:
        self.thermal, self.conduction = thermal, thermal.conduction
        heat = thermal.heat
        self.start = self.conduction.uniform(heat.ambient if heat.start is None else heat.start)
        rise = steady.state.new - self.start
        if not steady.converged:
            shape = steady.state.rise / max(steady.state.hottest, 1e-12)
            rise = _RUNAWAY * shape
        self.goal = rise
        weights = self.conduction.capacity
        size = float(weights @ rise[:-2])
        self.weights = weights / size if abs(size) > 1e-9 * weights.sum() else 0.0 * weights
        self.nodes = np.array(_NODES)
        self.near = steady.state.solution
        self.states: list[ThermalState] = []
        self._rows: Any = None

    def guess(self, share: float) -> Array:
        """Return temperatures on the straight line to the steady state, (n+2,)."""
        return self.start + share * self.goal

    def theta(self, values: Array) -> Array:
        """Return theta of temperatures (..., n+2)."""
        return np.asarray((values[..., :-2] - self.start[:-2]) @ self.weights)

    def tabulate(self, temperatures: list[Array]) -> None:
        """Solve the nips of the table."""
        if not self.thermal.follows:
            temperatures = temperatures[:1]
        self.states = [
            self.thermal.at(one, self.thermal.divided(one, self.near, _ALLOWED))
            for one in temperatures
        ]
        self._interpolate()

    def _interpolate(self) -> None:
        from scipy.interpolate import PchipInterpolator

        rows = np.array([_packed(state) for state in self.states])
        self._rows = rows if len(rows) == 1 else PchipInterpolator(self.nodes, rows, axis=0)

    def table(self, theta: float) -> Array:
        """Return the heat of the nip at theta, in the order of `_packed`."""
        if isinstance(self._rows, np.ndarray):
            return np.asarray(self._rows[0])
        return np.asarray(self._rows(min(max(theta, 0.0), 1.0)))

    def follow(self, values: Array, unmoved: float) -> float:
        """Solve the nips of the table again at the temperatures of a path, as far as it reaches.

        A nip whose temperatures are within ``unmoved`` of those at which it was solved is kept [K].
        Returns the largest difference that is thereby left.
        """
        left = 0.0
        theta = self.theta(values)
        rising = np.maximum.accumulate(theta)
        keep = np.concatenate([[True], np.diff(rising) > 0.0])
        reached = float(rising[-1])
        for i, node in enumerate(self.nodes):
            if node > reached:
                continue
            here = np.array([np.interp(node, rising[keep], column) for column in values[keep].T])
            moved = float(np.max(np.abs(here - self.states[i].temperatures)))
            if moved <= unmoved:
                left = max(left, moved)
                continue
            self.states[i] = self.thermal.at(here, self.thermal.divided(here, self.near, _ALLOWED))
        self._interpolate()
        return left

    def power(self, values: Array) -> Array:
        """Return the heat of the nip along a path, (nt,) [W/m]."""
        rows = np.array([self.table(theta) for theta in np.atleast_1d(self.theta(values))])
        return np.asarray(rows[:, -1])

    @property
    def slowest(self) -> float:
        """Slowest time constant of conduction with the exchange of the last nip [s]."""
        matrix, _ = self.conduction.system(self.states[-1].sources.over)
        rates = np.linalg.eigvals(self._rates(matrix)).real
        return float(1.0 / np.min(np.abs(rates)))

    def _rates(self, matrix: Array) -> Array:
        """Return the Jacobian of the cells, with the surfaces eliminated, (n, n) [1/s]."""
        n = self.conduction.cells
        inner = matrix[:n, :n] - matrix[:n, n:] @ np.linalg.solve(matrix[n:, n:], matrix[n:, :n])
        return np.asarray(-inner / self.conduction.capacity[:, None])

    def integrate(self, time: Array) -> Array:
        """Return the temperatures of cells and surfaces at given times, (nt, n+2) [degC]."""
        conduction, n = self.conduction, self.conduction.cells

        def slope(_: float, cells: Array) -> Array:
            row, rise = self.row(cells), cells - conduction.ambient
            matrix, right = conduction.system(_over(row, n))
            outside = np.linalg.solve(matrix[n:, n:], right[n:] - matrix[n:, :n] @ rise)
            flow = right[:n] + row[:n] - matrix[:n, :n] @ rise - matrix[:n, n:] @ outside
            return np.asarray(flow / conduction.capacity)

        def jacobian(_: float, cells: Array) -> Array:
            return self._rates(conduction.system(_over(self.row(cells), n))[0])

        from scipy.integrate import solve_ivp

        done = solve_ivp(
            slope,
            (0.0, float(time[-1])),
            self.start[:-2],
            method="BDF",
            t_eval=time,
            jac=jacobian,
            rtol=_RTOL,
            atol=_ATOL,
        )
        if not done.success:
            raise ConvergenceError(f"The warm-up could not be integrated: {done.message}")
        return np.array([np.concatenate([cells, self._surfaces(cells)]) for cells in done.y.T])

    def _surfaces(self, cells: Array) -> Array:
        """Return the temperatures of both surfaces, which store no heat, (2,) [degC]."""
        n, ambient = self.conduction.cells, self.conduction.ambient
        matrix, right = self.conduction.system(_over(self.row(cells), n))
        outside = np.linalg.solve(matrix[n:, n:], right[n:] - matrix[n:, :n] @ (cells - ambient))
        return np.asarray(ambient + outside)

    def row(self, cells: Array) -> Array:
        """Return the heat of the nip at temperatures of the cells, in the order of `_packed`."""
        return self.table(float((cells - self.start[:-2]) @ self.weights))


def _over(row: Array, n: int) -> Exchange:
    return Exchange(row[n : n + 4].reshape(2, 2), row[n + 4 : n + 6], np.zeros(2), 0.0)


def _packed(state: ThermalState) -> Array:
    """Return sources in cells, exchange matrix, offset and power of a nip in one row."""
    over, solution = state.sources.over, state.solution
    power = (solution.dissipation_viscous or 0.0) + (solution.dissipation_friction or 0.0)
    return np.concatenate([state.sources.cells, over.matrix.ravel(), over.offset, [power]])
