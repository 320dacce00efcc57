"""Plots of a fit: measurements beside predictions, and residuals."""

from __future__ import annotations

from math import ceil

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rollnip.figure import axis_label
from rollnip.figures import FIGURES, PROFILES
from rollnip.identification.result import Fit, FittedSet
from rollnip.plots.style import Look, Style, label, page, palette_of, prepare

_MOST_COLUMNS = 3
_HEIGHT = 92.0  # height of a row [mm]
_BAND = 2.0  # half-width of bands and error bars, in standard errors


def plot_fit(fit: Fit, style: Style = "light") -> Figure:
    """Draw each set: measurements with standard errors and predictions, and residuals below.

    Parameters
    ----------
    fit :
        from `identify`.
    style :
        "light" or "dark".

    Returns
    -------
    Figure
        180 mm wide, outside pyplot; two axes for each set.
    """
    columns = min(len(fit.sets), _MOST_COLUMNS)
    rows = ceil(len(fit.sets) / columns)
    figure = page(style, _HEIGHT * rows)
    grids = figure.subfigures(rows, columns, squeeze=False)
    for part, one in zip(grids.flat, fit.sets, strict=False):
        part.set_facecolor(palette_of(style).ground)
        above, below = part.subplots(2, 1, sharex=True, height_ratios=(2.2, 1.0))
        plot_set(one, above, style=style, quantile=fit.quantile)
        plot_residuals(one, below, style=style)
        above.set_xlabel("")
        above.tick_params(labelbottom=False)
    return figure


def plot_set(
    one: FittedSet,
    ax: Axes | None = None,
    style: Style | None = None,
    *,
    quantile: float = _BAND,
) -> Axes:
    """Draw the measurements of a set with two standard errors, and the predictions.

    A band around the predictions, ``quantile`` standard errors each way, shows how well the fitted
    curve is known.
    """
    ax, look = prepare(ax, style)
    colours = look.palette
    order = np.argsort(one.at, kind="stable")
    ax.plot(
        one.at[order],
        one.predicted[order],
        color=colours.pressure,
        linewidth=look.line,
        marker=".",
        label="fit",
    )
    reach = quantile * one.prediction_error[order]
    if np.all(np.isfinite(reach)):
        ax.fill_between(
            one.at[order],
            one.predicted[order] - reach,
            one.predicted[order] + reach,
            color=colours.pressure,
            alpha=0.2,
            linewidth=0.0,
            label="interval of the curve",
        )
    ax.errorbar(
        one.at,
        one.measured,
        yerr=_BAND * one.standard_error,
        fmt="o",
        color=colours.shear,
        markerfacecolor="none",
        markersize=0.45 * look.size,
        linewidth=1.5 * look.thin,
        label="measured, ± 2 standard errors",
    )
    label(ax, look, _named(one.against), axis_label(one.quantity, one.unit))
    ax.set_title(one.name, loc="left", fontsize=look.size, color=colours.ink, parse_math=False)
    ax.legend(frameon=False, fontsize=look.small, labelcolor=colours.ink, loc="best")
    return ax


def plot_residuals(one: FittedSet, ax: Axes | None = None, style: Style | None = None) -> Axes:
    """Draw measured minus predicted over the standard error; the band holds 95 of 100 points."""
    ax, look = prepare(ax, style)
    colours = look.palette
    ax.axhspan(-_BAND, _BAND, facecolor=colours.stick, linewidth=0.0)
    ax.axhline(0.0, color=colours.muted, linewidth=look.thin)
    ax.plot(
        one.at,
        one.residuals,
        "o",
        color=colours.shear,
        markerfacecolor="none",
        markersize=0.45 * look.size,
    )
    reach = max(1.3 * float(np.max(np.abs(one.residuals))), 1.5 * _BAND)
    ax.set_ylim(-reach, reach)
    _label_residuals(ax, look, one)
    return ax


def _label_residuals(ax: Axes, look: Look, one: FittedSet) -> None:
    label(ax, look, _named(one.against), "residual\n/ std. error")


def _named(path: str) -> str:
    """Return the label of an axis for a path: its last key in words, with a unit if it is known."""
    figures = {
        "nip.load": FIGURES["load"],
        "nip.approach": FIGURES["approach"],
        "nip.traction": FIGURES["traction"],
        "nip.torque_lower": FIGURES["torque_lower"],
        "nip.speed": PROFILES["speed_upper"],
        "x": PROFILES["x"],
    }
    name = path.rpartition(".")[2].replace("_", " ")
    return axis_label(name, figures[path].unit) if path in figures else name
