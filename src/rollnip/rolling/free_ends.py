"""Zones whose ends are free, on ever finer meshes: few nodes, ends by secants.

Tractions between nodes at cosine places are cubic in the number of the node. With edges and
transitions at nodes, a dozen such nodes in a zone are as accurate as a hundred nodes with linear
tractions between them.
"""

from __future__ import annotations

from math import inf, sqrt
from typing import TypeGuard

import numpy as np

from rollnip._largest import largest
from rollnip.contact import Layout, cubic_error, more_elements
from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.rolling.estimates import (
    LEAST_ERROR,
    Size,
    sized,
    with_errors,
    with_further_errors,
    zone_excess,
)
from rollnip.rolling.iterations import STILL, converge, with_residual
from rollnip.rolling.placing import Placing
from rollnip.rolling.round import Round, excess
from rollnip.rolling.search import SearchState
from rollnip.rolling.surfaces import PairKernels

_FIRST_COUNT = 18
_ELEMENTS_PER_ZONE = 4  # elements more for each zone
_MOST_ELEMENTS = 300  # at a tolerance of 1e-3; what needs more has no smooth tractions
_MOST_TIMES_FIRST = 3.0  # likewise, over the elements of the first mesh
_FIRST_EXCESS = 3.08  # error over the tolerance, about, of zones that were solved on one size only
_LEAST_GROWTH = 1.2  # of the number of elements from size to size
ENOUGH_FOR_ZONES = 100  # elements; transitions that still move have no square root at them


def is_verified(found: Round | None, model: Model) -> TypeGuard[Round]:
    """Return whether there is a solution whose residual was evaluated and is small enough."""
    return found is not None and found.residual <= model.tolerance


def with_free_ends(
    nip: Nip,
    model: Model,
    kernels: PairKernels,
    layout: Layout,
    before: Round,
    misplacement: float,
    fewest: int = 0,
) -> Round | None:
    """Solve with zones whose ends are free, on ever finer meshes until the error is small enough.

    Parameters
    ----------
    layout : the zones to start with, and about where they are.
    before : the solution that the layout comes from.
    misplacement : of the ends of its zones at most, over the width of the contact.
    fewest : elements of the first mesh, at least: those of the mesh that the zones come from; above
        `ENOUGH_FOR_ZONES` zones count as known. 0: no lower bound.

    Returns
    -------
    A verified solution; else that on the finest mesh, whose residual is infinite; None where there
    are not two sizes to estimate its error from: zones that come and go, or singular tractions.
    """
    placing = Placing(nip, model, kernels)
    count = max(fewest, _FIRST_COUNT + _ELEMENTS_PER_ZONE * layout.states.size)
    start = SearchState(layout, before, misplacement=misplacement)
    try:
        return _refined(placing, start, count, known=fewest > ENOUGH_FOR_ZONES)
    except np.linalg.LinAlgError:
        return None


def _refined(placing: Placing, state: SearchState, count: int, *, known: bool) -> Round | None:
    nip, model = placing.nip, placing.model
    history: list[Size] = []
    most = _MOST_ELEMENTS * max(1e-3 / model.tolerance, 1.0) ** (1.0 / 3.0)
    most = max(most, _MOST_TIMES_FIRST * count)
    best: Round | None = None
    is_repeated = False  # on a mesh of the same size
    shown = _FIRST_EXCESS  # error, residual or roughness over what is allowed
    while count <= most:
        closely = bool(history)  # the error may be small enough
        placed = placing.placed(state, count, known=known or closely, closely=closely)
        if placed is None:
            break
        if not placed.layout.is_like(state.layout):
            history.clear()  # figures of other zones tell nothing of the errors with these
        state, latest = placed, placed.before
        wanted, count = count, as_cosines(latest)
        roughness = _roughness(nip, model, latest)
        if roughness > 1.0 and not history and nip.friction == 0.0:
            # Without friction zones stay as they are: how rough tractions are says all.
            count, known = _next_count(count, roughness, model.tolerance), True
            continue
        if is_repeated and history:
            history.pop()
        history.append(sized(nip, model, latest, count, state.layout.breaks))
        best = latest = with_errors(nip, latest, history, state.left)
        ratio = excess(nip, latest, model.tolerance)
        zones_rest = count > ENOUGH_FOR_ZONES or zone_excess(history, model.tolerance) <= 1.0
        if largest(ratio, roughness) <= 1.0 and zones_rest:
            final = converge(nip, model, latest, placing.given, latest.zones)
            final = with_residual(nip, model, placing.kernels, final)
            if final.residual <= model.tolerance:
                return with_further_errors(nip, final, history)
            ratio = final.residual / model.tolerance
            if not is_repeated:
                is_repeated, count = True, wanted  # with ends at their next places
                continue
        shown = min(shown, _FIRST_EXCESS) if ratio == inf else largest(ratio, roughness)
        finer = _next_count(count, shown, model.tolerance)
        is_repeated = False
        count = min(finer, int(most)) if _LEAST_GROWTH * count < most else finer
    return None if best is None or len(history) < 2 else with_further_errors(nip, best, history)


def _next_count(count: int, ratio: float, tolerance: float) -> int:
    """Return how many elements would bring an error ``ratio`` times too large to the tolerance.

    They are at least as many as such an error can be claimed with.
    """
    growth = max(1.1 * ratio ** (1.0 / 3.0), _LEAST_GROWTH)
    claimed = 1.02 * sqrt(float(np.max(LEAST_ERROR)) / tolerance)
    return int(max(count * growth, claimed)) + 1


def as_cosines(latest: Round) -> int:
    """Count the elements of a solution, each zone's as if its nodes lay at cosine places."""
    fine = latest.mesh.fine
    shares = map(more_elements, fine.crowding)
    return round(sum(n / more for n, more in zip(fine.elements, shares, strict=True)))


def _roughness(nip: Nip, model: Model, latest: Round) -> float:
    """Return how badly cubics follow the tractions, over what is allowed.

    Where cubics do not follow the tractions, sizes of mesh may agree and all be wrong.
    """
    elements, x = latest.mesh.fine.elements, latest.mesh.inner
    pressure, shear = latest.state.pressure, latest.state.shear
    # Where nodes crowd, the layers that they crowd for count more than their share of the width.
    width = float(x[-1] - x[0]) * sqrt(min(latest.mesh.fine.crowding))
    peak = float(np.max(pressure))
    little = model.tolerance * nip.friction * peak  # shear that hardly matters
    most = max(float(np.max(np.abs(shear))), little)
    errors = [cubic_error(pressure, x, elements) / (peak * width)]
    if most > 0.0:
        errors.append(cubic_error(shear, x, elements) / (most * width))
    return largest(*errors) / (STILL * model.tolerance)
