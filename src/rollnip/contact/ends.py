"""By how much the end of a zone is misplaced, from the tractions at the nodes beside it."""

from __future__ import annotations

from collections.abc import Sequence
from math import copysign, inf, sqrt
from typing import TypeVar

from rollnip.contact.problem import Array, ContactState

# Discrete form of the inverse square root that a misplaced end leaves: the change of a square-root
# traction, relative to it, at the first three nodes inside a zone of many cubic elements
# (`subdivided`), per first element by which the zone is too wide. Measured on a parabola pressed on
# a half-plane (tests).
RESPONSE = (-0.6831, -0.1132, -0.0597)

Three = Sequence[float]
_Number = TypeVar("_Number", float, complex)


def roots_beside(
    x: Array, state: ContactState, end: int, step: int, kappa: complex
) -> tuple[list[float], list[complex]]:
    """Return the distances of three nodes from an end, and p + i q there over their square roots.

    Parameters
    ----------
    end : index in ``x`` of the node at the end.
    step : from node to node; its sign points into the zone.
    kappa : see `edge_exponents`. The factor (s/s_1)^kappa is taken out of p + i q at the distances
        s_1, s_2, ... What is left vanishes at the edge as a square root.
    """
    # Plain numbers: NumPy would be slower for three values.
    beside, place = [end + step, end + 2 * step, end + 3 * step], x.item(end)
    distance = [abs(x.item(node) - place) for node in beside]
    tractions = [complex(state.pressure.item(i), state.shear.item(i)) for i in beside]
    roots = [t / sqrt(s) for t, s in zip(tractions, distance, strict=True)]
    if kappa:
        roots = [r * (s / distance[0]) ** -kappa for r, s in zip(roots, distance, strict=True)]
    return distance, roots


def proposed_move(
    x: Array,
    state: ContactState,
    end: int,
    inwards: int,
    weight: complex,
    kappa: complex,
    furthest: int,
) -> float:
    """Return how far outwards the end of a zone should move; see `outward_move`.

    Parameters
    ----------
    x, state : nodes and a solution.
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
        distance, roots = roots_beside(x, state, end, inwards * apart, kappa)
        values = [(weight * root).real for root in roots]
        move, apart = outward_move(distance, values, smooth=furthest > 0), 2 * apart
        reach = distance[-1]
    return move


def singular_part(x: Array, state: ContactState, end: int, inwards: int) -> float:
    """Return the inverse square root in the pressure beside an edge, times its first distance.

    ``end``, ``inwards``: as in `proposed_move`.
    """
    distance, roots = roots_beside(x, state, end, inwards, 0j)
    misplaced = determinant((1.0, 1.0, 1.0), distance, [root.real for root in roots])
    return misplaced / determinant((1.0, 1.0, 1.0), distance, RESPONSE) * distance[0]


def outward_move(distance: Three, roots: Three, *, smooth: bool) -> float:
    """Return how far outwards the end of a zone should move, from values at three nodes inside it.

    The values, here over the square roots of the distances from the end, are fitted by s, s^3 and a
    third function, s being that square root: the inverse square root of a misplaced end
    (`RESPONSE`), or s^5 at a smooth end. Where the fit does not rise inwards as it should, the
    result is infinite; its sign still tells which way to move.
    """
    third = [d * d for d in distance] if smooth else RESPONSE
    whole = determinant((1.0, 1.0, 1.0), distance, third)
    root = determinant(roots, distance, third)
    if smooth:
        bend = determinant((1.0, 1.0, 1.0), roots, third)
        return root / (1.5 * bend) if bend * whole > 0.0 else copysign(inf, root * whole)
    misplaced = determinant((1.0, 1.0, 1.0), distance, roots)
    if root * whole > 0.0:
        return -misplaced / root * distance[0]
    return copysign(inf, -misplaced * whole)


def root_at(distance: Three, roots: Sequence[complex]) -> complex:
    """Return the factor of the square root at an edge, from `roots_beside`."""
    return determinant(roots, distance, RESPONSE) / determinant((1.0, 1.0, 1.0), distance, RESPONSE)


def determinant(a: Sequence[_Number], b: Three, c: Three) -> _Number:
    """Return the determinant of the matrix with these three columns."""
    return (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )
