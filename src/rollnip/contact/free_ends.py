"""Zones with given states and free ends: where the ends should be.

A zone that is too wide by delta leaves, to first order, delta/2 times an inverse square root in
the tractions beside its end; one that is too narrow leaves the opposite. On nodes at cosine places
that pattern is the same for every zone, in units of the first element: at short distance every
surface responds as a half-plane does. So the first nodes tell how far an end is off. It is Newton's
method with the derivative known beforehand; misplaced by a whole element, an end is found again
to a hundredth of one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import copysign, inf, isfinite, sqrt

import numpy as np

from rollnip.contact.coupled import LinearSystem, next_slip, solve_states
from rollnip.contact.features import ContactZone, transition
from rollnip.contact.problem import (
    FREE,
    STICK,
    Array,
    ContactProblem,
    ContactState,
    Indices,
    Mask,
    State,
    States,
    shear_signs,
)

# Of the first three nodes beside the end of a zone of many cubic elements (see `subdivided`): the
# change relative to a square root from there, for each first element that the zone is too wide.
# Measured on a parabola pressed on a half-plane (tests).
_RESPONSE = (-0.6831, -0.1132, -0.0597)

_ROUNDING = 1e-9  # length of a zone over the width of the contact, at least
_SHORTEST = 1e-4  # likewise, of a zone found node by node
# Length of stick put between slip both ways, on either side, over the shorter zone of slip.
_STICK_BETWEEN = 0.1
_MOVE_WITHOUT_PLACE = 0.1  # likewise, where no place is asked for
_LONGEST_MOVE = 0.4  # of an end into a zone, over its length, where ends are asked to cross


@dataclass(frozen=True, slots=True)
class Layout:
    """The zones of one contact interval.

    Attributes
    ----------
    breaks : (m + 1,) ends of the zones, trailing to leading [mm].
    states : (m,) their states.
    """

    breaks: Array
    states: States

    @classmethod
    def of(cls, zones: tuple[ContactZone, ...]) -> Layout | None:
        """Return the layout of zones; None where they do not touch.

        Between slip one way and the other the surfaces stick: a short zone is put there.
        """
        zones = _with_stick_between(zones)
        if not zones:
            return None
        states = np.array([zone.state for zone in zones], dtype=np.int8)
        layout = cls(np.array([zones[0].start, *(zone.stop for zone in zones)]), states)
        touching = all(a.stop == b.start for a, b in pairwise(zones))
        alike = any(a.state == b.state for a, b in pairwise(zones))
        return layout if touching and not alike and layout.is_proper else None

    @classmethod
    def found(
        cls, x: Array, state: ContactState, friction: float, edges: tuple[float, float]
    ) -> Layout | None:
        """Return the layout of the states of nodes in one contact with known edges; None as above.

        Beyond the edges the pressure may be negative, and sticking nodes there do not count.
        """
        slack = friction * state.pressure - np.abs(state.shear)
        touching = np.flatnonzero((state.states != FREE) & (x > edges[0]) & (x < edges[1]))
        if touching.size == 0:
            return None
        first, last = touching[0], touching[-1]
        changes = [i for i in range(first, last) if state.states[i] != state.states[i + 1]]
        ends = [transition(x, slack, state.states, i) for i in changes]
        breaks = [edges[0], *ends, edges[1]]
        states = [State(int(state.states[i])) for i in (*changes, last)]
        return cls.of(tuple(map(ContactZone, breaks[:-1], breaks[1:], states)))

    @classmethod
    def around(cls, zones: tuple[ContactZone, ...], room: float) -> Layout:
        """Return the layout of zones and of the free surfaces between and beside them.

        Zones shorter than `_SHORTEST` of the width are left out.

        Parameters
        ----------
        zones : with some length in all.
        room : length of the free surface beyond either edge [mm].
        """
        start, stop = zones[0].start, zones[-1].stop
        least = _SHORTEST * (stop - start)
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
        """Return a single zone of stick of some half-width [mm]."""
        return cls(np.array([-half_width, half_width]), np.array([STICK], dtype=np.int8))

    @property
    def edges(self) -> tuple[float, float]:
        """Trailing and leading edge of the contact [mm]."""
        return float(self.breaks[0]), float(self.breaks[-1])

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
        """Return what layouts of like zones have in common: the states in their order."""
        return self.states.tobytes()

    def is_like(self, other: Layout) -> bool:
        """Return whether another layout has the same states in the same order."""
        return self.key == other.key

    def distance(self, other: Layout) -> float:
        """Return the largest distance of the edges of two like layouts, over the width.

        The distance of transitions counts a tenth, for figures of the nip depend on them only to
        second order.
        """
        moves = np.abs(self.breaks - other.breaks)
        moves[1:-1] *= 0.1
        return float(np.max(moves)) / other.width

    def towards(self, asked: Layout) -> Layout:
        """Return this layout with its breaks moved towards those asked for, without crossing.

        No zone becomes more than twice as long, and no break goes further than `_LONGEST_MOVE` of
        the zone that it moves into.
        """
        lengths = np.diff(self.breaks)
        back = np.concatenate([[self.width], lengths])
        ahead = np.concatenate([lengths, [self.width]])
        moves = asked.breaks - self.breaks
        little = np.where(np.isfinite(moves), np.inf, _MOVE_WITHOUT_PLACE * np.minimum(back, ahead))
        furthest_back = np.minimum(np.minimum(_LONGEST_MOVE * back, ahead), little)
        furthest_ahead = np.minimum(np.minimum(_LONGEST_MOVE * ahead, back), little)
        bounded = np.clip(moves, -furthest_back, furthest_ahead)
        return Layout(self.breaks + bounded, self.states)

    def vanishing(self, asked: Layout) -> Mask:
        """Return which zones would have no length left with the breaks asked for, (m,)."""
        with np.errstate(invalid="ignore"):
            return np.asarray(~(np.diff(asked.breaks) > 0.0))

    def without(self, number: int, *, keeps_stick: bool) -> Layout | None:
        """Return the layout without one zone; None where slip both ways would be side by side.

        ``keeps_stick``: whether one zone of stick must be left.
        """
        breaks, states = self.breaks.tolist(), self.states.tolist()
        if len(states) == 1:
            return None
        if number in (0, len(states) - 1):
            del states[number]
            del breaks[1 if number == 0 else -2]
        elif states[number - 1] == states[number + 1]:
            del states[number : number + 2]
            del breaks[number : number + 2]
        else:
            return None
        if keeps_stick and STICK not in states:
            return None
        return Layout(np.array(breaks), np.array(states, dtype=np.int8))

    def slipping_up_to(self, place: float, slip: State) -> Layout | None:
        """Return the layout with a zone of slip from a place [mm] to the nearer edge.

        Return None where the contact does not stick there.
        """
        leads = place > self.breaks.mean()
        if self.states[-1 if leads else 0] != STICK:
            return None
        breaks = np.insert(self.breaks, self.breaks.size - 1 if leads else 1, place)
        states = np.insert(self.states, self.states.size if leads else 0, np.int8(slip))
        return Layout(breaks, states)

    @property
    def zones(self) -> tuple[ContactZone, ...]:
        """Return the zones, from trailing to leading edge."""
        ends = zip(self.breaks[:-1], self.breaks[1:], self.states, strict=True)
        return tuple(ContactZone(float(a), float(b), State(int(s))) for a, b, s in ends)

    def ends(self, x: Array) -> Indices:
        """Return the indices of the nodes at the breaks."""
        return np.searchsorted(x, self.breaks - 1e-12 * self.width)

    def states_on(self, x: Array) -> States:
        """Return the state of each node; at a break it is one with known shear: FREE or slip."""
        ends = self.ends(x)
        out = np.full(x.size, FREE, dtype=np.int8)
        for start, stop, state in zip(ends[:-1], ends[1:], self.states, strict=True):
            slips = state != STICK
            out[start + (not slips) : stop + slips] = state
        out[ends[0]] = out[ends[-1]] = FREE
        return out

    def moved(self, x: Array, state: ContactState, friction: float) -> Layout:
        """Return the layout with its breaks moved to where a solution with these states puts them.

        Pressure goes as a square root at an edge, mu p - |q| where stick turns to slip. Where
        slip turns to stick, mu p - |q| is smooth: it goes as y^(3/2) from the place where stick
        ends, and (y + d)^(3/2) = y^(3/2) + 3/2 d y^(1/2) to first order.

        Parameters
        ----------
        x : (n,) nodes, those at the breaks among them [mm].
        state : a solution with ``states_on(x)``.
        friction : Coulomb coefficient.
        """
        # Plain numbers: there are three of each at a handful of breaks.
        nodes, pressure, shear = x.tolist(), state.pressure.tolist(), state.shear.tolist()
        signs, ends = shear_signs(self.states).tolist(), self.ends(x).tolist()
        last = self.states.size
        breaks = []
        for number, (place, end) in enumerate(zip(self.breaks.tolist(), ends, strict=True)):
            is_edge = number in (0, last)
            smooth = not is_edge and self.states[number - 1] == STICK
            inwards = -1 if smooth or number == last else 1
            # In a short zone of stick the shear may change its sign.
            sign = 0 if is_edge else signs[number if smooth else number - 1]
            bound = 1.0 if is_edge else friction
            # At a smooth end nothing is singular: where the first nodes tell no place, for values
            # there are as small as their errors, nodes further inside do.
            furthest = (end - ends[number - 1]) // 3 if smooth else 1
            off, reach, apart = inf, 0.0, 1
            while abs(off) > reach and apart <= furthest:
                beside = [end + inwards * apart * i for i in (1, 2, 3)]
                distance = [abs(nodes[i] - place) for i in beside]
                values = [bound * pressure[i] - sign * shear[i] for i in beside]
                off, apart = _outwards(distance, values, smooth=smooth), 2 * apart
                reach = distance[-1]
            breaks.append(place - inwards * off)
        return Layout(np.array(breaks), self.states)


def _with_stick_between(zones: tuple[ContactZone, ...]) -> tuple[ContactZone, ...]:
    """Put stick between zones that slip both ways."""
    out = list(zones[:1])
    for zone in zones[1:]:
        before = out[-1]
        if STICK not in (before.state, zone.state) and before.state != zone.state:
            reach = _STICK_BETWEEN * min(before.stop - before.start, zone.stop - zone.start)
            start, stop = before.stop - reach, zone.start + reach
            out[-1] = replace(before, stop=start)
            out += [ContactZone(start, stop, State.STICK), replace(zone, start=stop)]
        else:
            out.append(zone)
    return tuple(out)


_Three = Sequence[float]


def _outwards(distance: _Three, values: _Three, *, smooth: bool) -> float:
    """Return how far outwards a zone's end should move, from values at three distances inwards.

    The values are fitted by s, s^3 and a third pattern, where s is the square root of the
    distance: the pattern that a misplaced end leaves, or s^5 at a smooth end. Where the values do
    not rise inwards as they should, the end is infinitely far off, on the side that they tell.
    """
    first = (1.0, 1.0, 1.0)
    third = [d * d for d in distance] if smooth else _RESPONSE
    right = [value / sqrt(d) for value, d in zip(values, distance, strict=True)]
    whole = _determinant(first, distance, third)
    root = _determinant(right, distance, third)
    if smooth:
        bend = _determinant(first, right, third)
        return root / (1.5 * bend) if bend * whole > 0.0 else copysign(inf, root * whole)
    misplaced = _determinant(first, distance, right)
    if root * whole > 0.0:
        return -misplaced / root * distance[0]
    return copysign(inf, -misplaced * whole)


def _determinant(a: _Three, b: _Three, c: _Three) -> float:
    """Return the determinant of the matrix with these three columns."""
    return (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )


@dataclass(slots=True)
class GivenStates:
    """Solver of a contact problem whose states are given and kept.

    It keeps its last linear system, for problems on the same mesh with other second-order terms.
    """

    _last: LinearSystem | None = None

    def solve(self, problem: ContactProblem, states: States) -> ContactState:
        """Return the solution for these states; whether they are right is checked later."""
        last = self._last
        if (
            last is None
            or last.problem.influence is not problem.influence
            or not np.array_equal(last.states, states)
        ):
            last = self._last = LinearSystem.of(problem, states)
        return last.solved(problem, settled=True)


@dataclass(frozen=True, slots=True)
class HeldContact:
    """Solver of a contact problem whose contact set is given; stick and slip are found.

    Parameters
    ----------
    max_steps : linear systems to solve at most.
    rounding : as that of `CoupledActiveSet`.
    """

    max_steps: int = 12
    rounding: float = 1e-11

    def solve(self, problem: ContactProblem, states: States) -> ContactState:
        """Return the solution on the contact set of ``states``, with stick and slip iterated.

        Pressure may be negative and surfaces may overlap; this is checked later.
        """
        for step in range(1, self.max_steps + 1):
            solution = solve_states(problem, states, steps=step, settled=True)
            if step == self.max_steps:
                break
            wanted = next_slip(problem, solution, self.rounding)
            if np.array_equal(wanted, states):
                break
            states = wanted
        return solution
