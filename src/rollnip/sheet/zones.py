"""Zones of stick and slip on the two interfaces of a sheet, common to membranes and plates."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from rollnip._largest import largest
from rollnip.contact import Layout

Array = NDArray[np.float64]

LONGEST_MOVE = 0.04
"""Longest move of an edge per mesh, over the width."""
OF_TRANSITIONS = 10.0
"""Factor of the squared distance of transitions, compared to the distance of edges."""


@dataclass(frozen=True, slots=True)
class SideZones:
    """The zones of the upper and of the lower interface, each with any edges.

    Attributes
    ----------
    upper, lower : zones of each interface.
    """

    upper: Layout
    lower: Layout

    @classmethod
    def sticking(cls, reach: float) -> Self:
        """Return one stick zone on each interface, from -``reach`` to ``reach`` [mm]."""
        return cls(Layout.sticking(reach), Layout.sticking(reach))

    @property
    def sides(self) -> tuple[Layout, Layout]:
        """Return the zones of the upper and of the lower interface."""
        return self.upper, self.lower

    @property
    def width(self) -> float:
        """Return the width of the upper contact [mm]."""
        return self.upper.width

    @property
    def ends(self) -> Array:
        """Return the zone ends of both interfaces, one after the other, (m,) [mm]."""
        return np.concatenate([side.breaks for side in self.sides])

    def with_ends(self, ends: Array) -> Self:
        """Return zones with the same states and other ends, in the order of ``ends``."""
        n = self.upper.breaks.size
        upper, lower = Layout(ends[:n], self.upper.states), Layout(ends[n:], self.lower.states)
        return type(self)(upper, lower)

    @property
    def key(self) -> bytes:
        """Key that zones share if they have the same states in the same order."""
        return b"|".join(side.key for side in self.sides)

    @property
    def count(self) -> int:
        """Number of zones on both interfaces."""
        return sum(side.states.size for side in self.sides)

    def is_like(self, other: Self) -> bool:
        """Return whether the other zones have the same states in the same order."""
        pairs = zip(self.sides, other.sides, strict=True)
        return all(np.array_equal(one.states, two.states) for one, two in pairs)

    def distance(self, other: Self) -> float:
        """Return the largest distance between the ends of like zones, over their widths.

        Figures depend on transitions only to second order: ten times their squared distance counts.
        """
        parts = []
        for one, two in zip(self.sides, other.sides, strict=True):
            off = np.abs(one.breaks - two.breaks) / two.width
            off[1:-1] *= OF_TRANSITIONS * off[1:-1]
            parts.append(float(off.max()))
        return largest(*parts)


def within_zone_middles(breaks: Array, proposed: Array, edges: tuple[float, float]) -> Array:
    """Return proposed zone ends, each transition limited to between the middles of its zones."""
    out = breaks.copy()
    middles = 0.5 * (breaks[1:] + breaks[:-1])
    wanted = np.where(np.isfinite(proposed), proposed, breaks)
    out[1:-1] = np.clip(wanted[1:-1], middles[:-1], middles[1:])
    out[0], out[-1] = edges
    if not np.all(np.diff(out) > 0.0):  # an edge moved past a transition: keep relative places
        relative = (breaks - breaks[0]) / (breaks[-1] - breaks[0])
        out = edges[0] + relative * (edges[1] - edges[0])
    return np.asarray(out)


def without_slivers_in(layout: Layout, least: float) -> Layout:
    """Return a layout without zones shorter than ``least`` [mm], where their neighbours agree."""
    breaks, states = layout.breaks.tolist(), layout.states.tolist()
    number = 0
    while len(states) > 1 and number < len(states):
        if breaks[number + 1] - breaks[number] >= least:
            number += 1
        elif number in (0, len(states) - 1):
            del breaks[1 if number == 0 else -2], states[number]
            number = 0
        elif states[number - 1] == states[number + 1]:
            del breaks[number : number + 2], states[number : number + 2]
            number = 0
        else:
            number += 1
    return Layout(np.array(breaks), np.array(states, dtype=np.int8))
