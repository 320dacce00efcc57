"""Strains and velocities along a surface find the modulus that made them."""

import numpy as np
import pytest

import rollnip as rn
from rollnip.identification import LeastSquares, Strains, Unknown, Velocities, identify
from rollnip.io import parse_case
from rollnip.lda import profile_from_means, surface_speed

from .conftest import MODULUS, tree_of

X = np.linspace(-9.0, 9.0, 25)
TREE = tree_of(traction=0.5, speed=100.0)
UNKNOWN = (Unknown(path=MODULUS, low=1.5, high=3.0, log=True),)
METHOD = LeastSquares(tried=0, profile=False)


@pytest.fixture(scope="module")
def solved():
    case = parse_case(TREE)
    return rn.solve(case.nip, case.model)


def test_strain_is_that_of_the_solution(solved):
    one = Strains(x=X, measured=np.ones(X.size))
    profiles = solved.profiles
    expected = np.interp(X, profiles.x, profiles.strain_upper)
    np.testing.assert_allclose(one.predict([solved]), expected, atol=1e-12)


def test_strains_tell_the_modulus(solved):
    strain = Strains(x=X, measured=np.ones(X.size)).predict([solved])
    noise = 0.002 * np.random.default_rng(1).standard_normal(X.size)
    cost = Strains(x=X, measured=strain + noise, standard_error=0.002)
    fit = identify(TREE, UNKNOWN, cost, METHOD)
    one = fit[MODULUS]
    assert abs(one.value - 2.0) < 3.0 * one.standard_error < 0.3


def test_velocities_tell_the_modulus_whatever_the_shift_and_the_speed(solved):
    profile, _ = surface_speed(solved, "upper")
    noise = 0.2 * np.random.default_rng(2).standard_normal(X.size)
    measured = 1.01 * profile.at(X) + noise
    cost = Velocities(profile=profile_from_means(X + 0.3, measured, np.full(X.size, 0.2)))
    fit = identify(TREE, UNKNOWN, cost, METHOD)
    one = fit[MODULUS]
    assert abs(one.value - 2.0) < 3.0 * one.standard_error < 0.3
    # 25 values less modulus, shift and speed
    assert fit.degrees == 22
