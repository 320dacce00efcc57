"""Contact, stick and slip of all nodes at once, by an interior-point method.

The conditions of contact and of Coulomb's friction are a linear complementarity problem,

    gap >= 0, p >= 0, gap p = 0;
    creep = a - b, a >= 0, b >= 0, a (mu p - q) = 0, b (mu p + q) = 0,

on any number of interfaces. Each product gets a small positive value in place of 0, the same one
for all, and Newton's method follows the solution while that value falls to zero (Mehrotra, SIAM J.
Optim. 2 (1992) 575). No state of a node is guessed before the tractions are known, so no search can
turn in a circle: some ten linear systems find all states, whatever their number.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

import numpy as np
from scipy.linalg import lapack

from rollnip.contact.problem import SLIP_MINUS, SLIP_PLUS, STICK, Array, Indices, Mask, States

# What is left of the conditions, over their sizes: where the iteration ends at the latest, and
# where it ends as soon as nothing is gained, as where a node is about to slip. There is no solution
# where it has grown by the inverse of the second.
_SMALLEST, _SMALL = 1e-11, 1e-6
_FIRST = 0.1  # gap and creep to begin with, over their sizes
_SHORT_OF = 0.95  # of the step on which the first part of a condition would vanish
_MOST_STEPS = 40


@dataclass(frozen=True, slots=True)
class Inequalities:
    """Gaps and creeps that are linear in tractions and further unknowns, and where friction bounds.

    The rows of ``matrix`` times the unknowns plus ``right`` are the gap at the place of each
    pressure, the creep at the place of each shear, and zero in all other rows. A creep is positive
    where a positive shear would stop it (`ContactProblem`).

    Attributes
    ----------
    matrix : (m, m).
    right : (m,).
    pressures : (k,) places of the pressures among the unknowns.
    shears : (s,) places of the shears.
    bounding : (s,) place of the pressure that bounds each shear.
    frictions : (s,) coefficient of each shear, positive.
    sizes : (m,) about how large the unknowns are; not used for shears.
    scales : (m,) about how large gaps, creeps and the parts of the other rows are.
    """

    matrix: Array
    right: Array
    pressures: Indices
    shears: Indices
    bounding: Indices
    frictions: Array
    sizes: Array
    scales: Array


@dataclass(frozen=True, slots=True)
class Complementary:
    """A solution of `Inequalities`.

    Attributes
    ----------
    unknowns : (m,).
    touches : (k,) whether the gap at each pressure is closed.
    states : (s,) whether each shear sticks or slips.
    steps : linear systems factorised.
    """

    unknowns: Array
    touches: Mask
    states: States
    steps: int


def interior_point(problem: Inequalities, start: Array, enough: float = _SMALL) -> Complementary:
    """Return tractions that meet all conditions.

    Parameters
    ----------
    problem : gaps, creeps and what bounds them.
    start : (m,) unknowns to begin with, pressures positive and shears within their bounds.
    enough : what may be left of the conditions, where no step gains any more.

    Raises
    ------
    numpy.linalg.LinAlgError
        where there are none, or a system is singular.
    """
    iterate, best = _Iterate.of(problem, start), inf
    diverged = max(iterate.left, 1.0) / _SMALL
    solution: Complementary | None = None
    for steps in range(_MOST_STEPS):
        left = iterate.left
        if left < min(best, enough):
            best, solution = left, iterate.solution(steps)
        if best < _SMALLEST or best < min(left, _SMALL) or not left < diverged:
            break
        iterate.advance()
    if solution is None:
        raise np.linalg.LinAlgError("no contact, stick and slip were found")
    return solution


@dataclass(slots=True)
class _Iterate:
    """Tractions and the parts of their conditions, all over their sizes.

    Attributes
    ----------
    problem : as it was given.
    sizes : (m,) of the unknowns; a shear's is its friction times the size of its pressure.
    matrix, right : over sizes and scales.
    unknowns : (m,) over their sizes.
    creeps : (k + 2 s,) gaps, then a and b of all shears.
    """

    problem: Inequalities
    sizes: Array
    matrix: Array
    right: Array
    unknowns: Array
    creeps: Array

    @classmethod
    def of(cls, problem: Inequalities, start: Array) -> _Iterate:
        """Begin, with equal gaps and creeps."""
        sizes = problem.sizes.copy()
        sizes[problem.shears] = problem.frictions * sizes[problem.bounding]
        creeps = np.full(problem.pressures.size + 2 * problem.shears.size, _FIRST)
        matrix = problem.matrix * sizes / problem.scales[:, None]
        return cls(problem, sizes, matrix, problem.right / problem.scales, start / sizes, creeps)

    @property
    def left(self) -> float:
        """Return what is left of the conditions: their mean product, or most of an equation.

        Infinite where rounding has taken all the room of a shear.
        """
        room = self._room(self.unknowns)
        if not float(room.min()) > 0.0:
            return inf
        products = float(room @ self.creeps) / self.creeps.size
        return max(products, float(np.abs(self._residual()).max()))

    def advance(self) -> None:
        """Take one step of Newton's method: predicted to zero, corrected, and kept inside."""
        room, creeps = self._room(self.unknowns), self.creeps
        residual, rates = self._residual(), creeps / room
        factors, pivots, info = lapack.dgetrf(self._jacobian(rates), overwrite_a=1)
        if info != 0:
            raise np.linalg.LinAlgError("Singular matrix")

        def direction(products: Array | float) -> tuple[Array, Array, Array]:
            """Return steps of the unknowns, of the room that they leave, and of the creeps."""
            wanted = products / room - creeps
            found, _ = lapack.dgetrs(factors, pivots, self._on_rows(wanted) - residual)
            opened = self._room(found)
            return found, opened, wanted - rates * opened

        mean = float(room @ creeps) / creeps.size
        _, opened, slid = direction(0.0)
        step = _longest(room, opened, creeps, slid)
        left = float((room + step * opened) @ (creeps + step * slid)) / creeps.size
        found, opened_too, slid_too = direction(mean * (left / mean) ** 3 - opened * slid)
        step = _longest(room, opened_too, creeps, slid_too)
        step = step if step == 1.0 else _SHORT_OF * step
        self.unknowns = self.unknowns + step * found
        self.creeps = creeps + step * slid_too
        if not np.all(np.isfinite(self.unknowns)):
            raise np.linalg.LinAlgError("no finite solution")

    def solution(self, steps: int) -> Complementary:
        """Return tractions and states."""
        k, s = self.problem.pressures.size, self.problem.shears.size
        closed = self._room(self.unknowns) > self.creeps
        states = np.where(~closed[k : k + s], SLIP_PLUS, STICK)
        states[~closed[k + s :]] = SLIP_MINUS
        found = self.unknowns * self.sizes
        return Complementary(found, closed[:k], states.astype(np.int8), steps)

    def _room(self, unknowns: Array) -> Array:
        """Return p, and mu p - q and mu p + q of all shears, over their sizes."""
        bound, shear = unknowns[self.problem.bounding], unknowns[self.problem.shears]
        return np.concatenate([unknowns[self.problem.pressures], bound - shear, bound + shear])

    def _residual(self) -> Array:
        """Return what tractions, gaps and creeps leave of the equations."""
        return np.asarray(self.matrix @ self.unknowns + self.right - self._on_rows(self.creeps))

    def _on_rows(self, parts: Array) -> Array:
        """Return gaps and creeps, of which the latter have two parts, on the rows of the matrix."""
        problem, out = self.problem, np.zeros(self.right.size)
        k, s = problem.pressures.size, problem.shears.size
        out[problem.pressures] = parts[:k]
        out[problem.shears] = parts[k : k + s] - parts[k + s :]
        return out

    def _jacobian(self, rates: Array) -> Array:
        """Return the matrix with what gaps and creeps yield when the room for them changes."""
        problem, out = self.problem, self.matrix.copy()
        k, s = problem.pressures.size, problem.shears.size
        plus, minus = rates[k : k + s], rates[k + s :]
        out[problem.pressures, problem.pressures] += rates[:k]
        out[problem.shears, problem.bounding] += plus - minus
        out[problem.shears, problem.shears] -= plus + minus
        return out


def _longest(room: Array, opened: Array, creeps: Array, slid: Array) -> float:
    """Return the share of a step, at most 1, on which nothing becomes negative."""
    fastest = max(float(np.max(-opened / room)), float(np.max(-slid / creeps)))
    return 1.0 if fastest <= 1.0 else 1.0 / fastest
