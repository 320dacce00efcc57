"""The coupled active set: pressure, shear, approach and creepage in one linear system.

A semi-smooth Newton method. Every node has a state; the states make the contact conditions linear
equations for all unknowns together; the solution tells which states were wrong.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import lapack

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
    gap_and_creep,
    shear_signs,
)

_TINY = np.finfo(float).tiny


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
            wanted = next_states(problem, solution, self.rounding)
            if wanted.tobytes() == states.tobytes():
                return replace(solution, steps=step, settled=True)
            seen.add(states.tobytes())
            if wanted.tobytes() in seen:
                wanted = _gentler(states, wanted, solution)
            states = _ensure_solvable(problem, wanted)
        return replace(solution, steps=self.max_steps)


def solve_states(
    problem: ContactProblem, states: States, *, steps: int = 1, settled: bool = False
) -> ContactState:
    """Solve the linear system that given states make; no condition is checked.

    ``steps`` and ``settled`` are what the solution shall say of itself.

    Raises
    ------
    numpy.linalg.LinAlgError
        where the states leave the system singular.
    """
    (contact,) = (states != FREE).nonzero()
    stick = (states == STICK).nonzero()[0] if problem.friction > 0.0 else contact[:0]
    signs = shear_signs(states)
    unknowns = _solved(*_system(problem, contact, stick, signs))
    n_c, n_s = contact.size, stick.size
    pressure = np.zeros(states.size)
    pressure[contact] = unknowns[:n_c]
    shear = problem.friction * signs * pressure
    shear[stick] = unknowns[n_c : n_c + n_s]
    # What is prescribed comes back to rounding; it is taken as it was given.
    control = problem.control
    approach, creepage = control.approach, control.creepage
    if approach is None:
        approach = float(unknowns[-2])
    if creepage is None:
        creepage = float(unknowns[-1]) if problem.friction > 0.0 else np.nan
    return ContactState(states, pressure, shear, approach, creepage, steps, settled)


def _solved(matrix: Array, right: Array) -> Array:
    """Solution of a linear system; overwrites the matrix.

    LAPACK wants columns and the matrix lies in rows: the transposed one is factorised where it
    lies. For such small systems the ways around LAPACK would cost more than LAPACK.
    """
    factors, pivots, info = lapack.dgetrf(matrix.T, overwrite_a=1)
    if info != 0:
        raise np.linalg.LinAlgError("Singular matrix")
    solution, _ = lapack.dgetrs(factors, pivots, right, trans=1)
    return np.asarray(solution)


def _system(
    problem: ContactProblem, contact: Indices, stick: Indices, signs: Array
) -> tuple[Array, Array]:
    """Rows: gap 0 in contact, creep 0 in stick, load or approach, traction or creepage."""
    n_c, size, n = contact.size, contact.size + stick.size, problem.x.size
    rows = np.concatenate([contact, n + stick])
    ratio = problem.friction * signs
    influence = problem.influence.take(rows, axis=0)
    if stick.size < n_c:  # where nodes slip the shear comes with the pressure
        influence[:, :n] += influence[:, n:] * ratio
    matrix, right = np.zeros((size + 2, size + 2)), np.zeros(size + 2)
    matrix[:size, :size] = influence.take(rows, axis=1)
    matrix[:n_c, -2] = -1.0
    right[:n_c] = -problem.clearance[contact]
    matrix[n_c:size, -1] = problem.creep_length[stick]
    right[n_c:size] = -problem.creep_offset[stick]
    control, weights = problem.control, problem.weights[contact]
    if control.load is not None:
        matrix[-2, :n_c] = weights
        right[-2] = control.load
    else:
        matrix[-2, -2], right[-2] = 1.0, control.approach
    if control.traction is not None and problem.friction > 0.0:
        matrix[-1, :n_c] = weights * ratio[contact]
        matrix[-1, n_c:size] = problem.weights[stick]
        right[-1] = control.traction
    else:
        matrix[-1, -1], right[-1] = 1.0, control.creepage or 0.0
    return matrix, right


def next_states(problem: ContactProblem, solution: ContactState, rounding: float) -> States:
    """States that the signs of gap, pressure, creep and shear ask for."""
    states, pressure = solution.states, solution.pressure
    depth, drift = gap_and_creep(problem, solution)
    scale = np.abs(problem.clearance).max() + abs(solution.approach)
    largest = np.abs(pressure).max()
    in_contact = states != FREE
    kept: Mask = np.where(in_contact, pressure >= -rounding * largest, depth < -rounding * scale)
    if problem.friction == 0.0:
        return np.asarray(np.where(kept, np.maximum(states, STICK), FREE), dtype=np.int8)
    # The shear that would bring the creep to zero, were its own node the only one to change: it
    # tells a slipping node apart that should stick from one that should slip the other way.
    own = np.minimum(problem.creep_shear.diagonal(), -_TINY)
    sought = solution.shear - drift / own
    bound = problem.friction * np.maximum(pressure, 0.0)
    # Within rounding a node keeps its state.
    slack = rounding * problem.friction * largest
    plus = sought > bound + np.where(states == SLIP_PLUS, -slack, slack)
    minus = sought < -bound - np.where(states == SLIP_MINUS, -slack, slack)
    out: States = kept.astype(np.int8)  # 1: STICK
    out[kept & plus] = SLIP_PLUS
    out[kept & minus] = SLIP_MINUS
    (new,) = (kept & ~in_contact).nonzero()
    if new.size:
        out[new] = _nearest_states(states, in_contact, new)
    return out


def _nearest_states(states: States, in_contact: Mask, new: Indices) -> States:
    """States of the nodes in contact that are nearest to some new ones.

    A node that comes into contact beside slipping ones slips with them: held in stick it would
    carry a shear out of all proportion and be thrown out again.
    """
    (touching,) = in_contact.nonzero()
    place = touching.searchsorted(new)
    before = touching[np.maximum(place - 1, 0)]
    after = touching[np.minimum(place, touching.size - 1)]
    return states[np.where(np.abs(before - new) < np.abs(after - new), before, after)]


def _ensure_solvable(problem: ContactProblem, states: States) -> States:
    """Keep one node in contact, and one in stick where the creepage is sought."""
    states = states.copy()
    if not states.any():
        states[np.argmin(problem.clearance)] = STICK
    if problem.control.traction is not None and not (states == STICK).any():
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
    if torn.any():
        slip = np.where(solution.shear > 0.0, SLIP_PLUS, SLIP_MINUS)
        out[torn] = slip[torn]
        return out
    first = np.flatnonzero(states != wanted)[0]
    out[first] = wanted[first]
    return out
