"""NORM, TANG and their alternation (Kalker 1990, section 4.3).

NORM solves the normal problem for a given shear, TANG the tangential one for a given pressure. Both
are active-set loops in two nested levels (Kalker 1990, section 4.3): the inner one drops
what violates an inequality until nothing does, the outer one takes in what the signs of gap and
slip ask for. On a positive definite problem no set comes twice; where one does all the same,
the loop goes on one node at a time (NORM) or along the creepage (TANG).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from rollnip.contact import (
    ContactProblem,
    ContactState,
    Control,
    State,
    States,
    solve_nodes,
)
from rollnip.contact.coupled import solve_states
from rollnip.contact.problem import Array, Mask, shear_signs

_ROUNDING = 1e-11


def with_shear(problem: ContactProblem, shear: Array) -> ContactProblem:
    """The normal problem: frictionless, the gap that a given shear opens added to the clearance."""
    return replace(
        problem,
        clearance=problem.clearance + problem.normal_shear @ shear,
        friction=0.0,
        control=replace(problem.control, traction=0.0, creepage=None),
    )


def with_pressure(problem: ContactProblem, pressure: Array) -> ContactProblem:
    """The tangential problem: a pressure that is given whatever the shear.

    With the unit matrix in place of the normal compliance, -p as clearance and no approach, a gap
    of zero says that the pressure is the given one.
    """
    control = problem.control
    return replace(
        problem,
        clearance=-pressure,
        influence=np.block(
            [
                [np.eye(pressure.size), np.zeros((pressure.size, pressure.size))],
                [problem.creep_pressure, problem.creep_shear],
            ]
        ),
        control=Control(None, 0.0, control.traction, control.creepage),
    )


@dataclass(frozen=True, slots=True)
class Norm:
    """NORM: contact set and pressure for a given shear.

    Parameters
    ----------
    max_steps :
        linear systems to solve at most, per node.
    """

    max_steps: int = 10

    def solve(self, problem: ContactProblem, states: States, shear: Array) -> ContactState:
        """Pressure and approach (or load) with the shear held; ``states`` is where to begin."""
        normal = with_shear(problem, shear)
        states = np.minimum(states, State.STICK)
        if not np.any(states):
            states[np.argmin(normal.clearance)] = State.STICK
        seen: set[bytes] = set()
        single = False
        for step in range(1, self.max_steps * states.size + 1):
            solution = replace(solve_states(normal, states), steps=step)
            wrong = _tension(solution)
            if not np.any(wrong):
                wrong = _overlap(normal, solution)
            if not np.any(wrong):
                return replace(solution, shear=shear, creepage=np.nan)
            single = single or states.tobytes() in seen
            seen.add(states.tobytes())
            if single:  # Murty's least-index rule: finite for a P-matrix
                wrong = np.arange(wrong.size) == np.flatnonzero(wrong)[0]
            states = np.where(wrong, State.STICK - states, states).astype(np.int8)
        return replace(solution, shear=shear, settled=False)


@dataclass(frozen=True, slots=True)
class Tang:
    """TANG: stick, slip, shear and creepage (or traction) for a given pressure.

    Parameters
    ----------
    max_steps :
        linear systems to solve at most before all states are sought at once instead.
    """

    max_steps: int = 40

    def solve(self, problem: ContactProblem, states: States, pressure: Array) -> ContactState:
        """Shear with the pressure held; ``states`` is where to begin."""
        tangential = with_pressure(problem, pressure)
        states = np.where(pressure > 0.0, np.maximum(states, State.STICK), State.FREE)
        states = states.astype(np.int8)
        start = states
        for step in range(1, self.max_steps + 1):
            if not np.any(states == State.STICK):
                break
            solution = replace(solve_states(tangential, states), steps=step)
            wanted = _over_bound(tangential, solution)
            if np.array_equal(wanted, states):
                wanted = _wrong_way(tangential, solution)
            if np.array_equal(wanted, states):
                return replace(solution, pressure=pressure)

            states = wanted
        at_once = solve_nodes(tangential, start)
        return replace(at_once, pressure=pressure)


@dataclass(frozen=True, slots=True)
class Alternation:
    """The paper's process: NORM and TANG in turn until neither changes the other.

    Parameters
    ----------
    tolerance :
        largest change of shear in one turn, relative to the largest traction bound.
    max_turns :
        turns at most.
    """

    tolerance: float = 1e-9
    max_turns: int = 200

    def solve(self, problem: ContactProblem, states: States) -> ContactState:
        """Alternate from zero shear; ``settled`` is False where it does not converge."""
        shear = np.zeros(states.size)
        tangential = states
        steps = 0
        for _ in range(self.max_turns):
            normal = Norm().solve(problem, states, shear)
            steps += normal.steps
            states = normal.states
            if problem.friction == 0.0:
                return normal
            turn = Tang().solve(problem, tangential, np.maximum(normal.pressure, 0.0))
            steps += turn.steps
            change = float(np.max(np.abs(turn.shear - shear)))
            shear, tangential = turn.shear, turn.states
            if change <= self.tolerance * problem.friction * float(np.max(normal.pressure)):
                break
        else:
            turn = replace(turn, settled=False)
        touching = np.where(states == State.FREE, State.FREE, tangential).astype(np.int8)
        return replace(
            turn,
            states=touching,
            approach=normal.approach,
            steps=steps,
            settled=turn.settled and normal.settled,
        )


def _tension(solution: ContactState) -> Mask:
    """Nodes in contact under tension."""
    return np.asarray(solution.pressure < -_ROUNDING * np.max(solution.pressure))


def _overlap(problem: ContactProblem, solution: ContactState) -> Mask:
    """Free nodes that overlap."""
    scale = np.max(np.abs(problem.clearance)) + abs(solution.approach)
    free = solution.states == State.FREE
    return np.asarray(free & (problem.gap_and_creep(solution)[0] < -_ROUNDING * scale))


def _over_bound(problem: ContactProblem, solution: ContactState) -> States:
    """Let sticking nodes slip where the shear exceeds the traction bound."""
    out = solution.states.copy()
    bound = problem.friction * solution.pressure * (1.0 + _ROUNDING)
    stick = out == State.STICK
    out[stick & (solution.shear > bound)] = State.SLIP_PLUS
    out[stick & (solution.shear < -bound)] = State.SLIP_MINUS
    return out


def _wrong_way(problem: ContactProblem, solution: ContactState) -> States:
    """Let slipping nodes stick where the slip would go with the shear that resists it."""
    out = solution.states.copy()
    rate = problem.gap_and_creep(solution)[1] * shear_signs(out)
    floor = -_ROUNDING * np.max(np.abs(problem.creep_length)) * max(abs(solution.creepage), 1e-6)
    out[(shear_signs(out) != 0.0) & (rate < floor)] = State.STICK
    return out
