"""Moves of the ends of zones from mesh to mesh, by the secants through the last two of each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, Protocol, Self, TypeVar

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Bounds of the move that a solution asks for over how far an end is off.
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
    """Ends of like zones on the last meshes, and how far their solutions moved them."""

    zones: Z | None = None
    step: Array | None = None

    def next(self, zones: Z, asked: Z) -> Z:
        """Return where to put the ends next, each by the secant through its last two moves.

        Parameters
        ----------
        zones : as they were on the last mesh.
        asked : where its solution puts them.
        """
        here, step = zones.ends, asked.ends - zones.ends
        before, step_before = self.zones, self.step
        self.zones, self.step = zones, step
        if before is None or step_before is None or not zones.is_like(before):
            return asked
        with np.errstate(divide="ignore", invalid="ignore"):
            slope = (step_before - step) / (here - before.ends)
        factor = 1.0 / np.clip(np.nan_to_num(slope, nan=1.0), *_SLOPES)
        found = zones.with_ends(here + factor * step)
        return found if found.is_proper else asked
