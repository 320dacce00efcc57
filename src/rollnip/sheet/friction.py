"""Friction on the interfaces of a sheet: coefficients and the states of stick and slip."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import State, States
from rollnip.nip import Nip

Array = NDArray[np.float64]

SIGNS = np.array([0.0, 0.0, 1.0, -1.0])
"""Sign of the shear for each state of a node, in the order of `State`."""


def frictions_of(nip: Nip) -> tuple[float, float]:
    """Return the friction coefficients of the sheet on the upper and on the lower roller."""
    return nip.friction_on("upper"), nip.friction_on("lower")


def with_stick_between_slips(states: States, shear: Array) -> States:
    """Return states of one interface with a sticking node wherever slip reverses its sign.

    It is the one of the two nodes with less shear. ``states`` is modified in place.
    """
    size = np.abs(shear)
    for i in np.flatnonzero((states[:-1] > State.STICK) & (states[1:] > State.STICK)):
        if states[i] != states[i + 1] and states[i] > State.STICK:
            states[i + int(size[i + 1] < size[i])] = State.STICK
    return states
