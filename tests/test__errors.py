import pickle
from decimal import Decimal
from fractions import Fraction
from math import inf, nan

import numpy as np
import pytest

from rollnip._errors import (
    CaseFileError,
    ConvergenceError,
    InvalidInputError,
    RollnipError,
    require_finite,
    require_not_negative,
    require_positive,
)


@pytest.mark.parametrize("kind", [CaseFileError, ConvergenceError, InvalidInputError])
def test_one_tree(kind):
    assert issubclass(kind, RollnipError)


def test_wrong_input_is_a_value_error():
    assert issubclass(InvalidInputError, ValueError)


@pytest.mark.parametrize("check", [require_positive, require_not_negative, require_finite])
@pytest.mark.parametrize(
    "value",
    [nan, inf, -inf, None, "1", b"1", True, [1.0], np.True_, np.complex64(1.0), np.array([1, 2])],
)
def test_what_is_not_a_finite_number_is_refused(check, value):
    with pytest.raises(InvalidInputError, match=r"^`thickness` must be .*, got "):
        check("thickness", value)


def test_signs():
    require_positive("x", 1e-300)
    require_not_negative("x", 0)
    require_finite("x", -1)
    require_finite("x", np.float64(2.0))
    with pytest.raises(InvalidInputError):
        require_positive("x", 0.0)
    with pytest.raises(InvalidInputError):
        require_not_negative("x", -1e-300)


@pytest.mark.parametrize("check", [require_positive, require_not_negative, require_finite])
@pytest.mark.parametrize(
    "value", [3, np.uint8(3), np.float16(3), np.array(3), Decimal(3), Fraction(3)]
)
def test_numbers_of_any_type_come_back_as_floats(check, value):
    number = check("x", value)
    assert type(number) is float
    assert number == 3.0


def test_convergence_error_carries_the_last_solution():
    assert ConvergenceError("no", solution="last").solution == "last"
    assert str(pickle.loads(pickle.dumps(ConvergenceError("no")))) == "no"
