"""Estimated errors of the figures, from their changes between sizes of mesh."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, partial
from math import inf

import numpy as np

from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.rolling.changes import errors_from_changes, share_left, shown_order
from rollnip.rolling.further import further_errors, further_figures
from rollnip.rolling.round import Figures, Further, Round, creepage_scale
from rollnip.rolling.surfaces import Array

# Order for cubic elements, from two sizes.
_ORDER_FROM_TWO_SIZES = np.array([2.0, 2.0, 1.0, 2.0, 2.0])
# Least relative error of each of Figures, times the square of the number of elements: measured on
# random nips against ten times as many elements; linear elements, and cubic ones. These are of
# higher order where tractions go as a square root at every end; where unlike surfaces stick up to
# an edge they do not, the edge is misplaced by a share of the first element, and the order is 2.
_LEAST_ERROR_LINEAR = np.array([0.1, 0.5, 2.0, 2.0, 0.5])
_LEAST_ERROR_CUBIC = np.array([0.02, 0.05, 0.3, 0.2, 0.2])
_CREEPAGE, _PEAK = 2, 4  # their places among Figures


@dataclass(frozen=True, slots=True)
class Elements:
    """Properties of the errors that one kind of elements makes.

    Attributes
    ----------
    least : (5,) least relative error of each of Figures, times the squared number of elements.
    are_cubic : whether they are cubic; their errors may then be of any order, from the first up.
    """

    least: Array
    are_cubic: bool


LINEAR = Elements(_LEAST_ERROR_LINEAR, are_cubic=False)
CUBIC = Elements(_LEAST_ERROR_CUBIC, are_cubic=True)


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

    @cached_property
    def further(self) -> Further:
        """Further figures."""
        return self.make_further()


def sized(nip: Nip, model: Model, latest: Round, count: int, breaks: Array) -> Size:
    """Return the results of a round on a mesh of ``count`` elements."""
    found = latest.mesh, latest.state, latest.zones
    return Size(
        count, latest.figures, breaks, partial(further_figures, nip, model.geometry, *found)
    )


def with_errors(nip: Nip, latest: Round, history: list[Size], kind: Elements) -> Round:
    """Return the round with the estimated errors of the figures that the tolerance is for."""
    return replace(latest, error=estimated_error(nip, latest, history, kind))


def with_further_errors(nip: Nip, latest: Round, history: list[Size]) -> Round:
    """Return the round with the estimated errors of the further figures."""
    sizes = [(size.count, size.further) for size in history]
    return replace(latest, further_error=further_errors(nip, latest, sizes))


def estimated_error(nip: Nip, latest: Round, history: list[Size], kind: Elements) -> Figures:
    """Return the estimated error of each figure from its changes between meshes (second order).

    Two meshes may agree by chance. So earlier changes count too, reduced by the order; no error is
    claimed below the least error of meshes of this size in random nips, nor, with linear elements,
    an error of the peak below its difference from the highest node.

    Parameters
    ----------
    latest : the solution on the last of the meshes.
    history : all sizes of mesh, coarsest first.
    kind : of elements, LINEAR or CUBIC.
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
    change = errors_from_changes(counts, values, order if kind.are_cubic else np.full(5, 2.0))
    scales = np.abs(figures.array())
    scales[_CREEPAGE] = creepage_scale(nip, figures)
    floor = kind.least * scales / count**2
    if not kind.are_cubic:
        highest = float(np.max(latest.state.pressure))
        floor[_PEAK] = max(floor[_PEAK], figures.peak_pressure - highest)
    given = np.isnan(change) | (change < 1e-12 * scales)  # nan, or prescribed
    return Figures(*(float(e) for e in np.where(given, change, np.maximum(change, floor))))


def zone_excess(history: list[Size], tolerance: float) -> float:
    """Return the largest estimated error of a zone's length, over the allowed one.

    Allowed is three times the tolerance of the length, or of a twentieth of the nip for shorter
    zones.
    """
    if len(history) < 2 or history[-1].breaks.size != history[-2].breaks.size:
        return 0.0
    coarse, fine = history[-2:]
    lengths = np.diff(fine.breaks)
    share = share_left(np.array([coarse.count, fine.count]), np.array(2.0))
    change = share * np.abs(lengths - np.diff(coarse.breaks))
    allowed = 3.0 * tolerance * np.maximum(lengths, 0.05 * lengths.sum())
    return float(np.max(change / allowed))
