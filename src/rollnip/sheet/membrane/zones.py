"""Zones of stick and slip on both interfaces of a membrane; they have the same edges."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import Layout, States, contact_zones
from rollnip.sheet.membrane.system import MembraneProblem, MembraneState
from rollnip.sheet.zones import (
    LONGEST_MOVE,
    SideZones,
    within_zone_middles,
    without_slivers_in,
)

Array = NDArray[np.float64]

_TOGETHER = 5e-4  # over the width: transitions of both interfaces this close share a node
_COINCIDENT = 1e-8  # over the width: zone ends this close leave elements of no length
_SLIVER = 1e-3  # over the width: shorter zones are removed


class RequestedZones(Protocol):
    """Zones that are computed on demand."""

    @property
    def sides(self) -> tuple[Layout, Layout]:
        """Return the zones of the upper and of the lower interface."""
        ...

    def creeps_against_shear(self, number: int) -> NDArray[np.bool_]:
        """Return at which transitions of an interface the slip beside it must stick again, (m,)."""
        ...


@dataclass(frozen=True, slots=True)
class MembraneZones(SideZones):
    """The zones of the upper and of the lower interface of a membrane, with common edges."""

    @property
    def edges(self) -> tuple[float, float]:
        """Return the trailing and the leading edge [mm]."""
        return self.upper.edges

    @property
    def is_proper(self) -> bool:
        """Return whether all zone ends are finite and clearly apart, also across interfaces."""
        apart = np.diff(self.breaks)
        return bool(np.all(apart > _COINCIDENT * self.width))

    @property
    def breaks(self) -> Array:
        """Return the zone ends of both interfaces merged, each once, (m,) [mm]."""
        places = {place for side in self.sides for place in side.breaks.tolist()}
        return np.array(sorted(places))

    def states_on(self, x: Array) -> States:
        """Return the states of the nodes on both interfaces, (2, n)."""
        return np.stack([side.states_on(x) for side in self.sides])

    def aligned(self) -> MembraneZones:
        """Return zones whose nearly coincident transitions are both moved to their mean."""
        near = _TOGETHER * self.width
        places = [side.breaks.copy() for side in self.sides]
        for i in range(1, places[0].size - 1):
            apart = np.abs(places[1][1:-1] - places[0][i])
            if apart.size and apart.min() < near:
                j = 1 + int(np.argmin(apart))
                places[0][i] = places[1][j] = 0.5 * (places[0][i] + places[1][j])
        upper, lower = (Layout(p, s.states) for p, s in zip(places, self.sides, strict=True))
        return MembraneZones(upper, lower)

    def moved(
        self,
        problem: MembraneProblem,
        state: MembraneState,
        requested: RequestedZones,
        *,
        is_near: bool,
    ) -> MembraneZones:
        """Return zones whose ends are moved to where a solution with these zones puts them.

        ``requested``: like zones from the nodal states that the solution calls for. They place a
        transition where the shears beside it do not, or would move it beyond the middle of a zone;
        and, where ``is_near`` says that ends are close to their places, also where the slip beside
        it creeps back.
        """
        x = problem.mesh.inner
        proposed = [
            side.with_proposed_ends(x, state.side(number), friction)
            for number, (side, friction) in enumerate(
                zip(self.sides, problem.frictions, strict=True)
            )
        ]
        edges, sides = self._edges_towards(proposed), []
        for number, (side, wanted) in enumerate(zip(self.sides, proposed, strict=True)):
            middles = 0.5 * (side.breaks[1:] + side.breaks[:-1])
            inner = wanted.breaks[1:-1]
            clear = (inner > middles[:-1]) & (inner < middles[1:])
            if is_near and inner.size:
                clear &= ~requested.creeps_against_shear(number)
            if not clear.all():
                inner[~clear] = requested.sides[number].breaks[1:-1][~clear]
            sides.append(
                Layout(within_zone_middles(side.breaks, wanted.breaks, edges), side.states)
            )
        return MembraneZones(sides[0], sides[1])

    def _edges_towards(self, proposed: Sequence[Layout]) -> tuple[float, float]:
        """Return the edges, moved towards proposed ones as far as the zones of both sides allow."""
        most, edges = LONGEST_MOVE * self.width, np.array(self.edges)
        upper, lower = (
            side.stepped_towards(wanted).breaks[[0, -1]] - edges
            for side, wanted in zip(self.sides, proposed, strict=True)
        )
        moves = np.where(np.abs(upper) < np.abs(lower), upper, lower)
        trailing, leading = (edges + np.clip(moves, -most, most)).tolist()
        return trailing, leading

    def without_slivers(self) -> MembraneZones:
        """Return the zones without those too short to matter."""
        sides = [without_slivers_in(side, _SLIVER * self.width) for side in self.sides]
        return MembraneZones(sides[0], sides[1])

    @classmethod
    def around(
        cls, x: Array, state: MembraneState, frictions: tuple[float, float]
    ) -> MembraneZones:
        """Return the zones of nodal states on a mesh that extends beyond the contact.

        Where the contact or its zones are disconnected, one stick zone is returned.
        """
        whole = [
            contact_zones(x, state.side(number), friction)
            for number, friction in enumerate(frictions)
        ]
        edges = whole[0][0].start, whole[0][-1].stop
        upper, lower = map(Layout.of, whole, frictions)
        if upper is None or lower is None:
            stick = Layout(np.array(edges), Layout.sticking(1.0).states)
            return cls(stick, stick)
        return cls(upper, lower)

    @classmethod
    def found(
        cls,
        x: Array,
        state: MembraneState,
        frictions: tuple[float, float],
        edges: tuple[float, float],
    ) -> MembraneZones | None:
        """Return the zones of nodal states between known edges; None where they are unclear."""
        sides = [
            Layout.from_nodes(x, state.side(number), friction, edges)
            for number, friction in enumerate(frictions)
        ]
        upper, lower = sides
        return None if upper is None or lower is None else cls(upper, lower)
