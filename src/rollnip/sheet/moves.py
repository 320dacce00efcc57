"""Moves of the ends of zones from mesh to mesh, by the secants through the last two of each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, Protocol, Self, TypeVar

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Bounds of the proposed move over the error of an end.
_SLOPES = 0.4, 2.5


class Ends(Protocol):
    """Zones, as far as their moves ask."""

    @property
    def ends(self) -> Array:
        """The ends of the zones of both interfaces, one after the other, (m,) [mm]."""
        ...

    @property
    def is_proper(self) -> bool:
        """Whether every zone has a length."""
        ...

    def is_like(self, other: Self) -> bool:
        """Return whether the other zones have the same states in the same order."""
        ...

    def with_ends(self, ends: Array) -> Self:
        """Return the same zones between other ends."""
        ...


Z = TypeVar("Z", bound=Ends)


@dataclass(slots=True)
class Moves(Generic[Z]):
    """Ends of like zones on the last mesh, and what the moves that were proposed are worth.

    Attributes
    ----------
    zones : on the last mesh of this size; None: on none yet.
    step : (m,) how far its solution moved their ends [mm].
    slopes : (m,) by how much the proposed move is less, per move of each end. It is 1 where a
        surface responds as a half-plane does over the first elements. The next size of mesh
        begins with these slopes.
    """

    zones: Z | None = None
    step: Array | None = None
    slopes: Array | None = None

    def refined(self) -> None:
        """Note that the next zones lie on a mesh of another size."""
        self.step = None

    def next(self, zones: Z, proposed: Z) -> Z:
        """Return where to put the ends next, each by the secant through its last two moves.

        Parameters
        ----------
        zones : as they were on the last mesh.
        proposed : where its solution puts them.
        """
        here, step = zones.ends, proposed.ends - zones.ends
        before, step_before = self.zones, self.step
        self.zones, self.step = zones, step
        if before is None or not zones.is_like(before):
            self.slopes = None
            return proposed
        if step_before is not None:
            moved = here - before.ends
            # between two places that ask for opposite ways the secant needs no bound
            most = np.where(step * step_before < 0.0, np.inf, _SLOPES[1])
            with np.errstate(divide="ignore", invalid="ignore"):
                slopes = np.clip((step_before - step) / moved, _SLOPES[0], most)
            known = np.ones(step.size) if self.slopes is None else self.slopes
            self.slopes = np.where(np.isfinite(slopes), slopes, known)
        if self.slopes is None:
            return proposed
        found = zones.with_ends(here + step / self.slopes)
        return found if found.is_proper else proposed
