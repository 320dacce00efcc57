import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rollnip._errors import InvalidInputError
from rollnip.lda import SpeedProfile


def test_a_straight_profile_is_its_own_average():
    line = SpeedProfile(np.array([-1.0, 0.3, 2.0]), np.array([1.0, 2.3, 4.0]))
    x = np.linspace(-0.5, 1.5, 7)
    assert line.averaged(x, 0.2) == pytest.approx(x + 2.0, abs=1e-12)


@given(width=st.floats(0.01, 0.3))
def test_a_curved_profile_is_biased_by_half_the_curvature_times_the_variance(width):
    x = np.linspace(-3.0, 3.0, 1501)
    parabola = SpeedProfile(x, 100.0 + 5.0 * x**2)
    bias = parabola.averaged(np.zeros(1), width)[0] - 100.0
    # half of v'' = 10; the chords lie above by 10 h^2/12
    assert bias == pytest.approx(5.0 * width**2 + 10.0 * 0.004**2 / 12.0, rel=1e-6)


def test_the_average_is_that_of_a_quadrature():
    rng = np.random.default_rng(3)
    profile = SpeedProfile(np.linspace(-2.0, 2.0, 41), rng.normal(100.0, 5.0, 41))
    nodes, weights = np.polynomial.hermite_e.hermegauss(180)
    by_rule = np.sum(weights * profile.at(0.13 + 0.1 * nodes)) / np.sum(weights)
    assert profile.averaged(np.array([0.13]), 0.1)[0] == pytest.approx(by_rule, rel=1e-3)


def test_a_volume_of_no_length_reads_the_profile():
    profile = SpeedProfile(np.array([0.0, 1.0, 3.0]), np.array([0.0, 2.0, 2.0]))
    x = np.array([0.5, 2.0])
    assert profile.averaged(x, 0.0) == pytest.approx(profile.averaged(x, 1e-6), abs=1e-5)


def test_places_outside_are_refused():
    profile = SpeedProfile(np.array([-1.0, 1.0]), np.array([1.0, 1.0]))
    profile.check_inside(np.array([0.4]), 0.1)
    with pytest.raises(InvalidInputError, match="inside the solution"):
        profile.check_inside(np.array([0.6]), 0.1)


@pytest.mark.parametrize("x", [[0.0], [0.0, 0.0], [1.0, 0.0]])
def test_refuses_what_is_no_profile(x):
    with pytest.raises(InvalidInputError, match="`x`"):
        SpeedProfile(np.array(x), np.ones(len(x)))
