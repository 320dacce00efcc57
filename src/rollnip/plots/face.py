"""A picture of a solved face: the impression to scale, line load, scrub, bent axes."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rollnip.face.figures import FACE_PROFILES, SHEET_FACE_FIGURES, SHEET_FACE_PROFILES
from rollnip.face.sheet_solution import SheetFaceSolution
from rollnip.face.solution import FaceSolution
from rollnip.plots.style import Palette, Style, palette_of
from rollnip.sheet_figures import SHEET_FIGURES

_SIZE, _SHEET_SIZE = (10.0, 8.0), (10.0, 14.0)  # inches


def plot_face(solution: FaceSolution, *, style: Style = "light") -> Figure:
    """Return one page about a face: impression, line load, traction, axes and surfaces.

    Parameters
    ----------
    solution : what `solve_face` returned.
    style : "light" or "dark".
    """
    palette = palette_of(style)
    size = _SIZE if not isinstance(solution, SheetFaceSolution) else _SHEET_SIZE
    figure = Figure(figsize=size, layout="constrained", facecolor=palette.ground)
    rows = 4 if not isinstance(solution, SheetFaceSolution) else 6
    axes = figure.subplots(rows, 1, sharex=True)
    impression, load, scrub, shape = (axes[i] for i in (0, 1, 2, -1))
    for ax in axes:
        ax.set_facecolor(palette.ground)
        ax.tick_params(colors=palette.ink)
        for spine in ax.spines.values():
            spine.set_color(palette.ink)
    _impression(impression, solution, palette)
    _line(load, solution, solution.load, FACE_PROFILES["load"].axis, palette.pressure)
    load.axhline(solution.mean_load, color="0.5", linewidth=0.8, linestyle=":", label="mean")
    load.legend(frameon=False, fontsize=9, loc="best", labelcolor=palette.ink)
    _line(scrub, solution, solution.traction, FACE_PROFILES["traction"].axis, palette.shear)
    if isinstance(solution, SheetFaceSolution):
        _sheet(axes[3], axes[4], scrub, solution, palette)
    _shapes(shape, solution, palette)
    shape.set_xlabel(FACE_PROFILES["y"].axis_for("y along the face"))
    for ax in figure.axes:
        for text in (ax.title, ax.xaxis.label, ax.yaxis.label):
            text.set_color(palette.ink)
    figure.align_ylabels(axes)
    title = solution.nip.title or "Face"
    state = "" if solution.converged else " (NOT CONVERGED)"
    figure.suptitle(f"{title}{state}", color=palette.ink, ha="left", x=0.02)
    return figure


def _impression(ax: Axes, solution: FaceSolution, palette: Palette) -> None:
    """Draw the print that carbon paper keeps: the nip width over the face."""
    half = 0.5 * solution.nip_width
    ax.fill_between(solution.y, -half, half, color=palette.muted, linewidth=0.0)
    top = 1.4 * float(half.max(initial=0.0)) or 1.0
    ax.set_ylim(-top, top)
    ax.set_ylabel(FACE_PROFILES["nip_width"].axis)
    widths = solution.nip_width[[0, solution.y.size // 2, -1]]
    places, sides = (solution.y[0], 0.0, solution.y[-1]), ("left", "center", "right")
    for y, width, side in zip(places, widths, sides, strict=True):
        shift = {"left": 6, "center": 0, "right": -6}[side]  # points, away from the end
        ax.annotate(
            FACE_PROFILES["nip_width"].text(width), (y, 0.0), (shift, 0),
            textcoords="offset points", color=palette.ground, ha=side, va="center", size=9,
        )  # fmt: skip
    ax.set_title("impression", loc="left", size=10, color=palette.ink)


def _line(
    ax: Axes,
    solution: FaceSolution,
    values: np.ndarray[tuple[int], np.dtype[np.float64]],
    label: str,
    color: str,
) -> None:
    ax.plot(solution.y, values, color=color, linewidth=1.8)
    ax.axhline(0.0, color="0.5", linewidth=0.6)
    ax.set_ylabel(label)
    if values.min() >= 0.0:
        ax.set_ylim(bottom=0.0)


def _sheet(
    feed: Axes, tension: Axes, scrub: Axes, solution: SheetFaceSolution, palette: Palette
) -> None:
    """Draw the feed of the sheet, its tension at the inlet, and both tractions."""
    scrub.lines[0].set_label(SHEET_FIGURES["sheet.traction_lower"].label)
    scrub.plot(
        solution.y, solution.traction_upper, color=palette.upper, linewidth=1.8,
        label=SHEET_FACE_PROFILES["traction_upper"].label,
    )  # fmt: skip
    scrub.legend(frameon=False, fontsize=9, loc="best", labelcolor="linecolor")
    ahead = 1e3 * ((1.0 + solution.feed_upper) / (1.0 + solution.mean_feed) - 1.0)
    feed.plot(solution.y, ahead, color=palette.lower, linewidth=1.8)
    feed.axhline(0.0, color="0.5", linewidth=0.6)
    feed.set_ylabel(SHEET_FACE_FIGURES["feed_difference"].axis_for("feed over mean"))
    span = max(float(np.max(np.abs(ahead))), 0.01)
    feed.set_ylim(-1.2 * span, 1.2 * span)
    inlet = solution.tension_in
    tension.plot(solution.y, inlet, color=palette.lower, linewidth=1.8)
    pushed = np.minimum(inlet, 0.0)
    tension.fill_between(solution.y, pushed, 0.0, color=palette.pressure, alpha=0.4, linewidth=0.0)
    tension.axhline(0.0, color="0.5", linewidth=0.6)
    low, high = min(float(inlet.min()), 0.0), max(float(inlet.max()), 0.0)
    tension.set_ylim(1.2 * low, 1.2 * high or 1.0)
    tension.set_ylabel(SHEET_FACE_PROFILES["tension_in"].axis)


def _shapes(ax: Axes, solution: FaceSolution, palette: Palette) -> None:
    """Draw how far the axes bend away from each other, and the crown that meets them."""
    away = solution.deflection_upper + solution.deflection_lower
    away = away - 0.5 * (away[0] + away[-1])
    crown = solution.problem.still - 0.5 * (solution.problem.still[0] + solution.problem.still[-1])
    lines = (
        (away, palette.upper, "-", "both axes bend apart"),
        (crown, palette.lower, "--", "crowns and skew fill"),
    )
    for values, color, dashes, name in lines:
        ax.plot(solution.y, values, color=color, linewidth=1.8, linestyle=dashes, label=name)
    ax.set_ylabel(FACE_PROFILES["deflection_upper"].axis_for("minus ends"))
    ax.legend(frameon=False, fontsize=9, loc="best", labelcolor="linecolor")
