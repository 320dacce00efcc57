"""What a fit does not tell is said."""

import numpy as np
import pytest

from rollnip._errors import InvalidInputError
from rollnip.identification import (
    Approaches,
    LeastSquares,
    NipWidths,
    Prior,
    Unknown,
    identify,
)
from rollnip.identification.fit import fitted

from .conftest import MODULUS, THICKNESS, TRUE, exact, tree_of
from .test_search import A, B, Formula

X = np.linspace(0.0, 1.0, 9)
QUICK = LeastSquares(tried=4, followed=2)


def fit_of(formula, measured, *unknowns, error=0.1, tolerance=1e-3, method=QUICK):
    part = NipWidths(at={}, measured=measured, standard_error=error)
    return fitted(Formula(formula), unknowns, (part,), method, tolerance=tolerance)


def one(path, low=-10.0, high=10.0, **more):
    return Unknown(path=path, low=low, high=high, **more)


def test_a_good_fit_is_not_warned_of():
    noise = 0.1 * np.random.default_rng(0).standard_normal(9)
    fit = fit_of(lambda a, b: a + b * X, 1.0 + 2.0 * X + noise, one(A), one(B))
    assert fit.warnings == ()


def test_twins_are_named():
    fit = fit_of(lambda a, b: (a + b) * X + 0.01 * b, 2.0 * X, one(A), one(B))
    assert any("hardly tell `nip.load` from `nip.friction`" in said for said in fit.warnings)
    assert abs(fit.correlation[0, 1]) > 0.98


def test_a_combination_of_three_is_named():
    third = one("nip.speed")
    fit = fit_of(lambda a, b, c: (a + b + c) * X, 2.0 * X, one(A), one(B), third)
    assert any("combination of" in s or "hardly tell" in s for s in fit.warnings)
    assert fit.singular_values[1] < 1e-6 * fit.singular_values[0]


def test_an_unknown_without_effect_is_named():
    fit = fit_of(lambda a, b: a * (1.0 + X), 1.0 + X, one(A, 0.1), one(B))
    assert any("No prediction changes with `nip.friction`" in said for said in fit.warnings)


def test_a_bound_is_named():
    fit = fit_of(lambda a: a * X, 5.0 * X, one(A, 0.0, 3.0))
    assert fit[A].bound == "high"
    assert any("ended at its upper bound 3" in said for said in fit.warnings)
    assert fit[A].open_ends[1]


def test_errors_that_are_too_small_widen_the_intervals():
    noise = 0.5 * np.random.default_rng(1).standard_normal(9)
    fit = fit_of(lambda a: a * (1 + X), 1.0 + X + noise, one(A), error=0.05)
    assert fit.probability < 1e-6
    assert fit.widened == pytest.approx(np.sqrt(fit.chi_square / 8))
    assert any("further from the fit" in said for said in fit.warnings)
    better = fit_of(lambda a: a * (1 + X), 1.0 + X + noise, one(A), error=0.5)
    assert fit[A].standard_error == pytest.approx(
        better[A].standard_error * np.sqrt(better.chi_square / 8), rel=1e-3
    )


def test_errors_that_are_too_large_are_named():
    fit = fit_of(lambda a: a * (1 + X), 1.0 + X, one(A), error=10.0)
    assert any("closer to the fit" in said for said in fit.warnings)


def test_two_valleys_are_named():
    method = LeastSquares(tried=20, followed=12)
    fit = fit_of(lambda a: [a**2], [4.0], one(A, -5.0, 5.0), method=method)
    assert any("Another set of values fits nearly as well" in said for said in fit.warnings)


def test_a_prior_ends_the_doubt():
    unknowns = (one(A), one(B, prior=Prior(1.0, 0.1)))
    fit = fit_of(lambda a, b: (a + b) * (1 + X), 3.0 * (1 + X), *unknowns)
    assert fit[A].value == pytest.approx(2.0, abs=1e-3)
    assert fit[B].standard_error == pytest.approx(0.1, rel=0.01)


def test_weights_leave_profiles_out():
    part = NipWidths(at={}, measured=[1.0, 2.0], standard_error=0.1)
    fit = fitted(Formula(lambda a: [a, 2 * a]), (one(A),), (2 * part).parts, QUICK, tolerance=1e-3)
    assert fit[A].profile is None


def test_nip_widths_alone_hardly_tell_modulus_from_thickness():
    # over a narrow range of loads; with approaches they are told apart
    loads = {"nip.load": [4.0, 5.0, 6.0]}
    blank = (
        NipWidths(at=loads, measured=np.ones(3), standard_error=0.1),
        Approaches(at=loads, measured=np.ones(3), standard_error=0.002),
    )
    widths, approaches = exact(tree_of(), TRUE, *blank)
    unknowns = (
        Unknown(path=MODULUS, low=1.0, high=4.0, start=2.0, log=True),
        Unknown(path=THICKNESS, low=5.0, high=13.0, start=8.0, log=True),
    )
    method = LeastSquares(tried=0, profile=False)
    alone = identify(tree_of(), unknowns, widths, method)
    both = identify(tree_of(), unknowns, widths + approaches, method)
    assert any("hardly tell" in said for said in alone.warnings)
    assert alone[MODULUS].standard_error > 3.0 * both[MODULUS].standard_error


@pytest.mark.parametrize(
    ("unknowns", "cost", "said"),
    [
        ((), NipWidths(at={}, measured=[1.0]), "at least one unknown"),
        ((one("nip.lod"),), NipWidths(at={}, measured=[1.0]), "nip.lod"),
        ((one("title"),), NipWidths(at={}, measured=[1.0]), "number of the case"),
        ((one(A, 1.0), one(A, 1.0)), NipWidths(at={}, measured=[1.0] * 3), "once only"),
        ((one(A, 1.0),), NipWidths(at={A: 1.0}, measured=[1.0]), "must not be an unknown"),
        (
            (one(A, 1.0), one(MODULUS, 1.0)),
            NipWidths(at={}, measured=[1.0]),
            "2 unknowns, 1 measurements",
        ),
        ((one(A, 1.0, 9.0),), NipWidths(at={"nip.frction": 1.0}, measured=[1.0]), "nip.frction"),
        ((one(A, 1.0, 9.0),), NipWidths(at={}, measured=[1.0]), "too few to estimate it"),
    ],
)
def test_what_cannot_be_fitted_is_refused(unknowns, cost, said):
    with pytest.raises(InvalidInputError, match=said):
        identify(tree_of(), unknowns, cost, LeastSquares(tried=0, profile=False))


@pytest.mark.parametrize(
    "wrong", [{"tried": -1}, {"followed": 0}, {"step": 1e-8}, {"confidence": 1.0}]
)
def test_a_method_out_of_range_is_refused(wrong):
    with pytest.raises(InvalidInputError, match=next(iter(wrong))):
        LeastSquares(**wrong)
