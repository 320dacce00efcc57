"""Secant steps for zone ends, each from its last two moves on meshes of one size."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import Generic, Protocol, Self, TypeVar

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

# Bounds of the secant slope: proposed move over the actual error of an end.
_SLOPES = 0.4, 2.5
_OF_ROOTS = 0.1, 10.0  # bounds of that of inverse square roots, over the slope before


class Ends(Protocol):
    """Zones with adjustable ends, as far as the secant steps use them."""

    @property
    def ends(self) -> Array:
        """The zone ends of both interfaces, one after the other, (m,) [mm]."""
        ...

    @property
    def is_proper(self) -> bool:
        """Whether every zone has a length."""
        ...

    def is_like(self, other: Self) -> bool:
        """Return whether the other zones have the same states in the same order."""
        ...

    def with_ends(self, ends: Array) -> Self:
        """Return zones with the same states and other ends."""
        ...


Z = TypeVar("Z", bound=Ends)


@dataclass(slots=True)
class SecantSteps(Generic[Z]):
    """State of the secant iteration: last zone ends, what the solution said of them, and slopes.

    What a solution says of an end is the move that it proposes. That is a ratio, of an inverse
    square root in the tractions to a square root. Beside an edge in a peak of the pressure that is
    shorter than the distance to the right place, the square root may vanish or change its sign, and
    the move with it; the inverse square root itself stays proportional to that distance, since the
    solution is linear in the gap that is closed too far or not far enough. Where it is given, it
    replaces the move.

    Attributes
    ----------
    zones : on the last mesh; None before the first mesh.
    said : (m,) what its solution said of their ends: inverse square roots in the pressure at edges
        [MPa sqrt(mm)], proposed moves otherwise [mm]; None before the first mesh of a size.
    by_root : (m,) at which ends it is inverse square roots.
    slopes : (m,) secant slopes: the decrease of ``said`` per distance moved, for each end; inf: not
        known. The slope of proposed moves is 1 where a surface responds as a half-plane over the
        first elements. The slopes are kept for the next mesh size.
    low, high : (m,) the last places of this size from which an end was to move up, and down, with
        what was said there, each (2, m); None before the first mesh. An end that far away from its
        place sees only the nearest pressures proposes moves that hardly grow with the distance, and
        a secant through two of them may lead past a place that is already known as too far.
    """

    zones: Z | None = None
    said: Array | None = None
    by_root: Mask | None = None
    slopes: Array | None = None
    low: Array | None = None
    high: Array | None = None

    def begin_size(self) -> None:
        """Begin with meshes of another size: forget the last moves, keep the slopes."""
        self.said = self.low = self.high = None

    def learn(self, zones: Z, proposed: Z, singular: Array | None = None) -> Z:
        """Take up what the solution on a mesh says; return the zones with ends where they belong.

        Parameters
        ----------
        zones : on this mesh.
        proposed : the zones with their ends where the solution puts them.
        singular : (m,) inverse square roots in the pressure at edges, NaN at other ends; positive
            where the edge is to move up. None: all ends by their proposed moves.
        """
        moves = proposed.ends - zones.ends
        said = moves if singular is None else np.where(np.isnan(singular), moves, singular)
        by_root = np.zeros(moves.size, dtype=bool) if singular is None else ~np.isnan(singular)
        first = np.ones(moves.size)
        with np.errstate(divide="ignore", invalid="ignore"):
            first[by_root] = np.where(said * moves > 0.0, said / moves, inf)[by_root]
        before, said_before = self.zones, self.said
        self.zones, self.said, self.by_root = zones, said, by_root
        if before is None or self.slopes is None or not zones.is_like(before):
            self.slopes, self.low, self.high = first, None, None
        else:
            self.slopes = np.where(np.isfinite(self.slopes), self.slopes, first)
            if said_before is not None:
                self._update_slopes(zones.ends - before.ends, said_before)
        known = by_root & np.isfinite(self.slopes)
        places = zones.with_ends(np.where(known, zones.ends + said / self.slopes, proposed.ends))
        return places if places.is_proper else proposed

    def _update_slopes(self, moved: Array, said_before: Array) -> None:
        """Update the slopes by what was said before the ends moved."""
        assert self.said is not None
        assert self.by_root is not None
        assert self.slopes is not None
        is_known, between = np.isfinite(self.slopes), self.said * said_before < 0.0
        least = np.where(self.by_root, _OF_ROOTS[0] * self.slopes, _SLOPES[0])
        most = np.where(self.by_root, _OF_ROOTS[1] * self.slopes, _SLOPES[1])
        # Between two places with moves of opposite sign the secant interpolates: no bound.
        most = np.where(between & ~self.by_root, inf, most)
        least[~is_known], most[~is_known] = 0.0, inf
        with np.errstate(divide="ignore", invalid="ignore"):
            slopes = (said_before - self.said) / moved
        shows = np.isfinite(slopes) & (is_known | (slopes > 0.0))
        self.slopes = np.where(shows, np.clip(slopes, least, most), self.slopes)

    def next(self, proposed: Z) -> Z:
        """Return the zones with ends at the next places to try, by secants through the last moves.

        ``proposed``: where the ends are proposed, for those of which the slope is not known.
        """
        zones, said, slopes = self.zones, self.said, self.slopes
        assert zones is not None
        assert said is not None
        assert slopes is not None
        wanted = np.where(np.isfinite(slopes), zones.ends + said / slopes, proposed.ends)
        found = zones.with_ends(self._bracketed(zones.ends, said, wanted))
        return found if found.is_proper else proposed

    def _bracketed(self, here: Array, step: Array, wanted: Array) -> Array:
        """Return wanted ends, interpolated between known places where they lie beyond one.

        A place on the other side serves once: it may have changed as other ends moved.
        """
        now, unknown = np.stack([here, step]), np.full((2, step.size), np.nan)
        low = np.where(step > 0.0, now, unknown if self.low is None else self.low)
        high = np.where(step < 0.0, now, unknown if self.high is None else self.high)
        with np.errstate(invalid="ignore"):
            beyond = (low[0] < high[0]) & ((wanted <= low[0]) | (wanted >= high[0]))
            between = (low[0] * high[1] - high[0] * low[1]) / (high[1] - low[1])
        self.low = np.where(beyond & (step < 0.0), unknown, low)
        self.high = np.where(beyond & (step > 0.0), unknown, high)
        return np.asarray(np.where(beyond, between, wanted))
