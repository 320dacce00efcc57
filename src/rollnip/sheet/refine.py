"""Sizes of mesh, finer and finer, until the estimated errors of all figures are small enough."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import inf, sqrt
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import elements_of_zones
from rollnip.model import Geometry, Model
from rollnip.nip import Creepage, LineLoad, Nip
from rollnip.rolling import Figures, PairKernels
from rollnip.rolling.round import peak_at, peak_pressure, scale_of_creepage
from rollnip.sheet.powers import SheetPowers, off_the_moments, sheet_powers, slip_works
from rollnip.sheet.search import SheetAttempt, SheetSearch, overlap, violation
from rollnip.sheet.system import frictions_of
from rollnip.sheet.zones import Zones

Array = NDArray[np.float64]

FIRST_COUNT = 20  # elements where zones are not known
_FIRST = 24  # of the first size of mesh
GROWTH = 1.6  # of the number of elements from size to size, at most
_LEAST_GROWTH = 1.25
_MORE = 1.4  # than as many elements as bring an error to the tolerance
MOST_COUNT = 260
_SAFETY, _SAFETY_OF_FIRST = 3.0, 1.5  # on estimates by the second and by the first order
_ORDER_OF_TWO = 1.5  # of errors, where only two sizes are there
_ORDERS = 5.0, 3.0  # by which earlier changes count: with the same zones, and with others
# Sizes of mesh before an error is believed, and one more with memory, as without a sheet.
FEWEST = 2
FEWEST_WITH_SLIP = 3
_MOST_FAILURES = 3  # sizes of mesh whose zones do not come to rest
_ROUGHLY, LAST_CLOSELY = 1.0, 0.03  # of the tolerance: what ends may be off on first, last sizes
_LAST_COUNT = 60  # elements beyond which ends are placed better
_ROUNDING = 1e-12
_WATCHED = 7  # of the figures: those that the tolerance is for
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
class SheetFigures:
    """Figures of a solution, or their errors.

    Attributes
    ----------
    values : (20,) in the order of `NAMES`. The tolerance is for the first seven: approach, load
        (the pressure's, less what the shears take of it), creepage, nip width, peak pressure, and
        the creepages of both interfaces. Then the tractions of both interfaces, the largest and the
        smallest tension, `SheetPowers`, the place of the highest pressure, and the largest strain
        of the sheet in size.
    """

    values: Array

    @classmethod
    def of(cls, stand: SheetAttempt, geometry: str) -> SheetFigures:
        """Return the figures of a solution."""
        problem, state = stand.problem, stand.state
        mesh = problem.mesh
        peak, place = peak_pressure(mesh.fine.nodes[1:-1], mesh.between(state.pressure))
        tension = problem.tension_at(state)
        strain = strain_at(stand)
        spent = sheet_powers(problem, geometry, state, stand.lagged)  # type: ignore[arg-type]
        weights = mesh.weights
        first = [
            state.approach,
            float(weights @ state.pressure) - stand.lagged.lean,
            state.creepage + state.creepage_lower,
            stand.zones.width,
            peak,
            state.creepage,
            state.creepage_lower,
            float(weights @ state.shear),
            float(weights @ state.shear_lower),
            largest_of(mesh.inner, tension),
            -largest_of(mesh.inner, -tension),
        ]
        widest = 1.0 if strain.max() > -strain.min() else -1.0
        last = [place, widest * largest_of(mesh.inner, widest * strain)]
        return cls(np.array([*first, *spent.array().tolist(), *last]))

    def __getattr__(self, name: str) -> float:
        if name in NAMES:
            return float(self.values[NAMES.index(name)])
        raise AttributeError(name)

    @property
    def watched(self) -> Figures:
        """Return the figures of any nip."""
        return Figures(*self.values[:5].tolist())

    @property
    def powers(self) -> SheetPowers:
        """Return torques over radii and losses."""
        return SheetPowers(*self.values[11:18].tolist())


NAMES = (
    "approach", "load", "creepage", "nip_width", "peak_pressure",
    "creepage_upper", "creepage_lower",
    "traction_upper", "traction_lower", "tension_max", "tension_min",
    "friction_upper", "friction_lower", "lost_upper", "lost_lower", "pull_upper", "pull_lower",
    "into_sheet", "peak_pressure_x", "strain_max",
)  # fmt: skip


def largest_of(x: Array, values: Array) -> float:
    """Return the largest value, between nodes too."""
    return peak_at(x, values, int(np.argmax(values)))[0]


def strain_at(stand: SheetAttempt) -> Array:
    """Return the strain of the sheet at the nodes, (n,)."""
    problem, state = stand.problem, stand.state
    sheet = problem.sheet
    tension = sheet.stretch_by_tension * problem.tension_at(state)
    return np.asarray(tension + sheet.stretch_by_pressure * state.pressure)


@dataclass(frozen=True, slots=True)
class SheetRefined:
    """The last solution, its figures and their estimated errors.

    Attributes
    ----------
    stand : the solution on the finest mesh.
    figures, errors : see `SheetFigures`; errors inf where unknown.
    residual : how badly it violates the conditions, see `violation` and `overlap`.
    count : about how many elements the mesh was to have.
    cut : how far the conditions are violated by what "finite" leaves out of its correction.
    cut_losses : how much that changes the friction loss of either side [N/mm].
    """

    stand: SheetAttempt
    figures: SheetFigures
    errors: SheetFigures
    residual: float
    count: int
    cut: float = 0.0
    cut_losses: tuple[float, float] = (0.0, 0.0)


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
    search, count = SheetSearch(nip, model, kernels), float(_FIRST)
    stand = search.begun(half_width, FIRST_COUNT) if before is None else before
    history: list[tuple[float, SheetFigures, Zones]] = []
    best: SheetRefined | None = None
    failures, fewest = 0, FEWEST + nip.is_viscoelastic
    while count <= MOST_COUNT and failures < _MOST_FAILURES:
        may_be_last = len(history) + 1 >= fewest
        closely = _closely(count) if may_be_last else _ROUGHLY
        try:
            stand = search.placed(stand.zones, round(count), stand, closely)
        except np.linalg.LinAlgError:
            failures, count = failures + 1, _next_count(count, inf)
            continue
        figures = SheetFigures.of(stand, model.geometry)
        elements = stand.problem.mesh.inner.size - 1
        here = (float(elements), figures, stand.zones)
        errors = SheetFigures(errors_between(nip, [*history, here], _ORDERS))
        latest = SheetRefined(stand, figures, errors, violation(stand), round(count))
        if stand.stands_still:
            history.append(here)
            best = latest
            if may_be_last and ratio(nip, figures, errors) <= model.tolerance:
                best = _with_overlap(latest, kernels, model.geometry)
                if best.residual <= model.tolerance:
                    return best
        else:
            best = best or latest
            failures += 1
        least = _LEAST_GROWTH * _elements(stand.zones, count)
        count = _next_count(count, ratio(nip, figures, errors) / model.tolerance)
        while count < MOST_COUNT and _elements(stand.zones, count) < least:
            count = _next_count(count, 0.0)  # short zones have their fewest elements still
    if best is None:
        raise np.linalg.LinAlgError("no size of mesh has a solution")
    return _with_overlap(best, kernels, model.geometry)


def _next_count(count: float, ratio: float) -> float:
    """Return how many elements an error ``ratio`` times too large asks for; inf: no more are left.

    As if errors were of second order in the size of the elements.
    """
    growth = min(max(_MORE * sqrt(ratio), _LEAST_GROWTH), GROWTH)
    return min(count * growth, MOST_COUNT) if _LEAST_GROWTH * count < MOST_COUNT else inf


def _elements(zones: Zones, count: float) -> int:
    """Return how many elements a mesh of some size has, apart from those that crowd."""
    return int(elements_of_zones(zones.breaks, round(count)).sum())


def _closely(count: float) -> float:
    """Return what ends may be off, of the tolerance: less on finer meshes, which claim less."""
    return LAST_CLOSELY * min(1.0, (_LAST_COUNT / count) ** 2)


def _with_overlap(refined: SheetRefined, kernels: PairKernels, geometry: Geometry) -> SheetRefined:
    """Return a solution with what it overlaps outside the contact, too."""
    checked = replace(refined, residual=residual_of(refined.stand, kernels, geometry))
    return with_errors_of_powers(checked, geometry)


def with_errors_of_powers(refined: SheetRefined, geometry: Geometry) -> SheetRefined:
    """Return a solution that claims slip along its own shear, and what torques are off its moments.

    The former has no place in its losses. Only at finite strain are moments as exact as torques.
    """
    stand = refined.stand
    problem, state = stand.problem, stand.state
    works = slip_works(problem, geometry, state, stand.lagged)
    off = np.zeros(2)
    if geometry == "finite":
        off = off_the_moments(problem, geometry, state, refined.figures.powers)
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


def residual_of(stand: SheetAttempt, kernels: PairKernels, geometry: Geometry) -> float:
    """Return how badly a solution violates its conditions, relative."""
    return max(violation(stand), overlap(stand, kernels, geometry))


def ratio(nip: Nip, figures: SheetFigures, errors: SheetFigures) -> float:
    """Return the largest relative error of the figures that the tolerance is for."""
    relative = errors.values[:_WATCHED] / scales(nip, figures)[:_WATCHED]
    if nip.has_half_space:
        relative[0] = 0.0
    worst = float(np.max(relative))
    return worst if np.isfinite(worst) else inf


def scales(nip: Nip, figures: SheetFigures) -> Array:
    """Return the sizes that errors are relative to, (20,).

    A creepage, traction, tension or loss that is zero by symmetry has no relative accuracy: each
    size is at least a part of the largest value that the figure may have.
    """
    values = np.abs(figures.values)
    load, slope = values[1], 0.5 * values[3] * nip.curvature
    carried = 0.05 * np.minimum(frictions_of(nip), 1.0)  # of either side, over the load
    work = load * slope
    viscous = [roller.is_viscoelastic for roller in (nip.upper, nip.lower)]
    out = values.copy()
    out[2] = scale_of_creepage(values[2], slope)
    out[5:7] = scale_of_creepage(max(values[5], values[6]), slope)
    out[7:9] = np.maximum(values[7:9], load * carried)
    out[9:11] = max(values[9], values[10], load * float(carried.max()))
    out[11:13] = np.maximum(values[11:13], work * carried)
    out[13:15] = np.where(viscous, np.maximum(values[13:15], 0.0025 * work), 0.0)
    out[15:18] = np.maximum(values[15:18], work)
    out[18] = values[3]
    assert nip.sheet is not None
    out[19] = max(values[19], nip.sheet.stretch_by_tension * out[9])
    return np.asarray(out)


class _Alike(Protocol):
    """Zones that can be compared with others."""

    def is_like(self, other: Any) -> bool:
        """Return whether the other zones have the same states in the same order."""
        ...


def errors_between(
    nip: Nip,
    history: Sequence[tuple[float, SheetFigures, _Alike]],
    orders: tuple[float, float] = (3.0, 3.0),
) -> Array:
    """Return the estimated errors from the changes between meshes.

    The last change counts by the second order, or the first where the changes do not shrink so
    fast; from two sizes alone, which show no order, by one between them. Two sizes may agree by
    chance, so earlier changes count too, by higher orders; but for the first size, which finds the
    zones and hardly resolves short ones, where three finer ones stand. No error is less than the
    least of such meshes in random nips.

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
    return np.asarray(np.maximum(error, floor))


SHARES_OF_MODEL: Mapping[Geometry, Array] = {
    "second": np.array(
        [
            *(1e-3, 1e-3, 1e-2, 2e-3, 1.5e-3, 1e-2, 1e-2),
            *(5e-3, 5e-3, 1e-2, 1e-2),
            *(3e-3, 3e-3, 3e-3, 3e-3, 2e-3, 2e-3, 5e-3, 7e-3, 1e-2),
        ]
    ),
    "finite": np.array(
        [
            *(3e-4, 3e-4, 5e-3, 1e-3, 3e-3, 5e-3, 5e-3),
            *(5e-3, 5e-3, 5e-3, 5e-3),
            *(2e-3, 2e-3, 3e-3, 3e-3, 2e-3, 2e-3, 5e-3, 7e-3, 5e-3),
        ]
    ),
}
"""Relative error that a geometry leaves in each figure, as for a bare nip. In "finite" figures of
30 random nips change by less than that between meshes of 24 and 64 elements."""

# With twice the finite elements under the tractions the creepage of a plate changed by 0.9 %
# (number 523 of the random sheets, with eight times its load), those of membranes by 0.14 %.
_PLATE_CREEPAGES = 2.0


def shares_of_model(geometry: Geometry, bends: bool) -> Array:
    """Return what the model's own order leaves open of each figure, over its scale, (n,)."""
    shares = SHARES_OF_MODEL.get(geometry, np.zeros(len(NAMES))).copy()
    if bends:
        at = [n for n, name in enumerate(NAMES) if name.startswith("creepage")]
        shares[at] *= _PLATE_CREEPAGES
    return shares


def traction_slope(stand: SheetAttempt) -> float:
    """Return how fast both tractions grow with the creepage, where the same nodes stick [N/mm].

    An error of the creepage at a given traction is one of the traction at a given creepage, as
    without a sheet.
    """
    tractions = []
    for creepage in (0.0, 1.0):  # the tractions are linear in it
        nip = replace(stand.problem.nip, tangential=Creepage(creepage))
        found = replace(stand.problem, nip=nip).solve(stand.state.both_states, stand.lagged)
        tractions.append(float(stand.problem.mesh.weights @ found.shear_lower))
    return abs(tractions[1] - tractions[0])
