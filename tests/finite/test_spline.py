"""Splines of third and fifth degree against those of scipy."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline, make_interp_spline

from rollnip.finite._spline import Spline

_NATURAL = [(3, 0.0), (4, 0.0)]


def test_is_the_natural_spline():
    rng = np.random.default_rng(4)
    x = np.cumsum(rng.uniform(0.01, 1.0, 30))
    values = rng.normal(size=30)
    ours, theirs = Spline.natural_cubic(x, values), CubicSpline(x, values, bc_type="natural")
    at = np.linspace(x[0], x[-1], 400)
    np.testing.assert_allclose(ours(at), theirs(at), atol=1e-10)
    np.testing.assert_allclose(ours(at, 1), theirs(at, 1), atol=1e-8)


@pytest.mark.parametrize("shortest", [0.001, 0.1])
def test_is_the_natural_spline_of_fifth_degree(shortest: float):
    rng = np.random.default_rng(4)
    x = np.cumsum(10.0 ** rng.uniform(np.log10(shortest), 0.0, 30))
    values = rng.normal(size=30)
    ours, theirs = (
        Spline.natural_quintic(x, values),
        make_interp_spline(x, values, k=5, bc_type=(_NATURAL,) * 2),
    )
    at = np.linspace(x[0], x[-1], 400)
    most, steepest = np.abs(theirs(at)).max(), np.abs(theirs(at, 1)).max()
    np.testing.assert_allclose(ours(at), theirs(at), atol=1e-9 * most)
    np.testing.assert_allclose(ours(at, 1), theirs(at, 1), atol=1e-9 * steepest)


def test_a_mean_is_that_of_the_functions():
    x, other = np.linspace(0.0, 3.0, 13), np.linspace(0.0, 3.0, 9)
    one, two = Spline.natural_cubic(x, np.sin(x)), Spline.natural_cubic(x, x**2)
    at = np.linspace(0.0, 3.0, 50)
    both = Spline.weighted_sum(np.array([0.3, 0.7]), [one, two])
    np.testing.assert_allclose(both(at, 1), 0.3 * one(at, 1) + 0.7 * two(at, 1), atol=1e-12)
    elsewhere = Spline.weighted_sum(np.array([1.0, 0.0]), [one, Spline.natural_cubic(other, other)])
    np.testing.assert_allclose(elsewhere(other), one(other), atol=1e-12)


def test_is_constant_beyond_its_points():
    ours = Spline.natural_cubic(np.array([0.0, 1.0, 3.0, 4.0]), np.array([1.0, 2.0, 0.0, 5.0]))
    assert ours(np.array([-2.0, 9.0])) == pytest.approx([1.0, 5.0])
    assert ours(np.array([-2.0, 9.0]), 1) == pytest.approx([0.0, 0.0])
