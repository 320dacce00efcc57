"""Influence coefficients on a uniform grid, one for each distance between two nodes.

A hat function is a constant convolved with itself, so that the displacement under a hat is the
second difference of the double integral of G. Far from the hat this difference loses digits by
cancellation. There G itself is averaged over the hat: int G(x - s) hat(s) ds = h (G(x - h) + 10
G(x) + G(x + h))/12 - h^5 G''''(x)/240 + ..., with the weights of Numerov's method.
"""

from __future__ import annotations

from collections.abc import Callable
from math import factorial, log

import numpy as np
from numpy.typing import NDArray

from rollnip.influence.kernel import Kernel

Array = NDArray[np.float64]


def _near_nodes(kernel: Kernel) -> float:
    """Return the number of spacings within which second differences are taken.

    At n spacings both formulas have the same error. The average misses 6/240 n^-4 of G, which
    varies as ln x. The differences miss n^2 times the error of the table, a polynomial of degree 5
    through values, slopes and second derivatives at steps h of ln x: h^6/(2^6 6!) of it.
    """
    step = log(2.0) / kernel.points_per_octave
    return float((6.0 / 240.0 * 2.0**6 * factorial(6)) ** (1.0 / 6.0) / step)


def grid_displacements(kernel: Kernel, spacing: float, count: int) -> Array:
    """Return the displacement per unit hat at distances -(count-1) ... count-1 spacings.

    Parameters
    ----------
    kernel : influence function, one channel.
    spacing : spacing of the grid, half the width of a hat [mm].
    count : number of nodes of the grid.

    Returns
    -------
    (2 count - 1,) [mm/MPa]: the convolution kernel for which `displacement_matrix` is the full
    matrix.
    """
    value = kernel.value

    def far(x: Array) -> Array:
        return (spacing / 12.0) * (value(x - spacing) + 10.0 * value(x) + value(x + spacing))

    return _over_distances(kernel, spacing, count, kernel.double_integral, far)


def grid_strains(kernel: Kernel, spacing: float, count: int) -> Array:
    """Return the derivative of `grid_displacements` along x, (2 count - 1,) [1/MPa].

    Near the hat it is the second difference of the integral of G. Far from it, it is the difference
    of two means of G over a spacing, each by Simpson's rule.
    """
    value, half = kernel.value, 0.5 * spacing

    def far(x: Array) -> Array:
        middle = 4.0 * (value(x + half) - value(x - half))
        return (middle + value(x + spacing) - value(x - spacing)) / 6.0

    return _over_distances(kernel, spacing, count, kernel.integral, far)


def _over_distances(
    kernel: Kernel,
    spacing: float,
    count: int,
    integral: Callable[[Array], Array],
    far: Callable[[Array], Array],
) -> Array:
    """Return second differences of an integral near the hat, and ``far`` away from it."""
    step = np.arange(1.0 - count, count)
    x, is_near = spacing * step, np.abs(step) <= _near_nodes(kernel)
    near = x[is_near]
    out = np.empty(x.size)
    difference = integral(near + spacing) - 2.0 * integral(near) + integral(near - spacing)
    out[is_near] = difference / spacing
    out[~is_near] = far(x[~is_near])
    return out
