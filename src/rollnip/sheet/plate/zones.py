"""Zones of stick and slip on both interfaces of a plate, each between its own edges."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf

import numpy as np
from numpy.typing import NDArray

from rollnip._largest import largest
from rollnip.contact import ContactState, Layout, State, States, contact_zones
from rollnip.sheet.plate.system import PlateProblem, PlateState
from rollnip.sheet.zones import (
    LONGEST_MOVE,
    SideZones,
    within_zone_middles,
    without_slivers_in,
)

Array = NDArray[np.float64]

_SLIVER = 1e-4  # over the width: shorter zones are removed


@dataclass(frozen=True, slots=True)
class PlateZones(SideZones):
    """The zones of the upper and of the lower interface of a plate, each between its own edges."""

    @property
    def edges(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Return trailing and leading edge of each contact [mm]."""
        return self.upper.edges, self.lower.edges

    @property
    def is_proper(self) -> bool:
        """Return whether all zone ends are finite and every zone has a positive length."""
        return self.upper.is_proper and self.lower.is_proper

    def breaks_of_mesh(self, number: int, thickness: float, *, peaks: bool = False) -> Array:
        """Return where the nodes of one interface crowd: its zone ends and some opposite places.

        Opposite an edge of the other contact, and opposite a transition from slip to stick on it,
        where the couple of its shear rises steeply, the pressure varies over about the thickness of
        the sheet. The nodes of a wide contact do not resolve that by themselves. A place that is
        closer than the thickness to another one shares the nodes of that one. An exception are the
        two edges of a contact that is narrower than that: through the sheet the shear beside each
        edge is felt separately. Where the pressure ends in peaks about as long as the sheet is
        thick, nodes crowd at both ends of each peak.

        Parameters
        ----------
        number : of the interface.
        thickness : of the sheet [mm].
        peaks : whether the pressure ends in such peaks, as on a bare roller.
        """
        own, opposite = self.sides[number], self.sides[1 - number]
        first, last = own.edges
        # only transitions where stick begins: there the shear behaves as a square root
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

    def edges_off(self, other: PlateZones) -> float:
        """Return the largest distance between the edges of both, over the widths of these zones."""
        parts = zip(self.sides, self.edges, other.edges, strict=True)
        off = (float(np.abs(np.subtract(a, b)).max()) / one.width for one, a, b in parts)
        return largest(*off)

    def states_on(self, x: tuple[Array, Array]) -> tuple[States, States]:
        """Return the states of the nodes on both interfaces."""
        return self.upper.states_on(x[0]), self.lower.states_on(x[1])

    def moved(
        self, problem: PlateProblem, state: PlateState, requested: PlateZones | None = None
    ) -> PlateZones:
        """Return zones whose ends are moved to where a solution with these zones puts them.

        A transition moves at most half of the way to its neighbours, and away from stick at most
        the length of that, because its place is told by the tractions there. An edge moves at most
        a 25th of the width, and outwards at most the length of the zone beside it. A transition of
        which only the direction is known moves as far as it may.

        Parameters
        ----------
        problem, state : a solution with nodes at the zone ends.
        requested : like zones, with states that meet all conditions on these meshes. They place a
            transition where the nearest shears do not, because all of them exceed their bounds.
        """
        sides = []
        for number, side in enumerate(self.sides):
            x, friction = problem.meshes[number].inner, problem.frictions[number]
            proposed = side.with_proposed_ends(x, state.side(number), friction).breaks
            if requested is not None:
                proposed = np.where(np.isfinite(proposed), proposed, requested.sides[number].breaks)
            trailing, leading = side.edges
            most, lengths, places = LONGEST_MOVE * side.width, side.lengths, side.breaks[1:-1]
            reach = np.where(side.states == State.STICK, lengths, side.width)
            proposed[1:-1] = proposed[1:-1].clip(places - reach[1:], places + reach[:-1])
            first, last = float(proposed[0]), float(proposed[-1])
            # an edge beside which no pressure rises lies in tension: move it to where that ends
            pressed = x[state.pressure[number] > 0.0]
            if pressed.size:
                first = float(pressed[0]) if first == inf else first
                last = float(pressed[-1]) if last == -inf else last
            outwards = np.minimum(most, lengths[[0, -1]])
            edges = (
                float(np.clip(first, trailing - outwards[0], trailing + most)),
                float(np.clip(last, leading - most, leading + outwards[1])),
            )
            sides.append(Layout(within_zone_middles(side.breaks, proposed, edges), side.states))
        return PlateZones(sides[0], sides[1])

    def shows_roots(self, problem: PlateProblem, state: PlateState) -> bool:
        """Return whether a solution shows where slip turns to stick, at each such transition.

        There the shear leaves its bound as a square root.
        """
        for number, side in enumerate(self.sides):
            x, friction = problem.meshes[number].inner, problem.frictions[number]
            proposed = side.with_proposed_ends(x, state.side(number), friction).breaks
            if not np.isfinite(proposed[1:-1][side.states[1:] == State.STICK]).all():
                return False
        return True

    def singular(self, problem: PlateProblem, state: PlateState) -> Array:
        """Return the inverse square roots in the pressures at all edges, NaN at transitions, (m,).

        See `Layout.singular`.
        """
        parts = []
        for number, side in enumerate(self.sides):
            part = np.full(side.breaks.size, np.nan)
            part[[0, -1]] = side.singular(problem.meshes[number].inner, state.side(number))
            parts.append(part)
        return np.concatenate(parts)

    def without_slivers(self) -> PlateZones:
        """Return the zones without those too short to matter."""
        upper, lower = (without_slivers_in(side, _SLIVER * side.width) for side in self.sides)
        return PlateZones(upper, lower)

    def reopened(self, misplaced: float) -> PlateZones:
        """Return zones in which short stick zones between opposite slip are lengthened.

        Their least length is twice the error that zone ends may have. The tractions of a zone are
        only sensitive over the length of the zone: if it closed while other ends were misplaced it
        could not grow again, because its ends would seem to be in place. ``misplaced``: allowed
        error of an end, over the width.
        """
        upper, lower = (_reopened(side, 2.0 * misplaced * side.width) for side in self.sides)
        return PlateZones(upper, lower)

    @classmethod
    def around(cls, problem: PlateProblem, state: PlateState) -> PlateZones:
        """Return the zones of nodal states on meshes that extend beyond the contacts.

        Nodes without pressure between others, where the pressure is low or few nodes resolve a dip,
        get the state of their neighbours. An interface whose zones are still disconnected gets one
        stick zone.
        """
        sides = []
        for number, (mesh, friction) in enumerate(
            zip(problem.meshes, problem.frictions, strict=True)
        ):
            zones = contact_zones(mesh.inner, _joined(state.side(number)), friction)
            if not zones:
                raise np.linalg.LinAlgError("an interface without contact")
            edges = np.array([zones[0].start, zones[-1].stop])
            sides.append(Layout.of(zones, friction) or Layout(edges, Layout.sticking(1.0).states))
        return cls(sides[0], sides[1])

    def found(self, problem: PlateProblem, state: PlateState) -> PlateZones | None:
        """Return the zones of nodal states between these edges; None where they are unclear."""
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
    """Return one interface with a connected contact: inner free nodes get the state before them."""
    states = state.states.copy()
    touching = np.flatnonzero(states != State.FREE)
    if touching.size:
        first, last = touching[[0, -1]]
        before = np.searchsorted(touching, np.arange(first, last + 1), side="right") - 1
        states[first : last + 1] = states[touching[before]]
    return replace(state, states=states)


def _reopened(layout: Layout, least: float) -> Layout:
    """Return a layout whose zones between unlike ones are at least ``least`` long [mm].

    They take at most half of their neighbours.
    """
    breaks, states = layout.breaks.copy(), layout.states
    for number in range(1, states.size - 1):
        before, start, stop, after = layout.breaks[number - 1 : number + 3]
        missing = least - (stop - start)
        if missing > 0.0 and states[number - 1] != states[number + 1]:
            breaks[number] = start - 0.5 * min(missing, start - before)
            breaks[number + 1] = stop + 0.5 * min(missing, after - stop)
    return Layout(breaks, states)
