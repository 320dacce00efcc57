"""Sizes of mesh, finer and finer, until the estimated errors of all figures are small enough."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import inf, sqrt
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from rollnip.model import Geometry, Model
from rollnip.nip import Creepage, LineLoad, Nip
from rollnip.rolling import PairKernels
from rollnip.rolling.estimates import edge_within_memory
from rollnip.rolling.surfaces import Mesh
from rollnip.sheet.figures import ALIKE, NAMES, SheetFigures, ratio, scales
from rollnip.sheet.powers import off_the_moments, slip_works
from rollnip.sheet.search import (
    FIRST_SIZE,
    SheetAttempt,
    SheetSearch,
    overlap,
    violation,
)
from rollnip.sheet.zones import Zones

Array = NDArray[np.float64]

FIRST_COUNT = 20  # elements where zones are not known
GROWTH = 1.6  # of the number of elements from size to size, at most
_LEAST_GROWTH = 1.25
_MORE = 1.4  # than as many elements as bring an error to the tolerance
MOST_COUNT = 260
_SAFETY, _SAFETY_OF_FIRST = 3.0, 1.5  # on estimates by the second and by the first order
_ORDER_OF_TWO = 1.5  # of errors, where only two sizes are there
ORDERS = 5.0, 3.0  # by which earlier changes count: with the same zones, and with others
FEWEST = 2  # sizes of mesh before an error is believed
FEWEST_WITH_SLIP = 3
_MOST_FAILURES = 3  # sizes of mesh whose zones do not settle
_ROUGHLY, LAST_CLOSELY = 1.0, 0.03  # of the tolerance: allowed error of ends on first, last sizes
_LAST_COUNT = 60  # elements beyond which ends are placed better
_ROUNDING = 1e-12
# Least error of each figure over its scale, times the square of the number of elements; measured
# on random nips against much finer meshes (tests judge others).
_LEAST = np.array(
    [
        *(0.1, 0.1, 1.0, 0.95, 0.3, 1.0, 1.0),
        *(2.0, 2.0, 4.0, 4.0),
        *(6.0, 6.0, 0.5, 0.5, 1.0, 1.0, 1.0, 8.0, 4.0),
    ]
)


@dataclass(frozen=True, slots=True)
class SheetRefined:
    """The last solution, its figures and their estimated errors.

    Attributes
    ----------
    attempt : the solution on the finest mesh.
    figures, errors : see `SheetFigures`; errors inf where unknown.
    residual : how badly it violates the conditions, see `violation` and `overlap`.
    count : about how many elements the mesh was to have.
    cut : how far the conditions are violated by what "finite" leaves out of its correction.
    cut_losses : how much that changes the friction loss of either side [N/mm].
    """

    attempt: SheetAttempt
    figures: SheetFigures
    errors: SheetFigures
    residual: float
    count: int
    cut: float = 0.0
    cut_losses: tuple[float, float] = (0.0, 0.0)


_WIDTH = NAMES.index("nip_width")
_CREEPAGES = [NAMES.index(name) for name in ("creepage", "creepage_upper", "creepage_lower")]
_BY_TRACTIONS = range(NAMES.index("traction_upper"), len(NAMES))
_Size = tuple[float, SheetFigures, Zones]  # elements, figures and zones of a size of mesh


def refine_sheet(
    nip: Nip,
    model: Model,
    kernels: PairKernels,
    half_width: float,
    before: SheetAttempt | None = None,
) -> SheetRefined:
    """Solve on ever finer meshes until the estimated errors are below the tolerance.

    Parameters
    ----------
    nip, model, kernels : the problem, how it is computed, and its influence functions.
    half_width : about that of the contact [mm].
    before : a solution to begin with; None: one of the linear geometry.

    Raises
    ------
    numpy.linalg.LinAlgError
        where no size of mesh has a solution.
    """
    search, count = SheetSearch(nip, model, kernels), float(FIRST_SIZE)
    attempt = search.begun(half_width, FIRST_COUNT) if before is None else before
    history: list[_Size] = []
    best: SheetRefined | None = None
    failures, last_count = 0, 0
    while count <= MOST_COUNT and failures < _MOST_FAILURES:
        may_be_last = len(history) + 1 >= FEWEST
        closely = _closely(count) if may_be_last else _ROUGHLY
        try:
            attempt = search.placed(attempt.zones, round(count), attempt, closely)
        except np.linalg.LinAlgError:
            failures, count = failures + 1, next_count(count, inf)
            continue
        here = _size_of(attempt, model.geometry)
        figures = here[1]
        meshes = (attempt.problem.mesh,)
        errors = estimated_errors(nip, meshes, [*history, here])
        is_near = attempt.settled and may_be_last
        if is_near and ratio(nip, figures, errors) > model.tolerance:
            history = _with_zones_of(attempt, history, search, last_count)
            errors = estimated_errors(nip, meshes, [*history, here])
        latest = SheetRefined(attempt, figures, errors, violation(attempt), round(count))
        if attempt.settled:
            history.append(here)
            best, last_count = latest, round(count)
            if may_be_last and ratio(nip, figures, errors) <= model.tolerance:
                best = _with_overlap(latest, kernels, model.geometry)
                if best.residual <= model.tolerance:
                    return best
        else:
            best = best or latest
            failures += 1
        count = next_count(count, ratio(nip, figures, errors) / model.tolerance)
    if best is None:
        raise np.linalg.LinAlgError("no size of mesh has a solution")
    return _with_overlap(best, kernels, model.geometry)


def _size_of(attempt: SheetAttempt, geometry: Geometry) -> _Size:
    """Return what the estimates of errors ask of a size of mesh."""
    elements = attempt.problem.mesh.inner.size - 1
    return float(elements), SheetFigures.of(attempt, geometry), attempt.zones


class _Alike(Protocol):
    """Zones that can be compared with others."""

    def is_like(self, other: Any) -> bool:
        """Return whether the other zones have the same states in the same order."""
        ...


def estimated_errors(
    nip: Nip, meshes: Sequence[Mesh], history: Sequence[tuple[float, SheetFigures, _Alike]]
) -> SheetFigures:
    """Return the estimated errors of a solution, the last of some sizes of mesh.

    They are those of the mesh, and what a memory does that is shorter than its elements, on which
    all sizes agree: to the width, and twice its share to a creepage that follows from a traction
    and to all that tractions make, as without a sheet.

    Parameters
    ----------
    nip, meshes : the problem, and the meshes of the last size.
    history : see `errors_between`.
    """
    errors, figures = errors_between(nip, history, ORDERS), history[-1][1]
    lag = max(edge_within_memory(nip, mesh) for mesh in meshes)
    errors[_WIDTH] += lag
    by_edges = [*_CREEPAGES[isinstance(nip.tangential, Creepage) :], *_BY_TRACTIONS]
    errors[by_edges] += 2.0 * lag / figures.nip_width * scales(nip, figures)[by_edges]
    return SheetFigures(errors)


def _with_zones_of(
    attempt: SheetAttempt, history: list[_Size], search: SheetSearch, count: int
) -> list[_Size]:
    """Return the sizes of mesh before a solution, the last of them with its zones.

    Where a solution has other zones than the sizes before, which missed them, what it changes says
    nothing of its own errors. The last size before, of ``count`` elements, is solved again,
    with nodes at the ends of these zones.
    """
    if not history or history[-1][2].is_like(attempt.zones):
        return history
    try:
        again = search.placed(attempt.zones, count, attempt, _ROUGHLY)
    except np.linalg.LinAlgError:
        return history
    if not (again.settled and again.zones.is_like(attempt.zones)):
        return history
    return [_size_of(again, search.model.geometry)]


def next_count(count: float, ratio: float, most: float = MOST_COUNT) -> float:
    """Return how many elements an error ``ratio`` times too large asks for; inf: no more are left.

    As if errors were of second order in the size of the elements. ``most``: elements of the last
    size.
    """
    growth = min(max(_MORE * sqrt(ratio), _LEAST_GROWTH), GROWTH)
    return min(count * growth, most) if _LEAST_GROWTH * count < most else inf


def _closely(count: float) -> float:
    """Return the allowed error of ends over the tolerance: less on finer meshes."""
    return LAST_CLOSELY * min(1.0, (_LAST_COUNT / count) ** 2)


def _with_overlap(refined: SheetRefined, kernels: PairKernels, geometry: Geometry) -> SheetRefined:
    """Return a solution with what it overlaps outside the contact, too."""
    checked = replace(refined, residual=residual_of(refined.attempt, kernels, geometry))
    return with_errors_of_powers(checked, geometry)


def with_errors_of_powers(refined: SheetRefined, geometry: Geometry) -> SheetRefined:
    """Return a solution that claims slip along its own shear, and errors of torques.

    The former has no place in its losses. Only at finite strain are moments as exact as torques.
    """
    attempt = refined.attempt
    problem, state = attempt.problem, attempt.state
    spent = refined.figures.powers
    pulls = spent.pull_upper, spent.pull_lower
    works = slip_works(problem, geometry, state, attempt.lagged, pulls)
    off = np.zeros(2)
    if geometry == "finite":
        off = off_the_moments(problem, geometry, state, spent)
    return replace(refined, errors=claimed_of_powers(refined.errors, works, off))


def claimed_of_powers(
    errors: SheetFigures, works: Sequence[tuple[float, float]], off: Array
) -> SheetFigures:
    """Return errors that are no less than slip along its own shear, and torques off their moments.

    ``works``, ``off``: of both sides, see `slip_works` and `off_the_moments`.
    """
    values = errors.values.copy()
    for side, (_, reversed_slip), left in zip(("upper", "lower"), works, off, strict=True):
        for name, least in (("friction", max(reversed_slip, left)), ("pull", left)):
            at = NAMES.index(f"{name}_{side}")
            values[at] = max(values[at], least)
    return SheetFigures(values)


def residual_of(attempt: SheetAttempt, kernels: PairKernels, geometry: Geometry) -> float:
    """Return how badly a solution violates its conditions, relative."""
    return max(violation(attempt), overlap(attempt, kernels, geometry))


def errors_between(
    nip: Nip,
    history: Sequence[tuple[float, SheetFigures, _Alike]],
    orders: tuple[float, float] = (3.0, 3.0),
) -> Array:
    """Return the estimated errors from the changes between meshes.

    The last change counts by the second order, or the first where the changes do not shrink so
    fast; from two sizes alone, which show no order, by one between them. Two sizes may agree by
    chance, so earlier changes count too, by higher orders; but for the first size, which finds the
    zones and hardly resolves short ones, where three finer ones stand. So may figures of one kind,
    which are given the largest error of their kind. No error is less than the least of such meshes
    in random nips.

    ``orders``: by which earlier changes count where the zones have not changed since, and where
    they have.
    """
    history = history[1:] if len(history) > FEWEST_WITH_SLIP else history
    count, figures, _ = history[-1]
    if len(history) < 2:
        return np.full(figures.values.size, inf)
    steps = [np.abs(b.values - a.values) for (_, a, _), (_, b, _) in pairwise(history)]
    ratios = [b / a for (a, _, _), (b, _, _) in pairwise(history)]
    order = np.full(figures.values.size, _ORDER_OF_TWO)
    if len(steps) > 1:
        a, b, c = (1.0 / size**2 for size, _, _ in history[-3:])
        order = np.where(steps[-1] > 1.05 * steps[-2] * (b - c) / (a - b), 1.0, 2.0)
    error = (
        steps[-1] * np.where(order > 1.0, _SAFETY, _SAFETY_OF_FIRST) / (ratios[-1] ** order - 1.0)
    )
    last = history[-1][2]
    for number, (step, grown) in enumerate(zip(steps[:-1], ratios[:-1], strict=True)):
        kept = all(zones.is_like(last) for _, _, zones in history[number:])
        left = (history[number + 1][0] / count) ** orders[0 if kept else 1]
        error = np.maximum(error, _SAFETY * step / (grown**2 - 1.0) * left)
    floor = _LEAST * scales(nip, figures) / count**2
    prescribed = 1 if isinstance(nip.normal, LineLoad) else 0
    floor[prescribed] = _ROUNDING * abs(figures.values[prescribed])
    error, sizes = np.maximum(error, floor), scales(nip, figures)
    for kind in ALIKE:
        error[kind] = sizes[kind] * np.max(error[kind] / sizes[kind])
    return np.asarray(error)


def traction_slope(attempt: SheetAttempt) -> float:
    """Return how fast both tractions grow with the creepage, where the same nodes stick [N/mm].

    An error of the creepage at a given traction is one of the traction at a given creepage, as
    without a sheet.
    """
    tractions = []
    for creepage in (0.0, 1.0):  # the tractions are linear in it
        nip = replace(attempt.problem.nip, tangential=Creepage(creepage))
        found = replace(attempt.problem, nip=nip).solve(attempt.state.both_states, attempt.lagged)
        tractions.append(float(attempt.problem.mesh.weights @ found.shear_lower))
    return abs(tractions[1] - tractions[0])
