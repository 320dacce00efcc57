"""The coupled active set: pressure, shear, approach and creepage in one linear system.

A semi-smooth Newton method. Every node has a state; the states make the contact conditions linear
equations for all unknowns together; the solution tells which states were wrong.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from rollnip.contact.problem import (
    FREE,
    SLIP_MINUS,
    SLIP_PLUS,
    STICK,
    Array,
    ContactProblem,
    ContactState,
    Indices,
    Mask,
    States,
    creep,
    gap,
    shear_signs,
)


@dataclass(frozen=True, slots=True)
class CoupledActiveSet:
    """Solve a contact problem for all unknowns at once.

    Parameters
    ----------
    max_steps :
        linear systems to solve at most.
    rounding :
        conditions violated by less than this, relative to the largest gap, pressure or creep,
        count as met.
    """

    max_steps: int = 40
    rounding: float = 1e-11

    def solve(self, problem: ContactProblem, states: States) -> ContactState:
        """Iterate from ``states`` until they reproduce themselves, or ``max_steps``."""
        states = _ensure_solvable(problem, states)
        seen: set[bytes] = set()
        for step in range(1, self.max_steps + 1):
            solution = solve_states(problem, states)
            solution = replace(solution, steps=step)
            wanted = next_states(problem, solution, self.rounding)
            if np.array_equal(wanted, states):
                return replace(solution, settled=True)
            seen.add(states.tobytes())
            if wanted.tobytes() in seen:
                wanted = _gentler(states, wanted, solution)
            states = _ensure_solvable(problem, wanted)
        return solution


def solve_states(problem: ContactProblem, states: States) -> ContactState:
    """Solve the linear system that given states make; no condition is checked.

    Raises
    ------
    numpy.linalg.LinAlgError
        where the states leave the system singular.
    """
    contact = np.flatnonzero(states != FREE)
    stick = np.flatnonzero(states == STICK) if problem.friction > 0.0 else contact[:0]
    matrix, right = _system(problem, states, contact, stick)
    unknowns = np.linalg.solve(matrix, right)
    n_c, n_s = contact.size, stick.size
    pressure = np.zeros(states.size)
    pressure[contact] = unknowns[:n_c]
    shear = problem.friction * shear_signs(states) * pressure
    shear[stick] = unknowns[n_c : n_c + n_s]
    control = problem.control
    approach, creepage = unknowns[n_c + n_s :]
    if problem.friction == 0.0 and control.creepage is None:
        creepage = np.nan
    return ContactState(states, pressure, shear, float(approach), float(creepage), 1, False)


def _system(
    problem: ContactProblem, states: States, contact: Indices, stick: Indices
) -> tuple[Array, Array]:
    """Rows: gap 0 in contact, creep 0 in stick, load or approach, traction or creepage."""
    n_c, n_s = contact.size, stick.size
    size = n_c + n_s + 2
    matrix = np.zeros((size, size))
    right = np.zeros(size)
    ratio = problem.friction * shear_signs(states)[contact]
    normal, tangential = slice(0, n_c), slice(n_c, n_c + n_s)
    in_contact, stick_contact = np.ix_(contact, contact), np.ix_(stick, contact)
    matrix[normal, normal] = (
        problem.normal_pressure[in_contact] + problem.normal_shear[in_contact] * ratio
    )
    matrix[normal, tangential] = problem.normal_shear[np.ix_(contact, stick)]
    matrix[normal, -2] = -1.0
    right[normal] = -problem.clearance[contact]
    matrix[tangential, normal] = (
        problem.creep_pressure[stick_contact] + problem.creep_shear[stick_contact] * ratio
    )
    matrix[tangential, tangential] = problem.creep_shear[np.ix_(stick, stick)]
    matrix[tangential, -1] = problem.creep_length[stick]
    right[tangential] = -problem.creep_offset[stick]
    control = problem.control
    if control.load is not None:
        matrix[-2, normal] = problem.weights[contact]
        right[-2] = control.load
    else:
        matrix[-2, -2], right[-2] = 1.0, control.approach
    if control.traction is not None and problem.friction > 0.0:
        matrix[-1, normal] = problem.weights[contact] * ratio
        matrix[-1, tangential] = problem.weights[stick]
        right[-1] = control.traction
    else:
        matrix[-1, -1], right[-1] = 1.0, control.creepage or 0.0
    return matrix, right


def next_states(problem: ContactProblem, solution: ContactState, rounding: float) -> States:
    """States that the signs of gap, pressure, creep and shear ask for."""
    states = solution.states
    out = states.copy()
    in_contact = states != FREE
    depth = gap(problem, solution)
    scale = np.max(np.abs(problem.clearance)) + abs(solution.approach)
    largest = np.max(np.abs(solution.pressure), initial=0.0)
    out[in_contact & (solution.pressure < -rounding * largest)] = FREE
    out[~in_contact & (depth < -rounding * scale)] = STICK
    if problem.friction == 0.0:
        return out
    kept = out != FREE
    bound = problem.friction * np.maximum(solution.pressure, 0.0)
    # The shear that would bring the creep to zero, were its own node the only one to change: it
    # tells a slipping node apart that should stick from one that should slip the other way.
    own = np.minimum(np.diag(problem.creep_shear), -np.finfo(float).tiny)
    sought = solution.shear - creep(problem, solution) / own
    # Within rounding a node keeps its state.
    slack = rounding * problem.friction * largest
    out[kept] = STICK
    out[kept & (sought > bound + np.where(states == SLIP_PLUS, -slack, slack))] = SLIP_PLUS
    out[kept & (sought < -bound - np.where(states == SLIP_MINUS, -slack, slack))] = SLIP_MINUS
    new = kept & ~in_contact
    if np.any(new):
        out[new] = _nearest_state(states, in_contact)[new]
    return out


def _nearest_state(states: States, in_contact: Mask) -> States:
    """State of the nearest node in contact, for each node.

    A node that comes into contact beside slipping ones slips with them: held in stick it would
    carry a shear out of all proportion and be thrown out again.
    """
    index = np.arange(states.size)
    touching = np.flatnonzero(in_contact)
    after = np.clip(np.searchsorted(touching, index), 0, touching.size - 1)
    before = np.maximum(after - 1, 0)
    nearer = np.abs(touching[before] - index) < np.abs(touching[after] - index)
    return states[np.where(nearer, touching[before], touching[after])]


def _ensure_solvable(problem: ContactProblem, states: States) -> States:
    """Keep one node in contact, and one in stick where the creepage is sought."""
    states = states.copy()
    if not np.any(states != FREE):
        states[np.argmin(problem.clearance)] = STICK
    if problem.control.traction is not None and not np.any(states == STICK):
        # Material sticks first where it comes in: the leading edge.
        states[np.flatnonzero(states != FREE)[-1]] = STICK
    return states


def _gentler(states: States, wanted: States, solution: ContactState) -> States:
    """A smaller change than the one that led back to states already seen.

    A sticking node under tension slips before it parts: beside an edge its tension may come from
    a shear that it cannot carry. Where there is none, only the first node changes.
    """
    out = states.copy()
    torn = (states == STICK) & (wanted == FREE)
    if np.any(torn):
        slip = np.where(solution.shear > 0.0, SLIP_PLUS, SLIP_MINUS)
        out[torn] = slip[torn]
        return out
    first = np.flatnonzero(states != wanted)[0]
    out[first] = wanted[first]
    return out
