"""The solver of a whole contact problem: the coupled active set and the slower ways behind it."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from rollnip.contact.coupled import CoupledActiveSet, next_states, solve_states
from rollnip.contact.path import CreepagePath
from rollnip.contact.problem import ContactProblem, ContactState, State, States, unsolved

_MOST_STEPS_PER_NODE = 10  # linear systems at most, where one node changes at a time


@dataclass(frozen=True, slots=True)
class Safeguarded:
    """The coupled active set; where it cycles, a slower way that does not (the default).

    With friction that is path following in the creepage, without it one node at a time by Murty's
    rule, which ends on the matrices of elastic contact.

    Parameters
    ----------
    fast :
        the coupled active set and its limit of steps.
    rounding :
        violations smaller than this, relative, count as met in the slower way's result.
    """

    fast: CoupledActiveSet = field(default_factory=CoupledActiveSet)
    rounding: float = 1e-7

    def solve(self, problem: ContactProblem, states: States) -> ContactState:
        """Solve from ``states``; ``settled`` says whether the conditions hold at the nodes."""
        try:
            solution = self.fast.solve(problem, states)
        except np.linalg.LinAlgError:
            solution = unsolved(problem)
        if solution.settled:
            return solution
        try:
            slow = self._slow(problem, states)
        except np.linalg.LinAlgError:
            slow = unsolved(problem)
        if not slow.settled and np.any(solution.pressure):
            slow = solution
        return replace(slow, steps=solution.steps + slow.steps)

    def _slow(self, problem: ContactProblem, states: States) -> ContactState:
        """Solve one node at a time, or along the creepage, and check the result afterwards."""
        if problem.friction == 0.0:
            return self._one_at_a_time(problem, states)
        slow = CreepagePath().solve(problem, states)
        if not slow.settled:
            return slow
        consistent = np.array_equal(next_states(problem, slow, self.rounding), slow.states)
        return replace(slow, settled=consistent)

    def _one_at_a_time(self, problem: ContactProblem, states: States) -> ContactState:
        """Solve without friction, changing only the first wrong node in each step (Murty 1974)."""
        states = np.minimum(states, State.STICK)
        if not np.any(states):
            states[np.argmin(problem.clearance)] = State.STICK
        for step in range(1, _MOST_STEPS_PER_NODE * states.size + 1):
            solution = solve_states(problem, states, steps=step)
            wrong = np.flatnonzero(next_states(problem, solution, self.fast.rounding) != states)
            if wrong.size == 0:
                return replace(solution, settled=True)
            states = states.copy()
            states[wrong[0]] = State.STICK - states[wrong[0]]
        return solution
