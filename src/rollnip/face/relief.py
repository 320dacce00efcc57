"""Ends of a face: how load and peak pressure depart there from those of the plane nip.

Where one roller ends on the longer covering of the other, or a covering itself ends, the
cross-sections near the end are not plane (see `rollnip.patch.face_end` and
`rollnip.patch.covering_end`). Ends are solved at a few approaches, evenly spaced in their
logarithm, and kept for the next face. Between them the ratios to the plane nip are interpolated
over the distance from the end, in units of the length that each solution covers. A place of the
face represents its share of the length and is given the mean ratio over this share. The load of the
whole face then includes what the end adds or takes away, however few places lie there.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import floor, log

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError, RollnipError
from rollnip.face.beam import FaceGrid
from rollnip.face.rows import NipRows
from rollnip.nip import Nip
from rollnip.patch import FaceEnd, covering_end, face_end
from rollnip.patch.covering_ends import Ending
from rollnip.rollers import Roller
from rollnip.shafts import Face

Array = NDArray[np.float64]

_ENDING: Mapping[str, Ending] = {
    "covering": "both",
    "covering-upper": "upper",
    "covering-lower": "lower",
}
"""Whose covering ends, by `Face.ends`."""
_STEP = 0.25  # of the logarithm of the approach, between solutions


@dataclass(frozen=True, slots=True)
class End:
    """One end of a face.

    Attributes
    ----------
    distance : (k + 1,) from the end [mm], increasing from 0.
    load, peak : (k + 1,) integrals from the end of the ratios of load and peak pressure to those of
        the plane nip [mm]; beyond the last distance the ratios are 1.
    added_length : length of face that the end adds to the load [mm]; negative: it carries less.
    error : error of that length, by its elements and by interpolation between approaches [mm].
    """

    distance: Array
    load: Array
    peak: Array
    added_length: float
    error: float

    def mean(self, which: str, edges: Array) -> Array:
        """Return the mean ratio between edges, (n,); edges (n + 1,) are distances from the end."""
        values = self.load if which == "load" else self.peak
        beyond = np.maximum(edges - self.distance[-1], 0.0)
        whole = np.interp(edges, self.distance, values) + beyond
        return np.asarray(np.diff(whole) / np.diff(edges))


@dataclass(frozen=True, slots=True)
class Relief:
    """Both ends of a face, at y < 0 and at y > 0; None where the nip is open."""

    ends: tuple[End | None, End | None]

    def ratios(self, grid: FaceGrid) -> tuple[Array, Array]:
        """Return load and peak pressure at the places, relative to plane nips, each (n,)."""
        (load, peak), (other_load, other_peak) = self._of_each(grid)
        return load * other_load, peak * other_peak

    def overlap(self, grid: FaceGrid) -> Array:
        """Return how much both ends change the load at the same places, (n,), as a product."""
        (load, _), (other, _) = self._of_each(grid)
        return np.abs((1.0 - load) * (1.0 - other))

    def _of_each(self, grid: FaceGrid) -> list[tuple[Array, Array]]:
        """Return load and peak pressure as each end alone would change them, each (n,)."""
        edges = np.concatenate([[0.0], np.cumsum(grid.weights)])
        even = np.ones(grid.y.size)
        first, second = (
            (even, even) if one is None else (one.mean("load", edges), one.mean("peak", edges))
            for one in self.ends
        )
        return [first, (second[0][::-1], second[1][::-1])]

    @property
    def added_length(self) -> float:
        """Length of face that both ends add to the load [mm]."""
        return sum(one.added_length for one in self.ends if one is not None)


def relief_of(
    nips: tuple[Nip, Nip], face: Face, approaches: tuple[float, float], rows: NipRows
) -> Relief:
    """Return the ends of a face at the approaches there [mm].

    Parameters
    ----------
    nips : the nip at either end, with the coverings there.
    face : the face.
    approaches : at both ends [mm].
    rows : keeps what was solved.

    Raises
    ------
    InvalidInputError
        where the ends cannot be computed, as with cores that are half-spaces.
    """
    first, second = (
        None if approach <= 0.0 else _end(nip, face, approach, rows)
        for nip, approach in zip(nips, approaches, strict=True)
    )
    return Relief((first, second))


def _end(nip: Nip, face: Face, approach: float, rows: NipRows) -> End:
    place = log(approach) / _STEP
    low = floor(place)
    share = place - low
    both = [_kept(nip, face, low + i, rows) for i in (0, 1)]
    curves = [_integrated(one) for one in both]

    def between(i: int) -> Array:
        return np.asarray((1.0 - share) * curves[0][i] + share * curves[1][i])

    low_added, high_added = (one.added_length for one in both)
    added = (1.0 - share) * low_added + share * high_added
    # Between two nodes a power law lies off its chord by this much.
    off = 0.5 * share * (1.0 - share) * (high_added - low_added) ** 2
    off /= max(abs(added), abs(high_added - low_added), 1e-300)
    return End(
        distance=between(0),
        load=between(1),
        peak=between(2),
        added_length=added,
        error=max(one.error for one in both) + off,
    )


def _kept(nip: Nip, face: Face, node: int, rows: NipRows) -> FaceEnd:
    """Return the end at the approach of a node, kept from before or solved now."""
    upper, lower = (replace(one, shaft=None) for one in (nip.upper, nip.lower))
    key = (upper, lower, face.ends, face.end_radius, node)
    if key not in rows.ends:
        rows.ends[key] = _solved(upper, lower, face, float(np.exp(_STEP * node)))
    return rows.ends[key]


def _solved(upper: Roller, lower: Roller, face: Face, approach: float) -> FaceEnd:
    try:
        if face.ends in _ENDING:
            return covering_end(upper, lower, approach, _ENDING[face.ends])
        return face_end(upper, lower, approach, face.end_radius)
    except InvalidInputError as error:
        raise InvalidInputError(f'`ends` cannot be "{face.ends}": {error}') from None
    except RollnipError as error:
        raise type(error)(f"The end of the face at {approach:.4g} mm: {error}") from None


def _integrated(end: FaceEnd) -> tuple[Array, Array, Array]:
    """Return edges of equal parts along y, and both integrals up to them, each (k + 1,)."""
    step = float(end.distance[1] - end.distance[0])
    count = end.distance.size
    edges = step * np.arange(count + 1.0)
    parts = (
        np.concatenate([[0.0], np.cumsum(one) * step]) for one in (end.load, end.peak_pressure)
    )
    load, peak = parts
    return edges, load, peak
