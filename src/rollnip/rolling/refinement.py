"""From an estimate of the width to a verified solution: zones node by node, then free ends."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Protocol

import numpy as np

from rollnip.contact import NEAR_ENOUGH, Layout, solve_nodes
from rollnip.rolling.assemble import initial_terms
from rollnip.rolling.changes import NEGLIGIBLE
from rollnip.rolling.free_ends import is_verified, with_free_ends
from rollnip.rolling.iterations import holding_second_order, solve_on_mesh, with_residual
from rollnip.rolling.lengths import boundary_layer
from rollnip.rolling.mesh_solution import MeshSolution
from rollnip.rolling.placing import MOST_MESHES
from rollnip.rolling.rolling_contact import RollingContact
from rollnip.rolling.zone_solver import are_too_many, mesh_around

SIZES = (16, 32, 64, 128, 256)  # elements of the meshes on which states are sought node by node


class IsTooDeep(Protocol):
    """A function that judges how far layers are compressed: `no_nip.is_too_deep` for one nip."""

    def __call__(self, found: MeshSolution, *, is_rough: bool) -> bool:
        """Return whether a solution presses a layer in too far.

        ``is_rough``: whether the solution is only a rough one.
        """
        ...


def refine(
    contact: RollingContact,
    half_width: float,
    sizes: tuple[int, ...] = SIZES,
    is_too_deep: IsTooDeep | None = None,
) -> MeshSolution:
    """Return a solution with an estimated error below the tolerance, if one is found.

    Zones are first sought node by node, on a coarse mesh that extends beyond the estimated contact.
    Their ends are then a free boundary (`with_free_ends`). If that gives no verified solution,
    zones are sought again on the next finer mesh.

    Parameters
    ----------
    half_width : first estimate [mm].
    sizes : numbers of elements of the meshes on which zones are sought, in turn.
    is_too_deep : tells which solutions no finer mesh can make possible; such a one is returned as
        it is. None: do not check.

    Returns
    -------
    A verified solution; otherwise the last one with free ends; if there is none, the last one
    found node by node, preferably one that has settled.
    """
    best: MeshSolution | None = None
    for latest in by_nodes(contact, half_width, sizes):
        if latest.settled and is_too_deep is not None and is_too_deep(latest, is_rough=True):
            return latest
        found = free_ends_from_nodes(latest) if latest.settled else None
        if is_verified(found):
            return found
        best = found or best
    best = best or latest
    if not best.figures.peak_pressure > 0.0:
        return best
    return with_residual(best)


def free_ends_from_nodes(located: MeshSolution, most: int | None = None) -> MeshSolution | None:
    """Return the solution with free ends, starting from the zones of one found node by node.

    Its first mesh has as many elements as that one, or ``most`` if these are fewer. Nodes that
    crowd at the ends of short zones add to them.
    """
    layout, count = located.layout, located.mesh.inner.size
    if layout is None:
        return None
    fewest = count if most is None else min(count, most)
    return with_free_ends(located, layout, 1.0 / count, fewest)


def by_nodes(
    contact: RollingContact,
    half_width: float,
    sizes: tuple[int, ...],
    before: MeshSolution | None = None,
) -> Iterator[MeshSolution]:
    """Yield the solution found node by node on each of the mesh sizes.

    It is the last solution of a size that has settled. One that has not settled is yielded only as
    long as none has. The sequence ends early where nothing is pressed, or friction cannot
    carry the prescribed traction.

    ``before`` : a solution to start from; None: start from the estimated ``half_width`` [mm].
    """
    any_settled = False
    for count in sizes:
        found, settled = _solve_at_size(contact, half_width, count, before)
        any_settled = any_settled or settled is not None
        if settled is not None or not any_settled:
            yield settled or found
        if not (found.figures.peak_pressure > 0.0 and found.has_grip):
            return
        before = found if found.settled else before


def _solve_at_size(
    contact: RollingContact, half_width: float, count: int, before: MeshSolution | None
) -> tuple[MeshSolution, MeshSolution | None]:
    """Return the last solution node by node at one mesh size, and the last that has settled.

    Each mesh is dense at the ends of zones that the previous one found.
    """
    last: MeshSolution | None = None
    for _ in range(MOST_MESHES):
        found = _solve_by_nodes(contact, half_width, count, last or before)
        is_pressed = found.settled and found.figures.peak_pressure > 0.0
        if not is_pressed or _zones_are_known(found, last):
            break
        last = found
    return found, found if found.settled else last


def _solve_by_nodes(
    contact: RollingContact, half_width: float, count: int, before: MeshSolution | None
) -> MeshSolution:
    """Return the solution node by node on a mesh around the zones of ``before``, or a guess."""
    if before is None:
        around = Layout.with_free_surfaces(
            Layout.sticking(half_width).zones, 3.0 * NEAR_ENOUGH * half_width
        )
    else:
        zones = before.zones
        if are_too_many(len(zones)):  # then the mesh is dense at both edges only
            zones = (replace(zones[0], stop=zones[-1].stop),)
        around = Layout.with_free_surfaces(zones, NEAR_ENOUGH * before.figures.nip_width)
    mesh = mesh_around(contact, around, count, holding_second_order(contact, before))
    lagged, steps = initial_terms(contact, mesh), 0
    if before is not None:
        lagged, steps = before.lagged.carried(before.mesh, mesh), before.steps
    start = around.states_on(mesh.inner), lagged, steps
    return solve_on_mesh(contact, mesh, start, solve_nodes, NEGLIGIBLE)


def _zones_are_known(latest: MeshSolution, before: MeshSolution | None) -> bool:
    """Return whether the zones are known well enough to place their ends.

    The first mesh of a size is dense at the edges only. It takes a second one to be dense at
    transitions, or in boundary layers shorter than the elements. If each mesh holds the
    second order of the one before, no end may have moved by more than an element.
    """
    element = latest.figures.nip_width / latest.mesh.inner.size
    if latest.contact.kernels.is_fixed:
        is_resolved = len(latest.zones) == 1 and boundary_layer(latest.nip) >= element
        return before is not None or is_resolved
    if before is None or len(before.zones) != len(latest.zones):
        return False
    ends = np.array([(zone.start, zone.stop) for zone in latest.zones])
    moves = ends - np.array([(zone.start, zone.stop) for zone in before.zones])
    return bool(np.max(np.abs(moves)) <= element)
