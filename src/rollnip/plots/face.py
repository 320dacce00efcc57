"""A picture of a solved face: the impression to scale, line load, scrub, bent axes."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rollnip.face.solution import FaceSolution
from rollnip.plots.style import Palette, Style, palette_of

_SIZE = (10.0, 8.0)  # inches


def plot_face(solution: FaceSolution, *, style: Style = "light") -> Figure:
    """Return one page about a face: impression, line load, traction, axes and surfaces.

    Parameters
    ----------
    solution : what `solve_face` returned.
    style : "light" or "dark".
    """
    palette = palette_of(style)
    figure = Figure(figsize=_SIZE, layout="constrained", facecolor=palette.ground)
    impression, load, scrub, shape = figure.subplots(4, 1, sharex=True)
    for ax in (impression, load, scrub, shape):
        ax.set_facecolor(palette.ground)
        ax.tick_params(colors=palette.ink)
        for spine in ax.spines.values():
            spine.set_color(palette.ink)
    _impression(impression, solution, palette)
    _line(load, solution, solution.load, "line load [N/mm]", palette.pressure)
    load.axhline(solution.mean_load, color="0.5", linewidth=0.8, linestyle=":")
    _line(scrub, solution, solution.traction, "traction [N/mm]", palette.shear)
    _shapes(shape, solution, palette)
    shape.set_xlabel("y along the face [mm]")
    for ax in figure.axes:
        for text in (ax.title, ax.xaxis.label, ax.yaxis.label):
            text.set_color(palette.ink)
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
    ax.set_ylabel("nip width [mm]")
    widths = solution.nip_width[[0, solution.y.size // 2, -1]]
    places, sides = (solution.y[0], 0.0, solution.y[-1]), ("left", "center", "right")
    for y, width, side in zip(places, widths, sides, strict=True):
        shift = {"left": 6, "center": 0, "right": -6}[side]  # points, away from the end
        ax.annotate(
            f"{width:.2f} mm", (y, 0.0), (shift, 0), textcoords="offset points",
            color=palette.ground, ha=side, va="center", size=9,
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
        ax.plot(solution.y, 1e3 * values, color=color, linewidth=1.8, linestyle=dashes, label=name)
    ax.set_ylabel("over the ends [µm]")
    ax.legend(frameon=False, fontsize=9, loc="best", labelcolor="linecolor")
