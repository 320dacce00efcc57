"""Leaving out of a function what is too short for the contact."""

from __future__ import annotations

import numpy as np
from scipy.linalg import lapack

from rollnip.finite._spline import Spline

_PER_CUT = 1.0  # points of the grid per radian of the wave of which half is left


def smoothed(
    functions: tuple[Spline, ...], middle: float, ends: float, cut: float
) -> tuple[Spline, ...]:
    """Return functions of the place with waves of number k times 1 / (1 + (k/cut)^4).

    Parameters
    ----------
    functions : of the place x.
    middle : of the places that are of interest [mm].
    ends : distance from the middle up to which they are [mm].
    cut : wave number of which half is left [1/mm].
    """
    count = int(np.ceil(2.0 * ends * cut * _PER_CUT)) + 1
    x = np.linspace(middle - ends, middle + ends, count)
    values = np.stack([f(x) for f in functions], axis=1)
    weight = 1.0 / (cut * (x[1] - x[0])) ** 4
    # 1 + weight times the square of second differences, without any beyond the ends
    band = np.zeros((3, count))
    band[0, 2:], band[1, 1:], band[2] = weight, -4.0 * weight, 1.0 + 6.0 * weight
    band[1, [1, -1]], band[2, [0, -1]], band[2, [1, -2]] = (
        -2.0 * weight,
        1.0 + weight,
        1.0 + 5.0 * weight,
    )
    _, made, info = lapack.dpbsv(band, values)
    assert info == 0
    return tuple(Spline.through(x, column) for column in made.T)
