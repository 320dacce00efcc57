"""Cubic splines on points at any distances.

Those of scipy do the same; to import them takes longer than to solve a nip.
"""

from __future__ import annotations

from collections.abc import Sequence
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
        diagonal, beside = np.empty(x.size), 1.0 / (x[1:] - x[:-1])
        diagonal[1:-1] = 2.0 * (beside[1:] + beside[:-1])
        diagonal[0], diagonal[-1] = 2.0 * beside[0], 2.0 * beside[-1]
        bent = 3.0 * (values[1:] - values[:-1]) * beside * beside
        right = np.empty(x.size)
        right[1:-1] = bent[1:] + bent[:-1]
        right[0], right[-1] = bent[0], bent[-1]
        return cls(x, values, lapack.dptsv(diagonal, beside, right)[2])

    @classmethod
    def mean(cls, shares: Array, splines: Sequence[Spline]) -> Spline:
        """Return a weighted sum of splines, on the points of the last one."""
        x = splines[-1].x
        values, slopes = np.zeros((2, x.size))
        for share, one in zip(shares, splines, strict=True):
            on = one if one.x is x else cls.through(x, one(x))
            values += share * on.values
            slopes += share * on.slopes
        return cls(x, values, slopes)

    def __call__(self, x: Array, order: int = 0) -> Array:
        """Value at ``x``, of its shape, or with ``order`` 1 its derivative."""
        first, last = self.x[0], self.x[-1]
        place = np.minimum(np.maximum(x, first), last)
        cell = self.x[1:-1].searchsorted(place)
        left = self.x[cell]
        length = self.x[cell + 1] - left
        t = (place - left) / length
        here = self.values[cell]
        rise = self.values[cell + 1] - here
        start, stop = length * self.slopes[cell], length * self.slopes[cell + 1]
        bend = start + stop - 2.0 * rise
        if order == 1:
            turn = 2.0 * (rise - start - bend) + 3.0 * t * bend
            return np.asarray((start + t * turn) / length * ((x >= first) & (x <= last)))
        assert order == 0
        return np.asarray(here + t * (start + t * (rise - start - bend + t * bend)))
