"""Contacts with a correction of all orders that is held, on ever better meshes.

While the correction changes much, a coarse contact is enough. Where one with free ends is not found
from a guess of the width, as under stiff foils with friction, contact, stick and slip are sought
node by node until the correction has settled; only then free ends take over the zones.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace
from enum import IntEnum
from math import inf

import numpy as np

from rollnip.contact import Layout
from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.rolling.assemble import second_order
from rollnip.rolling.claimed_errors import grips_skin, skin_thickness
from rollnip.rolling.free_ends import as_cosines, is_verified, with_free_ends
from rollnip.rolling.iterations import STILL, solve_on_mesh
from rollnip.rolling.placing import Placing
from rollnip.rolling.refinement import (
    BY_NODES,
    ENOUGH_FOR_ZONES,
    SIZES,
    by_nodes,
    finer_by_nodes,
    placed,
    refine,
)
from rollnip.rolling.round import Round, excess
from rollnip.rolling.search import SearchState
from rollnip.rolling.surfaces import PairKernels

_FAR = 0.1  # change from which a contact is sought again, where it is sought node by node
_AT_REST = 0.3  # change of such a contact's correction, over the tolerance: free ends take over
_COARSE = 24  # elements of the contact while its correction still changes
NEARLY = 6.0  # last change or those to come, over the tolerance: the mesh is refined now
# Change, over the tolerance, from which on the mesh of a bare nip is refined: at once where the
# correction is moderate, later where a layer is viscoelastic (coarse iterations are cheap then) or
# a skin needs a correction that nearly fits to find its edges.
_REFINED_FROM = 400.0
_REFINED_LATER_FROM = 50.0
_COARSELY = 1e-2  # tolerance of such contacts
_OFF = 0.01  # of the width of the contact: how far a correction moves the ends of zones, about


class Stage(IntEnum):
    """How good a contact is that a correction is evaluated from."""

    COARSE = 0
    FINE = 1  # sought node by node, on a fine mesh
    REFINED = 2


@dataclass(frozen=True, slots=True)
class Asked:
    """Demands of a correction on the next contact.

    Attributes
    ----------
    change : by which the correction changes the terms of finite strain.
    near : that change or the sum of those to come, over the tolerance; inf where the correction is
        not that of the tractions themselves.
    """

    change: float
    near: float


def begin(nip: Nip, model: Model, kernels: PairKernels, half_width: float) -> tuple[Round, Stage]:
    """Return a contact to begin with: with free ends, coarse or refined, or by nodes."""
    asked = coarsely(model)
    for located in by_nodes(nip, asked, kernels, half_width, SIZES[:ENOUGH_FOR_ZONES]):
        layout = Layout.of(located.zones) if located.settled else None
        if layout is not None:
            start = SearchState(layout, located, misplacement=1.0 / located.mesh.inner.size)
            with suppress(np.linalg.LinAlgError):
                found = Placing(nip, asked, kernels).placed(start, _COARSE, known=False)
                if found is not None:
                    return found.before, Stage.COARSE
    refined = placed(nip, model, kernels, located) if located.settled else None
    return (refined, Stage.REFINED) if is_verified(refined, model) else (located, Stage.COARSE)


def solved_next(
    nip: Nip, model: Model, kernels: PairKernels, latest: Round, stage: Stage, asked: Asked
) -> tuple[Round, Stage]:
    """Solve with another correction, on better meshes where it is nearly right.

    Where that fails the round has not settled.
    """
    if asked.near <= _enough_for_better(nip, latest, stage):
        return _better(nip, model, kernels, latest, stage)
    return _solved_again(nip, model, kernels, latest, stage, asked.change), stage


def _enough_for_better(nip: Nip, latest: Round, stage: Stage) -> float:
    """Return the change, over the tolerance, from which on a better mesh is worth its cost."""
    if stage is Stage.REFINED:
        return -inf
    if stage is Stage.FINE:
        return _AT_REST
    if not latest.is_placed:
        return NEARLY
    if grips_skin(nip):
        return 1.0  # zones need a correction that fits
    waits = nip.is_viscoelastic or skin_thickness(nip) > 0.0
    return _REFINED_LATER_FROM if waits else _REFINED_FROM


def _better(
    nip: Nip, model: Model, kernels: PairKernels, latest: Round, stage: Stage
) -> tuple[Round, Stage]:
    """Solve on better meshes, with a correction that is held and nearly right."""
    if latest.is_placed:
        found = _refined(nip, model, kernels, latest)
        return found, Stage.REFINED if found.is_placed else Stage.FINE
    ready = placed(nip, model, kernels, latest) if stage is Stage.FINE else None
    if ready is not None and excess(nip, ready, model.tolerance) <= 1.0:
        return ready, Stage.REFINED
    finer = finer_by_nodes(nip, model, kernels, latest)
    if finer is None and ready is not None:
        return ready, Stage.REFINED  # its errors stay too large, and are said
    return finer or replace(latest, settled=False), Stage.FINE


def coarsely(model: Model) -> Model:
    """Return the model of contacts whose correction still changes."""
    return replace(model, tolerance=max(model.tolerance, _COARSELY))


def _refined(nip: Nip, model: Model, kernels: PairKernels, latest: Round) -> Round:
    """Refine a solution with free ends on a coarse mesh, with a correction that is held."""
    layout = Layout.of(latest.zones)
    if layout is not None:
        found = with_free_ends(nip, model, kernels, layout, latest, _OFF)
        if is_verified(found, model):
            return found
    return refine(nip, model, kernels, 0.5 * latest.figures.nip_width)


def restarted(
    nip: Nip,
    model: Model,
    both: tuple[PairKernels, PairKernels],
    latest: Round,
    stage: Stage,
) -> tuple[PairKernels, Round, Stage]:
    """Solve from the beginning: with a mean of corrections or, if it leads astray, the last one."""
    half_width = 0.5 * latest.figures.nip_width
    for kernels in both if both[0].held is not both[1].held else both[:1]:
        if stage is Stage.COARSE:
            found, stage = begin(nip, model, kernels, half_width)
        else:
            found = refine(nip, model, kernels, half_width)
            stage = Stage.REFINED if found.is_placed else Stage.FINE
        if found.settled:
            break
    return kernels, found, stage


def _solved_again(
    nip: Nip, model: Model, kernels: PairKernels, latest: Round, stage: Stage, change: float
) -> Round:
    """Solve with another correction; where that fails the round has not settled."""
    if not latest.is_placed:
        if change > _FAR:
            sizes = SIZES[:ENOUGH_FOR_ZONES]
            *_, found = by_nodes(nip, model, kernels, 0.5 * latest.figures.nip_width, sizes)
            return found
        start = latest.state.states, latest.second, latest.steps
        found = solve_on_mesh(nip, model, latest.mesh, start, BY_NODES, STILL)
    else:
        asked = coarsely(model) if stage is Stage.COARSE else model
        found = _placed_again(nip, asked, kernels, latest)
    return replace(found, error=latest.error, make_further_error=latest.make_further_error)


def _placed_again(nip: Nip, model: Model, kernels: PairKernels, latest: Round) -> Round:
    """Solve with another correction, which moves free ends of zones.

    These move to where the last solution put them; nodes that crowd at a boundary layer need ends
    that are placed, but where friction holds a skin: there the correction moves them more.
    """
    layout, found = Layout.of(latest.zones), None
    if layout is not None:
        placing = Placing(nip, model, kernels)
        second = second_order(nip, model.geometry, latest.mesh, latest.state)
        search = SearchState(layout, replace(latest, second=second), misplacement=_OFF)
        is_crowded = not grips_skin(nip) and min(latest.mesh.fine.crowding) < 1.0
        with suppress(np.linalg.LinAlgError):
            found = None if is_crowded else placing.solved_at_moved_ends(search)
            found = found or placing.placed(search, as_cosines(latest), known=True)
    return replace(latest if found is None else found.before, settled=found is not None)
