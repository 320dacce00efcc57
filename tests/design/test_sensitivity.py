"""Shares of the variance against functions whose shares are known."""

from math import pi

import numpy as np
import pytest

from rollnip._errors import InvalidInputError
from rollnip.design.sensitivity import regression, sobol_places, sobol_shares


def ishigami(x, a=7.0, b=0.1):
    return np.sin(x[:, 0]) + a * np.sin(x[:, 1]) ** 2 + b * x[:, 2] ** 4 * np.sin(x[:, 0])


def ishigami_shares(a=7.0, b=0.1):
    """Sobol & Levitan (1999): partial variances of the Ishigami function."""
    one = 0.5 * (1.0 + b * pi**4 / 5.0) ** 2
    two = a**2 / 8.0
    both = 8.0 * b**2 * pi**8 / 225.0  # of x1 and x3 together
    whole = one + two + both
    first = np.array([one, two, 0.0]) / whole
    return first, first + np.array([both, 0.0, both]) / whole


def shares(count, *, seed=0):
    places = sobol_places(count, 3, seed)
    return sobol_shares(ishigami(pi * (2.0 * places - 1.0)), count, confidence=0.95, seed=seed)


def test_the_ishigami_function():
    first, total = ishigami_shares()
    assert first == pytest.approx([0.3139, 0.4424, 0.0], abs=1e-4)
    found = shares(4096)
    np.testing.assert_allclose(found.first, first, atol=0.02)
    np.testing.assert_allclose(found.total, total, atol=0.02)


def test_the_intervals_hold_what_is_true():
    first, total = ishigami_shares()
    held = []
    for seed in range(20):
        found = shares(128, seed=seed)
        held += [
            *((found.first_low <= first) & (first <= found.first_high)),
            *((found.total_low <= total) & (total <= found.total_high)),
        ]
    # 95 % wanted of 120; low-discrepancy points scatter less than the bootstrap thinks
    assert np.mean(held) >= 0.92
    assert found.first_of(1) == (found.first[1], found.first_low[1], found.first_high[1])


def test_one_parameter_has_it_all():
    places = sobol_places(64, 1, 0)
    found = sobol_shares(places[:, 0], 64, confidence=0.9, seed=0)
    assert found.first == pytest.approx([1.0], abs=0.05)
    assert found.total == pytest.approx([1.0], abs=0.05)


def test_the_places_are_two_samples_and_their_mixtures():
    places = sobol_places(8, 2, 3)
    a, b, first, second = places.reshape(4, 8, 2)
    np.testing.assert_array_equal(first, np.column_stack([b[:, 0], a[:, 1]]))
    np.testing.assert_array_equal(second, np.column_stack([a[:, 0], b[:, 1]]))
    np.testing.assert_array_equal(places, sobol_places(8, 2, 3))


@pytest.mark.parametrize("count", [0, 4, 100, 2**17])
def test_counts_that_are_no_power_of_two(count):
    with pytest.raises(InvalidInputError, match="`sobol` must be a power of two from 8 to 65536"):
        sobol_places(count, 2, 0)


def test_the_regression_of_a_plane_is_exact():
    x = np.random.default_rng(0).normal(size=(50, 2)) * [1.0, 10.0]
    found = regression(x, 3.0 * x[:, 0] - 0.4 * x[:, 1] + 7.0)
    assert found.explained == pytest.approx(1.0)
    spread = (3.0 * x[:, 0] - 0.4 * x[:, 1]).std()
    expected = np.array([3.0, -0.4]) * x.std(axis=0) / spread
    np.testing.assert_allclose(found.coefficients, expected, rtol=1e-9)


def test_the_regression_of_a_bowl_says_that_it_explains_nothing():
    x = np.linspace(-1.0, 1.0, 101)[:, None]
    assert regression(x, x[:, 0] ** 2).explained == pytest.approx(0.0, abs=1e-9)


def test_a_result_that_does_not_change_has_no_shares():
    x = np.linspace(-1.0, 1.0, 11)[:, None]
    assert regression(x, np.full(11, 2.0)).coefficients == 0.0
