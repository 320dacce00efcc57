"""What a geometry of finite strain adds to the influence functions of both rollers.

"second" adds the second order, which every mesh evaluates anew. "finite" adds all orders by finite
elements instead: what they give beyond the linear displacements is a correction, which is held
while a contact is solved and evaluated anew from its solution. In free rolling the correction is a
few hundredths of the first-order terms, and a turn leaves a twentieth of its error.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from math import inf
from typing import Generic, Literal, TypeVar

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import Layout, Safeguarded
from rollnip.finite import CUT, FiniteResponse, NoEquilibriumError
from rollnip.influence import KernelCache, SecondResponse
from rollnip.model import Geometry, Model
from rollnip.nip import Nip
from rollnip.rollers import Roller
from rollnip.rolling.assemble import second_order
from rollnip.rolling.check import surface_strain_in_nip
from rollnip.rolling.claims import skin_thickness
from rollnip.rolling.displacements import NO_SECOND_ORDER, Field, SecondFields
from rollnip.rolling.free_ends import as_cosines, with_free_ends
from rollnip.rolling.largest import largest
from rollnip.rolling.placing import Placing
from rollnip.rolling.powers import rates_of
from rollnip.rolling.refinement import refine
from rollnip.rolling.round import Ended, Round
from rollnip.rolling.search import SearchState
from rollnip.rolling.surfaces import PairKernels
from rollnip.rolling.turns import STILL, change_of, solve_on_mesh, with_residual

Array = NDArray[np.float64]
Acting = tuple[Array, Array, Array]
"""Nodes, and the pressure and the shear that act on a roller at all but the first and the last."""
_DEPTH = 5  # corrections of which a mean is taken
_COMPARED = 65  # places at which they are compared
MOST_CORRECTIONS = 30  # of the correction and the contact
_ENOUGH = 0.3  # violation of the contact conditions, or change to come, over the tolerance
SMALL = 0.1  # change of a turn from which it may be the last one
_LARGEST_RATIO = 0.9  # of changes
_FAR = 0.1  # change from which a mesh of linear elements is graded anew
MOST_AFRESH = 10  # turns that are solved from the beginning
# Of the wave numbers: with all of them turns may not come to rest beside an edge that slips at
# strains of two and more. Which cut they need is not known before; what it costs is claimed.
SHARES_KEPT = (1.0, 0.5, 0.25)
_STRAIN = 0.6  # of a surface at which waves up to half the number are kept
_COARSE = 24  # elements of the contact while its correction still changes
NEARLY = 6.0  # last change or those to come, over the tolerance: the mesh is refined now
_COARSELY = 10.0  # times the tolerance
_COARSEST = 1e-2  # at most
# Tolerance that nips with a stiff skin are solved to at least: violations of the contact conditions
# by 0.007 of the approach have changed the peak of pressure beside an edge by a half.
UNDER_SKINS = 1e-3
_EVERYWHERE = ((-inf, inf),) * 4
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


@dataclass(frozen=True)
class AllOrders:
    """Finite elements of both rollers; None for a rigid one."""

    upper: FiniteResponse | None
    lower: FiniteResponse | None

    @classmethod
    def of(cls, nip: Nip, half_width: float, strain: float, share: float = 1.0) -> AllOrders:
        """Prepare elements for a contact of about that half-width [mm] and surface strain.

        ``share``: of the wave numbers that are kept as a rule.
        """
        cut = share * CUT / (1.0 + strain / _STRAIN)

        def response(roller: Roller) -> FiniteResponse | None:
            return None if roller.is_rigid else FiniteResponse(roller, half_width, cut, nip.speed)

        return cls(response(nip.upper), response(nip.lower))

    def beyond(self, latest: Round, *, roughly: bool) -> tuple[SecondFields, SecondFields, bool]:
        """Return what all orders add to the linear displacements of a bare nip, see `under`."""
        nodes, pressure, shear = latest.nodes, latest.pressure, latest.shear
        sides = (nodes, pressure, shear), (nodes, pressure, -shear)
        return self.under(sides, latest.state.creepage, roughly=roughly)

    def under(
        self, sides: tuple[Acting, Acting], creepage: float, *, roughly: bool
    ) -> tuple[SecondFields, SecondFields, bool]:
        """Return what all orders add to the linear displacements under tractions of both rollers.

        Raises `NoEquilibriumError` where there is no equilibrium.

        Parameters
        ----------
        sides : of the upper and of the lower roller: nodes (N+1,) [mm], and pressure and shear at
            nodes[1:-1] as they act on that roller, (N-1,) [MPa].
        creepage : of the upper roller against the lower one.
        roughly : on a mesh of before as long as the contact has not moved far.

        Returns
        -------
        The correction, the same before it was smoothed, and whether it is that of the tractions
        themselves, not of some on the way to them.
        """
        functions: list[Field | None] = []
        rough: list[Field | None] = []
        lost, is_whole = [0.0, 0.0], True
        rates = rates_of("finite", creepage)
        for side, response in enumerate((self.upper, self.lower)):
            if response is None:
                functions += [None, None]
                rough += [None, None]
                continue
            functions += response.displacement(*sides[side], rates[side], roughly=roughly)
            rough += response.rough
            lost[side] = response.lost
            is_whole = is_whole and response.share == 1.0
            if not response.is_found:
                raise NoEquilibriumError
        smooth = SecondFields(
            tuple(functions), _EVERYWHERE, lost=(lost[0], lost[1]), rough=tuple(rough)
        )
        return smooth, smooth.uncut, is_whole


def refine_all_orders(
    nip: Nip, model: Model, kernels: PairKernels, half_width: float
) -> tuple[PairKernels, Round]:
    """Solve a coarse contact in turns with the correction of all orders, then refine it.

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
        for share in SHARES_KEPT:
            orders = AllOrders.of(nip, half_width, strain, share)
            found = _turns(nip, model, kernels, latest, orders, is_refined=is_refined)
            if not isinstance(found, Ended):
                return found
            ended = found
            if ended.cause == "balance":
                break
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
        shares = np.append(back, 1.0) - np.append(0.0, back)
        others = tuple(zip(shares.tolist(), self.made, strict=True))
        lost = shares @ np.array([one.lost for one in self.made])
        return replace(NO_SECOND_ORDER, others=others, lost=(float(lost[0]), float(lost[1])))


Found = TypeVar("Found")


@dataclass
class Least(Generic[Found]):
    """The solution that violates the contact conditions least, with the correction of its own.

    Attributes
    ----------
    found : that solution; None as long as all violate them by more than the tolerance.
    left : violation by the last solution, over the tolerance.
    """

    found: Found | None = None
    left: float = inf

    def is_enough(self, found: Found, left: float, to_come: float) -> bool:
        """Take in a further solution; return whether there is one from which turns need not go on.

        ``left``: violation by it, over the tolerance; ``to_come``: sum of the changes to come, over
        the tolerance.
        """
        before, self.left = self.left, left
        if left <= min(1.0, before):
            self.found = found
        return self.found is not None and (min(left, to_come) <= _ENOUGH or left > before)


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
    change, afresh, past = inf, 0, Past(even_places(_edges(latest)))
    least, turns = Least[tuple[PairKernels, Round, SecondFields]](), 0
    cause: Literal["balance", "contact", "turns"] = "turns"
    for turn in range(MOST_CORRECTIONS):
        is_coarse = not is_refined and latest.mesh.fine.values is not None
        try:
            made, rough, is_whole = orders.beyond(latest, roughly=is_coarse)
        except NoEquilibriumError:
            cause, turns = "balance", turn
            break
        turns = turn + 1
        smooth = replace(kernels, held=made)
        before, change = change, _change(nip, model, smooth, latest)
        to_come = to_come_after(change, before) / model.tolerance
        if is_refined and change < SMALL and is_whole:
            checked = with_residual(nip, model, smooth, _with(latest, smooth))
            checked = replace(checked, geometry_change=largest(change, latest.geometry_change))
            left = checked.residual / model.tolerance
            # Small changes to come are not enough: the last one is still missing in the solution.
            if least.is_enough((smooth, checked, rough), left, inf):
                break
        mixed = replace(kernels, held=past.next(kernels.held or NO_SECOND_ORDER, made))
        kernels, latest = mixed, _with(latest, mixed)
        near = min(to_come, change / model.tolerance)
        if not is_refined and is_whole and near <= (NEARLY if is_coarse else 1.0):
            found, is_refined = _refined(nip, model, mixed, latest), True
            past = Past(places_by_the_edges(_edges(latest)))
        elif is_coarse:
            found = _solved_again(nip, coarsely(model), mixed, latest, change, _COARSE)
        else:
            found = _solved_again(nip, model, mixed, latest, change, as_cosines(latest))
        if not found.stands_still and afresh < MOST_AFRESH:
            afresh += 1
            half_width = 0.5 * latest.figures.nip_width
            again = _coarse(nip, model, mixed, half_width) if is_coarse else None
            found = again or refine(nip, model, mixed, half_width)
            is_refined = is_refined or (again is None and found.mesh.fine.values is not None)
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
    nip: Nip, model: Model, kernels: PairKernels, checked: Round, rough: SecondFields
) -> tuple[PairKernels, Round]:
    """Add to a solution the violation of the contact conditions by what was cut."""
    uncut = replace(kernels, held=rough)
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
    nip: Nip, model: Model, kernels: PairKernels, latest: Round, change: float, count: int
) -> Round:
    """Solve with another correction; where that fails the round does not stand still.

    Ends of zones are placed anew if they are free, on about ``count`` elements. Otherwise the mesh
    stays, if the correction changed little: what meshes of linear elements differ in would keep
    turns going.
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
        search = SearchState(layout, latest, off=_OFF)
        try:
            placed = Placing(nip, model, kernels).placed(search, count, known=True)
        except np.linalg.LinAlgError:
            return failed
        if placed is None:
            return failed
        found = placed.before
    return replace(found, error=latest.error, further_error=latest.further_error)
