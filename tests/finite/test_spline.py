"""Cubic splines against those of scipy."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from rollnip.finite._spline import Spline


def test_is_the_natural_spline():
    rng = np.random.default_rng(4)
    x = np.cumsum(rng.uniform(0.01, 1.0, 30))
    values = rng.normal(size=30)
    ours, theirs = Spline.through(x, values), CubicSpline(x, values, bc_type="natural")
    at = np.linspace(x[0], x[-1], 400)
    np.testing.assert_allclose(ours(at), theirs(at), atol=1e-10)
    np.testing.assert_allclose(ours(at, 1), theirs(at, 1), atol=1e-8)


def test_is_constant_beyond_its_points():
    ours = Spline.through(np.array([0.0, 1.0, 3.0, 4.0]), np.array([1.0, 2.0, 0.0, 5.0]))
    assert ours(np.array([-2.0, 9.0])) == pytest.approx([1.0, 5.0])
    assert ours(np.array([-2.0, 9.0]), 1) == pytest.approx([0.0, 0.0])
