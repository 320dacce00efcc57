"""Secant steps for zone ends, each from its last two moves on meshes of one size."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, Protocol, Self, TypeVar

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Bounds of the secant slope: proposed move over the actual error of an end.
_SLOPES = 0.4, 2.5


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
    """State of the secant iteration: last zone ends, their proposed moves, and secant slopes.

    Attributes
    ----------
    zones : on the last mesh of this size; None before the first mesh.
    step : (m,) moves of their ends that the solution proposed [mm].
    slopes : (m,) secant slopes: the decrease of the proposed move per distance moved, for each end.
        The slope is 1 where a surface responds as a half-plane over the first elements. The slopes
        are kept for the next mesh size.
    low, high : (m,) the last places of this size from which an end was to move up, and down, with
        the proposed moves, each (2, m) [mm]; None before the first mesh. An end that far away from
        its place sees only the nearest pressures proposes moves that hardly grow with the distance,
        and a secant through two of them may lead past a place that is already known as too far.
    """

    zones: Z | None = None
    step: Array | None = None
    slopes: Array | None = None
    low: Array | None = None
    high: Array | None = None

    def begin_size(self) -> None:
        """Begin with meshes of another size: forget the last moves, keep the slopes."""
        self.step = self.low = self.high = None

    def next(self, zones: Z, proposed: Z) -> Z:
        """Return zones whose ends are placed by secants through their last two moves.

        Parameters
        ----------
        zones : on the last mesh.
        proposed : the zones with their ends where the solution on that mesh puts them.
        """
        here, step = zones.ends, proposed.ends - zones.ends
        before, step_before = self.zones, self.step
        self.zones, self.step = zones, step
        if before is None or not zones.is_like(before):
            self.slopes = self.low = self.high = None
            return proposed
        if step_before is not None:
            moved = here - before.ends
            # between two places with moves of opposite sign the secant interpolates: no bound
            most = np.where(step * step_before < 0.0, np.inf, _SLOPES[1])
            with np.errstate(divide="ignore", invalid="ignore"):
                slopes = np.clip((step_before - step) / moved, _SLOPES[0], most)
            known = np.ones(step.size) if self.slopes is None else self.slopes
            self.slopes = np.where(np.isfinite(slopes), slopes, known)
        if self.slopes is None:
            return proposed
        found = zones.with_ends(self._bracketed(here, step, here + step / self.slopes))
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
