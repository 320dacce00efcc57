"""Distributions in base units, and samples that have what they should."""

import numpy as np
import pytest
from scipy.stats import norm, uniform

from rollnip._errors import InvalidInputError
from rollnip.design import Correlation, LogNormal, Normal, Triangular, Uniform
from rollnip.design.distributions import frozen, hypercube, score_matrix


def test_texts_are_read_in_their_units():
    one = frozen(Normal("2 mm", "50 um"), "length")
    assert (one.mean(), one.std()) == pytest.approx((2.0, 0.05))
    assert frozen(Uniform("1 mm", "0.2 in"), "length").support() == pytest.approx((1.0, 5.08))
    peak = frozen(Triangular(1.0, 2.0, 5.0), "length")
    assert (peak.support(), peak.mean()) == ((1.0, 5.0), pytest.approx(8.0 / 3.0))
    skew = frozen(LogNormal("2 MPa", "10 %"), "pressure")
    assert skew.median() == pytest.approx(2.0)
    assert np.std(np.log(skew.ppf(np.linspace(0.001, 0.999, 999)))) == pytest.approx(0.1, rel=0.02)


def test_the_deviation_of_a_temperature_is_a_difference():
    one = frozen(Normal("73.4 degF", "2 K"), "temperature")
    assert (one.mean(), one.std()) == pytest.approx((23.0, 2.0))


def test_one_sample_in_each_stratum():
    sample = hypercube([norm(5.0, 2.0), uniform()], 50, None, 7)
    strata = np.floor(50.0 * norm(5.0, 2.0).cdf(sample[:, 0]))
    assert sorted(strata) == list(range(50))
    assert sorted(np.floor(50.0 * sample[:, 1])) == list(range(50))
    np.testing.assert_array_equal(sample, hypercube([norm(5.0, 2.0), uniform()], 50, None, 7))
    assert not np.array_equal(sample, hypercube([norm(5.0, 2.0), uniform()], 50, None, 8))


@pytest.mark.parametrize("coefficient", [-0.9, 0.3, 0.8])
def test_correlated_samples_keep_their_strata(coefficient):
    scores = score_matrix(("a", "b"), [Correlation("b", "a", coefficient)])
    sample = hypercube([norm(), norm(3.0, 0.1)], 2000, scores, 0)
    assert np.corrcoef(sample.T)[0, 1] == pytest.approx(coefficient, abs=0.03)
    strata = np.floor(2000.0 * norm(3.0, 0.1).cdf(sample[:, 1]))
    assert sorted(strata) == list(range(2000))


@pytest.mark.parametrize(
    ("distribution", "message"),
    [
        (Normal(2.0, 0.0), "`deviation` must be positive, got 0.0"),
        (Normal(2.0, "-1 mm"), "`deviation` must be positive"),
        (Normal("2 N", 0.1), "`mean` must be a length"),
        (Normal(float("nan"), 0.1), "`mean` must be a finite number"),
        (Uniform(2.0, 2.0), "`low` must be below `high`, got 2.0 and 2.0"),
        (Triangular(1.0, 3.0, 2.0), "`mode` must lie between low and high"),
        (LogNormal(-1.0, 0.1), "`median` must be positive"),
        (LogNormal(1.0, "1 mm"), "`spread` must be a plain number"),
    ],
)
def test_wrong_distributions(distribution, message):
    with pytest.raises(InvalidInputError, match=message):
        frozen(distribution, "length")


@pytest.mark.parametrize(
    ("pairs", "message"),
    [
        ([("a", "x", 0.5)], "`between` must name parameters that vary, got x"),
        ([("a", "b", 0.5), ("b", "a", 0.5)], "must not hold b and a twice"),
        ([("a", "b", 0.9), ("b", "c", 0.9), ("a", "c", -0.9)], "cannot hold together"),
    ],
)
def test_wrong_correlations(pairs, message):
    with pytest.raises(InvalidInputError, match=message):
        score_matrix(("a", "b", "c"), [Correlation(*pair) for pair in pairs])


def test_wrong_coefficients():
    with pytest.raises(
        InvalidInputError, match=r"`coefficient` must lie between -1 and 1, got 1\.0"
    ):
        Correlation("a", "b", 1.0)
    with pytest.raises(InvalidInputError, match="got a twice"):
        Correlation("a", "a", 0.5)
