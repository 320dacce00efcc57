"""Contact intervals and stick/slip zones of a discrete solution, to a fraction of an element."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rollnip.contact.problem import FREE, STICK, Array, ContactState, Mask, State, States


@dataclass(frozen=True, slots=True)
class ContactZone:
    """A piece of the contact in one state.

    Attributes
    ----------
    start, stop : trailing and leading end [mm].
    state : STICK, SLIP_PLUS or SLIP_MINUS.
    """

    start: float
    stop: float
    state: State


def contact_zones(x: Array, state: ContactState, friction: float) -> tuple[ContactZone, ...]:
    """Return zones, trailing edge first; without friction each interval is one STICK zone.

    Pressure goes to zero as the square root of the distance to an edge, and mu p - |q| as the
    square root of the distance to the trailing end of a stick zone, where stick turns to slip, so
    their squares are extrapolated linearly. At its leading end slip turns to stick, nothing is
    singular and mu p - |q| goes as the power 3/2.
    """
    states = state.states
    states = np.minimum(states, STICK) if friction == 0.0 else _without_slivers(states)
    zones = []
    squares = np.maximum(state.pressure, 0.0) ** 2
    for first, last in runs(states != FREE):
        edges = _crossing(x, squares, first, -1), _crossing(x, squares, last, +1)
        zones += _split(x, state, friction, states, (first, last), edges)
    return tuple(zones)


def contact_intervals(zones: tuple[ContactZone, ...]) -> tuple[tuple[float, float], ...]:
    """Join neighbouring zones to contact intervals (trailing, leading) [mm]."""
    intervals: list[tuple[float, float]] = []
    for zone in zones:
        if intervals and zone.start <= intervals[-1][1]:
            intervals[-1] = (intervals[-1][0], zone.stop)
        else:
            intervals.append((zone.start, zone.stop))
    return tuple(intervals)


def runs(mask: Mask) -> list[tuple[int, int]]:
    """Return the first and last index of each run of True."""
    padded = np.concatenate([[False], mask, [False]])
    changes = np.flatnonzero(padded[1:] != padded[:-1])
    return [(int(a), int(b) - 1) for a, b in zip(changes[::2], changes[1::2], strict=True)]


def _split(
    x: Array,
    state: ContactState,
    friction: float,
    states: States,
    interval: tuple[int, int],
    edges: tuple[float, float],
) -> list[ContactZone]:
    """Cut one contact interval at its changes of state."""
    first, last = interval
    slack = friction * state.pressure - np.abs(state.shear)
    zones: list[ContactZone] = []
    start = edges[0]
    for i in range(first, last + 1):
        if i < last and states[i + 1] == states[i]:
            continue
        stop = edges[1] if i == last else transition(x, slack, states, i)
        zones.append(ContactZone(start, stop, State(states[i])))
        start = stop
    return zones


def _without_slivers(states: States) -> States:
    """Turn a single slipping node beside a sticking one, with no slip beside it, into stick.

    At an edge the pressure of the last node is as large as its error, and whether that node
    alone sticks or slips says nothing about the contact.
    """
    padded = np.zeros(states.size + 2, dtype=np.int8)  # free beyond both ends
    padded[1:-1] = states
    before, after = padded[:-2], padded[2:]
    alone = (states > STICK) & (before <= STICK) & (after <= STICK)
    alone &= (before == STICK) | (after == STICK)
    padded[1:-1][alone] = STICK
    return padded[1:-1]


def transition(x: Array, slack: Array, states: States, i: int) -> float:
    """Return the place between nodes i and i + 1 of a change of state; slack is mu p - |q|.

    To the power that `contact_zones` names it is linear in the distance from that place.
    """
    slack = np.maximum(slack, 0.0)
    if states[i + 1] == STICK:
        return _crossing(x, slack**2, i + 1, -1)
    if states[i] == STICK:
        return _crossing(x, slack ** (2.0 / 3.0), i, +1)
    return 0.5 * float(x[i] + x[i + 1])


def _crossing(x: Array, values: Array, i: int, step: int) -> float:
    """Return the place where values, extrapolated from nodes i - step and i, vanish [mm].

    It lies between node i and the place of node i + step, and is their midpoint where no zero can
    be extrapolated.
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
