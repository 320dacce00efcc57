"""Finite strain of all orders with a sheet: the contact and both corrections, by iteration.

As in a bare nip (`rollnip.rolling.all_orders`), the displacements of a surface are the linear ones
plus a correction that is held while a contact is solved. With a sheet each roller has tractions of
its own: pressure and the shear of its interface. The correction of each follows from these alone,
so that iterations are those of a bare nip, and the sheet is no part of them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf
from typing import Generic

import numpy as np

from rollnip.finite import NoEquilibriumError
from rollnip.model import Model
from rollnip.rolling import PairKernels, stretch_excess
from rollnip.rolling.all_orders import (
    CUT_FACTORS,
    MOST_CORRECTIONS,
    SKIN_TOLERANCE,
    SMALL_CHANGE,
    AndersonMixer,
    BestSolution,
    even_places,
    places_by_the_edges,
)
from rollnip.rolling.changes import to_come_after
from rollnip.rolling.claimed_errors import skin_thickness
from rollnip.rolling.contact_stages import NEARLY_CONVERGED, coarse_model
from rollnip.rolling.corrections import PairCorrection, RollerTractions
from rollnip.rolling.displacements import NO_SECOND_ORDER
from rollnip.sheet.attempt import AnyAttempt
from rollnip.sheet.kind import CLOSELY, ROUGHLY, S, SheetKind
from rollnip.sheet.powers import smooth_works
from rollnip.sheet.refine import Refined, elements_to_begin_with, on_last_mesh, refine

_MOST_RESTARTS = 10  # iterations that are solved from the beginning
_COARSE = 20  # elements of the contact while its corrections still change


def solve_by_iteration(
    kind: SheetKind[S], model: Model, kernels: PairKernels, half_width: float
) -> tuple[PairKernels, Refined[S]] | None:
    """Solve the contact with a sheet and evaluate both corrections by iteration.

    First on a coarse mesh, from the linear displacements, until the changes to come are small. Then
    the mesh is refined, and iterations go on until the contact conditions are met with the
    corrections that belong to the solution itself. Only the first correction, under tractions that
    are far off, may be a rough one: what it lacks would be met again on the finest mesh.

    Where they do not settle, with fewer of the short waves.

    Returns
    -------
    The influence functions with the last corrections and the solution with them; None where there
    is no equilibrium, or zones or corrections do not settle.
    """
    if skin_thickness(kind.nip) > 0.0:
        model = replace(model, tolerance=min(model.tolerance, SKIN_TOLERANCE))
    try:
        attempt = _begun(kind, coarse_model(model), kernels, half_width)
    except np.linalg.LinAlgError:
        return None
    for cut_factor in CUT_FACTORS:
        correction = PairCorrection.of(
            kind.nip, kernels, half_width, _largest_strain(attempt), cut_factor
        )
        try:
            found = _iterate_until_settled(kernels, _Contact(kind, model, attempt), correction)
        except (NoEquilibriumError, np.linalg.LinAlgError):
            continue
        if found is not None:
            return found
    return None


def _begun(kind: SheetKind[S], model: Model, kernels: PairKernels, half_width: float) -> S:
    """Return a solution of a coarse contact, from no other one."""
    search = kind.search(model, kernels)
    count = round(elements_to_begin_with(kind, half_width, _COARSE))
    attempt = search.begun(half_width, count)
    return search.placed(attempt.zones, count, attempt, ROUGHLY)


@dataclass
class _Contact(Generic[S]):
    """A contact that is solved repeatedly.

    Attributes
    ----------
    kind, model : what solves it, and how accurately once it is refined.
    attempt : the last solution.
    refined : the refined one; None: the mesh is coarse still.
    restarts : how often it was restarted.
    """

    kind: SheetKind[S]
    model: Model
    attempt: S
    refined: Refined[S] | None = None
    restarts: int = 0

    def solve(self, kernels: PairKernels, *, refine: bool) -> None:
        """Solve with other corrections, from the last solution.

        Where zones do not settle, from none. ``refine``: on finer and finer meshes.
        """
        found = self.kind.holding(self.attempt, kernels)
        if refine:
            self._refine(kernels, found)
            return
        model = coarse_model(self.model) if self.refined is None else self.model
        size = _COARSE if self.refined is None else self.refined.count
        half_width = 0.5 * found.zones.width
        count = round(elements_to_begin_with(self.kind, half_width, size))
        search = self.kind.search(model, kernels)
        found = search.placed(found.zones, count, found, CLOSELY)
        if not found.settled and self.restarts < _MOST_RESTARTS:
            start, stop = _edges(self.attempt)
            found = _begun(self.kind, model, kernels, 0.5 * (stop - start))
            self.restarts += 1
            if self.refined is not None:
                self._refine(kernels, found)
                return
        self.attempt = found

    def _refine(self, kernels: PairKernels, before: S) -> None:
        half_width = 0.5 * before.zones.width
        self.refined = refine(self.kind, self.model, kernels, half_width, before)
        self.attempt = self.refined.attempt


def _iterate_until_settled(
    kernels: PairKernels, contact: _Contact[S], correction: PairCorrection
) -> tuple[PairKernels, Refined[S]] | None:
    """Iterate, see `solve_by_iteration`."""
    kind, tolerance, change = contact.kind, contact.model.tolerance, inf
    mixer = AndersonMixer(even_places(_edges(contact.attempt)))
    best = BestSolution[tuple[PairKernels, Refined[S], S]]()
    for _ in range(MOST_CORRECTIONS):
        attempt, refined = contact.attempt, contact.refined
        creepage = sum(attempt.state.creepages)
        made, is_full_load = correction.of_tractions(
            _sides(attempt), creepage, roughly=change == inf
        )
        smooth = replace(kernels, held=made)
        own = kind.holding(attempt, smooth)
        before, change = change, own.change
        to_come = to_come_after(change, before) / tolerance
        if refined is not None and change < SMALL_CHANGE and is_full_load:
            missed = kind.missed(attempt, own)
            found = on_last_mesh(kind, refined, own, smooth, missed)
            if best.may_stop((smooth, found, own), found.residual / tolerance, to_come):
                break
        kernels = replace(kernels, held=mixer.mixed(kernels.held or NO_SECOND_ORDER, made))
        near = min(to_come, change / tolerance)
        begins = refined is None and is_full_load and near <= NEARLY_CONVERGED
        if begins:
            mixer = AndersonMixer(places_by_the_edges(_edges(attempt)))
        contact.solve(kernels, refine=begins)
        if not contact.attempt.settled and contact.refined is not None:
            break
    if best.found is None:
        return None
    kernels, found, own = best.found
    assert kernels.held is not None
    uncut = kind.holding(own, replace(kernels, held=kernels.held.uncut))
    return kernels, _with_cut(found, kind.missed(own, uncut))


def _with_cut(refined: Refined[S], cut: float) -> Refined[S]:
    """Return a refined solution with what the correction leaves out."""
    figures, ((upper, _), (lower, _)) = refined.figures, smooth_works(refined.attempt)
    losses = abs(figures.friction_upper - upper), abs(figures.friction_lower - lower)
    return replace(refined, cut=cut, cut_losses=losses)


def _sides(attempt: AnyAttempt) -> tuple[RollerTractions, RollerTractions]:
    """Return the tractions of the upper and of the lower roller."""
    out: list[RollerTractions] = []
    for number, (mesh, sign) in enumerate(zip(attempt.problem.meshes, (1.0, -1.0), strict=True)):
        one = attempt.state.side(number)
        out.append((mesh.fine.nodes, mesh.acting(one.pressure), sign * mesh.acting(one.shear)))
    return out[0], out[1]


def _edges(attempt: AnyAttempt) -> tuple[float, float]:
    """Return the ends of both contacts together [mm]."""
    starts, stops = zip(*(side.edges for side in attempt.zones.sides), strict=True)
    return min(starts), max(stops)


def _largest_strain(attempt: AnyAttempt) -> float:
    """Return the largest strain of either surface in its contact, mean over an element."""
    problem, state, most = attempt.problem, attempt.state, 0.0
    for side, mesh in enumerate(problem.meshes):
        x, u = mesh.fine.nodes[1:], mesh.finer(problem.displacements(state, side))
        strains = np.abs(stretch_excess(x, problem.nip, "finite", u)[side] / np.diff(x))
        touching = mesh.acting(state.side(side).pressure) > 0.0
        most = max(most, float(strains[touching].max(initial=0.0)))
    return most
