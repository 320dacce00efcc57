"""Solution of linear systems by restarted GMRES with a right preconditioner."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_VECTORS = 60
_RESTARTS = 5


def gmres(
    product: Callable[[Array], Array],
    roughly: Callable[[Array], Array],
    right: Array,
    tolerance: float,
) -> Array:
    """Return x with |right - A x| < tolerance |right|, or the best one after 300 products.

    Parameters
    ----------
    product : function that returns A times a vector.
    roughly : function that returns an approximate inverse times a vector.
    right : (n,).
    tolerance : relative.

    References
    ----------
    Saad & Schultz 1986, SIAM J. Sci. Stat. Comput. 7, 856-869.
    """
    solution = np.zeros_like(right)
    goal = tolerance * float(np.linalg.norm(right))
    rest = right
    if float(np.linalg.norm(rest)) <= goal:
        return solution
    for _ in range(_RESTARTS):
        change, is_close = _cycle(product, rest, roughly, goal)
        solution = solution + change
        if is_close:
            break
        rest = right - product(solution)
    return solution


def _cycle(
    product: Callable[[Array], Array],
    rest: Array,
    roughly: Callable[[Array], Array],
    goal: float,
) -> tuple[Array, bool]:
    """Return the best change within one Krylov space, and whether it meets the goal."""
    first = float(np.linalg.norm(rest))
    basis = [rest / first]
    triangle = np.zeros((_VECTORS + 1, _VECTORS))
    weights: Array = np.zeros(0)
    left = first
    for j in range(_VECTORS):
        vector = product(roughly(basis[j]))
        for _ in range(2):  # the second pass removes what rounding left in the first
            for i, other in enumerate(basis):
                part = float(other @ vector)
                triangle[i, j] += part
                vector = vector - part * other
        triangle[j + 1, j] = float(np.linalg.norm(vector))
        unit = np.zeros(j + 2)
        unit[0] = first
        block = triangle[: j + 2, : j + 1]
        weights = np.asarray(np.linalg.lstsq(block, unit, rcond=None)[0], dtype=float)
        left = float(np.linalg.norm(unit - block @ weights))
        if left <= goal or triangle[j + 1, j] <= 1e-14 * first:
            break
        basis.append(vector / triangle[j + 1, j])
    mixed = np.zeros_like(rest)
    for weight, vector in zip(weights, basis, strict=False):
        mixed += weight * vector
    return roughly(mixed), left <= goal
