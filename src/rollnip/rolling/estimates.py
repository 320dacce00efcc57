"""Estimated errors of the figures, from their changes between sizes of mesh."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property, partial
from math import inf

import numpy as np

from rollnip.materials import memory_integral, relaxation_modulus
from rollnip.model import Model
from rollnip.nip import Creepage, Nip
from rollnip.rollers import Roller
from rollnip.rolling.changes import errors_from_changes, share_left, shown_order
from rollnip.rolling.further import further_errors, further_figures, further_sizes
from rollnip.rolling.round import Figures, Further, Round, creepage_scale
from rollnip.rolling.surfaces import Array, Mesh

# Order of the errors, from two sizes.
_ORDER_FROM_TWO_SIZES = np.array([2.0, 2.0, 1.0, 2.0, 2.0])
# Least relative error of each of Figures, times the square of the number of elements: measured on
# random nips against ten times as many elements. They are of higher order where tractions go as a
# square root at every end; where unlike surfaces stick up to an edge they do not, the edge is
# misplaced by a share of the first element, and the order is 2.
LEAST_ERROR = np.array([0.02, 0.05, 0.3, 0.2, 0.2])
_CREEPAGE, _WIDTH, _PEAK = (
    [one.name for one in fields(Figures)].index(name)
    for name in ("creepage", "nip_width", "peak_pressure")
)


@dataclass(frozen=True)
class Size:
    """Results on one size of mesh.

    Attributes
    ----------
    count : number of elements.
    figures : of the nip.
    breaks : edges and transitions [mm].
    make_further : evaluates the further figures, which takes long where layers have a memory.
    """

    count: int
    figures: Figures
    breaks: Array
    make_further: Callable[[], Further]

    @property
    def edge_elements(self) -> float:
        """Length of the elements at the edges, over that of as many elements in a single zone."""
        lengths = np.diff(self.breaks)
        return float(np.sqrt(lengths).sum() ** 2 / lengths.sum())

    @cached_property
    def further(self) -> Further:
        """Further figures."""
        return self.make_further()


def sized(nip: Nip, model: Model, latest: Round, count: int, breaks: Array) -> Size:
    """Return the results of a round on a mesh of ``count`` elements."""
    further = partial(further_figures, nip, model.geometry, latest)
    return Size(count, latest.figures, breaks, further)


def with_errors(nip: Nip, latest: Round, history: list[Size], left: Figures | None) -> Round:
    """Return the round with the estimated errors of the figures that the tolerance is for.

    They are those of the mesh, what the ends of zones may still change (``left``), and what memory
    does within their elements: two sizes of mesh agree on wrong figures where their ends are
    misplaced alike, or where the elements of both are too long.
    """
    figures, edge = latest.figures, edge_within_memory(nip, latest.mesh)
    # Edges are misplaced by that much. A creepage at a given traction goes as the square of the
    # width, as the load does. Approach, load and peak pressure depend on edges to second order.
    creepage = 0.0
    if not isinstance(nip.tangential, Creepage):
        creepage = 2.0 * creepage_scale(nip, figures) * edge / figures.nip_width
    unseen = np.array([0.0, 0.0, creepage, edge, 0.0])
    error = estimated_error(nip, latest, history).array() + unseen
    if left is not None:
        error += left.array()
    return replace(latest, error=Figures(*error.tolist()))


def edge_within_memory(nip: Nip, mesh: Mesh) -> float:
    """Return the error of edges from a memory that is shorter than the elements there [mm]."""
    if not nip.is_viscoelastic:
        return 0.0
    last = np.cumsum(mesh.fine.elements) - 1
    longest = mesh.dx[[*last, *(last - mesh.fine.elements + 1)]].max()
    return max(lag_within(float(longest), roller, nip.speed) for roller in (nip.upper, nip.lower))


def lag_within(length: float, roller: Roller, speed: float | None) -> float:
    """Return how far the stress of a surface lags behind its strain within a length h [mm].

    A stress that has been int E(t) de(t) since the material came in equals, to first order, E(h/V)
    times the strain that was there V int (E(t)/E(h/V) - 1) dt before, with t up to h/V. It is 0
    both where nothing relaxes within h and where h is rolled in no time.
    """
    if roller.is_rigid or speed is None or not roller.materials[0].relaxation_times:
        return 0.0
    surface, time = roller.materials[0], np.array([length / speed])
    relaxed = (memory_integral(surface, time) + time) * surface.relaxed_modulus
    return speed * float((relaxed / relaxation_modulus(surface, time) - time)[0])


def with_further_errors(nip: Nip, latest: Round, history: list[Size]) -> Round:
    """Return the round with the estimated errors of the further figures, made when asked for."""
    make = partial(_further_error, nip, latest, tuple(history))
    return replace(latest, make_further_error=make)


def _further_error(nip: Nip, latest: Round, history: Sequence[Size]) -> Further | None:
    """Return the estimated errors of the further figures; None where there is a single mesh.

    Edges that are misplaced as in `with_errors` change tractions by twice that over the width, and
    with them what is handed on and lost, which is quadratic in them; the length by one at either
    edge.
    """
    sizes = [(size.count, size.further) for size in history]
    error = further_errors(nip, latest, sizes)
    if error is None:
        return None
    share = 2.0 * edge_within_memory(nip, latest.mesh) / latest.figures.nip_width
    more = share * further_sizes(nip, latest, history[-1].further)
    return Further(*(error.array() + more).tolist())


def estimated_error(nip: Nip, latest: Round, history: list[Size]) -> Figures:
    """Return the estimated error of each figure from its changes between meshes (second order).

    Two meshes may agree by chance. So earlier changes count too, reduced by the order; no error is
    claimed below the least error of meshes of this size in random nips.

    Parameters
    ----------
    latest : the solution on the last of the meshes.
    history : all sizes of mesh with these zones, coarsest first.
    """
    figures, count = latest.figures, history[-1].count
    if len(history) < 2:
        return Figures(inf, inf, inf, inf, inf)
    counts = np.array([size.count for size in history], dtype=float)
    values = np.array([size.figures.array() for size in history])
    values[:-3, _PEAK] = values[-3:, _PEAK][0]  # coarse meshes do not see peaks under a stiff skin
    # The creepage depends most on an edge up to which unlike surfaces stick; from two sizes alone,
    # which show no order, its order is taken as first.
    order = (
        _ORDER_FROM_TWO_SIZES if len(history) < 3 else shown_order(counts, np.diff(values, axis=0))
    )
    change = errors_from_changes(counts, values, order)
    scales = np.abs(figures.array())
    scales[_CREEPAGE] = creepage_scale(nip, figures)
    floor = LEAST_ERROR * scales / count**2
    floor[_WIDTH] *= history[-1].edge_elements
    given = np.isnan(change) | (change < 1e-12 * scales)  # nan, or prescribed
    return Figures(*(float(e) for e in np.where(given, change, np.maximum(change, floor))))


def zone_excess(history: list[Size], tolerance: float) -> float:
    """Return the largest estimated error of a zone's length, over the allowed one.

    Allowed is three times the tolerance of the length, or of a twentieth of the nip for shorter
    zones.
    """
    if len(history) < 2:
        return 0.0
    coarse, fine = history[-2:]
    share = share_left(np.array([coarse.count, fine.count]), np.array(2.0))
    return float(share) * length_excess(coarse.breaks, fine.breaks, tolerance)


def length_excess(before: Array, after: Array, tolerance: float) -> float:
    """Return the largest change of a zone's length, over what `zone_excess` allows."""
    lengths = np.diff(after)
    allowed = 3.0 * tolerance * np.maximum(lengths, 0.05 * lengths.sum())
    return float(np.max(np.abs(lengths - np.diff(before)) / allowed))
