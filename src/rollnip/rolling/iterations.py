"""The solution on one mesh: fixed-point iteration of the lagged terms, and the residual."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from rollnip._largest import largest
from rollnip.contact import (
    ContactProblem,
    ContactState,
    ContactZone,
    States,
    contact_zones,
)
from rollnip.contact.problem import MOST_ITERATIONS
from rollnip.rolling.assemble import LaggedTerms, contact_problem, lagged_terms
from rollnip.rolling.check import fields_between, residual
from rollnip.rolling.displacements import NO_SECOND_ORDER
from rollnip.rolling.mesh_solution import UNKNOWN_ERROR, Figures, MeshSolution, peak_on
from rollnip.rolling.neglected_slip import tolerable_slip
from rollnip.rolling.rolling_contact import RollingContact
from rollnip.rolling.surfaces import Mesh, PairKernels


def holding_second_order(contact: RollingContact, before: MeshSolution | None) -> PairKernels:
    """Return the influence functions, holding the second order of the last solution, if any.

    Those that model no second order are returned as they are. The second order is small and smooth,
    so a few updates are enough, from mesh to mesh. The last mesh is checked with its own.
    """
    kernels = contact.kernels
    if kernels.is_fixed:
        return kernels
    if before is None or not before.settled:
        return replace(kernels, held=NO_SECOND_ORDER)
    return replace(kernels, held=before.mesh.second_fields(before.state))


def own_second_order(latest: MeshSolution) -> tuple[Mesh, LaggedTerms, float]:
    """Return the mesh of a solution that holds the second order of its own tractions.

    With it come the lagged terms that follow, and their change from those of the solution,
    see `LaggedTerms.change_from`.
    """
    contact = latest.contact
    own = replace(contact.kernels, held=latest.mesh.second_fields(latest.state))
    mesh = latest.mesh.holding(own)
    lagged = lagged_terms(contact, mesh, latest.state)
    return mesh, lagged, lagged.change_from(latest.lagged, contact, mesh, latest.state)


def solve_on_mesh(
    contact: RollingContact,
    mesh: Mesh,
    start: tuple[States, LaggedTerms, int],
    solve: Callable[[ContactProblem, States], ContactState],
    settled_change: float,
    zones: tuple[ContactZone, ...] | None = None,
) -> MeshSolution:
    """Return the solution on one mesh, by fixed-point iteration of the lagged terms.

    Parameters
    ----------
    start : states, lagged terms, and the number of linear systems solved before.
    solve : solver of the contact problem with given lagged terms, from initial states.
    settled_change : change of the lagged terms at which to stop, over the tolerance.
    zones : of the solution; None: derive them from it.
    """
    states, lagged, steps = start
    change = 0.0
    reached: float | None = None  # the last traction for a torque that friction carries
    for _ in range(MOST_ITERATIONS):
        problem = contact_problem(contact, mesh, lagged)
        state = solve(problem, states)
        steps += state.steps
        if not state.settled and reached is not None and _is_far(reached, lagged, contact):
            lagged = lagged.nearer_to(reached)
            continue
        reached = lagged.traction
        if not state.settled or contact.has_no_lagged_terms:
            break
        updated = lagged_terms(contact, mesh, state)
        change = updated.change_from(lagged, contact, mesh, state)
        lagged, states = updated, state.states
        if not change > settled_change * contact.tolerance:
            break
    if zones is None:
        zones = contact_zones(problem.x, state, contact.nip.friction)
    figures = figures_of(mesh, state, zones, lagged.lean)
    is_still = change <= settled_change * contact.tolerance
    return MeshSolution(
        contact=contact,
        mesh=mesh,
        problem=problem,
        state=state,
        lagged=lagged,
        zones=zones,
        figures=figures,
        error=UNKNOWN_ERROR,
        steps=steps,
        settled=state.settled and is_still and figures.peak_pressure > 0.0,
        geometry_change=change,
    )


def _is_far(reached: float, lagged: LaggedTerms, contact: RollingContact) -> bool:
    """Return whether the traction for a torque is beyond the one reached by over the tolerance."""
    sought = lagged.traction
    return sought is not None and abs(sought - reached) > contact.tolerance * abs(sought)


def figures_of(
    mesh: Mesh, state: ContactState, zones: tuple[ContactZone, ...], lean: float
) -> Figures:
    """Return approach, load, creepage, nip width and peak pressure of a solution on a mesh."""
    peak, _ = peak_on(mesh, state.pressure)
    return Figures(
        approach=state.approach,
        load=float(mesh.weights @ state.pressure) - lean,
        creepage=state.creepage,
        nip_width=zones[-1].stop - zones[0].start if zones else 0.0,
        peak_pressure=peak,
    )


def with_residual(latest: MeshSolution) -> MeshSolution:
    """Return a solution with its residual: of the contact conditions, on more points.

    The traction bound and drift are not checked where slip is left out that changes the creepage
    within its tolerance.

    Where the second order follows the tractions, the mesh of the result holds that of its own
    tractions. The change of the lagged terms that this makes counts for `geometry_change`.
    """
    if not latest.contact.kernels.is_fixed:
        mesh, _, change = own_second_order(latest)
        change = largest(change, latest.geometry_change)
        latest = replace(latest, mesh=mesh, geometry_change=change)
    left = residual(latest, fields_between(latest), tolerable_slip(latest))
    return replace(latest, residual=left)
