"""Intervals hold the true values as often as they say: 95 of 100 simulated measurements."""

import numpy as np
import pytest

from rollnip.identification import LeastSquares, NipWidths, RollingResistances, Unknown, identify
from rollnip.identification.fit import fitted

from .conftest import (
    TRUE,
    UNKNOWNS,
    Interpolated,
    exact,
    noisy,
    tree_of,
    widths_and_approaches,
)

SEEDS = 200
# Of 200 with probability 0.95 each, between 183 and 196 hold in 97 of 100 repetitions.
FEWEST, MOST = 183, 196
METHOD = LeastSquares(tried=4, followed=1)


def held(predictor, unknowns, truth, parts, *, known, tolerance=1e-2):
    """Of 200 fits, those whose covariance and whose profile interval holds each true value."""
    count = np.zeros((2, len(unknowns)), dtype=int)
    for seed in range(SEEDS):
        data = noisy(parts, 0.01, np.random.default_rng(seed), known=known)
        fit = fitted(predictor, unknowns, data, METHOD, tolerance=tolerance)
        for j, one in enumerate(fit.estimates):
            count[0, j] += one.low <= truth[one.path] <= one.high
            count[1, j] += one.profile[0] <= truth[one.path] <= one.profile[1]
    return count


@pytest.mark.slow
def test_interpolation_is_far_closer_than_the_noise(elastic):
    rng = np.random.default_rng(5)
    for _ in range(5):
        z = rng.random(2)
        values = {
            u.path: u.outer(u.inner(u.low) + s * (u.inner(u.high) - u.inner(u.low)))
            for u, s in zip(UNKNOWNS, z, strict=True)
        }
        solved = np.concatenate(elastic.forward.predict(values))
        np.testing.assert_allclose(np.concatenate(elastic.predict(values)), solved, rtol=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize("known", [True, False], ids=["errors given", "errors estimated"])
def test_modulus_and_thickness_of_a_cover(elastic, known):
    parts = exact(tree_of(), TRUE, *widths_and_approaches())
    count = held(elastic, UNKNOWNS, TRUE, parts, known=known)
    assert np.all((count >= FEWEST) & (count <= MOST)), count


@pytest.mark.slow
def test_relaxation_of_a_cover_from_its_rolling_resistance():
    base = "materials.cover"
    material = {
        "model": "standard-linear-solid",
        "modulus": 2.0,
        "stiffening": 1.5,
        "relaxation_time": 5e-3,
        "poisson": 0.5,
    }
    tree = tree_of(material, speed=100.0)
    truth = {f"{base}.stiffening": 1.5, f"{base}.relaxation_time": 5e-3}
    unknowns = (
        Unknown(path=f"{base}.stiffening", low=1.2, high=1.9, log=True),
        Unknown(path=f"{base}.relaxation_time", low=4e-3, high=6.3e-3, log=True),
    )
    speeds = {"nip.speed": [100.0, 500.0, 2500.0, 10000.0]}
    blank = (
        RollingResistances(at=speeds, measured=np.ones(4)),
        NipWidths(at=speeds, measured=np.ones(4)),
    )
    predictor = Interpolated(tree, blank, unknowns, 4)
    count = held(predictor, unknowns, truth, exact(tree, truth, *blank), known=True)
    assert np.all((count >= FEWEST) & (count <= MOST)), count


def test_a_fit_by_solving_nips_holds_the_truth():
    parts = exact(tree_of(), TRUE, *widths_and_approaches())
    data = noisy(parts, 0.01, np.random.default_rng(11))
    method = LeastSquares(tried=0, profile=False)
    fit = identify(tree_of(), UNKNOWNS, data[0] + data[1], method)
    assert fit.verified
    assert not fit.warnings
    for one in fit.estimates:
        # four standard errors: this one seed must not fail by chance
        assert abs(one.value - TRUE[one.path]) < 4.0 * one.standard_error
        assert one.standard_error < 0.05 * one.value
