"""Contact intervals and stick and slip zones of a nodal solution, located within the elements."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from rollnip.contact.problem import FREE, STICK, Array, ContactState, Mask, State, States


@dataclass(frozen=True, slots=True)
class ContactZone:
    """An interval of the contact in one state.

    Attributes
    ----------
    start, stop : trailing and leading end [mm].
    state : STICK, SLIP_PLUS or SLIP_MINUS.
    """

    start: float
    stop: float
    state: State


def contact_zones(x: Array, state: ContactState, friction: float) -> tuple[ContactZone, ...]:
    """Return the zones, trailing edge first; without friction each interval is one STICK zone.

    Ends are found by extrapolating a power of the tractions that is linear in the distance. At an
    edge the pressure, and at the trailing end of a stick zone mu p - |q|, vanish as a square root:
    their squares are extrapolated. At the leading end of a stick zone nothing is singular and
    mu p - |q| vanishes as the power 3/2.
    """
    states = state.states
    states = np.minimum(states, STICK) if friction == 0.0 else _without_slivers(states)
    zones = []
    squares = np.maximum(state.pressure, 0.0) ** 2
    for first, last in runs(states != FREE):
        edges = _crossing(x, squares, first, -1), _crossing(x, squares, last, +1)
        zones += zones_between(x, state, friction, states, (first, last), edges)
    return tuple(zones)


def contact_intervals(zones: tuple[ContactZone, ...]) -> tuple[tuple[float, float], ...]:
    """Return the contact intervals (trailing, leading) that adjoining zones make up [mm]."""
    intervals: list[tuple[float, float]] = []
    for zone in zones:
        if intervals and zone.start <= intervals[-1][1]:
            intervals[-1] = (intervals[-1][0], zone.stop)
        else:
            intervals.append((zone.start, zone.stop))
    return tuple(intervals)


def with_stick_between(zones: tuple[ContactZone, ...], friction: float) -> tuple[ContactZone, ...]:
    """Return the zones with stick between adjoining slip zones of opposite sign.

    The stick takes a share of the shorter slip zone on either side: half or, as its length falls
    with the friction, the cube root of the friction if that is less. It is rather too long, for
    where it is much too short, tractions do not tell where its ends belong (decision 103).
    """
    out = list(zones[:1])
    for zone in zones[1:]:
        before = out[-1]
        slips = STICK not in (before.state, zone.state) and before.state != zone.state
        if slips and before.stop == zone.start:
            share = min(0.5, friction ** (1.0 / 3.0))
            reach = share * min(before.stop - before.start, zone.stop - zone.start)
            start, stop = before.stop - reach, zone.start + reach
            out[-1] = replace(before, stop=start)
            out += [ContactZone(start, stop, State.STICK), replace(zone, start=stop)]
        else:
            out.append(zone)
    return tuple(out)


def runs(mask: Mask) -> list[tuple[int, int]]:
    """Return the first and last index of each run of True."""
    padded = np.concatenate([[False], mask, [False]])
    changes = np.flatnonzero(padded[1:] != padded[:-1])
    return [(int(a), int(b) - 1) for a, b in zip(changes[::2], changes[1::2], strict=True)]


def zones_between(
    x: Array,
    state: ContactState,
    friction: float,
    states: States,
    interval: tuple[int, int],
    edges: tuple[float, float],
) -> list[ContactZone]:
    """Return the zones of one contact interval, cut where the state changes.

    Parameters
    ----------
    states : of the nodes; they may differ from those of the solution ``state``.
    interval : the first and the last node in contact.
    edges : trailing and leading edge of the interval [mm].
    """
    first, last = interval
    slack = friction * state.pressure - np.abs(state.shear)
    zones: list[ContactZone] = []
    start = edges[0]
    for i in range(first, last + 1):
        if i < last and states[i + 1] == states[i]:
            continue
        stop = edges[1] if i == last else _transition(x, slack, states, i)
        zones.append(ContactZone(start, stop, State(states[i])))
        start = stop
    return zones


def _without_slivers(states: States) -> States:
    """Return states in which a lone slipping node beside a sticking one sticks, too.

    At an edge the pressure at the last node is no larger than its error, so the state of that node
    alone is no evidence of slip.
    """
    padded = np.zeros(states.size + 2, dtype=np.int8)  # free beyond both ends
    padded[1:-1] = states
    before, after = padded[:-2], padded[2:]
    alone = (states > STICK) & (before <= STICK) & (after <= STICK)
    alone &= (before == STICK) | (after == STICK)
    padded[1:-1][alone] = STICK
    return padded[1:-1]


def _transition(x: Array, slack: Array, states: States, i: int) -> float:
    """Return the place of a change of state between nodes i and i + 1; slack is mu p - |q|.

    It is extrapolated as in `contact_zones`.
    """
    slack = np.maximum(slack, 0.0)
    if states[i + 1] == STICK:
        return _crossing(x, slack**2, i + 1, -1)
    if states[i] == STICK:
        return _crossing(x, slack ** (2.0 / 3.0), i, +1)
    return 0.5 * float(x[i] + x[i + 1])


def _crossing(x: Array, values: Array, i: int, step: int) -> float:
    """Return where values extrapolated linearly from nodes i - step and i reach zero [mm].

    The result is kept between nodes i and i + step; it is their midpoint where the values do not
    fall towards node i.
    """
    beyond = i + step
    limit = x[beyond] if 0 <= beyond < x.size else x[i] + step * abs(x[i] - x[i - step])
    if not 0 <= i - step < x.size:
        return 0.5 * float(x[i] + limit)
    here, before = values[[i, i - step]]
    if before <= here:
        return 0.5 * float(x[i] + limit)
    place = x[i] + (x[i] - x[i - step]) * here / (before - here)
    return float(min(max(place, min(x[i], limit)), max(x[i], limit)))
