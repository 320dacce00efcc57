"""A fit judged against the data: no freedom, rows that are off, misfits that run; Huber's loss."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise, permutations
from typing import Any

import numpy as np
import pytest

from rollnip.identification import LeastSquares, NipWidths, Unknown, fit_dict, fit_report, identify
from rollnip.identification.fit import fitted
from rollnip.identification.loss import bent, slope, straight
from rollnip.identification.quality import _chance_of_runs

from .conftest import LOADS, MODULUS, THICKNESS, TRUE, exact, tree_of
from .test_search import A, B, Formula

X = np.linspace(0.0, 1.0, 12)
UNKNOWNS = (Unknown(path=A, low=-10.0, high=10.0), Unknown(path=B, low=-10.0, high=10.0))
QUICK = LeastSquares(tried=0, profile=False)


def line(a: float, b: float) -> Any:
    return a + b * X


def fit_of(measured: Any, error: float | None = 0.1, loss: Any = "squares", **more: Any) -> Any:
    part = NipWidths(at={"nip.speed": X}, measured=measured, standard_error=error, **more)
    method = replace(QUICK, loss=loss)
    return fitted(Formula(line), UNKNOWNS, (part,), method, tolerance=1e-3)


def noisy(seed: int) -> Any:
    return line(1.0, 2.0) + 0.1 * np.random.default_rng(seed).standard_normal(X.size)


def test_no_degrees_of_freedom_are_said() -> None:
    """It was called noise estimated from the scatter."""
    part = NipWidths(at={}, measured=[1.0, 2.0], standard_error=0.1)
    formula = Formula(lambda a, b: [a, a + b])
    fit = fitted(formula, UNKNOWNS, (part,), QUICK, tolerance=1e-3)
    assert any("as many unknowns as measurements" in said for said in fit.warnings)
    assert (
        "No degrees of freedom: unless a bound stops it, the fit passes through the"
        in fit_report(fit)
    )
    assert "estimated from the scatter" not in fit_report(fit)


@pytest.mark.parametrize("error", [0.1, None])
def test_the_row_that_is_off_is_named(error: float | None) -> None:
    measured = noisy(3)
    measured[4] += 1.0
    names = tuple(f"widths.csv line {i + 2}" for i in range(X.size))
    (said,) = [one for one in fit_of(measured, error, rows=names).warnings if "Check it" in one]
    assert said.startswith("nip width, widths.csv line 6 (nip.speed = 0.3636): lies ")
    assert f"{measured[4]:.3f}"[:4] in said


def test_good_data_have_no_row_that_is_off() -> None:
    """The chance of a false alarm is 1 in 100; of 200 fits 7 or more would be one in 200."""
    for error in (0.1, None):
        alarms = sum(
            any("Check it" in said for said in fit_of(noisy(seed), error).warnings)
            for seed in range(200)
        )
        assert alarms < 7


def test_a_misfit_that_runs_is_said_whatever_the_standard_error() -> None:
    x = np.linspace(0.0, 1.0, 20)
    curve = 1.0 + 4.0 * x**2 + 0.02 * np.random.default_rng(1).standard_normal(x.size)
    for error in (5.0, None):
        part = NipWidths(at={"nip.speed": x}, measured=curve, standard_error=error)
        formula = Formula(lambda a, b: a + b * x)
        fit = fitted(formula, UNKNOWNS, (part,), QUICK, tolerance=1e-3)
        assert any("do not scatter but run along nip.speed" in said for said in fit.warnings)
    assert not any("run along" in said for said in fit_of(noisy(0)).warnings)


def test_runs_against_all_orders() -> None:
    """All 70 orders of four signs of each kind, counted."""
    orders = set(permutations("++++----"))
    for runs in range(2, 9):
        few = sum(1 + sum(a != b for a, b in pairwise(o)) <= runs for o in orders)
        assert _chance_of_runs(runs, 4, 4) == pytest.approx(few / len(orders))


def test_a_fit_far_off_the_values_is_said() -> None:
    """With the noise estimated nothing said so: the scatter was taken for noise."""
    rough = 3.0 + np.where(np.arange(X.size) % 2, 0.8, -0.8)
    said = " ".join(fit_of(rough, None).warnings)
    assert "the fit is 25 % of the values off" in said
    assert "explains" in said
    assert not any("of the values" in one for one in fit_of(noisy(0), None).warnings)


def test_errors_of_predictions_of_a_straight_line() -> None:
    # sigma sqrt(1/n + (x - mean)^2 / sum (x - mean)^2): the band of a regression line
    fit = fit_of(noisy(0))
    off = X - X.mean()
    expected = 0.1 * np.sqrt(1.0 / X.size + off**2 / np.sum(off**2))
    assert fit.sets[0].prediction_error == pytest.approx(expected, rel=1e-6)
    assert fit_dict(fit)["sets"][0]["prediction_error"] == pytest.approx(expected.tolist())


def test_what_a_loss_bends_it_straightens() -> None:
    r = np.linspace(-30.0, 30.0, 401)
    assert straight(bent(r, "huber"), "huber") == pytest.approx(r)
    numeric = np.gradient(bent(r, "huber"), r)
    smooth = np.abs(np.abs(r) - 1.345) > 0.4
    assert slope(r, "huber")[smooth] == pytest.approx(numeric[smooth], abs=3e-3)
    assert np.array_equal(bent(r, "squares"), r)


@pytest.mark.parametrize("error", [0.1, None])
def test_wrong_values_do_little_to_hubers_loss(error: float | None) -> None:
    """Two of twelve values wrong by 30 standard errors: the slope stays; its interval holds."""
    off: dict[Any, list[float]] = {"squares": [], "huber": []}
    held = 0
    for seed in range(60):
        measured = noisy(seed)
        measured[[9, 10]] += 3.0
        for loss, found in off.items():
            fit = fit_of(measured, error, loss)
            found.append(fit[B].value - 2.0)
            held += loss == "huber" and fit[B].low <= 2.0 <= fit[B].high
    assert np.mean(off["squares"]) > 1.5
    assert abs(np.mean(off["huber"])) < 0.5
    fit = fit_of(measured, error, "huber")
    assert "Huber's loss: " in fit_report(fit)
    assert fit.probability is None
    assert held > 30


def test_without_wrong_values_hubers_intervals_hold_the_truth() -> None:
    held = 0
    for seed in range(300):
        one = fit_of(noisy(seed), 0.1, "huber")[B]
        held += one.low <= 2.0 <= one.high
    assert 265 <= held <= 298  # 95 % of 300, and a little less as with so few values


def test_widths_with_a_wrong_thickness_look_right() -> None:
    """What the page says: the modulus is off, and nothing in the fit shows it."""
    blank = NipWidths(at={"nip.load": LOADS}, measured=np.ones(5), standard_error=0.1)
    (widths,) = exact(tree_of(), TRUE, blank)
    widths = replace(widths, standard_error=0.01 * widths.values)
    wrong = tree_of()
    wrong["upper"]["layers"][0]["thickness"] = 0.9 * TRUE[THICKNESS]
    unknown = Unknown(path=MODULUS, low=0.5, high=8.0, log=True)
    fit = identify(wrong, [unknown], widths, LeastSquares(tried=0, profile=False))
    ratio = fit[MODULUS].value / TRUE[MODULUS]
    assert fit.probability is not None
    assert fit.probability > 0.2
    assert not any("Check" in said or "do not scatter" in said for said in fit.warnings)
    assert ratio == pytest.approx(0.94, abs=0.01)
    assert fit[MODULUS].high < 0.98 * TRUE[MODULUS]
