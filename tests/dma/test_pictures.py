"""Pictures of dynamic-mechanical data."""

import numpy as np
import pytest

from rollnip.dma import (
    DmaMethod,
    fit_dma,
    plot_deviation,
    plot_dma,
    plot_master,
    plot_phase,
    plot_shifts,
)
from rollnip.plots import save_figure

from .conftest import LAW, TEMPERATURES, ZENER, isotherms


@pytest.mark.parametrize("style", ["light", "dark"])
def test_one_page_with_four_pictures(fitted, style, tmp_path):
    figure = plot_dma(fitted, style)
    assert len(figure.axes) == 4
    save_figure(figure, tmp_path / "dma.png")


def test_the_master_curve_holds_all_data_and_the_material(fitted):
    ax = plot_master(fitted)
    data, curve = ax.lines[:2]
    np.testing.assert_allclose(data.get_ydata(), fitted.master.reduced.storage)
    assert curve.get_xdata()[[0, -1]] == pytest.approx(fitted.frequency_range)


def test_shifts_are_those_of_the_law(fitted):
    ax = plot_shifts(fitted)
    temperature, shift = ax.lines[0].get_data()
    assert temperature[0] == TEMPERATURES[0]
    assert shift[0] == pytest.approx(np.log10(fitted.shift.law.factor(TEMPERATURES[0])))


def test_deviation_and_phase_are_of_the_data(fitted):
    values = plot_deviation(fitted).lines[0].get_ydata()
    assert np.sqrt(np.mean(values**2)) == pytest.approx(100.0 * fitted.deviation[0])
    phases = np.concatenate([line.get_ydata() for line in plot_phase(fitted).lines])
    assert np.all((phases > 0.0) & (phases < 90.0))


def test_one_isotherm_is_drawn_too():
    fit = fit_dma(isotherms(ZENER, LAW, temperatures=np.array([23.0])), DmaMethod())
    assert len(plot_dma(fit).axes) == 4
