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
from functools import cached_property
from itertools import pairwise
from math import inf, isfinite

import numpy as np

from rollnip.contact.edge_exponents import exponent_at_leading_edge
from rollnip.contact.ends import ZoneEnd
from rollnip.contact.features import ContactZone, with_stick_between, zones_between
from rollnip.contact.problem import (
    FREE,
    SLIP_MINUS,
    SLIP_PLUS,
    STICK,
    Array,
    ContactState,
    Indices,
    Mask,
    State,
    States,
)

NEAR_ENOUGH = 0.1
"""Largest misplacement of ends, over the width, with which a solution shows what slips.

It is also the misplacement assumed initially, the free surface beside estimated edges, and the
relative change of a half-width or a correction up to which a contact is an initial guess for the
next one.
"""
_ROUNDING = float(np.sqrt(np.finfo(float).eps))  # least length of a zone over the width
_LONGEST_MOVE = 0.4  # longest move of an end into a zone, over the length of that zone


@dataclass(frozen=True)
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
    def of(cls, zones: tuple[ContactZone, ...], friction: float) -> Layout | None:
        """Return the layout of given zones, with free zones in the gaps between them.

        A stick zone is put between two slip zones of opposite sign, where the surfaces must
        stick. Return None where neighbours have the same state, or a zone has no length.
        """
        zones = with_stick_between(zones, friction)
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
        zones: list[ContactZone] = []
        for start, stop in pieces:
            touching = np.flatnonzero((state.states != FREE) & (x > start) & (x < stop))
            if touching.size == 0:
                return None
            nodes = int(touching[0]), int(touching[-1])
            zones += zones_between(x, state, friction, state.states, nodes, (start, stop))
        return cls.of(tuple(zones), friction)

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

    @cached_property
    def is_edge(self) -> Mask:
        """Which breaks are edges of a piece of the contact, not transitions, (m + 1,)."""
        free = [True, *(self.states == FREE).tolist(), True]
        return np.array([before or after for before, after in pairwise(free)])

    @cached_property
    def width(self) -> float:
        """Width of the contact [mm]."""
        return float(self.breaks[-1] - self.breaks[0])

    @cached_property
    def lengths(self) -> Array:
        """Lengths of the zones, (m,) [mm]."""
        return self.breaks[1:] - self.breaks[:-1]

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
        moves = np.abs(self.breaks - other.breaks) * np.where(self.is_edge, 1.0, transitions_count)
        return float(moves.max()) / other.width

    def stepped_towards(self, proposed: Layout) -> Layout:
        """Return this layout with its breaks moved towards proposed places, in limited steps.

        A break moves by at most `_LONGEST_MOVE` of the zone that it shortens, so that breaks do not
        cross, and by at most the length of the zone that it extends.
        """
        lengths = np.array([self.width, *self.lengths.tolist(), self.width])
        behind, ahead = lengths[:-1], lengths[1:]
        least = -np.minimum(_LONGEST_MOVE * behind, ahead)
        most = np.minimum(_LONGEST_MOVE * ahead, behind)
        moves = (proposed.breaks - self.breaks).clip(least, most)
        return Layout(self.breaks + moves, self.states)

    def vanishing(self, proposed: Layout) -> set[int]:
        """Return the numbers of the zones that would have no length with the proposed breaks.

        A break whose proposed place is infinite means only that its zone extends further. Within
        the zone the tractions show no more than about its own length, so a longer neighbour does
        not count as vanishing.
        """
        places = proposed.breaks.tolist()
        for number, (behind, ahead) in enumerate(pairwise([inf, *self.lengths.tolist(), inf])):
            place = places[number]
            if (place == inf and ahead > behind) or (place == -inf and behind > ahead):
                places[number] = self.breaks.item(number)
        return {number for number, (a, b) in enumerate(pairwise(places)) if not b > a}

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
            lengths = np.where(layout._overlaps(known), np.inf, layout.lengths)
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
        states, lengths = self.states.tolist(), self.lengths.tolist()
        return [
            middle
            for middle in range(1, len(states) - 1)
            if states[middle] == STICK
            and {states[middle - 1], states[middle + 1]} == {SLIP_PLUS, SLIP_MINUS}
            and lengths[middle] < lengths[middle - 1] + lengths[middle + 1]
        ]

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
    def slip_beyond_stick(self) -> list[float]:
        """Return for each stick zone the length of slip between it and a leading edge, else inf."""
        states, out = [*self.states.tolist(), FREE, FREE], [inf] * self.states.size
        for number, length in enumerate(self.lengths.tolist()[1:]):
            here, ahead, beyond = states[number : number + 3]
            if here == STICK and ahead > STICK and beyond == FREE:
                out[number] = length
        return out

    def ends(self, x: Array) -> Indices:
        """Return the indices of the nodes at the breaks, (m + 1,)."""
        return x.searchsorted(self.breaks - 1e-12 * self.width)

    def states_on(self, x: Array) -> States:
        """Return the state of each node; a node at a break is FREE or slips, so its shear is known.

        At edges it is FREE, at transitions it has the state of the slip zone.
        """
        ends = self.ends(x)
        out = np.full(x.size, FREE, dtype=np.int8)
        for (start, stop), state in zip(pairwise(ends.tolist()), self.states.tolist(), strict=True):
            slips = state != STICK
            out[start + (not slips) : stop + slips] = state
        out[ends[self.is_edge]] = FREE
        return out

    def exponents(self, beta: float, friction: float) -> tuple[complex, ...]:
        """Return the exponents at all breaks, see `contact.edge_exponents`; 0 at smooth ends."""
        out: list[complex] = []
        for before, after in pairwise([FREE, *self.states.tolist(), FREE]):
            if before == FREE:
                out.append(-exponent_at_leading_edge(after, beta, friction))
            elif after in (FREE, STICK):
                out.append(exponent_at_leading_edge(before, beta, friction))
            else:
                out.append(0j)
        return tuple(out)

    def with_proposed_ends(
        self,
        x: Array,
        state: ContactState,
        friction: float,
        exponents: tuple[complex, ...] = (),
    ) -> Layout:
        """Return the layout with its breaks where a solution with its states proposes them.

        The pressure at an edge, and mu p - |q| at the trailing end of stick, vanish as a square
        root, but for their exponents. At the leading end of stick mu p - |q| is smooth: it goes as
        y^(3/2) with the distance y from there, and (y + d)^(3/2) = y^(3/2) + 3/2 d y^(1/2) to first
        order in the error d.

        Parameters
        ----------
        x : (n,) nodes, those at the breaks among them [mm].
        state : a solution with ``states_on(x)``.
        friction : Coulomb coefficient.
        exponents : see `exponents`; empty: square roots at all breaks.
        """
        ends, breaks = self.ends(x).tolist(), []
        kappas = exponents or (0j,) * self.breaks.size
        sides = pairwise([FREE, *self.states.tolist(), FREE])
        for number, ((before, after), place, kappa) in enumerate(
            zip(sides, self.breaks.tolist(), kappas, strict=True)
        ):
            if FREE in (before, after):
                inwards, weight = 1 if before == FREE else -1, 1.0 + 0j
            else:
                # The sign is that of the slip: in a short stick zone the shear may change sign.
                inwards, slip = (-1, after) if before == STICK else (1, before)
                weight = complex(friction, 1.0 if slip == SLIP_PLUS else -1.0)
            # At a smooth end nodes further inside are tried, see `ZoneEnd.proposed_move`.
            smooth = before == STICK and after != FREE
            furthest = (ends[number] - ends[number - 1]) // 3 if smooth else 0
            end = ZoneEnd(x, state, ends[number], inwards, kappa)
            breaks.append(place - inwards * end.proposed_move(weight, furthest))
        return Layout(np.array(breaks), self.states)

    def singular(self, x: Array, state: ContactState) -> Array:
        """Return the amplitudes of the inverse square roots in the pressure at both edges, (2,).

        Each is the factor of the square root at that edge times the move that the edge needs,
        positive towards the leading edge [MPa sqrt(mm)].
        """
        first, last = self.ends(x)[[0, -1]].tolist()
        trailing, leading = ZoneEnd(x, state, first, 1), ZoneEnd(x, state, last, -1)
        return np.array([trailing.singular_part(), -leading.singular_part()])
