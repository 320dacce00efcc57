"""Pictures of a sweep: curves over one parameter, maps over two, scatter plots over more."""

from __future__ import annotations

import json

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError
from rollnip.figure import axis_label
from rollnip.plots import plot_curves, plot_map
from rollnip.plots.style import FULL, MM, Style, label, palette_of, prepare
from rollnip.sweeps.row import scalar_axis
from rollnip.sweeps.store import Store

Array = NDArray[np.float64]
_USUAL = ("nip_width", "peak_pressure")
_MOST_RESULTS, _MOST_PARAMETERS = 4, 4
_HEIGHT = 75.0  # mm of a row


def plot_sweep(store: Store, *, style: Style = "light") -> Figure:
    """Draw the results of a sweep over its parameters, as far as cases are finished.

    Each result has its own row or column: nip width and peak pressure, or the first four results
    that
    the study names. With one varying parameter they are curves; with two that form a grid, maps
    with
    contours; otherwise a scatter plot of the cases over each of up to four parameters. Cases that
    were
    not solved are left out.

    Raises
    ------
    InvalidInputError
        where no numeric parameter varies, or nothing was solved.
    """
    results = _results(store)
    parameters, values = _read(store, results)
    changing = [i for i, one in enumerate(parameters.values()) if np.unique(one).size > 1]
    names = [list(parameters)[i] for i in changing]
    if not names:
        raise InvalidInputError("No parameter that is a number changes: there is nothing to draw.")
    columns = [parameters[name] for name in names]
    if not any(np.isfinite(one).any() for one in values.values()):
        raise InvalidInputError("No case was solved: there is nothing to draw.")
    heads = [_head(store, name) for name in names]
    is_map = len(names) == 2 and _is_grid(columns)
    wide = 1 if len(names) == 1 else len(results) if is_map else min(len(names), _MOST_PARAMETERS)
    high = 1 if is_map else len(results)
    ground = palette_of(style).ground
    size = (FULL * MM, _HEIGHT * high * MM)
    figure = Figure(figsize=size, layout="constrained", facecolor=ground)
    axes = figure.subplots(high, wide, squeeze=False)
    for number, (name, result) in enumerate(values.items()):
        said = scalar_axis(name)
        if is_map:
            _map(axes[0, number], columns, result, (heads[0], heads[1], said), style)
        elif wide == 1:
            plot_curves(
                columns[0], {said: result}, axes[number, 0], names=(heads[0], said), style=style
            )
        else:
            for ax, column, head in zip(axes[number], columns, heads, strict=False):
                _cloud(ax, column, result, (head, said), style)
    return figure


def _results(store: Store) -> tuple[str, ...]:
    """Return the results to draw: those of the study if few, else the usual ones among them."""
    named = store.about.results
    if len(named) <= _MOST_RESULTS:
        return named
    usual = tuple(name for name in _USUAL if name in named)
    return usual or named[:2]


def _read(store: Store, results: tuple[str, ...]) -> tuple[dict[str, Array], dict[str, Array]]:
    """Return the numeric parameters and the results; nan where a case was not solved."""
    about = store.about
    numbers = [i for i, unit in enumerate(about.units) if unit]
    rows = []
    for given, status, *found in store.rows(("parameters", "status", *results)):
        values = json.loads(given)
        solved = [np.nan if one is None or status != "solved" else one for one in found]
        rows.append([*(values[i] for i in numbers), *solved])
    table = np.array(rows, dtype=float).reshape(len(rows), len(numbers) + len(results))
    parameters = {about.paths[i]: table[:, n] for n, i in enumerate(numbers)}
    first = len(numbers)
    return parameters, {name: table[:, first + n] for n, name in enumerate(results)}


def _head(store: Store, path: str) -> str:
    unit = dict(zip(store.about.paths, store.about.units, strict=True))[path]
    return axis_label(path, unit)


def _is_grid(columns: list[Array]) -> bool:
    """Return whether every value of one column occurs with every value of the other just once."""
    one, other = (np.unique(column).size for column in columns)
    pairs = np.unique(np.column_stack(columns), axis=0).shape[0]
    return bool(one * other == pairs == columns[0].size)


def _map(
    ax: Axes, columns: list[Array], result: Array, names: tuple[str, str, str], style: Style
) -> None:
    (x, i), (y, j) = (np.unique(column, return_inverse=True) for column in columns)
    field = np.full((y.size, x.size), np.nan)
    field[j, i] = result
    plot_map(x, y, field, ax, names=names, style=style)


def _cloud(ax: Axes, x: Array, y: Array, names: tuple[str, str], style: Style) -> None:
    ax, look = prepare(ax, style)
    size = 0.35 * look.size
    ax.plot(x, y, "o", color=look.palette.pressure, alpha=0.5, markersize=size, markeredgewidth=0)
    label(ax, look, *names)
