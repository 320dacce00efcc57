"""Influence coefficients on a uniform grid: one number for each distance between two nodes.

A hat function is a constant convolved with itself, so the displacement under a hat is the second
difference of the double integral of G. Far from the hat that difference cancels digits away; there
G itself, averaged over the hat, is taken: int G(x - s) hat(s) ds = h (G(x - h) + 10 G(x) + G(x + h)
)/12 - h^5 G''''(x)/240 + ... (the same weights as in Numerov's method).
"""

from __future__ import annotations

from math import factorial, log

import numpy as np
from numpy.typing import NDArray

from rollnip.influence.kernel import Kernel

Array = NDArray[np.float64]


def _near_nodes(kernel: Kernel) -> float:
    """Return the number of spacings within which second differences are taken.

    At n spacings both ways err alike. The average misses 6/240 n^-4 of G, which goes as ln x. The
    differences miss n^2 times what the table misses, a polynomial of degree 5 through values,
    slopes and second derivatives at steps h of ln x: h^6/(2^6 6!) of it.
    """
    step = log(2.0) / kernel.points_per_octave
    return float((6.0 / 240.0 * 2.0**6 * factorial(6)) ** (1.0 / 6.0) / step)


def grid_displacements(kernel: Kernel, spacing: float, count: int) -> Array:
    """Displacement per unit hat, at distances -(count-1) ... count-1 spacings from its top.

    Parameters
    ----------
    kernel : influence function of one channel.
    spacing : of the grid, half the width of a hat [mm].
    count : nodes of the grid.

    Returns
    -------
    (2 count - 1,) [mm/MPa], nothing but the convolution kernel of `displacement_matrix`.
    """
    step = np.arange(1.0 - count, count)
    x, near = spacing * step, np.abs(step) <= _near_nodes(kernel)
    out = np.empty(x.size)
    integral, value, inside, outside = kernel.double_integral, kernel.value, x[near], x[~near]
    out[near] = (
        integral(inside + spacing) - 2.0 * integral(inside) + integral(inside - spacing)
    ) / spacing
    out[~near] = (spacing / 12.0) * (
        value(outside - spacing) + 10.0 * value(outside) + value(outside + spacing)
    )
    return out


def grid_strains(kernel: Kernel, spacing: float, count: int) -> Array:
    """Derivative of `grid_displacements` along x, (2 count - 1,) [1/MPa].

    Near the hat the second difference of the integral of G; far from it the difference of two
    means of G over a spacing, each by Simpson's rule.
    """
    step = np.arange(1.0 - count, count)
    x, near = spacing * step, np.abs(step) <= _near_nodes(kernel)
    out = np.empty(x.size)
    integral, value, inside, outside = kernel.integral, kernel.value, x[near], x[~near]
    out[near] = (
        integral(inside + spacing) - 2.0 * integral(inside) + integral(inside - spacing)
    ) / spacing
    half = 0.5 * spacing
    out[~near] = (
        4.0 * (value(outside + half) - value(outside - half))
        + value(outside + spacing)
        - value(outside - spacing)
    ) / 6.0
    return out
