"""LU factors of a dense matrix, to solve it for several right-hand sides."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lapack

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class LUFactors:
    """Factors of the transpose of a matrix, with pivots, as LAPACK returns them."""

    factors: Array
    pivots: NDArray[np.intp]

    @classmethod
    def of(cls, matrix: Array) -> Self:
        """Factorise a square matrix, (n, n), which is overwritten.

        Raises
        ------
        numpy.linalg.LinAlgError
            where it is singular.
        """
        factors, pivots, info = lapack.dgetrf(matrix.T, overwrite_a=1)
        if info != 0:
            raise np.linalg.LinAlgError("Singular matrix")
        return cls(factors, pivots)

    def solve(self, right: Array) -> Array:
        """Return the solution for a right-hand side, (n,)."""
        unknowns, info = lapack.dgetrs(self.factors, self.pivots, right, trans=1)
        assert info == 0
        return np.asarray(unknowns)
