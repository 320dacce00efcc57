"""The range of a face's table: the loads and slips of its lattice, and how fine it is."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, floor, inf, log

import numpy as np

from rollnip.face.lattice import Lattice
from rollnip.face.law import NipLaw

PER_E = 1.0  # smallest number of loads in a factor e
SLIP_STEP, MOST_SLIP = 0.14, 0.91  # largest step between measures of slip; largest measure of slip
_FEWEST = 5  # smallest number of loads, and of slips, in a table


@dataclass(frozen=True, slots=True)
class Span:
    """The range of a table, and how fine its lattice is.

    Attributes
    ----------
    low, high : line loads of the nominal covering [N/mm].
    slips : smallest and largest measure of slip; None without friction.
    halved : smallest number of halvings of the steps between loads, and between slips.
    """

    low: float
    high: float
    slips: tuple[float, float] | None
    halved: tuple[int, int] = (0, 0)

    @property
    def steps(self) -> tuple[int, int]:
        """Number of halvings of each step, so that the span holds enough loads and slips."""
        loads = max(_needed(log(self.high / self.low) * PER_E), self.halved[0])
        if self.slips is None:
            return loads, 0
        return loads, max(_needed((self.slips[1] - self.slips[0]) / SLIP_STEP), self.halved[1])

    @property
    def lattice(self) -> Lattice:
        """Loads and slips, on a lattice that is common to all tables."""
        halved = self.steps
        per_e = PER_E * 2.0 ** halved[0]
        first, last = _around(per_e * log(self.low), per_e * log(self.high), inf)
        ladder = np.exp(np.arange(first, last + 1) / per_e)
        if self.slips is None:
            return Lattice(ladder, np.zeros(1), np.ones((ladder.size - 1, 1), dtype=bool))
        step = SLIP_STEP / 2.0 ** halved[1]
        low, high = self.slips
        first, last = _around(low / step, high / step, MOST_SLIP / step)
        slips = step * np.arange(first, last + 1.0)
        return Lattice(ladder, slips, np.ones((ladder.size - 1, slips.size - 1), dtype=bool))


def _needed(steps: float) -> int:
    """Return how often steps must be halved to be enough for a table."""
    return max(0, ceil(log((_FEWEST - 1) / max(steps, 0.1)) / log(2.0) - 1e-9))


def _around(low: float, high: float, most: float) -> tuple[int, int]:
    """Return the integers around an interval, at least as many as a table needs, up to +-most."""
    first, last = floor(low + 1e-6), ceil(high - 1e-6)
    while last - first < _FEWEST - 1:
        first, last = first - 1, last + 1
    if most < inf:
        limit = floor(most + 1e-6)
        first, last = max(first, -limit), min(last, limit)
        first = min(first, max(last - _FEWEST + 1, -limit))
        last = max(last, min(first + _FEWEST - 1, limit))
    return first, last


def span_of(law: NipLaw) -> Span:
    """Return the span of a table."""
    loads = round(log((law.loads.size - 1) / log(law.loads[-1] / law.loads[0]) / PER_E, 2.0))
    ends = float(law.loads[0]), float(law.loads[-1])
    if law.s.size == 1:
        return Span(*ends, None, (loads, 0))
    slips = round(log(SLIP_STEP / (law.s[1] - law.s[0]), 2.0))
    return Span(*ends, (float(law.s[0]), float(law.s[-1])), (loads, slips))
