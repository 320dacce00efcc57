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
from rollnip.all_orders.nearby import Nearby
from rollnip.contact.problem import MOST_ITERATIONS
from rollnip.finite import NoEquilibriumError
from rollnip.influence import KernelCache, SecondResponse
from rollnip.model import Geometry, Model
from rollnip.nip import Nip
from rollnip.rollers import Roller
from rollnip.rolling.assemble import lagged_terms
from rollnip.rolling.changes import to_come_after
from rollnip.rolling.check import surface_strain_in_nip
from rollnip.rolling.displacements import NO_SECOND_ORDER, Stretch
from rollnip.rolling.iterations import change_of, with_residual
from rollnip.rolling.lengths import grips_skin
from rollnip.rolling.mesh_solution import FailureCause, IterationFailure, MeshSolution
from rollnip.rolling.refinement import IsTooDeep
from rollnip.rolling.surfaces import PairKernels

MOST_CORRECTIONS = MOST_ITERATIONS  # with one cut-off
SMALL_CHANGE = 0.05  # change of the correction in an iteration below which that may be the last one
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
    kernels: PairKernels, nip: Nip, geometry: Geometry, half_width: float, cache: KernelCache
) -> PairKernels:
    """Return influence functions with responses of second order, for a contact of about this size.

    Unchanged in other geometries than "second". ``half_width`` in [mm].
    """
    if geometry != "second":
        return kernels

    def response(roller: Roller) -> SecondResponse | None:
        if roller.is_rigid or roller.core:
            return None
        return cache.second(roller, nip.speed, half_width)

    return replace(kernels, second_upper=response(nip.upper), second_lower=response(nip.lower))


def refine_all_orders(
    nip: Nip,
    model: Model,
    kernels: PairKernels,
    half_width: float,
    cache: KernelCache,
    is_too_deep: IsTooDeep,
    near: Nearby | None = None,
) -> tuple[PairKernels, MeshSolution]:
    """Solve a contact in the geometry "finite", by iteration of contact and correction.

    Parameters
    ----------
    kernels : influence functions without finite strain.
    half_width : first guess [mm].
    is_too_deep : tells which solutions press a layer in too far.
    near : the solution of a similar nip, from which the iteration starts if it can.

    Returns
    -------
    The influence functions with the last correction, and the solution with it. Where the iteration
    does not converge, that solution is not ``settled``, and ``failure`` says how far it got.
    """
    model = replace(model, tolerance=min(model.tolerance, ITERATION_TOLERANCE))
    if grips_skin(nip):
        kernels = replace(kernels, held=replace(NO_SECOND_ORDER, stretch=(Stretch(), Stretch())))
    second = partial(with_second_order, kernels, nip, "second", half_width, cache)
    start, latest, stage = first_contact(
        nip, model, kernels, half_width, None if grips_skin(nip) else second, is_too_deep
    )
    failure: IterationFailure | None = None
    if latest.settled and is_too_deep(latest, is_rough=True):
        failure = IterationFailure("depth", 0, inf)
    elif latest.settled and latest.figures.peak_pressure > 0.0:
        strain = surface_strain_in_nip(nip, model.geometry, latest)
        found_nearby = _from_nearby(nip, model, kernels, (half_width, strain), near, is_too_deep)
        if found_nearby is not None:
            return found_nearby
        if stage is ContactStage.COARSE and start is not kernels:
            start, latest, stage = second_contact(nip, model, second(), latest, strain)
        for cut_factor in CUT_FACTORS:
            correction = PairCorrection.of(nip, kernels, half_width, strain, cut_factor)
            found = _iterate(nip, model, (start, latest), correction, stage, is_too_deep)
            if not isinstance(found, IterationFailure):
                return found
            failure = found
            if failure.cause == "balance" and failure.iterations == 0:
                break  # the first tractions have no equilibrium, whatever the cut-off
    return start, replace(latest, settled=False, failure=failure)


def _from_nearby(
    nip: Nip,
    model: Model,
    kernels: PairKernels,
    sizes: tuple[float, float],
    near: Nearby | None,
    is_too_deep: IsTooDeep,
) -> tuple[PairKernels, MeshSolution] | None:
    """Solve by iteration from the solution of a similar nip; None where that does not succeed.

    ``sizes``: half-width of the contact [mm] and strain of its surface.
    """
    half_width, strain = sizes
    start = None if near is None else near.first_contact(nip, model, kernels, half_width)
    if near is None or start is None:
        return None
    correction = PairCorrection.of(nip, kernels, half_width, strain, bodies=near.bodies)
    found = _iterate(nip, model, start, correction, ContactStage.REFINED, is_too_deep)
    return None if isinstance(found, IterationFailure) else found


def _iterate(
    nip: Nip,
    model: Model,
    start: tuple[PairKernels, MeshSolution],
    correction: PairCorrection,
    stage: ContactStage,
    is_too_deep: IsTooDeep,
) -> tuple[PairKernels, MeshSolution] | IterationFailure:
    """Iterate contact and correction, with one cut-off.

    On a coarse mesh as long as the correction changes much, then on a refined one until the contact
    conditions are met with the correction of the solution itself. A contact that presses a layer in
    too far is not refined.

    Parameters
    ----------
    start : influence functions with the first correction, and the contact solved with it.
    correction : the finite elements.
    stage : of that contact.
    """
    kernels, latest = start
    change, restarts, mixer = inf, 0, AndersonMixer(places_by_the_edges(_edges(latest)))
    best = BestSolution[tuple[PairKernels, MeshSolution]]()
    iterations = 0
    cause: FailureCause = "iterations"
    for iteration in range(MOST_CORRECTIONS):
        try:
            new, is_full_load = correction.of_contact(latest, kernels)
        except NoEquilibriumError:
            cause, iterations = "balance", iteration
            break
        iterations = iteration + 1
        updated = replace(kernels, held=new)
        before, change = change, _change_of_terms(nip, model, updated, latest)
        if stage is ContactStage.REFINED and change < SMALL_CHANGE and is_full_load:
            checked = _with_own_correction(nip, model, updated, latest, change)
            violation, cut = checked.residual / model.tolerance, checked.cut / model.tolerance
            if best.may_stop((updated, checked), violation, change / model.tolerance, cut):
                cause = "conditions"
                break
            if iteration == 0:  # with a correction of other tractions: no measure for later ones
                best = BestSolution()
        accelerated = replace(kernels, held=mixer.mixed(kernels.held or NO_SECOND_ORDER, new))
        kernels, latest = accelerated, _holding(latest, accelerated)
        to_come = min(change, to_come_after(change, before)) / model.tolerance
        deep = stage is ContactStage.COARSE and is_too_deep(latest, is_rough=False)
        if deep and is_full_load and to_come <= NEARLY_CONVERGED:
            return accelerated, latest
        was, convergence = stage, Convergence(change, to_come if is_full_load and not deep else inf)
        found, stage = next_contact(nip, model, accelerated, latest, stage, convergence)
        may_restart = best.found is None and restarts < _MOST_RESTARTS
        if not found.settled and stage is not ContactStage.FINE and may_restart:
            restarts += 1
            kernels, found, stage = restart(nip, model, (accelerated, updated), latest)
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
    nip: Nip, model: Model, kernels: PairKernels, latest: MeshSolution, change: float
) -> MeshSolution:
    """Return a solution with its violation of the contact conditions under its own correction.

    The stretch is that of the displacements, even where another one was held. Where the conditions
    are met, they are evaluated once more with the correction before the low-pass filter; ``cut`` is
    the violation then.
    """
    assert kernels.held is not None
    own = replace(kernels, held=replace(kernels.held, stretch=None))
    checked = with_residual(nip, model, own, _holding(latest, own))
    change = largest(change, latest.geometry_change)
    checked = replace(checked, geometry_change=change, settled=True)
    if not checked.residual <= model.tolerance:
        return checked
    uncut = replace(own, held=replace(kernels.held.uncut, stretch=None))
    cut = with_residual(nip, model, uncut, _holding(checked, uncut)).residual
    return replace(checked, cut=cut)


def _holding(latest: MeshSolution, kernels: PairKernels) -> MeshSolution:
    """Return a solution whose mesh holds the correction of some influence functions."""
    return replace(latest, mesh=latest.mesh.holding(kernels))


def _change_of_terms(nip: Nip, model: Model, kernels: PairKernels, latest: MeshSolution) -> float:
    """Return by how much another correction changes the finite-strain terms of a solution.

    Relative to its first-order terms.
    """
    mesh = _holding(latest, kernels).mesh
    own = lagged_terms(nip, model.geometry, mesh, latest.state)
    return change_of(own, latest.lagged, mesh, nip, latest.state)
