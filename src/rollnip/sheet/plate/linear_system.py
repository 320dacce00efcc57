"""The linear system of a plate for given contact, stick and slip, LU-factorised."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import State, States
from rollnip.contact.problem import shear_signs
from rollnip.nip import Creepage, LineLoad
from rollnip.sheet.lu import LUFactors
from rollnip.sheet.plate.matrices import Pair
from rollnip.sheet.plate.system import PlateProblem, PlateState, PlateTerms

Array = NDArray[np.float64]

EXTRA_UNKNOWNS = 5
"""Number of unknowns besides the tractions: approach, two creepages, height and rotation."""


@dataclass(frozen=True, slots=True)
class FactorisedPlate:
    """The factorised linear system for given states, to be solved for several lagged terms.

    ``unknowns``: indices of the unknowns, see `_unknown_indices`.
    """

    problem: PlateProblem
    states: tuple[States, States]
    unknowns: NDArray[np.intp]
    factors: LUFactors

    @classmethod
    def of(cls, problem: PlateProblem, states: tuple[States, States]) -> FactorisedPlate:
        """Factorise the system for given states of both interfaces.

        Raises
        ------
        numpy.linalg.LinAlgError
            where the states make the system singular.
        """
        unknowns = _unknown_indices(states, problem.starts[-1])
        matrix = _matrix(problem, states)[np.ix_(unknowns, unknowns)]
        return cls(problem, states, unknowns, LUFactors.of(matrix))

    def solved(self, lagged: PlateTerms) -> PlateState:
        """Return the solution for these states and given lagged terms."""
        problem, states = self.problem, self.states
        found = np.zeros(problem.starts[-1] + EXTRA_UNKNOWNS)
        found[self.unknowns] = self.factors.solve(-constant_terms(problem, lagged)[self.unknowns])
        p_u, q_u, p_l, q_l = problem.parts(found)
        slips = _slip_ratios(problem, states)
        q_u, q_l = q_u + slips[0] * p_u, q_l + slips[1] * p_l
        approach, upper, lower, height, rotation = found[-EXTRA_UNKNOWNS:].tolist()
        return PlateState(
            states, (p_u, p_l), (q_u, q_l), approach, (upper, lower), height, rotation
        )


def _unknown_indices(states: tuple[States, States], end: int) -> NDArray[np.intp]:
    """Return the indices of the unknowns: pressures in contact, shears in stick, and the rest.

    ``end``: number of tractions.
    """
    parts = [mask for one in states for mask in (one != State.FREE, one == State.STICK)]
    return np.append(np.concatenate(parts).nonzero()[0], np.arange(end, end + EXTRA_UNKNOWNS))


def _slip_ratios(problem: PlateProblem, states: tuple[States, States]) -> Pair:
    """Return shear over pressure where the interfaces slip, 0 elsewhere."""
    upper, lower = (
        friction * shear_signs(one) for friction, one in zip(problem.frictions, states, strict=True)
    )
    return upper, lower


def _integral_conditions(problem: PlateProblem) -> Array:
    """Return the rows, (5, r), of the integral conditions on the tractions.

    They are the load, the forces across the sheet, the moment on it, the change of tension, and
    T_l.
    """
    a, b, c, d, end = problem.starts
    weights = [mesh.weights for mesh in problem.meshes]
    moments = [one.moment for one in problem.loads]
    half, rows = 0.5 * problem.sheet.thickness, np.zeros((EXTRA_UNKNOWNS, end))
    rows[0, a:b] = weights[0]
    rows[1, a:b], rows[1, c:d] = -weights[0], weights[1]
    rows[2, a:b], rows[2, c:d] = -moments[0], moments[1]
    rows[2, b:c], rows[2, d:] = half * weights[0], half * weights[1]
    upper, lower = (one.total * arcs for one, arcs in zip(problem.loads, problem.arcs, strict=True))
    rows[3, b:c], rows[3, d:] = upper, -lower
    rows[4, d:] = weights[1]
    return rows


def equations(problem: PlateProblem) -> Array:
    """Return the matrix of gaps, creeps and integral conditions for all tractions.

    The rows are gap and creep at all nodes of the upper, then of the lower interface; then load,
    forces and moment on the sheet, change of its tension, and the prescribed drive. The unknowns
    are the tractions, then approach, creepages, height and rotation.
    """
    a, b, c, d, end = problem.starts
    whole = np.zeros((end + EXTRA_UNKNOWNS, end + EXTRA_UNKNOWNS))
    whole[:end, :end], whole[end:, :end] = problem.matrix, _integral_conditions(problem)
    x_u, x_l = (mesh.inner for mesh in problem.meshes)
    whole[a:b, end], whole[a:b, end + 3], whole[a:b, end + 4] = -1.0, -1.0, -x_u
    whole[c:d, end + 3], whole[c:d, end + 4] = 1.0, x_l
    whole[b:c, end + 1], whole[d:end, end + 2] = problem.meshes[0].dx, problem.meshes[1].dx
    whole[end + 2, end + 4] = -problem.plate.righting_moment
    if not isinstance(problem.nip.normal, LineLoad):
        whole[end, :end], whole[end, end] = 0.0, 1.0
    if isinstance(problem.nip.tangential, Creepage):
        whole[end + 4, :end], whole[end + 4, end + 1 : end + 3] = 0.0, 1.0
    return whole


def constant_terms(problem: PlateProblem, lagged: PlateTerms) -> Array:
    """Return the parts of the rows of `equations` that do not depend on the unknowns."""
    nip = problem.nip
    normal, tangential = nip.normal, nip.tangential
    load = normal.load + lagged.lean if isinstance(normal, LineLoad) else normal.approach
    last = tangential.creepage if isinstance(tangential, Creepage) else lagged.traction
    assert last is not None
    pulled, curved = lagged.known.change, lagged.curved
    force, moment = (0.0, 0.0) if curved is None else (curved.total, curved.moment)
    return np.concatenate([problem.constant_terms(lagged), [-load, force, moment, -pulled, -last]])


def _matrix(problem: PlateProblem, states: tuple[States, States]) -> Array:
    """Return the equations with shears in slip in proportion to their pressures."""
    a, b, c, d, end = problem.starts
    whole = equations(problem)
    for ratio, at in zip(_slip_ratios(problem, states), ((a, b, c), (c, d, end)), strict=True):
        if ratio.any():
            whole[:, at[0] : at[1]] += whole[:, at[1] : at[2]] * ratio
    return whole
