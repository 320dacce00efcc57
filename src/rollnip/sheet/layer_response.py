r"""Displacements of the faces of an elastic layer under tractions that are straight lines.

A displacement that goes as a share of the traction's waves, by their length over the thickness h,
is in space a long-wave part, which is in proportion to the traction there, and a part that decays
within a few h. A straight line turns at its nodes, and each turn acts by the double integral of the
latter: `FaceResponse.cubics` tabulate it over the distance from the node.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

FAR = 6.0  # over the thickness: what decays is 1e-12 there, it falls as exp(-4.2 distance)
_PLACES = 400  # of a table, crowded at 0, where what is tabulated goes as t^2 log t
DISTANCES = FAR * np.linspace(0.0, 1.0, _PLACES) ** 4
"""Distances over the thickness at which responses are tabulated."""
_AT_ONCE = 64  # nodes: what these need stays in a fast memory
_ROOTS = 1000


@dataclass(frozen=True, slots=True)
class FaceResponse:
    """Displacement of both faces of a layer per traction on one of them, over its thickness.

    Each pair is for the face that the traction acts on and for the other face.

    Attributes
    ----------
    values : displacement per traction at the same place.
    slopes : displacement per slope of the traction at the same place, over the thickness.
    cubics : (4, 2 (places - 1)) cubics between the places of the tables of both faces, one after
        the other; highest power first.
    is_odd : whether the displacement by a turn has one sign behind its node and the other ahead.
    """

    values: tuple[float, float]
    slopes: tuple[float, float]
    cubics: Array
    is_odd: bool = False


def tabulated(near: Array, far: Array) -> Array:
    """Return the cubics of `FaceResponse` from the values at `DISTANCES` of both faces."""
    # loads more than 200 modules, which a nip without a sheet does not need
    from scipy.interpolate import CubicSpline

    places = np.arange(_PLACES)
    return np.concatenate([CubicSpline(places, one).c for one in (near, far)], axis=1)


def displacements(
    responses: Sequence[FaceResponse],
    thickness: float,
    x: Array,
    nodes: Array,
    lines: Array,
    is_far: Mask,
) -> list[Array]:
    """Return the displacements by several responses at some places, each (m, s).

    Parameters
    ----------
    responses : of the layer.
    thickness : of the layer [mm].
    x : (m,) places [mm].
    nodes : (N + 1,) between which tractions are straight lines [mm].
    lines : (N + 1, s) sets of tractions at the nodes, 0 at both ends [MPa].
    is_far : (m,) whether a place is on the face opposite to the tractions.
    """
    steps, face = np.diff(nodes), is_far.astype(np.intp)
    # Slopes of the lines, 0 beyond both ends, times the thickness.
    slopes = np.zeros((nodes.size + 1, lines.shape[1]))
    np.subtract(lines[1:], lines[:-1], out=slopes[1:-1])
    slopes[1:-1] *= (thickness / steps)[:, None]
    values: Array | None = None
    out = []
    for one in responses:
        made = np.zeros((x.size, lines.shape[1]))
        if any(one.values):
            values = _between(x, nodes, lines) if values is None else values
            np.multiply(np.array(one.values)[face, None], values, out=made)
        if any(one.slopes):
            here = slopes[np.searchsorted(nodes, x)] + slopes[np.searchsorted(nodes, x, "right")]
            made += 0.5 * np.array(one.slopes)[face, None] * here
        out.append(made)
    _add_turns(out, responses, (x / thickness, nodes / thickness, face), np.diff(slopes, axis=0))
    return out


def _between(x: Array, nodes: Array, lines: Array) -> Array:
    """Return the values at ``x`` of straight lines between nodes, 0 beyond them."""
    at = np.clip(np.searchsorted(nodes, x, side="right") - 1, 0, nodes.size - 2)
    share = (x - nodes[at]) / (nodes[at + 1] - nodes[at])
    share[(share < 0.0) | (share > 1.0)] = 0.0  # values are 0 at both ends
    inside = ((x >= nodes[0]) & (x <= nodes[-1])).astype(float)
    weights = (inside * (1.0 - share))[:, None], (inside * share)[:, None]
    return np.asarray(weights[0] * lines[at] + weights[1] * lines[at + 1])


def _add_turns(
    out: Sequence[Array],
    responses: Sequence[FaceResponse],
    places: tuple[Array, Array, NDArray[np.intp]],
    turns: Array,
) -> None:
    """Add what the turns of the lines at their nodes make near by.

    ``places``: those of the displacements and of the nodes over the thickness, and the face of each
    of the former; ``turns``: (N + 1, s) changes of slope at the nodes, times the thickness.
    """
    x, nodes, face = places
    for start in range(0, nodes.size, _AT_ONCE):
        some = slice(start, start + _AT_ONCE)
        ends = nodes[some]
        near = np.flatnonzero((x > ends[0] - FAR) & (x < ends[-1] + FAR))
        sets = np.flatnonzero(turns[some].any(axis=0))  # of a few neighbours each, as a rule
        if not (near.size and sets.size):
            continue
        columns = slice(int(sets[0]), int(sets[-1]) + 1)
        away = x[near, None] - ends
        place = np.sqrt(np.sqrt(np.minimum(np.abs(away), FAR) / FAR))
        place *= _PLACES - 1
        piece = np.minimum(place.astype(np.intp), _PLACES - 2)
        place -= piece
        piece += (_PLACES - 1) * face[near, None]
        for made, one in zip(out, responses, strict=True):
            spread = one.cubics[0].take(piece)
            for row in one.cubics[1:]:
                spread *= place
                spread += row.take(piece)
            if one.is_odd:
                spread *= -np.sign(away)
            made[near, columns] += spread @ turns[some, columns]


def roots(sign: float) -> NDArray[np.complex128]:
    """Return the first roots of sinh y + sign y = 0 in the first quadrant."""
    about = pi * (2.0 * np.arange(1, _ROOTS + 1) - 0.5 * sign)
    root = np.log(2.0 * about) + 1j * about
    for _ in range(20):  # Newton's method
        root = root - (np.sinh(root) + sign * root) / (np.cosh(root) + sign)
    return np.asarray(root)
