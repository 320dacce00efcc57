"""One result over two parameters, with contours."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke
from numpy.typing import ArrayLike

from rollnip._errors import InvalidInputError
from rollnip.plots.arrays import Array, finite_row, require_some
from rollnip.plots.style import Look, Style, figure_of, label, legend, prepare

_LEVELS = 9
_EDGE = 0.05  # of the picture; a value nearer to the frame would lie over it
_SHORT = 0.08  # of the picture; on a shorter contour there is no room for a value


def plot_map(
    x: ArrayLike,
    y: ArrayLike,
    values: ArrayLike,
    ax: Axes | None = None,
    *,
    names: tuple[str, str, str] = ("x", "y", "value"),
    wanted: float | None = None,
    style: Style | None = None,
) -> Axes:
    """Draw one result over two parameters, with contours.

    Parameters
    ----------
    x, y :
        (nx,) and (ny,) values of the parameters of a grid, rising; or (n,) places of samples.
    values :
        (ny, nx) results on the grid, or (n,) at the samples; nan where there is none, left empty.
    ax :
        axes to draw on; None makes a figure of its own (``ax.figure``).
    names :
        names of x, y and the values, with their units.
    wanted :
        a value whose contour is drawn heavily.
    style :
        "light" or "dark"; None: as the figure of ``ax`` is, light without one.

    Raises
    ------
    InvalidInputError
        where shapes do not fit, there are fewer than 2 x 2 (or 4 samples not on a line), or the
        values are all nan.
    """
    places = finite_row("x", x), finite_row("y", y)
    field = np.ma.masked_invalid(np.asarray(values, dtype=float))
    require_some("values", field.compressed())
    ax, look = prepare(ax, style)
    ax.set_facecolor(look.palette.contact)
    filled, lines = _contours(ax, look, places, field)
    _write_values(ax, look, lines)
    if wanted is not None:
        _wanted(ax, look, (*places, field), wanted, names[2])
    bar = figure_of(ax).colorbar(filled, ax=ax)
    bar.set_label(names[2], fontsize=look.size, color=look.palette.ink)
    bar.ax.tick_params(colors=look.palette.ink, labelsize=look.small)
    bar.outline.set_edgecolor(look.palette.muted)
    label(ax, look, names[0], names[1])
    return ax


def _contours(ax: Axes, look: Look, places: tuple[Array, Array], field: Any) -> tuple[Any, Any]:
    """Filled contours and lines: on a grid, or between samples."""
    x, y = places
    lines: dict[str, Any] = {"colors": look.palette.ink, "linewidths": look.thin, "levels": _LEVELS}
    colours: dict[str, Any] = {"cmap": look.palette.sequential, "levels": _LEVELS}
    if field.ndim == 2:
        if field.shape != (y.size, x.size) or min(field.shape) < 2:
            raise InvalidInputError(
                f"`values` must have shape ({y.size}, {x.size}), two or more each, as y and x "
                f"say, got {field.shape}."
            )
        return ax.contourf(x, y, field, **colours), ax.contour(x, y, field, **lines)
    if field.shape != x.shape or x.shape != y.shape:
        raise InvalidInputError(
            f"`values` must be as many as x and y, got {field.shape}, {x.shape} and {y.shape}."
        )
    there = ~np.ma.getmaskarray(field)
    points = (x[there], y[there], field.compressed())
    try:
        filled = ax.tricontourf(*points, **colours)
    except (ValueError, RuntimeError):
        raise InvalidInputError(
            f"`x` and `y` must hold 3 or more places not on a line, got {points[0].size}."
        ) from None
    drawn = ax.tricontour(*points, **lines)
    ax.plot(x, y, ".", color=look.palette.muted, markersize=0.25 * look.size)
    return filled, drawn


def _write_values(ax: Axes, look: Look, lines: Any) -> None:
    """Write the value of each contour on it, where it is farthest from the frame.

    A contour that is short, or near the frame everywhere, has none: the colours say it.
    """
    frame = np.array([ax.get_xlim(), ax.get_ylim()]).T
    places = []
    for segment in (one for level in lines.allsegs for one in level if len(one) > 1):
        steps = np.arange(len(segment))
        fine = np.linspace(0.0, steps[-1], 20 * steps[-1] + 1)
        points = np.stack([np.interp(fine, steps, column) for column in segment.T], axis=1)
        share = (points - frame[0]) / (frame[1] - frame[0])
        inside = np.minimum(share, 1.0 - share).min(axis=1)
        best = np.argmax(inside)
        if inside[best] > _EDGE and np.ptp(share, axis=0).max() > _SHORT:
            places.append(tuple(points[best]))
    ax.clabel(lines, fontsize=look.small, fmt="%.4g", manual=places)
    for text in lines.labelTexts:
        text.set_path_effects([withStroke(linewidth=2.5, foreground=look.palette.ground)])
        text.set_color(look.palette.ink)


def _wanted(
    ax: Axes, look: Look, field: tuple[Array, Array, Any], wanted: float, name: str
) -> None:
    x, y, values = field
    style: dict[str, Any] = {"colors": look.palette.ink, "linewidths": 1.4 * look.line}
    style["levels"] = [wanted]
    low, high = values.min(), values.max()
    if low < wanted < high:
        if values.ndim == 2:
            drawn: Any = ax.contour(x, y, values, **style)
        else:
            there = ~np.ma.getmaskarray(values)
            drawn = ax.tricontour(x[there], y[there], values.compressed(), **style)
        casing = withStroke(linewidth=2.4 * look.line, foreground=look.palette.ground)
        drawn.set_path_effects([casing])
    where = "" if low < wanted < high else " (not reached here)"
    line = Line2D([], [], color=look.palette.ink, linewidth=1.4 * look.line)
    line.set_label(f"{name} = {wanted:.5g}{where}")
    legend(ax, look, [line])
