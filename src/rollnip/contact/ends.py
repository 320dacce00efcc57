"""By how much the end of a zone is misplaced, from the tractions at the nodes beside it."""

from __future__ import annotations

from collections.abc import Sequence
from math import copysign, inf, sqrt

import numpy as np

from rollnip.contact.problem import Array, ContactState, State

# Discrete form of the inverse square root that a misplaced end leaves: the change of a square-root
# traction, relative to it, at the first three nodes inside a zone of many cubic elements
# (`subdivided`), per first element by which the zone is too wide. Measured on a parabola pressed on
# a half-plane (tests).
RESPONSE = (-0.6831, -0.1132, -0.0597)

_Three = Sequence[float]


def slip_beside(
    x: Array, state: ContactState, friction: float, edge: int, *, leads: bool
) -> tuple[float, State]:
    """Return the length of a slip zone missing between stick and an edge, and its state.

    Leaving out a slip zone much shorter than the elements changes mu p - |q| as misplacing the end
    of stick outwards by its length does. Other effects that three nodes mistake for it depend on
    the spacing of the nodes. So the length is accepted only if it agrees, to within itself, with
    the length from nodes twice as far apart; otherwise it is 0.

    Parameters
    ----------
    edge : index in ``x`` of the node at the edge.
    leads : whether it is the leading edge of its piece of the contact.
    """
    inwards = -1 if leads else 1
    for slip, sign in ((State.SLIP_PLUS, 1.0), (State.SLIP_MINUS, -1.0)):
        lengths = []
        for apart in (1, 2):
            beside = edge + inwards * apart * np.array([1, 2, 3])
            distance = np.abs(x[beside] - x[edge]).tolist()
            values = (friction * state.pressure[beside] - sign * state.shear[beside]).tolist()
            lengths.append(-outward_move(distance, values, smooth=leads))
        near, far = lengths
        if abs(far - near) < near < inf:
            return near, slip
    return 0.0, State.STICK


def outward_move(distance: _Three, values: _Three, *, smooth: bool) -> float:
    """Return how far outwards the end of a zone should move, from values at three nodes inside it.

    The values are fitted by s, s^3 and a third function, s being the square root of the distance
    from the end: the inverse square root of a misplaced end (`RESPONSE`), or s^5 at a smooth end.
    Where the fit does not rise inwards as it should, the result is infinite; its sign still tells
    which way to move.
    """
    first = (1.0, 1.0, 1.0)
    third = [d * d for d in distance] if smooth else RESPONSE
    right = [value / sqrt(d) for value, d in zip(values, distance, strict=True)]
    whole = _determinant(first, distance, third)
    root = _determinant(right, distance, third)
    if smooth:
        bend = _determinant(first, right, third)
        return root / (1.5 * bend) if bend * whole > 0.0 else copysign(inf, root * whole)
    misplaced = _determinant(first, distance, right)
    if root * whole > 0.0:
        return -misplaced / root * distance[0]
    return copysign(inf, -misplaced * whole)


def _determinant(a: _Three, b: _Three, c: _Three) -> float:
    """Return the determinant of the matrix with these three columns."""
    return (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )
