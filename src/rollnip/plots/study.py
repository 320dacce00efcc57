"""Results over one parameter, and the best of two results at once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from numpy.typing import ArrayLike, NDArray

from rollnip._errors import InvalidInputError
from rollnip.plots.arrays import finite_row, require_some
from rollnip.plots.style import Look, Style, label, legend, prepare

_DASHES = ("-", "--", "-.", ":")
_MARKS = ("o", "s", "^", "D", "v", "P")
_MOST_CURVES = 12


def plot_curves(
    x: ArrayLike,
    curves: Mapping[str, ArrayLike],
    ax: Axes | None = None,
    *,
    names: tuple[str, str] = ("x", "value"),
    wanted: float | None = None,
    style: Style | None = None,
) -> Axes:
    """Draw results over one parameter.

    Parameters
    ----------
    x : (n,) values of the parameter; drawn in rising order.
    curves : (n,) results by the name that the legend shows; nan leaves a gap. 12 at most.
    ax : axes to draw on; None makes a figure of its own.
    names : names of the abscissa and the ordinate, with their units.
    wanted : a value to mark.
    style : "light" or "dark"; None: as the figure of ``ax`` is.

    Raises
    ------
    InvalidInputError
        where lengths differ, or there is nothing to draw.
    """
    places = finite_row("x", x)
    if not 1 <= len(curves) <= _MOST_CURVES:
        raise InvalidInputError(
            f"`curves` must hold 1 to {_MOST_CURVES} curves, got {len(curves)}."
        )
    columns = {name: np.asarray(values, dtype=float) for name, values in curves.items()}
    for name, column in columns.items():
        if column.shape != places.shape:
            raise InvalidInputError(
                f"`curves` must hold as many values as x, {places.size}; {name} has shape "
                f"{column.shape}."
            )
        require_some(f"curves of {name}", column[np.isfinite(column)])
    ax, look = prepare(ax, style)
    order = np.argsort(places, kind="stable")
    handles: list[Artist] = []
    for index, (name, column) in enumerate(columns.items()):
        handles += ax.plot(
            places[order],
            column[order],
            color=_colours(look)[index % 4],
            linestyle=_DASHES[(index // 4) % 4],
            marker=_MARKS[index % 6] if places.size <= 40 else "",
            markersize=0.4 * look.size,
            linewidth=look.line,
            label=name,
        )
    if wanted is not None:
        line = ax.axhline(wanted, color=look.palette.alert, linewidth=look.thin, linestyle="--")
        line.set_label(f"wanted {wanted:.5g}")
        handles.append(line)
    label(ax, look, *names)
    if len(handles) > 1:
        legend(ax, look, handles)
    return ax


def plot_pareto(
    x: ArrayLike,
    y: ArrayLike,
    front: Sequence[int] | NDArray[np.intp],
    ax: Axes | None = None,
    *,
    names: tuple[str, str] = ("x", "y"),
    style: Style | None = None,
) -> Axes:
    """Draw cases by two results, and the front of those that no other beats in both.

    Parameters
    ----------
    x, y : (n,) results; pairs with nan are left out.
    front : numbers of the cases on the front, such as `rollnip.design.pareto_front` gives.
    ax : axes to draw on; None makes a figure of its own.
    names : names of the results, with their units.
    style : "light" or "dark"; None: as the figure of ``ax`` is.

    Raises
    ------
    InvalidInputError
        where lengths differ, there is no pair of numbers, or the front names a case that is not.
    """
    a, b = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    if a.ndim != 1 or a.shape != b.shape:
        raise InvalidInputError(f"`x` and `y` must be alike in shape, got {a.shape} and {b.shape}.")
    require_some("x and y", a[np.isfinite(a) & np.isfinite(b)])
    chosen = np.asarray(front, dtype=int)
    if chosen.size and not (chosen.min() >= 0 and chosen.max() < a.size):
        raise InvalidInputError(f"`front` must hold numbers of cases from 0 to {a.size - 1}.")
    ax, look = prepare(ax, style)
    rest = np.setdiff1d(np.arange(a.size), chosen)
    size = 0.4 * look.size
    handles: list[Artist] = [
        *ax.plot(
            a[rest],
            b[rest],
            "o",
            color=look.palette.muted,
            alpha=0.6,
            markersize=0.6 * size,
            label=f"beaten by another ({rest.size})",
        )
    ]
    order = chosen[np.argsort(a[chosen], kind="stable")]
    handles += ax.plot(
        a[order],
        b[order],
        "D:",
        color=look.palette.shear,
        markersize=size,
        linewidth=look.thin,
        label=f"Pareto front ({order.size})",
    )
    label(ax, look, *names)
    legend(ax, look, handles)
    return ax


def _colours(look: Look) -> tuple[str, str, str, str]:
    one = look.palette
    return one.pressure, one.shear, one.upper, one.lower
