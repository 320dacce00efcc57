"""Parts of the node-by-node solution that membranes and plates have in common."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import State, States

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
