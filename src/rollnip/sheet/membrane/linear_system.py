"""The linear system of a membrane for given contact, stick and slip, LU-factorised."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import State, States
from rollnip.contact.problem import shear_signs
from rollnip.nip import Creepage, LineLoad
from rollnip.sheet.lu import LUFactors
from rollnip.sheet.membrane.system import MembraneProblem, MembraneState, MembraneTerms

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class FactorisedMembrane:
    """The factorised linear system for given states, to be solved for several lagged terms."""

    problem: MembraneProblem
    states: States
    factors: LUFactors

    @classmethod
    def of(cls, problem: MembraneProblem, states: States) -> FactorisedMembrane:
        """Factorise the system for given states, (2, n), without checking the contact conditions.

        Raises
        ------
        numpy.linalg.LinAlgError
            where the states make the system singular.
        """
        return cls(problem, states, LUFactors.of(_matrix(problem, states)))

    def solved(self, lagged: MembraneTerms) -> MembraneState:
        """Return the solution for these states and given lagged terms."""
        problem, states = self.problem, self.states
        unknowns = self.factors.solve(_right_side(problem, states, lagged))
        contact, sticks = _unknown_indices(states)
        n, n_c = states.shape[1], contact.size
        pressure = np.zeros(n)
        pressure[contact] = unknowns[:n_c]
        shears = _slip_ratios(problem, states) * pressure
        shears.reshape(-1)[sticks] = unknowns[n_c:-3]
        approach, creepage, lower = unknowns[-3:].tolist()
        return MembraneState(
            states=states[0],
            pressure=pressure,
            shear=shears[0],
            approach=approach,
            creepage=creepage,
            steps=1,
            settled=True,
            states_lower=states[1],
            shear_lower=shears[1],
            creepage_lower=lower,
        )


def _unknown_indices(states: States) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return the indices of nodes in contact, and of sticking shears among both interfaces'."""
    return (states[0] != State.FREE).nonzero()[0], (states == State.STICK).reshape(-1).nonzero()[0]


def _slip_ratios(problem: MembraneProblem, states: States) -> Array:
    """Return shear over pressure where the interfaces slip, 0 elsewhere, (2, n)."""
    return np.asarray(np.array(problem.frictions)[:, None] * shear_signs(states))


def _matrix(problem: MembraneProblem, states: States) -> Array:
    """Return the matrix of gaps in contact, creeps in stick, and three prescribed quantities."""
    n, (contact, sticks) = states.shape[1], _unknown_indices(states)
    n_c, size = contact.size, contact.size + sticks.size
    rows = np.concatenate([contact, n + sticks])
    ratios = _slip_ratios(problem, states)
    influence = problem.matrix.take(rows, axis=0)
    for side, ratio in enumerate(ratios):
        if ratio.any():
            influence[:, :n] += influence[:, (1 + side) * n : (2 + side) * n] * ratio
    matrix = np.zeros((size + 3, size + 3))
    matrix[:size, :size] = influence.take(rows, axis=1)
    matrix[:n_c, -3] = -1.0
    in_upper = sticks < n
    length = problem.dx[sticks % n]
    matrix[n_c:size, -2] = np.where(in_upper, length, 0.0)
    matrix[n_c:size, -1] = np.where(in_upper, 0.0, length)
    weights = problem.mesh.weights
    if isinstance(problem.nip.normal, LineLoad):
        matrix[-3, :n_c] = weights[contact]
    else:
        matrix[-3, -3] = 1.0
    # The change of tension through the nip, then T_l or the sum of the creepages.
    matrix[-2, :size] = _shear_integral(problem.force_weights, ratios[0], contact, sticks)
    matrix[-2, :size] -= _shear_integral(problem.force_weights, ratios[1], contact, sticks - n)
    if isinstance(problem.nip.tangential, Creepage):
        matrix[-1, -2:] = 1.0
    else:
        matrix[-1, :size] = _shear_integral(weights, ratios[1], contact, sticks - n)
    return matrix


def _shear_integral(
    weights: Array, ratio: Array, contact: NDArray[np.intp], sticks: NDArray[np.intp]
) -> Array:
    """Return the integral of one interface's shear, per pressure and per sticking shear.

    ``sticks``: node indices of sticking shears; indices out of range belong to the other interface.
    """
    own = (sticks >= 0) & (sticks < weights.size)
    stuck = np.where(own, weights[np.where(own, sticks, 0)], 0.0)
    return np.concatenate([(weights * ratio)[contact], stuck])


def _right_side(problem: MembraneProblem, states: States, lagged: MembraneTerms) -> Array:
    contact, sticks = _unknown_indices(states)
    right, nip = problem.constant_terms(lagged), problem.nip
    normal, tangential = nip.normal, nip.tangential
    load = normal.load + lagged.lean if isinstance(normal, LineLoad) else normal.approach
    last = tangential.creepage if isinstance(tangential, Creepage) else lagged.traction
    assert last is not None
    prescribed = [load, lagged.known.change, last]
    return np.concatenate([-right[0, contact], -right[1:].reshape(-1)[sticks], prescribed])
