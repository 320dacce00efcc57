"""Cubic splines on points at any distances.

Those of scipy do the same; to import them takes longer than to solve a nip.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lapack

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Spline:
    """A piecewise cubic function with a continuous second derivative, constant beyond its points.

    Attributes
    ----------
    x : (n,) increasing points.
    values, slopes : (n,) there.
    """

    x: Array
    values: Array
    slopes: Array

    @classmethod
    def through(cls, x: Array, values: Array) -> Spline:
        """Return the spline through some points, n >= 3, without curvature at both ends."""
        h = np.diff(x)
        rise = np.diff(values) / h
        diagonal, beside = np.empty(x.size), 1.0 / h
        diagonal[1:-1] = 2.0 * (beside[1:] + beside[:-1])
        diagonal[0], diagonal[-1] = 2.0 * beside[0], 2.0 * beside[-1]
        right = np.empty(x.size)
        right[1:-1] = 3.0 * (rise[1:] * beside[1:] + rise[:-1] * beside[:-1])
        right[0], right[-1] = 3.0 * rise[0] * beside[0], 3.0 * rise[-1] * beside[-1]
        return cls(x, values, lapack.dptsv(diagonal, beside, right)[2])

    def __call__(self, x: Array, order: int = 0) -> Array:
        """Value at ``x``, of its shape, or with ``order`` 1 its derivative."""
        inside = (x >= self.x[0]) & (x <= self.x[-1])
        x = np.clip(x, self.x[0], self.x[-1])
        cell = np.clip(np.searchsorted(self.x, x) - 1, 0, self.x.size - 2)
        h = self.x[cell + 1] - self.x[cell]
        t = (x - self.x[cell]) / h
        rise = self.values[cell + 1] - self.values[cell]
        start, stop = h * self.slopes[cell], h * self.slopes[cell + 1]
        if order == 1:
            turn = 6.0 * rise - 4.0 * start - 2.0 * stop + 3.0 * t * (start + stop - 2.0 * rise)
            return np.asarray((start + t * turn) / h * inside)
        assert order == 0
        cubic = start + t * (3.0 * rise - 2.0 * start - stop + t * (start + stop - 2.0 * rise))
        return np.asarray(self.values[cell] + t * cubic)
