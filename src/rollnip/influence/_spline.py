"""Cubic splines on an even grid.

Those of scipy do the same; to import them takes longer than to solve a nip.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lapack

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class EvenSpline:
    """A piecewise cubic function on cells of one length.

    Attributes
    ----------
    start, step : first point and spacing of the grid.
    coefficients : (4, cells) of the powers 3 to 0 of the fraction of a cell; the first and the
        last cell go on beyond the grid.
    """

    start: float
    step: float
    coefficients: Array

    def __call__(self, x: Array, order: int = 0) -> Array:
        """Value at ``x``, of its shape, or with ``order`` 1 its derivative."""
        (a, b, c, d), t = self._cells(x)
        if order == 0:
            return np.asarray(((a * t + b) * t + c) * t + d)
        assert order == 1
        return np.asarray(((3.0 * a * t + 2.0 * b) * t + c) / self.step)

    def _cells(self, x: Array) -> tuple[Array, Array]:
        """Coefficients of the cell of each place, (4, ...), and the fraction of it."""
        place = (x - self.start) / self.step
        last = self.coefficients.shape[1] - 1
        cell = np.minimum(np.maximum(place.astype(np.intp), 0), last)
        return self.coefficients.take(cell, axis=1), place - cell


def even_splines(x: Array, values: Array) -> tuple[EvenSpline, ...]:
    """Cubic splines (not-a-knot) of the rows of ``values`` (m, n) on an even grid x, n >= 4."""
    rise = values[:, 1:] - values[:, :-1]
    # The slopes at all points; the equations at both ends are halved, which makes them symmetric.
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
