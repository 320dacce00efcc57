"""Natural cubic and quintic splines on unevenly spaced points.

A stiff skin answers the fourth derivative of a displacement with a pressure. For a cubic spline
that is a point force at every point and zero between; for a quintic spline it is continuous.
scipy's cubic splines are the same functions, but importing them takes longer than solving a nip.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lapack

Array = NDArray[np.float64]

# Half the integral of the squared third derivative of a quintic over an interval of length 1 is a
# quadratic form of its slope and second derivative at the beginning, those at the end, and its rise
# (end value less first value). Rows 0 to 3: Hessian with respect to the former four. Row 4: minus
# the mixed derivatives with respect to these and the rise.
_QUINTIC_ENERGY = np.array(
    [
        [192.0, 36.0, 168.0, -24.0],
        [36.0, 9.0, 24.0, -3.0],
        [168.0, 24.0, 192.0, -36.0],
        [-24.0, -3.0, -36.0, 9.0],
        [360.0, 60.0, 360.0, -60.0],
    ]
)


@dataclass(frozen=True, slots=True)
class Spline:
    """A piecewise polynomial of degree five at most, constant outside its points.

    Attributes
    ----------
    x : (n,) increasing points.
    values, slopes, bends : (n,) value, first and second derivative at the points.
    """

    x: Array
    values: Array
    slopes: Array
    bends: Array

    @classmethod
    def natural_cubic(cls, x: Array, values: Array) -> Spline:
        """Return the natural cubic spline through n >= 3 points (no curvature at both ends)."""
        over, rise = 1.0 / (x[1:] - x[:-1]), values[1:] - values[:-1]
        diagonal, right, bent = np.zeros(x.size), np.zeros(x.size), 3.0 * rise * over * over
        for part in (slice(None, -1), slice(1, None)):
            diagonal[part] += 2.0 * over
            right[part] += bent
        slopes = lapack.dptsv(diagonal, over, right)[2]
        bends = np.zeros(x.size)
        bends[:-1] = 2.0 * (bent - over * (2.0 * slopes[:-1] + slopes[1:]))
        return cls(x, values, slopes, bends)

    @classmethod
    def natural_quintic(cls, x: Array, values: Array) -> Spline:
        """Return the natural quintic spline through some points.

        Of all functions through them it has the least integral of the squared third derivative. It
        has four continuous derivatives; the third and the fourth vanish at both ends.
        """
        length, rise = x[1:] - x[:-1], values[1:] - values[:-1]
        powers = length ** -np.arange(6.0)[:, None]
        band, right = np.zeros((4, 2 * x.size)), np.zeros(2 * x.size)
        for i in range(4):
            for j in range(i + 1):
                band[i - j, j : j + 2 * length.size : 2] += (
                    _QUINTIC_ENERGY[i, j] * powers[3 - i % 2 - j % 2]
                )
            right[i : i + 2 * length.size : 2] += _QUINTIC_ENERGY[4, i] * rise * powers[4 - i % 2]
        made = lapack.dpbsv(band, right, lower=1)[1]
        return cls(x, values, made[::2], made[1::2])

    @classmethod
    def weighted_sum(cls, weights: Array, splines: Sequence[Spline]) -> Spline:
        """Return a weighted sum of splines, on the points of the last one."""
        x = splines[-1].x
        sums = np.zeros((3, x.size))
        for weight, one in zip(weights, splines, strict=True):
            on = one if one.x is x else cls.natural_cubic(x, one(x))
            sums += weight * np.stack((on.values, on.slopes, on.bends))
        return cls(x, *sums)

    def __call__(self, x: Array, order: int = 0) -> Array:
        """Return the value at ``x``, in its shape, or with ``order`` 1 the derivative."""
        first, last = self.x[0], self.x[-1]
        place = np.minimum(np.maximum(x, first), last)
        cell = self.x[1:-1].searchsorted(place)
        left = self.x[cell]
        length = self.x[cell + 1] - left
        t = (place - left) / length
        here, slope = self.values[cell], length * self.slopes[cell]
        bend, next_bend = length**2 * self.bends[cell], length**2 * self.bends[cell + 1]
        # Differences at the end of the interval from the parabola that continues its beginning: of
        # the value, of the slope, and half that of the second derivative.
        off = self.values[cell + 1] - here - slope - 0.5 * bend
        turn = length * self.slopes[cell + 1] - slope - bend
        grown = 0.5 * (next_bend - bend)
        a, b, c = (
            10.0 * off - 4.0 * turn + grown,
            7.0 * turn - 15.0 * off - 2.0 * grown,
            6.0 * off - 3.0 * turn + grown,
        )
        if order == 1:
            tilt = slope + t * (bend + t * (3.0 * a + t * (4.0 * b + t * 5.0 * c)))
            return np.asarray(tilt / length * ((x >= first) & (x <= last)))
        assert order == 0
        return np.asarray(here + t * (slope + t * (0.5 * bend + t * (a + t * (b + t * c)))))
