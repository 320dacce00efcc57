"""Derivatives by deliberate steps, and the search from several starts."""

import numpy as np
import pytest

from rollnip._errors import InvalidInputError
from rollnip.identification import NipWidths, PeakPressures, Prior, Unknown
from rollnip.identification.forward import Forward
from rollnip.identification.search import Misfit, local_search, several_starts

from .conftest import MODULUS, tree_of

A, B = "nip.load", "nip.friction"


class Formula:
    """Predictions by a formula; None where it says so."""

    refused = "too much"

    def __init__(self, formula):
        self.formula = formula

    def predict(self, values):
        found = self.formula(*values.values())
        return None if found is None else (np.asarray(found, dtype=float),)


def misfit_of(formula, measured, *unknowns, step=0.02):
    part = NipWidths(at={}, measured=measured, standard_error=1.0)
    return Misfit(Formula(formula), unknowns, (part,), (part.errors,), step)


def test_scaling_law_of_the_derivatives_in_spite_of_the_errors_of_the_solver():
    # p = E g(F/E): the logarithmic slopes with modulus and load add up to 1.
    tree = tree_of()
    tree["solver"] = {"tolerance": 1e-3}
    part = PeakPressures(at={}, measured=[1.0], standard_error=1.0)
    unknowns = (
        Unknown(path=MODULUS, low=0.5, high=10.0, log=True),
        Unknown(path="nip.load", low=0.5, high=50.0, log=True),
    )
    misfit = Misfit(Forward(tree, (part,), {}), unknowns, (part,), (part.errors,), 0.02)
    z = np.log([2.0, 4.0])
    slopes = misfit.jacobian(z)[0] / misfit.predictions(z)[0][0]
    assert slopes.sum() == pytest.approx(1.0, abs=0.01)
    assert np.all(slopes > 0.1)


def test_derivatives_are_of_second_order_at_a_bound_too():
    one = Unknown(path=A, low=1.0, high=3.0)
    misfit = misfit_of(lambda a: [a**2, 2.0 * a], [0.0, 0.0], one)
    for a in (1.0, 2.0, 3.0):
        np.testing.assert_allclose(misfit.jacobian(np.array([a]))[:, 0], [2.0 * a, 2.0])


def test_derivatives_keep_to_the_side_that_has_solutions():
    one = Unknown(path=A, low=1.0, high=3.0)
    misfit = misfit_of(lambda a: None if a > 2.001 else [a**2], [0.0], one)
    assert misfit.jacobian(np.array([2.0]))[0, 0] == pytest.approx(4.0)


def test_the_search_leaves_places_without_solutions():
    one = Unknown(path=A, low=1.0, high=9.0)
    misfit = misfit_of(lambda a: None if a > 5.0 else [a, a**2], [4.0, 16.0], one)
    end = local_search(misfit, np.array([1.1]))
    assert end.ended[0] == pytest.approx(4.0, rel=1e-4)
    with pytest.raises(InvalidInputError, match=r"none was found at nip\.load = 8: too much"):
        local_search(misfit, np.array([8.0]))


def test_several_starts_find_the_lower_of_two_valleys():
    one = Unknown(path=A, low=-4.0, high=4.0, start=-3.0)
    # two roots of the first row; only that at +2 also suits the second
    misfit = misfit_of(lambda a: [5.0 * (a**2 - 4.0), a - 2.0], [0.0, 0.0], one)
    assert local_search(misfit, np.array([-3.0])).ended[0] == pytest.approx(-2.0, abs=0.1)
    best = several_starts(misfit, 8, 2)[0]
    assert best.ended[0] == pytest.approx(2.0, abs=1e-3)
    again = several_starts(misfit, 8, 2)[0]
    assert again.ended[0] == best.ended[0]


def test_a_prior_is_one_more_measurement():
    one = Unknown(path=A, low=0.0, high=9.0, prior=Prior(2.0, 0.5))
    misfit = misfit_of(lambda a: [a], [4.0], one)
    end = local_search(misfit, np.array([1.0]))
    # weights 1 and 1/0.25
    assert end.ended[0] == pytest.approx((4.0 + 2.0 * 4.0) / 5.0, rel=1e-4)
