"""Pressure and shear along the nip."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes

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
from rollnip.sheet_figures import SHEET_PROFILES
from rollnip.solution import Solution

_SIDE = 0.35  # shown on either side, in nip widths


def plot_pressure(
    solution: Solution, ax: Axes | None = None, *, style: Style | None = None
) -> Axes:
    """Draw pressure, shear and the traction bound +-mu p over x; stick and slip are shaded.

    With a sheet they are those of its upper face; the pressure on the other face is drawn too
    where the sheet resists bending.

    Parameters
    ----------
    solution :
        what `solve` returned.
    ax :
        axes to draw on; None makes a figure of its own (``ax.figure``).
    style :
        "light" or "dark"; None: as the figure of ``ax`` is, light without one.

    Returns
    -------
    Axes
        with x [mm] from the trailing to the leading edge, and stress [MPa].

    Raises
    ------
    InvalidInputError
        where the style is unknown.
    """
    ax, look = prepare(ax, style)
    profiles, friction = solution.profiles, solution.nip.friction_on("upper")
    zones = shade(ax, look, solution)
    ax.axhline(0.0, color=look.palette.muted, linewidth=look.thin)
    curves: list[Artist] = [
        *ax.plot(
            profiles.x,
            profiles.pressure,
            color=look.palette.pressure,
            linewidth=look.line,
            label=f"{PROFILES['pressure'].label} p",
        )
    ]
    high = float(np.max(profiles.pressure))
    if solution.sheet is not None and solution.sheet.bends:
        below = solution.sheet.profiles.pressure_lower
        dashes: dict[str, Any] = {
            "linewidth": look.line,
            "linestyle": "-.",
            "label": SHEET_PROFILES["pressure_lower"].label,
        }
        curves += ax.plot(profiles.x, below, color=look.palette.pressure, **dashes)
        high = max(high, float(np.max(below)))
    if friction > 0.0:
        curves += _shear(ax, look, solution)
    ax.set_xlim(*view(solution, _SIDE))
    # the bound of a high friction may leave the picture
    low, most = float(np.min(profiles.shear)), float(np.max(profiles.shear))
    heights(ax, min(0.0, low), max(most, high))
    label(ax, look, PROFILES["x"].axis, PROFILES["pressure"].axis_for("stress"))
    title(ax, look, solution, "Pressure and shear in the nip")
    mark_direction(ax, look, solution)
    legend(ax, look, curves + zones)
    return ax


def _shear(ax: Axes, look: Look, solution: Solution) -> list[Artist]:
    """Shear and its bound on either side."""
    profiles, friction = solution.profiles, solution.nip.friction_on("upper")
    bound = friction * profiles.pressure
    dotted: dict[str, Any] = {
        "color": look.palette.muted,
        "linewidth": 1.3 * look.thin,
        "linestyle": ":",
    }
    curves: list[Artist] = [
        *ax.plot(
            profiles.x,
            profiles.shear,
            color=look.palette.shear,
            linewidth=look.line,
            linestyle="--",
            label=f"{PROFILES['shear'].label} q on the upper roller",
        )
    ]
    name = f"traction bound ±µp, µ = {friction:g}"
    curves += ax.plot(profiles.x, bound, label=name, **dotted)
    ax.plot(profiles.x, -bound, **dotted)
    return curves
