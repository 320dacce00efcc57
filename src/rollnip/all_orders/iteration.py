"""The iteration of contact and correction, for nips without a sheet."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from math import inf

from rollnip._largest import largest
from rollnip.all_orders.acceleration import AndersonMixer, BestSolution, places_by_the_edges
from rollnip.all_orders.contact_stages import (
    NEARLY_CONVERGED,
    ContactStage,
    Convergence,
    first_contact,
    next_contact,
    restart,
    second_contact,
)
from rollnip.all_orders.corrections import PairCorrection
from rollnip.all_orders.nearby import contact_nearby
from rollnip.contact.problem import MOST_ITERATIONS
from rollnip.finite import NoEquilibriumError
from rollnip.influence import KernelCache, SecondResponse
from rollnip.rollers import Roller
from rollnip.rolling.assemble import lagged_terms
from rollnip.rolling.changes import to_come_after
from rollnip.rolling.check import surface_strain_in_nip
from rollnip.rolling.displacements import NO_SECOND_ORDER, Stretch
from rollnip.rolling.free_ends import is_verified
from rollnip.rolling.iterations import with_residual
from rollnip.rolling.lengths import grips_skin
from rollnip.rolling.mesh_solution import FailureCause, IterationFailure, MeshSolution
from rollnip.rolling.refinement import IsTooDeep
from rollnip.rolling.rolling_contact import RollingContact

MOST_CORRECTIONS = MOST_ITERATIONS  # with one cut-off
_MOST_RESTARTS = 3  # of the contact from its first mesh, with one cut-off
# Factors of the cut-off, tried in turn: beside an edge that slips at strains of two and more the
# iteration may not converge with the first. Which one it needs is not known beforehand; the error
# of the cut-off is claimed.
CUT_FACTORS = (1.0, 0.5, 0.25)
# Coarsest tolerance of the iteration, whatever the model asks for. While it converges, figures are
# off by more than the contact conditions are violated: a creepage by 0.012 where these were met to
# 0.0007, and the pressure peak beside the edge of a stiff skin by a half where they were to 0.007.
ITERATION_TOLERANCE = 1e-3


def with_second_order(
    contact: RollingContact, half_width: float, cache: KernelCache
) -> RollingContact:
    """Return a contact of about this half-width [mm] with responses of second order."""
    speed = contact.nip.speed

    def response(roller: Roller) -> SecondResponse | None:
        return None if roller.is_rigid or roller.core else cache.second(roller, speed, half_width)

    upper, lower = response(contact.nip.upper), response(contact.nip.lower)
    return replace(
        contact, kernels=replace(contact.kernels, second_upper=upper, second_lower=lower)
    )


def with_iteration_tolerance(contact: RollingContact) -> RollingContact:
    """Return the contact with a tolerance of `ITERATION_TOLERANCE` at most."""
    model = contact.model
    return contact.with_model(replace(model, tolerance=min(model.tolerance, ITERATION_TOLERANCE)))


def refine_all_orders(
    contact: RollingContact,
    half_width: float,
    cache: KernelCache,
    is_too_deep: IsTooDeep,
    near: MeshSolution | None = None,
) -> MeshSolution:
    """Solve a contact in the geometry "finite", by iteration of contact and correction.

    Parameters
    ----------
    contact : with influence functions without finite strain.
    half_width : first guess [mm].
    is_too_deep : tells which solutions press a layer in too far.
    near : the solution of a similar nip, from which the iteration starts if it can.

    Returns
    -------
    The solution with the last correction, which its contact holds. Where the iteration does not
    converge, that solution is not ``settled``, and ``failure`` says how far it got.
    """
    finer = with_iteration_tolerance(contact)
    found = _refine_to_tolerance(finer, half_width, cache, is_too_deep, near)
    return replace(found, contact=found.contact.with_model(contact.model))


def _refine_to_tolerance(
    contact: RollingContact,
    half_width: float,
    cache: KernelCache,
    is_too_deep: IsTooDeep,
    near: MeshSolution | None,
) -> MeshSolution:
    """Solve as `refine_all_orders` does, to the tolerance of the contact as it is."""
    nip = contact.nip
    if grips_skin(nip):
        contact = contact.holding(replace(NO_SECOND_ORDER, stretch=(Stretch(), Stretch())))
    second = partial(with_second_order, contact, half_width, cache)
    latest, stage = first_contact(
        contact, half_width, None if grips_skin(nip) else second, is_too_deep
    )
    failure: IterationFailure | None = None
    if latest.settled and is_too_deep(latest, is_rough=True):
        failure = IterationFailure("depth", 0, inf)
    elif latest.settled and latest.figures.peak_pressure > 0.0:
        strain = surface_strain_in_nip(latest)
        found_nearby = _from_nearby(contact, (half_width, strain), near, is_too_deep)
        if found_nearby is not None:
            return found_nearby
        holds_second_order = latest.contact.kernels is not contact.kernels
        if stage is ContactStage.COARSE and holds_second_order:
            latest, stage = second_contact(contact, second(), latest)
        for cut_factor in CUT_FACTORS:
            correction = PairCorrection.of(nip, contact.kernels, half_width, strain, cut_factor)
            found = _iterate(contact, latest, correction, stage, is_too_deep)
            if not isinstance(found, IterationFailure):
                return found
            failure = found
            if failure.cause == "balance" and failure.iterations == 0:
                break  # the first tractions have no equilibrium, whatever the cut-off
    return replace(latest, settled=False, failure=failure)


def _from_nearby(
    contact: RollingContact,
    sizes: tuple[float, float],
    near: MeshSolution | None,
    is_too_deep: IsTooDeep,
) -> MeshSolution | None:
    """Solve by iteration from the solution of a similar nip; None where that does not succeed.

    ``sizes``: half-width of the contact [mm] and strain of its surface.
    """
    half_width, strain = sizes
    start = None if near is None else contact_nearby(near, contact, half_width)
    if start is None:
        return None
    held = start.contact.kernels.held
    assert held is not None
    correction = PairCorrection.of(
        contact.nip, contact.kernels, half_width, strain, bodies=held.bodies
    )
    found = _iterate(contact, start, correction, ContactStage.REFINED, is_too_deep)
    return None if isinstance(found, IterationFailure) else found


def _iterate(
    contact: RollingContact,
    latest: MeshSolution,
    correction: PairCorrection,
    stage: ContactStage,
    is_too_deep: IsTooDeep,
) -> MeshSolution | IterationFailure:
    """Iterate contact and correction, with one cut-off.

    On a coarse mesh as long as the correction changes much, then on a refined one until the contact
    conditions are met with the correction of the solution itself. A contact that presses a layer in
    too far is not refined.

    Parameters
    ----------
    latest : the solution with the first correction.
    correction : the finite elements.
    stage : of that solution.
    """
    change, restarts, mixer = inf, 0, AndersonMixer(places_by_the_edges(_edges(latest)))
    best, tolerance = BestSolution[MeshSolution](), contact.tolerance
    iterations = 0
    cause: FailureCause = "iterations"
    for iteration in range(MOST_CORRECTIONS):
        try:
            new, is_full_load = correction.of_contact(latest)
        except NoEquilibriumError:
            cause, iterations = "balance", iteration
            break
        iterations = iteration + 1
        updated = contact.holding(new)
        before, change = change, _change_of_terms(updated, latest)
        if stage is ContactStage.REFINED and is_full_load:
            checked = _with_own_correction(updated, latest, change)
            violation, cut = checked.residual / tolerance, checked.cut / tolerance
            if best.may_stop(checked, violation, change / tolerance, cut):
                cause = "conditions"
                break
            if iteration == 0:  # with a correction of other tractions: no measure for later ones
                best = BestSolution()
        held = latest.contact.kernels.held or NO_SECOND_ORDER
        accelerated = contact.holding(mixer.mixed(held, new))
        latest = latest.with_correction_of(accelerated)
        to_come = min(change, to_come_after(change, before)) / tolerance
        deep = stage is ContactStage.COARSE and is_too_deep(latest, is_rough=False)
        if deep and is_full_load and to_come <= NEARLY_CONVERGED:
            return latest
        was, convergence = stage, Convergence(change, to_come if is_full_load and not deep else inf)
        found, stage = next_contact(latest, stage, convergence)
        may_restart = best.found is None and restarts < _MOST_RESTARTS
        if not found.settled and stage is not ContactStage.FINE and may_restart:
            restarts += 1
            found, stage = restart(accelerated, updated, 0.5 * latest.figures.nip_width)
        if not found.settled:
            cause = "contact"
            break
        # Corrections of contacts found node by node say little of those with free ends.
        goes_on = stage is was or latest.has_free_ends
        mixer = mixer if goes_on else AndersonMixer(places_by_the_edges(_edges(latest)))
        latest = found
    if best.found is None:
        return IterationFailure(cause, iterations, change)
    return best.found


def _edges(latest: MeshSolution) -> tuple[float, float]:
    return latest.zones[0].start, latest.zones[-1].stop


def _with_own_correction(
    contact: RollingContact, latest: MeshSolution, change: float
) -> MeshSolution:
    """Return a solution with its violation of the contact conditions under its own correction.

    The stretch is that of the displacements, even where another one was held. Where the conditions
    are met, they are evaluated once more with the correction before the low-pass filter; ``cut`` is
    the violation then.

    Parameters
    ----------
    contact : holding the correction of the solution.
    change : of the finite-strain terms by this correction.
    """
    held = contact.kernels.held
    assert held is not None
    own = contact.holding(replace(held, stretch=None))
    checked = with_residual(latest.with_correction_of(own))
    change = largest(change, latest.geometry_change)
    checked = replace(checked, contact=contact, geometry_change=change, settled=True)
    if not is_verified(checked):
        return checked
    uncut = contact.holding(replace(held.uncut, stretch=None))
    return replace(checked, cut=with_residual(checked.with_correction_of(uncut)).residual)


def _change_of_terms(contact: RollingContact, latest: MeshSolution) -> float:
    """Return by how much another correction changes the finite-strain terms of a solution.

    Relative to its first-order terms.
    """
    mesh = latest.mesh.holding(contact.kernels)
    own = lagged_terms(contact, mesh, latest.state)
    return own.change_from(latest.lagged, contact, mesh, latest.state)
