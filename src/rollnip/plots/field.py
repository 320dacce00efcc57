"""Contours of a field over the cross-section of the rollers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Colormap
from matplotlib.contour import QuadContourSet
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.ticker import FuncFormatter, MaxNLocator
from matplotlib.transforms import Affine2D, ScaledTranslation, blended_transform_factory
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError, require_positive
from rollnip.figures import INTERFACE_FIGURES, PROFILES
from rollnip.plots.section import QUANTITIES, Piece, Scale, roller_of, section_pieces
from rollnip.plots.style import (
    Look,
    PageLayout,
    Style,
    axes_inches,
    below_axes,
    figure_of,
    label,
    prepare,
    require_choice,
    title,
)
from rollnip.rollers import Side
from rollnip.solution import Solution

Array = NDArray[np.float64]

_DEPTH = INTERFACE_FIGURES["depth"]
_WINDOW = {"stretched": 0.35, "equal": 0.35}  # shown on either side, in nip widths
_LEVELS = 14
_TAIL = 0.97  # part of the area whose values the colours cover where the rest is far larger
_FAR = 2.5
_NOISE = 1e-6
_LEAST = 0.6  # least share of the axes beside names and colour bar
_MIXED = 0.02  # a quantity that should be positive and is less than this below zero counts as such


def plot_field(
    solution: Solution,
    component: str = "s_zz",
    rollers: Literal["both", "upper", "lower"] = "both",
    ax: Axes | None = None,
    *,
    scale: Scale = "stretched",
    limit: float | None = None,
    style: Style | None = None,
) -> Axes:
    """Draw contours of a field over the layered cross-section of one roller or both.

    One global frame, x along the nip and z upwards, the upper roller above: u_z, s_xz and e_xz of
    the lower one are turned into it. Interfaces are lines; what is rigid is hatched.

    Parameters
    ----------
    solution, style :
        as in `plot_pressure`.
    component :
        u_x, u_z, s_xx, s_yy, s_zz, s_xz, s_1, s_2, max_shear, von_mises, pressure, e_xx, e_zz,
        e_xz, energy_density or loss_density.
    rollers :
        "both", "upper" or "lower".
    ax :
        axes to draw on, which give room to the colour bar; None makes a figure.
    scale :
        "stretched": unrolled and undeformed, depths fill the picture; "equal": round, with
        the radial displacements, heights to the scale of x.
    limit :
        largest size that the colours tell apart, in the unit of the colour bar; None: the largest
        value, or that of 97 % of the area where single places are far beyond it.

    Returns
    -------
    Axes
        with x [mm] and depth or height [mm]; colours are centred on 0 where values have both
        signs.

    Raises
    ------
    InvalidInputError
        where a name is unknown (the nearest is told), nothing in the roller deforms, or the limit
        is not positive and finite.
    """
    names = _checked(solution, component, rollers, scale, limit)
    ax, look = prepare(ax, style)
    pieces = section_pieces(solution, names, component, scale, _WINDOW[scale])
    shades = _shades(pieces, component, limit, look)
    drawn = [
        _fill(ax, piece, _without_noise(piece.values, shades.high), shades, look)
        for piece in pieces
        if piece.values is not None
    ]
    for piece in pieces:
        _outline(ax, piece, look)
    _frame(ax, look, pieces, scale)
    _name_layers(ax, look, pieces)
    text = QUANTITIES[component].label + ("" if rollers == "both" else f", {rollers} roller")
    _colour_bar(ax, look, drawn[0], shades, text + _theory(solution, names, component))
    title(ax, look, solution, "Inside the layers", room=0.5)
    engine = figure_of(ax).get_layout_engine()
    if scale == "equal" and isinstance(engine, ConstrainedLayoutEngine):
        for _ in range(2):  # a fixed shape takes more than the one pass that drawing makes
            engine.execute(figure_of(ax))
    return ax


def _theory(solution: Solution, names: tuple[Side, ...], component: str) -> str:
    """Return whether what is drawn in geometry "finite" is of finite strain."""
    if solution.model.geometry != "finite":
        return ""
    if component == "loss_density":
        return ", linear theory"
    soft = [name for name in names if not roller_of(solution, name).is_rigid]
    linear = [name for name in soft if not solution.is_finite_inside(name)]
    if not linear:
        return ", finite strain"
    return ", linear theory" + ("" if linear == soft else f" in the {linear[0]} roller")


def _checked(
    solution: Solution, component: str, rollers: str, scale: str, limit: float | None
) -> tuple[Side, ...]:
    """The rollers to draw; InvalidInputError for what cannot be drawn."""
    require_choice("component", component, tuple(QUANTITIES))
    require_choice("rollers", rollers, ("both", "upper", "lower"))
    require_choice("scale", scale, ("stretched", "equal"))
    if limit is not None:
        require_positive("limit", limit)
    both: tuple[Side, ...] = ("upper", "lower")
    names = tuple(name for name in both if rollers in ("both", name))
    if all(roller_of(solution, name).is_rigid for name in names):
        raise InvalidInputError(
            f'`rollers` must name one that deforms, got "{rollers}", a bare rigid core.'
        )
    return names


@dataclass(frozen=True, slots=True)
class _Shades:
    """Levels of the contours and the colours between them."""

    levels: Array
    colours: Colormap
    low: float
    high: float
    extend: Literal["neither", "min", "max", "both"]


def _shades(pieces: list[Piece], component: str, limit: float | None, look: Look) -> _Shades:
    """Levels over the values, or up to the limit; colours about 0 unless all are positive."""
    values = np.concatenate([p.values.ravel() for p in pieces if p.values is not None])
    low, high = float(values.min()), float(values.max())
    bound = limit or _bound(pieces)
    positive = QUANTITIES[component].positive and low > -_MIXED * high
    first, last = (0.0 if positive else max(low, -bound)), min(high, bound)
    if not last > first:  # nothing there, such as the loss of an elastic layer
        first, last = -1.0, 1.0
    levels = MaxNLocator(_LEVELS, steps=[1, 2, 2.5, 4, 5, 10]).tick_values(first, last)
    under, over = low < levels[0] and not positive, high > levels[-1]
    extend = {(0, 0): "neither", (1, 0): "min", (0, 1): "max", (1, 1): "both"}[(under, over)]
    size = max(abs(levels[0]), abs(levels[-1]))
    colours = look.palette.sequential if positive else look.palette.diverging
    return _Shades(levels, colours, 0.0 if positive else -size, size, extend)  # type: ignore[arg-type]


def _colour_bar(ax: Axes, look: Look, drawn: QuadContourSet, shades: _Shades, text: str) -> None:
    """Colour bar below the axes; it takes room of theirs where no layout engine gives any."""
    figure = figure_of(ax)
    if figure.get_layout_engine() is None:
        bar = figure.colorbar(drawn, ax=ax, location="bottom", aspect=40, shrink=0.9, pad=0.17)
    else:
        points = Affine2D().scale(1.0 / 72.0) + figure.dpi_scale_trans
        under = points + ScaledTranslation(0.0, 0.0, ax.transAxes)  # type: ignore[arg-type]
        height = 0.9 * look.size
        bounds = (0.05, -below_axes(look) - 1.4 * height, 0.9, height)
        transform = blended_transform_factory(ax.transAxes, under)
        bar = figure.colorbar(
            drawn, cax=ax.inset_axes(bounds, transform=transform), orientation="horizontal"
        )
    bar.ax.tick_params(colors=look.palette.ink, labelsize=look.small)
    ticks = _ticks(shades.levels, 8 if axes_inches(ax)[0] > 3.5 else 5)
    bar.set_ticks(ticks)
    numbers = bar.ax.xaxis.get_major_formatter()
    numbers.format_ticks(ticks)
    power = numbers.get_offset()  # such as 1e-6; where it is drawn it would stand in the name
    bar.ax.xaxis.get_offset_text().set_visible(False)
    text = text.replace("[", f"[{power} ") if power else text
    bar.set_label(text, fontsize=look.size, color=look.palette.ink)
    bar.outline.set_edgecolor(look.palette.muted)


def _ticks(levels: Array, most: int) -> list[float]:
    """Return at most ``most`` levels at equal steps, 0 among them where it is a level."""
    every = -(-levels.size // most)
    return [float(x) for x in levels[int(np.argmin(np.abs(levels))) % every :: every]]


def _bound(pieces: list[Piece]) -> float:
    """Return the largest size worth a colour: of all, or of most of the area that has any."""
    sizes, areas = [np.zeros(1)], [np.zeros(1)]
    for piece in pieces:
        if piece.values is not None and piece.values.any():  # not an elastic roller's loss
            width, height = np.gradient(piece.x[0]), np.abs(np.gradient(piece.y[:, 0]))
            areas.append((height[:, None] * width).ravel())
            sizes.append(np.abs(piece.values).ravel())
    size, area = np.concatenate(sizes), np.concatenate(areas)
    order = np.argsort(size)
    covered = np.cumsum(area[order])
    most = float(size[order][np.searchsorted(covered, _TAIL * covered[-1])])
    largest = float(size[order][-1])
    return most if largest > _FAR * most > 0.0 else largest


def _without_noise(values: Array, size: float) -> Array:
    """Give rounding errors on a free surface the sign of the values below: no contours of noise."""
    noise = np.abs(values[0]) < _NOISE * size
    out = values.copy()
    out[0, noise] = _NOISE * size * np.sign(values[1, noise])
    return out


def _fill(ax: Axes, piece: Piece, values: Array, shades: _Shades, look: Look) -> QuadContourSet:
    """Filled contours and thin lines between them."""
    filled = ax.contourf(
        piece.x,
        piece.y,
        values,
        levels=shades.levels,
        cmap=shades.colours,
        vmin=shades.low,
        vmax=shades.high,
        extend=shades.extend,
        zorder=1.0,
    )
    if float(np.ptp(values)) > 0.0:
        ax.contour(
            piece.x,
            piece.y,
            values,
            levels=shades.levels,
            colors=look.palette.ink,
            linewidths=0.5 * look.thin,
            linestyles="solid",
            alpha=0.45,
            zorder=1.1,
        )
    return filled


def _outline(ax: Axes, piece: Piece, look: Look) -> None:
    """Faces of a layer; what is rigid is hatched."""
    colours = look.palette
    if piece.values is None:
        ax.fill(
            np.concatenate([piece.x[0], piece.x[-1][::-1]]),
            np.concatenate([piece.y[0], piece.y[-1][::-1]]),
            facecolor=colours.core,
            edgecolor=colours.muted,
            hatch="////",
            linewidth=0.0,
            zorder=1.0,
        )
        ax.plot(piece.x[0], piece.y[0], color=colours.ink, linewidth=look.thin, zorder=1.2)
        return
    for row in (0, -1):
        ax.plot(
            piece.x[row], piece.y[row], color=colours.ink, linewidth=0.8 * look.thin, zorder=1.2
        )


def _frame(ax: Axes, look: Look, pieces: list[Piece], scale: Scale) -> None:
    """Limits, axes' names and the inlet."""
    names = {piece.name for piece in pieces}
    left = max(float(piece.x[0, 0]) for piece in pieces)
    right = min(float(piece.x[0, -1]) for piece in pieces)
    ax.set_xlim(left, right)
    ax.set_ylim(*_seen(pieces, left, right))
    quantity = _DEPTH.axis_for("height") if scale == "equal" else _DEPTH.axis
    if scale == "equal":
        ax.set_aspect("equal", adjustable="box")
    else:
        ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{abs(value):g}"))
    label(
        ax, look, PROFILES["x"].axis, quantity if len(names) == 1 else f"lower ← {quantity} → upper"
    )
    _mark_inlet(ax, look)


def _seen(pieces: list[Piece], left: float, right: float) -> tuple[float, float]:
    """Lowest and highest drawn point."""
    inside = [(p.x >= left) & (p.x <= right) for p in pieces]
    low = min(float(p.y[seen].min()) for p, seen in zip(pieces, inside, strict=True))
    high = max(float(p.y[seen].max()) for p, seen in zip(pieces, inside, strict=True))
    return low, high


def _mark_inlet(ax: Axes, look: Look) -> None:
    """Arrow along the motion above the leading edge."""
    inches = figure_of(ax).dpi_scale_trans
    height, length = 0.8 * look.size / 72.0, 4.6 * look.small / 72.0
    head = ax.transAxes + ScaledTranslation(-length, height, inches)
    ax.annotate(
        "inlet",
        xy=(1.0, 1.0),
        xycoords=head,
        xytext=(length * 72.0, 0.0),
        textcoords="offset points",
        ha="right",
        va="center",
        fontsize=look.small,
        color=look.palette.muted,
        arrowprops={
            "arrowstyle": "-|>",
            "color": look.palette.muted,
            "linewidth": look.thin,
            "shrinkA": 1.0,
            "shrinkB": 0.0,
            "relpos": (0.0, 0.5),
        },
    )


def _name_layers(ax: Axes, look: Look, pieces: list[Piece]) -> None:
    """Write each layer's thickness and moduli at the right, moved apart where layers are thin."""
    low, high = ax.get_ylim()
    # rather too low: texts then stand further apart than they must
    width, height = axes_inches(ax)
    part = 1.0 if isinstance(figure_of(ax).get_layout_engine(), PageLayout) else _LEAST
    points = 72.0 * part * height
    if ax.get_aspect() == 1.0:
        first, last = ax.get_xlim()
        points = min(points, 72.0 * part * width * (high - low) / (last - first))
    sizes = np.array([look.small * 1.25 * (1 + piece.text.count("\n")) for piece in pieces])
    middles = np.array([0.5 * float(p.y[0, -1] + p.y[-1, -1]) for p in pieces])
    order = np.argsort(middles)
    wanted = (middles[order] - low) / (high - low) * points
    for place, want, i in zip(_apart(wanted, sizes[order]), wanted, order, strict=True):
        ax.annotate(
            pieces[i].text,
            xy=(1.0, middles[i]),
            xycoords=ax.get_yaxis_transform(),
            xytext=(1.1 * look.size, float(place - want)),
            textcoords="offset points",
            ha="left",
            va="center",
            fontsize=look.small,
            linespacing=1.05,
            color=look.palette.ink,
            annotation_clip=False,
            arrowprops={
                "arrowstyle": "-",
                "color": look.palette.muted,
                "linewidth": look.thin,
                "shrinkA": 0.0,
                "shrinkB": 0.0,
                "relpos": (0.0, 0.5),
            },
        )


def _apart(wanted: Array, sizes: Array) -> Array:
    """Places nearest to the wanted ones, increasing, at which texts of these sizes do not touch."""
    places = wanted.copy()
    for _ in range(200):
        overlap = 0.5 * (sizes[1:] + sizes[:-1]) - np.diff(places)
        if not np.any(overlap > 0.01):
            break
        push = 0.5 * np.maximum(overlap, 0.0)
        places[:-1] -= push
        places[1:] += push
    return places
