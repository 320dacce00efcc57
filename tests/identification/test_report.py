"""Reports: numbers with the digits that are known, JSON that is finite, a case that reads."""

import json

import numpy as np
import pytest

from rollnip.identification import (
    LeastSquares,
    NipWidths,
    Unknown,
    fit_case,
    fit_dict,
    fit_report,
    identify,
    plot_fit,
    plot_residuals,
    plot_set,
)
from rollnip.io import parse_case
from rollnip.plots import save_figure

from .conftest import MODULUS, exact, tree_of

LOADS = {"nip.load": [2.0, 4.0, 8.0]}


@pytest.fixture(scope="module")
def fit():
    (part,) = exact(tree_of(), {MODULUS: 2.0}, NipWidths(at=LOADS, measured=np.ones(3)))
    data = NipWidths(
        at=LOADS,
        measured=part.values + np.array([0.05, -0.1, 0.05]),
        standard_error=0.1,
        name="My rubber",
    )
    unknowns = (
        Unknown(path=MODULUS, low=0.5, high=20.0, log=True),
        Unknown(path="nip.friction", low=0.3, high=0.9),
    )
    return identify(tree_of(), unknowns, data, LeastSquares(tried=1, followed=2))


def test_the_report_says_values_intervals_misfit_and_warnings(fit):
    text = fit_report(fit, "A title")
    lines = text.splitlines()
    assert lines[0] == "A title"
    for said in (
        "2 unknowns, 3 measurements in 1 set",
        "MPa",
        "My rubber: 3 values",
        "(given)",
        "chi-square",
        "1 degrees",
        "Warning: No prediction changes with `nip.friction`",
    ):
        assert said in text
    row = next(line for line in lines if line.startswith(MODULUS))
    low, high = row.split()[-3], row.split()[-1]
    assert float(low) < fit[MODULUS].value < float(high)
    other = next(line for line in lines if line.startswith("nip.friction"))
    assert "unknown" in other
    assert "<= 0.3" in other
    assert ">= 0.9" in other


def test_json_is_finite_and_whole(fit):
    tree = json.loads(json.dumps(fit_dict(fit), allow_nan=False))
    assert tree["unknowns"][0]["path"] == MODULUS
    assert tree["unknowns"][0]["unit"] == "MPa"
    assert tree["unknowns"][1]["standard_error"] is None
    assert len(tree["sets"][0]["predicted"]) == 3
    assert tree["geometry"] == "linear"
    assert tree["verified"] is True


def test_the_case_holds_the_fitted_values(fit):
    text = fit_case(fit)
    material = parse_case(text).nip.upper.layers[0].material
    assert material.modulus == fit[MODULUS].value
    assert text.startswith("# Fitted by rollnip")
    assert "(95 %:" in text
    assert "# Warning:" in text


@pytest.mark.parametrize("style", ["light", "dark"])
def test_the_picture_has_two_axes_for_each_set(fit, style, tmp_path):
    figure = plot_fit(fit, style)
    assert len(figure.axes) == 2
    save_figure(figure, tmp_path / "fit.png")


def test_pictures_show_the_measurements(fit):
    (one,) = fit.sets
    np.testing.assert_allclose(plot_set(one).lines[0].get_ydata(), one.predicted)
    points = plot_residuals(one).lines[-1].get_ydata()
    np.testing.assert_allclose(points, (one.measured - one.predicted) / 0.1)


def test_a_notebook_shows_values_and_warnings(fit):
    assert repr(fit).startswith("<Fit to ")
    assert len(repr(fit)) < 400
    shown = fit._repr_html_()
    for one in fit.estimates:
        assert f"<td>{one.path}</td>" in shown
