"""One page about a solution: pictures and a table of its key figures."""

from __future__ import annotations

from collections.abc import Iterator
from textwrap import wrap
from typing import Any, NamedTuple

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rollnip._results.summary import line
from rollnip._units import format_quantity
from rollnip.figures import FIGURES, INTERFACE_FIGURES, PROFILES, PULL
from rollnip.plots.field import plot_field
from rollnip.plots.pressure import plot_pressure
from rollnip.plots.section import layer_texts
from rollnip.plots.sheet import plot_sheet
from rollnip.plots.style import (
    LETTER,
    MM,
    Look,
    PageLayout,
    Style,
    axes_inches,
    palette_of,
    text_width,
)
from rollnip.plots.surfaces import plot_deformed_surfaces, plot_strain
from rollnip.rollers import Roller
from rollnip.sheet_figures import SHEET_FIGURES
from rollnip.solution import Solution

_WIDTH, _HEIGHT = 297.0, 186.0  # mm, 16:10, as wide as a sheet of A4
_LOWER = 0.135
_PLACES = {
    "pressure": (0.055, 0.62, 0.3, 0.295),
    "field": (0.415, 0.62, 0.285, 0.295),
    "surfaces": (0.055, _LOWER, 0.3, 0.3),
    "strain": (0.415, _LOWER, 0.285, 0.3),
    "table": (0.79, 0.03, 0.205, 0.92),
}  # left, bottom, width, height
_BESIDE = 3.0  # a name, a mark and what is between them, in sizes of type
_REMARK = 0.02  # height of a line below; the lower pictures make room
_DIGITS = 4
_ROUNDING = 1e-9  # of the stresses inside
_MOST_LAYERS = 4  # listed of each roller
_REMARKS, _LETTERS = 3, 190  # lines, and how many letters each
_KEYS = {
    "Nip": ("load", "approach", "nip_width", "dwell_time", "peak_pressure", "mean_pressure"),
    "Drive": ("traction", "creepage", "torque_upper", "torque_lower"),
    "Losses": ("rolling_resistance", "dissipation.friction", "dissipation.viscous"),
}
_OF_SHEET = ("feed_upper", "feed_lower", "tension_max", "tension_min", "grip_reserve")
_SIGNS = (
    "x points to the inlet",
    "traction, creepage > 0: upper drives",
    "torque > 0: axle puts power in",
)


def plot_overview(solution: Solution, *, style: Style = "light") -> Figure:
    """Draw one page: pressure, normal stress inside, deformed surfaces, strain, key figures.

    With a sheet the shears on its faces and its tension take the place of the strain, and its
    feed, tension and grip are among the figures.

    Parameters
    ----------
    solution :
        what `solve` returned.
    style :
        "light" or "dark".

    Returns
    -------
    Figure
        297 mm by 186 mm, outside pyplot; `save_figure` writes it.

    Raises
    ------
    InvalidInputError
        where the style is unknown.
    """
    palette = palette_of(style)
    figure = Figure(figsize=(_WIDTH * MM, _HEIGHT * MM), facecolor=palette.ground)
    # places are fixed: legends and the colour bar have their room, and laying out takes no time
    figure.set_layout_engine(PageLayout(adjust_compatible=True, colorbar_gridspec=False))
    remarks = _remarks(solution)
    room = _REMARK * len(remarks)
    axes = {
        name: figure.add_axes(
            (left, low + room, width, height - room)
            if low == _LOWER
            else (left, low, width, height)
        )
        for name, (left, low, width, height) in _PLACES.items()
    }
    pressure = plot_pressure(solution, axes["pressure"], style=style)
    plot_field(solution, "s_zz", ax=axes["field"], style=style)
    plot_deformed_surfaces(solution, axes["surfaces"], style=style)
    has_sheet = solution.sheet is not None
    (plot_sheet if has_sheet else plot_strain)(solution, axes["strain"], style=style)
    look = Look(palette, pressure.xaxis.label.get_size())  # type: ignore[attr-defined]
    headings = {
        "pressure": "Pressure and shear",
        "field": "Normal stress inside",
        "surfaces": "Deformed surfaces",
        "strain": "Shears and tension of the sheet" if has_sheet else "Strain of the surfaces",
    }
    for name, text in headings.items():
        axes[name].set_title(text, loc="left", fontsize=1.05 * look.size, color=palette.ink)
    for name in ("pressure", "surfaces"):
        _make_room(axes[name], look)
    _table(axes["table"], look, solution)
    _head_and_foot(figure, look, solution, remarks)
    return figure


def _make_room(ax: Axes, look: Look) -> None:
    """Begin axes at the left of the page farther in, where numbers are too long for their names."""
    numbers = ax.yaxis.get_major_formatter().format_ticks(ax.get_yticks())  # type: ignore[arg-type]
    points = max(text_width(number, look.small) for number in numbers) + _BESIDE * look.size
    left, (first, low, last, high) = points / (72.0 * _WIDTH * MM), ax.get_position().extents
    if left > first:
        ax.set_position((left, low, last - left, high - low))


class _Row(NamedTuple):
    """A line of the table; a heading where there is no value."""

    name: str
    value: str | None = None
    unit: str = ""


def _number(name: str, value: float, unit: str = "", size: float = 0.0) -> _Row:
    """A number; 0 where it is a rounding error of ``size``."""
    rounded = 0.0 if abs(value) < _ROUNDING * size else value
    return _Row(name, format_quantity(rounded, digits=_DIGITS).replace("-", "−"), unit)


def _figure(key: str, solution: Solution) -> _Row:
    """A figure of the registry; a dash where it is not defined."""
    one = line(FIGURES[key] if key in FIGURES else SHEET_FIGURES[key], solution)
    return _Row(one.label, "–" if one.value == "-" else one.value.replace("-", "−"), one.unit)


def _rows(solution: Solution) -> Iterator[_Row]:
    for heading, keys in _KEYS.items():
        yield _Row(heading)
        yield from (_figure(key, solution) for key in keys)
    if solution.sheet is not None:
        yield _Row("Sheet")
        for row in (_figure(f"sheet.{key}", solution) for key in _OF_SHEET):
            yield row._replace(name=row.name.replace("over the", "over"))  # room for the number
        yield _Row(f"slides first where pulled: {solution.sheet.grip.first} side", "")
    yield from _bond_rows(solution)
    yield from _roller_rows("Upper roller", solution.nip.upper)
    yield from _roller_rows("Lower roller", solution.nip.lower)
    yield _Row("Signs")
    yield from (_Row(text, "") for text in _SIGNS)


def _bond_rows(solution: Solution) -> Iterator[_Row]:
    """Yield the shear range and the largest pull on the bond of each covering."""
    bonds = [one for one in solution.interfaces if one.is_bond]
    if bonds:
        yield _Row("Bond to the core")
    for bond in bonds:
        name, size = bond.roller, bond.peel_range
        for one in (INTERFACE_FIGURES["shear_range"], PULL):
            yield _number(f"{one.label}, {name}", one.value(bond) or 0.0, one.shown_unit, size=size)


def _roller_rows(name: str, roller: Roller) -> Iterator[_Row]:
    yield _Row(name)
    yield _number("radius", roller.radius, PROFILES["x"].shown_unit)
    if roller.is_rigid:
        yield _Row("rigid", "")
    texts = [text.replace("\n", ", ") for text in layer_texts(roller)]
    for text in texts[:_MOST_LAYERS]:
        yield _Row(text, "")
    if len(texts) > _MOST_LAYERS:
        yield _Row(f"and {len(texts) - _MOST_LAYERS} more", "")


def _table(ax: Axes, look: Look, solution: Solution) -> None:
    """Key figures as lines of text: name, number, unit."""
    ax.set_axis_off()
    colours = look.palette
    rows = list(_rows(solution))
    if solution.converged:
        status, colour = f"verified; geometry {solution.model.geometry}", colours.muted
    else:
        status, colour = "NOT CONVERGED", colours.alert
    heights = [0.0]
    for row in rows:
        heights.append(heights[-1] + (1.6 if row.value is None else 1.0))
    step = min(1.45 * look.small / (72.0 * axes_inches(ax)[1]), 0.97 / (heights[-1] + 1.0))
    size = min(look.small, step * 72.0 * axes_inches(ax)[1] / 1.3)
    common: dict[str, Any] = {
        "transform": ax.transAxes,
        "fontsize": size,
        "va": "baseline",
        "in_layout": False,
    }
    ax.text(0.0, 1.0 - step, status, color=colour, **common)
    for row, below in zip(rows, heights[1:], strict=True):
        y = 1.0 - (below + 1.0) * step
        if row.value is None:
            ax.text(0.0, y, row.name, color=colours.ink, weight="bold", **common)
            continue
        ax.text(0.03, y, row.name, color=colours.ink, **common)
        ax.text(0.72, y, row.value, color=colours.ink, ha="right", **common)
        ax.text(0.75, y, row.unit, color=colours.muted, **common)


def _remarks(solution: Solution) -> list[str]:
    """Return the failure, if any, and the warnings, as a few lines."""
    warnings = [] if solution.converged else [solution.status]
    warnings += [f"Note: {warning}" for warning in solution.warnings]
    return wrap(" ".join(warnings), _LETTERS, max_lines=_REMARKS, placeholder=" ...")


def _head_and_foot(figure: Figure, look: Look, solution: Solution, remarks: list[str]) -> None:
    """Title above; remarks below."""
    size = 1.5 * look.size
    letters = int(0.9 * 72.0 * figure.get_figwidth() / (LETTER * size))
    name = wrap(solution.nip.title or "Nip", letters, max_lines=1, placeholder=" ...")
    common: dict[str, Any] = {"x": 0.012, "ha": "left", "parse_math": False}
    figure.text(
        y=0.985,
        s=name[0] if name else "Nip",
        va="top",
        fontsize=size,
        weight="bold",
        color=look.palette.ink,
        **common,
    )
    figure.text(
        y=0.012,
        s="\n".join(remarks),
        va="bottom",
        fontsize=look.small,
        color=look.palette.muted,
        **common,
    )
