"""The steady state of a nip and its heat: temperatures that the heat of the warm nip sustains."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import ConvergenceError, InvalidInputError, RollnipError
from rollnip.cooling import HeatBalance
from rollnip.heat.amplitude import RunawayError, from_cold
from rollnip.heat.anderson import settle
from rollnip.heat.figures import PARAMETERS, RISE, TEMPERATURE
from rollnip.heat.follow import Branch, follow
from rollnip.heat.reservations import of_whole_layers
from rollnip.heat.solution import HeatSolution
from rollnip.heat.state import HeatProblem, Parameter, ThermalState
from rollnip.heat.warm import Divided, follows
from rollnip.influence import KernelCache
from rollnip.materials import LossFactor
from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.reservation import Reservation
from rollnip.rollers import SIDES

Array = NDArray[np.float64]

COARSE = 0.25  # largest change of ln E* inside a sub-layer at first
_FINER = 0.5  # factor on it in each further round
_ROUNDS = 3
_SHARE = 0.5  # relative tolerance of the rise, over that of the model
_MOST = 20  # most nips solved in one iteration
_CHANCE = 2.0
"""Claimed error of sub-layers over the change that finer ones make.

They are whole cells and at most 24 in a layer, so that their error is not of second order for
certain: on 12 random nips temperatures were off by up to 3 times that change, at the tolerance.
"""
_PROBE = 0.03  # disturbance for the test of stability, over the rise
_TRIES = 3  # number of starts, each at a larger rise than the last
_PAST = 1.5  # ratio of the next start to the rise at which the last one did not settle
_LOW = 0.1  # first speed of the branch that is followed, over the speed of the nip


@dataclass
class _Course:
    """The progress of an iteration: its last state, its division, and its errors [K]."""

    state: ThermalState
    cut: Divided
    left: float
    fine: float = 0.0
    settled: bool = False
    why: str = ""


def solve_heat(
    nip: Nip,
    heat: HeatBalance,
    model: Model | None = None,
    *,
    cache: KernelCache | None = None,
    on_failure: Literal["raise", "return"] = "return",
) -> HeatSolution:
    """Solve a nip and the temperatures of its rollers together, in the steady state.

    Parameters
    ----------
    nip : with a speed, and with thermal properties of its materials. Their own ``temperature`` is
        not used.
    heat : where the heat goes.
    model : geometry and accuracy; ``Model()`` by default.
    cache : influence functions of earlier solves.
    on_failure : "return" a solution whose ``converged`` is False, or "raise" ConvergenceError.

    Returns
    -------
    HeatSolution. Where there is no steady state its ``status`` says so, and the temperatures are
    the last ones reached.

    Raises
    ------
    InvalidInputError
        where the speed is missing, a material has no thermal properties, or no heat can leave.
    ConvergenceError
        where ``on_failure`` is "raise" and no steady state was found.
    """
    model = Model() if model is None else model
    thermal = HeatProblem(nip, heat, model, cache)
    cold = thermal.at(thermal.conduction.uniform(heat.ambient), thermal.whole())
    course = _Course(cold, thermal.whole(), 0.0, settled=True)
    stable: bool | None = True
    if thermal.follows and cold.hottest > 0.0:
        course = _followed(thermal, cold)
        stable = is_stable(thermal, course.state, course.cut) if course.settled else None
    solution = _wrapped(thermal, cold, course, stable)
    if on_failure == "raise" and not solution.converged:
        raise ConvergenceError(solution.status, solution)
    return solution


def follow_heat(
    nip: Nip,
    heat: HeatBalance,
    model: Model | None = None,
    *,
    parameter: Parameter = "speed",
    low: float,
    high: float,
    largest_rise: float = 200.0,
    cache: KernelCache | None = None,
) -> Branch:
    """Follow the steady states from cold with rising speed or load, through thermal runaway.

    Beyond the turning point the branch continues over unstable states, back to lower values, and
    over hot states where it turns again.

    Parameters
    ----------
    nip, heat, model, cache : as for `solve_heat`.
    parameter : "speed" [mm/s] or "load" [N/mm].
    low, high : first and last value.
    largest_rise : rise at which the branch ends, too [K].

    Returns
    -------
    Branch; its ``turning`` is the point of runaway, and ``margin(value)`` the distance to it.

    Raises
    ------
    InvalidInputError
        as `solve_heat`, and where the limits are not in order.
    ConvergenceError
        where not even the first state was found.
    """
    thermal = HeatProblem(nip, heat, Model() if model is None else model, cache)
    return follow(thermal, parameter, low, high, largest_rise=largest_rise)


def _followed(thermal: HeatProblem, cold: ThermalState) -> _Course:
    """Find the steady state reached from a cold start; where there is none, say where it ends."""
    course, above = _Course(cold, thermal.whole(), np.inf), 0.0
    try:
        for _ in range(_TRIES):
            near = from_cold(thermal, cold, above=above)
            course = steady_course(thermal, near)
            if course.settled:
                break
            above = _PAST * near.hottest
    except RunawayError as error:
        course.why = f"{error} {_where_it_ends(thermal)}".strip()
    except RollnipError as error:
        course.why = _lost(error)
    return course


def _where_it_ends(thermal: HeatProblem) -> str:
    """Return a sentence about the speed of thermal runaway; "" where it was not found."""
    speed = thermal.nip.speed
    assert speed is not None
    try:
        turning = follow(thermal, "speed", _LOW * speed, speed, past_turning=False).turning
    except RollnipError:
        return ""
    if turning is None:
        return ""
    return (
        f"Followed from cold, the covering runs away at "
        f"{PARAMETERS['speed'].text(turning.value)}, where its hot spot has "
        f"{TEMPERATURE.text(turning.hot_spot)}; cool it better, or lower speed or load."
    )


def steady_course(thermal: HeatProblem, start: ThermalState) -> _Course:
    """Iterate the temperatures, starting from a state, on sub-layers that are fine enough."""
    course = _Course(start, thermal.whole(), np.inf)
    allowed = COARSE
    cut = thermal.divided(start.new, start.solution, allowed)
    for _ in range(_ROUNDS):
        if not _iterate(thermal, course, cut):
            return course
        allowed *= _FINER
        wanted = thermal.model.tolerance * course.state.hottest
        finer = thermal.divided(course.state.new, course.state.solution, allowed)
        course.fine *= _FINER**2  # the error of sub-layers is of second order
        if finer.count == cut.count or 0.0 < course.fine <= wanted:
            break
        try:
            check = thermal.at(course.state.new, finer)
        except RollnipError as error:
            course.why = _lost(error)
            return course
        course.fine = float(np.max(np.abs(check.new - course.state.new)))
        if course.fine <= wanted:
            break
        course.state, course.cut, cut = check, finer, finer
    course.settled = True
    return course


def _iterate(thermal: HeatProblem, course: _Course, cut: Divided) -> bool:
    """Iterate on given sub-layers; return whether the temperatures settled."""
    share = _SHARE * thermal.model.tolerance
    floor = float(np.min(course.state.base))

    def image(temperatures: Array) -> Array:
        course.state = thermal.at(temperatures, cut)
        return course.state.new

    try:
        found = settle(
            image,
            course.state.new,
            tolerance=lambda _: share * course.state.hottest,
            most=_MOST,
            floor=floor,
        )
    except RollnipError as error:
        course.why = _lost(error)
        return False
    course.cut, course.left = cut, found.left
    if not found.converged:
        course.why = (
            f"The temperatures did not settle: they still change by "
            f"{RISE.text(found.left, 2)} after "
            f"{thermal.solves} nips."
        )
    return found.converged


def _lost(error: RollnipError) -> str:
    return f"The nip could not be solved on the way: {error}"


def is_stable(thermal: HeatProblem, state: ThermalState, cut: Divided) -> bool:
    """Return whether a small rise of all temperatures dies out, that is, leads to a smaller one."""
    rise = state.rise
    try:
        pushed = thermal.at(state.new + _PROBE * rise, cut)
    except InvalidInputError:
        return False
    answer = float(rise @ (pushed.new - state.new)) / float(rise @ rise)
    return answer < _PROBE


def _wrapped(
    thermal: HeatProblem, cold: ThermalState, course: _Course, stable: bool | None
) -> HeatSolution:
    model, warm = thermal.model, course.state.solution
    said = of_whole_layers(warm.reservations, cold.solution.reservations, course.cut)
    state = replace(course.state, solution=replace(warm, reservations=said))
    error = claimed = max(course.left, course.fine)
    converged, status = False, course.why
    if course.settled:
        met = error <= 2.0 * model.tolerance * max(state.hottest, 0.0)
        claimed = _claimed(course, state)
        converged = state.solution.converged and met
        if not met:
            status = f"The sub-layers leave {RISE.text(error, 2)} open, more than the tolerance."
        elif not state.solution.converged:
            status = f"The warm nip: {state.solution.status}"
        else:
            known = RISE.text(max(claimed, 1e-9), 1)
            nips = "1 nip" if thermal.solves == 1 else f"{thermal.solves} nips"
            status = f"Steady: temperatures to {known}, {nips}."
        if stable is False:
            status += " This state is not stable: a disturbance grows."
    return HeatSolution(
        nip=thermal.nip,
        heat=thermal.heat,
        model=model,
        converged=converged,
        status=status,
        reservations=(*_reservations(thermal), *said),
        error={"temperature": float(claimed)},
        cold=cold.solution,
        stable=stable,
        solves=thermal.solves,
        sublayers=course.cut.count,
        state=state,
        conduction=thermal.conduction,
    )


def _claimed(course: _Course, state: ThermalState) -> float:
    """Return the error of the temperatures that is claimed [K].

    It is what the iteration leaves, twice what finer sub-layers change, and what the errors of the
    losses make of the rise.
    """
    warm = state.solution
    lost = (warm.dissipation_viscous or 0.0) + (warm.dissipation_friction or 0.0)
    wrong = sum(warm.error.get(f"dissipation_{one}") or 0.0 for one in ("viscous", "friction"))
    share = wrong / lost if lost > 0.0 else 0.0
    return course.left + _CHANCE * course.fine + share * max(state.hottest, 0.0)


def _reservations(thermal: HeatProblem) -> Iterator[Reservation]:
    for side in SIDES:
        roller = getattr(thermal.nip, side)
        for number, material in enumerate(roller.materials, start=1):
            if not material.is_elastic and not follows(material):
                yield Reservation(
                    "no_shift",
                    "{where} has no shift: its moduli do not follow the temperature.",
                    side=side,
                    material=number,
                )
            elif isinstance(material, LossFactor):
                yield Reservation(
                    "loss_factor_stays",
                    "{where} has a loss factor, which does not follow the temperature.",
                    side=side,
                    material=number,
                )
            elif follows(material) and number > len(roller.layers):
                yield Reservation(
                    "core_mean",
                    "The core of the {side} roller has the moduli of its mean temperature; put a "
                    "layer of the same material on it to see the temperature vary.",
                    side=side,
                )
