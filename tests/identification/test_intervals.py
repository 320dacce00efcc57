"""Intervals where the answer is known: straight lines, and curves of one unknown."""

import numpy as np
import pytest

from rollnip.identification import NipWidths, Unknown
from rollnip.identification.intervals import covariance, profile_ends
from rollnip.identification.noise import estimated_noise, first_noise
from rollnip.identification.search import Misfit, local_search

from .test_search import A, B, Formula, misfit_of

X = np.linspace(0.0, 1.0, 9)


def line(a, b):
    return a + b * X


def wide(path):
    return Unknown(path=path, low=-100.0, high=100.0)


def test_covariance_of_a_straight_line():
    misfit = misfit_of(line, 1.0 + 2.0 * X, wide(A), wide(B))
    best = local_search(misfit, np.zeros(2))
    design = np.stack([np.ones(9), X], axis=1)
    expected = np.linalg.inv(design.T @ design)
    np.testing.assert_allclose(covariance(best.jacobian, np.ones(9)), expected, rtol=1e-6)


def test_weights_make_no_knowledge():
    # All rows with the weight 4: as many standard errors off, and no more is known than before.
    misfit = misfit_of(line, 1.0 + 2.0 * X, wide(A), wide(B))
    best = local_search(misfit, np.zeros(2))
    plain = covariance(best.jacobian, np.ones(9))
    np.testing.assert_allclose(covariance(2.0 * best.jacobian, np.full(9, 4.0)), plain)


def test_profiles_of_a_straight_line_are_the_covariance():
    misfit = misfit_of(line, 1.0 + 2.0 * X, wide(A), wide(B))
    best = local_search(misfit, np.zeros(2))
    spread = covariance(best.jacobian, np.ones(9))
    for index in range(2):
        ends = profile_ends(misfit, best, spread, index, 1.96)
        reach = 1.96 * np.sqrt(spread[index, index])
        assert [e.coordinate - best.ended[index] for e in ends] == pytest.approx(
            [-reach, reach], rel=0.02
        )
        assert not any(e.is_bound for e in ends)


def test_profile_of_a_curve_is_where_the_sum_of_squares_has_risen():
    # one unknown: the interval of exp(a) = 3 +- 1.96 is that of a, exactly
    misfit = misfit_of(lambda a: [np.exp(a)], [3.0], Unknown(path=A, low=-3.0, high=3.0))
    best = local_search(misfit, np.array([0.5]))
    spread = covariance(best.jacobian, np.ones(1))
    low, high = profile_ends(misfit, best, spread, 0, 1.96)
    reach = [3.0 - np.exp(low.coordinate), np.exp(high.coordinate) - 3.0]
    assert reach == pytest.approx([1.96, 1.96], rel=0.011)


def test_an_interval_that_the_data_leave_open_ends_at_the_bound():
    # above 1 the prediction no longer changes
    misfit = misfit_of(lambda a: [min(a, 1.0)], [0.8], Unknown(path=A, low=-50.0, high=4.0))
    best = local_search(misfit, np.array([0.0]))
    spread = covariance(best.jacobian, np.ones(1))
    low, high = profile_ends(misfit, best, spread, 0, 1.0)
    assert not low.is_bound
    assert high.is_bound
    assert high.coordinate == 4.0


def test_estimated_noise_is_unbiased():
    # mean of s^2 over seeds: RSS/(n - 2) for a straight line
    found = []
    for seed in range(200):
        noise = 0.3 * np.random.default_rng(seed).standard_normal(9)
        part = NipWidths(at={}, measured=1.0 + 2.0 * X + noise)
        first = first_noise([part])
        misfit = Misfit(Formula(line), (wide(A), wide(B)), (part,), first.errors, 0.02)
        best = local_search(misfit, np.zeros(2))
        second = estimated_noise([part], first, best)
        found.append(second.errors[0][0] ** 2)
        assert second.degrees == pytest.approx(7.0)
    # standard error of the mean: 0.09 sqrt(2/7/200)
    assert np.mean(found) == pytest.approx(0.09, abs=4 * 0.09 * np.sqrt(2 / 7 / 200))
