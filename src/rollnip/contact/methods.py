"""The solver of a contact problem that always ends: an active set, then an interior point."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from rollnip.contact.complementarity import Inequalities, interior_point
from rollnip.contact.coupled import (
    active_set,
    next_states,
    right_side,
    solve_states,
    system_matrix,
)
from rollnip.contact.problem import (
    FREE,
    MOST_ITERATIONS,
    Array,
    ContactProblem,
    ContactState,
    States,
)

# Largest problem for the interior point: it takes some twenty linear systems, which for larger
# problems last seconds.
_MOST_NODES = 160
# Relative violation of the conditions up to which the states of the interior point are accepted.
_VIOLATION = 1e-7


def solve_nodes(
    problem: ContactProblem, states: States, *, most_steps: int = MOST_ITERATIONS
) -> ContactState:
    """Return the solution from initial ``states``: by an active set, or by an interior point.

    The interior point takes over where the active set does not settle. ``settled`` tells whether
    the contact conditions hold at the nodes. ``most_steps``: of the active set.
    """
    try:
        solution = active_set(problem, states, most_steps=most_steps)
    except np.linalg.LinAlgError:
        solution = _unsolved(problem)
    if solution.settled or problem.x.size > _MOST_NODES:
        return solution
    try:
        slow = _by_interior_point(problem)
    except np.linalg.LinAlgError:
        slow = _unsolved(problem)
    is_better = slow.settled or not np.any(solution.pressure)
    return replace(slow if is_better else solution, steps=solution.steps + slow.steps)


def _by_interior_point(problem: ContactProblem) -> ContactState:
    """Return the interior-point solution, settled if its own solution implies its states."""
    found = interior_point(*inequalities_of(problem))
    states = found.touches.astype(np.int8)  # 1: STICK
    if found.states.size:
        states = np.where(found.touches, found.states, np.int8(FREE))
    solution = solve_states(problem, states)
    settled = np.array_equal(next_states(problem, solution, _VIOLATION), states)
    return replace(solution, steps=found.steps + 1, settled=settled)


def _unsolved(problem: ContactProblem) -> ContactState:
    """Return a placeholder for a failed solution: all nodes free, not settled."""
    zero = np.zeros(problem.x.size)
    states = np.full(problem.x.size, FREE, dtype=np.int8)
    return ContactState(states, zero, zero, 0.0, np.nan, steps=0, settled=False)


def inequalities_of(problem: ContactProblem) -> tuple[Inequalities, Array]:
    """Return the complementarity problem of a contact problem, and initial unknowns.

    Unknowns are the pressures, the shears if there is friction, the approach and the creepage.

    Raises
    ------
    numpy.linalg.LinAlgError
        where the surfaces are not pressed together.
    """
    n, friction, control = problem.x.size, problem.friction, problem.control
    nodes = np.arange(n)
    stick = nodes if friction > 0.0 else nodes[:0]
    matrix = system_matrix(problem, nodes, stick, np.zeros(n))
    right = -right_side(problem, nodes, stick)

    # Sizes are estimated from a uniform pressure.
    depth = float(np.abs(problem.normal_pressure).sum(axis=1).max())
    weight = float(problem.weights.sum())
    if control.load is not None:
        peak = control.load / weight
    else:
        peak = ((control.approach or 0.0) - float(problem.clearance.min())) / depth
    if not peak > 0.0:
        raise np.linalg.LinAlgError("nothing is pressed")
    made = np.abs(problem.creep_pressure) + friction * np.abs(problem.creep_shear)
    creepage = float(made.sum(axis=1).max() / problem.creep_length.max()) * peak or 1.0
    approach, load = depth * peak, weight * peak
    has_traction = control.traction is not None and stick.size > 0
    sizes, scales, start = (
        np.full(right.size, peak),
        np.full(right.size, approach),
        np.zeros(right.size),
    )
    sizes[-2:] = approach, creepage
    scales[n:-2] = creepage * problem.creep_length[stick]
    scales[-2] = load if control.load is not None else approach
    scales[-1] = friction * load if has_traction else creepage
    start[:n], start[-2] = peak, approach
    frictions = np.full(stick.size, friction)
    return Inequalities(matrix, right, nodes, n + stick, stick, frictions, sizes, scales), start
