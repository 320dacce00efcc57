"""Contact, stick and slip of all nodes at once, by an interior-point method.

The conditions of contact and of Coulomb's friction are a linear complementarity problem,

    gap >= 0, p >= 0, gap p = 0;
    creep = a - b, a >= 0, b >= 0, a (mu p - q) = 0, b (mu p + q) = 0,

on any number of interfaces. Every product is set to the same small positive value instead of 0, and
Newton's method follows the solution as that value goes to zero (Mehrotra, SIAM J. Optim. 2 (1992)
575). Unlike an active set, the method never guesses the states of nodes, so it cannot cycle: it
finds all states with about ten linear systems, however many nodes there are.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

import numpy as np
from scipy.linalg import lapack

from rollnip.contact.problem import (
    MOST_ITERATIONS,
    SLIP_MINUS,
    SLIP_PLUS,
    STICK,
    Array,
    Indices,
    Mask,
    States,
)

# Stopping limits on the violation of the conditions, relative to their scales. Below the first the
# iteration always stops; below the second it stops once a step brings no gain, as where a node is
# on the point of slipping. A violation that has grown to the inverse of the second has diverged:
# there is no solution. The violation is a product of two factors, one of which goes to zero: the
# first limit tells factors apart that differ by the second, a third of all digits.
_SMALL = float(np.cbrt(np.finfo(float).eps))
_SMALLEST = _SMALL * _SMALL
_FIRST = 0.1  # initial gap and creep, relative to their scales
_SHORT_OF = 0.95  # share taken of the longest step that keeps all factors positive


@dataclass(frozen=True, slots=True)
class Inequalities:
    """The complementarity problem: gaps and creeps linear in the unknowns, and friction bounds.

    Unknowns are pressures, shears and others, such as the approach. ``matrix`` times the unknowns
    plus ``right`` is the gap in the row of each pressure, the creep in the row of each shear, and
    zero in all other rows. A creep is positive where a positive shear would stop it
    (`ContactProblem`).

    Attributes
    ----------
    matrix : (m, m).
    right : (m,).
    pressures : (k,) indices of the pressures among the unknowns.
    shears : (s,) indices of the shears.
    bounding : (s,) index of the pressure that bounds each shear.
    frictions : (s,) friction coefficient of each shear, positive.
    sizes : (m,) rough magnitudes of the unknowns; not used for shears.
    scales : (m,) rough magnitudes of the gaps, of the creeps, and of the terms in the other rows.
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
    states : (s,) stick or slip at each shear.
    steps : number of linear systems factorised.
    """

    unknowns: Array
    touches: Mask
    states: States
    steps: int


def interior_point(problem: Inequalities, start: Array, enough: float = _SMALL) -> Complementary:
    """Return unknowns that meet all conditions.

    Parameters
    ----------
    problem : gaps, creeps and friction bounds.
    start : (m,) initial unknowns, with positive pressures and shears within their bounds.
    enough : largest acceptable violation of the conditions, once steps bring no further gain.

    Raises
    ------
    numpy.linalg.LinAlgError
        where no solution is found, or a system is singular.
    """
    iterate, best = _InteriorPoint.of(problem, start), inf
    diverged = max(iterate.violation, 1.0) / _SMALL
    solution: Complementary | None = None
    for steps in range(MOST_ITERATIONS):
        violation = iterate.violation
        if violation < min(best, enough):
            best, solution = violation, iterate.solution(steps)
        if best < _SMALLEST or best < min(violation, _SMALL) or not violation < diverged:
            break
        iterate.advance()
    if solution is None:
        raise np.linalg.LinAlgError("no contact, stick and slip were found")
    return solution


@dataclass(slots=True)
class _InteriorPoint:
    """One iterate of the interior-point method, in dimensionless form.

    Attributes
    ----------
    problem : the problem in its own units.
    sizes : (m,) of the unknowns; that of a shear is its friction times the size of its pressure.
    matrix, right : of the problem, divided by sizes and scales.
    unknowns : (m,) divided by their sizes.
    creeps : (k + 2 s,) gaps, then a and b of all shears.
    """

    problem: Inequalities
    sizes: Array
    matrix: Array
    right: Array
    unknowns: Array
    creeps: Array

    @classmethod
    def of(cls, problem: Inequalities, start: Array) -> _InteriorPoint:
        """Return the first iterate, with all gaps and creeps equal."""
        sizes = problem.sizes.copy()
        sizes[problem.shears] = problem.frictions * sizes[problem.bounding]
        creeps = np.full(problem.pressures.size + 2 * problem.shears.size, _FIRST)
        matrix = problem.matrix * sizes / problem.scales[:, None]
        return cls(problem, sizes, matrix, problem.right / problem.scales, start / sizes, creeps)

    @property
    def violation(self) -> float:
        """Return the violation: the mean complementarity product, or the largest residual if more.

        Infinite where rounding has brought a shear up to its bound.
        """
        slack = self._slack(self.unknowns)
        if not float(slack.min()) > 0.0:
            return inf
        products = float(slack @ self.creeps) / self.creeps.size
        return max(products, float(np.abs(self._residual()).max()))

    def advance(self) -> None:
        """Take one predictor-corrector step (Mehrotra), shortened to keep all factors positive."""
        slack, creeps = self._slack(self.unknowns), self.creeps
        residual, rates = self._residual(), creeps / slack
        factors, pivots, info = lapack.dgetrf(self._jacobian(rates), overwrite_a=1)
        if info != 0:
            raise np.linalg.LinAlgError("Singular matrix")

        def direction(products: Array | float) -> tuple[Array, Array, Array]:
            """Return the steps of unknowns, slacks and creeps towards products of this size."""
            to_products = products / slack - creeps
            d_unknowns, _ = lapack.dgetrs(factors, pivots, self._on_rows(to_products) - residual)
            d_slack = self._slack(d_unknowns)
            return d_unknowns, d_slack, to_products - rates * d_slack

        mean = float(slack @ creeps) / creeps.size
        _, d_slack, d_creeps = direction(0.0)
        step = _longest(slack, d_slack, creeps, d_creeps)
        reached = float((slack + step * d_slack) @ (creeps + step * d_creeps)) / creeps.size
        centring = (reached / mean) ** 3
        d_unknowns, d_slack, d_creeps = direction(mean * centring - d_slack * d_creeps)
        step = _longest(slack, d_slack, creeps, d_creeps)
        step = step if step == 1.0 else _SHORT_OF * step
        self.unknowns = self.unknowns + step * d_unknowns
        self.creeps = creeps + step * d_creeps
        if not np.all(np.isfinite(self.unknowns)):
            raise np.linalg.LinAlgError("no finite solution")

    def solution(self, steps: int) -> Complementary:
        """Return unknowns in their own units, and the states of nodes."""
        k, s = self.problem.pressures.size, self.problem.shears.size
        closed = self._slack(self.unknowns) > self.creeps
        states = np.where(~closed[k : k + s], SLIP_PLUS, STICK)
        states[~closed[k + s :]] = SLIP_MINUS
        found = self.unknowns * self.sizes
        return Complementary(found, closed[:k], states.astype(np.int8), steps)

    def _slack(self, unknowns: Array) -> Array:
        """Return the slacks of the bounds: p, then mu p - q and mu p + q of all shears."""
        bound, shear = unknowns[self.problem.bounding], unknowns[self.problem.shears]
        return np.concatenate([unknowns[self.problem.pressures], bound - shear, bound + shear])

    def _residual(self) -> Array:
        """Return the residual of the linear equations."""
        return np.asarray(self.matrix @ self.unknowns + self.right - self._on_rows(self.creeps))

    def _on_rows(self, parts: Array) -> Array:
        """Return gaps and creeps a - b, placed in the rows of the matrix; 0 in other rows."""
        problem, out = self.problem, np.zeros(self.right.size)
        k, s = problem.pressures.size, problem.shears.size
        out[problem.pressures] = parts[:k]
        out[problem.shears] = parts[k : k + s] - parts[k + s :]
        return out

    def _jacobian(self, rates: Array) -> Array:
        """Return the Newton matrix, with gaps and creeps eliminated from the products."""
        problem, out = self.problem, self.matrix.copy()
        k, s = problem.pressures.size, problem.shears.size
        plus, minus = rates[k : k + s], rates[k + s :]
        out[problem.pressures, problem.pressures] += rates[:k]
        out[problem.shears, problem.bounding] += plus - minus
        out[problem.shears, problem.shears] -= plus + minus
        return out


def _longest(slack: Array, d_slack: Array, creeps: Array, d_creeps: Array) -> float:
    """Return the largest share of a step, at most 1, that makes no factor negative."""
    fastest = max(float(np.max(-d_slack / slack)), float(np.max(-d_creeps / creeps)))
    return 1.0 if fastest <= 1.0 else 1.0 / fastest
