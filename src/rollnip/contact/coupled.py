"""The coupled active set: pressure, shear, approach and creepage in one linear system.

This is a semi-smooth Newton method. Given the state of every node, the contact conditions are
linear equations for all unknowns together; the signs of their solution show which states are wrong.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.linalg import lapack

from rollnip.contact.problem import (
    FREE,
    MOST_ITERATIONS,
    SLIP_MINUS,
    SLIP_PLUS,
    STICK,
    Array,
    ContactProblem,
    ContactState,
    Indices,
    Mask,
    States,
    shear_signs,
)

_TINY = np.finfo(float).tiny
# Conditions violated by less than this, relative to the largest gap, pressure or creep, count as
# met: it is above what linear systems leave.
_ROUNDING = 1e-11


def solve_states(problem: ContactProblem, states: States) -> ContactState:
    """Return the solution with given states, as settled; no inequality is checked.

    Raises
    ------
    numpy.linalg.LinAlgError
        where the system for these states is singular.
    """
    (contact,) = (states != FREE).nonzero()
    stick = (states == STICK).nonzero()[0] if problem.friction > 0.0 else contact[:0]
    signs, n_c, n_s = shear_signs(states), contact.size, stick.size
    # LAPACK is column-major and the matrix row-major, so the transpose is factorised in place.
    # For such small systems SciPy's wrappers would cost more than LAPACK itself.
    matrix = system_matrix(problem, contact, stick, signs)
    factors, pivots, info = lapack.dgetrf(matrix.T, overwrite_a=1)
    if info != 0:
        raise np.linalg.LinAlgError("Singular matrix")
    unknowns, _ = lapack.dgetrs(factors, pivots, right_side(problem, contact, stick), trans=1)
    pressure = np.zeros(states.size)
    pressure[contact] = unknowns[:n_c]
    shear = problem.friction * signs * pressure
    shear[stick] = unknowns[n_c : n_c + n_s]
    # The system meets the prescribed values only to rounding; the exact ones are kept.
    control = problem.control
    approach, creepage = control.approach, control.creepage
    if approach is None:
        approach = float(unknowns[-2])
    if creepage is None:
        creepage = float(unknowns[-1]) + 0.0 if problem.friction > 0.0 else np.nan  # not -0
    return ContactState(states, pressure, shear, approach, creepage, steps=1, settled=True)


def system_matrix(problem: ContactProblem, contact: Indices, stick: Indices, signs: Array) -> Array:
    """Return the matrix: gaps in contact, creeps in stick, then the two prescribed quantities."""
    n_c, size, n = contact.size, contact.size + stick.size, problem.x.size
    rows = np.concatenate([contact, n + stick])
    ratio = problem.friction * signs
    influence = problem.influence.take(rows, axis=0)
    if stick.size < n_c:  # at slipping nodes the shear follows from the pressure
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


def right_side(problem: ContactProblem, contact: Indices, stick: Indices) -> Array:
    """Return the right-hand sides of the rows of `system_matrix`."""
    n_c = contact.size
    right = np.empty(n_c + stick.size + 2)
    right[:n_c] = -problem.clearance[contact]
    right[n_c:-2] = -problem.creep_offset[stick]
    control = problem.control
    right[-2] = control.approach if control.load is None else control.load
    has_traction = control.traction is not None and problem.friction > 0.0
    right[-1] = control.traction if has_traction else control.creepage or 0.0
    return right


def next_states(
    problem: ContactProblem,
    solution: ContactState,
    rounding: float,
    *,
    holds_contact: bool = False,
) -> States:
    """Return the states implied by a solution: by the signs of gap, pressure, creep and shear.

    Violations up to ``rounding``, relative to the scale of each condition, change no state.
    ``holds_contact``: whether only stick and slip may change; then free nodes and nodes under
    tension keep their states.
    """
    states, pressure = solution.states, solution.pressure
    gap, creep = problem.gap_and_creep(solution)
    in_contact, little = states != FREE, rounding * np.abs(pressure).max()
    kept: Mask = pressure >= -little
    if holds_contact:
        kept &= in_contact
    else:
        scale = np.abs(problem.clearance).max() + abs(solution.approach)
        kept = np.where(in_contact, kept, gap < -rounding * scale)
    others = states if holds_contact else FREE
    if problem.friction == 0.0:
        return np.where(kept, np.maximum(states, STICK), others).astype(np.int8)
    # The shear that would bring the creep to zero if only this node's shear changed. It tells a
    # slipping node that should stick from one that should slip the other way.
    own = np.minimum(problem.creep_shear.diagonal(), -_TINY)
    sought = solution.shear - creep / own
    bound = problem.friction * np.maximum(pressure, 0.0)
    out = stick_and_slip(states, sought, bound, problem.friction * little)
    out = np.where(kept, out, others).astype(np.int8)
    (new,) = (kept & ~in_contact).nonzero()
    if new.size:
        out[new] = _nearest_states(states, in_contact, new)
    return out


def stick_and_slip(states: States, sought: Array, bound: Array, slack: float) -> States:
    """Return the states that shears call for: stick within the traction bound, slip beyond it.

    Within ``slack`` of the bound a node keeps its state.

    Parameters
    ----------
    states : (n,) of the nodes now.
    sought : (n,) shear of each node with which its creep would be zero [MPa].
    bound : (n,) traction bound [MPa].
    """
    out = np.full(states.size, STICK, dtype=np.int8)
    out[sought > bound + np.where(states == SLIP_PLUS, -slack, slack)] = SLIP_PLUS
    out[sought < -bound - np.where(states == SLIP_MINUS, -slack, slack)] = SLIP_MINUS
    return out


def _nearest_states(states: States, in_contact: Mask, new: Indices) -> States:
    """Return a state for each node newly in contact: that of the nearest node already in contact.

    A node that comes into contact beside slipping nodes has to slip with them: in stick it would
    carry an excessive shear and leave the contact again in the next step.
    """
    (touching,) = in_contact.nonzero()
    place = touching.searchsorted(new)
    before = touching[np.maximum(place - 1, 0)]
    after = touching[np.minimum(place, touching.size - 1)]
    return states[np.where(np.abs(before - new) < np.abs(after - new), before, after)]


def active_set(
    problem: ContactProblem,
    states: States,
    *,
    most_steps: int = MOST_ITERATIONS,
    holds_contact: bool = False,
) -> ContactState:
    """Solve for all unknowns at once, from ``states`` on, until a solution implies its own states.

    ``settled`` is False where that takes more than ``most_steps`` linear systems.
    ``holds_contact``: whether only stick and slip are sought. Then pressures may be negative, and
    surfaces may overlap.
    """
    states = _ensure_solvable(problem, states)
    seen: set[bytes] = set()
    for step in range(1, most_steps + 1):
        solution = solve_states(problem, states)
        wanted = next_states(problem, solution, _ROUNDING, holds_contact=holds_contact)
        if wanted.tobytes() == states.tobytes():
            return replace(solution, steps=step)
        seen.add(states.tobytes())
        if wanted.tobytes() in seen:
            wanted = _gentler(states, wanted, solution)
        states = _ensure_solvable(problem, wanted)
    return replace(solution, steps=most_steps, settled=False)


def _ensure_solvable(problem: ContactProblem, states: States) -> States:
    """Return states with at least one contact node and, if the creepage is unknown, one in stick.

    Without these the system is singular.
    """
    states = states.copy()
    if not states.any():
        states[np.argmin(problem.clearance)] = STICK
    if problem.control.traction is not None and not (states == STICK).any():
        # Material sticks first where it enters the contact: at the leading edge.
        states[np.flatnonzero(states != FREE)[-1]] = STICK
    return states


def _gentler(states: States, wanted: States, solution: ContactState) -> States:
    """Return a smaller change of states, to break a cycle.

    A sticking node under tension is made to slip rather than freed: beside an edge its tension may
    come from a shear beyond the traction bound. Where there is no such node, only the first of the
    nodes that call for another state changes.
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
