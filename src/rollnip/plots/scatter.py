"""Pictures of a result's scatter and of the parameters it depends on."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke
from numpy.typing import ArrayLike

from rollnip._errors import InvalidInputError
from rollnip.figures import MEASURED
from rollnip.plots.arrays import Array, finite_row
from rollnip.plots.style import Look, Style, label, legend, prepare

_LONG = 14  # letters
_SHARE_GAP = 0.38  # distance between the bars of a parameter, in rows


def plot_shares(
    names: Sequence[str],
    first: ArrayLike,
    total: ArrayLike | None = None,
    ax: Axes | None = None,
    *,
    result: str = "the result",
    kinds: tuple[str, str] = ("alone (first order)", "with interactions (total)"),
    style: Style | None = None,
) -> Axes:
    """Draw each parameter's share of a result's variance: Sobol indices.

    Parameters
    ----------
    names : names of the d parameters, drawn from the top.
    first : (d, 3) index alone, and the limits of its confidence interval; or (d,) without.
    total : the same with all interactions; None: not drawn.
    ax : axes to draw on; None makes a figure of its own.
    result : name of the scattering result, for the abscissa.
    kinds : names of ``first`` and ``total``, for the legend.
    style : "light" or "dark"; None: as the figure of ``ax`` is.

    Raises
    ------
    InvalidInputError
        where shapes do not fit or a number is not finite.
    """
    parts = [(kinds[0], _shares("first", first, len(names)))]
    if total is not None:
        parts.append((kinds[1], _shares("total", total, len(names))))
    ax, look = prepare(ax, style)
    rows = np.arange(len(names), dtype=float)
    colours = (look.palette.pressure, look.palette.shear)
    handles: list[Artist] = []
    style_of: dict[str, Any]
    for index, (text, values) in enumerate(parts):
        offset = _SHARE_GAP * (index - 0.5 * (len(parts) - 1))
        hatch = "" if index == 0 else "////"
        style_of = {"facecolor": colours[index], "hatch": hatch, "linewidth": 0.0}
        style_of["edgecolor"] = look.palette.ground
        ax.barh(rows + offset, values[:, 0], height=0.9 * _SHARE_GAP, **style_of)
        handles.append(Patch(**style_of, label=text))
        ax.hlines(rows + offset, values[:, 1], values[:, 2], color=look.palette.ink, linewidth=1.0)
    ax.axvline(0.0, color=look.palette.muted, linewidth=look.thin)
    if np.any(parts[0][1][:, 1] < parts[0][1][:, 2]):
        handles.append(Line2D([], [], color=look.palette.ink, linewidth=1.0, label="confidence"))
    ax.set_yticks(rows, [_folded(name) for name in names], parse_math=False)
    ax.set_ylim(len(names) - 0.5, -0.5)
    label(ax, look, f"share of the variance of {result}", "")
    legend(ax, look, handles)
    return ax


def plot_distribution(
    values: ArrayLike,
    ax: Axes | None = None,
    *,
    name: str = "value",
    quantiles: Sequence[tuple[float, float]] = (),
    limits: tuple[float | None, float | None] = (None, None),
    style: Style | None = None,
) -> Axes:
    """Draw how a result is distributed: a histogram, the cumulative share, what is asked of it.

    Parameters
    ----------
    values : (n,) samples, at least two.
    ax : axes to draw on; None makes a figure of its own.
    name : name of the result, with its unit.
    quantiles : (probability, value) to mark.
    limits : (at least, at most) of a specification; None: no such limit. Outside is shaded.
    style : "light" or "dark"; None: as the figure of ``ax`` is.

    Returns
    -------
    Axes of the histogram [samples]; the cumulative share stands on axes of its own at the right.

    Raises
    ------
    InvalidInputError
        for fewer than two samples, or one that is not finite.
    """
    samples = finite_row("values", values)
    if samples.size < 2:
        raise InvalidInputError(f"`values` must hold at least 2 samples, got {samples.size}.")
    ax, look = prepare(ax, style)
    ax.hist(
        samples,
        bins=_bins(samples).tolist(),
        color=look.palette.pressure,
        alpha=0.55,
        edgecolor=look.palette.ground,
        linewidth=0.6,
    )
    handles: list[Artist] = [
        Patch(facecolor=look.palette.pressure, alpha=0.55, label=f"{samples.size} samples")
    ]
    ax.margins(x=0.04)
    reach = ax.get_xlim()
    handles += _specification(ax, look, limits, reach)
    for probability, value in quantiles:
        ax.axvline(value, color=look.palette.ink, linewidth=look.thin, linestyle=":")
        _beside(ax, look, value, f"{100.0 * probability:g} %")
    handles.append(_cumulative(ax, look, samples))
    ax.set_ylim(0.0, 1.12 * ax.get_ylim()[1])
    label(ax, look, name, "samples")
    legend(ax, look, handles)
    return ax


def _specification(
    ax: Axes,
    look: Look,
    limits: tuple[float | None, float | None],
    reach: tuple[float, float],
) -> list[Artist]:
    """Shade what is out of specification; the limits stay in the picture."""
    given = [one for one in limits if one is not None]
    if not given:
        return []
    room = 0.04 * (reach[1] - reach[0])
    low, high = min(reach[0], min(given) - room), max(reach[1], max(given) + room)
    for limit, end in zip(limits, (low, high), strict=True):
        if limit is None:
            continue
        ax.axvline(limit, color=look.palette.alert, linewidth=look.line)
        ax.axvspan(
            limit, end, facecolor=look.palette.slip, hatch="////", edgecolor=look.palette.hatch,
            linewidth=0.0, zorder=0.5,
        )  # fmt: skip
    ax.set_xlim(low, high)
    return [
        Patch(
            facecolor=look.palette.slip,
            hatch="////",
            edgecolor=look.palette.hatch,
            linewidth=0.5,
            label="out of specification",
        )
    ]


def _cumulative(ax: Axes, look: Look, samples: Array) -> Artist:
    """Share of the samples up to a value, on axes at the right."""
    other = ax.twinx()
    ordered = np.sort(samples)
    (line,) = other.step(
        np.concatenate([ordered[:1], ordered]),
        100.0 * np.arange(samples.size + 1) / samples.size,
        where="post",
        color=look.palette.shear,
        linewidth=look.line,
        label="cumulative",
    )
    other.set_ylim(0.0, 112.0)
    other.set_yticks([0.0, 25.0, 50.0, 75.0, 100.0])
    other.tick_params(colors=look.palette.ink, labelsize=look.small)
    other.set_ylabel(MEASURED["cumulative"].axis, fontsize=look.size, color=look.palette.ink)
    for spine in other.spines.values():
        spine.set_edgecolor(look.palette.muted)
    return line


def _beside(ax: Axes, look: Look, value: float, text: str) -> None:
    ax.annotate(
        text,
        xy=(value, 0.985),
        xycoords=ax.get_xaxis_transform(),
        xytext=(2.0, 0.0),
        textcoords="offset points",
        va="top",
        fontsize=look.small,
        color=look.palette.ink,
        path_effects=[withStroke(linewidth=2.5, foreground=look.palette.ground)],
    )


def _folded(path: str) -> str:
    """A long path on two lines, so that it leaves room for the bars."""
    above, _, last = path.rpartition(".")
    return f"{above}.\n{last}" if len(path) > _LONG and above else path


def _bins(samples: Array) -> Array:
    """Edges after Freedman & Diaconis, 8 to 60 bins."""
    edges = np.histogram_bin_edges(samples, bins="fd")
    count = int(np.clip(edges.size - 1, 8, 60))
    return np.histogram_bin_edges(samples, bins=count)


def _shares(name: str, values: ArrayLike, count: int) -> Array:
    array = np.asarray(values, dtype=float)
    if array.ndim == 1:
        array = np.column_stack([array, array, array])
    if array.shape != (count, 3) or not np.isfinite(array).all() or count == 0:
        raise InvalidInputError(
            f"`{name}` must hold finite numbers, a value and two limits for each of {count} "
            f"names, got shape {array.shape}."
        )
    return array
