"""Unknowns: bounds, scales, first guesses."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rollnip._errors import InvalidInputError
from rollnip.identification import Prior, Unknown
from rollnip.identification.unknowns import inner_bounds, outer_values

PATH = "materials.cover.modulus"


@given(st.floats(0.1, 50.0), st.booleans())
def test_the_coordinate_of_the_search_leads_back_to_the_value(value, log):
    one = Unknown(path=PATH, low=0.1, high=50.0, log=log)
    assert one.outer(one.inner(value)) == pytest.approx(value, rel=1e-12)


def test_rounding_never_leaves_the_bounds():
    one = Unknown(path=PATH, low=0.3, high=0.7, log=True)
    low, high = inner_bounds((one,))
    assert outer_values((one,), high + 1e-9) == {PATH: 0.7}
    assert outer_values((one,), low - 1e-9) == {PATH: 0.3}
    # an interval of what the data do not tell is as wide as can be
    assert outer_values((one,), high + 1e140) == {PATH: 0.7}


def test_the_first_guess_is_the_middle_of_the_scale():
    assert Unknown(path=PATH, low=1.0, high=100.0).first == 50.5
    assert Unknown(path=PATH, low=1.0, high=100.0, log=True).first == pytest.approx(10.0)
    assert Unknown(path=PATH, low=1.0, high=100.0, start=3.0).first == 3.0


@pytest.mark.parametrize("log", [True, False])
def test_the_slope_is_the_derivative_of_the_value(log):
    one = Unknown(path=PATH, low=1.0, high=9.0, log=log)
    z, h = one.inner(4.0), 1e-6
    assert one.slope(4.0) == pytest.approx((one.outer(z + h) - one.outer(z - h)) / (2 * h))


@pytest.mark.parametrize(
    ("given_", "said"),
    [
        ({"low": 2.0, "high": 1.0}, "lower bound below the upper one"),
        ({"low": 0.0, "high": 1.0, "log": True}, "positive bounds on a log scale"),
        ({"low": 0.0, "high": np.inf}, "finite"),
        ({"low": 0.0, "high": 1.0, "start": 2.0}, "must start between"),
    ],
)
def test_bounds_that_cannot_be(given_, said):
    with pytest.raises(InvalidInputError, match=said) as error:
        Unknown(path=PATH, **given_)
    assert PATH in str(error.value)


def test_a_prior_needs_an_error():
    with pytest.raises(InvalidInputError, match=r"prior\.standard_error"):
        Prior(1.0, 0.0)
