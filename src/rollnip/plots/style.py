"""The style that all pictures share: light or dark, wide or narrow. It sets nothing globally."""

from __future__ import annotations

from dataclasses import dataclass
from difflib import get_close_matches
from textwrap import wrap
from typing import Any, Literal

import numpy as np
from matplotlib import colormaps, rcParams
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import Colormap, LinearSegmentedColormap, to_rgba
from matplotlib.figure import Figure, SubFigure
from matplotlib.font_manager import FontProperties
from matplotlib.layout_engine import PlaceHolderLayoutEngine
from matplotlib.patches import Patch
from matplotlib.textpath import text_to_path

from rollnip._errors import InvalidInputError, require_positive
from rollnip.solution import Solution

Style = Literal["light", "dark"]

MM = 1.0 / 25.4  # inches
FULL, COLUMN = 180.0, 85.0  # mm, widths of a page and of a column
MARK = 0.32  # size of a mark over the size of type
_GOLDEN = 0.6
_NARROW, _WIDE = 2.6, 5.5  # inches of axes at which type is smallest and full-sized
_ROOM = 1.06  # largest width of a legend, in widths of the axes
_SMALLEST = 0.72
_TYPE = 10.0  # pt
_MANY = 8  # pieces of contact
LETTER = 0.53  # mean width of a letter, in sizes


@dataclass(frozen=True, slots=True)
class Palette:
    """Colours of one style; told apart by people with any one kind of cone missing."""

    ground: str
    ink: str
    muted: str
    pressure: str
    shear: str
    upper: str
    lower: str
    contact: str
    stick: str
    slip: str
    hatch: str
    core: str
    alert: str
    diverging: Colormap
    sequential: Colormap


LIGHT = Palette(
    ground="#ffffff",
    ink="#1a1a1a",
    muted="#595959",
    pressure="#0072b2",
    shear="#c94a00",
    upper="#00705a",
    lower="#a0489c",
    contact="#ececec",
    stick="#e3edf4",
    slip="#f9e6d3",
    hatch="#c9a27c",
    core="#dcdcdc",
    alert="#b00020",
    diverging=colormaps["RdBu_r"],
    sequential=LinearSegmentedColormap.from_list(
        "rollnip_light", ["#fdfcf7", "#fddfa0", "#f9a26b", "#d9546c", "#8c2981", "#3b0f70"]
    ),
)
DARK = Palette(
    ground="#15181c",
    ink="#e8e8e8",
    muted="#a9adb2",
    pressure="#5cb8f0",
    shear="#ff9d4d",
    upper="#4fd6b4",
    lower="#dba6ee",
    contact="#2a2e33",
    stick="#22323f",
    slip="#43331f",
    hatch="#94713f",
    core="#3c4147",
    alert="#ff7b86",
    diverging=LinearSegmentedColormap.from_list(
        "rollnip_dark",
        ["#b4defc", "#4b9fdf", "#1c5485", "#15181c", "#8a3b12", "#e8813a", "#ffd9b0"],
    ),
    sequential=LinearSegmentedColormap.from_list(
        "rollnip_dark_positive",
        ["#15181c", "#44196b", "#98317e", "#e25165", "#fca36e", "#fcfdbf"],
    ),
)
_PALETTES = {"light": LIGHT, "dark": DARK}


class PageLayout(PlaceHolderLayoutEngine):
    """Axes at fixed places that leave room around them for type of our own size."""


@dataclass(frozen=True, slots=True)
class Look:
    """The colours of a drawing, and a size of type [pt] that suits the width of its axes."""

    palette: Palette
    size: float

    @property
    def small(self) -> float:
        """Size of remarks, legends and numbers [pt]."""
        return 0.88 * self.size

    @property
    def line(self) -> float:
        """Width of a curve [pt]."""
        return 0.19 * self.size

    @property
    def thin(self) -> float:
        """Width of a thin line [pt]."""
        return 0.09 * self.size


def new_axes(width: float = FULL, height: float | None = None, style: Style = "light") -> Axes:
    """Axes on a figure of their own, outside pyplot.

    Parameters
    ----------
    width, height :
        of the figure [mm]; 180 fills a page and 85 a column. The height is 0.6 of the width by
        default, or what that leaves too small 0.75.
    style :
        "light" or "dark".

    Returns
    -------
    Axes
        whose ``figure`` can be saved.

    Raises
    ------
    InvalidInputError
        where a length is not positive and finite, or the style is unknown.
    """
    require_positive("width", width)
    if height is None:
        height = (_GOLDEN if width > 1.2 * COLUMN else 0.75) * width
    require_positive("height", height)
    ground = palette_of(style).ground
    return page(style, height, width).subplots(subplot_kw={"facecolor": ground})


def page(style: str, height: float, width: float = FULL) -> Figure:
    """Return an empty page of a height and a width [mm], outside pyplot."""
    ground = palette_of(style).ground
    return Figure(figsize=(width * MM, height * MM), layout="constrained", facecolor=ground)


def palette_of(style: str) -> Palette:
    """Colours of a style; InvalidInputError where it is unknown."""
    require_choice("style", style, tuple(_PALETTES))
    return _PALETTES[style]


def require_choice(name: str, value: object, choices: tuple[str, ...]) -> None:
    """Raise InvalidInputError, naming the nearest choice, unless ``value`` is one of them."""
    if isinstance(value, str) and value in choices:
        return
    near = get_close_matches(str(value).lower().replace("-", "_"), choices, n=1, cutoff=0.4)
    hint = f' Did you mean "{near[0]}"?' if near else ""
    shown = f'"{value}"' if isinstance(value, str) else repr(value)
    raise InvalidInputError(f"`{name}` must be one of {', '.join(choices)}, got {shown}.{hint}")


def prepare(ax: Axes | None, style: Style | None) -> tuple[Axes, Look]:
    """Axes to draw on, in the wanted style.

    Without axes a figure is made. Given axes and no style: light or dark ink as the figure's
    ground needs it; given both, ground and figure are painted too.
    """
    if ax is None:
        ax = new_axes(style=style or "light")
    elif style is not None:
        ground = palette_of(style).ground
        ax.set_facecolor(ground)
        figure_of(ax).set_facecolor(ground)
    palette = _palette_on(ax) if style is None else palette_of(style)
    look = Look(palette, _size_on(ax))
    ax.tick_params(which="both", colors=palette.ink, labelsize=look.small)
    for spine in ax.spines.values():
        spine.set_edgecolor(palette.muted)
    return ax, look


def figure_of(ax: Axes) -> Figure:
    """The whole figure that axes belong to."""
    figure = ax.figure
    while not isinstance(figure, Figure):
        figure = figure.figure
    return figure


def _palette_on(ax: Axes) -> Palette:
    """Return the light or the dark palette, after the background of the figure."""
    figure = ax.figure
    while isinstance(figure, SubFigure) and to_rgba(figure.get_facecolor())[3] == 0.0:
        figure = figure.figure
    red, green, blue, alpha = to_rgba(figure.get_facecolor())
    brightness = 0.299 * red + 0.587 * green + 0.114 * blue
    return DARK if alpha > 0.0 and brightness < 0.5 else LIGHT


def _size_on(ax: Axes) -> float:
    """Size of type for the width of the axes, around the user's own size."""
    part = (axes_inches(ax)[0] - _NARROW) / (_WIDE - _NARROW)
    factor = _SMALLEST + (1.0 - _SMALLEST) * float(np.clip(part, 0.0, 1.0))
    if isinstance(figure_of(ax).get_layout_engine(), PageLayout):
        return factor * _TYPE
    return factor * float(rcParams["font.size"])


def axes_inches(ax: Axes) -> tuple[float, float]:
    """Width and height of the axes before layout [inches]."""
    box, dpi = ax.get_window_extent(), ax.figure.dpi
    return float(box.width / dpi), float(box.height / dpi)


def label(ax: Axes, look: Look, x: str, y: str) -> None:
    """Name both axes."""
    ax.set_xlabel(x, fontsize=look.size, color=look.palette.ink)
    ax.set_ylabel(y, fontsize=look.size, color=look.palette.ink)


def title(ax: Axes, look: Look, solution: Solution, default: str, room: float = 1.0) -> None:
    """Title on the left, on the given part of the axes' width; says where it did not converge."""
    text = solution.nip.title or default
    if not solution.converged:
        text = f"NOT CONVERGED: {text}"
    size = 1.1 * look.size
    letters = max(12, int(room * 72.0 * axes_inches(ax)[0] / (LETTER * size)))
    lines = wrap(text, letters, max_lines=2, placeholder=" ...") or [default]
    colour = look.palette.ink if solution.converged else look.palette.alert
    ax.set_title("\n".join(lines), loc="left", fontsize=size, color=colour, parse_math=False)


def legend(ax: Axes, look: Look, handles: list[Artist]) -> None:
    """Legend below the axes, in as many columns as their width takes.

    Inside them where the figure has no layout engine that would give it room.
    """
    widths = [text_width(str(handle.get_label()), look.small) for handle in handles]
    columns = len(handles)
    room = _ROOM * 72.0 * axes_inches(ax)[0]
    while columns > 1 and _legend_width(widths, columns, look.small) > room:
        columns -= 1
    place: dict[str, Any]
    if figure_of(ax).get_layout_engine() is None:
        # below the arrows
        place = {"loc": "best", "bbox_to_anchor": (0.0, 0.0, 1.0, 0.91), "edgecolor": "none"}
        place["facecolor"] = look.palette.ground
    else:
        place = {"loc": "upper center", "bbox_to_anchor": (0.5, 0.0), "frameon": False}
        place |= {"borderaxespad": below_axes(look) / look.small, "ncols": columns}
    ax.legend(
        handles=handles,
        handlelength=2.4,
        columnspacing=1.6,
        fontsize=look.small,
        labelcolor=look.palette.ink,
        **place,
    )


def below_axes(look: Look) -> float:
    """Return the height that the numbers and the name of the abscissa take [pt]."""
    return 14.0 + 1.2 * (look.small + look.size)


def text_width(text: str, size: float) -> float:
    """Width of a line of text [pt]."""
    font = FontProperties(size=size)
    return float(text_to_path.get_text_width_height_descent(text, font, ismath=False)[0])


def _legend_width(widths: list[float], columns: int, size: float) -> float:
    """Width of a legend filled column by column [pt].

    4.8: handle and the spaces beside it; 0.8: what the last column has less than that, but for
    the room around all.
    """
    full = sum(float(part.max()) + 4.8 * size for part in np.array_split(widths, columns))
    return full - 0.8 * size


def shade(ax: Axes, look: Look, solution: Solution) -> list[Artist]:
    """Shade stick and slip (without friction: the contact); returns what a legend shows."""
    colours = look.palette
    if not solution.zones:
        _shade_contact(ax, look, solution.contact)
        return [_swatch(look, "contact", colours.contact)]
    shown: dict[str, Artist] = {}
    for zone in sorted(solution.zones, key=lambda zone: zone.state != "stick"):
        name, fill, hatch = _kind(zone.state, zone.direction, colours)
        ax.axvspan(
            zone.start,
            zone.stop,
            facecolor=fill,
            hatch=hatch,
            edgecolor=colours.hatch,
            linewidth=0.0,
            zorder=0.5,
        )
        shown[name] = _swatch(look, name, fill, hatch)
    return list(shown.values())


def _shade_contact(ax: Axes, look: Look, contact: tuple[tuple[float, float], ...]) -> None:
    """Shade the contact; rough rollers may touch in thousands of pieces, drawn as one."""
    if len(contact) > _MANY:
        pieces = [(trailing, leading - trailing) for trailing, leading in contact]
        ax.broken_barh(
            pieces,
            (0.0, 1.0),
            transform=ax.get_xaxis_transform(),
            facecolor=look.palette.contact,
            linewidth=0.0,
            zorder=0.5,
        )
        return
    for trailing, leading in contact:
        ax.axvspan(trailing, leading, facecolor=look.palette.contact, linewidth=0.0, zorder=0.5)


def _kind(state: str, direction: int | None, colours: Palette) -> tuple[str, str, str]:
    if state == "stick":
        return "stick", colours.stick, ""
    if direction == -1:
        return "slip, upper faster", colours.slip, "////"
    return "slip, lower faster", colours.slip, "\\\\\\\\"


def _swatch(look: Look, name: str, fill: str, hatch: str = "") -> Artist:
    edge = look.palette.hatch if hatch else look.palette.muted
    return Patch(facecolor=fill, hatch=hatch, edgecolor=edge, linewidth=0.5, label=name)


def mark_direction(ax: Axes, look: Look, solution: Solution) -> None:
    """Arrows along the motion: into the nip at the leading edge, out of it at the trailing one."""
    edges = ((solution.contact[-1][1], "inlet", 1), (solution.contact[0][0], "outlet", -1))
    for x, text, side in edges:
        ax.annotate(
            text,
            xy=(x + 0.02 * side * solution.nip_width, 0.95),
            xycoords=ax.get_xaxis_transform(),
            xytext=(1.6 * side * look.size, 0.0),
            textcoords="offset points",
            ha="left" if side > 0 else "right",
            va="center",
            fontsize=look.small,
            color=look.palette.muted,
            arrowprops={
                "arrowstyle": "-|>" if side > 0 else "<|-",
                "color": look.palette.muted,
                "linewidth": look.thin,
                "shrinkA": 1.0,
                "shrinkB": 0.0,
            },
        )


def view(solution: Solution, side: float) -> tuple[float, float]:
    """Return the drawn range of x [mm]: ``side`` nip widths beyond the contact, if computed."""
    x, reach = solution.profiles.x, side * solution.nip_width
    first, last = solution.contact[0][0] - reach, solution.contact[-1][1] + reach
    return max(first, float(x[0])), min(last, float(x[-1]))


def heights(ax: Axes, low: float, high: float) -> None:
    """Limits of the ordinate, with room above for the arrows."""
    span = (high - low) or max(abs(high), 1e-12)
    ax.set_ylim(low - 0.08 * span, high + 0.18 * span)
