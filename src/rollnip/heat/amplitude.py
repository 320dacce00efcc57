"""The size of the steady rise, found from cold before its shape is settled.

Moduli may change by powers of ten with the temperature, so the heat of a cold nip says little
about the steady state. The rise theta of the hottest place is stepped up from cold until the heat
at that temperature no longer sustains it, A(theta) < theta; then the crossing is found between.
"""

from __future__ import annotations

from math import exp, log

from rollnip._errors import ConvergenceError
from rollnip.heat.figures import RISE
from rollnip.heat.state import HeatProblem, ThermalState
from rollnip.nip import Nip

HOTTEST = 400.0  # K of rise; rubber is destroyed long before
_FIRST = 0.1  # of the rise that the cold nip would cause
_FACTOR = 2.0  # largest step of the rise
_NEAR = 0.1  # ln(A/theta) that the iteration of all temperatures begins from
_MOST = 24
_COARSE = 0.5  # change of ln E* inside a sub-layer


class RunawayError(ConvergenceError):
    """The heat sustains every rise that was tried: no steady state was found."""


def from_cold(
    thermal: HeatProblem, cold: ThermalState, nip: Nip | None = None, *, above: float = 0.0
) -> ThermalState:
    """Return a state that is near the steady one with the smallest rise.

    Parameters
    ----------
    thermal : the problem.
    cold : the nip without a rise.
    nip : the cold nip where it is another than that of the problem, in speed or load.
    above : rise from which on it is looked for [K]. Just beyond a turning point heat and cooling
        are nearly even where there is no state.

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
    """Return the rise where the excess of heat changes its sign, by the secant method."""
    (a, fa), (b, fb) = low, high
    share = min(max(fa / (fa - fb), 0.1), 0.9)
    return exp(a + share * (b - a))
