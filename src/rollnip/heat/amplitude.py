"""The size of the steady temperature rise, found from cold before its distribution is settled.

Moduli may change by powers of ten with temperature, so that the heat of a cold nip says little
about the steady state. The rise theta of the hottest place is increased from cold in steps until
the heat at that temperature no longer sustains it, A(theta) < theta; then the crossing in between
is found.
"""

from __future__ import annotations

from math import exp, log

from rollnip._errors import ConvergenceError
from rollnip.heat.figures import RISE
from rollnip.heat.state import HeatProblem, ThermalState
from rollnip.nip import Nip

HOTTEST = 400.0  # largest rise that is tried [K]; rubber is destroyed long before
_FIRST = 0.1  # first rise, over the one that the heat of the cold nip would cause
_FACTOR = 2.0  # largest step of the rise
_NEAR = 0.1  # |ln(A/theta)| from which the iteration of all temperatures can start
_MOST = 24
_COARSE = 0.5  # largest change of ln E* inside a sub-layer


class RunawayError(ConvergenceError):
    """No steady state was found: the heat sustains every rise that was tried."""


def from_cold(
    thermal: HeatProblem, cold: ThermalState, nip: Nip | None = None, *, above: float = 0.0
) -> ThermalState:
    """Return a state close to the steady one with the smallest rise.

    Parameters
    ----------
    thermal : the problem.
    cold : the nip without a temperature rise.
    nip : the cold nip, where it differs from that of the problem in speed or load.
    above : rise from which the search starts [K]. Just beyond a turning point heat and cooling are
        almost balanced at a rise where there is no steady state.

    Raises
    ------
    RunawayError
        where there is no steady state up to a rise of 400 K.
    """
    near, theta = cold, max(_FIRST * cold.hottest, above)
    low: tuple[float, float] | None = None
    high: tuple[float, float] | None = None
    for _ in range(_MOST):
        temperatures = near.base + theta * near.rise / near.hottest
        cut = thermal.divided(temperatures, near.solution, _COARSE)
        near = thermal.at(temperatures, cut, nip)
        excess = log(near.hottest / theta)
        if abs(excess) < _NEAR:
            return near
        if excess > 0.0:
            low = (log(theta), excess)
        else:
            high = (log(theta), excess)
        if high is None:
            if theta >= HOTTEST:
                raise RunawayError(
                    f"No steady state exists up to a rise of {RISE.text(HOTTEST, 3)}: at "
                    f"{RISE.text(theta, 3)} the heat still asks for {RISE.text(near.hottest, 3)}."
                )
            theta = min(near.hottest, _FACTOR * theta, HOTTEST)
        elif low is None:
            theta = max(near.hottest, theta / _FACTOR)
        else:
            theta = _between(low, high)
    return near


def _between(low: tuple[float, float], high: tuple[float, float]) -> float:
    """Return the rise at which the excess of heat changes sign, by the secant method."""
    (a, fa), (b, fb) = low, high
    share = min(max(fa / (fa - fb), 0.1), 0.9)
    return exp(a + share * (b - a))
