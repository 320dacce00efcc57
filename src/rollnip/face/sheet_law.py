"""The nip with a sheet as a law: approach, feed and torques as functions of load and tractions.

A cross-section is determined by three numbers: its line load F and the tractions T_u, T_l of both
interfaces. Here T_u stands for T_l plus the pull, tension_in - tension_out: the levers of the
shears on a curved path, by which the upper roller gives more or less than that, are left out. The
tension at the outlet is that of the sheet's table. Both tractions are measured by Carter's law of
partial slip, as in `law`,

    T/(mu F) = sign(s) (1 - (1 - |s|)^2).

Plane nips are solved at nodes of a box in (ln F, s_u, s_l). A polynomial is fitted to them by least
squares: in ln F of any degree below the number of nodes, in both s of that total degree.

A pull may require a negative tension at the inlet, which a plane nip refuses. Then both tensions
are raised by a, and the sheet has an additional strain everywhere, by its compliance c of c a. Its
speed free of tension is thereby reduced by the factor 1 + c a, by which it is increased again.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import Executor
from dataclasses import dataclass, field, replace
from functools import cache
from itertools import product
from math import log, log1p

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from rollnip._errors import ConvergenceError, InvalidInputError
from rollnip.face.law import slip_measure, traction_share
from rollnip.influence import KernelCache
from rollnip.model import Model
from rollnip.nip import LineLoad, Nip, Traction
from rollnip.sheet import SheetSolution
from rollnip.sheets import Sheet
from rollnip.solver import solve

Array = NDArray[np.float64]
Progress = Callable[[int, int], None]
Point = tuple[float, float, float]
"""ln F [N/mm], s of the upper and of the lower interface."""
Values = tuple[float, ...]
"""The figures of a cross-section as stored in the law, in the order of `SHEET_NAMES`."""

_LOGS = ("approach", "nip_width", "peak_pressure")
_RATES = ("feed_upper", "feed_lower")  # ln(1 + feed), additive in speeds
_PER_LOAD = ("torque_upper", "torque_lower", "friction_loss", "viscous_loss")
SHEET_NAMES = (*_LOGS, *_RATES, *_PER_LOAD, "slip_width")
"""Figures of the law; the slip width is that of the upper interface."""
MOST_SLIP = 0.9
"""Largest measure of slip in a box; beyond it the sheet is about to slide."""


@dataclass(frozen=True, slots=True)
class Box:
    """A range of cross-sections, and how many are solved along each edge.

    Attributes
    ----------
    low, high : (3,) bounds of ln F, s_u and s_l.
    counts : number of nodes in ln F, and in each s.
    """

    low: Array
    high: Array
    counts: tuple[int, int] = (3, 3)

    @property
    def nodes(self) -> list[Point]:
        """Chebyshev points of the box."""
        edges = []
        for i, count in enumerate((self.counts[0], self.counts[1], self.counts[1])):
            t = -np.cos(np.pi * (np.arange(count) + 0.5) / count)
            edges.append(self._middle[i] + self._half[i] * t)
        return [(float(a), float(b), float(c)) for a, b, c in product(*edges)]

    @property
    def powers(self) -> list[tuple[int, int, int]]:
        """Degrees of the polynomials of which a figure is a sum."""
        loads, slips = self.counts
        both = [(j, k) for j in range(slips) for k in range(slips - j)]
        return [(i, j, k) for i in range(loads) for j, k in both]

    def holds(self, points: Array, slack: float = 1e-3) -> bool:
        """Return whether points (3, n) lie in the box."""
        return bool(
            np.all(points >= self.low[:, None] - slack)
            and np.all(points <= self.high[:, None] + slack)
        )

    def basis(self, points: Array) -> tuple[Array, Array]:
        """Return the polynomials at points (3, n), (n, p), and their derivatives, (3, n, p).

        Outside the box they are continued as planes.
        """
        near = np.clip(points, self.low[:, None], self.high[:, None])
        t = (near - self._middle[:, None]) / self._half[:, None]
        most = max(self.counts) - 1
        slopes = chebyshev.chebder(np.eye(most + 1), axis=0) if most else np.zeros((1, 1))
        values = [chebyshev.chebvander(row, most) for row in t]
        rates = [
            chebyshev.chebvander(row, slopes.shape[0] - 1) @ slopes / half
            for row, half in zip(t, self._half, strict=True)
        ]
        powers = np.array(self.powers).T
        factors = [one[:, power] for one, power in zip(values, powers, strict=True)]
        turned = [one[:, power] for one, power in zip(rates, powers, strict=True)]
        whole = factors[0] * factors[1] * factors[2]
        by = np.array(
            [
                turned[0] * factors[1] * factors[2],
                factors[0] * turned[1] * factors[2],
                factors[0] * factors[1] * turned[2],
            ]
        )
        return whole + np.einsum("in,inp->np", points - near, by), by

    def ripple(self, log_load: Array) -> Array:
        """Return the Chebyshev polynomial in ln F that vanishes at the nodes, (n,)."""
        t = np.clip((log_load - self._middle[0]) / self._half[0], -1.0, 1.0)
        return np.asarray(np.cos(self.counts[0] * np.arccos(t)))

    @property
    def _middle(self) -> Array:
        return np.asarray(0.5 * (self.low + self.high))

    @property
    def _half(self) -> Array:
        return np.asarray(0.5 * (self.high - self.low))


@dataclass(frozen=True)
class SheetLaw:
    """A table of plane nips with a sheet.

    Attributes
    ----------
    nip, model : of the cross-section; the nip's own load, traction and pull are not used.
    box : the range that was solved.
    table : name of a figure -> (p,) its coefficient for each polynomial of the box.
    misfit : largest difference between polynomial and nodes, by figure: relative for lengths and
        pressures, absolute for feeds.
    error : differences from nips solved afresh at places of the first face, as in `FaceSolution`;
        empty until then.
    solves : number of nips that were solved, for earlier boxes too.
    kernels : influence functions.
    """

    nip: Nip
    model: Model
    box: Box
    table: Mapping[str, Array]
    misfit: Mapping[str, float]
    error: Mapping[str, float] = field(default_factory=dict)
    solves: int = 0
    kernels: KernelCache = field(default_factory=KernelCache, repr=False, compare=False)

    @property
    def frictions(self) -> tuple[float, float]:
        """Friction of the sheet on the upper and on the lower roller."""
        return self.nip.friction_on("upper"), self.nip.friction_on("lower")

    def surface(self, name: str, points: Array) -> tuple[Array, Array]:
        """Return a figure's polynomial at points (3, n), and its derivatives (3, n).

        For lengths and pressures it is the logarithm, for feeds ln(1 + feed), for torques and
        losses their ratio to the load.
        """
        whole, by = self.box.basis(points)
        return whole @ self.table[name], by @ self.table[name]

    def figure(self, name: str, points: Array) -> Array:
        """Return a figure of `SHEET_NAMES` at points (3, n), (n,)."""
        value = self.surface(name, points)[0]
        if name in _LOGS:
            return np.exp(value)
        if name in _RATES:
            return np.expm1(value)
        return np.exp(points[0]) * value if name in _PER_LOAD else value

    def tractions(self, points: Array) -> tuple[Array, Array]:
        """Return T_u and T_l at points (3, n) [N/mm]."""
        load = np.exp(points[0])
        upper, lower = self.frictions
        return (
            upper * load * traction_share(points[1]),
            lower * load * traction_share(points[2]),
        )


def sheet_law(
    nip: Nip,
    model: Model,
    box: Box,
    kernels: KernelCache,
    progress: Progress | None = None,
    executor: Executor | None = None,
) -> SheetLaw:
    """Solve the nips of a box, and return their law.

    Parameters
    ----------
    nip, model : the cross-section; its load, traction and inlet tension are varied.
    box : the range to solve.
    kernels : initial influence functions.
    progress : called after each nip with the number solved and the total number.
    executor : solves nips in other processes; None: in this one.

    Raises
    ------
    ConvergenceError
        where more than a tenth of the nips could not be verified; the message is that of the first.
    """
    nodes = box.nodes
    tasks = [(nip, model, node) for node in nodes]
    found = (
        executor.map(_values_of_task, tasks, chunksize=4)
        if executor is not None
        else (values_at(nip, model, node, kernels) for node in nodes)
    )
    rows: list[Values | str] = []
    for row in found:
        rows.append(row)
        if progress is not None:
            progress(len(rows), len(nodes))
    good = [i for i, row in enumerate(rows) if not isinstance(row, str)]
    if len(good) < 0.9 * len(nodes):
        raise ConvergenceError(next(row for row in rows if isinstance(row, str)))
    points = np.array([nodes[i] for i in good]).T
    values = np.array([rows[i] for i in good])
    basis = box.basis(points)[0]
    shares, *_ = np.linalg.lstsq(basis, values, rcond=None)
    off = np.max(np.abs(basis @ shares - values), axis=0)
    return SheetLaw(
        nip,
        model,
        box,
        {name: shares[:, i] for i, name in enumerate(SHEET_NAMES)},
        {name: float(off[i]) for i, name in enumerate(SHEET_NAMES) if name in _LOGS + _RATES},
        solves=len(nodes),
        kernels=kernels,
    )


def along_the_face(sheet: Sheet) -> Sheet:
    """Return a sheet whose bending stiffness is included only where that is asked for.

    A sheet that resists bending wraps the roller towards which its tension pulls it. Its figures
    change abruptly where the pull changes sign, which no polynomial of a box can follow.
    """
    return replace(sheet, bending=bool(sheet.bending))


def values_at(nip: Nip, model: Model, point: Point, kernels: KernelCache) -> Values | str:
    """Return the figures of a plane nip as stored in the law, or why it has no solution."""
    sheet = nip.sheet
    assert sheet is not None
    load = float(np.exp(point[0]))
    upper, lower = (
        nip.friction_on(side) * load * float(traction_share(np.array([s]))[0])
        for side, s in (("upper", point[1]), ("lower", point[2]))
    )
    pull = upper - lower
    raised = max(0.0, -(sheet.tension_out + pull))
    stretched = replace(
        along_the_face(sheet),
        tension_in=sheet.tension_out + pull + raised,
        tension_out=sheet.tension_out + raised,
    )
    one = replace(
        nip, normal=LineLoad(load), tangential=Traction(lower), sheet=stretched, face_width=None
    )
    try:
        solution = solve(one, model, cache=kernels)
    except (ConvergenceError, InvalidInputError) as error:
        return _fault(load, upper, lower, str(error))
    if not solution.converged:
        return _fault(load, upper, lower, solution.status)
    assert isinstance(solution, SheetSolution)
    return _row(solution, log1p(sheet.stretch_by_tension * raised))


def _row(solution: SheetSolution, faster: float) -> Values:
    load, found, approach = solution.load, solution.sheet, solution.approach
    assert approach is not None
    slips = sum(zone.stop - zone.start for zone in solution.zones if zone.state == "slip")
    lost = solution.dissipation_friction, solution.dissipation_viscous
    figures = {
        "approach": log(approach),
        "nip_width": log(solution.nip_width),
        "peak_pressure": log(solution.peak_pressure),
        "feed_upper": log1p(found.feed_upper) + faster,
        "feed_lower": log1p(found.feed_lower) + faster,
        "torque_upper": (solution.torque_upper or 0.0) / load,
        "torque_lower": (solution.torque_lower or 0.0) / load,
        "friction_loss": (lost[0] or 0.0) / load,
        "viscous_loss": (lost[1] or 0.0) / load,
        "slip_width": slips,
    }
    return tuple(float(figures[name]) for name in SHEET_NAMES)


def _fault(load: float, upper: float, lower: float, why: str) -> str:
    return (
        f"The nip at {load:.4g} N/mm, with {upper:.4g} N/mm from the upper roller to the sheet and "
        f"{lower:.4g} N/mm from it to the lower one, which the face needs, was not solved: {why}"
    )


@cache
def _own_kernels() -> KernelCache:
    """Return the influence functions of a worker process."""
    return KernelCache()


def _values_of_task(task: tuple[Nip, Model, Point]) -> Values | str:
    return values_at(*task, _own_kernels())


def point_of(solution: SheetSolution) -> Point:
    """Return the coordinates of a plane nip with a sheet in a table."""
    load, found, nip = solution.load, solution.sheet, solution.nip
    upper = slip_measure(found.traction_upper / (nip.friction_on("upper") * load))
    lower = slip_measure(found.traction_lower / (nip.friction_on("lower") * load))
    return log(load), upper, lower
