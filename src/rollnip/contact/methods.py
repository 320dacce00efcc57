"""Ways to solve a whole contact problem: the paper's alternation, and the default."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from rollnip.contact.coupled import CoupledActiveSet, next_states
from rollnip.contact.given import Norm, Tang
from rollnip.contact.path import CreepagePath
from rollnip.contact.problem import ContactProblem, ContactState, State, States


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
            solution = None
        if solution is not None and solution.settled:
            return solution
        spent = self.fast.max_steps if solution is None else solution.steps
        if problem.friction == 0.0:
            slow = Norm().solve(problem, states, np.zeros(states.size))
            creepage = np.nan if problem.control.creepage is None else problem.control.creepage
            return replace(slow, creepage=creepage, steps=spent + slow.steps)
        slow = CreepagePath().solve(problem, states)
        consistent = np.array_equal(next_states(problem, slow, self.rounding), slow.states)
        settled = slow.settled and consistent
        return replace(slow, settled=settled, steps=spent + slow.steps)


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
