"""Path following in the creepage: slow, and does not cycle.

With the states of all nodes given, every unknown is an affine function of the creepage xi. From
full sliding (all nodes slip one way, |xi| large) the creepage is moved towards the wanted
traction; where the first condition is about to fail, the one node it belongs to changes its state,
and the path goes on. Each piece is visited once, so the walk ends: this is the principle of
Lemke's method for linear complementarity problems.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from rollnip.contact.coupled import CoupledActiveSet, solve_states
from rollnip.contact.problem import (
    Array,
    ContactProblem,
    ContactState,
    State,
    States,
    creep,
    gap,
    shear_signs,
    unsolved,
)


@dataclass(frozen=True, slots=True)
class CreepagePath:
    """Solver of a contact problem with friction that follows the creepage from full sliding.

    Parameters
    ----------
    most_events :
        changes of state at most, per node.
    most_nodes :
        larger problems are declined: four systems an event and an event a node take minutes.
    """

    most_events: int = 5
    most_nodes: int = 160

    def solve(self, problem: ContactProblem, states: States) -> ContactState:
        """Follow the path; ``states`` only says where contact may begin."""
        wanted = problem.control
        if problem.x.size > self.most_nodes:
            return unsolved(problem)
        sign = _side(problem)
        start = _sliding(problem, states, sign)
        if not start.settled or _beyond_sliding(problem, start, sign):
            return replace(start, settled=False)
        if _within_sliding(problem, start, sign):
            return solve_states(problem, start.states, steps=start.steps + 1, settled=True)
        creepage, heading = start.creepage, -sign
        current = start.states
        for step in range(1, self.most_events * problem.x.size + 1):
            here, ahead = _pair(problem, current, creepage, heading)
            length = _distance_to_goal(problem, here, ahead)
            event, node = _next_event(problem, here, ahead)
            if length is not None and length <= event:
                goal = creepage + heading * length * _unit(problem)
                at = replace(problem, control=replace(wanted, traction=None, creepage=goal))
                found = solve_states(at, current, steps=start.steps + 4 * step)
                return replace(found, settled=True)
            if not np.isfinite(event):
                break
            creepage += heading * event * _unit(problem)
            current = _changed(problem, current, here, ahead, event, node)
            if _turns(problem, current, creepage, heading, node):
                heading = -heading
        return replace(here, steps=start.steps + 4 * step, settled=False)


def _unit(problem: ContactProblem) -> float:
    """Return a step of creepage: about the strain that full sliding makes."""
    largest = np.abs(problem.creep_shear).sum(axis=1) * problem.friction
    weight = np.sum(problem.weights)
    load = problem.control.load
    pressure = (load if load is not None else 1.0) / weight
    strain = float(np.max(largest) * pressure / np.max(problem.creep_length))
    return max(strain, 1e-12)


def _side(problem: ContactProblem) -> int:
    """Return the sign of the sliding that is nearer to the prescribed traction or creepage."""
    control = problem.control
    value = control.creepage if control.traction is None else control.traction
    return -1 if value is not None and value < 0.0 else 1


def _sliding(problem: ContactProblem, states: States, sign: int) -> ContactState:
    """Return full sliding, just beyond the creepage at which the first node would stick."""
    slip = State.SLIP_PLUS if sign > 0 else State.SLIP_MINUS
    slipping = np.where(states != State.FREE, slip, State.FREE).astype(np.int8)
    offset = np.abs(problem.creep_offset / problem.creep_length).max()
    far = sign * (1e3 * _unit(problem) + 10.0 * offset + 10.0)
    control = replace(problem.control, traction=None, creepage=far)
    sliding = CoupledActiveSet().solve(replace(problem, control=control), slipping)
    # Sliding tractions do not depend on the creepage: return as far as full sliding lasts.
    touching = sliding.states != State.FREE
    rates = (sign * creep(problem, sliding) / problem.creep_length)[touching]
    nearest = far - sign * (float(rates.min()) - _unit(problem))
    return replace(sliding, creepage=nearest)


def _beyond_sliding(problem: ContactProblem, sliding: ContactState, sign: int) -> bool:
    """Return whether at least the traction of full sliding is prescribed."""
    wanted = problem.control.traction
    return wanted is not None and sign * (wanted - float(problem.weights @ sliding.shear)) >= 0.0


def _within_sliding(problem: ContactProblem, sliding: ContactState, sign: int) -> bool:
    """Return whether a creepage is prescribed at which all nodes slide."""
    wanted = problem.control.creepage
    return wanted is not None and sign * (wanted - sliding.creepage) >= 0.0


def _pair(
    problem: ContactProblem, states: States, creepage: float, heading: int
) -> tuple[ContactState, ContactState]:
    """Return the solutions at this creepage and one unit ahead, with the states kept."""
    pair = []
    for value in (creepage, creepage + heading * _unit(problem)):
        control = replace(problem.control, traction=None, creepage=value)
        pair.append(solve_states(replace(problem, control=control), states))
    return pair[0], pair[1]


def _margins(problem: ContactProblem, solution: ContactState) -> tuple[Array, Array]:
    """Return two margins (n,) of the nodes that are positive while the states are right.

    A free node has its gap (and inf), a sticking node mu p - q and mu p + q (their sum keeps the
    pressure positive), a slipping node its pressure and its creep in the sense of its shear.
    """
    states = solution.states
    bound = problem.friction * solution.pressure
    signs = shear_signs(states)
    first = np.where(states == State.STICK, bound - solution.shear, solution.pressure)
    first = np.where(states == State.FREE, gap(problem, solution), first)
    second = np.where(
        states == State.STICK, bound + solution.shear, signs * creep(problem, solution)
    )
    second = np.where(states == State.FREE, np.inf, second)
    return first, second


def _next_event(
    problem: ContactProblem, here: ContactState, ahead: ContactState
) -> tuple[float, tuple[int, int]]:
    """Return the distance in units to the first margin that vanishes, and its (row, node)."""
    now, then = np.stack(_margins(problem, here)), np.stack(_margins(problem, ahead))
    with np.errstate(invalid="ignore"):
        falling = now - then
        falling = np.where(np.isfinite(falling), falling, 0.0)
    scale = np.max(np.where(np.isfinite(now), np.abs(now), 0.0), axis=1, keepdims=True)
    moving = falling > 1e-13 * scale
    distance = np.full(now.shape, np.inf)
    distance[moving] = np.maximum(now[moving], 0.0) / falling[moving]
    row, node = np.unravel_index(int(np.argmin(distance)), distance.shape)
    return float(distance[row, node]), (int(row), int(node))


def _changed(
    problem: ContactProblem,
    states: States,
    here: ContactState,
    ahead: ContactState,
    event: float,
    place: tuple[int, int],
) -> States:
    """Return the states after the margin at ``place`` has vanished."""
    row, node = place
    out = states.copy()
    if states[node] == State.FREE:
        rate = (1.0 - event) * creep(problem, here) + event * creep(problem, ahead)
        out[node] = State.SLIP_PLUS if rate[node] >= 0.0 else State.SLIP_MINUS
    elif states[node] == State.STICK:
        out[node] = State.SLIP_PLUS if row == 0 else State.SLIP_MINUS
    else:
        out[node] = State.FREE if row == 0 else State.STICK
    return out


def _turns(
    problem: ContactProblem, states: States, creepage: float, heading: int, place: tuple[int, int]
) -> bool:
    """Return whether the node that changed would at once violate its new condition.

    The path then turns round.
    """
    here, ahead = _pair(problem, states, creepage, heading)
    now, then = np.stack(_margins(problem, here)), np.stack(_margins(problem, ahead))
    node = place[1]
    nearest = int(np.argmin(np.abs(now[:, node])))
    return bool(then[nearest, node] < now[nearest, node])


def _distance_to_goal(
    problem: ContactProblem, here: ContactState, ahead: ContactState
) -> float | None:
    """Return the units left to the prescribed traction or creepage; None where it is behind."""
    control = problem.control
    if control.traction is not None:
        now = float(problem.weights @ here.shear)
        then = float(problem.weights @ ahead.shear)
        goal = control.traction
    else:
        now, then, goal = here.creepage, ahead.creepage, control.creepage or 0.0
    if now == then:
        return None
    distance = float((goal - now) / (then - now))
    # A goal exactly at an event may lie behind it by rounding.
    return max(distance, 0.0) if distance >= -1e-9 else None
