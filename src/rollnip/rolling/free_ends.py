"""Mesh refinement with the ends of zones as a free boundary.

Between cosine nodes, tractions are cubic in the node index. With edges and transitions at nodes, a
dozen such nodes in a zone are as accurate as a hundred nodes with linear tractions in between.
"""

from __future__ import annotations

from functools import partial
from math import inf, isnan, sqrt
from typing import TypeGuard

import numpy as np

from rollnip._largest import largest
from rollnip.contact import Layout, cubic_error, more_elements
from rollnip.rolling.changes import NEGLIGIBLE
from rollnip.rolling.estimates import (
    LEAST_ERROR,
    RefinementLevel,
    with_errors,
    with_secondary_errors,
)
from rollnip.rolling.iterations import with_residual
from rollnip.rolling.mesh_solution import MeshSolution
from rollnip.rolling.neglected_slip import negligible_slip
from rollnip.rolling.placing import Aim, place_ends
from rollnip.rolling.power_balance import secondary_figures
from rollnip.rolling.zone_solver import SearchState

_FIRST_COUNT = 18
_ELEMENTS_PER_ZONE = 4  # more of them on the first mesh for each zone
# Most elements, over those of the first mesh or, at a tolerance of 1e-3, over `ENOUGH_FOR_ZONES`:
# tractions that need more are not smooth.
_MOST_TIMES_FIRST = 3.0
_FIRST_ERROR_RATIO = 3.08  # rough error over the tolerance, assumed after the first mesh size
# Number of elements above which zones found node by node count as known.
ENOUGH_FOR_ZONES = 100


def is_verified(found: MeshSolution | None) -> TypeGuard[MeshSolution]:
    """Return whether there is a solution whose residual was evaluated and meets the tolerance."""
    return found is not None and found.residual <= found.contact.tolerance


def with_free_ends(
    before: MeshSolution, layout: Layout, misplacement: float, fewest: int = 0
) -> MeshSolution | None:
    """Return the solution with free ends, on meshes refined until its error meets the tolerance.

    Parameters
    ----------
    before : a solution of the contact, to start from.
    layout : its zones, and roughly where they are.
    misplacement : largest expected error of the ends, over the width of the contact.
    fewest : least number of elements of the first mesh: that of the mesh which the zones come from.
        Above `ENOUGH_FOR_ZONES` the zones are taken as known. 0: no lower bound.

    Returns
    -------
    A verified solution; otherwise the one on the finest mesh, with an infinite residual. None if no
    error can be estimated because fewer than two mesh sizes were solved with the same zones, as
    when zones come and go or tractions are singular.
    """
    count = max(fewest, _FIRST_COUNT + _ELEMENTS_PER_ZONE * layout.states.size)
    start = SearchState(layout, before, misplacement=misplacement)
    return _refined(start, count, Aim.ENDS if fewest > ENOUGH_FOR_ZONES else Aim.ZONES)


def _refined(state: SearchState, count: int, aim: Aim) -> MeshSolution | None:
    """Return the solution on meshes refined from size to size, as `with_free_ends` does.

    ``aim`` : of the first mesh.
    """
    tolerance, friction = state.contact.tolerance, state.contact.nip.friction
    history: list[RefinementLevel] = []
    enough = ENOUGH_FOR_ZONES * max(1e-3 / tolerance, 1.0) ** (1.0 / 3.0)
    most = _MOST_TIMES_FIRST * max(enough, count)
    best: MeshSolution | None = None
    roughness = inf
    while count <= most:
        # From the second size on the error may meet the tolerance.
        try:
            placed = place_ends(state, count, Aim.FIGURES if history else aim)
        except np.linalg.LinAlgError:
            break
        if placed is None:
            break
        if not placed.layout.is_like(state.layout):
            history.clear()  # changes between different zones are no measure of the error
        state, latest = placed, placed.solution
        count = elements_without_crowding(latest)
        roughness = _roughness(latest, roughness)
        if roughness > 1.0 and not history and friction == 0.0:
            # Without friction no zones can be missing: the roughness alone gives the next size.
            count, aim = _next_count(count, roughness, tolerance), Aim.ENDS
            continue
        make_secondary = partial(secondary_figures, latest)
        history.append(RefinementLevel(count, latest.figures, state.layout.breaks, make_secondary))
        best = latest = with_errors(latest, history, state.end_error)
        ratio = latest.error_ratio
        if largest(ratio, roughness) <= 1.0:
            final = with_residual(latest)
            if is_verified(final):
                return with_secondary_errors(final, history)
            ratio = final.residual / tolerance
        excess = largest(ratio, roughness)
        if isnan(excess):
            break  # finer meshes do not help a solution that is no number
        wanted = _next_count(count, excess if excess < inf else _FIRST_ERROR_RATIO, tolerance)
        count = max(min(wanted, int(most)), _next_count(count, 1.0, tolerance))
    return None if best is None or len(history) < 2 else with_secondary_errors(best, history)


def _next_count(count: int, ratio: float, tolerance: float) -> int:
    """Return the number of elements that should reduce an error ``ratio`` times too large.

    It is large enough that the least error of such a mesh (`LEAST_ERROR`) meets the tolerance.
    """
    growth = 1.1 * max(ratio, 1.0) ** (1.0 / 3.0)
    claimed = 1.02 * sqrt(float(np.max(LEAST_ERROR)) / tolerance)
    return int(max(count * growth, claimed)) + 1


def elements_without_crowding(latest: MeshSolution) -> int:
    """Return the number of elements that a solution would have without crowding of nodes."""
    fine = latest.mesh.fine
    shares = map(more_elements, fine.crowding)
    return round(sum(n / more for n, more in zip(fine.elements, shares, strict=True)))


def _roughness(latest: MeshSolution, before: float) -> float:
    """Return the interpolation error of the tractions, over what is allowed.

    Where cubics do not resolve the tractions, mesh sizes may agree and all be wrong. Tractions
    that negligible slip covers do not count: without that slip they are singular. At finite strain
    the correction held has waves about as short as elements. A finer mesh may show more of them
    than the one ``before``: then the roughness tells nothing, and is given as 1, just allowed.
    """
    contact, x, fine = latest.contact, latest.mesh.inner, latest.mesh.fine
    covered = np.zeros(x.size, dtype=bool)
    for slip in negligible_slip(latest):
        covered |= slip.covers(x)
    zones = fine.elements, fine.crowding, covered
    pressure, shear = latest.state.pressure, latest.state.shear
    width = float(x[-1] - x[0])
    peak = float(np.max(pressure))
    little = contact.tolerance * contact.nip.friction * peak  # shear below this is negligible
    most = max(float(np.max(np.abs(shear))), little)
    errors = [cubic_error(pressure, x, *zones) / (peak * width)]
    if most > 0.0:
        errors.append(cubic_error(shear, x, *zones) / (most * width))
    roughness = largest(*errors) / (NEGLIGIBLE * contact.tolerance)
    return 1.0 if contact.has_finite_strain and roughness > before else roughness
