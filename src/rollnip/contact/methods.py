"""Ways to solve a whole contact problem: the paper's alternation, and the default."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from rollnip.contact.coupled import CoupledActiveSet, next_states
from rollnip.contact.given import Norm, Tang
from rollnip.contact.path import CreepagePath
from rollnip.contact.problem import ContactProblem, ContactState, State, States, unsolved


@dataclass(frozen=True, slots=True)
class Safeguarded:
    """The coupled active set; where it cycles, a slower way that does not (the default).

    With friction that is path following in the creepage, without it NORM, which goes on one node
    at a time where a contact set comes twice.

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
        """NORM without friction, path following with it; its result is examined once more."""
        if problem.friction == 0.0:
            normal = Norm().solve(problem, states, np.zeros(states.size))
            creepage = problem.control.creepage
            return replace(normal, creepage=np.nan if creepage is None else creepage)
        slow = CreepagePath().solve(problem, states)
        if not slow.settled:
            return slow
        consistent = np.array_equal(next_states(problem, slow, self.rounding), slow.states)
        return replace(slow, settled=consistent)


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
        """Alternate from zero shear; ``settled`` is False where the turns do not converge."""
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
