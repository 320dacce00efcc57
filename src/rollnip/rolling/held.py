"""Contacts with a correction of all orders that is held, on ever better meshes.

While the correction changes much, a coarse contact is enough: one mesh or, where zones are not
found from a guess of the width, as under stiff foils with friction, a solution to a larger
tolerance.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from enum import IntEnum

import numpy as np

from rollnip.contact import Layout
from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.rolling.assemble import second_order
from rollnip.rolling.claimed_errors import skin_thickness
from rollnip.rolling.free_ends import as_cosines, is_verified, with_free_ends
from rollnip.rolling.placing import Placing
from rollnip.rolling.refinement import refine
from rollnip.rolling.round import Round
from rollnip.rolling.search import SearchState
from rollnip.rolling.surfaces import PairKernels

_COARSE = 24  # elements of the contact while its correction still changes
# Change, over the tolerance, from which on the mesh of a bare nip is refined: at once where the
# correction is moderate, later where a layer is viscoelastic (coarse turns are cheap then) or a
# skin needs a correction that nearly fits to find its edges.
_REFINED_FROM = 400.0
_REFINED_LATER_FROM = 50.0
_COARSELY = 1e-2  # tolerance of such contacts
_OFF = 0.01  # of the width of the contact: how far a correction moves the ends of zones, about


class Stage(IntEnum):
    """How good a contact is that a correction is evaluated from."""

    COARSE = 0
    REFINED = 1


def begin(nip: Nip, model: Model, kernels: PairKernels, half_width: float) -> Round:
    """Return a coarse contact to begin with; where it is not found it does not stand still."""
    found = _coarsely_placed(nip, model, kernels, half_width)
    return found or _from_nothing(nip, coarsely(model), kernels, half_width)


def _from_nothing(nip: Nip, model: Model, kernels: PairKernels, half_width: float) -> Round:
    """Return a contact that is sought without another; without free ends it is not at rest."""
    found = refine(nip, model, kernels, half_width)
    return found if found.is_placed else replace(found, stands_still=False)


def _coarsely_placed(
    nip: Nip, model: Model, kernels: PairKernels, half_width: float
) -> Round | None:
    placing = Placing(nip, coarsely(model), kernels)
    try:
        stand = placing.guessed(Layout.sticking(half_width), _COARSE)
        found = None if stand is None else placing.placed(stand, _COARSE, known=False)
    except np.linalg.LinAlgError:
        return None
    return None if found is None else found.before


def solved_next(
    nip: Nip, model: Model, kernels: PairKernels, latest: Round, stage: Stage, near: float
) -> tuple[Round, Stage]:
    """Solve with another correction, on better meshes where it is nearly right.

    Where that fails the round does not stand still.

    Parameters
    ----------
    near : by which the correction changes the terms of finite strain, or the sum of such changes to
        come, over the tolerance; inf where it is not that of the tractions themselves.
    """
    waits = nip.is_viscoelastic or skin_thickness(nip) > 0.0
    enough = _REFINED_LATER_FROM if waits else _REFINED_FROM
    if stage is Stage.COARSE and near <= enough:
        return _refined(nip, model, kernels, latest), Stage.REFINED
    model = coarsely(model) if stage is Stage.COARSE else model
    found = _placed_again(nip, model, kernels, latest)
    return replace(found, error=latest.error, further_error=latest.further_error), stage


def coarsely(model: Model) -> Model:
    """Return the model of contacts whose correction still changes."""
    return replace(model, tolerance=max(model.tolerance, _COARSELY))


def _refined(nip: Nip, model: Model, kernels: PairKernels, latest: Round) -> Round:
    """Refine a solution with free ends on a coarse mesh, with a correction that is held."""
    layout, found = Layout.of(latest.zones), None
    if layout is not None:
        found = with_free_ends(nip, model, kernels, layout, latest, _OFF)
    return found if is_verified(found, model) else replace(latest, stands_still=False)


def anew(
    nip: Nip,
    model: Model,
    both: tuple[PairKernels, PairKernels],
    latest: Round,
    stage: Stage,
) -> tuple[PairKernels, Round]:
    """Solve from the beginning: with a mean of corrections or, if it leads astray, the last one."""
    half_width, mixed = 0.5 * latest.figures.nip_width, both[0]
    for kernels in both if mixed.held is not both[1].held else both[:1]:
        if stage is Stage.COARSE:
            found = begin(nip, model, kernels, half_width)
        else:
            found = _from_nothing(nip, model, kernels, half_width)
        if found.stands_still:
            break
    return kernels, found


def _placed_again(nip: Nip, model: Model, kernels: PairKernels, latest: Round) -> Round:
    """Solve with another correction, which moves free ends of zones.

    These move to where the last solution put them; nodes that crowd at a boundary layer need ends
    that are placed.
    """
    layout, found = Layout.of(latest.zones), None
    if layout is not None:
        placing = Placing(nip, model, kernels)
        second = second_order(nip, model.geometry, latest.mesh, latest.state)
        search = SearchState(layout, replace(latest, second=second), off=_OFF)
        is_crowded = min(latest.mesh.fine.crowding) < 1.0
        with suppress(np.linalg.LinAlgError):
            found = None if is_crowded else placing.turned(search)
            found = found or placing.placed(search, as_cosines(latest), known=True)
    return replace(latest if found is None else found.before, stands_still=found is not None)
