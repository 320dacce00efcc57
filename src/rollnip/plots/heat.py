"""Pictures of heat: temperature over depth, warm-up over time, the branch to thermal runaway."""

from __future__ import annotations

from itertools import groupby, pairwise
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rollnip.figure import axis_label
from rollnip.figures import INTERFACE_FIGURES
from rollnip.heat import Branch, BranchPoint, HeatSolution, WarmUp
from rollnip.heat.figures import COURSES, PARAMETERS, ROLLER_FIGURES
from rollnip.plots.style import Palette, Style, palette_of
from rollnip.rollers import SIDES

_WIDTH, _HEIGHT = 9.0, 3.4  # inches, of one picture
_HOT = ROLLER_FIGURES["hot_spot"]


def plot_heat(
    solution: HeatSolution,
    course: WarmUp | None = None,
    branch: Branch | None = None,
    *,
    style: Style = "light",
) -> Figure:
    """Return one page about heat: temperature over depth, and what else is given below it.

    Parameters
    ----------
    solution : what `solve_heat` returned.
    course : what `warm_up` returned; None: without.
    branch : what `follow_heat` returned; None: without.
    style : "light" or "dark".
    """
    palette = palette_of(style)
    count = 1 + (course is not None) + (branch is not None)
    figure = Figure(
        figsize=(_WIDTH, _HEIGHT * count), layout="constrained", facecolor=palette.ground
    )
    axes = list(figure.subplots(count, 1, squeeze=False)[:, 0])
    for ax in axes:
        _dressed(ax, palette)
    _depth(axes[0], solution, palette)
    if course is not None:
        _course(axes[1], course, palette)
    if branch is not None:
        _branch(axes[-1], branch, solution, palette)
    for ax in axes:
        for text in (ax.xaxis.label, ax.yaxis.label):
            text.set_color(palette.ink)
    state = "" if solution.converged else " (NOT CONVERGED)"
    title = f"{solution.nip.title or 'Heat'}{state}"
    figure.suptitle(title, color=palette.ink, ha="left", x=0.02)
    return figure


def _dressed(ax: Axes, palette: Palette) -> None:
    ax.set_facecolor(palette.ground)
    ax.tick_params(colors=palette.ink)
    for name, spine in ax.spines.items():
        spine.set_color(palette.ink)
        spine.set_visible(name in ("left", "bottom"))


def _degrees(value: float) -> str:
    return f"{value:.1f} {_HOT.shown_unit}"


def _color(palette: Palette, side: str) -> str:
    return palette.upper if side == "upper" else palette.lower


def _depth(ax: Axes, solution: HeatSolution, palette: Palette) -> None:
    """Draw temperatures over the depth below each surface; bonds and hot spots are marked."""
    ax.set_title("temperature below the surface", loc="left", size=10, color=palette.ink)
    for side, roller in zip(SIDES, (solution.upper, solution.lower), strict=True):
        color = _color(palette, side)
        if roller.r.size == 1:
            ax.axhline(
                roller.surface_temperature,
                color=color,
                linewidth=1.8,
                linestyle="--",
                label=f"{side} roller, {_degrees(roller.surface_temperature)} throughout",
            )
            continue
        depth = roller.r[-1] - roller.r
        bond = roller.bond_temperature
        held = "" if bond is None else f", bond {_degrees(bond)}"
        label = f"{side} roller: {_HOT.label} {_degrees(roller.hot_spot)}{held}"
        ax.plot(depth, roller.temperature, color=color, linewidth=1.8, label=label)
        ax.plot(roller.hot_spot_depth, roller.hot_spot, "o", color=color, clip_on=False)
        one = solution.nip.upper if side == "upper" else solution.nip.lower
        for interface in one.interfaces:
            ax.axvline(interface, color=color, linewidth=0.7, linestyle=":")
    ax.axhline(solution.heat.ambient, color=palette.muted, linewidth=0.8, linestyle=":")
    ax.set_xlim(left=0.0)
    ax.set_xlabel(INTERFACE_FIGURES["depth"].axis)
    ax.set_ylabel(COURSES["temperature"].axis)
    _legend(ax)


def _course(ax: Axes, course: WarmUp, palette: Palette) -> None:
    """Draw hot spot and surface of each roller over time."""
    ax.set_title("warm-up", loc="left", size=10, color=palette.ink)
    unit, factor, _ = COURSES["time"].shown_for(course.time[-1])
    time = factor * course.time
    for side in ("upper", "lower"):
        color = _color(palette, side)
        ax.plot(
            time, course.hot_spot(side), color=color, linewidth=1.8, label=f"{side}, {_HOT.label}"
        )
        surface = course.surface(side)
        ax.plot(
            time,
            surface,
            color=color,
            linewidth=1.2,
            linestyle="--",
            label=f"{side}, {ROLLER_FIGURES['surface_temperature'].label}",
        )
    ax.set_xlim(0.0, time[-1])
    ax.set_xlabel(axis_label(COURSES["time"].label, unit))
    ax.set_ylabel(COURSES["temperature"].axis)
    _legend(ax)


def _branch(ax: Axes, branch: Branch, solution: HeatSolution, palette: Palette) -> None:
    """Draw the hot spot over the parameter: stable states, others, and the turning point."""
    ax.set_title("steady states", loc="left", size=10, color=palette.ink)
    for stable, run in groupby(pairwise(branch.points), _are_stable):
        pieces = list(run)
        points = [pieces[0][0], *(second for _, second in pieces)]
        values, hottest = [one.value for one in points], [one.hot_spot for one in points]
        known = ax.get_legend_handles_labels()[1]
        name = "stable" if stable else "not stable"
        ax.plot(
            values,
            hottest,
            "o-" if stable else "--",
            color=palette.pressure if stable else palette.muted,
            markersize=3,
            label=None if name in known else name,
        )
    if branch.turning is not None:
        at = branch.turning
        text = f"thermal runaway at {PARAMETERS[branch.parameter].text(at.value)}"
        ax.plot(at.value, at.hot_spot, "o", color=palette.alert, label=text)
    here = solution.nip.speed if branch.parameter == "speed" else solution.cold.load
    if here is not None and solution.converged:
        hot = max(solution.upper.hot_spot, solution.lower.hot_spot)
        ax.plot(here, hot, "D", color=palette.shear, label="this case")
    ax.set_xlabel(PARAMETERS[branch.parameter].axis)
    ax.set_ylabel(_HOT.axis)
    _legend(ax)


def _are_stable(two: tuple[BranchPoint, BranchPoint]) -> bool:
    return two[0].stable and two[1].stable


def _legend(ax: Any) -> None:
    ax.legend(frameon=False, fontsize=9, loc="best", labelcolor="linecolor")
