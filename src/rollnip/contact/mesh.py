"""Meshes with nodes at the ends of zones, at cosine places between, and cubics through these."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import accumulate, pairwise
from math import ceil, inf, log2, pi, sqrt

import numpy as np
from numpy.typing import NDArray
from scipy.special import ellipj, ellipkm1

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

FEWEST_ELEMENTS_OF_A_ZONE = 6
# Share of all elements that a zone has at least: errors show between sizes only where each zone is
# refined.
LEAST_SHARE_OF_A_ZONE = 0.08
# Share taken off the creep from the last node to an edge per shear at that node: the square root of
# the shear at the edge leaves it there although the shear is right. Half-plane (tests).
CREEP_TO_EDGE = 0.02655
_OUTER_NODE_DISTANCE = 1e-3  # of the nodes beyond both ends of cosine places, in edge elements
_PIECES_PER_ELEMENT = 2
_MOST_NODE_VALUES = 500_000  # pieces times the square of the nodes, where pieces are many
_GAUSS_POINTS = 4  # in each piece
_CROWDED_LAYER_LENGTHS = 4.0  # nodes crowd where a zone is longer than so many boundary layers
_ROUNDING = float(np.sqrt(np.finfo(float).eps))  # least share of a zone's length: digits are lost


@dataclass(frozen=True, slots=True)
class Subdivision:
    """Finer nodes between the nodes of a mesh, and the interpolation of values to them.

    On nodes at cosine places a traction is smooth in the *number* of the node, right up to an edge
    where it goes as a square root in x. So a cubic in the number, through four nodes of one zone,
    says what it is between them far better than a straight line in x does.

    Tractions act as straight lines between the finer nodes. The mean of such a line differs from
    the mean of the curve by h^2/12 times the second derivative. So the tractions that act get the
    means of their cubics (each node half of the difference of the pieces on its two sides), and
    all that depends on them is of fourth order rather than second.

    Attributes
    ----------
    nodes : (M+1,) the finer nodes; those subdivided are among them [mm].
    elements : number in each zone before the subdivision; empty where nothing was subdivided, or
        where the zones are not those of a solution (states are sought node by node then).
    crowding : of each zone, see `cosine_nodes`.
    values : (M+1, N+1) values at them per value at the N+1 mesh nodes; None: the same nodes.
    acting : (M+1, N+1) likewise for tractions that act.
    means : (M-1, N) mean values between nodes[1:] per value at the nodes of the mesh but the first.
    edges : numbers of nodes[1:-1] of the mesh at the trailing and leading edge of each piece of
        the contact, in turn.
    """

    nodes: Array
    elements: tuple[int, ...] = ()
    crowding: tuple[float, ...] = ()
    values: Array | None = None
    acting: Array | None = None
    means: Array | None = None
    edges: tuple[int, ...] = ()

    def integrated(self, values: Array) -> Array:
        """Return integrals between nodes[1:] of the mesh of functions with ``values`` there."""
        dx = (self.nodes[2:] - self.nodes[1:-1])[:, None]
        if self.means is None:
            return np.asarray(0.5 * dx * (values[1:] + values[:-1]))
        return np.asarray(self.sums(dx * self.means) @ values)

    def sums(self, pieces: Array) -> Array:
        """Return sums over the intervals of nodes[1:] of the mesh of values on those of these."""
        if self.values is None:
            return pieces
        # Each interval has as many pieces, but the one beyond the last break has not been cut.
        parts = (self.nodes.size - 3) // (self.values.shape[1] - 3)
        out = pieces[::parts].copy()
        for part in range(1, parts):
            out[:-1] += pieces[part:-1:parts]
        return np.asarray(out)


def subdivided(
    nodes: Array,
    elements: Indices,
    crowding: tuple[float, ...] | None = None,
    shortest: float = inf,
    edges: Sequence[int] = (),
) -> Subdivision:
    """Cut every element into equal steps of the node's number, but not those beyond both ends.

    Parameters
    ----------
    nodes : (N+1,) of `cosine_nodes` [mm].
    elements : in each zone, three or more; no cubic reaches from one into another.
    crowding : of each zone, as it was given to `cosine_nodes`.
    shortest :
        largest length of the pieces [mm], unless they become too many. The surface of a thin
        incompressible layer moves as the second derivative of the pressure, which straight lines
        longer than the thickness of the layer do not have.
    edges :
        numbers of nodes[1:-1] as in `Subdivision`; by default the first and the last.
    """
    counts = tuple(elements.tolist())
    crowding = (1.0,) * len(counts) if crowding is None else crowding
    longest = float((nodes[1:] - nodes[:-1]).max())
    most = _MOST_NODE_VALUES // nodes.size**2
    parts = max(min(ceil(longest / shortest), most), _PIECES_PER_ELEMENT)
    values, acting, means = _cubics(counts, crowding, parts)
    finer = _cosine_values(tuple(parts * n for n in counts), crowding)
    finer = finer @ nodes[[1, *_ends(counts)]]
    finer[0], finer[-1] = nodes[0], nodes[-1]
    edges = tuple(edges) or (0, nodes.size - 3)
    return Subdivision(finer, counts, crowding, values, acting, means, edges)


def _ends(elements: tuple[int, ...]) -> list[int]:
    """Return the indices of the last nodes of zones; node 0 lies before the first zone."""
    return [1 + end for end in accumulate(elements)]


def carry(before: Subdivision, after: Subdivision) -> tuple[Array, Array] | None:
    """Return matrices that carry values to another mesh of the same zones, zone by zone.

    The interpolation is cubic in the node's number, as good as that of tractions between nodes.

    Parameters
    ----------
    before, after : zones and their elements.

    Returns
    -------
    Two of (sum of elements after + 1, sum of those before + 1): of values at nodes, and of values
    of the intervals that begin at them, of which the one beyond the leading edge keeps its own.
    None where the zones are not as many or crowd their nodes otherwise, or there are none.
    """
    if before.crowding != after.crowding or not before.elements:
        return None
    counts = before.elements, after.elements
    return _carry(*counts, between=False), _carry(*counts, between=True)


def _carry(before: tuple[int, ...], after: tuple[int, ...], *, between: bool) -> Array:
    out = np.zeros((sum(after) + 1, sum(before) + 1))
    row = column = 0
    for old, new in zip(before, after, strict=True):
        # The last row of a zone is the first of the next one.
        out[row : row + new, column : column + old + 1] = _carry_zone(old, new, between=between)
        row, column = row + new, column + old
    out[-1, -1] = 1.0
    return out


@lru_cache(maxsize=128)
def _carry_zone(old: int, new: int, *, between: bool) -> Array:
    """Return the rows of `_carry` of one zone but the last, (new, old + 1)."""
    shift = 0.5 if between else 0.0
    places = (np.arange(new) + shift) * (old / new) - shift
    first = np.clip(np.floor(places).astype(int) - 1, 0, old - (4 if between else 3))
    out = np.zeros((new, old + 1))
    out[np.arange(new)[:, None], first[:, None] + np.arange(4)] = _cubic_weights(places - first)
    out.setflags(write=False)
    return out


def cubic_error(values: Array, nodes: Array, elements: tuple[int, ...]) -> float:
    """Return the integral of the errors of the cubics of `subdivided` through values at nodes.

    Between the inner two of four points an error is 3/128 of the fourth difference, from five
    points. An error on a short element beside an edge matters as little as that element is long.

    Parameters
    ----------
    values : (sum of elements + 1,) at the nodes from the first break to the last.
    nodes : their places [mm].
    elements : in each zone.
    """
    fourth = np.abs(
        values[4:] - 4.0 * (values[3:-1] + values[1:-3]) + 6.0 * values[2:-2] + values[:-4]
    )
    for end in accumulate(elements[:-1]):
        fourth[end - 3 : end] = 0.0  # across a break nothing is smooth
    return float(3.0 / 128.0 * fourth @ (0.5 * (nodes[3:-1] - nodes[1:-3])))


@lru_cache(maxsize=8)  # as meshes of one size that differ in the places of their ends
def _cubics(
    elements: tuple[int, ...], crowding: tuple[float, ...], pieces: int
) -> tuple[Array, Array, Array]:
    """Return the matrices values, acting and means of a `Subdivision`."""
    count = sum(elements)
    values, acting = np.zeros((2, pieces * count + 3, count + 3))
    means = np.zeros((pieces * count + 1, count + 2))
    for matrix in (values, acting):
        matrix[0, 0] = matrix[-1, -1] = 1.0
    means[-1, -2:] = 0.5
    row = column = 0
    for n, ratio in zip(elements, crowding, strict=True):
        rows = row + pieces * n
        at_nodes = np.s_[row + 1 : rows + 2, column + 1 : column + n + 2]
        zone = _zone_cubics(n, ratio, pieces)
        values[at_nodes], acting[at_nodes], means[row:rows, column : column + n + 1] = zone
        row, column = rows, column + n
    for matrix in (values, acting, means):
        matrix.setflags(write=False)
    return values, acting, means


@lru_cache(maxsize=128)
def _zone_cubics(n: int, ratio: float, pieces: int) -> tuple[Array, Array, Array]:
    """Return what one zone of ``n`` elements adds to `_cubics`.

    Values and acting tractions at its finer nodes, (pieces n + 1, n + 1) each, and means between
    these.
    """
    interval, parts = np.arange(n), np.arange(pieces) / pieces
    first = np.minimum(np.maximum(interval - 1, 0), n - 3)
    rows = np.arange(pieces * n)[:, None]
    columns = np.repeat(first[:, None] + np.arange(4), pieces, axis=0)
    values = np.zeros((rows.size + 1, n + 1))
    values[rows, columns] = _cubic_weights((interval - first)[:, None] + parts).reshape(-1, 4)
    values[-1, -1] = 1.0

    # Means over x, by Gauss points in the number of the node.
    points, weights = np.polynomial.legendre.leggauss(_GAUSS_POINTS)
    inside = parts[:, None] + 0.5 * (1.0 + points) / pieces
    slope = weights * _places((interval[:, None, None] + inside) / n, ratio)[1]
    cubics = _cubic_weights((interval - first)[:, None, None] + inside)
    mean = (slope[..., None] * cubics).sum(axis=2) / slope.sum(axis=2)[..., None]
    means = np.zeros((rows.size, n + 1))
    means[rows, columns] = mean.reshape(-1, 4)

    lacking = means - 0.5 * (values[:-1] + values[1:])
    acting = values.copy()
    acting[1:-1] += 0.5 * (lacking[1:] + lacking[:-1])  # across a break nothing is smooth
    for matrix in (values, acting, means):
        matrix.setflags(write=False)
    return values, acting, means


def _cubic_weights(t: Array) -> Array:
    """Return the weights of values at 0, 1, 2, 3 in the cubic through them at ``t``; (..., 4)."""
    a, b, c = t - 1.0, t - 2.0, t - 3.0
    return np.stack([-a * b * c / 6.0, t * b * c / 2.0, -t * a * c / 2.0, t * a * b / 6.0], axis=-1)


def crowding_of(breaks: Array, length: float) -> tuple[float, ...]:
    """Return how strongly nodes crowd at the ends of each zone to resolve boundary layers there.

    Each value is a power of two, so that zones that move a little keep theirs.

    Parameters
    ----------
    breaks : (m,) ends of zones [mm].
    length : of the boundary layers [mm].
    """
    wanted = [
        _CROWDED_LAYER_LENGTHS * length / (stop - start)
        for start, stop in pairwise(breaks.tolist())
    ]
    shares = (min(max(share, _ROUNDING), 1.0) for share in wanted)
    return tuple(2.0 ** ceil(log2(share)) for share in shares)


def elements_of_zones(
    breaks: Array,
    count: int,
    crowding: tuple[float, ...] | None = None,
    least_share: float = LEAST_SHARE_OF_A_ZONE,
) -> Indices:
    """Return the number of elements in each zone between ``breaks`` (m,) [mm]; (m - 1,).

    They are about ``count`` in all, and more where nodes crowd. A zone has ``least_share`` of them,
    and six, at least.
    """
    shares = [sqrt(stop - start) for start, stop in pairwise(breaks.tolist())]
    total = sum(shares)
    fewest = max(FEWEST_ELEMENTS_OF_A_ZONE, round(least_share * count))
    more = [1.0] * len(shares) if crowding is None else [more_elements(ratio) for ratio in crowding]
    return np.array(
        [
            max(round(count * share / total), fewest) * longer
            for share, longer in zip(shares, more, strict=True)
        ]
    ).astype(int)


@lru_cache(maxsize=128)
def more_elements(ratio: float) -> float:
    """Return the factor by which crowding nodes raises the number of elements of a zone."""
    return sqrt(float(ellipkm1(ratio * ratio)) / (0.5 * pi))


def cosine_nodes(
    breaks: Array, elements: Indices, crowding: tuple[float, ...] | None = None
) -> Array:
    """Return nodes at cosine places on each zone between ``breaks``, and one beyond either end.

    Where a zone crowds its nodes by r < 1, cosines become elliptic functions: the share y of the
    zone's length that lies before the share s of its elements is, with the modulus k' = r,

        y/(1 - y) = r sc(K s)^2,

    for r = 1 that of cosine places. At either end y still goes as the square of s, but only up to
    y = r; from there to the other end its logarithm goes evenly. So a boundary layer of that
    length has its share of the nodes, and the roots at the ends are straight lines in the number.

    Parameters
    ----------
    breaks : (m,) increasing: contact edges and the transitions between [mm].
    elements : (m - 1,) number of them in each zone.
    crowding : (m - 1,) r of each zone; None: 1 everywhere.
    """
    crowding = (1.0,) * elements.size if crowding is None else crowding
    return np.asarray(_cosine_values(tuple(elements.tolist()), crowding) @ breaks)


def _places(share: Array, ratio: float) -> tuple[Array, Array]:
    """Return the place in a zone of length 1 for a share of its elements, and its derivative."""
    if ratio == 1.0:
        return 0.5 * (1.0 - np.cos(pi * share)), 0.5 * pi * np.sin(pi * share)
    quarter = float(ellipkm1(ratio * ratio))
    sn, cn, dn, _ = ellipj(quarter * np.minimum(share, 1.0 - share), 1.0 - ratio * ratio)
    below = ratio * sn * sn / (cn * cn + ratio * sn * sn)
    slope = 2.0 * quarter * ratio * sn * cn * dn / (cn * cn + ratio * sn * sn) ** 2
    return np.where(share > 0.5, 1.0 - below, below), slope


@lru_cache(maxsize=128)
def _cosine_values(elements: tuple[int, ...], crowding: tuple[float, ...]) -> Array:
    """Return the derivative of `cosine_nodes` by the place of each break."""
    values = np.zeros((sum(elements) + 3, len(elements) + 1))
    first = 1
    for zone, (n, ratio) in enumerate(zip(elements, crowding, strict=True)):
        cosine = _places(np.arange(n + 1) / n, ratio)[0]
        cosine[-1] = 1.0
        values[first : first + n + 1, zone] = 1.0 - cosine
        values[first : first + n + 1, zone + 1] = cosine
        first += n
    values[0] = values[1] - _OUTER_NODE_DISTANCE * (values[2] - values[1])
    values[-1] = values[-2] + _OUTER_NODE_DISTANCE * (values[-2] - values[-3])
    values.setflags(write=False)
    return values
