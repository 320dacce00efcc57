"""Finite strain of all orders with a sheet: contact and finite-element corrections by iteration.

As in a bare nip (`rollnip.all_orders`), the displacements of a surface are the linear ones
plus a correction, which is held constant while a contact is solved. With a sheet each roller has
its own tractions, the pressure and the shear of its interface, and its correction follows from
these alone. The iteration is therefore that of a bare nip, and the sheet takes no part in it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf
from typing import Generic

import numpy as np

from rollnip.all_orders.acceleration import (
    AndersonMixer,
    BestSolution,
    even_places,
    places_by_the_edges,
)
from rollnip.all_orders.contact_stages import NEARLY_CONVERGED, coarse_model
from rollnip.all_orders.corrections import PairCorrection, RollerTractions
from rollnip.all_orders.iteration import (
    CUT_FACTORS,
    ITERATION_TOLERANCE,
    MOST_CORRECTIONS,
    SMALL_CHANGE,
)
from rollnip.finite import NoEquilibriumError
from rollnip.model import Model
from rollnip.rolling import PairKernels, stretch_excess
from rollnip.rolling.changes import to_come_after
from rollnip.rolling.displacements import NO_SECOND_ORDER
from rollnip.sheet.formulation import END_TOLERANCE, FIRST_END_TOLERANCE, Formulation, IterateT
from rollnip.sheet.iterate import AnyIterate
from rollnip.sheet.powers import smooth_slip_works
from rollnip.sheet.refine import Refined, initial_elements, on_last_mesh, refine

_MOST_RESTARTS = 10  # iterations that are solved from the beginning
_COARSE = 20  # number of elements while the corrections still change


def solve_by_iteration(
    formulation: Formulation[IterateT], model: Model, kernels: PairKernels, half_width: float
) -> tuple[PairKernels, Refined[IterateT]] | None:
    """Solve the contact with a sheet together with the corrections of both rollers, by iteration.

    The iteration starts on a coarse mesh, from the linear displacements, until the remaining
    changes are small. Then the mesh is refined, and the iteration continues until the contact
    conditions are met with the corrections that follow from the solution itself. Where the
    iteration does not converge, it is repeated with fewer of the short waves.

    Returns
    -------
    The influence functions with the last corrections and the solution with them; None where there
    is no equilibrium, or zones or corrections do not converge.
    """
    model = replace(model, tolerance=min(model.tolerance, ITERATION_TOLERANCE))
    coarse = coarse_model(model)
    try:
        iterate = _begun(formulation, coarse, kernels, half_width, allowed=coarse.tolerance)
    except np.linalg.LinAlgError:
        return None
    for share in CUT_FACTORS:
        orders = PairCorrection.of(
            formulation.nip, kernels, half_width, _largest_strain(iterate), share
        )
        try:
            found = _iterate_until_settled(kernels, _Contact(formulation, model, iterate), orders)
        except (NoEquilibriumError, np.linalg.LinAlgError):
            continue
        if found is not None:
            return found
    return None


def _begun(
    formulation: Formulation[IterateT],
    model: Model,
    kernels: PairKernels,
    half_width: float,
    *,
    allowed: float = 0.0,
) -> IterateT:
    """Return a solution on a coarse mesh, without a previous one.

    ``allowed``: error of the zone ends, over the width, up to which the solution in linear geometry
    will do: first corrections need no better one.
    """
    search, count = formulation.search(model, kernels), _elements(formulation, half_width)
    iterate = search.start(half_width, count)
    if iterate.misplacement <= allowed:
        return iterate
    return search.settle_zones(iterate.zones, count, iterate, FIRST_END_TOLERANCE)


def _elements(formulation: Formulation[IterateT], half_width: float, size: float = _COARSE) -> int:
    return round(initial_elements(formulation, half_width, size))


@dataclass
class _Contact(Generic[IterateT]):
    """A contact that is solved repeatedly.

    Attributes
    ----------
    formulation, model : formulation of the sheet, and the model with the tolerance of the refined
        solution.
    iterate : the last solution.
    refined : the refined solution; None while the mesh is coarse.
    restarts : how often the search was restarted.
    """

    formulation: Formulation[IterateT]
    model: Model
    iterate: IterateT
    refined: Refined[IterateT] | None = None
    restarts: int = 0

    def solve(self, kernels: PairKernels, start: IterateT, *, refine: bool) -> None:
        """Solve with other corrections.

        Where zones do not converge, the search is restarted.

        Parameters
        ----------
        kernels : influence functions with the corrections.
        start : the last solution, with lagged terms from about these corrections.
        refine : on finer and finer meshes.
        """
        if refine:
            self._refine(kernels, start)
            return
        if self.refined is None:
            model, size, placed = coarse_model(self.model), _COARSE, FIRST_END_TOLERANCE
        else:
            model, size, placed = self.model, self.refined.count, END_TOLERANCE
        count = _elements(self.formulation, 0.5 * start.zones.width, size)
        search = self.formulation.search(model, kernels)
        found = search.settle_zones(start.zones, count, start, placed)
        if not found.settled and self.restarts < _MOST_RESTARTS:
            trailing, leading = _edges(self.iterate)
            found = _begun(self.formulation, model, kernels, 0.5 * (leading - trailing))
            self.restarts += 1
            if self.refined is not None:
                self._refine(kernels, found)
                return
        self.iterate = found

    def _refine(self, kernels: PairKernels, before: IterateT) -> None:
        half_width = 0.5 * before.zones.width
        self.refined = refine(self.formulation, self.model, kernels, half_width, before)
        self.iterate = self.refined.iterate


def _iterate_until_settled(
    kernels: PairKernels, contact: _Contact[IterateT], orders: PairCorrection
) -> tuple[PairKernels, Refined[IterateT]] | None:
    """Iterate corrections and contact; see `solve_by_iteration`."""
    formulation, tolerance, change = contact.formulation, contact.model.tolerance, inf
    past = AndersonMixer(even_places(_edges(contact.iterate)))
    least = BestSolution[tuple[PairKernels, Refined[IterateT], IterateT]]()
    for _ in range(MOST_CORRECTIONS):
        iterate, refined = contact.iterate, contact.refined
        creepage = sum(iterate.state.creepages)
        made, is_whole = orders.of_tractions(_sides(iterate), creepage, kernels.held)
        smooth = replace(kernels, held=made)
        own = formulation.with_corrections(iterate, smooth)
        before, change = change, own.change
        to_come = to_come_after(change, before) / tolerance
        if refined is not None and change < SMALL_CHANGE and is_whole:
            missed = formulation.residual_with_terms_of(iterate, own)
            found = on_last_mesh(formulation, refined, own, smooth, missed)
            if least.may_stop((smooth, found, own), found.residual / tolerance, to_come):
                break
        kernels = replace(kernels, held=past.mixed(kernels.held or NO_SECOND_ORDER, made))
        near = min(to_come, change / tolerance)
        begins = refined is None and is_whole and near <= NEARLY_CONVERGED
        if begins:
            past = AndersonMixer(places_by_the_edges(_edges(iterate)))
        contact.solve(kernels, own, refine=begins)
        if not contact.iterate.settled and contact.refined is not None:
            break
    if least.found is None:
        return None
    kernels, found, own = least.found
    assert kernels.held is not None
    uncut = formulation.with_corrections(own, replace(kernels, held=kernels.held.uncut))
    return kernels, _with_cut(found, formulation.residual_with_terms_of(own, uncut))


def _with_cut(refined: Refined[IterateT], cut: float) -> Refined[IterateT]:
    """Return a refined solution with the residual ``cut`` due to what the correction leaves out."""
    figures, ((upper, _), (lower, _)) = refined.figures, smooth_slip_works(refined.iterate)
    losses = abs(figures.friction_upper - upper), abs(figures.friction_lower - lower)
    return replace(refined, cut=cut, cut_losses=losses)


def _sides(iterate: AnyIterate) -> tuple[RollerTractions, RollerTractions]:
    """Return the tractions of the upper and of the lower roller."""
    out: list[RollerTractions] = []
    for number, (mesh, sign) in enumerate(zip(iterate.problem.meshes, (1.0, -1.0), strict=True)):
        one = iterate.state.side(number)
        out.append((mesh.fine.nodes, mesh.acting(one.pressure), sign * mesh.acting(one.shear)))
    return out[0], out[1]


def _edges(iterate: AnyIterate) -> tuple[float, float]:
    """Return the outer edges of both contacts [mm]."""
    starts, stops = zip(*(side.edges for side in iterate.zones.sides), strict=True)
    return min(starts), max(stops)


def _largest_strain(iterate: AnyIterate) -> float:
    """Return the largest surface strain in either contact, averaged over an element."""
    problem, state, most = iterate.problem, iterate.state, 0.0
    for side, mesh in enumerate(problem.meshes):
        x, u = mesh.fine.nodes[1:], mesh.finer(problem.displacements(state, side))
        strains = np.abs(stretch_excess(x, problem.nip, "finite", u)[side] / np.diff(x))
        touching = mesh.acting(state.side(side).pressure) > 0.0
        most = max(most, float(strains[touching].max(initial=0.0)))
    return most
