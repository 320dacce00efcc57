"""Making the table of a law: the plane nips that are solved and kept for it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from functools import cache
from itertools import product
from math import isnan

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import ConvergenceError, InvalidInputError
from rollnip.face.covering import CoveringAxis, nips_of
from rollnip.face.lattice import Lattice
from rollnip.face.law import NAMES, NipLaw, traction_share
from rollnip.face.rows import NipRows, Place, Row
from rollnip.influence import KernelCache
from rollnip.model import Model
from rollnip.nip import LineLoad, Nip, Traction
from rollnip.solution import Solution
from rollnip.solver import solve

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Progress = Callable[[int, int], None]

CHECKED = ("approach", "nip_width", "peak_pressure")
"""Figures whose relative interpolation error between the nips of a table is estimated."""
_BEYOND = 1.0 - 1e-9


def nip_law(
    nip: Nip,
    model: Model,
    lattice: Lattice,
    axes: tuple[CoveringAxis, ...],
    rows: NipRows,
    progress: Progress | None = None,
    executor: Executor | None = None,
) -> NipLaw:
    """Solve the plane nips of a law, and return it.

    Loads beyond one at which a nip has no solution are left out.

    Parameters
    ----------
    nip, model : the cross-section; its load and traction are varied.
    lattice : loads and slips, and which of their nips are needed.
    axes : the coverings.
    rows : stores what is solved; what it holds already is not solved again.
    progress : called after each solve with the number solved and the total number.
    executor : solves nips in other processes; None: in this one.

    Raises
    ------
    ConvergenceError
        where too few nips could be verified for a table; the message is that of the first.
    InvalidInputError
        where a core is a half-space, whose approach is not defined in plane strain.
    """
    if nip.has_half_space:
        raise InvalidInputError(
            "`core` must be rigid for a face: over a half-space core the approach is not defined."
        )
    work = Work(model, rows, progress, executor)
    nips = nips_of(nip, axes)
    found = _usable(work, nips, _solved_up(work, nips, lattice))
    loads, slips = found.lattice.loads, found.lattice.s
    table = {}
    for i, name in enumerate(NAMES):
        figures = [
            [[work.value(one, (load, s), i) for s in slips] for load in loads] for one in nips
        ]
        values = np.where(found.lattice.asked, np.array(figures), np.nan)
        table[name] = _continued(values, loads)
    return NipLaw(
        nip, model, loads, slips, table, {}, axes,
        faults=found.faults, unsolved=found.unsolved, cells=found.lattice.cells,
        fault=found.fault, solves=work.done, rows=rows,
    )  # fmt: skip


def require_solution(nip: Nip, model: Model, place: Place, rows: NipRows) -> None:
    """Raise ConvergenceError where one nip has no verified solution, so that no table has one."""
    Work(model, rows, None, None).row(nip, place)


def _solved_up(work: Work, nips: Sequence[Nip], lattice: Lattice) -> Lattice:
    """Solve the nips of a lattice from light to heavy, and return the part that was solved.

    It ends at the first load at which no nip has a solution, after a load at which one had. Such
    nips are pressed in too far, and heavier ones even further.
    """
    has_begun, asked = False, lattice.asked
    for count, load in enumerate(lattice.loads, 1):
        wanted = [(load, s) for s in lattice.s[asked[count - 1]]]
        work.solve([(one, place) for one in nips for place in wanted], of=lattice.loads.size)
        is_solved = any(not work.fault(one, place) for one in nips for place in wanted)
        if has_begun and wanted and not is_solved:
            return lattice.part(slice(0, count), slice(0, lattice.s.size))
        has_begun = has_begun or is_solved
    return lattice


class Work:
    """Solves nips that are not kept yet, here or in other processes."""

    def __init__(
        self, model: Model, rows: NipRows, progress: Progress | None, executor: Executor | None
    ) -> None:
        self.model, self.rows = model, rows
        self.progress, self.executor = progress, executor
        self.done = 0

    def solve(self, wanted: Sequence[tuple[Nip, Place]], of: int = 1) -> None:
        """Solve the nips that are not kept yet; there are about ``of`` such sets in all."""
        missing = [one for one in wanted if self.rows.get(one[0], self.model, one[1]) is None]
        for (nip, place), row in zip(missing, self._solved(missing), strict=True):
            self.rows.keep(nip, self.model, place, row)
            self.done += 1
            if self.progress is not None:
                self.progress(self.done, max(self.done, of * len(wanted)))

    def _solved(self, missing: Sequence[tuple[Nip, Place]]) -> Iterator[Row | str]:
        if self.executor is None:
            for nip, place in missing:
                yield _row_or_fault(nip, self.model, place, self.rows.kernels)
            return
        tasks = [(nip, self.model, place) for nip, place in missing]
        yield from self.executor.map(_row_of_task, tasks, chunksize=8)

    def row(self, nip: Nip, place: Place) -> Row:
        """Return the figures of a nip; raise ConvergenceError where it has no solution."""
        self.solve([(nip, place)])
        found = self.rows.get(nip, self.model, place)
        if not isinstance(found, tuple):
            raise ConvergenceError(str(found))
        return found

    def value(self, nip: Nip, place: Place, index: int) -> float:
        """Return one figure of a nip; nan where it has no solution."""
        found = self.rows.get(nip, self.model, place)
        return found[index] if isinstance(found, tuple) else float("nan")

    def fault(self, nip: Nip, place: Place) -> str:
        """Return why a nip has no solution; empty where it has one."""
        found = self.rows.get(nip, self.model, place)
        return found if isinstance(found, str) else ""


@dataclass(frozen=True, slots=True)
class _Usable:
    """The part of a lattice of which a table can be made.

    Attributes
    ----------
    lattice : its loads and slips.
    unsolved : (m, k) which of its nips have no verified solution.
    fault : why the first of them has none.
    faults : why the loads end where they do, below and above; empty where the lattice ends.
    """

    lattice: Lattice
    unsolved: NDArray[np.bool_]
    fault: str
    faults: tuple[str, str]


def _usable(work: Work, nips: Sequence[Nip], lattice: Lattice) -> _Usable:
    """Return the largest ranges of loads and slips in which nips have solutions.

    A column of slips needs two solved nips, from which the others follow by a line; a load needs
    one. Raise ConvergenceError where this leaves too few for a table.
    """
    faults = np.array(
        [
            [next((f for one in nips if (f := work.fault(one, (load, s)))), "") for s in lattice.s]
            for load in lattice.loads
        ]
    )
    asked = lattice.asked
    faults = np.where(asked, faults, "")
    solved = asked & (faults == "")
    columns = _longest(np.count_nonzero(solved, axis=0) >= 2)
    rows = _longest(solved[:, columns].any(axis=1))
    first_fault = str(next(iter(faults[faults != ""]), ""))
    fewest = 4 if lattice.s.size > 1 else 1
    kept = solved[rows, columns]
    if kept.shape[0] < 4 or kept.shape[1] < fewest or np.any(np.count_nonzero(kept, axis=0) < 2):
        raise ConvergenceError(first_fault)

    def fault_of(row: int) -> str:
        if not 0 <= row < lattice.loads.size:
            return ""
        return str(next((one for one in faults[row] if one), ""))

    return _Usable(
        lattice.part(rows, columns),
        ~kept,
        first_fault,
        (fault_of(rows.start - 1), fault_of(rows.stop)),
    )


def _longest(wanted: NDArray[np.bool_]) -> slice:
    """Return the longest run of True."""
    best, start = slice(0, 0), 0
    for i, one in enumerate([*wanted.tolist(), False]):
        if not one:
            if i - start > best.stop - best.start:
                best = slice(start, i)
            start = i + 1
    return best


def _continued(values: Array, loads: Array) -> Array:
    """Return a figure with missing values filled along the load, (states, m, k).

    A line through the two nearest nips of the same slip fills them: in logarithms for positive
    figures, otherwise of the figure over the load.
    """
    if not np.isnan(values).any() or np.isnan(values).all():
        return values
    place = np.log(loads)
    out = values.copy()
    for state, column in product(range(values.shape[0]), range(values.shape[2])):
        row = values[state, :, column]
        good = np.flatnonzero(~np.isnan(row))
        if good.size < 2:
            continue
        by_log = bool(np.all(row[good] > 0.0))
        line = np.log(row) if by_log else row / loads
        for i in np.flatnonzero(np.isnan(row)):
            a, b = good[np.argsort(np.abs(good - i))[:2]]
            at = line[a] + (line[b] - line[a]) * (place[i] - place[a]) / (place[b] - place[a])
            out[state, i, column] = np.exp(at) if by_log else at * loads[i]
    return out


@cache
def _own_kernels() -> KernelCache:
    """Return the influence functions of a worker process."""
    return KernelCache()


def _row_of_task(task: tuple[Nip, Model, Place]) -> Row | str:
    return _row_or_fault(*task, _own_kernels())


def _row_or_fault(nip: Nip, model: Model, place: Place, kernels: KernelCache) -> Row | str:
    """Return the figures of a plane nip, or why it has no solution."""
    load, s = float(place[0]), float(place[1])
    share = float(np.clip(traction_share(np.array([s]))[0], -_BEYOND, _BEYOND))
    traction = share * nip.friction * load
    one = replace(
        nip, normal=LineLoad(load), tangential=Traction(traction), face_width=None, title=""
    )
    try:
        solution = solve(one, model, cache=kernels)
    except (ConvergenceError, InvalidInputError) as error:
        return _fault(load, traction, str(error))
    if not solution.converged:
        return _fault(load, traction, solution.status)
    return _row(solution)


def _fault(load: float, traction: float, why: str) -> str:
    return (
        f"The nip at {load:.4g} N/mm and a traction of {traction:.4g} N/mm, which the face "
        f"needs, was not solved: {why}"
    )


def _row(solution: Solution) -> Row:
    slips = sum(zone.stop - zone.start for zone in solution.zones if zone.state == "slip")
    figures = {
        "approach": solution.approach,
        "creepage": solution.creepage or 0.0,
        "nip_width": solution.nip_width,
        "slip_width": slips,
        "peak_pressure": solution.peak_pressure,
        "torque_upper": solution.torque_upper,
        "torque_lower": solution.torque_lower,
        "friction_loss": solution.dissipation_friction,
        "viscous_loss": solution.dissipation_viscous,
    }
    values = (figures[name] for name in NAMES)
    return tuple(float("nan") if value is None or isnan(value) else value for value in values)
