"""Optima and tolerances in words and plots."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from matplotlib.figure import Figure

from rollnip._units import format_quantity
from rollnip.design.aims import AtLeast, LimitKept
from rollnip.design.optimum import Optimum
from rollnip.design.quantities import QUANTITIES, result_error
from rollnip.design.scatter import Chance, Scatter, Share, Tolerance
from rollnip.figure import LOST, axis_label
from rollnip.figures import FIGURES
from rollnip.plots import plot_distribution, plot_shares
from rollnip.plots.style import Style, page
from rollnip.sheet_figures import SHEET_FIGURES
from rollnip.sweeps import scalar_axis, scalar_label

_DIGITS = 5
_ROUNDING = 1e-9  # relative error that counts as zero
_ROW = 78.0  # height of the plots of one result [mm]
_SHOWN = (
    "load", "approach", "nip_width", "peak_pressure", "mean_pressure", "traction", "creepage",
    "dwell_time", "torque_upper", "torque_lower", "rolling_resistance",
)  # fmt: skip
_SHOWN_OF_FACE = (
    "face.evenness",
    "face.largest_departure",
    "face.even_share",
    "face.largest_scrub",
)
_SHOWN_OF_SHEET = (
    *("sheet.feed_upper", "sheet.feed_lower", "sheet.traction_upper"),
    *("sheet.tension_max", "sheet.tension_min", "sheet.grip_reserve"),
    *("sheet.slip_share_upper", "sheet.slip_share_lower"),
)


def optimum_report(found: Optimum, title: str = "") -> str:
    """Return the answer of `optimise` as text: parameters, limits and results."""
    lines = [title, ""] if title else []
    lines += [found.message, "", "Parameters"]
    for one in found.chosen:
        good = " to ".join(format_quantity(end, digits=_DIGITS) for end in one.as_good)
        lines.append(
            f"  {one.path:32s}{_shown(one.value, one.unit):>16s}   as good within 1 %: {good}"
        )
    if found.limits:
        lines += ["", "Limits"]
        lines += [f"  {_limit(one)}" for one in found.limits]
    asked = (found.quantity, *(one.quantity for one in found.limits))
    lines += [*result_lines(found.scalars, *asked), ""]
    lines.append(f"{found.solves} cases tried; {len(found.failures)} could not be solved.")
    return "\n".join(lines) + "\n"


def result_lines(row: Mapping[str, Any], *asked: str) -> list[str]:
    """Return the main results of a row of `rollnip.sweeps.evaluate` with errors, and warnings.

    Results ``asked`` for in addition come last.
    """
    names = dict.fromkeys((*_SHOWN, *_SHOWN_OF_FACE, *_SHOWN_OF_SHEET, *asked))
    shown = [name for name in names if name in QUANTITIES and row.get(name) is not None]
    wide = max([20, *(len(name) + 1 for name in shown)])
    lines = ["", "Results there, solved again"]
    lines += [f"  {name:{wide}s}{_with_error(row, name)}" for name in shown]
    warnings = str(row.get("warnings") or "")
    return [*lines, f"Note: {warnings}"] if warnings else lines


def tolerance_report(found: Tolerance, title: str = "") -> str:
    """Return the answer of `tolerance` as text: distributions, influences, chances and notes."""
    level = f"{100.0 * found.confidence:g} %"
    lines = [title, ""] if title else []
    lines.append(
        f"{found.count} samples of a Latin hypercube, {len(found.samples)} solved; "
        f"in brackets: {level} intervals."
    )
    for scatter in found.scatters:
        lines += ["", *_scatter_lines(scatter)]
    if found.chances:
        lines += ["", "Chance of meeting"]
        lines += [f"  {_chance(one)}" for one in found.chances]
        if found.together is not None and len(found.chances) > 1:
            lines.append(f"  {_chance(found.together, 'all at once')}")
    return "\n".join([*lines, *(f"Note: {note}" for note in found.notes)]) + "\n"


def plot_tolerance(found: Tolerance, *, style: Style = "light") -> Figure:
    """Draw the distribution of every result, and beside it the influence of each parameter.

    Raises
    ------
    InvalidInputError
        where the style is unknown.
    """
    rows = len(found.scatters)
    figure = page(style, _ROW * rows)
    axes = figure.subplots(rows, 2, squeeze=False, width_ratios=(1.25, 1.0))
    for (left, right), scatter in zip(axes, found.scatters, strict=True):
        plot_distribution(
            scatter.values,
            left,
            name=scalar_axis(scatter.quantity),
            quantiles=[(one.probability, one.value) for one in scatter.quantiles],
            limits=_limits_of(found, scatter.quantity),
            style=style,
        )
        _plot_influence(scatter, right, style)
    return figure


def _plot_influence(scatter: Scatter, ax: Any, style: Style) -> None:
    result = scalar_label(scatter.quantity)
    names = [share.path for share in scatter.shares]
    first = [share.first for share in scatter.shares if share.first is not None]
    total = [share.total for share in scatter.shares if share.total is not None]
    if first and total:
        kinds = ("alone (Sobol)", "with interactions")
        plot_shares(names, first, total, ax, result=result, kinds=kinds, style=style)
        return
    squares = [share.coefficient**2 for share in scatter.shares]
    kinds = (f"regression, R² = {scatter.linear_share:.3f}", "")
    plot_shares(names, squares, None, ax, result=result, kinds=kinds, style=style)


def _limits_of(found: Tolerance, quantity: str) -> tuple[float | None, float | None]:
    """Return the tightest limits on a result."""
    limits = [
        limit for chance in found.chances for limit in chance.limits if limit.quantity == quantity
    ]
    least = [float(one.limit) for one in limits if isinstance(one, AtLeast)]
    most = [float(one.limit) for one in limits if not isinstance(one, AtLeast)]
    return max(least, default=None), min(most, default=None)


def _scatter_lines(scatter: Scatter) -> Iterator[str]:
    yield axis_label(scatter.quantity, scatter.unit)
    yield (
        f"  mean {_number(scatter.mean)}, standard deviation "
        f"{format_quantity(scatter.deviation, digits=3)}, from {_number(scatter.least)} to "
        f"{_number(scatter.most)}"
    )
    for one in scatter.quantiles:
        ends = " to ".join("?" if end is None else _number(end) for end in (one.low, one.high))
        yield f"  {100.0 * one.probability:5g} % of all below {_number(one.value)}  [{ends}]"
    yield f"  influence (regression explains {100.0 * scatter.linear_share:.1f} % of the variance)"
    for share in _by_influence(scatter.shares):
        yield f"    {share.path:34s}{share.coefficient:+.3f}{_sobol(share)}"


def _by_influence(shares: Sequence[Share]) -> list[Share]:
    return sorted(shares, key=lambda one: -abs(one.coefficient))


def _sobol(share: Share) -> str:
    if share.first is None or share.total is None:
        return ""
    parts = (
        f"{value:.3f} [{low:.3f} to {high:.3f}]" for value, low, high in (share.first, share.total)
    )
    return "   Sobol: alone {}, with interactions {}".format(*parts)


def _chance(chance: Chance, called: str = "") -> str:
    near = f"; {chance.undecided} within the solver's error" if chance.undecided else ""
    value, low, high = (100.0 * part for part in (chance.value, chance.low, chance.high))
    return f"{called or chance.text}: {value:.1f} %  [{low:.1f} to {high:.1f} %]{near}"


def _limit(limit: LimitKept) -> str:
    state = "decides" if limit.is_active else "kept" if limit.is_kept else "BROKEN"
    doubt = "" if limit.error is None else f" ± {format_quantity(limit.error, digits=2)}"
    return (
        f"{limit.quantity} {limit.sense} {_shown(limit.limit, limit.unit)}: "
        f"{_shown(limit.value, limit.unit)}{doubt}, {state}"
    )


def _with_error(row: Mapping[str, Any], name: str) -> str:
    value, error = float(row[name]), result_error(row, name) or 0.0
    figure = FIGURES.get(name) or SHEET_FIGURES.get(name)
    noise = 0.0 if figure is None else figure.noise(row)
    if abs(value) <= LOST * error if figure is None else figure.is_nothing(value, error, row):
        value = 0.0
    is_said = error > max(noise, _ROUNDING * abs(value))
    doubt = f" ± {format_quantity(error, digits=2)}" if is_said else ""
    return f"{_shown(value, QUANTITIES[name])}{doubt}"


def _shown(value: float, unit: str) -> str:
    return format_quantity(value, unit, digits=_DIGITS)


def _number(value: float) -> str:
    return format_quantity(value, digits=_DIGITS)
