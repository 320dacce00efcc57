"""What a geometry of finite strain adds to the influence functions of both rollers.

"second" adds the second order, which every mesh evaluates anew. "finite" adds all orders by finite
elements instead: what they give beyond the linear displacements is a correction, which is held
while a contact is solved and evaluated anew from its solution. In free rolling the correction is a
few hundredths of the first-order terms, and a turn leaves a twentieth of its error.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from math import inf
from typing import Generic, Literal, TypeVar

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import Layout, Safeguarded
from rollnip.finite import NoEquilibriumError, Spline
from rollnip.influence import KernelCache, SecondResponse
from rollnip.model import Geometry, Model
from rollnip.nip import Nip
from rollnip.rollers import Roller
from rollnip.rolling.assemble import second_order
from rollnip.rolling.check import surface_strain_in_nip
from rollnip.rolling.claims import skin_thickness
from rollnip.rolling.displacements import NO_SECOND_ORDER, Field, SecondFields, WeightedSum
from rollnip.rolling.elements import EVERYWHERE, AllOrders
from rollnip.rolling.free_ends import as_cosines, with_free_ends
from rollnip.rolling.largest import largest
from rollnip.rolling.nearby import Nearby
from rollnip.rolling.placing import Placing
from rollnip.rolling.refinement import refine
from rollnip.rolling.round import Ended, Round
from rollnip.rolling.search import SearchState
from rollnip.rolling.surfaces import PairKernels
from rollnip.rolling.turns import STILL, change_of, solve_on_mesh, with_residual

Array = NDArray[np.float64]
_DEPTH = 5  # corrections of which a mean is taken
_COMPARED = 65  # places at which they are compared
MOST_CORRECTIONS = 30  # of the correction and the contact
_ENOUGH = 0.3  # violation of the contact conditions, or last change, over the tolerance
SMALL = 0.1  # change of a turn from which it may be the last one
_LARGEST_RATIO = 0.9  # of changes
_FAR = 0.1  # change from which a mesh of linear elements is graded anew
MOST_AFRESH = 10  # turns that are solved from the beginning
# Of the wave numbers: with all of them turns may not come to rest beside an edge that slips at
# strains of two and more. Which cut they need is not known before; what it costs is claimed.
SHARES_KEPT = (1.0, 0.5, 0.25)
_COARSE = 24  # elements of the contact while its correction still changes
NEARLY = 6.0  # last change or those to come, over the tolerance: the mesh is refined now
# Change, over the tolerance, from which on the mesh of a bare nip is refined: at once where the
# correction is moderate, later where a layer is viscoelastic (coarse turns are cheap then) or a
# skin needs a correction that nearly fits to find its edges.
_REFINED_FROM = 400.0
_REFINED_LATER_FROM = 50.0
_COARSELY = 10.0  # times the tolerance
_COARSEST = 1e-2  # at most
# Tolerance that nips with a stiff skin are solved to at least: violations of the contact conditions
# by 0.007 of the approach have changed the peak of pressure beside an edge by a half.
UNDER_SKINS = 1e-3
_OFF = 0.01  # of the width of the contact: how far a correction moves the ends of zones, about


def with_second_order(
    kernels: PairKernels, nip: Nip, geometry: Geometry, half_width: float, cache: KernelCache
) -> PairKernels:
    """Add the second order of finite strain, on grids fit for a contact of that size."""
    if geometry != "second":
        return kernels

    def response(roller: Roller) -> SecondResponse | None:
        if roller.is_rigid or roller.core:
            return None
        return cache.second(roller, nip.speed, half_width)

    return replace(kernels, second_upper=response(nip.upper), second_lower=response(nip.lower))


def refine_all_orders(
    nip: Nip, model: Model, kernels: PairKernels, half_width: float, near: Nearby | None = None
) -> tuple[PairKernels, Round]:
    """Solve a coarse contact in turns with the correction of all orders, then refine it.

    Where a nip much like it has been solved, turns start from that solution.

    Returns
    -------
    The influence functions with the last correction, and the solution with it. Where no equilibrium
    is found, or no contact, it does not stand still; ``ended`` tells how far turns got.
    """
    if skin_thickness(nip) > 0.0:
        model = replace(model, tolerance=min(model.tolerance, UNDER_SKINS))
    latest = _coarse(nip, model, kernels, half_width)
    is_refined = latest is None
    if latest is None:
        latest = refine(nip, model, kernels, half_width)
        is_refined = latest.mesh.fine.values is not None
    ended: Ended | None = None
    if latest.stands_still and latest.figures.peak_pressure > 0.0:
        strain = surface_strain_in_nip(nip, model.geometry, latest)
        begun = None if near is None else near.begun(nip, model, kernels, half_width)
        if near is not None and begun is not None:
            orders = AllOrders.of(nip, kernels, half_width, strain, bodies=near.bodies)
            found = _turns(nip, model, *begun, orders, is_refined=True)
            if not isinstance(found, Ended):
                return found
        for share in SHARES_KEPT:
            orders = AllOrders.of(nip, kernels, half_width, strain, share)
            found = _turns(nip, model, kernels, latest, orders, is_refined=is_refined)
            if not isinstance(found, Ended):
                return found
            ended = found
            if ended.cause == "balance" and ended.turns == 0:
                break  # the tractions to begin with have none, whatever waves are kept
    return kernels, replace(latest, stands_still=False, ended=ended)


def _coarse(nip: Nip, model: Model, kernels: PairKernels, half_width: float) -> Round | None:
    """Return a contact on a coarse mesh with free ends; None where there is none."""
    placing = Placing(nip, coarsely(model), kernels)
    try:
        stand = placing.guessed(Layout.sticking(half_width), _COARSE)
        placed = None if stand is None else placing.placed(stand, _COARSE, known=False)
    except np.linalg.LinAlgError:
        return None
    return None if placed is None else placed.before


@dataclass
class Past:
    """Corrections that contacts were solved with, and those that belong to their solutions.

    The next one is that mean of the latter for which the differences of both are smallest
    (Anderson 1965, J. ACM 12, 547-560).
    """

    x: Array
    made: list[SecondFields] = field(default_factory=list)
    off: list[Array] = field(default_factory=list)

    def next(self, held: SecondFields, made: SecondFields) -> SecondFields:
        """Return the correction to solve with next."""
        off = (made.at(self.x).four - held.at(self.x).four).ravel()
        self.made, self.off = [*self.made, made][-_DEPTH:], [*self.off, off][-_DEPTH:]
        if len(self.made) == 1:
            return made
        steps = np.diff(np.array(self.off), axis=0)
        back = np.linalg.lstsq(steps.T, off, rcond=1e-3)[0]
        return _mean(np.append(back, 1.0) - np.append(0.0, back), self.made)


def _mean(shares: Array, fields: Sequence[SecondFields]) -> SecondFields:
    """Return a weighted sum of corrections."""
    functions: list[Field | None] = []
    for several in zip(*(one.functions for one in fields), strict=True):
        splines = [f for f in several if isinstance(f, Spline)]
        functions.append(Spline.mean(shares, splines) if splines else None)
    rough: list[Field | None] = []
    for several in zip(*(one.rough for one in fields), strict=True):
        given = tuple(f for f in several if f is not None)
        rough.append(WeightedSum(tuple(shares.tolist()), given) if given else None)
    lost = shares @ np.array([one.lost for one in fields])
    both = float(lost[0]), float(lost[1])
    return SecondFields(tuple(functions), EVERYWHERE, lost=both, rough=tuple(rough))


Found = TypeVar("Found")


@dataclass
class Least(Generic[Found]):
    """The solution that violates the contact conditions least, with the correction of its own.

    Attributes
    ----------
    found : that solution; None as long as all violate them by more than the tolerance.
    left : violation by the last solution, over the tolerance.
    enough : violation from which turns need not go on, likewise.
    """

    found: Found | None = None
    left: float = inf
    enough: float = 0.3

    def is_enough(self, found: Found, left: float, to_come: float) -> bool:
        """Take in a further solution; return whether there is one from which turns need not go on.

        ``left``: violation by it, over the tolerance; ``to_come``: sum of the changes to come, over
        the tolerance.
        """
        before, self.left = self.left, left
        if left <= min(1.0, before):
            self.found = found
        return self.found is not None and (min(left, to_come) <= self.enough or left > before)


def _turns(
    nip: Nip,
    model: Model,
    kernels: PairKernels,
    latest: Round,
    orders: AllOrders,
    *,
    is_refined: bool,
) -> tuple[PairKernels, Round] | Ended:
    """Solve the contact and evaluate its correction in turns.

    First on a coarse mesh, until the changes to come are small. Then the mesh is refined, and turns
    go on until the contact conditions are met with the correction that belongs to the solution
    itself.
    """
    change, afresh, past = inf, 0, Past(places_by_the_edges(_edges(latest)))
    least = Least[tuple[PairKernels, Round]](enough=_ENOUGH)
    turns = 0
    cause: Literal["balance", "contact", "turns"] = "turns"
    waits = nip.is_viscoelastic or skin_thickness(nip) > 0.0
    moderate = _REFINED_LATER_FROM if waits else _REFINED_FROM
    for turn in range(MOST_CORRECTIONS):
        is_coarse = not is_refined and latest.mesh.fine.values is not None
        try:
            made, is_whole = orders.beyond(latest, roughly=is_coarse)
        except NoEquilibriumError:
            cause, turns = "balance", turn
            break
        turns = turn + 1
        smooth = replace(kernels, held=made)
        before, change = change, _change(nip, model, smooth, latest)
        if is_refined and change < SMALL and is_whole:
            checked = with_residual(nip, model, smooth, _with(latest, smooth))
            checked = replace(checked, geometry_change=largest(change, latest.geometry_change))
            checked = replace(checked, stands_still=True)
            left = checked.residual / model.tolerance
            if least.is_enough((smooth, checked), left, change / model.tolerance):
                break
            if turn == 0:  # of another nip's correction, later ones may well violate them more
                least = Least(enough=_ENOUGH)
        mixed = replace(kernels, held=past.next(kernels.held or NO_SECOND_ORDER, made))
        kernels, latest = mixed, _with(latest, mixed)
        near = min(change, to_come_after(change, before)) / model.tolerance
        if not is_refined and is_whole and near <= (moderate if is_coarse else 1.0):
            found, is_refined = _refined(nip, model, mixed, latest), True
            past = Past(places_by_the_edges(_edges(latest)))
        else:
            asked = coarsely(model) if is_coarse else model
            found = _solved_again(nip, asked, mixed, latest, change)
        if not found.stands_still and afresh < MOST_AFRESH:
            afresh += 1
            kernels, found = _anew(nip, model, (mixed, smooth), latest, is_coarse=is_coarse)
            is_cubic = found.mesh.fine.values is not None
            is_refined = is_refined or (found.residual < inf and is_cubic)
        if not found.stands_still:
            cause = "contact"
            break
        latest = found
    if least.found is None:
        return Ended(cause, turns, change)
    return _with_cut(nip, model, *least.found)


def coarsely(model: Model) -> Model:
    """Return the model of contacts whose correction still changes."""
    tolerance = max(model.tolerance, min(_COARSELY * model.tolerance, _COARSEST))
    return replace(model, tolerance=tolerance)


def _refined(nip: Nip, model: Model, kernels: PairKernels, latest: Round) -> Round:
    """Refine a solution with a correction that is held."""
    layout = Layout.of(latest.zones)
    if layout is not None and latest.mesh.fine.values is not None:
        found = with_free_ends(nip, model, kernels, layout, latest, _OFF).found
        if found is not None:
            return found
    return refine(nip, model, kernels, 0.5 * latest.figures.nip_width)


def _anew(
    nip: Nip, model: Model, both: tuple[PairKernels, PairKernels], latest: Round, *, is_coarse: bool
) -> tuple[PairKernels, Round]:
    """Solve from the beginning: with a mean of corrections or, if it leads astray, the last one."""
    half_width, mixed = 0.5 * latest.figures.nip_width, both[0]
    again = _coarse(nip, model, mixed, half_width) if is_coarse else None
    if again is not None:
        return mixed, again
    for kernels in both:
        found = refine(nip, model, kernels, half_width)
        if found.stands_still:
            break
    return kernels, found


def _edges(latest: Round) -> tuple[float, float]:
    return latest.zones[0].start, latest.zones[-1].stop


def even_places(edges: tuple[float, float]) -> Array:
    """Return places at which corrections are compared, at even distances.

    Dense beside the edges, the short waves there would hide what is slow to come to rest.
    """
    return np.linspace(*edges, _COMPARED)


def places_by_the_edges(edges: tuple[float, float]) -> Array:
    """Return places dense beside the edges, where last changes are."""
    start, stop = edges
    shares = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, _COMPARED))
    return np.asarray(start + (stop - start) * shares)


def _with_cut(
    nip: Nip, model: Model, kernels: PairKernels, checked: Round
) -> tuple[PairKernels, Round]:
    """Add to a solution the violation of the contact conditions by what was cut."""
    assert kernels.held is not None
    uncut = replace(kernels, held=kernels.held.uncut)
    cut = with_residual(nip, model, uncut, _with(checked, uncut)).residual
    return kernels, replace(checked, cut=cut)


def to_come_after(change: float, before: float) -> float:
    """Return the sum of all changes to come, as a geometric series; inf after the first."""
    if before == inf:
        return inf
    ratio = min(change / before, _LARGEST_RATIO) if before > 0.0 else 0.0
    return change * ratio / (1.0 - ratio)


def _with(latest: Round, kernels: PairKernels) -> Round:
    """Return a solution whose mesh has the correction of some influence functions."""
    return replace(latest, mesh=latest.mesh.holding(kernels))


def _change(nip: Nip, model: Model, kernels: PairKernels, latest: Round) -> float:
    """Return by how much a correction changes the terms of finite strain of a solution."""
    mesh = _with(latest, kernels).mesh
    own = second_order(nip, model.geometry, mesh, latest.state)
    return change_of(own, latest.second, mesh, nip, latest.state)


def _solved_again(
    nip: Nip, model: Model, kernels: PairKernels, latest: Round, change: float
) -> Round:
    """Solve with another correction; where that fails the round does not stand still.

    Free ends of zones move to where the last solution put them; nodes that crowd at a boundary
    layer need ends that are placed. A mesh of linear elements stays, if the correction changed
    little: what such meshes differ in would keep turns going.
    """
    failed = replace(latest, stands_still=False)
    if latest.mesh.fine.values is None:
        if change > _FAR:
            return failed
        start = latest.state.states, latest.second, latest.steps
        found = solve_on_mesh(nip, model, latest.mesh, start, Safeguarded(), STILL)
    else:
        layout = Layout.of(latest.zones)
        if layout is None:
            return failed
        placing = Placing(nip, model, kernels)
        second = second_order(nip, model.geometry, latest.mesh, latest.state)
        search = SearchState(layout, replace(latest, second=second), off=_OFF)
        is_crowded = min(latest.mesh.fine.crowding) < 1.0
        try:
            placed = None if is_crowded else placing.turned(search)
            if placed is None:
                placed = placing.placed(search, as_cosines(latest), known=True)
        except np.linalg.LinAlgError:
            return failed
        if placed is None:
            return failed
        found = replace(placed.before, stands_still=True)
    return replace(found, error=latest.error, further_error=latest.further_error)
