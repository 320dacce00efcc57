"""Systems of equations with one matrix and many right sides, by generalised conjugate residuals.

The method (Eisenstat, Elman & Schultz 1983, SIAM J. Numer. Anal. 20, 345-357) keeps the directions
of its steps, each with its product with the matrix, and makes these products orthonormal. The
directions of earlier systems serve later ones as well: the equilibria of one mesh ask for similar
displacements, so that few directions are new.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from rollnip.finite.strip import Array

_MOST_KEPT = 60  # directions
_MOST_STEPS = 180  # of one system


class Directions:
    """Directions of steps and their products with one matrix, from all systems solved so far.

    Parameters
    ----------
    size :
        number of unknowns.
    """

    def __init__(self, size: int) -> None:
        self._steps = np.empty((_MOST_KEPT, size))
        self._products = np.empty((_MOST_KEPT, size))  # orthonormal
        self._made = 0

    @property
    def _kept(self) -> slice:
        return slice(min(self._made, _MOST_KEPT))

    def solve(
        self, product: Callable[[Array], Array], start: Array, rest: Array, goal: float
    ) -> Array | None:
        """Return a solution whose residual is at most ``goal``; None if too many steps are needed.

        Parameters
        ----------
        product : function that returns the matrix times a vector; the same in every call.
        start, rest : (n,) the first guess and its residual.
        goal : 2-norm of the residual.
        """
        shares = self._products[self._kept] @ rest
        solution = start + shares @ self._steps[self._kept]
        rest = rest - shares @ self._products[self._kept]
        for _ in range(_MOST_STEPS):
            left = float(np.linalg.norm(rest))
            if left <= goal:
                return solution
            if not np.isfinite(left):
                break
            step, made = self._added(rest, product(rest))
            share = float(made @ rest)
            solution += share * step
            rest -= share * made
        return None

    def _added(self, step: Array, product: Array) -> tuple[Array, Array]:
        """Keep a direction, in place of the oldest if there are many; return it and its product."""
        steps, products = self._steps[self._kept], self._products[self._kept]
        for _ in range(2):  # the second time removes what rounding left in the first
            shares = products @ product
            product, step = product - shares @ products, step - shares @ steps
        length, place = float(np.linalg.norm(product)), self._made % _MOST_KEPT
        self._steps[place], self._products[place] = step / length, product / length
        self._made += 1
        return self._steps[place], self._products[place]
