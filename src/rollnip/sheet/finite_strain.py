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

from rollnip._largest import largest
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
    MOST_CORRECTIONS,
    with_iteration_tolerance,
)
from rollnip.finite import NoEquilibriumError
from rollnip.rolling import RollingContact, stretch_excess
from rollnip.rolling.changes import to_come_after
from rollnip.rolling.displacements import NO_SECOND_ORDER
from rollnip.sheet.formulation import END_TOLERANCE, FIRST_END_TOLERANCE, Formulation, IterateT
from rollnip.sheet.friction import SIDE_SIGNS
from rollnip.sheet.iterate import AnyIterate
from rollnip.sheet.powers import smooth_slip_works
from rollnip.sheet.refine import Refined, initial_elements, on_last_mesh, refine

_MOST_RESTARTS = 10  # iterations that are solved from the beginning
_COARSE = 20  # number of elements while the corrections still change


def solve_by_iteration(
    formulation: Formulation[IterateT], half_width: float
) -> tuple[RollingContact, Refined[IterateT]] | None:
    """Solve the contact with a sheet together with the corrections of both rollers, by iteration.

    The iteration starts on a coarse mesh, from the linear displacements, until the remaining
    changes are small. Then the mesh is refined, and the iteration continues until the contact
    conditions are met with the corrections that follow from the solution itself. Where the
    iteration does not converge, it is repeated with fewer of the short waves.

    Returns
    -------
    The contact as asked for, with the last corrections, and the solution with them; None where
    there is no equilibrium, or zones or corrections do not converge.
    """
    asked = formulation.contact.model
    contact = with_iteration_tolerance(formulation.contact)
    formulation = formulation.of(contact)
    coarse = _coarse(formulation)
    try:
        iterate = _begun(coarse, half_width, allowed=coarse.contact.tolerance)
    except np.linalg.LinAlgError:
        return None
    for cut_factor in CUT_FACTORS:
        strain = _largest_strain(iterate)
        correction = PairCorrection.of(contact.nip, contact.kernels, half_width, strain, cut_factor)
        try:
            found = _iterate(formulation, _Progress(iterate), correction)
        except (NoEquilibriumError, np.linalg.LinAlgError):
            continue
        if found is not None:
            solved, refined = found
            return solved.with_model(asked), refined
    return None


def _begun(
    formulation: Formulation[IterateT], half_width: float, *, allowed: float = 0.0
) -> IterateT:
    """Return a solution on a coarse mesh, without a previous one.

    ``allowed``: error of the zone ends, over the width, up to which the solution in linear geometry
    will do: first corrections need no better one.
    """
    search, count = formulation.search(), _elements(formulation, half_width)
    iterate = search.start(half_width, count)
    if iterate.misplacement <= allowed:
        return iterate
    return search.settle_zones(iterate.zones, count, iterate, FIRST_END_TOLERANCE)


def _elements(formulation: Formulation[IterateT], half_width: float, size: float = _COARSE) -> int:
    return round(initial_elements(formulation, half_width, size))


@dataclass
class _Progress(Generic[IterateT]):
    """How far a contact is solved whose corrections change.

    Attributes
    ----------
    iterate : the last solution.
    refined : the refined solution; None while the mesh is coarse.
    restarts : how often the search was restarted.
    """

    iterate: IterateT
    refined: Refined[IterateT] | None = None
    restarts: int = 0

    def solve(self, formulation: Formulation[IterateT], start: IterateT, *, refine: bool) -> None:
        """Solve with other corrections.

        Where zones do not converge, the search is restarted.

        Parameters
        ----------
        formulation : with the corrections.
        start : the last solution, with lagged terms from about these corrections.
        refine : on finer and finer meshes.
        """
        if refine:
            self._refine(formulation, start)
            return
        if self.refined is None:
            size, placed, solved = _COARSE, FIRST_END_TOLERANCE, _coarse(formulation)
        else:
            size, placed, solved = self.refined.count, END_TOLERANCE, formulation
        count = _elements(formulation, 0.5 * start.zones.width, size)
        found = solved.search().settle_zones(start.zones, count, start, placed)
        if not found.settled and self.restarts < _MOST_RESTARTS:
            trailing, leading = _edges(self.iterate)
            found = _begun(solved, 0.5 * (leading - trailing))
            self.restarts += 1
            if self.refined is not None:
                self._refine(formulation, found)
                return
        self.iterate = found

    def _refine(self, formulation: Formulation[IterateT], before: IterateT) -> None:
        self.refined = refine(formulation, 0.5 * before.zones.width, before)
        self.iterate = self.refined.iterate


def _coarse(formulation: Formulation[IterateT]) -> Formulation[IterateT]:
    """Return the formulation with the tolerance of a coarse contact."""
    contact = formulation.contact
    return formulation.of(contact.with_model(coarse_model(contact.model)))


def _iterate(
    formulation: Formulation[IterateT], solved: _Progress[IterateT], correction: PairCorrection
) -> tuple[RollingContact, Refined[IterateT]] | None:
    """Iterate contact and correction, with one cut-off; see `solve_by_iteration`."""
    contact, change = formulation.contact, inf
    mixer = AndersonMixer(even_places(_edges(solved.iterate)))
    best = BestSolution[tuple[Formulation[IterateT], Refined[IterateT], IterateT]]()
    tolerance = contact.tolerance
    for _ in range(MOST_CORRECTIONS):
        iterate, refined = solved.iterate, solved.refined
        creepage, held = sum(iterate.state.creepages), formulation.contact.kernels.held
        new, is_full_load = correction.of_tractions(_sides(iterate), creepage, held)
        updated = formulation.of(contact.holding(new))
        own = updated.with_corrections(iterate)
        before, change = change, own.change
        if refined is not None and is_full_load:
            violation = formulation.residual_with_terms_of(iterate, own)
            checked = on_last_mesh(updated, refined, own, violation)
            if best.may_stop(
                (updated, checked, own), checked.residual / tolerance, change / tolerance
            ):
                break
        accelerated = contact.holding(mixer.mixed(held or NO_SECOND_ORDER, new))
        formulation = formulation.of(accelerated)
        to_come = min(change, to_come_after(change, before)) / tolerance
        begins = refined is None and is_full_load and to_come <= NEARLY_CONVERGED
        if begins:
            mixer = AndersonMixer(places_by_the_edges(_edges(iterate)))
        solved.solve(formulation, own, refine=begins)
        if not solved.iterate.settled and solved.refined is not None:
            break
    if best.found is None:
        return None
    updated, checked, own = best.found
    held = updated.contact.kernels.held
    assert held is not None
    uncut = updated.of(contact.holding(held.uncut)).with_corrections(own)
    return updated.contact, _with_cut(checked, formulation.residual_with_terms_of(own, uncut))


def _with_cut(refined: Refined[IterateT], cut: float) -> Refined[IterateT]:
    """Return a refined solution with the residual ``cut`` due to what the correction leaves out."""
    figures, ((upper, _), (lower, _)) = refined.figures, smooth_slip_works(refined.iterate)
    losses = abs(figures.friction_upper - upper), abs(figures.friction_lower - lower)
    return replace(refined, cut=cut, cut_losses=losses)


def _sides(iterate: AnyIterate) -> tuple[RollerTractions, RollerTractions]:
    """Return the tractions of the upper and of the lower roller."""
    out: list[RollerTractions] = []
    for number, (mesh, sign) in enumerate(zip(iterate.problem.meshes, SIDE_SIGNS, strict=True)):
        one = iterate.state.side(number)
        out.append((mesh.fine.nodes, mesh.acting(one.pressure), sign * mesh.acting(one.shear)))
    return out[0], out[1]


def _edges(iterate: AnyIterate) -> tuple[float, float]:
    """Return the outer edges of both contacts [mm]."""
    starts, stops = zip(*(side.edges for side in iterate.zones.sides), strict=True)
    return min(starts), max(stops)


def _largest_strain(iterate: AnyIterate) -> float:
    """Return the largest surface strain in either contact, averaged over an element."""
    problem, state, parts = iterate.problem, iterate.state, []
    for side, mesh in enumerate(problem.meshes):
        x, u = mesh.fine.nodes[1:], mesh.finer(problem.displacements(state, side))
        strains = np.abs(stretch_excess(x, problem.nip, "finite", u)[side] / np.diff(x))
        touching = mesh.acting(state.side(side).pressure) > 0.0
        parts.append(float(strains[touching].max(initial=0.0)))
    return largest(*parts)
