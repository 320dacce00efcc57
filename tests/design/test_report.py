"""Optima and tolerances in words and in a picture."""

import re

import numpy as np
import pytest

from rollnip.design import (
    AtLeast,
    AtMost,
    Bounds,
    Minimise,
    Normal,
    Sampling,
    Varied,
    optimise,
    tolerance,
)
from rollnip.design.report import optimum_report, plot_tolerance, result_lines, tolerance_report
from rollnip.plots import save_figure
from rollnip.sweeps import Table

LOAD = "nip.load"
THICKNESS = "upper.layers[0].thickness"


@pytest.fixture
def scattered(coated):
    def solve(study):
        x = np.array([study.values(position) for position in range(study.count)])
        columns = {
            "nip_width": x[:, 0] + 3.0 * x[:, 1],
            "peak_pressure": x[:, 0],
            "error.nip_width": np.full(len(x), 0.01),
            "error.peak_pressure": np.full(len(x), 0.2),
            "converged": np.ones(len(x)),
            "message": ("",) * len(x),
            "case": np.arange(len(x)),
        }
        return Table(columns, {})

    def make(sobol):
        return tolerance(
            coated,
            [Varied(LOAD, Normal(10.0, 0.5)), Varied(THICKNESS, Normal(5.0, 0.1))],
            results=["nip_width"],
            limits=[AtMost("peak_pressure", 11.0), AtLeast("nip_width", 24.0)],
            sampling=Sampling(sobol=sobol),
            solve=solve,
        )

    return make


def test_tolerances_in_words(scattered):
    text = tolerance_report(scattered(0), "A title")
    assert text.startswith("A title\n\n200 samples of a Latin hypercube, 200 solved; in brackets")
    # sqrt(0.5^2 + 0.3^2) = 0.583; the hypercube's own scatter is some per cent
    assert re.search(r"nip_width \[mm\]\n  mean (24\.99|25\.00).*deviation 0\.5[5-9]", text)
    # 25 + 1.645 * 0.583 = 25.96, its standard error some 0.09
    assert re.search(r"95 % of all below (25\.[7-9]|26\.[01])", text)
    assert "peak_pressure at most 11.000 MPa: 9" in text
    assert "all at once: 9" in text
    assert "within the solver's error" in text
    # the load scatters the width by 0.5, the thickness by 0.3
    width = text[text.index("nip_width") : text.index("peak_pressure [MPa]")]
    assert width.index("nip.load") < width.index(THICKNESS)
    assert "Sobol" not in text
    assert "Sobol: alone 0.7" in tolerance_report(scattered(64))


@pytest.mark.parametrize("style", ["light", "dark"])
@pytest.mark.parametrize("sobol", [0, 16])
def test_tolerances_in_a_picture(scattered, tmp_path, sobol, style):
    figure = plot_tolerance(scattered(sobol), style=style)
    axes = [ax for ax in figure.axes if ax.get_xlabel()]
    assert [ax.get_xlabel() for ax in axes] == [
        "nip width [mm]",
        "share of the variance of nip width",
        "peak pressure [MPa]",
        "share of the variance of peak pressure",
    ]
    said = [text.get_text() for text in axes[1].get_legend().get_texts()]
    assert said[0] == ("alone (Sobol)" if sobol else "regression, R² = 1.000")
    save_figure(figure, tmp_path / "a.png")


def test_an_optimum_in_words(coated, stand_in):
    laws = {
        "peak_pressure": lambda load, _: load,
        "nip_width": lambda load, thickness: load * thickness,
        "error.nip_width": lambda *_: 0.02,
        "load": lambda load, _: load,
        "traction": lambda *_: 1e-19,
    }
    found = optimise(
        coated,
        [Bounds(LOAD, 1.0, 10.0), Bounds(THICKNESS, 1.0, 4.0)],
        Minimise("peak_pressure"),
        [AtLeast("nip_width", 8.0)],
        evaluate=stand_in(laws),
    )
    text = optimum_report(found, "A title")
    assert text.startswith("A title\n\nThe smallest peak_pressure found is 2.00")
    assert "nip_width at least 8.0000 mm: 8.0" in text
    assert " ± 0.020, decides" in text
    assert "stands at its upper bound" in text
    assert "as good within 1 %" in text
    assert "traction            0 N/mm" in text
    assert f"{found.solves} cases tried; 0 could not be solved." in text


@pytest.mark.parametrize(
    ("traction", "error", "said"),
    [
        (3e-17, 1.2e-17, "0 N/mm"),  # rounding, and so is its error
        (1e-5, 1e-3, "0 N/mm ± 0.0010"),  # far less than its error
        (0.1, 1e-3, "0.10000 N/mm ± 0.0010"),
    ],
)
def test_a_result_is_written_as_in_the_summary_of_a_nip(traction, error, said):
    row = {"load": 2.0, "traction": traction, "error.traction": error}
    assert result_lines(row)[-1].split("traction")[1].strip() == said
