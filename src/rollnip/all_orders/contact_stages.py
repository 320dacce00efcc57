"""Contacts solved with a correction that is held, on better meshes as the correction converges.

As long as the correction changes much, a coarse contact is enough. Its zones have free ends as soon
as those are found. Under stiff foils with friction, and where free ends are not found from a guess
of the width, contact, stick and slip are sought node by node until the correction has converged;
only then their zones get free ends.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from enum import IntEnum
from math import inf

import numpy as np

from rollnip.all_orders.corrections import cut_factor_at
from rollnip.contact import NEAR_ENOUGH, solve_nodes
from rollnip.model import Model
from rollnip.rolling.assemble import lagged_terms
from rollnip.rolling.changes import NEGLIGIBLE
from rollnip.rolling.check import surface_strain_in_nip
from rollnip.rolling.displacements import SecondFields
from rollnip.rolling.free_ends import (
    ENOUGH_FOR_ZONES,
    elements_without_crowding,
    is_verified,
    with_free_ends,
)
from rollnip.rolling.iterations import solve_on_mesh
from rollnip.rolling.lengths import grips_skin
from rollnip.rolling.mesh_solution import MeshSolution
from rollnip.rolling.placing import Aim, place_ends
from rollnip.rolling.refinement import (
    SIZES,
    IsTooDeep,
    by_nodes,
    free_ends_from_nodes,
    refine,
)
from rollnip.rolling.rolling_contact import RollingContact
from rollnip.rolling.zone_solver import SearchState

# Violation of the contact conditions, or change of the correction, below which the iteration may
# end: over the tolerance or, if that is larger, over the violation on account of the cut-off, which
# is claimed anyway.
CONVERGED = 0.3
_COARSE_ELEMENTS = 24  # elements of a coarse contact
NEARLY_CONVERGED = 6.0  # change over the tolerance below which contacts by nodes are refined
# Tolerance of coarse contacts; also about how far a correction moves ends of zones, over the width.
_COARSE_TOLERANCE = 1e-2
_COARSE_SIZES = tuple(count for count in SIZES if count <= ENOUGH_FOR_ZONES)

WithSecondOrder = Callable[[], RollingContact]
"""A function that returns the contact with responses of second order."""


class ContactStage(IntEnum):
    """How accurately the contact is solved that a correction is evaluated from."""

    COARSE = 0  # few elements, with free ends or node by node
    FINE = 1  # node by node, on a fine mesh
    REFINED = 2  # with free ends, to the tolerance


@dataclass(frozen=True, slots=True)
class Convergence:
    """How far the correction has converged.

    Attributes
    ----------
    change : last change of the finite-strain terms, relative to the first-order ones.
    to_come : the smaller of that change and the sum of the changes to come, over the tolerance; inf
        where the correction is not yet that of the whole tractions.
    """

    change: float
    to_come: float


def first_contact(
    contact: RollingContact,
    half_width: float,
    second: WithSecondOrder | None = None,
    is_too_deep: IsTooDeep | None = None,
) -> tuple[MeshSolution, ContactStage]:
    """Return the first solution of an iteration, and its stage.

    It is found node by node and then given free ends on a coarse mesh or, where that fails on all
    coarse meshes, on refined ones; where that fails, too, it stays as it was found. So do a contact
    that is too deep, and one where friction grips a stiff skin: short zones beside its edges come
    and go with the correction, and an iteration with free ends would follow them.

    The correction held is that of ``contact`` or, with ``second``, the second order under the
    tractions found node by node. Elastic nips of a single zone do without the second order: one
    iteration leaves so little of the error of the correction that it saves none.
    """
    nip, coarse = contact.nip, contact.with_model(coarse_model(contact.model))
    sizes = by_nodes(coarse, half_width, _COARSE_SIZES)
    if grips_skin(nip):
        *_, located = sizes
        return located, ContactStage.COARSE
    for located in sizes:
        layout = located.layout if located.settled else None
        if layout is not None and is_too_deep is not None and is_too_deep(located, is_rough=True):
            return located, ContactStage.COARSE
        if layout is not None:
            before = located
            if second is not None and (nip.is_viscoelastic or layout.states.size > 1):
                held = _second_order_under(located, second())
                before = located.with_correction_of(coarse.holding(held))
            start = SearchState(layout, before, misplacement=1.0 / located.mesh.inner.size)
            with suppress(np.linalg.LinAlgError):
                found = place_ends(start, _COARSE_ELEMENTS, Aim.ZONES)
                if found is not None:
                    return found.solution, ContactStage.COARSE
    known = replace(located, contact=contact)  # to be solved with its own tolerance
    refined = free_ends_from_nodes(known) if located.settled else None
    if is_verified(refined):
        return refined, ContactStage.REFINED
    return located, ContactStage.COARSE


def second_contact(
    contact: RollingContact, second: RollingContact, coarse: MeshSolution
) -> tuple[MeshSolution, ContactStage]:
    """Return a solution with the second order of a coarse one held, and its stage.

    What the second order leaves out is about the square of the strain of the surface in the coarse
    one. If that is little, the contact is refined at once, otherwise it stays coarse. Where it is
    not found, the solution is the coarse one itself.

    ``second`` : the contact with responses of second order.
    """
    before = coarse.with_correction_of(contact.holding(_second_order_under(coarse, second)))
    found: MeshSolution | None
    if surface_strain_in_nip(coarse) ** 2 <= NEAR_ENOUGH:
        found, stage = _with_free_ends(before), ContactStage.REFINED
    else:
        found, stage = _with_moved_ends(before, ContactStage.COARSE), ContactStage.COARSE
    if found is None or not found.settled:
        return before, ContactStage.COARSE
    return found, stage


def _second_order_under(latest: MeshSolution, second: RollingContact) -> SecondFields:
    """Return the displacements of second order under the tractions of a solution.

    Waves of the second order beyond the cut-off at the strain of its surface are left out.
    """
    kept = cut_factor_at(surface_strain_in_nip(latest))
    half_width = 0.5 * latest.figures.nip_width / kept
    upper, lower = (
        None if response is None else response.fitted(half_width)
        for response in (second.kernels.second_upper, second.kernels.second_lower)
    )
    fitted = replace(second.kernels, second_upper=upper, second_lower=lower)
    return fitted.second_fields(latest.nodes, latest.pressure, latest.shear)


def next_contact(
    latest: MeshSolution, stage: ContactStage, convergence: Convergence
) -> tuple[MeshSolution, ContactStage]:
    """Solve with the next correction, on a better mesh if the correction has converged that far.

    ``latest`` is the last solution, with the next correction in place of its own.

    Where there is no solution, the round returned is not ``settled``. Only a coarse contact found
    node by node goes on as it is if the better mesh fails, until the correction has converged more.
    """
    if convergence.to_come <= _change_for_better_stage(latest, stage):
        found, next_stage = _at_better_stage(latest, stage)
        if found.settled or latest.has_free_ends or stage is not ContactStage.COARSE:
            return found, next_stage
    return _at_same_stage(latest, stage, convergence.change), stage


def _change_for_better_stage(latest: MeshSolution, stage: ContactStage) -> float:
    """Return the change of the correction, over the tolerance, below which a better mesh pays."""
    if stage is ContactStage.REFINED:
        return -inf
    if stage is ContactStage.FINE:
        return CONVERGED
    if not latest.has_free_ends:
        return NEARLY_CONVERGED
    return NEAR_ENOUGH / latest.contact.tolerance


def _at_better_stage(
    latest: MeshSolution, stage: ContactStage
) -> tuple[MeshSolution, ContactStage]:
    """Solve on the meshes of a better stage, with a correction that has nearly converged."""
    if latest.has_free_ends:
        found = _refined(latest)
        return found, ContactStage.REFINED if found.has_free_ends else ContactStage.FINE
    ready: MeshSolution | None = None
    if stage is ContactStage.FINE:
        ready = free_ends_from_nodes(latest, ENOUGH_FOR_ZONES + 1)
    if ready is not None and ready.error_ratio <= 1.0:
        return ready, ContactStage.REFINED
    finer = finer_by_nodes(latest)
    if finer is None and ready is not None:
        return ready, ContactStage.REFINED  # its errors stay too large, and are reported
    return finer or replace(latest, settled=False), ContactStage.FINE


def finer_by_nodes(before: MeshSolution) -> MeshSolution | None:
    """Return the solution node by node on the next finer mesh; None if there is no finer one."""
    finer = [count for count in SIZES[len(_COARSE_SIZES) :] if count > 1.3 * before.mesh.inner.size]
    return next(by_nodes(before.contact, 0.0, tuple(finer), before), None)


def coarse_model(model: Model) -> Model:
    """Return the model with the tolerance of a coarse contact."""
    return replace(model, tolerance=max(model.tolerance, _COARSE_TOLERANCE))


def _refined(latest: MeshSolution) -> MeshSolution:
    """Refine a coarse solution with free ends; where that fails, start from its width alone."""
    found = _with_free_ends(latest)
    return found or refine(latest.contact, 0.5 * latest.figures.nip_width)


def _with_free_ends(latest: MeshSolution) -> MeshSolution | None:
    """Return a verified solution with about the zones of a coarse one; None where there is none."""
    if latest.layout is None:
        return None
    found = with_free_ends(latest, latest.layout, _COARSE_TOLERANCE)
    return found if is_verified(found) else None


def restart(
    accelerated: RollingContact, updated: RollingContact, half_width: float
) -> tuple[MeshSolution, ContactStage]:
    """Return a first solution anew, with the accelerated correction, or the last if that fails."""
    found, stage = first_contact(accelerated, half_width)
    if not found.settled and accelerated.kernels.held is not updated.kernels.held:
        found, stage = first_contact(updated, half_width)
    return found, stage


def _at_same_stage(latest: MeshSolution, stage: ContactStage, change: float) -> MeshSolution:
    """Solve at the same stage with the next correction; not ``settled`` where that fails."""
    if not latest.has_free_ends:
        if change > NEAR_ENOUGH:
            half_width = 0.5 * latest.figures.nip_width
            *_, found = by_nodes(latest.contact, half_width, _COARSE_SIZES)
            return found
        start = latest.state.states, latest.lagged, latest.steps
        found = solve_on_mesh(latest.contact, latest.mesh, start, solve_nodes, NEGLIGIBLE)
    else:
        found = _with_moved_ends(latest, stage)
    return replace(found, error=latest.error, make_secondary_error=latest.make_secondary_error)


def _with_moved_ends(latest: MeshSolution, stage: ContactStage) -> MeshSolution:
    """Solve with the next correction, which moves the free ends of zones.

    Nodes that crowd at a boundary layer need ends that are placed exactly, except where friction
    grips a skin: there the correction moves them by more than that.
    """
    contact, layout, found = latest.contact, latest.layout, None
    if layout is not None:
        is_coarse = stage is ContactStage.COARSE
        lagged = lagged_terms(contact, latest.mesh, latest.state)
        search = SearchState(layout, replace(latest, lagged=lagged), misplacement=_COARSE_TOLERANCE)
        is_crowded = not grips_skin(contact.nip) and min(map(min, latest.mesh.fine.crowding)) < 1.0
        with suppress(np.linalg.LinAlgError):
            found = place_ends(
                search,
                _COARSE_ELEMENTS if is_coarse else elements_without_crowding(latest),
                Aim.ENDS if is_coarse else Aim.FIGURES,
                correction_still_changes=not is_crowded,
            )
    return replace(latest if found is None else found.solution, settled=found is not None)
