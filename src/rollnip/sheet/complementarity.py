"""Parts of the node-by-node solution that membranes and plates have in common."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import ContactState, State, States, stick_and_slip

Array = NDArray[np.float64]

LEAST_PRESSURE = 0.15
"""Least initial pressure of a node, over the highest one."""


def indentation(depth: Array, pressure: Array) -> float:
    """Return how much deeper a surface is indented inside the contact than at its edges [mm].

    ``depth``: of the surface under the pressure, at the same nodes, (n,). Where the surface does
    not rise towards the edges, the largest depth is returned.
    """
    inside = np.flatnonzero(pressure)
    rise = float(depth[inside].max() - 0.5 * (depth[inside[0]] + depth[inside[-1]]))
    return rise if rise > 0.0 else float(np.abs(depth).max())


def with_stick_between_slips(states: States, shear: Array) -> States:
    """Return states of one interface with a sticking node wherever slip reverses its sign.

    It is the one of the two nodes with less shear. ``states`` is modified in place.
    """
    size = np.abs(shear)
    for i in np.flatnonzero((states[:-1] > State.STICK) & (states[1:] > State.STICK)):
        if states[i] != states[i + 1] and states[i] > State.STICK:
            states[i + int(size[i + 1] < size[i])] = State.STICK
    return states


def next_slip(
    state: ContactState, creep: Array, own: Array, friction: float, little: float
) -> States:
    """Return the states of one interface that follow from creep and shear, (n,).

    Free nodes and nodes under tension keep their states. A node also keeps its state while its
    shear is within the bound under ``little`` pressure.

    Parameters
    ----------
    state, creep, friction : of the interface; creep of its intervals, (n,) [mm].
    own : creep of each node by its own shear, (n,) [mm/MPa].
    little : pressure that counts as rounding [MPa].
    """
    kept = (state.states != State.FREE) & (state.pressure >= -little)
    sought = state.shear - creep / own
    bound = friction * np.maximum(state.pressure, 0.0)
    out = stick_and_slip(state.states, sought, bound, friction * little)
    return np.where(kept, out, state.states)
