"""A sheet in the nip: the shears on both of its faces, and the tension along it."""

from __future__ import annotations

from functools import partial
from operator import mul
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes

from rollnip._errors import InvalidInputError
from rollnip.plots.style import (
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
from rollnip.solution import Solution

_SIDE = 0.35  # shown on either side, in nip widths


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
        read on the right, where a shear over the whole nip stands for the tension it makes.

    Raises
    ------
    InvalidInputError
        where the solution has no sheet, or the style is unknown.
    """
    sheet = solution.sheet
    if sheet is None:
        raise InvalidInputError("`solution` must be of a nip with a sheet, got one without.")
    ax, look = prepare(ax, style)
    x, width = solution.profiles.x, solution.nip_width
    zones = shade(ax, look, solution)
    ax.axhline(0.0, color=look.palette.muted, linewidth=look.thin)
    rows: tuple[tuple[Any, str, str, str], ...] = (
        (solution.profiles.shear, look.palette.shear, "--", "shear of the upper roller"),
        (sheet.profiles.shear_lower, look.palette.shear, ":", "shear on the underside"),
        (sheet.profiles.tension / width, look.palette.pressure, "-", "tension (right)"),
    )
    curves: list[Artist] = []
    for values, color, dashes, name in rows:
        curves += ax.plot(x, values, color=color, linestyle=dashes, linewidth=look.line, label=name)
    ax.set_xlim(*view(solution, _SIDE))
    heights(
        ax,
        min(0.0, *(float(np.min(row[0])) for row in rows)),
        max(0.0, *(float(np.max(row[0])) for row in rows)),
    )
    label(ax, look, "x [mm]", "shear [MPa]")
    right = ax.secondary_yaxis("right", functions=(partial(mul, width), partial(mul, 1.0 / width)))
    right.set_ylabel("tension [N/mm]", fontsize=look.size, color=look.palette.pressure)
    right.tick_params(colors=look.palette.pressure, labelsize=look.small)
    title(ax, look, solution, "Shears and tension of the sheet")
    mark_direction(ax, look, solution)
    legend(ax, look, curves + zones)
    return ax
