"""The free boundary: zones with given states, and where a solution puts their ends.

The contact may be in several pieces. Between two of them lies a free zone: no traction acts there,
and both of its ends are edges like the outer ones, at which the pressure vanishes as a square root.

A zone that is too wide by delta has, to first order, delta/2 times an inverse square root in the
tractions beside its end; one that is too narrow has the opposite. At short distances every surface
responds as a half-plane does. So on cosine nodes that pattern is the same for every zone, in units
of the first element, and the first nodes tell the error of an end. This is Newton's method with a
derivative known beforehand: from an error of a whole element, one step leaves a hundredth of one.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import inf, isfinite

import numpy as np

from rollnip.contact.edge_exponents import exponent_at_leading_edge
from rollnip.contact.ends import proposed_move, singular_part
from rollnip.contact.features import ContactZone, transition, with_stick_between
from rollnip.contact.problem import (
    FREE,
    STICK,
    Array,
    ContactState,
    Indices,
    Mask,
    State,
    States,
    shear_signs,
)

NEAR_ENOUGH = 0.1
"""Largest misplacement of ends, over the width, with which a solution shows what slips.

It is also the misplacement assumed initially, the free surface beside estimated edges, and the
relative change of a half-width or a correction up to which a contact is an initial guess for the
next one.
"""
_ROUNDING = float(np.sqrt(np.finfo(float).eps))  # least length of a zone over the width
_LONGEST_MOVE = 0.4  # longest move of an end into a zone, over the length of that zone


@dataclass(frozen=True, slots=True)
class Layout:
    """A sequence of adjoining zones from the trailing to the leading edge of the contact.

    Free zones lie between pieces of the contact. The ends of zones are called breaks; a break is
    an edge where one of its sides is free, otherwise a transition.

    Attributes
    ----------
    breaks : (m + 1,) ends of the zones, trailing to leading [mm].
    states : (m,) their states.
    """

    breaks: Array
    states: States

    @classmethod
    def of(cls, zones: tuple[ContactZone, ...]) -> Layout | None:
        """Return the layout of given zones, with free zones in the gaps between them.

        A stick zone is put between two slip zones of opposite sign, where the surfaces must
        stick. Return None where neighbours have the same state, or a zone has no length.
        """
        zones = with_stick_between(zones)
        if not zones:
            return None
        breaks, states = [zones[0].start], []
        for zone in zones:
            if zone.start > breaks[-1]:
                breaks.append(zone.start)
                states.append(State.FREE)
            breaks.append(zone.stop)
            states.append(zone.state)
        layout = cls(np.array(breaks), np.array(states, dtype=np.int8))
        alike = any(a == b for a, b in pairwise(states))
        return layout if not alike and layout.is_proper else None

    @classmethod
    def from_nodes(
        cls,
        x: Array,
        state: ContactState,
        friction: float,
        *pieces: tuple[float, float],
    ) -> Layout | None:
        """Return the layout of a nodal solution, given the edges of each piece of the contact.

        Only nodes within the pieces count; beyond them pressures may be negative. Return None as
        `of` does, or where a piece has no node in contact.
        """
        slack = friction * state.pressure - np.abs(state.shear)
        zones: list[ContactZone] = []
        for start, stop in pieces:
            touching = np.flatnonzero((state.states != FREE) & (x > start) & (x < stop))
            if touching.size == 0:
                return None
            first, last = touching[0], touching[-1]
            changes = [i for i in range(first, last) if state.states[i] != state.states[i + 1]]
            ends = [transition(x, slack, state.states, i) for i in changes]
            states = [State(int(state.states[i])) for i in (*changes, last)]
            zones += map(ContactZone, [start, *ends], [*ends, stop], states)
        return cls.of(tuple(zones))

    @classmethod
    def with_free_surfaces(cls, zones: tuple[ContactZone, ...], room: float) -> Layout:
        """Return the layout of given zones with the free surface between and beside them.

        Zones without a length are left out.

        Parameters
        ----------
        zones : contact zones; the contact as a whole must have a length.
        room : length of the free surface to include beyond either edge [mm].
        """
        start, stop = zones[0].start, zones[-1].stop
        least = _ROUNDING * (stop - start)
        breaks, states = [start - room, start], [FREE]
        for zone in zones:
            if zone.start - breaks[-1] > least:
                breaks.append(zone.start)
                states.append(FREE)
            if zone.stop - breaks[-1] > least:
                breaks.append(zone.stop)
                states.append(zone.state)
        breaks[-1] = stop
        return cls(np.array([*breaks, stop + room]), np.array([*states, FREE], dtype=np.int8))

    @classmethod
    def sticking(cls, half_width: float) -> Layout:
        """Return a single stick zone of given half-width about x = 0 [mm]."""
        return cls(np.array([-half_width, half_width]), np.array([STICK], dtype=np.int8))

    @property
    def edges(self) -> tuple[float, float]:
        """Trailing and leading edge of the contact [mm]."""
        return float(self.breaks[0]), float(self.breaks[-1])

    @property
    def is_edge(self) -> Mask:
        """Return which breaks are edges of a piece of the contact, not transitions, (m + 1,)."""
        free = np.concatenate([[True], self.states == FREE, [True]])
        return np.asarray(free[:-1] | free[1:])

    @property
    def width(self) -> float:
        """Width of the contact [mm]."""
        return float(self.breaks[-1] - self.breaks[0])

    @property
    def is_proper(self) -> bool:
        """Return whether all breaks are finite and every zone has a length beyond rounding."""
        breaks, least = self.breaks.tolist(), _ROUNDING * abs(self.width)
        return all(map(isfinite, breaks)) and all(b - a > least for a, b in pairwise(breaks))

    @property
    def key(self) -> bytes:
        """Return a key that layouts share if they have the same states in the same order."""
        return self.states.tobytes()

    def is_like(self, other: Layout) -> bool:
        """Return whether another layout has the same states in the same order."""
        return self.key == other.key

    def distance(self, other: Layout, transitions_count: float = 0.1) -> float:
        """Return the largest distance between breaks of two like layouts, over the width.

        Transitions count a tenth unless told otherwise, as figures of the nip depend on them only
        to second order.
        """
        moves = np.abs(self.breaks - other.breaks)
        moves[~self.is_edge] *= transitions_count
        return float(np.max(moves)) / other.width

    def stepped_towards(self, proposed: Layout) -> Layout:
        """Return this layout with its breaks moved towards proposed places, in limited steps.

        A break moves by at most `_LONGEST_MOVE` of the zone that it shortens, so that breaks do not
        cross, and by at most the length of the zone that it extends.
        """
        lengths = np.diff(self.breaks)
        behind = np.concatenate([[self.width], lengths])
        ahead = np.concatenate([lengths, [self.width]])
        furthest_back = np.minimum(_LONGEST_MOVE * behind, ahead)
        furthest_ahead = np.minimum(_LONGEST_MOVE * ahead, behind)
        moves = np.clip(proposed.breaks - self.breaks, -furthest_back, furthest_ahead)
        return Layout(self.breaks + moves, self.states)

    def vanishing(self, proposed: Layout) -> Mask:
        """Return which zones would have no length with the proposed breaks, (m,).

        A break whose proposed place is infinite means only that its zone extends further. Within
        the zone the tractions show no more than about its own length, so a longer neighbour does
        not count as vanishing.
        """
        lengths, breaks = np.diff(self.breaks), proposed.breaks.copy()
        behind, ahead = np.append(np.inf, lengths), np.append(lengths, np.inf)
        unseen = (np.isposinf(breaks) & (ahead > behind)) | (np.isneginf(breaks) & (behind > ahead))
        breaks[unseen] = self.breaks[unseen]
        with np.errstate(invalid="ignore"):
            return np.asarray(~(np.diff(breaks) > 0.0))

    def without(self, number: int, *, keeps_stick: bool) -> Layout | None:
        """Return the layout without zone ``number``, which its neighbours take over.

        Equal neighbours become one zone. Beside an edge, the neighbour on the other side extends to
        the edge. A free zone beside stick is closed halfway. Return None if it is the only zone, if
        slip in opposite directions would adjoin, or if no stick would be left where
        ``keeps_stick`` requires some.
        """
        breaks = [-inf, *self.breaks.tolist(), inf]
        states = [int(FREE), *self.states.tolist(), int(FREE)]
        before, state, after = states[number : number + 3]
        del states[number + 1]
        if self.states.size == 1:
            return None
        if before == after:
            del states[number + 1], breaks[number + 1 : number + 3]
        elif FREE in (before, after):
            del breaks[number + (2 if before == FREE else 1)]
        elif state == FREE and STICK in (before, after):
            breaks[number + 1 : number + 3] = [0.5 * sum(breaks[number + 1 : number + 3])]
        else:
            return None
        if keeps_stick and STICK not in states:
            return None
        return Layout(np.array(breaks[1:-1]), np.array(states[1:-1], dtype=np.int8))

    def without_short_zones(self, least: float, known: Layout, *, keeps_stick: bool) -> Layout:
        """Return the layout without zones shorter than ``least`` [mm], removing the shortest first.

        It keeps those that overlap a zone of ``known`` in the same state, and stops at the first
        zone that cannot be removed, see `without`.
        """
        layout = self
        while True:
            lengths = np.where(layout._overlaps(known), np.inf, np.diff(layout.breaks))
            shortest = int(np.argmin(lengths))
            fewer = layout.without(shortest, keeps_stick=keeps_stick)
            if fewer is None or lengths[shortest] >= least:
                return layout
            layout = fewer

    def _overlaps(self, other: Layout) -> Mask:
        """Return which zones overlap a zone of ``other`` in the same state."""
        starts = np.maximum(self.breaks[:-1, None], other.breaks[:-1])
        stops = np.minimum(self.breaks[1:, None], other.breaks[1:])
        return np.asarray(((self.states[:, None] == other.states) & (starts < stops)).any(axis=1))

    @property
    def reversals(self) -> list[int]:
        """Numbers of the zones of stick where slip changes its sign, shorter than that slip."""
        signs, lengths = shear_signs(self.states), np.diff(self.breaks)
        opposite = signs[:-2] * signs[2:] == -1.0
        between = opposite & (self.states[1:-1] == STICK)
        between &= lengths[1:-1] < lengths[:-2] + lengths[2:]
        return (np.flatnonzero(between) + 1).tolist()

    def with_reversals(self, proposed: Layout, least: float) -> Layout:
        """Return the proposed zones with a stick of some length wherever slip changes its sign.

        There the surfaces stick over a length that falls with the friction. Where the proposed ends
        of such a zone cross, or leave it shorter than ``least`` [mm], or where one of them is given
        no place, they tell only where its middle should be, and no further than it is long: it
        moves there, at half its length.
        """
        breaks = proposed.breaks.copy()
        for start in self.reversals:
            ends = [start, start + 1]
            now, then = self.breaks[ends], proposed.breaks[ends]
            given = np.isfinite(then)
            if given.any() and not (given.all() and then[1] - then[0] >= least):
                middle = now.mean() + (then - now)[given].mean()
                half_length = 0.5 * max(0.5 * (now[1] - now[0]), least)
                breaks[ends] = middle - half_length, middle + half_length
        return Layout(breaks, self.states)

    def with_gap(self, start: float, stop: float) -> Layout | None:
        """Return the layout with a free zone from ``start`` to ``stop`` [mm].

        Return None unless both lie in the same zone.
        """
        number = int(np.searchsorted(self.breaks, start)) - 1
        if not (self.breaks[number] < start < stop < self.breaks[number + 1]):
            return None
        state = self.states[number]
        breaks = np.insert(self.breaks, number + 1, [start, stop])
        return Layout(breaks, np.insert(self.states, number + 1, [FREE, state]))

    @property
    def zones(self) -> tuple[ContactZone, ...]:
        """Return the zones in contact, from trailing to leading edge."""
        ends = zip(self.breaks[:-1], self.breaks[1:], self.states, strict=True)
        zones = (ContactZone(float(a), float(b), State(int(s))) for a, b, s in ends)
        return tuple(zone for zone in zones if zone.state != FREE)

    @property
    def slip_beyond_stick(self) -> Array:
        """Return for each stick zone the length of slip between it and a leading edge, else inf."""
        lengths = np.diff(self.breaks)
        out = np.full(lengths.size, inf)
        slips = (self.states[:-1] == STICK) & (self.states[1:] > STICK) & self.is_edge[2:]
        out[:-1][slips] = lengths[1:][slips]
        return out

    def ends(self, x: Array) -> Indices:
        """Return the indices of the nodes at the breaks, (m + 1,)."""
        return np.searchsorted(x, self.breaks - 1e-12 * self.width)

    def states_on(self, x: Array) -> States:
        """Return the state of each node; a node at a break is FREE or slips, so its shear is known.

        At edges it is FREE, at transitions it has the state of the slip zone.
        """
        ends = self.ends(x)
        out = np.full(x.size, FREE, dtype=np.int8)
        for start, stop, state in zip(ends[:-1], ends[1:], self.states, strict=True):
            slips = state != STICK
            out[start + (not slips) : stop + slips] = state
        out[ends[self.is_edge]] = FREE
        return out

    def edge_exponents(self, beta: float, friction: float) -> tuple[complex, ...]:
        """Return the exponents at all edges, trailing edge first, see `contact.edge_exponents`."""
        out = []
        for number in np.flatnonzero(self.is_edge).tolist():
            leads = self.leads(number)
            state = int(self.states[number - leads])
            out.append((1.0 if leads else -1.0) * exponent_at_leading_edge(state, beta, friction))
        return tuple(out)

    def leads(self, edge: int) -> bool:
        """Return whether the edge with the number of its break is a leading edge."""
        return edge == self.states.size or bool(self.states[edge] == FREE)

    def with_proposed_ends(
        self,
        x: Array,
        state: ContactState,
        friction: float,
        exponents: tuple[complex, ...] = (),
    ) -> Layout:
        """Return the layout with its breaks where a solution with its states proposes them.

        The pressure at an edge, and mu p - |q| at the trailing end of stick, vanish as a square
        root. At the leading end of stick mu p - |q| is smooth: it goes as y^(3/2) with the distance
        y from there, and (y + d)^(3/2) = y^(3/2) + 3/2 d y^(1/2) to first order in the error d.

        Parameters
        ----------
        x : (n,) nodes, those at the breaks among them [mm].
        state : a solution with ``states_on(x)``.
        friction : Coulomb coefficient.
        exponents : see `edge_exponents`; empty: square roots at all edges.
        """
        # Lists, not arrays: NumPy would be slower for three values at each of a few breaks.
        nodes, tractions = x.tolist(), (state.pressure + 1j * state.shear).tolist()
        signs, ends = shear_signs(self.states).tolist(), self.ends(x).tolist()
        edges = self.is_edge.tolist()
        kappas, breaks = iter(exponents), []
        for number, (place, end) in enumerate(zip(self.breaks.tolist(), ends, strict=True)):
            is_edge = edges[number]
            smooth = not is_edge and self.states[number - 1] == STICK
            inwards = -1 if smooth or (is_edge and self.leads(number)) else 1
            # The sign is that of the slip zone: in a short stick zone the shear may change sign.
            sign = 0 if is_edge else signs[number if smooth else number - 1]
            kappa = next(kappas, 0j) if is_edge else 0j
            weight = (1.0 if is_edge else friction) + 1j * sign
            # At a smooth end nodes further inside are tried, see `proposed_move`.
            furthest = (end - ends[number - 1]) // 3 if smooth else 0
            step = proposed_move(nodes, tractions, end, inwards, weight, kappa, furthest)
            breaks.append(place - inwards * step)
        return Layout(np.array(breaks), self.states)

    def singular(self, x: Array, state: ContactState) -> Array:
        """Return the amplitudes of the inverse square roots in the pressure at both edges, (2,).

        Each is the factor of the square root at that edge times the move that the edge needs,
        positive towards the leading edge [MPa sqrt(mm)].
        """
        ends = zip(self.ends(x)[[0, -1]].tolist(), (1, -1), strict=True)
        return np.array([inwards * singular_part(x, state, end, inwards) for end, inwards in ends])
