"""Zones of stick and slip on both interfaces of a plate, each between edges of its own."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import ContactState, Layout, State, States, contact_zones
from rollnip.sheet.plate.system import PlateProblem, PlateState
from rollnip.sheet.zones import LONGEST_MOVE, SideZones, held, without_slivers_in

Array = NDArray[np.float64]

_SLIVER = 1e-4  # over the width: zones that are left out
_OF_TRANSITIONS = 10.0  # times the squared distance of transitions, beside that of edges


@dataclass(frozen=True, slots=True)
class PlateZones(SideZones):
    """The zones of the upper and of the lower interface, each between edges of its own."""

    @property
    def edges(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Return trailing and leading edge of either contact [mm]."""
        return self.upper.edges, self.lower.edges

    @property
    def is_proper(self) -> bool:
        """Return whether all breaks are finite and every zone has a length."""
        return self.upper.is_proper and self.lower.is_proper

    def breaks_of_mesh(self, number: int, thickness: float, *, peaks: bool = False) -> Array:
        """Return the places where nodes of one interface crowd: its breaks, and some opposite.

        Opposite an edge of the other contact, and opposite a place where its slip turns to stick,
        where the couple of its shear rises steeply, the pressure turns over about the thickness of
        the sheet, which the nodes of a wide contact do not resolve by themselves. A place nearer
        than that to another one has the nodes of that one, but for both edges of a contact that is
        narrower than that: through the sheet the shear beside either edge is felt as it is. Where
        the pressure ends in peaks about as long as the sheet is thick, nodes crowd at either side
        of them.

        Parameters
        ----------
        number : of the interface.
        thickness : of the sheet [mm].
        peaks : whether the pressure ends in such peaks, as on a rigid roller.
        """
        own, opposite = self.sides[number], self.sides[1 - number]
        first, last = own.edges
        # of the transitions only those where stick begins: there the shear is a root
        begins = np.append(opposite.states == State.STICK, True)
        begins[0] = True
        breaks = own.breaks
        trailing, leading = opposite.edges
        for x in opposite.breaks[begins].tolist():
            others = breaks[breaks != trailing] if x == leading else breaks
            if first < x < last and float(np.abs(others - x).min()) > thickness:
                breaks = np.append(breaks, x)
        if peaks:
            for x in (first + thickness, last - thickness):
                if first < x < last and float(np.abs(breaks - x).min()) > 0.5 * thickness:
                    breaks = np.append(breaks, x)
        return np.sort(breaks)

    def distance(self, other: PlateZones) -> float:
        """Return how far apart the breaks of like zones are, over their widths.

        Those of transitions count squared, for figures depend on them to second order.
        """
        parts = []
        for one, two in zip(self.sides, other.sides, strict=True):
            share = np.abs(one.breaks - two.breaks) / two.width
            share[1:-1] *= _OF_TRANSITIONS * share[1:-1]
            parts.append(float(share.max()))
        return max(parts)

    def edges_off(self, other: PlateZones) -> float:
        """Return how far apart the edges of both are, over the widths of these."""
        parts = zip(self.sides, self.edges, other.edges, strict=True)
        return max(float(np.abs(np.subtract(a, b)).max()) / one.width for one, a, b in parts)

    def states_on(self, x: tuple[Array, Array]) -> tuple[States, States]:
        """Return the states of the nodes on both interfaces."""
        return self.upper.states_on(x[0]), self.lower.states_on(x[1])

    def moved(
        self, problem: PlateProblem, state: PlateState, called: PlateZones | None = None
    ) -> PlateZones:
        """Return the zones with their breaks moved to where a solution with them puts them.

        A transition moves at most half way to its neighbours, an edge by a 25th of the width; it
        stays where nothing says where it belongs.

        Parameters
        ----------
        problem, state : a solution with nodes at the breaks.
        called : like zones, of the states that meet all conditions on these meshes. They say where
            a transition belongs that the nearest shears do not place: all beyond their bounds.
        """
        sides = []
        for number, side in enumerate(self.sides):
            x, friction = problem.meshes[number].inner, problem.frictions[number]
            proposed = side.with_proposed_ends(x, state.side(number), friction).breaks
            if called is not None:
                proposed = np.where(np.isfinite(proposed), proposed, called.sides[number].breaks)
            trailing, leading = side.edges
            most = LONGEST_MOVE * side.width
            first, last = float(proposed[0]), float(proposed[-1])
            # an edge without pressure that rises from it lies in tension: it goes where that ends
            pressed = x[state.pressure[number] > 0.0]
            if pressed.size:
                first = first if np.isfinite(first) else float(pressed[0])
                last = last if np.isfinite(last) else float(pressed[-1])
            first = first if np.isfinite(first) else trailing
            last = last if np.isfinite(last) else leading
            edges = (
                float(np.clip(first, trailing - most, trailing + most)),
                float(np.clip(last, leading - most, leading + most)),
            )
            sides.append(Layout(held(side.breaks, proposed, edges), side.states))
        return PlateZones(sides[0], sides[1])

    def without_slivers(self) -> PlateZones:
        """Return the zones without those too short to matter."""
        upper, lower = (without_slivers_in(side, _SLIVER * side.width) for side in self.sides)
        return PlateZones(upper, lower)

    def reopened(self, misplaced: float) -> PlateZones:
        """Return the zones, those of stick between opposite slip as long as ends may be misplaced.

        The tractions of a zone see no further than it is long: one that closed up while other ends
        were misplaced could not grow again, as its ends would seem to be placed.
        ``misplaced``: allowed error of an end, over the width.
        """
        upper, lower = (_reopened(side, 2.0 * misplaced * side.width) for side in self.sides)
        return PlateZones(upper, lower)

    @classmethod
    def around(cls, problem: PlateProblem, state: PlateState) -> PlateZones:
        """Return the zones of nodal states on meshes that reach beyond the contacts.

        Nodes without pressure between others, where it is low or few nodes show how it dips, count
        as their neighbours. One zone of stick on an interface whose zones are in pieces all the
        same.
        """
        sides = []
        for number, (mesh, friction) in enumerate(
            zip(problem.meshes, problem.frictions, strict=True)
        ):
            zones = contact_zones(mesh.inner, _joined(state.side(number)), friction)
            if not zones:
                raise np.linalg.LinAlgError("an interface without contact")
            edges = np.array([zones[0].start, zones[-1].stop])
            sides.append(Layout.of(zones) or Layout(edges, Layout.sticking(1.0).states))
        return cls(sides[0], sides[1])

    def found(self, problem: PlateProblem, state: PlateState) -> PlateZones | None:
        """Return the zones of nodal states between the edges of these; None if unclear."""
        sides = [
            Layout.from_nodes(mesh.inner, state.side(number), friction, side.edges)
            for number, (mesh, friction, side) in enumerate(
                zip(problem.meshes, problem.frictions, self.sides, strict=True)
            )
        ]
        upper, lower = sides
        if upper is None or lower is None:
            return None
        in_pieces = any(State.FREE in side.states for side in (upper, lower))
        return None if in_pieces else PlateZones(upper, lower)


def _joined(state: ContactState) -> ContactState:
    """Return one interface with its contact in one piece: free nodes within are as those before."""
    states = state.states.copy()
    touching = np.flatnonzero(states != State.FREE)
    if touching.size:
        first, last = touching[[0, -1]]
        before = np.searchsorted(touching, np.arange(first, last + 1), side="right") - 1
        states[first : last + 1] = states[touching[before]]
    return replace(state, states=states)


def _reopened(layout: Layout, least: float) -> Layout:
    """Return a layout whose zones between unlike ones are no shorter than ``least`` [mm].

    They take no more than half of their neighbours.
    """
    breaks, states = layout.breaks.copy(), layout.states
    for number in range(1, states.size - 1):
        before, start, stop, after = layout.breaks[number - 1 : number + 3]
        missing = least - (stop - start)
        if missing > 0.0 and states[number - 1] != states[number + 1]:
            breaks[number] = start - 0.5 * min(missing, start - before)
            breaks[number + 1] = stop + 0.5 * min(missing, after - stop)
    return Layout(breaks, states)
