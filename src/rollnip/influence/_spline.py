"""Cubic splines on an even grid.

scipy has the same splines, but importing them takes longer than solving a nip.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lapack

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class EvenSpline:
    """A piecewise cubic function on cells of equal length.

    Attributes
    ----------
    start, step : first point and spacing of the grid.
    coefficients : (4, cells) coefficients of the powers 3 to 0 of the fraction of a cell; the first
        and the last cell extend beyond the grid.
    """

    start: float
    step: float
    coefficients: Array

    def __call__(self, x: Array, order: int = 0) -> Array:
        """Return the value at ``x``, of its shape; with ``order`` 1, the derivative."""
        (a, b, c, d), t = self._cells(x)
        if order == 0:
            return np.asarray(((a * t + b) * t + c) * t + d)
        assert order == 1
        return np.asarray(((3.0 * a * t + 2.0 * b) * t + c) / self.step)

    def _cells(self, x: Array) -> tuple[Array, Array]:
        """Return the coefficients (4, ...) of each place's cell, and the fraction of the cell."""
        place = (x - self.start) / self.step
        last = self.coefficients.shape[1] - 1
        cell = np.minimum(np.maximum(place.astype(np.intp), 0), last)
        return self.coefficients.take(cell, axis=1), place - cell


def even_splines(x: Array, values: Array) -> tuple[EvenSpline, ...]:
    """Return the not-a-knot cubic splines of rows ``values`` (m, n) on an even grid x, n >= 4."""
    rise = values[:, 1:] - values[:, :-1]
    # Unknowns are the slopes at all points. Halving the equations at both ends makes the matrix
    # symmetric.
    diagonal, beside = np.full(x.size, 4.0), np.ones(x.size - 1)
    diagonal[0] = diagonal[-1] = 0.5
    right = np.empty(values.shape)
    np.add(rise[:, 1:], rise[:, :-1], out=right[:, 1:-1])
    right[:, 1:-1] *= 3.0
    right[:, 0] = 0.25 * (5.0 * rise[:, 0] + rise[:, 1])
    right[:, -1] = 0.25 * (5.0 * rise[:, -1] + rise[:, -2])
    slope = lapack.dptsv(diagonal, beside, right.T, overwrite_b=1)[2].T
    cubes = np.empty((len(values), 4, x.size - 1))
    turn = slope[:, 1:] + slope[:, :-1] - 2.0 * rise
    cubes[:, 0], cubes[:, 1] = turn, rise - slope[:, :-1] - turn
    cubes[:, 2], cubes[:, 3] = slope[:, :-1], values[:, :-1]
    start, step = float(x[0]), float(x[1] - x[0])
    return tuple(EvenSpline(start, step, cube) for cube in cubes)
