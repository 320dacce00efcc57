"""Meshes graded to contact edges, to transitions between stick and slip, and to the tractions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rollnip.contact.mesh import FEWEST_ELEMENTS_OF_A_ZONE
from rollnip.contact.problem import Array

# Share of the nodes placed by the demand of a former solution. It is larger from `_MANY_ELEMENTS`
# on: tractions that so many do not resolve bend inside the zones rather than at their ends.
_SHARE_BY_DEMAND = 0.15
_SHARE_BY_DEMAND_OF_MANY = 0.4
_MANY_ELEMENTS = 150
# Share where the demand on two elements at cosine places is `_PEAK_RATIO` times their number or
# more: peaks under a stiff skin, a few of its thicknesses wide.
_SHARE_BY_DEMAND_OF_PEAKS = 0.7
_PEAK_RATIO = 2.0
_PLACES_PER_ELEMENT = 8  # places in an element at which the demand is looked at
# Distances of the nodes outside the contact from the edge, in edge elements.
_OUTER_NODE_DISTANCES = np.array([1.0, 2.0, 4.0, 8.0])


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
            shares += _share_by_demand(count) * (asked / asked.sum() - shares)
    counts = np.maximum(np.rint(count * shares), FEWEST_ELEMENTS_OF_A_ZONE).astype(int)
    parts = [breaks[:1]]
    for start, stop, n in zip(breaks[:-1], breaks[1:], counts, strict=True):
        parts.append(
            _zone_nodes(float(start), float(stop), int(n), demand, _share_by_demand(count))
        )
    inner = np.concatenate(parts)
    first, last = inner[1] - inner[0], inner[-1] - inner[-2]
    return np.concatenate(
        [
            inner[0] - first * _OUTER_NODE_DISTANCES[::-1],
            inner,
            inner[-1] + last * _OUTER_NODE_DISTANCES,
        ]
    )


def _share_by_demand(count: int) -> float:
    return _SHARE_BY_DEMAND if count < _MANY_ELEMENTS else _SHARE_BY_DEMAND_OF_MANY


def _zone_nodes(
    start: float, stop: float, count: int, demand: Demand | None, share: float
) -> Array:
    """Return the nodes of one zone, without its first."""
    cosine = 0.5 * (1.0 - np.cos(np.pi * np.arange(count + 1) / count))
    if demand is None:
        return start + (stop - start) * cosine[1:]
    fine = np.linspace(0.0, 1.0, _PLACES_PER_ELEMENT * count + 1)
    places = start + (stop - start) * 0.5 * (1.0 - np.cos(np.pi * fine))
    asked = demand.up_to(places) - demand.up_to(np.array([start]))
    if not asked[-1] > 0.0:
        return start + (stop - start) * cosine[1:]
    asked /= asked[-1]
    steps = 2 * _PLACES_PER_ELEMENT  # two elements
    if np.max(asked[steps:] - asked[:-steps]) > _PEAK_RATIO * fine[steps]:
        share = _SHARE_BY_DEMAND_OF_PEAKS
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
