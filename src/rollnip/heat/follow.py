"""The branch of steady states from cold, over speed or load.

A branch is a curve in the plane of the logarithms of the parameter and of the rise of the hottest
place. For each next point, whichever of the two changes faster along the curve is prescribed, and
the other is found (local parametrisation: Rheinboldt & Burkardt 1983, ACM Trans. Math. Softw. 9,
215-235). The branch can thus be followed through a turning point, where the parameter has an
extreme value: thermal runaway. With slightly more speed or load there is no steady state nearby.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from math import exp, hypot, isinf, log

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import ConvergenceError, InvalidInputError, RollnipError
from rollnip.figure import Figure
from rollnip.heat.amplitude import from_cold
from rollnip.heat.anderson import settle
from rollnip.heat.figures import PARAMETERS, RISE
from rollnip.heat.solution import bond_temperature, profile
from rollnip.heat.state import HeatProblem, Parameter, ThermalState

Array = NDArray[np.float64]

_ALLOWED = 0.25  # largest change of ln E* inside a sub-layer
_TOLERANCE = 1e-3  # relative tolerance of the rise
_MOST = 15  # most nips solved for one point
_STEP = 0.45  # length of a step in the plane of the logarithms
_SMALLEST = 0.03
_POINTS = 40
_REFINED = 2  # number of parabolas fitted through a turning point
_EXPONENT = {"speed": 1.0, "load": 1.5}
"""Approximate exponent of the heat as a power of the parameter, which starts the iteration."""


@dataclass(frozen=True, slots=True)
class BranchPoint:
    """One steady state of a branch.

    Attributes
    ----------
    value : of the parameter [mm/s or N/mm].
    rise : of the hottest place, over its temperature without heat [K].
    hot_spot : highest temperature of both rollers [degC].
    bond_upper, bond_lower : temperatures of the bonds [degC]; None where there is none.
    power : heat of the nip [W/m].
    stable : whether a disturbance dies out; it does where the parameter rises along the branch.
    state : the nip in this state.
    """

    value: float
    rise: float
    hot_spot: float
    bond_upper: float | None
    bond_lower: float | None
    power: float
    stable: bool
    state: ThermalState = field(repr=False)


@dataclass(frozen=True, slots=True)
class Branch:
    """Steady states from cold to hot.

    Attributes
    ----------
    parameter, unit : "speed" [mm/s] or "load" [N/mm].
    points : along the branch, from cold; beyond the turning point they are unstable states, and
        from a second turning point on hot states.
    turning : the point with the largest parameter at the first turning point, thermal runaway; None
        where none was found.
    reached : whether the wanted end of the parameter was reached without a turning point.
    status : a sentence about where the branch ends.
    solves : number of nips that were solved.
    """

    parameter: Parameter
    unit: str
    points: tuple[BranchPoint, ...]
    turning: BranchPoint | None
    reached: bool
    status: str
    solves: int

    def at(self, value: float) -> ThermalState | None:
        """Return the coolest state close to a value of the parameter; None where there is none."""
        for low, high in zip(self.points[:-1], self.points[1:], strict=True):
            if low.value <= value * (1.0 + _TOLERANCE) and high.value >= value * (1.0 - _TOLERANCE):
                near = abs(log(high.value / value)) < abs(log(low.value / value))
                return high.state if near else low.state
        return None

    def margin(self, value: float) -> float | None:
        """Return by which share the parameter may rise before runaway; None without runaway."""
        return None if self.turning is None else self.turning.value / value - 1.0


def follow(
    thermal: HeatProblem,
    parameter: Parameter,
    low: float,
    high: float,
    *,
    largest_rise: float = 200.0,
    past_turning: bool = True,
) -> Branch:
    """Follow the steady states from a low value of the parameter to a high one.

    Parameters
    ----------
    thermal : the problem.
    parameter : "speed" or "load".
    low, high : first and last value [mm/s or N/mm].
    largest_rise : rise at which the branch ends [K].
    past_turning : whether it continues beyond the first turning point.

    Raises
    ------
    InvalidInputError
        where the limits are not in order, or the parameter is unknown.
    ConvergenceError
        where not even the first state was found; start lower.
    """
    if parameter not in PARAMETERS:
        raise InvalidInputError(f'`parameter` must be "speed" or "load", got {parameter!r}.')
    if not 0.0 < low < high or isinf(high):
        raise InvalidInputError(
            f"`low` must be positive and below `high`, got {low!r} and {high!r}."
        )
    walk = _Walk(thermal, parameter)
    found = [walk.first(low)]
    step, status = _STEP, f"It was given up after {_POINTS} points."
    while len(found) < _POINTS:
        try:
            found.append(walk.next(found, step, high))
        except RollnipError as error:
            step *= 0.5
            if step < _SMALLEST:
                status = f"It ends where no further state was found: {error}"
                break
            continue
        step = min(_STEP, 1.5 * step)
        ended = _end(found, low, high, largest_rise, PARAMETERS[parameter])
        if not ended and not past_turning and found[-1].value < found[-2].value:
            ended = "It ends behind the turning point."
        if ended:
            status = ended
            break
    return walk.branch(found, high, status)


def _end(
    found: Sequence[_BranchState], low: float, high: float, largest_rise: float, over: Figure
) -> str:
    """Return why a branch ends; "" where it continues."""
    last = found[-1]
    if last.value >= high * (1.0 - 1e-9):
        turned = any(b.value < a.value for a, b in pairwise(found))
        return f"It reaches {over.text(high)}{' on hot states' if turned else ''}."
    if last.rise > largest_rise:
        return f"It ends at a rise of {RISE.text(last.rise)}."
    if last.value < low * (1.0 - 1e-9):
        return f"It returns below {over.text(low)} on states that are not stable."
    return ""


@dataclass(frozen=True, slots=True)
class _BranchState:
    """A state of the branch: parameter, rise [K], and the nip."""

    value: float
    rise: float
    state: ThermalState


class _Walk:
    """Finds the states of a branch, one after the other."""

    def __init__(self, thermal: HeatProblem, parameter: Parameter) -> None:
        self.thermal, self.parameter = thermal, parameter

    def first(self, value: float) -> _BranchState:
        """Return the steady state from cold, at a parameter close to the given one."""
        thermal = self.thermal
        nip = thermal.with_parameter(self.parameter, value)
        cold = thermal.conduction.uniform(thermal.heat.ambient)
        last = thermal.at(cold, thermal.whole(), nip)
        if last.hottest <= 0.0:
            raise InvalidInputError(
                "No heat arises where the branch begins, so there is none to follow: begin at "
                "more, or give the nip viscoelastic layers or slip."
            )
        near = from_cold(thermal, last, nip)
        return self.at_rise(_BranchState(value, near.hottest, near), near.hottest, value)

    def next(self, found: Sequence[_BranchState], step: float, high: float) -> _BranchState:
        """Return the state one step further along the branch, at most at the end ``high``."""
        last = found[-1]
        along, up = 1.0, 1.0 / _EXPONENT[self.parameter]
        if len(found) > 1:
            before = found[-2]
            along, up = log(last.value / before.value), log(last.rise / before.rise)
        length = hypot(along, up)
        along, up = along / length, up / length
        if abs(up) > abs(along):
            return self.at_rise(last, last.rise * exp(step * up), last.value * exp(step * along))
        value = min(last.value * exp(step * along), high)
        return self.at_value(last, value, last.rise * (value / last.value) ** (up / along))

    def at_value(self, near: _BranchState, value: float, guess: float) -> _BranchState:
        """Return the state at a parameter, from a nearby state and a guess of the rise [K]."""
        thermal = self.thermal
        nip = thermal.with_parameter(self.parameter, value)
        temperatures = near.state.base + guess * near.state.rise / near.state.hottest
        cut = thermal.divided(temperatures, near.state.solution, _ALLOWED)
        states = [near.state]

        def image(values: Array) -> Array:
            states.append(thermal.at(values, cut, nip))
            return states[-1].new

        done = settle(
            image,
            temperatures,
            tolerance=lambda _: _TOLERANCE * states[-1].hottest,
            most=_MOST,
        )
        if not done.converged:
            raise ConvergenceError(
                f"no state at {PARAMETERS[self.parameter].text(value)} was found"
            )
        return _BranchState(value, states[-1].hottest, states[-1])

    def at_rise(self, near: _BranchState, rise: float, guess: float) -> _BranchState:
        """Return the state with a given rise [K], from a nearby state."""
        thermal, exponent = self.thermal, _EXPONENT[self.parameter]
        shape = near.state.rise / near.state.hottest
        temperatures = near.state.base + rise * shape
        cut = thermal.divided(temperatures, near.state.solution, _ALLOWED)
        states = [near.state]

        def image(unknowns: Array) -> Array:
            value = exp(unknowns[0] / rise)
            nip = thermal.with_parameter(self.parameter, value)
            state = thermal.at(states[-1].base + unknowns[1:], cut, nip)
            states.append(state)
            new = np.empty_like(unknowns)
            new[0] = unknowns[0] - rise * log(state.hottest / rise) / exponent
            new[1:] = state.rise * rise / state.hottest
            return new

        done = settle(
            image,
            np.concatenate([[rise * log(guess)], rise * shape]),
            tolerance=lambda _: _TOLERANCE * rise,
            most=_MOST,
        )
        if not done.converged:
            raise ConvergenceError(f"no state of a rise of {RISE.text(rise)} was found")
        return _BranchState(exp(float(done.value[0]) / rise), rise, states[-1])

    def branch(self, found: list[_BranchState], high: float, status: str) -> Branch:
        """Return the branch with its turning point."""
        peak = _first_peak(found)
        turning = None
        for _ in range(0 if peak is None else _REFINED):
            assert peak is not None
            around = self._turning(found[peak - 1 : peak + 2])
            if around is None:
                break
            forward = found[peak + 1].rise - found[peak].rise
            behind = (around.rise - found[peak].rise) * forward > 0.0
            found.insert(peak + 1 if behind else peak, around)
            peak = max(range(peak - 1, peak + 3), key=lambda i: found[i].value)
        if peak is not None:
            turning = self._point(found, peak)
        points = tuple(self._point(found, i) for i in range(len(found)))
        reached = turning is None and found[-1].value >= high * (1.0 - 1e-9)
        return Branch(
            self.parameter,
            PARAMETERS[self.parameter].unit,
            points,
            turning,
            reached,
            status,
            self.thermal.solves,
        )

    def _turning(self, three: Sequence[_BranchState]) -> _BranchState | None:
        """Return the state at the top of the parabola through three states; None without one."""
        x = np.log([one.rise for one in three])
        y = np.log([one.value for one in three])
        fit = np.polyfit(x - x[1], y, 2)
        if not fit[0] < 0.0:
            return None
        top = float(np.clip(-0.5 * fit[1] / fit[0], x[0] - x[1], x[2] - x[1]))
        value = exp(float(np.polyval(fit, top)))
        try:
            return self.at_rise(three[1], exp(float(x[1]) + top), value)
        except RollnipError:
            return None

    def _point(self, found: Sequence[_BranchState], i: int) -> BranchPoint:
        one, conduction = found[i], self.thermal.conduction
        state = one.state
        before, after = found[max(i - 1, 0)], found[min(i + 1, len(found) - 1)]
        rising = after.value >= before.value
        bonds = [bond_temperature(conduction, state.new, side) for side in range(2)]
        solution = state.solution
        return BranchPoint(
            value=one.value,
            rise=one.rise,
            hot_spot=max(float(profile(conduction, state.new, s)[1].max()) for s in range(2)),
            bond_upper=bonds[0],
            bond_lower=bonds[1],
            power=(solution.dissipation_viscous or 0.0) + (solution.dissipation_friction or 0.0),
            stable=rising,
            state=state,
        )


def _first_peak(found: Sequence[_BranchState]) -> int | None:
    """Return the first inner point whose parameter is larger than that of its neighbours."""
    for i in range(1, len(found) - 1):
        if found[i].value > found[i - 1].value and found[i].value >= found[i + 1].value:
            return i
    return None
