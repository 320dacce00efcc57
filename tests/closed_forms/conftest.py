"""What the tests of the closed forms share."""

from itertools import pairwise

import numpy as np
import pytest


def _hilbert(function, breaks, x, points=4000):
    """(1/pi) pv int f(t)/(t - x) dt by the midpoint rule in theta, t = cos(theta) on each piece.

    ``breaks``: the ends and the kinks of f, none of them at x. Root singularities at them cost
    nothing.
    """
    theta = (np.arange(points) + 0.5) * np.pi / points
    total = 0.0
    for low, high in pairwise(breaks):
        half = 0.5 * (high - low)
        t = 0.5 * (high + low) + half * np.cos(theta)
        level = 0.0
        if low < x < high:
            level = function(np.array([x]))[0]
            total += level * np.log((high - x) / (x - low))
        total += np.sum((function(t) - level) / (t - x) * np.sin(theta)) * half * np.pi / points
    return total / np.pi


@pytest.fixture(scope="session")
def hilbert():
    """Finite Hilbert transform, computed numerically."""
    return _hilbert
