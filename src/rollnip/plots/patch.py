"""A picture of a solved patch: pressure, stick and slip with the shear, and the middle lines."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch as Swatch

from rollnip.patch.figures import PATCH_FIELDS, PATCH_PLACES
from rollnip.patch.solution import PatchSolution
from rollnip.plots.style import Palette, Style, palette_of

_SIZE = (10.0, 7.0)  # inches
_X = PATCH_PLACES["x"].axis_for("x, rolling to the right")
_ARROWS = 17


def plot_patch(solution: PatchSolution, *, style: Style = "light") -> Figure:
    """Return one page about a patch: pressure, stick and slip with shear, lines through the middle.

    Parameters
    ----------
    solution : what `solve_patch` returned.
    style : "light" or "dark".
    """
    palette = palette_of(style)
    figure = Figure(figsize=_SIZE, layout="constrained", facecolor=palette.ground)
    (pressure, zones), (along, across) = figure.subplots(2, 2, height_ratios=(1.6, 1.0))
    _pressure(figure, pressure, solution, palette)
    _zones(zones, solution, palette)
    row, column = _middle(solution)
    _line(
        along,
        (solution.x, solution.pressure[row], solution.shear_x[row]),
        solution,
        palette,
        PATCH_FIELDS["shear_x"].label,
    )
    _line(
        across,
        (solution.y, solution.pressure[:, column], solution.shear_y[:, column]),
        solution,
        palette,
        PATCH_FIELDS["shear_y"].label,
    )
    along.set_xlabel(_X)
    across.set_xlabel(PATCH_PLACES["y"].axis_for("y, along the axis"))
    for ax, other, fixed in ((along, "y", solution.y[row]), (across, "x", solution.x[column])):
        way = "x" if other == "y" else "y"
        place = PATCH_PLACES[other].text(fixed, 2).replace("-", "\N{MINUS SIGN}")
        said = f"along {way} at {other} = {place}"
        ax.set_title(said, loc="left", size=10, color=palette.ink)
    for ax in figure.axes:
        ax.tick_params(colors=palette.ink)
        for spine in ax.spines.values():
            spine.set_color(palette.ink)
        for text in (ax.xaxis.label, ax.yaxis.label, *ax.texts):
            text.set_color(palette.ink)
    title = solution.patch.title or "Patch"
    state = "" if solution.converged else " (NOT CONVERGED)"
    figure.suptitle(f"{title}{state}", color=palette.ink, ha="left", x=0.02)
    return figure


def _middle(solution: PatchSolution) -> tuple[int, int]:
    """Return the row and the column through the middle of the pressure."""
    total = float(np.sum(solution.pressure))
    y = float(np.sum(solution.pressure.sum(axis=1) * solution.y)) / total
    x = float(np.sum(solution.pressure.sum(axis=0) * solution.x)) / total
    return int(np.argmin(np.abs(solution.y - y))), int(np.argmin(np.abs(solution.x - x)))


def _frame(ax: Axes, solution: PatchSolution, palette: Palette) -> None:
    """Set the window of a map; to scale where the patch is not much longer than wide."""
    grid = solution.grid
    ax.set_facecolor(palette.ground)
    ax.set_xlim(grid.x[0] - 0.5 * grid.hx, grid.x[-1] + 0.5 * grid.hx)
    ax.set_ylim(grid.y[0] - 0.5 * grid.hy, grid.y[-1] + 0.5 * grid.hy)
    if 0.5 < solution.length / max(solution.width, 1e-300) < 2.0:
        ax.set_aspect("equal")
    ax.set_xlabel(_X)
    ax.set_ylabel(PATCH_PLACES["y"].axis)


def _pressure(figure: Figure, ax: Axes, solution: PatchSolution, palette: Palette) -> None:
    values = np.where(solution.pressure > 0.0, solution.pressure, np.nan)
    filled = ax.pcolormesh(
        solution.x, solution.y, values, cmap=palette.sequential, shading="nearest", rasterized=True
    )
    bar = figure.colorbar(filled, ax=ax)
    bar.set_label(PATCH_FIELDS["pressure"].axis, color=palette.ink)
    ax.set_title(PATCH_FIELDS["pressure"].label, loc="left", size=10, color=palette.ink)
    _frame(ax, solution, palette)


def _zones(ax: Axes, solution: PatchSolution, palette: Palette) -> None:
    """Draw where the surfaces stick and slip, with the shear on the upper roller as arrows."""
    colours = ListedColormap([palette.ground, palette.stick, palette.slip])
    ax.pcolormesh(
        solution.x,
        solution.y,
        solution.state,
        cmap=colours,
        vmin=-0.5,
        vmax=2.5,
        shading="nearest",
        rasterized=True,
    )
    rows, columns = (
        slice(count // (2 * _ARROWS), None, max(count // _ARROWS, 1))
        for count in (solution.y.size, solution.x.size)
    )
    part = (rows, columns)
    there = solution.pressure[part] > 0.0
    x, y = np.meshgrid(solution.x[columns], solution.y[rows])
    if np.any(solution.level.shear):
        ax.quiver(
            x[there],
            y[there],
            solution.shear_x[part][there],
            solution.shear_y[part][there],
            color=palette.shear,
            pivot="mid",
        )
    ax.contour(
        solution.x, solution.y, solution.pressure > 0.0, levels=[0.5], colors=palette.ink,
        linewidths=0.8,
    )  # fmt: skip
    swatches = (
        Swatch(facecolor=palette.stick, edgecolor=palette.muted, label="stick"),
        Swatch(facecolor=palette.slip, edgecolor=palette.muted, label="slip"),
    )
    _legend_below(ax, palette, -0.16, swatches)
    ax.set_title(
        "stick, slip, and shear on the upper roller", loc="left", size=10, color=palette.ink
    )
    _frame(ax, solution, palette)


def _line(
    ax: Axes,
    curves: tuple[np.ndarray[tuple[int], np.dtype[np.float64]], ...],
    solution: PatchSolution,
    palette: Palette,
    name: str,
) -> None:
    """Draw pressure, traction bound and shear along one line through the patch."""
    places, pressure, shear = curves
    bound = solution.patch.friction * pressure
    ax.set_facecolor(palette.ground)
    ax.plot(
        places,
        pressure,
        color=palette.pressure,
        linewidth=1.8,
        label=PATCH_FIELDS["pressure"].label,
    )
    if solution.patch.friction > 0.0:
        ax.plot(places, shear, color=palette.shear, linewidth=1.8, label=name)
        for side, label in ((bound, "traction bound"), (-bound, None)):
            ax.plot(places, side, color=palette.muted, linewidth=0.8, linestyle=":", label=label)
    ax.set_ylabel(PATCH_FIELDS["pressure"].axis_for("stress"))
    _legend_below(ax, palette, -0.24)


def _legend_below(
    ax: Axes, palette: Palette, distance: float, handles: Sequence[Artist] | None = None
) -> None:
    """Put the legend below the axes, where it hides no curve; ``distance`` in their heights."""
    ax.legend(
        handles=ax.get_legend_handles_labels()[0] if handles is None else handles,
        loc="upper center",
        bbox_to_anchor=(0.5, distance),
        ncols=3,
        frameon=False,
        fontsize=8,
        labelcolor=palette.ink,
    )
