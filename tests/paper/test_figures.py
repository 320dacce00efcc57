import numpy as np
import pytest
from matplotlib.figure import Figure

from rollnip.paper import contour_figure, pressure_figure, strain_figure
from rollnip.plots.paper import draw_contours, draw_pressure, draw_strain


@pytest.fixture(scope="module")
def seven():
    return strain_figure(2, positions=15)


def test_figure_7(seven):
    assert set(seven.driven.solutions) == {"linear", "corrected", "curved"}
    assert seven.free.solutions["curved"].traction == pytest.approx(0.0, abs=1e-9)
    # simulated from the curved solution, they agree with it
    assert seven.free.points.probability > 1e-3
    assert seven.free.points.x.size == 15


def test_simulated_points_say_so(seven):
    figure = draw_strain(seven)
    assert "SIMULATED" in figure.get_suptitle()
    labels = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    assert labels == ["linear", "corrected", "curved", "SIMULATED LDA"]


def test_figures_4_and_5():
    data = pressure_figure()
    assert data.thicknesses == (0.0, 0.025, 0.1, 0.2)
    assert isinstance(draw_pressure(data), Figure)
    fields = contour_figure()
    # the stress on the surface is the pressure
    surface = fields.fields[0].s_zz[0]
    solution = fields.solutions[0]
    pressure = np.interp(fields.fields[0].x, solution.nodes, solution.pressure, 0.0, 0.0)
    assert surface == pytest.approx(-pressure, abs=0.02 * solution.peak_pressure)
    assert isinstance(draw_contours(fields), Figure)
