"""Low-pass filter of the correction: it removes waves that are too short for the contact."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lapack

from rollnip.finite._spline import Spline

Array = NDArray[np.float64]

_PER_CUT = 1.0  # grid points per radian of the wave at the cut-off, whose amplitude is halved


@dataclass(frozen=True)
class LowPass:
    """A low-pass filter that multiplies waves of the wave number k by 1 / (1 + (k/cut)^4).

    It solves (1 + w D^T D) smooth = given, with the second differences D at all inner points of an
    even grid of spacing h and w = 1/(cut h)^4.

    Attributes
    ----------
    x : (n,) grid on which functions are smoothed [mm].
    factors : (3, n) Cholesky factors of 1 + w D^T D, upper, in banded storage.
    """

    x: Array
    factors: Array

    @classmethod
    def of(cls, middle: float, ends: float, cut: float) -> LowPass:
        """Return the filter for functions between middle - ends and middle + ends [mm].

        ``cut`` is the wave number whose amplitude is halved [1/mm].
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
        """Return the functions without their short waves, as natural cubic splines on ``x``."""
        values = np.stack([f(self.x) for f in functions], axis=1)
        made, info = lapack.dpbtrs(self.factors, values)
        assert info == 0
        return tuple(Spline.natural_cubic(self.x, column) for column in made.T)
