"""Contacts with a correction of all orders that is held, on ever better meshes.

While the correction changes much, a coarse contact is enough. Under stiff foils with friction, and
where one with free ends is not found from a guess of the width, contact, stick and slip are sought
node by node until the correction has settled; only then free ends take over the zones.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from enum import IntEnum
from math import inf

import numpy as np

from rollnip.contact import Layout
from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.rolling.assemble import second_order
from rollnip.rolling.check import surface_strain_in_nip
from rollnip.rolling.claimed_errors import grips_skin
from rollnip.rolling.elements import share_of_waves
from rollnip.rolling.free_ends import elements_without_crowding, is_verified, with_free_ends
from rollnip.rolling.iterations import NEGLIGIBLE, solve_on_mesh
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
from rollnip.rolling.search import NEAR_ENOUGH, SearchState
from rollnip.rolling.surfaces import PairKernels

# Violation of the contact conditions, or last change, from which iterations need not go on: over
# the tolerance, or over the violation by what is cut, which the solution says that it leaves open.
ENOUGH = 0.3
_COARSE = 24  # elements of the contact while its correction still changes
NEARLY = 6.0  # last change or those to come, over the tolerance: the mesh is refined now
# Tolerance of such contacts, and about how far a correction moves ends of zones, over the width.
_COARSELY = 1e-2


Responses = Callable[[], PairKernels]
"""Influence functions with responses of second order."""


class Stage(IntEnum):
    """How good a contact is that a correction is evaluated from."""

    COARSE = 0
    FINE = 1  # sought node by node, on a fine mesh
    REFINED = 2


@dataclass(frozen=True, slots=True)
class Progress:
    """How far the iterations of a correction have come.

    Attributes
    ----------
    change : by which the last one changed the terms of finite strain.
    to_come : that change or the sum of those to come, whichever is less, over the tolerance; inf
        where the correction is not that of the tractions themselves.
    """

    change: float
    to_come: float


def begin(
    nip: Nip,
    model: Model,
    kernels: PairKernels,
    half_width: float,
    second: Responses | None = None,
    is_too_deep: IsTooDeep | None = None,
) -> tuple[PairKernels, MeshSolution, Stage]:
    """Return a contact to begin with: with free ends, coarse or refined, or by nodes.

    And the influence functions with the correction that it holds: that of ``kernels`` or, with
    ``second``, the second order under the tractions of nodes. An elastic nip of a single zone
    goes without: an iteration leaves so little of the error of the correction there that the second
    order saves none. A contact that is too deep is returned as its nodes found it. Where friction
    grips a stiff skin no ends are sought yet: its short zones beside the edges come and go with the
    correction, and iterations from those would follow them.
    """
    coarse_model = coarsely(model)
    sizes = by_nodes(nip, coarse_model, kernels, half_width, COARSE_SIZES)
    if grips_skin(nip):
        *_, located = sizes
        return kernels, located, Stage.COARSE
    for located in sizes:
        layout = Layout.of(located.zones) if located.settled else None
        if layout is not None and is_too_deep is not None and is_too_deep(located, is_rough=True):
            return kernels, located, Stage.COARSE
        if layout is not None:
            held, before = kernels, located
            if second is not None and (nip.is_viscoelastic or layout.states.size > 1):
                held, before = _holding_second_order(nip, model, second(), located)
            start = SearchState(layout, before, misplacement=1.0 / located.mesh.inner.size)
            with suppress(np.linalg.LinAlgError):
                found = Placing(nip, coarse_model, held).solve(start, _COARSE, zones_known=False)
                if found is not None:
                    return held, found.before, Stage.COARSE
    refined = free_ends_from_nodes(nip, model, kernels, located) if located.settled else None
    if is_verified(refined, model):
        return kernels, refined, Stage.REFINED
    return kernels, located, Stage.COARSE


def refined_at_once(
    nip: Nip, model: Model, second: PairKernels, coarse: MeshSolution
) -> tuple[PairKernels, MeshSolution, Stage]:
    """Return a refined contact that holds the second order of a coarse one, and what holds it.

    The coarse one itself where the ends of zones are not found on finer meshes.
    """
    held, before = _holding_second_order(nip, model, second, coarse)
    refined = _with_free_ends(nip, model, held, before)
    if refined is None:
        return held, before, Stage.COARSE
    return held, refined, Stage.REFINED


def _holding_second_order(
    nip: Nip, model: Model, second: PairKernels, latest: MeshSolution
) -> tuple[PairKernels, MeshSolution]:
    """Return influence functions that hold the second order of a solution, and it with them.

    Of its waves those are left out that are too short at the strain of the solution.
    """
    kept = share_of_waves(surface_strain_in_nip(nip, model.geometry, latest))
    half_width = 0.5 * latest.figures.nip_width / kept
    upper, lower = (
        None if response is None else response.fitted(half_width)
        for response in (second.second_upper, second.second_lower)
    )
    fitted = replace(second, second_upper=upper, second_lower=lower)
    fields = fitted.second_fields(latest.nodes, latest.pressure, latest.shear)
    kernels = replace(second, second_upper=None, second_lower=None, held=fields)
    return kernels, replace(latest, mesh=latest.mesh.holding(kernels))


def solved_next(
    nip: Nip,
    model: Model,
    kernels: PairKernels,
    latest: MeshSolution,
    stage: Stage,
    progress: Progress,
) -> tuple[MeshSolution, Stage]:
    """Solve with another correction, on better meshes where it is nearly right.

    Where that fails the round has not settled; but nodes of a first mesh go on there until the
    correction has come further.
    """
    if progress.to_come <= _enough_for_better(model, latest, stage):
        found, better = _better(nip, model, kernels, latest, stage)
        if found.settled or latest.is_placed or stage is not Stage.COARSE:
            return found, better
    return _solved_again(nip, model, kernels, latest, stage, progress.change), stage


def _enough_for_better(model: Model, latest: MeshSolution, stage: Stage) -> float:
    """Return the change, over the tolerance, from which on a better mesh is worth its cost."""
    if stage is Stage.REFINED:
        return -inf
    if stage is Stage.FINE:
        return ENOUGH
    if not latest.is_placed:
        return NEARLY
    return 1.0 / model.tolerance  # a change of less than the terms themselves


def _better(
    nip: Nip, model: Model, kernels: PairKernels, latest: MeshSolution, stage: Stage
) -> tuple[MeshSolution, Stage]:
    """Solve on better meshes, with a correction that is held and nearly right."""
    if latest.is_placed:
        found = _refined(nip, model, kernels, latest)
        return found, Stage.REFINED if found.is_placed else Stage.FINE
    ready = free_ends_from_nodes(nip, model, kernels, latest) if stage is Stage.FINE else None
    if ready is not None and error_ratio(nip, ready, model.tolerance) <= 1.0:
        return ready, Stage.REFINED
    finer = finer_by_nodes(nip, model, kernels, latest)
    if finer is None and ready is not None:
        return ready, Stage.REFINED  # its errors stay too large, and are said
    return finer or replace(latest, settled=False), Stage.FINE


def coarsely(model: Model) -> Model:
    """Return the model of contacts whose correction still changes."""
    return replace(model, tolerance=max(model.tolerance, _COARSELY))


def _refined(nip: Nip, model: Model, kernels: PairKernels, latest: MeshSolution) -> MeshSolution:
    """Refine a solution with free ends on a coarse mesh, with a correction that is held."""
    found = _with_free_ends(nip, model, kernels, latest)
    return found or refine(nip, model, kernels, 0.5 * latest.figures.nip_width)


def _with_free_ends(
    nip: Nip, model: Model, kernels: PairKernels, latest: MeshSolution
) -> MeshSolution | None:
    """Return a verified solution with about the zones of a coarse one; None: there is none."""
    layout = Layout.of(latest.zones)
    if layout is None:
        return None
    found = with_free_ends(nip, model, kernels, layout, latest, _COARSELY)
    return found if is_verified(found, model) else None


def restarted(
    nip: Nip, model: Model, both: tuple[PairKernels, PairKernels], latest: MeshSolution
) -> tuple[PairKernels, MeshSolution, Stage]:
    """Begin again: with a mean of corrections or, if it leads astray, the last one."""
    half_width = 0.5 * latest.figures.nip_width
    for kernels in both if both[0].held is not both[1].held else both[:1]:
        held, found, stage = begin(nip, model, kernels, half_width)
        if found.settled:
            break
    return held, found, stage


def _solved_again(
    nip: Nip, model: Model, kernels: PairKernels, latest: MeshSolution, stage: Stage, change: float
) -> MeshSolution:
    """Solve with another correction; where that fails the round has not settled."""
    if not latest.is_placed:
        if change > NEAR_ENOUGH:
            half_width = 0.5 * latest.figures.nip_width
            *_, found = by_nodes(nip, model, kernels, half_width, COARSE_SIZES)
            return found
        start = latest.state.states, latest.second, latest.steps
        found = solve_on_mesh(nip, model, latest.mesh, start, BY_NODES, NEGLIGIBLE)
    else:
        model_of_stage = coarsely(model) if stage is Stage.COARSE else model
        found = _placed_again(nip, model_of_stage, kernels, latest)
    return replace(found, error=latest.error, make_secondary_error=latest.make_secondary_error)


def _placed_again(
    nip: Nip, model: Model, kernels: PairKernels, latest: MeshSolution
) -> MeshSolution:
    """Solve with another correction, which moves free ends of zones.

    These move to where the last solution put them; nodes that crowd at a boundary layer need ends
    that are placed, but where friction holds a skin: there the correction moves them more.
    """
    layout, found = Layout.of(latest.zones), None
    if layout is not None:
        placing = Placing(nip, model, kernels)
        second = second_order(nip, model.geometry, latest.mesh, latest.state)
        search = SearchState(layout, replace(latest, second=second), misplacement=_COARSELY)
        is_crowded = not grips_skin(nip) and min(latest.mesh.fine.crowding) < 1.0
        with suppress(np.linalg.LinAlgError):
            found = None if is_crowded else placing.solve_at_moved_ends(search)
            found = found or placing.solve(
                search, elements_without_crowding(latest), zones_known=True
            )
    return replace(latest if found is None else found.before, settled=found is not None)
