"""Lagged terms and residuals, as far as membranes and plates have them in common."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import State, States

Array = NDArray[np.float64]


def pressed_gap(gap: Array, pressure: Array) -> float:
    """Return the largest gap under pressure, weighted by pressure over peak pressure [mm]."""
    peak = float(np.abs(pressure).max())
    return float(np.abs(gap * pressure).max()) / peak if peak > 0.0 else 0.0


def creep_in_stick(creep: Array, states: States) -> float:
    """Return the largest distance that surfaces creep within a run of sticking nodes [mm].

    ``creep``, ``states``: of the intervals, and of the nodes at which they begin.
    """
    sticks = states == State.STICK
    along = np.concatenate([[0.0], np.cumsum(np.where(sticks, creep, 0.0))])
    begins = np.flatnonzero(sticks & ~np.append(False, sticks[:-1]))
    ends = np.flatnonzero(sticks & ~np.append(sticks[1:], False)) + 1
    runs = (along[begin : end + 1] for begin, end in zip(begins, ends, strict=True))
    return max((float(np.ptp(run)) for run in runs), default=0.0)


def sheet_rate(creepage_upper: float, creepage_lower: float) -> float:
    """Return V_s/V."""
    return 1.0 + 0.5 * (creepage_lower - creepage_upper)
