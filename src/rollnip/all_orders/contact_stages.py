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
from rollnip.contact import NEAR_ENOUGH, Layout
from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.rolling.assemble import lagged_terms
from rollnip.rolling.changes import NEGLIGIBLE
from rollnip.rolling.check import surface_strain_in_nip
from rollnip.rolling.free_ends import (
    ENOUGH_FOR_ZONES,
    elements_without_crowding,
    is_verified,
    with_free_ends,
)
from rollnip.rolling.iterations import solve_on_mesh
from rollnip.rolling.lengths import grips_skin
from rollnip.rolling.mesh_solution import MeshSolution, error_ratio
from rollnip.rolling.placing import Placing
from rollnip.rolling.refinement import (
    BY_NODES,
    COARSE_SIZES,
    IsTooDeep,
    by_nodes,
    finer_by_nodes,
    free_ends_from_nodes,
    refine,
)
from rollnip.rolling.surfaces import PairKernels
from rollnip.rolling.zone_search import SearchState

# Violation of the contact conditions, or change of the correction, below which the iteration may
# end: over the tolerance or, if that is larger, over the violation on account of the cut-off, which
# is claimed anyway.
CONVERGED = 0.3
_COARSE_ELEMENTS = 24  # elements of a coarse contact
NEARLY_CONVERGED = 6.0  # change over the tolerance below which contacts by nodes are refined
# Tolerance of coarse contacts; also about how far a correction moves ends of zones, over the width.
_COARSE_TOLERANCE = 1e-2


SecondOrderKernels = Callable[[], PairKernels]
"""A function that returns influence functions with responses of second order."""


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
    nip: Nip,
    model: Model,
    kernels: PairKernels,
    half_width: float,
    second: SecondOrderKernels | None = None,
    is_too_deep: IsTooDeep | None = None,
) -> tuple[PairKernels, MeshSolution, ContactStage]:
    """Return the first contact of an iteration, the influence functions it has, and its stage.

    It is found node by node and then given free ends on a coarse mesh or, where that fails on all
    coarse meshes, on refined ones; where that fails, too, it stays as it was found. So do a contact
    that is too deep, and one where friction grips a stiff skin: short zones beside its edges come
    and go with the correction, and an iteration with free ends would follow them.

    The correction held is that of ``kernels`` or, with ``second``, the second order under the
    tractions found node by node. Elastic nips of a single zone do without the second order: one
    iteration leaves so little of the error of the correction that it saves none.
    """
    coarse = coarse_model(model)
    sizes = by_nodes(nip, coarse, kernels, half_width, COARSE_SIZES)
    if grips_skin(nip):
        *_, located = sizes
        return kernels, located, ContactStage.COARSE
    for located in sizes:
        layout = Layout.of(located.zones, nip.friction) if located.settled else None
        if layout is not None and is_too_deep is not None and is_too_deep(located, is_rough=True):
            return kernels, located, ContactStage.COARSE
        if layout is not None:
            held, before = kernels, located
            if second is not None and (nip.is_viscoelastic or layout.states.size > 1):
                strain = surface_strain_in_nip(nip, model.geometry, located)
                held, before = _holding_second_order(second(), located, strain)
            start = SearchState(layout, before, misplacement=1.0 / located.mesh.inner.size)
            with suppress(np.linalg.LinAlgError):
                found = Placing(nip, coarse, held).solve(start, _COARSE_ELEMENTS, zones_known=False)
                if found is not None:
                    return held, found.solution, ContactStage.COARSE
    refined = free_ends_from_nodes(nip, model, kernels, located) if located.settled else None
    if is_verified(refined, model):
        return kernels, refined, ContactStage.REFINED
    return kernels, located, ContactStage.COARSE


def second_contact(
    nip: Nip, model: Model, second: PairKernels, coarse: MeshSolution, strain: float
) -> tuple[PairKernels, MeshSolution, ContactStage]:
    """Return a contact with the second order of a coarse one held, with its stage.

    And the influence functions that hold it. What the second order leaves out is about the square
    of the ``strain`` of the coarse contact's surface. If that is little, the contact is refined at
    once, otherwise it stays coarse. Where it is not found, it is the coarse contact itself.
    """
    held, before = _holding_second_order(second, coarse, strain)
    found: MeshSolution | None
    if strain**2 <= NEAR_ENOUGH:
        found, stage = _with_free_ends(nip, model, held, before), ContactStage.REFINED
    else:
        stage = ContactStage.COARSE
        found = _with_moved_ends(nip, model, held, before, stage)
    if found is None or not found.settled:
        return held, before, ContactStage.COARSE
    return held, found, stage


def _holding_second_order(
    second: PairKernels, latest: MeshSolution, strain: float
) -> tuple[PairKernels, MeshSolution]:
    """Return influence functions that hold the second order of a solution, and it with them.

    Waves of the second order beyond the cut-off at the ``strain`` of its surface are left out.
    """
    kept = cut_factor_at(strain)
    half_width = 0.5 * latest.figures.nip_width / kept
    upper, lower = (
        None if response is None else response.fitted(half_width)
        for response in (second.second_upper, second.second_lower)
    )
    fitted = replace(second, second_upper=upper, second_lower=lower)
    fields = fitted.second_fields(latest.nodes, latest.pressure, latest.shear)
    kernels = replace(second, second_upper=None, second_lower=None, held=fields)
    return kernels, replace(latest, mesh=latest.mesh.holding(kernels))


def next_contact(
    nip: Nip,
    model: Model,
    kernels: PairKernels,
    latest: MeshSolution,
    stage: ContactStage,
    convergence: Convergence,
) -> tuple[MeshSolution, ContactStage]:
    """Solve with the next correction, on a better mesh if the correction has converged that far.

    Where there is no solution, the round returned is not ``settled``. Only a coarse contact found
    node by node goes on as it is if the better mesh fails, until the correction has converged more.
    """
    if convergence.to_come <= _change_for_better_stage(model, latest, stage):
        found, next_stage = _at_better_stage(nip, model, kernels, latest, stage)
        if found.settled or latest.has_free_ends or stage is not ContactStage.COARSE:
            return found, next_stage
    return _at_same_stage(nip, model, kernels, latest, stage, convergence.change), stage


def _change_for_better_stage(model: Model, latest: MeshSolution, stage: ContactStage) -> float:
    """Return the change of the correction, over the tolerance, below which a better mesh pays."""
    if stage is ContactStage.REFINED:
        return -inf
    if stage is ContactStage.FINE:
        return CONVERGED
    if not latest.has_free_ends:
        return NEARLY_CONVERGED
    return NEAR_ENOUGH / model.tolerance


def _at_better_stage(
    nip: Nip, model: Model, kernels: PairKernels, latest: MeshSolution, stage: ContactStage
) -> tuple[MeshSolution, ContactStage]:
    """Solve on the meshes of a better stage, with a correction that has nearly converged."""
    if latest.has_free_ends:
        found = _refined(nip, model, kernels, latest)
        return found, ContactStage.REFINED if found.has_free_ends else ContactStage.FINE
    ready: MeshSolution | None = None
    if stage is ContactStage.FINE:
        ready = free_ends_from_nodes(nip, model, kernels, latest, ENOUGH_FOR_ZONES + 1)
    if ready is not None and error_ratio(nip, ready, model.tolerance) <= 1.0:
        return ready, ContactStage.REFINED
    finer = finer_by_nodes(nip, model, kernels, latest)
    if finer is None and ready is not None:
        return ready, ContactStage.REFINED  # its errors stay too large, and are reported
    return finer or replace(latest, settled=False), ContactStage.FINE


def coarse_model(model: Model) -> Model:
    """Return the model with the tolerance of a coarse contact."""
    return replace(model, tolerance=max(model.tolerance, _COARSE_TOLERANCE))


def _refined(nip: Nip, model: Model, kernels: PairKernels, latest: MeshSolution) -> MeshSolution:
    """Refine a coarse solution with free ends; where that fails, start from its width alone."""
    found = _with_free_ends(nip, model, kernels, latest)
    return found or refine(nip, model, kernels, 0.5 * latest.figures.nip_width)


def _with_free_ends(
    nip: Nip, model: Model, kernels: PairKernels, latest: MeshSolution
) -> MeshSolution | None:
    """Return a verified solution with about the zones of a coarse one; None where there is none."""
    layout = Layout.of(latest.zones, nip.friction)
    if layout is None:
        return None
    found = with_free_ends(nip, model, kernels, layout, latest, _COARSE_TOLERANCE)
    return found if is_verified(found, model) else None


def restart(
    nip: Nip, model: Model, both: tuple[PairKernels, PairKernels], latest: MeshSolution
) -> tuple[PairKernels, MeshSolution, ContactStage]:
    """Return a first contact anew: with the accelerated correction or, if that fails, the last one.

    ``both``: influence functions with either.
    """
    half_width = 0.5 * latest.figures.nip_width
    for kernels in both if both[0].held is not both[1].held else both[:1]:
        held, found, stage = first_contact(nip, model, kernels, half_width)
        if found.settled:
            break
    return held, found, stage


def _at_same_stage(
    nip: Nip,
    model: Model,
    kernels: PairKernels,
    latest: MeshSolution,
    stage: ContactStage,
    change: float,
) -> MeshSolution:
    """Solve at the same stage with the next correction; not ``settled`` where that fails."""
    if not latest.has_free_ends:
        if change > NEAR_ENOUGH:
            half_width = 0.5 * latest.figures.nip_width
            *_, found = by_nodes(nip, model, kernels, half_width, COARSE_SIZES)
            return found
        start = latest.state.states, latest.lagged, latest.steps
        found = solve_on_mesh(nip, model, latest.mesh, start, BY_NODES, NEGLIGIBLE)
    else:
        found = _with_moved_ends(nip, model, kernels, latest, stage)
    return replace(found, error=latest.error, make_secondary_error=latest.make_secondary_error)


def _with_moved_ends(
    nip: Nip, model: Model, kernels: PairKernels, latest: MeshSolution, stage: ContactStage
) -> MeshSolution:
    """Solve with the next correction, which moves the free ends of zones.

    Nodes that crowd at a boundary layer need ends that are placed exactly, except where friction
    grips a skin: there the correction moves them by more than that.
    """
    layout, found = Layout.of(latest.zones, nip.friction), None
    if layout is not None:
        is_coarse = stage is ContactStage.COARSE
        lagged = lagged_terms(nip, model.geometry, latest.mesh, latest.state)
        search = SearchState(layout, replace(latest, lagged=lagged), misplacement=_COARSE_TOLERANCE)
        is_crowded = not grips_skin(nip) and min(map(min, latest.mesh.fine.crowding)) < 1.0
        with suppress(np.linalg.LinAlgError):
            found = Placing(nip, model, kernels).solve(
                search,
                _COARSE_ELEMENTS if is_coarse else elements_without_crowding(latest),
                zones_known=True,
                follows_correction=not is_crowded,
                may_be_last=not is_coarse,
            )
    return replace(latest if found is None else found.solution, settled=found is not None)
