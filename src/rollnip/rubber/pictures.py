"""Pictures of tests of rubber with a fitted strain energy."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rollnip.figures import MEASURED
from rollnip.plots.style import MARK, Style, label, page, prepare
from rollnip.rubber.data import TESTS
from rollnip.rubber.fit import RubberFit
from rollnip.rubber.laws import nominal_stress

_HEIGHT = 75.0  # mm
_MARKS = dict(zip(TESTS, "o^sDv", strict=True))


def plot_rubber(fit: RubberFit, style: Style = "light") -> Figure:
    """Draw measured and fitted stresses, and their deviations.

    Parameters
    ----------
    fit :
        from `fit_rubber`.
    style :
        "light" or "dark".

    Returns
    -------
    Figure
        180 by 75 mm, not registered with pyplot.
    """
    figure = page(style, _HEIGHT)
    left, right = figure.subplots(1, 2)
    plot_stress(fit, left, style=style)
    plot_stress_deviation(fit, right, style=style)
    return figure


def plot_stress(fit: RubberFit, ax: Axes | None = None, style: Style | None = None) -> Axes:
    """Draw the measured nominal stress over strain, with the fitted energy as curves."""
    ax, look = prepare(ax, style)
    colours, data = look.palette, fit.data
    for number, test in enumerate(data.tests):
        rows, rest = data.rows(test), 0.0 if test == "shear" else 1.0
        strain = data.stretch[rows] - rest
        ends = min(0.0, float(strain.min())), max(0.0, float(strain.max()))
        grid = np.linspace(*ends, 300)
        colour = (colours.pressure, colours.shear, colours.muted, colours.ink)[number % 4]
        stress = fit.shear_modulus * nominal_stress(fit.energy, test, grid + rest)
        ax.plot(grid, stress, color=colour, linewidth=0.7 * look.line)
        ax.plot(
            strain,
            data.stress[rows],
            _MARKS[test],
            color=colour,
            markersize=MARK * look.size,
            markerfacecolor="none",
            markeredgewidth=look.thin,
            label=test,
        )
    label(ax, look, MEASURED["strain"].axis, MEASURED["nominal_stress"].axis)
    ax.legend(
        title=f"curves: {fit.law}",
        frameon=False,
        fontsize=look.small,
        labelcolor=colours.ink,
        loc="best",
    ).get_title().set(fontsize=look.small, color=colours.ink)
    return ax


def plot_stress_deviation(
    fit: RubberFit, ax: Axes | None = None, style: Style | None = None
) -> Axes:
    """Draw computed less measured stress in per cent of the largest stress of each test."""
    ax, look = prepare(ax, style)
    colours, data = look.palette, fit.data
    for number, test in enumerate(data.tests):
        rows, rest = data.rows(test), 0.0 if test == "shear" else 1.0
        ax.plot(
            data.stretch[rows] - rest,
            100.0 * fit.deviation[rows] / np.abs(data.stress[rows]).max(),
            _MARKS[test],
            color=(colours.pressure, colours.shear, colours.muted, colours.ink)[number % 4],
            markersize=MARK * look.size,
            markerfacecolor="none",
            markeredgewidth=look.thin,
        )
    ax.axhline(0.0, color=colours.muted, linewidth=look.thin)
    across = MEASURED["strain"].axis
    label(ax, look, across, MEASURED["deviation"].axis_for("deviation over the largest stress"))
    return ax
