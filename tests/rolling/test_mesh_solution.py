"""Figures of a solution on one mesh: peak, creepage scale, error over the tolerance."""

from dataclasses import replace
from math import inf
from pathlib import Path

import numpy as np
import pytest

import rollnip as rn
from rollnip.influence import load_weights
from rollnip.rolling.mesh_solution import (
    Figures,
    peak_pressure,
    peaks_alike,
)

EXAMPLES = Path(__file__).parents[2] / "examples"
FIGURES = Figures(approach=0.2, load=1.5, creepage=0.02, nip_width=4.0, peak_pressure=0.3)


@pytest.mark.parametrize("place", [-0.13, 0.02, 0.4])
def test_peak_of_a_parabola_is_exact(place):
    """Any spacing, and the highest node on either side of the summit."""
    x = np.array([-1.0, -0.7, -0.2, -0.1, 0.15, 0.5, 0.8])
    value, where = peak_pressure(x, 2.0 - 3.0 * (x - place) ** 2)
    assert value == pytest.approx(2.0, rel=1e-13)
    assert where == pytest.approx(place, abs=1e-13)


def test_peak_at_an_end_or_on_a_line():
    x = np.arange(4.0)
    assert peak_pressure(x, np.array([4.0, 3.0, 1.0, 0.0])) == (4.0, 0.0)
    assert peak_pressure(x, np.array([0.0, 1.0, 2.0, 3.0])) == (3.0, 3.0)
    assert peak_pressure(x, np.ones(4))[0] == 1.0


def test_peak_of_a_single_node():
    assert peak_pressure(np.array([0.3]), np.array([2.0])) == (2.0, 0.3)


def test_creepage_has_a_least_scale(solved):
    """A twentieth of the slope of the gap at the edge."""
    final = replace(solved("II free").final, figures=FIGURES)
    assert final.creepage_scale == 0.02
    still, fast = (
        replace(final, figures=replace(FIGURES, creepage=creepage)) for creepage in (0.0, -0.5)
    )
    assert still.creepage_scale == pytest.approx(0.05 * 2.0 * final.nip.curvature)
    assert fast.creepage_scale == 0.5


def test_excess_is_that_of_the_worst_figure(solved):
    final = solved("II free").final
    none = Figures(0.0, 0.0, 0.0, 0.0, 0.0)
    assert replace(final, error=none).error_ratio == 0.0
    for name in ("approach", "creepage", "nip_width", "peak_pressure"):
        size = abs(getattr(final.figures, name))
        wrong = replace(final, error=replace(none, **{name: 2e-3 * size}))
        assert wrong.error_ratio == pytest.approx(2.0, rel=1e-12)
    # the load is prescribed
    assert replace(final, error=replace(none, load=1.0)).error_ratio == 0.0


def test_excess_of_what_is_not_prescribed(solved):
    final = solved("foam on a plane").final
    none = Figures(0.0, 0.0, 0.0, 0.0, 0.0)
    wrong = replace(final, error=replace(none, load=3e-3 * final.figures.load))
    assert wrong.error_ratio == pytest.approx(3.0, rel=1e-12)


def test_unknown_errors_exceed_everything(solved):
    unknown = replace(solved("II free").final, error=Figures(inf, inf, inf, inf, inf))
    assert unknown.error_ratio == inf


def test_figures_are_those_of_the_solution(case, solved):
    solution = solved(case[0])
    figures = solution.final.figures
    assert figures.nip_width == pytest.approx(
        solution.contact[-1][1] - solution.contact[0][0], rel=1e-14
    )
    load = load_weights(solution.final.nodes) @ solution.pressure
    assert figures.load == pytest.approx(load, rel=1e-12)
    cubic = solution.final.mesh.between(solution.final.state.pressure)
    peak, top = figures.peak_pressure, int(np.argmax(cubic))
    bend = cubic[top - 1] - 2.0 * cubic[top] + cubic[top + 1]
    # a peak between nodes lies above the highest node by an eighth of the bend, at most
    assert cubic[top] == pytest.approx(peak, abs=3e-4 * peak - bend / 8.0)
    # what acts between nodes has the right means, so at a node it exceeds the cubic by h^2 |f''|/12
    above = solution.pressure[top] - cubic[top]
    assert above == pytest.approx(-bend / 12.0, rel=0.05, abs=3e-5 * peak)
    # a third of the tolerance, about; a stiff top has its peak within its own thickness
    assert abs(above) < (1.5e-3 if case[0] == "stiff top" else 4.5e-4) * peak
    if isinstance(case[1].normal, rn.LineLoad):
        assert figures.load == pytest.approx(case[1].normal.load, rel=1e-9)


def test_no_error_is_small_where_nothing_is_pressed(case, solved):
    final = solved(case[0]).final
    nothing = replace(final, figures=replace(final.figures, peak_pressure=0.0))
    assert nothing.error_ratio == inf


def test_of_peaks_that_are_equally_high_the_leading_one_is_the_place():
    """Rounding does not choose between them; a fifth digit does not make one of them higher."""
    x = np.linspace(-1.0, 1.0, 41)
    twins = np.exp(-40.0 * (x - 0.8) ** 2) + np.exp(-40.0 * (x + 0.8) ** 2)
    for tilt in (-1e-12, 0.0, 1e-12, -4e-5):
        assert peak_pressure(x, twins * (1.0 + tilt * x))[1] == pytest.approx(0.8, abs=1e-3)
        assert len(peaks_alike(twins * (1.0 + tilt * x))) == 2
    for tilt in (-1e-4, -1e-3):
        assert peak_pressure(x, twins * (1.0 + tilt * x))[1] == pytest.approx(-0.8, abs=1e-3)
        assert len(peaks_alike(twins * (1.0 + tilt * x))) == 1


def test_the_place_of_peaks_beside_both_edges_of_a_skin_is_known():
    """Their place is said to a share of their distance from the edge, not to the whole nip."""
    case = rn.read_case(EXAMPLES / "figure-4-top-layer-0.1mm.toml")
    solution = rn.solve(case.nip)
    leading, (trailing,) = solution.peak_pressure_x, solution.peaks_alike_x
    assert leading == pytest.approx(-trailing, rel=1e-3)
    assert 0.9 < leading / solution.contact[-1][1] < 1.0
    assert solution.error["peak_pressure_x"] < 0.02 * solution.nip_width
    assert "as high at x" in solution.summary()
