"""Meshes of linear elements, dense at contact edges and at transitions between stick and slip."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import ContactZone, States, cosine_nodes, elements_of_zones

Array = NDArray[np.float64]
# Distances of the nodes outside the contact from the edge, in edge elements.
_OUTER_NODE_DISTANCES = np.array([1.0, 2.0, 4.0, 8.0])


def states_on(x: Array, zones: tuple[ContactZone, ...]) -> States:
    """Return the state of each of the nodes ``x``: of its zone, ends included, or FREE.

    A node between two zones belongs to the leading one.
    """
    out = np.zeros(x.size, dtype=np.int8)
    for zone in zones:
        out[(x >= zone.start) & (x <= zone.stop)] = zone.state
    return out


def graded_nodes(breaks: Array, count: int) -> Array:
    """Return nodes at cosine places on zones between ``breaks``, and a few beyond either end.

    Tractions go to zero as the square root of the distance to an edge or a transition; nodes
    whose distance to it grows as a square (a cosine over the zone) then make the interpolation
    error equal on all elements, and the whole of second order in 1/count.

    Parameters
    ----------
    breaks : (m,) increasing: outermost contact edges, further edges, transitions [mm].
    count : number of elements, about.
    """
    inner = cosine_nodes(breaks, elements_of_zones(breaks, count))[1:-1]
    first, last = inner[1] - inner[0], inner[-1] - inner[-2]
    return np.concatenate(
        [
            inner[0] - first * _OUTER_NODE_DISTANCES[::-1],
            inner,
            inner[-1] + last * _OUTER_NODE_DISTANCES,
        ]
    )
