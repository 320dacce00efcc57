"""Meshes graded to contact edges, to transitions between stick and slip, and to the tractions."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import accumulate, pairwise
from math import ceil, inf, log2, pi, sqrt

import numpy as np
from numpy.typing import NDArray
from scipy.special import ellipj, ellipkm1

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

_SMALLEST_ZONE = 6  # elements in a zone, however short
# Share of the nodes placed by the demand of a former solution; more of `_MANY` elements and up, for
# tractions that so many do not resolve bend inside the zones rather than at their ends.
_ASKED = 0.15
_ASKED_OF_MANY = 0.4
_MANY = 150
# Share where the demand on some elements at cosine places is `_PEAKED` times their number or more:
# peaks under a stiff skin, a few of its thicknesses wide.
_ASKED_OF_PEAKS = 0.7
_PEAKED = 2.0
_FINER = 8  # places in an element at which the demand is looked at
# Share taken off the creep from the last node to an edge per shear at that node: the square root of
# the shear at the edge leaves it there although the shear is right. Half-plane (tests).
CREEP_TO_EDGE = 0.02655
_BESIDE = 1e-3  # elements: nodes beyond both ends of cosine places, where tractions end
_PARTS, _MOST_PARTS = 2, 64  # of an element
_MOST_VALUES = 500_000  # of displacements at nodes per traction of a piece, where parts are many
_POINTS = 4  # of Gauss in each of these
_LAYERS = 4.0  # lengths of a boundary layer up to which nodes at the end of a zone crowd
_MOST_CROWDED = 2.0**-20
_MARGIN = np.array([1.0, 2.0, 4.0, 8.0])  # nodes outside the contact, in edge elements


@dataclass(frozen=True, slots=True)
class Demand:
    """Number of elements that tractions need: the integral of |f''|^(1/3) over each interval.

    Linear interpolation of f errs by f'' h^2/12 on average; with a given number of elements the
    integral of the error is smallest where h goes as |f''|^(-1/3).

    Attributes
    ----------
    x : (n,) increasing places [mm].
    total : (n,) elements needed from x[0] up to each place, in an arbitrary unit.
    """

    x: Array
    total: Array

    @classmethod
    def of(cls, x: Array, *tractions: Array) -> Demand:
        """Return the demand of nodal tractions (each (n,)), each relative to its largest value."""
        density = np.zeros(x.size)
        for values in tractions:
            largest = np.max(np.abs(values))
            if largest > 0.0:
                density = np.maximum(density, _bend(x, values / largest) ** (1.0 / 3.0))
        smooth = np.convolve(np.pad(density, 2, mode="edge"), [0.1, 0.2, 0.4, 0.2, 0.1], "valid")
        steps = 0.5 * (smooth[1:] + smooth[:-1]) * np.diff(x)
        return cls(x, np.concatenate([[0.0], np.cumsum(steps)]))

    def up_to(self, places: Array) -> Array:
        """Return the number of elements needed up to each place."""
        return np.interp(places, self.x, self.total)


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
    elements : number in each zone before the subdivision; empty where nothing was subdivided.
    crowding : of each zone, see `cosine_nodes`.
    values : (M+1, N+1) values at them per value at the N+1 mesh nodes; None: the same nodes.
    acting : (M+1, N+1) likewise for tractions that act.
    means : (M-1, N) mean values between nodes[1:] per value at the nodes of the mesh but the first.
    """

    nodes: Array
    elements: tuple[int, ...] = ()
    crowding: tuple[float, ...] = ()
    values: Array | None = None
    acting: Array | None = None
    means: Array | None = None


def subdivided(
    nodes: Array,
    elements: Indices,
    crowding: tuple[float, ...] | None = None,
    shortest: float = inf,
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
    """
    counts = tuple(elements.tolist())
    crowding = (1.0,) * len(counts) if crowding is None else crowding
    longest = float(np.max(np.diff(nodes)))
    most = min(_MOST_PARTS, _MOST_VALUES // nodes.size**2)
    parts = max(min(ceil(longest / shortest), most), _PARTS)
    values, acting, means = _cubics(counts, crowding, parts)
    finer = _cosine_values(tuple(parts * n for n in counts), crowding)
    finer = finer @ nodes[[1, *_ends(counts)]]
    finer[0], finer[-1] = nodes[0], nodes[-1]
    return Subdivision(finer, counts, crowding, values, acting, means)


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


@lru_cache(maxsize=128)
def _carry(before: tuple[int, ...], after: tuple[int, ...], *, between: bool) -> Array:
    out = np.zeros((sum(after) + 1, sum(before) + 1))
    row = column = 0
    shift = 0.5 if between else 0.0
    for old, new in zip(before, after, strict=True):
        places = (np.arange(new + 1) + shift) * (old / new) - shift
        first = np.clip(np.floor(places).astype(int) - 1, 0, old - (4 if between else 3))
        columns = column + first[:, None] + np.arange(4)
        out[row + np.arange(new + 1)[:, None], columns] = _cubic_weights(places - first)
        row, column = row + new, column + old
        if row < out.shape[0] - 1:
            out[row] = 0.0  # shared with the next zone, which writes it
    if between:
        out[-1], out[-1, -1] = 0.0, 1.0
    out.setflags(write=False)
    return out


def cubic_error(values: Array, elements: tuple[int, ...]) -> float:
    """Return the largest error of the cubics of `subdivided` through values at element ends.

    Between the inner two of four points it is 3/128 of the fourth difference, from five points.

    Parameters
    ----------
    values : (sum of elements + 1,) at the nodes from the first break to the last.
    elements : in each zone.
    """
    fourth = np.abs(
        values[4:] - 4.0 * (values[3:-1] + values[1:-3]) + 6.0 * values[2:-2] + values[:-4]
    )
    for end in accumulate(elements[:-1]):
        fourth[end - 3 : end] = 0.0  # across a break nothing is smooth
    return float(3.0 / 128.0 * fourth.max(initial=0.0))


@lru_cache(maxsize=64)
def _cubics(
    elements: tuple[int, ...], crowding: tuple[float, ...], pieces: int
) -> tuple[Array, Array, Array]:
    """Return the matrices values, acting and means of a `Subdivision`."""
    ends = np.concatenate([[0], np.cumsum(elements)])
    interval = np.arange(ends[-1])
    zone = np.searchsorted(ends, interval, side="right") - 1
    first = np.minimum(np.maximum(interval - 1, ends[zone]), ends[zone + 1] - 3)
    parts = np.arange(pieces) / pieces
    columns = 1 + np.repeat(first[:, None] + np.arange(4), pieces, axis=0)
    rows = np.arange(columns.shape[0])[:, None]

    values = np.zeros((rows.size + 3, interval.size + 3))
    values[0, 0] = values[-2, -2] = values[-1, -1] = 1.0
    values[1 + rows, columns] = _cubic_weights((interval - first)[:, None] + parts).reshape(-1, 4)

    # Means over x, by Gauss points in the number of the node.
    points, weights = np.polynomial.legendre.leggauss(_POINTS)
    inside = parts[:, None] + 0.5 * (1.0 + points) / pieces
    number = (interval - ends[zone])[:, None, None] + inside
    slope = np.empty(number.shape)
    for i, (n, crowd) in enumerate(zip(elements, crowding, strict=True)):
        slope[zone == i] = weights * _places(number[zone == i] / n, crowd)[1]
    cubics = _cubic_weights((interval - first)[:, None, None] + inside)
    mean = (slope[..., None] * cubics).sum(axis=2) / slope.sum(axis=2)[..., None]
    means = np.zeros((rows.size + 1, interval.size + 3))
    means[rows, columns] = mean.reshape(-1, 4)
    means[-1, -2:] = 0.5

    lacking = means[:-1] - 0.5 * (values[1:-2] + values[2:-1])
    acting = values.copy()
    added = 0.5 * (lacking[1:] + lacking[:-1])
    added[pieces * ends[1:-1] - 1] = 0.0
    acting[2:-2] += added
    for matrix in (values, acting, means):
        matrix.setflags(write=False)
    return values, acting, means[:, 1:]


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
    wanted = [_LAYERS * length / (stop - start) for start, stop in pairwise(breaks.tolist())]
    shares = (min(max(share, _MOST_CROWDED), 1.0) for share in wanted)
    return tuple(2.0 ** ceil(log2(share)) for share in shares)


def elements_of_zones(
    breaks: Array, count: int, crowding: tuple[float, ...] | None = None
) -> Indices:
    """Return the number of elements in each zone between ``breaks`` (m,) [mm]; (m - 1,).

    They are about ``count`` in all, and more where nodes crowd.
    """
    shares = [sqrt(stop - start) for start, stop in pairwise(breaks.tolist())]
    total = sum(shares)
    more = [1.0] * len(shares) if crowding is None else [more_elements(crowd) for crowd in crowding]
    return np.array(
        [
            max(round(count * share / total), _SMALLEST_ZONE) * longer
            for share, longer in zip(shares, more, strict=True)
        ]
    ).astype(int)


def more_elements(crowd: float) -> float:
    """Return the factor by which crowding nodes raises the number of elements of a zone."""
    return sqrt(float(ellipkm1(crowd * crowd)) / (0.5 * pi))


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


def _places(share: Array, crowd: float) -> tuple[Array, Array]:
    """Return the place in a zone of length 1 for a share of its elements, and its derivative."""
    if crowd == 1.0:
        return 0.5 * (1.0 - np.cos(pi * share)), 0.5 * pi * np.sin(pi * share)
    quarter = float(ellipkm1(crowd * crowd))
    sn, cn, dn, _ = ellipj(quarter * np.minimum(share, 1.0 - share), 1.0 - crowd * crowd)
    below = crowd * sn * sn / (cn * cn + crowd * sn * sn)
    slope = 2.0 * quarter * crowd * sn * cn * dn / (cn * cn + crowd * sn * sn) ** 2
    return np.where(share > 0.5, 1.0 - below, below), slope


@lru_cache(maxsize=128)
def _cosine_values(elements: tuple[int, ...], crowding: tuple[float, ...]) -> Array:
    """Return the derivative of `cosine_nodes` by the place of each break."""
    values = np.zeros((sum(elements) + 3, len(elements) + 1))
    first = 1
    for zone, (n, crowd) in enumerate(zip(elements, crowding, strict=True)):
        cosine = _places(np.arange(n + 1) / n, crowd)[0]
        cosine[-1] = 1.0
        values[first : first + n + 1, zone] = 1.0 - cosine
        values[first : first + n + 1, zone + 1] = cosine
        first += n
    values[0] = values[1] - _BESIDE * (values[2] - values[1])
    values[-1] = values[-2] + _BESIDE * (values[-2] - values[-3])
    values.setflags(write=False)
    return values


def graded_nodes(breaks: Array, count: int, demand: Demand | None = None) -> Array:
    """Return nodes on zones between ``breaks``, dense at every break and where tractions bend.

    Tractions go to zero as the square root of the distance to an edge or a transition; nodes
    whose distance to it grows as a square (a cosine over the zone) then make the interpolation
    error equal on all elements, and the whole of second order in 1/count. Most nodes are placed
    so; the others follow the demand of a former solution, where there is one.

    Parameters
    ----------
    breaks : (m,) increasing: outermost contact edges, further edges, transitions [mm].
    count :
        number of elements, about.
    demand :
        of a former solution; None: cosines alone.

    Returns
    -------
    (n,) increasing nodes [mm], a few of them outside the outermost breaks.
    """
    lengths = np.diff(breaks)
    shares = np.sqrt(lengths / lengths.sum())
    shares /= shares.sum()
    if demand is not None:
        asked = np.diff(demand.up_to(breaks))
        if asked.sum() > 0.0:
            shares += _asked_share(count) * (asked / asked.sum() - shares)
    counts = np.maximum(np.rint(count * shares), _SMALLEST_ZONE).astype(int)
    parts = [breaks[:1]]
    for start, stop, n in zip(breaks[:-1], breaks[1:], counts, strict=True):
        parts.append(_zone_nodes(float(start), float(stop), int(n), demand, _asked_share(count)))
    inner = np.concatenate(parts)
    first, last = inner[1] - inner[0], inner[-1] - inner[-2]
    return np.concatenate([inner[0] - first * _MARGIN[::-1], inner, inner[-1] + last * _MARGIN])


def _asked_share(count: int) -> float:
    return _ASKED if count < _MANY else _ASKED_OF_MANY


def _zone_nodes(
    start: float, stop: float, count: int, demand: Demand | None, share: float
) -> Array:
    """Return the nodes of one zone, without its first."""
    cosine = 0.5 * (1.0 - np.cos(np.pi * np.arange(count + 1) / count))
    if demand is None:
        return start + (stop - start) * cosine[1:]
    fine = np.linspace(0.0, 1.0, _FINER * count + 1)
    places = start + (stop - start) * 0.5 * (1.0 - np.cos(np.pi * fine))
    asked = demand.up_to(places) - demand.up_to(np.array([start]))
    if not asked[-1] > 0.0:
        return start + (stop - start) * cosine[1:]
    asked /= asked[-1]
    steps = 2 * _FINER  # two elements
    if np.max(asked[steps:] - asked[:-steps]) > _PEAKED * fine[steps]:
        share = _ASKED_OF_PEAKS
    rank = fine + share * (asked - fine)
    nodes = np.interp(np.arange(1, count + 1) / count, rank, places)
    nodes[-1] = stop
    return nodes


def _bend(x: Array, values: Array) -> Array:
    """Return |f''| at the nodes, from differences; 0 at both ends."""
    slopes = np.diff(values) / np.diff(x)
    bend = np.zeros(x.size)
    bend[1:-1] = np.abs(np.diff(slopes)) / (0.5 * (x[2:] - x[:-2]))
    return bend
