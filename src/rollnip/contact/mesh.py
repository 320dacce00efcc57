"""Meshes with nodes at the ends of zones and cosine nodes between, with cubic interpolation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import accumulate, pairwise
from math import pi, sqrt

import numpy as np
from scipy.special import ellipj, ellipkm1

from rollnip.contact.cubics import cubic_matrix, gauss_points, with_means
from rollnip.contact.problem import Array, Indices, Mask

Crowding = tuple[tuple[float, float], ...]
"""How strongly nodes crowd at the start and at the stop of each zone, see `cosine_nodes`."""

FEWEST_ELEMENTS_OF_A_ZONE = 6
# Least share of all elements that a zone has: the difference between two mesh sizes shows an error
# only where every zone is refined.
LEAST_SHARE_OF_A_ZONE = 0.08
_OUTER_NODE_DISTANCE = 1e-3  # of the nodes beyond both edges, in lengths of the first element
PIECES_PER_ELEMENT = 2  # linear pieces of the acting tractions, at least
_CROWDED_LAYER_LENGTHS = 4.0  # nodes crowd in zones longer than this many boundary layers
_ROUNDING = float(np.sqrt(np.finfo(float).eps))  # least crowding; below it digits are lost


@dataclass(frozen=True, slots=True)
class Subdivision:
    """Finer nodes between the nodes of a mesh, and the interpolation of nodal values to them.

    Nodal tractions are interpolated by cubics in the node *index*, through four nodes of one zone.
    On cosine nodes a traction is smooth in the index, right up to an edge where it goes as a square
    root in x, so that this is far better than a straight line in x.

    Displacements are computed from a traction that is linear between the finer nodes, the acting
    one. The mean of a linear piece differs from that of the curve by h^2/12 times the second
    derivative. So the acting traction is adjusted to have the means of the cubics: each node takes
    half of the differences on its two sides. That makes everything computed from it fourth-order
    accurate rather than second.

    Attributes
    ----------
    nodes : (M+1,) the finer nodes, including those of the mesh [mm].
    elements : number in each zone before the subdivision; empty where nothing was subdivided, or
        where the zones are not those of a solution, as in a search node by node.
    crowding : of each zone, see `cosine_nodes`.
    values : (M+1, N+1) from nodal values to the values of the cubics; None: the nodes are the same.
    acting : (M+1, N+1) from nodal values to those of the acting traction; None likewise.
    means : (M-1, N) from nodal values, but the first, to means of the cubics between nodes[1:].
    edges : indices in nodes[1:-1] of the mesh of the trailing and leading edge of each piece of
        the contact, in turn.
    exponents : at the edge or transition at each of `breaks`, see `edge_exponents`; 0 for a square
        root, and where tractions are smooth.
    pieces : number of linear pieces of an element, except those beyond both edges, which have one.
    """

    nodes: Array
    elements: tuple[int, ...] = ()
    crowding: Crowding = ()
    values: Array | None = None
    acting: Array | None = None
    means: Array | None = None
    edges: tuple[int, ...] = ()
    exponents: tuple[complex, ...] = ()
    pieces: int = 1

    @property
    def breaks(self) -> list[int]:
        """Indices in nodes[1:-1] of the mesh of the breaks beside and between its zones."""
        return [0, *accumulate(self.elements)]

    @property
    def inner_breaks(self) -> list[int]:
        """Indices in nodes[1:-1] of the mesh of the breaks between its zones."""
        return self.breaks[1:-1]

    def exponent_at(self, node: int) -> complex:
        """Return the exponent at a node of the mesh."""
        return dict(zip(self.breaks, self.exponents, strict=False)).get(node, 0j)

    @property
    def unlike_ends(self) -> list[tuple[int, complex, int]]:
        """Ends of zones with exponents: index in nodes[1:-1], exponent, and the step inwards.

        At a transition two zones end.
        """
        edges = {node: -1 if number % 2 else 1 for number, node in enumerate(self.edges)}
        return [
            (node, kappa, inwards)
            for node, kappa in zip(self.breaks, self.exponents, strict=False)
            for inwards in ((edges[node],) if node in edges else (-1, 1))
            if kappa
        ]

    def integrated(self, values: Array) -> Array:
        """Return the integrals between nodes[1:] of the mesh of functions with ``values`` there."""
        dx = (self.nodes[2:] - self.nodes[1:-1])[:, None]
        if self.means is None:
            return np.asarray(0.5 * dx * (values[1:] + values[:-1]))
        return np.asarray(self.sums(dx * self.means) @ values)

    def sums(self, pieces: Array) -> Array:
        """Return, for each interval of the mesh's nodes[1:], the sum of ``pieces`` within it."""
        out = pieces[:: self.pieces].copy()
        for part in range(1, self.pieces):
            out[:-1] += pieces[part : -1 : self.pieces]
        return out


def subdivided(
    nodes: Array,
    elements: Indices,
    crowding: Crowding | None = None,
    pieces: int = PIECES_PER_ELEMENT,
    edges: Sequence[int] = (),
    exponents: tuple[complex, ...] = (),
) -> Subdivision:
    """Return a mesh with every element cut into equal steps of the node index.

    The elements beyond both edges are not cut.

    Parameters
    ----------
    nodes : (N+1,) from `cosine_nodes` [mm].
    elements : in each zone, three or more; no cubic extends across a break.
    crowding : of each zone, as given to `cosine_nodes`.
    pieces :
        linear pieces of an element.
    edges :
        indices in nodes[1:-1] as in `Subdivision`; by default the first and the last.
    exponents :
        as in `Subdivision`; by default all 0.
    """
    counts = tuple(elements.tolist())
    crowding = uncrowded(len(counts)) if crowding is None else crowding
    values, acting, means = _cubics(counts, crowding, pieces)
    finer = _cosine_values(tuple(pieces * n for n in counts), crowding)
    finer = finer @ nodes[np.cumsum([1, *counts])]
    finer[0], finer[-1] = nodes[0], nodes[-1]
    edges = tuple(edges) or (0, nodes.size - 3)
    exponents = exponents or (0j,) * (len(counts) + 1)
    return Subdivision(finer, counts, crowding, values, acting, means, edges, exponents, pieces)


def carry(before: Subdivision, after: Subdivision) -> tuple[Array, Array] | None:
    """Return matrices that interpolate values to another mesh of the same zones, zone by zone.

    The interpolation is cubic in the node index, as accurate as that of tractions between nodes.

    Parameters
    ----------
    before, after : the meshes interpolated from and to.

    Returns
    -------
    Two matrices (sum of elements after + 1, sum of those before + 1): for values at nodes, and for
    values of the intervals that begin at them; the interval beyond the leading edge keeps its own.
    None where the meshes differ in the number or the crowding of their zones, or have none.
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
        zone = _carry_zone(old, new, between=between)
        out[row : row + new, column : column + zone.shape[1]] = zone
        row, column = row + new, column + old
    out[-1, -1] = 1.0
    return out


@lru_cache(maxsize=128)
def _carry_zone(old: int, new: int, *, between: bool) -> Array:
    """Return the rows of `_carry` for one zone, without its last row."""
    shift = 0.5 if between else 0.0
    places: Array = (np.arange(float(new)) + shift) * (old / new) - shift
    out = cubic_matrix(places, old if between else old + 1)
    out.setflags(write=False)
    return out


def cubic_error(
    values: Array,
    nodes: Array,
    elements: tuple[int, ...],
    crowding: Crowding,
    left_out: Mask,
) -> float:
    """Return the estimated error of cubic interpolation between nodes, integrated over x.

    Between the middle two of four points the error is 3/128 of the fourth difference, which takes
    five points. Integrated, an error counts in proportion to the length of its element, so little
    in the short elements beside an edge. In a zone whose nodes crowd, boundary layers matter more
    than their length says: at the share y of the zone from an end, but not nearer than the crowding
    r there, an error counts 1/sqrt(y) times.

    Parameters
    ----------
    values : (sum of elements + 1,) at the nodes from the first break to the last.
    nodes : their places [mm].
    elements, crowding : of each zone.
    left_out : (sum of elements + 1,) nodes whose values are not counted.
    """
    fourth = np.abs(
        values[4:] - 4.0 * (values[3:-1] + values[1:-3]) + 6.0 * values[2:-2] + values[:-4]
    )
    ends = [0, *accumulate(elements)]
    for end in ends[1:-1]:
        fourth[end - 3 : end] = 0.0  # values are not smooth across a break
    for offset in range(5):
        fourth[left_out[offset : left_out.size - 4 + offset]] = 0.0
    counted = np.ones(nodes.size)
    for (start, stop), (first, last) in zip(pairwise(ends), crowding, strict=True):
        if min(first, last) < 1.0:
            zone = nodes[start : stop + 1]
            share = (zone - zone[0]) / (zone[-1] - zone[0])
            nearer = np.minimum(np.maximum(share, first), np.maximum(1.0 - share, last))
            counted[start : stop + 1] = 1.0 / np.sqrt(nearer)
    lengths = 0.5 * (nodes[3:-1] - nodes[1:-3]) * counted[2:-2]
    return float(3.0 / 128.0 * fourth @ lengths)


@lru_cache(maxsize=8)  # meshes of one size that differ only in the places of their breaks share it
def _cubics(
    elements: tuple[int, ...], crowding: Crowding, pieces: int
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
def _zone_cubics(n: int, ratio: tuple[float, float], pieces: int) -> tuple[Array, Array, Array]:
    """Return the block of one zone of ``n`` elements in the matrices of `_cubics`.

    Its parts are the values and the acting tractions at the finer nodes of the zone,
    (pieces n + 1, n + 1) each, and the means between these, (pieces n, n + 1).
    """
    finer = np.arange(pieces * n + 1) / pieces
    values = cubic_matrix(finer, n + 1)
    # Means over x, by Gauss quadrature in the node index. As many points as a cubic has nodes are
    # exact for a cubic times a slope dx/ds of the fourth degree, which a piece is short enough for.
    points, weights = gauss_points(4)
    inside = finer[:-1, None] + 0.5 * (1.0 + points) / pieces
    slope = weights * _places(inside / n, ratio)[1]
    means = (slope[..., None] * cubic_matrix(inside, n + 1)).sum(axis=1)
    means /= slope.sum(axis=1)[:, None]
    acting = with_means(values, means)
    for matrix in (values, acting, means):
        matrix.setflags(write=False)
    return values, acting, means


def uncrowded(zones: int) -> Crowding:
    """Return the crowding of cosine nodes, which do not crowd."""
    return ((1.0, 1.0),) * zones


def crowding_of(breaks: Array, length: float | Array) -> Crowding:
    """Return the crowding of nodes in each zone that resolves boundary layers at its ends.

    See `cosine_nodes`. Each value is a power of two, so that it does not change when ends move a
    little.

    Parameters
    ----------
    breaks : (m,) ends of zones [mm].
    length : of the boundary layers, one for all or (m - 1, 2) at the start and stop of zones [mm].
    """
    lengths = (breaks[1:] - breaks[:-1])[:, None] * np.ones(2)
    wanted = (_CROWDED_LAYER_LENGTHS * length / lengths).clip(_ROUNDING, 1.0)
    return tuple((start, stop) for start, stop in np.exp2(np.ceil(np.log2(wanted))).tolist())


def elements_of_zones(
    breaks: Array,
    count: int,
    crowding: Crowding | None = None,
    least_share: float = LEAST_SHARE_OF_A_ZONE,
) -> Indices:
    """Return the number of elements in each zone between ``breaks`` (m,) [mm]; (m - 1,).

    They are about ``count`` in all, and more where nodes crowd. Each zone gets at least
    ``least_share`` of ``count``, and at least `FEWEST_ELEMENTS_OF_A_ZONE`.
    """
    shares = np.sqrt(breaks[1:] - breaks[:-1])
    fewest = max(FEWEST_ELEMENTS_OF_A_ZONE, round(least_share * count))
    counts: Array = np.maximum(np.rint(count * shares / shares.sum()), fewest)
    counts *= [more_elements(ratio) for ratio in crowding or uncrowded(counts.size)]
    return counts.astype(np.intp)


@lru_cache(maxsize=128)
def more_elements(ratio: tuple[float, float]) -> float:
    """Return the factor by which crowding raises the number of elements of a zone."""
    return sqrt(float(ellipkm1(ratio[0] * ratio[1])) / (0.5 * pi))


def cosine_nodes(breaks: Array, elements: Indices, crowding: Crowding | None = None) -> Array:
    """Return cosine nodes on each zone between ``breaks``, and one node beyond either end.

    In a zone whose nodes crowd by a at its start and by b at its stop, the cosine becomes an
    elliptic function. The share y of the zone's length covered by the share s of its elements is,
    with modulus k' = sqrt(a b),

        y/(1 - y) = a sc(K s)^2,

    which for a = b = 1 is the cosine. At either end y still grows as the square of s, but only up
    to y = a, or 1 - y = b; beyond, nodes are spaced evenly in its logarithm. So a boundary layer of
    that length gets its share of the nodes, and square roots at the ends are linear in the node
    index.

    Parameters
    ----------
    breaks : (m,) increasing: edges of the contact and transitions [mm].
    elements : (m - 1,) number of them in each zone.
    crowding : (m - 1,) a and b of each zone; None: 1 everywhere.
    """
    crowding = uncrowded(elements.size) if crowding is None else crowding
    return np.asarray(_cosine_values(tuple(elements.tolist()), crowding) @ breaks)


def _places(share: Array, ratio: tuple[float, float]) -> tuple[Array, Array]:
    """Return the place y in a zone of length 1 for the share s of its elements, and dy/ds."""
    if ratio == (1.0, 1.0):
        return 0.5 * (1.0 - np.cos(pi * share)), 0.5 * pi * np.sin(pi * share)
    start, stop = ratio
    quarter = float(ellipkm1(start * stop))
    sn, cn, dn, _ = ellipj(quarter * np.minimum(share, 1.0 - share), 1.0 - start * stop)
    scale = np.where(share > 0.5, stop, start)
    below = scale * sn * sn / (cn * cn + scale * sn * sn)
    slope = 2.0 * quarter * scale * sn * cn * dn / (cn * cn + scale * sn * sn) ** 2
    return np.where(share > 0.5, 1.0 - below, below), slope


@lru_cache(maxsize=128)
def _cosine_values(elements: tuple[int, ...], crowding: Crowding) -> Array:
    """Return the derivative of `cosine_nodes` with respect to the place of each break."""
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
