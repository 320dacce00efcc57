"""Leaving out of functions what is too short for the contact."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lapack

from rollnip.finite._spline import Spline

Array = NDArray[np.float64]

_PER_CUT = 1.0  # points of the grid per radian of the wave of which half is left


@dataclass(frozen=True)
class Smoothing:
    """Waves of number k are left to 1 / (1 + (k/cut)^4).

    Attributes
    ----------
    x : (n,) even points on which functions are smoothed [mm].
    factors : of 1 + weight times the square of second differences, without any beyond the ends.
    """

    x: Array
    factors: Array

    @classmethod
    def of(cls, middle: float, ends: float, cut: float) -> Smoothing:
        """Return the smoothing of functions between middle - ends and middle + ends.

        ``cut`` is the wave number of which half is left [1/mm].
        """
        count = int(np.ceil(2.0 * ends * cut * _PER_CUT)) + 1
        x = np.linspace(middle - ends, middle + ends, count)
        weight = 1.0 / (cut * (x[1] - x[0])) ** 4
        band = np.zeros((3, count))
        band[0, 2:], band[1, 1:], band[2] = weight, -4.0 * weight, 1.0 + 6.0 * weight
        band[1, [1, -1]], band[2, [0, -1]], band[2, [1, -2]] = (
            -2.0 * weight,
            1.0 + weight,
            1.0 + 5.0 * weight,
        )
        factors, info = lapack.dpbtrf(band)
        assert info == 0
        return cls(x, factors)

    def __call__(self, functions: tuple[Spline, ...]) -> tuple[Spline, ...]:
        """Return functions of the place without their short waves, on the points ``x``."""
        values = np.stack([f(self.x) for f in functions], axis=1)
        made, info = lapack.dpbtrs(self.factors, values)
        assert info == 0
        return tuple(Spline.through(self.x, column) for column in made.T)
