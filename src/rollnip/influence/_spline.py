"""Cubic splines on an even grid.

Those of scipy do the same; to import them takes longer than to solve a nip.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_banded

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
        cell = np.clip(np.floor(place), 0.0, self.coefficients.shape[1] - 1.0).astype(np.intp)
        return self.coefficients.take(cell, axis=1), place - cell


def even_splines(x: Array, values: Array) -> tuple[EvenSpline, ...]:
    """Cubic splines (not-a-knot) of the columns of ``values`` (n, m) on an even grid x, n >= 4."""
    rise = np.diff(values, axis=0)
    right = np.empty(values.shape)
    right[1:-1] = 3.0 * (rise[1:] + rise[:-1])
    right[[0, -1]] = 0.5 * (5.0 * rise[[0, -1]] + rise[[1, -2]])
    bands = np.ones((3, x.size))
    bands[1, 1:-1] = 4.0
    bands[0, 1] = bands[2, -2] = 2.0
    slope = solve_banded((1, 1), bands, right, check_finite=False)
    turn = slope[1:] + slope[:-1] - 2.0 * rise
    cubes = np.stack([turn, rise - slope[:-1] - turn, slope[:-1], values[:-1]])
    start, step = float(x[0]), float(x[1] - x[0])
    columns = np.ascontiguousarray(np.moveaxis(cubes, 2, 0))
    return tuple(EvenSpline(start, step, column) for column in columns)
