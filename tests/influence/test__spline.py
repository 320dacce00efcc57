"""Splines on an even grid against those of scipy."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from rollnip.influence._spline import even_splines


@pytest.mark.parametrize("count", [4, 5, 64])
def test_those_of_scipy(count):
    """Values and slopes between the points and on a little beyond them."""
    x = np.linspace(-3.0, 5.0, count)
    values = np.random.default_rng(count).normal(size=(2, count))
    places = np.linspace(-3.2, 5.3, 401)
    for spline, column in zip(even_splines(x, values), values, strict=True):
        exact = CubicSpline(x, column)
        np.testing.assert_allclose(spline(places), exact(places), rtol=1e-10, atol=1e-11)
        np.testing.assert_allclose(spline(places, 1), exact(places, 1), rtol=1e-10, atol=1e-10)


def test_a_cubic_is_itself():
    x = np.linspace(0.0, 2.0, 9)
    (spline,) = even_splines(x, (x**3 - x)[None])
    places = np.array([[0.0, 0.3], [1.1, 2.0]])
    np.testing.assert_allclose(spline(places), places**3 - places, rtol=0.0, atol=1e-14)
    np.testing.assert_allclose(spline(places, 1), 3.0 * places**2 - 1.0, rtol=0.0, atol=1e-13)
