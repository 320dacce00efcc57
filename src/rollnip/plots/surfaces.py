"""Both surfaces: strain, speed, gap, shape."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.layout_engine import ConstrainedLayoutEngine
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError, require_positive
from rollnip.figures import PROFILES
from rollnip.plots.style import (
    Look,
    Style,
    axes_inches,
    figure_of,
    heights,
    label,
    legend,
    mark_direction,
    prepare,
    shade,
    title,
    view,
)
from rollnip.rollers import Roller
from rollnip.rolling import Displacements, surface_depths
from rollnip.solution import Solution

Array = NDArray[np.float64]

_X = PROFILES["x"].axis
_SIDE = 0.8  # shown of strain and speed on either side, in nip widths
_NEAR = 0.45  # of gap and surfaces
_LEFT = 0.8
_FACTORS = (
    1.0,
    1.5,
    2.0,
    3.0,
    4.0,
    5.0,
    6.0,
    8.0,
    10.0,
    15.0,
    20.0,
    30.0,
    50.0,
    100.0,
    200.0,
    500.0,
)


def plot_strain(solution: Solution, ax: Axes | None = None, *, style: Style | None = None) -> Axes:
    """Draw the strain of both surfaces along x, in and outside the nip.

    Parameters
    ----------
    solution, ax, style : as in `plot_pressure`.

    Returns
    -------
    Axes
        with x [mm] and the strain du_x/dx [%] ("curved": stretch less 1), tension positive.

    Raises
    ------
    InvalidInputError
        where the style is unknown.
    """
    ax, look = prepare(ax, style)
    profiles = solution.profiles
    zones = shade(ax, look, solution)
    ax.axhline(0.0, color=look.palette.muted, linewidth=look.thin)
    strains = (100.0 * profiles.strain_upper, 100.0 * profiles.strain_lower)
    curves = _pair(ax, look, solution, *strains)
    _finish(ax, look, solution, strains, _SIDE)
    label(ax, look, _X, PROFILES["strain_upper"].axis_for("surface strain"))
    title(ax, look, solution, "Strain of the surfaces")
    legend(ax, look, curves + zones)
    return ax


def plot_speed(solution: Solution, ax: Axes | None = None, *, style: Style | None = None) -> Axes:
    """Draw the speed of both surfaces along x, what laser-Doppler anemometry measures.

    Thin lines: the circumferential speeds of the undeformed rollers.

    Parameters
    ----------
    solution, ax, style : as in `plot_pressure`.

    Returns
    -------
    Axes
        with x [mm] and speed [mm/s]; the surfaces move towards -x.

    Raises
    ------
    InvalidInputError
        where the nip has no speed or its creepage is free, or the style is unknown.
    """
    profiles = solution.profiles
    upper, lower = profiles.speed_upper, profiles.speed_lower
    if upper is None or lower is None:
        missing = "`speed`" if solution.nip.speed is None else "friction: its creepage is free"
        raise InvalidInputError(
            f"`solution` must have surface speeds to draw, got a nip without {missing}."
        )
    ax, look = prepare(ax, style)
    zones = shade(ax, look, solution)
    colours = look.palette
    # v = V (1 + strain) on each roller
    rollers = (upper / (1.0 + profiles.strain_upper), lower / (1.0 + profiles.strain_lower))
    for speed, colour in zip(rollers, (colours.upper, colours.lower), strict=True):
        ax.axhline(float(speed[0]), color=colour, linewidth=look.thin, linestyle=(0, (6, 3)))
    curves = _pair(ax, look, solution, upper, lower)
    _finish(ax, look, solution, (upper, lower), _SIDE)
    label(ax, look, _X, PROFILES["speed_upper"].axis_for("surface speed"))
    ax.ticklabel_format(axis="y", useOffset=False)
    title(ax, look, solution, "Speed of the surfaces")
    rim = ax.plot(
        [], [], color=colours.muted, linewidth=look.thin, linestyle=(0, (6, 3)), label="undeformed"
    )
    legend(ax, look, [*curves, *rim, *zones])
    return ax


def plot_gap(solution: Solution, ax: Axes | None = None, *, style: Style | None = None) -> Axes:
    """Draw the distance of the surfaces along x; thin: of the undeformed ones, where they part.

    Parameters
    ----------
    solution, ax, style : as in `plot_pressure`.

    Returns
    -------
    Axes
        with x [mm] and gap [mm], 0 in contact.

    Raises
    ------
    InvalidInputError
        where the style is unknown.
    """
    ax, look = prepare(ax, style)
    zones = shade(ax, look, solution)
    profiles = solution.profiles
    colours = look.palette
    ax.axhline(0.0, color=colours.muted, linewidth=look.thin)
    curves: list[Artist] = [
        *ax.plot(
            profiles.x,
            profiles.gap,
            color=colours.pressure,
            linewidth=look.line,
            label=PROFILES["gap"].label,
        )
    ]
    if solution.approach is not None:
        upper, lower = _outlines(solution, profiles.x)
        apart = upper - lower
        curves += ax.plot(
            profiles.x, apart, label="undeformed rollers (< 0: overlap)", **_thin(look)
        )
        _finish(ax, look, solution, (profiles.gap, apart), _NEAR)
    else:
        _finish(ax, look, solution, (profiles.gap,), _NEAR)
    ax.set_ylim(top=1.18 * float(np.max(_within(solution, profiles.gap, _NEAR))))
    label(ax, look, _X, PROFILES["gap"].axis)
    title(ax, look, solution, "Gap between the surfaces")
    legend(ax, look, curves + zones)
    return ax


def plot_deformed_surfaces(
    solution: Solution,
    ax: Axes | None = None,
    *,
    exaggeration: float | None = None,
    style: Style | None = None,
) -> Axes:
    """Draw both deformed surfaces; thin: the undeformed ones at the same approach.

    Of a sheet the thickness is left out; a line between the surfaces is the path of one that bends.

    Parameters
    ----------
    solution, ax, style :
        as in `plot_pressure`.
    exaggeration :
        how much heights are stretched against x; 1 is to scale; None: what fits. The axis says it.

    Returns
    -------
    Axes
        with x [mm] and the height above the top of the undeformed lower roller [mm].

    Raises
    ------
    InvalidInputError
        where the exaggeration is not positive and finite, or the style is unknown.
    """
    if exaggeration is not None:
        require_positive("exaggeration", exaggeration)
    ax, look = prepare(ax, style)
    x = solution.deformed_surfaces.x
    upper, lower = solution.deformed_surfaces.upper, solution.deformed_surfaces.lower
    curves = _pair(ax, look, solution, upper, lower, x)
    shown = [upper, lower]
    if solution.sheet is not None and solution.sheet.bends:
        path = solution.sheet.profiles.height
        curves += ax.plot(x, path, color=look.palette.ink, linewidth=look.thin, label="sheet")
    if solution.approach is not None:  # a half-space sinks by an unknown amount
        outlines = _outlines(solution, x)
        thin = [ax.plot(x, line, **_thin(look))[0] for line in outlines]
        thin[0].set_label("undeformed")
        curves.append(thin[0])
        shown += outlines
    seen = np.concatenate([_within(solution, line, _NEAR) for line in shown])
    low, high = float(np.min(seen)), float(np.max(seen))
    far = 20.0 * (high - low)
    for line, edge, colour in (
        (upper, high + far, look.palette.upper),
        (lower, low - far, look.palette.lower),
    ):
        ax.fill_between(x, line, edge, color=colour, alpha=0.16, linewidth=0.0)
    factor = _stretch(ax, view(solution, _NEAR), (low, high), exaggeration)
    scale = "to scale" if factor == 1.0 else f"stretched {factor:g} times"
    label(ax, look, _X, f"{PROFILES['gap'].axis_for('height')}, {scale}")
    title(ax, look, solution, "Deformed surfaces")
    mark_direction(ax, look, solution)
    legend(ax, look, curves)
    return ax


def _pair(
    ax: Axes, look: Look, solution: Solution, upper: Array, lower: Array, x: Array | None = None
) -> list[Artist]:
    """One curve for each roller."""
    places = solution.profiles.x if x is None else x
    names = (_name("upper", solution.nip.upper), _name("lower", solution.nip.lower))
    curves = ax.plot(places, upper, color=look.palette.upper, linewidth=look.line, label=names[0])
    curves += ax.plot(
        places,
        lower,
        color=look.palette.lower,
        linewidth=look.line,
        linestyle=(0, (3.2, 1.4)),
        label=names[1],
    )
    return list(curves)


def _name(name: str, roller: Roller) -> str:
    return f"{name} roller (rigid)" if roller.is_rigid else f"{name} roller"


def _thin(look: Look) -> dict[str, Any]:
    return {"color": look.palette.ink, "linewidth": look.thin, "linestyle": (0, (6, 3))}


def _within(solution: Solution, curve: Array, side: float) -> Array:
    """Values of a profile that are shown, those at the edges of the window interpolated."""
    first, last = view(solution, side)
    x = solution.profiles.x
    edges = np.interp([first, last], x, curve)
    return np.concatenate([curve[(x > first) & (x < last)], edges])


def _finish(
    ax: Axes, look: Look, solution: Solution, curves: tuple[Array, ...], side: float
) -> None:
    """Limits around what is shown, and the direction of motion."""
    ax.set_xlim(*view(solution, side))
    shown = np.concatenate([_within(solution, curve, side) for curve in curves])
    heights(ax, float(np.min(shown)), float(np.max(shown)))
    mark_direction(ax, look, solution)


def _outlines(solution: Solution, x: Array) -> tuple[Array, Array]:
    """Heights of the undeformed surfaces, in the frame and the gap model of the solution."""
    still = Displacements(np.zeros((4, x.size)))
    upper, lower = surface_depths(x, solution.nip, solution.model.geometry, still)
    return upper - (solution.approach or 0.0), -lower


def _stretch(
    ax: Axes, along: tuple[float, float], up: tuple[float, float], wanted: float | None
) -> float:
    """Fix the scale of heights and the limits around them; returns the exaggeration."""
    width, height = axes_inches(ax)
    if isinstance(figure_of(ax).get_layout_engine(), ConstrainedLayoutEngine):
        height *= _LEFT  # title, names and legend will take the rest
    room, least = (height / width) * (along[1] - along[0]), 1.3 * (up[1] - up[0])
    factor = wanted or max((f for f in _FACTORS if f <= room / least), default=1.0)
    span = max(room / factor, least)
    middle = 0.5 * (up[0] + up[1]) + 0.05 * span
    # the window grows where the axes are larger, without a word only where it is not fixed
    ax.set_xlim(*along, auto=True)
    ax.set_ylim(middle - 0.5 * span, middle + 0.5 * span, auto=True)
    ax.set_aspect(factor, adjustable="datalim")
    return factor
