"""The coupled active set: pressure, shear, approach and creepage in one linear system.

A semi-smooth Newton method. Every node has a state; the states make the contact conditions linear
equations for all unknowns together; the solution tells which states were wrong.
"""

from __future__ import annotations

from collections.abc import Callable
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


def solve_states(
    problem: ContactProblem, states: States, *, steps: int = 1, settled: bool = False
) -> ContactState:
    """Solve the linear system that given states make; no condition is checked.

    ``steps`` and ``settled`` are copied into the solution.

    Raises
    ------
    numpy.linalg.LinAlgError
        where the states leave the system singular.
    """
    return LinearSystem.of(problem, states).solved(problem, steps=steps, settled=settled)


@dataclass(frozen=True, slots=True)
class LinearSystem:
    """The linear system that given states make of a contact problem, factorised.

    Attributes
    ----------
    problem, states : the problem and states that make the system.
    contact, stick : numbers of the nodes in contact, and of those whose shear is unknown.
    signs : (n,) of the shear of nodes that slip.
    factors, pivots : of LAPACK's LU decomposition.
    """

    problem: ContactProblem
    states: States
    contact: Indices
    stick: Indices
    signs: Array
    factors: Array
    pivots: Indices

    @classmethod
    def of(cls, problem: ContactProblem, states: States) -> LinearSystem:
        """Factorise the system for the given states, see `solve_states`."""
        (contact,) = (states != FREE).nonzero()
        stick = (states == STICK).nonzero()[0] if problem.friction > 0.0 else contact[:0]
        signs = shear_signs(states)
        # LAPACK wants columns and the matrix is stored by rows, so its transpose is factorised in
        # place. For such small systems SciPy's wrappers would cost more than LAPACK itself.
        matrix = _matrix(problem, contact, stick, signs)
        factors, pivots, info = lapack.dgetrf(matrix.T, overwrite_a=1)
        if info != 0:
            raise np.linalg.LinAlgError("Singular matrix")
        return cls(problem, states, contact, stick, signs, factors, pivots)

    def solved(
        self, problem: ContactProblem, *, steps: int = 1, settled: bool = False
    ) -> ContactState:
        """Solve that problem, or one like it, with the factorised system.

        The clearance, the lengths and offsets of the creep and the prescribed values may differ.
        Which quantities are prescribed, the influence, weights and friction may not.
        """
        unknowns = self._unknowns(problem)
        n_c, n_s = self.contact.size, self.stick.size
        pressure = np.zeros(self.states.size)
        pressure[self.contact] = unknowns[:n_c]
        shear = problem.friction * self.signs * pressure
        shear[self.stick] = unknowns[n_c : n_c + n_s]
        # The solution meets the prescribed values to rounding; the exact values are kept.
        control = problem.control
        approach, creepage = control.approach, control.creepage
        if approach is None:
            approach = float(unknowns[-2])
        if creepage is None:
            creepage = float(unknowns[-1]) if problem.friction > 0.0 else np.nan
        return ContactState(self.states, pressure, shear, approach, creepage, steps, settled)

    def _unknowns(self, problem: ContactProblem) -> Array:
        right = _right_side(problem, self.contact, self.stick)
        if problem.creep_length is self.problem.creep_length:
            return self._divided(right)
        # The lengths are the column of the creepage, so other lengths change one column of the
        # matrix (Sherman & Morrison). The divisor is the ratio of the determinants: where it is
        # small, the other matrix has lost its digits, however it is factorised.
        change = np.zeros(right.size)
        longer = problem.creep_length - self.problem.creep_length
        change[self.contact.size : -2] = longer[self.stick]
        both = self._divided(np.stack([right, change], axis=1))
        first, more = both[:, 0], both[:, 1]
        divisor = 1.0 + float(more[-1])
        if divisor == 0.0:
            raise np.linalg.LinAlgError("Singular matrix")
        return np.asarray(first - more * (first[-1] / divisor))

    def _divided(self, right: Array) -> Array:
        solution, _ = lapack.dgetrs(self.factors, self.pivots, right, trans=1)
        return np.asarray(solution)


def _matrix(problem: ContactProblem, contact: Indices, stick: Indices, signs: Array) -> Array:
    """Return the matrix of gap in contact, creep in stick, and the two prescribed quantities."""
    n_c, size, n = contact.size, contact.size + stick.size, problem.x.size
    rows = np.concatenate([contact, n + stick])
    ratio = problem.friction * signs
    influence = problem.influence.take(rows, axis=0)
    if stick.size < n_c:  # where nodes slip the shear comes with the pressure
        influence[:, :n] += influence[:, n:] * ratio
    matrix = np.zeros((size + 2, size + 2))
    matrix[:size, :size] = influence.take(rows, axis=1)
    matrix[:n_c, -2] = -1.0
    matrix[n_c:size, -1] = problem.creep_length[stick]
    control, weights = problem.control, problem.weights[contact]
    if control.load is not None:
        matrix[-2, :n_c] = weights
    else:
        matrix[-2, -2] = 1.0
    if control.traction is not None and problem.friction > 0.0:
        matrix[-1, :n_c] = weights * ratio[contact]
        matrix[-1, n_c:size] = problem.weights[stick]
    else:
        matrix[-1, -1] = 1.0
    return matrix


def _right_side(problem: ContactProblem, contact: Indices, stick: Indices) -> Array:
    """Return the right-hand sides of the rows of `_matrix`."""
    n_c = contact.size
    right = np.empty(n_c + stick.size + 2)
    right[:n_c] = -problem.clearance[contact]
    right[n_c:-2] = -problem.creep_offset[stick]
    control = problem.control
    right[-2] = control.approach if control.load is None else control.load
    has_traction = control.traction is not None and problem.friction > 0.0
    right[-1] = control.traction if has_traction else control.creepage or 0.0
    return right


def next_states(problem: ContactProblem, solution: ContactState, rounding: float) -> States:
    """Return the states that follow from the signs of gap, pressure, creep and shear."""
    states, pressure = solution.states, solution.pressure
    depth, drift = gap_and_creep(problem, solution)
    scale = np.abs(problem.clearance).max() + abs(solution.approach)
    largest = np.abs(pressure).max()
    in_contact = states != FREE
    kept: Mask = np.where(in_contact, pressure >= -rounding * largest, depth < -rounding * scale)
    if problem.friction == 0.0:
        return np.asarray(np.where(kept, np.maximum(states, STICK), FREE), dtype=np.int8)
    out: States = kept.astype(np.int8)  # 1: STICK
    _let_slip(out, kept, problem, solution, drift, rounding * largest)
    (new,) = (kept & ~in_contact).nonzero()
    if new.size:
        out[new] = _nearest_states(states, in_contact, new)
    return out


def next_slip(problem: ContactProblem, solution: ContactState, rounding: float) -> States:
    """Return the states by creep and shear; free nodes and those under tension keep theirs."""
    states, pressure = solution.states, solution.pressure
    out = states.copy()
    if problem.friction == 0.0:
        return out
    made = problem.creep_pressure @ pressure + problem.creep_shear @ solution.shear
    drift = made + problem.creep_offset + solution.creepage * problem.creep_length
    little = rounding * float(np.abs(pressure).max())
    kept: Mask = (states != FREE) & (pressure >= -little)
    out[kept] = STICK
    _let_slip(out, kept, problem, solution, drift, little)
    return out


def _let_slip(
    out: States,
    kept: Mask,
    problem: ContactProblem,
    solution: ContactState,
    drift: Array,
    little: float,
) -> None:
    """Set the states of the nodes that slip, of those ``kept`` in contact.

    ``drift`` is the creep of each interval, ``little`` a pressure that counts as rounding.
    """
    # The shear that would bring the creep to zero if its own node were the only one to change. It
    # tells a slipping node that should stick from one that should slip the other way.
    own = np.minimum(problem.creep_shear.diagonal(), -_TINY)
    sought = solution.shear - drift / own
    bound = problem.friction * np.maximum(solution.pressure, 0.0)
    # Within rounding a node keeps its state.
    slack, states = problem.friction * little, solution.states
    plus = sought > bound + np.where(states == SLIP_PLUS, -slack, slack)
    minus = sought < -bound - np.where(states == SLIP_MINUS, -slack, slack)
    out[kept & plus] = SLIP_PLUS
    out[kept & minus] = SLIP_MINUS


def _nearest_states(states: States, in_contact: Mask, new: Indices) -> States:
    """Return the states of the nodes in contact that are nearest to some new ones.

    A node that comes into contact beside slipping ones slips with them: held in stick it would
    carry a shear out of all proportion and be thrown out again.
    """
    (touching,) = in_contact.nonzero()
    place = touching.searchsorted(new)
    before = touching[np.maximum(place - 1, 0)]
    after = touching[np.minimum(place, touching.size - 1)]
    return states[np.where(np.abs(before - new) < np.abs(after - new), before, after)]


@dataclass(frozen=True, slots=True)
class CoupledActiveSet:
    """Active-set solver of a contact problem for all unknowns at once.

    Parameters
    ----------
    max_steps :
        linear systems to solve at most.
    rounding :
        conditions violated by less than this, relative to the largest gap, pressure or creep,
        count as met.
    wanted :
        gives the states that follow from a solution: `next_states`, or `next_slip` on a contact
        set that is held. There pressure may be negative and surfaces may overlap.
    """

    max_steps: int = 40
    rounding: float = 1e-11
    wanted: Callable[[ContactProblem, ContactState, float], States] = next_states

    def solve(self, problem: ContactProblem, states: States) -> ContactState:
        """Iterate from ``states`` until they reproduce themselves, or ``max_steps``."""
        states = _ensure_solvable(problem, states)
        seen: set[bytes] = set()
        for step in range(1, self.max_steps + 1):
            solution = solve_states(problem, states)
            wanted = self.wanted(problem, solution, self.rounding)
            if wanted.tobytes() == states.tobytes():
                return replace(solution, steps=step, settled=True)
            seen.add(states.tobytes())
            if wanted.tobytes() in seen:
                wanted = _gentler(states, wanted, solution)
            states = _ensure_solvable(problem, wanted)
        return replace(solution, steps=self.max_steps)


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
    """Return a smaller change than the one that led back to states already seen.

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
