"""Figures of a round: peak, creepage scale, excess over the tolerance."""

from dataclasses import replace
from math import inf

import numpy as np
import pytest

import rollnip as rn
from rollnip.rolling import Figures, creepage_scale, excess, peak_pressure

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


def test_creepage_has_a_least_scale(cases):
    """A twentieth of the slope of the gap at the edge."""
    nip, _ = cases["II free"]
    assert creepage_scale(nip, FIGURES) == 0.02
    slope = 2.0 * nip.curvature
    assert creepage_scale(nip, replace(FIGURES, creepage=0.0)) == pytest.approx(0.05 * slope)
    assert creepage_scale(nip, replace(FIGURES, creepage=-0.5)) == 0.5


def test_excess_is_that_of_the_worst_figure(cases, solved):
    nip, _ = cases["II free"]
    final = solved("II free").final
    none = Figures(0.0, 0.0, 0.0, 0.0, 0.0)
    assert excess(nip, replace(final, error=none), 1e-3) == 0.0
    for name in ("approach", "creepage", "nip_width", "peak_pressure"):
        size = abs(getattr(final.figures, name))
        wrong = replace(final, error=replace(none, **{name: 2e-3 * size}))
        assert excess(nip, wrong, 1e-3) == pytest.approx(2.0, rel=1e-12)
    # the load is prescribed
    assert excess(nip, replace(final, error=replace(none, load=1.0)), 1e-3) == 0.0


def test_excess_of_what_is_not_prescribed(cases, solved):
    nip, _ = cases["foam on a plane"]
    final = solved("foam on a plane").final
    none = Figures(0.0, 0.0, 0.0, 0.0, 0.0)
    wrong = replace(final, error=replace(none, load=3e-3 * final.figures.load))
    assert excess(nip, wrong, 1e-3) == pytest.approx(3.0, rel=1e-12)


def test_unknown_errors_exceed_everything(cases, solved):
    nip, _ = cases["II free"]
    unknown = replace(solved("II free").final, error=Figures(inf, inf, inf, inf, inf))
    assert excess(nip, unknown, 0.1) == inf


def test_figures_are_those_of_the_solution(case, solved):
    solution = solved(case[0])
    figures = solution.final.figures
    assert figures.nip_width == pytest.approx(
        solution.contact[-1][1] - solution.contact[0][0], rel=1e-14
    )
    load = solution.final.weights @ solution.pressure
    assert figures.load == pytest.approx(load, rel=1e-12)
    # what acts between nodes has the right means, so it is a little too large at the nodes
    assert np.max(solution.pressure) == pytest.approx(figures.peak_pressure, rel=1e-3)
    if isinstance(case[1].normal, rn.LineLoad):
        assert figures.load == pytest.approx(case[1].normal.load, rel=1e-9)


def test_no_error_is_small_where_nothing_is_pressed(case, solved):
    final = solved(case[0]).final
    nothing = replace(final, figures=replace(final.figures, peak_pressure=0.0))
    assert excess(case[1], nothing, 1e-3) == inf
