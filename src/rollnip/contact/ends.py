"""By how much the end of a zone is misplaced, from the tractions at the nodes beside it."""

from __future__ import annotations

from collections.abc import Sequence
from math import copysign, inf, sqrt
from typing import TypeVar

import numpy as np

from rollnip.contact.edge_exponents import turned_back
from rollnip.contact.problem import Array, ContactState

# Discrete form of the inverse square root that a misplaced end leaves: the change of a square-root
# traction, relative to it, at the first three nodes inside a zone of many cubic elements
# (`subdivided`), per first element by which the zone is too wide. Measured on a parabola pressed on
# a half-plane (tests).
RESPONSE = (-0.6831, -0.1132, -0.0597)

Three = Sequence[float]
_Number = TypeVar("_Number", float, complex)


def proposed_move(
    nodes: Sequence[float],
    tractions: Sequence[complex],
    end: int,
    inwards: int,
    weight: complex,
    kappa: complex,
    furthest: int,
) -> float:
    """Return how far outwards the end of a zone should move; see `outward_move`.

    Parameters
    ----------
    nodes, tractions : of the mesh, and p + i q at them.
    end : index of the node at the end.
    inwards : 1 or -1, step of the index into the zone.
    weight : of p + i q, of which the real part vanishes at the end.
    kappa : see `edge_exponents`.
    furthest :
        0 at an end with a square root. At a smooth end, the most elements between the nodes used:
        values at the first nodes may be no larger than their errors, and if they propose a place
        beyond their own reach, nodes further inside are tried.
    """
    move, reach, apart = inf, 0.0, 1
    while abs(move) > reach and apart <= max(furthest, 1):
        beside = [end + inwards * apart * i for i in (1, 2, 3)]
        distance = [abs(nodes[i] - nodes[end]) for i in beside]
        back = turned_back([tractions[i] for i in beside], distance, kappa)
        values = [(weight * one).real for one in back]
        move, apart = outward_move(distance, values, smooth=furthest > 0), 2 * apart
        reach = distance[-1]
    return move


def singular_part(x: Array, state: ContactState, end: int, inwards: int) -> float:
    """Return the inverse square root in the pressure beside an edge, times its first distance.

    ``end``, ``inwards``: as in `proposed_move`.
    """
    beside = end + inwards * np.array([1, 2, 3])
    distance = np.abs(x[beside] - x[end])
    right = state.pressure[beside] / np.sqrt(distance)
    patterns = np.stack([np.ones(3), distance, np.array(RESPONSE)], axis=1)
    return float(np.linalg.solve(patterns, right)[2] * distance[0])


def outward_move(distance: Three, values: Three, *, smooth: bool) -> float:
    """Return how far outwards the end of a zone should move, from values at three nodes inside it.

    The values are fitted by s, s^3 and a third function, s being the square root of the distance
    from the end: the inverse square root of a misplaced end (`RESPONSE`), or s^5 at a smooth end.
    Where the fit does not rise inwards as it should, the result is infinite; its sign still tells
    which way to move.
    """
    first = (1.0, 1.0, 1.0)
    third = [d * d for d in distance] if smooth else RESPONSE
    right = [value / sqrt(d) for value, d in zip(values, distance, strict=True)]
    whole = determinant(first, distance, third)
    root = determinant(right, distance, third)
    if smooth:
        bend = determinant(first, right, third)
        return root / (1.5 * bend) if bend * whole > 0.0 else copysign(inf, root * whole)
    misplaced = determinant(first, distance, right)
    if root * whole > 0.0:
        return -misplaced / root * distance[0]
    return copysign(inf, -misplaced * whole)


def determinant(a: Sequence[_Number], b: Three, c: Three) -> _Number:
    """Return the determinant of the matrix with these three columns."""
    return (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )
