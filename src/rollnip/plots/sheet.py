"""A sheet in the nip: shears on both of its faces, tension, pressures on both faces, path."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError
from rollnip.figures import PROFILES
from rollnip.plots.style import (
    Look,
    Style,
    heights,
    label,
    legend,
    mark_direction,
    prepare,
    shade,
    title,
    view,
)
from rollnip.sheet.result import SheetResult
from rollnip.sheet_figures import SHEET_PROFILES
from rollnip.solution import Solution

_Row = tuple[Any, str, str, str]  # values, colour, dashes and name of a curve

_UPPER = {key: f"{PROFILES[key].label}, upper side" for key in ("pressure", "shear")}
_SIDE = 0.35  # shown on either side, in nip widths
_FLAT = 1e-3  # of the nip width: what the scale of a straight path spans


def plot_sheet(solution: Solution, ax: Axes | None = None, *, style: Style | None = None) -> Axes:
    """Draw the shears on both faces of a sheet and its tension; zones of the upper face are shaded.

    Parameters
    ----------
    solution :
        what `solve` returned for a nip with a sheet.
    ax :
        axes to draw on; None makes a figure of its own (``ax.figure``).
    style :
        "light" or "dark"; None: as the figure of ``ax`` is, light without one.

    Returns
    -------
    Axes
        with x [mm] from the trailing to the leading edge and shear [MPa]; the tension [N/mm] is
        read on the right, where it reaches as far from 0 as the larger shear does.

    Raises
    ------
    InvalidInputError
        where the solution has no sheet, or the style is unknown.
    """
    sheet = _sheet_of(solution)
    ax, look = prepare(ax, style)
    times = _largest(sheet.profiles.tension) / _largest(
        solution.profiles.shear, sheet.profiles.shear_lower
    )
    rows: tuple[_Row, ...] = (
        (solution.profiles.shear, look.palette.shear, "--", _UPPER["shear"]),
        (sheet.profiles.shear_lower, look.palette.shear, ":", SHEET_PROFILES["shear_lower"].label),
        (
            sheet.profiles.tension / times,
            look.palette.pressure,
            "-",
            f"{SHEET_PROFILES['tension'].label} (right)",
        ),
    )
    lowest = min(0.0, *(float(np.min(row[0])) for row in rows))
    highest = max(0.0, *(float(np.max(row[0])) for row in rows))
    _draw(ax, look, solution, rows, view(solution, _SIDE), (lowest, highest))
    label(ax, look, PROFILES["x"].axis, PROFILES["shear"].axis)
    _on_right(ax, look, SHEET_PROFILES["tension"].axis, (0.0, times), look.palette.pressure)
    title(ax, look, solution, "Shears and tension of the sheet")
    return ax


def plot_sheet_path(
    solution: Solution, ax: Axes | None = None, *, style: Style | None = None
) -> Axes:
    """Draw the pressures on both faces of a sheet, and the path that it takes through the nip.

    Parameters
    ----------
    solution, ax, style : as in `plot_sheet`; zones of the upper face are shaded.

    Returns
    -------
    Axes
        with x [mm] from the trailing to the leading edge and pressure [MPa]; the height of the
        sheet over the top of the undeformed lower roller, its thickness left out [mm], is read on
        the right.

    Raises
    ------
    InvalidInputError
        where the solution has no sheet, or the style is unknown.
    """
    sheet = _sheet_of(solution)
    ax, look = prepare(ax, style)
    x, colours = solution.profiles.x, look.palette
    first, last = _both_contacts(solution)
    shown = (x >= first) & (x <= last)
    rows: tuple[_Row, ...] = (
        (solution.profiles.pressure, colours.upper, "-", _UPPER["pressure"]),
        (
            sheet.profiles.pressure_lower,
            colours.lower,
            "--",
            SHEET_PROFILES["pressure_lower"].label,
        ),
    )
    high = max(float(np.max(row[0])) for row in rows)
    height = sheet.profiles.height
    low, rise = float(np.min(height[shown])), float(np.ptp(height[shown]))
    times = (rise or _FLAT * solution.nip_width) / high
    path = ((height - low) / times, colours.ink, "-", f"{SHEET_PROFILES['height'].label} (right)")
    _draw(ax, look, solution, (*rows, path), (first, last), (0.0, high))
    label(ax, look, PROFILES["x"].axis, PROFILES["pressure"].axis)
    _on_right(ax, look, SHEET_PROFILES["height"].axis, (low, times), colours.ink)
    title(ax, look, solution, "Pressures on the sheet, and its path")
    return ax


def _draw(
    ax: Axes,
    look: Look,
    solution: Solution,
    rows: tuple[_Row, ...],
    along: tuple[float, float],
    up: tuple[float, float],
) -> None:
    """Draw the zones and some curves over x, from and to ``along`` and ``up``, with a legend."""
    zones = shade(ax, look, solution)
    ax.axhline(0.0, color=look.palette.muted, linewidth=look.thin)
    curves: list[Artist] = []
    for values, color, dashes, name in rows:
        drawn = ax.plot(solution.profiles.x, values, color=color, linestyle=dashes, label=name)
        drawn[0].set_linewidth(look.line)
        curves += drawn
    ax.set_xlim(*along)
    heights(ax, *up)
    mark_direction(ax, look, solution)
    legend(ax, look, curves + zones)


def _sheet_of(solution: Solution) -> SheetResult:
    sheet: SheetResult | None = solution.sheet
    if sheet is None:
        raise InvalidInputError("`solution` must be of a nip with a sheet, got one without.")
    return sheet


def _largest(*rows: NDArray[np.float64]) -> float:
    """Return the largest size of some values, 1 where all are 0."""
    return max(float(np.abs(row).max()) for row in rows) or 1.0


def _both_contacts(solution: Solution) -> tuple[float, float]:
    """Return the drawn range of x [mm], which holds the contacts of both faces."""
    (first, last), zones = view(solution, _SIDE), _sheet_of(solution).zones_lower
    reach = _SIDE * solution.nip_width
    x = solution.profiles.x
    if zones:
        first, last = min(first, zones[0].start - reach), max(last, zones[-1].stop + reach)
    return max(first, float(x[0])), min(last, float(x[-1]))


def _on_right(ax: Axes, look: Look, name: str, scale: tuple[float, float], color: str) -> None:
    """Add a scale on the right: the first of ``scale``, and the second times the left one."""
    first, times = scale
    functions = partial(_line, first, times), partial(_line, -first / times, 1.0 / times)
    right = ax.secondary_yaxis("right", functions=functions)
    right.set_ylabel(name, fontsize=look.size, color=color)
    right.tick_params(colors=color, labelsize=look.small)


def _line(first: float, times: float, value: Any) -> Any:
    return first + times * value
