"""Pressure and shear along the nip."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from rollnip._files import check_target, write_whole
from rollnip.solution import Solution

SUFFIXES = (".png", ".svg", ".pdf")
_BLUE, _RED, _GREY = "#0072b2", "#d55e00", "#595959"  # Okabe & Ito, told apart by most eyes
_STICK, _SLIP, _HATCH = "#e3edf4", "#f9e6d3", "#c9a27c"
SIZE = (8.0, 4.8)  # inches
_SIDE = 0.35  # shown on either side, in nip widths


def plot_pressure(solution: Solution, ax: Axes | None = None) -> Axes:
    """Draw pressure, shear and the traction bound +-mu p over x; stick and slip are shaded.

    Parameters
    ----------
    solution :
        what `solve` returned.
    ax :
        axes to draw on; None makes a figure of its own (``ax.figure``).

    Returns
    -------
    Axes
        with x [mm] from the trailing to the leading edge, and stress [MPa].
    """
    if ax is None:
        ax = Figure(figsize=SIZE, layout="constrained").subplots()
    profiles, friction = solution.profiles, solution.nip.friction
    _shade(ax, solution)
    ax.axhline(0.0, color=_GREY, linewidth=0.8)
    ax.plot(profiles.x, profiles.pressure, color=_BLUE, linewidth=2.0, label="pressure p")
    if friction > 0.0:
        bound = friction * profiles.pressure
        label = f"traction bound ±µp, µ = {friction:g}"
        ax.plot(profiles.x, bound, color=_GREY, linewidth=1.0, linestyle=":", label=label)
        ax.plot(profiles.x, -bound, color=_GREY, linewidth=1.0, linestyle=":")
        shear = "shear q on the upper roller"
        ax.plot(profiles.x, profiles.shear, color=_RED, linewidth=2.0, linestyle="--", label=shear)
    _frame(ax, solution)
    return ax


def save_pressure(solution: Solution, path: str | Path) -> None:
    """Draw `plot_pressure` into a file, all or nothing.

    The name ends in .png, .svg or .pdf. Raises RollnipError where it does not, or where the file
    cannot be written; a file of that name then stays as it was.
    """
    target = Path(path)
    check_figure_target(target)
    figure = Figure(figsize=SIZE, layout="constrained")
    plot_pressure(solution, figure.subplots())
    kind = target.suffix.lower().removeprefix(".")
    write_whole(target, lambda file: figure.savefig(file, format=kind, dpi=150))


def check_figure_target(path: Path) -> None:
    """Raise RollnipError where a picture could not be written to ``path``."""
    check_target(path, SUFFIXES)


def _shade(ax: Axes, solution: Solution) -> None:
    for zone in solution.zones:
        color, hatch = (_STICK, "") if zone.state == "stick" else (_SLIP, "////")
        ax.axvspan(
            zone.start, zone.stop, facecolor=color, hatch=hatch, edgecolor=_HATCH, linewidth=0.0
        )


def _frame(ax: Axes, solution: Solution) -> None:
    profiles = solution.profiles
    first, last = solution.contact[0][0], solution.contact[-1][1]
    side = _SIDE * (last - first)
    ax.set_xlim(max(first - side, profiles.x[0]), min(last + side, profiles.x[-1]))
    top = float(np.max(profiles.pressure))
    high = max(top, float(np.max(profiles.shear)))
    low = min(0.0, float(np.min(profiles.shear)))
    # the bound of a high friction may leave the picture
    ax.set_ylim(low - 0.08 * (high - low), high + 0.15 * (high - low))
    ax.set_xlabel("x [mm]")
    ax.set_ylabel("stress [MPa]")
    ax.set_title(_title(solution), loc="left", fontsize="medium")
    for where, text, align in ((0.01, "← outlet", "left"), (0.99, "inlet →", "right")):
        ax.text(
            where, 0.98, text, transform=ax.transAxes, ha=align, va="top", color=_GREY, size="small"
        )
    _legend(ax, {zone.state for zone in solution.zones})


def _legend(ax: Axes, states: set[str]) -> None:
    handles, _ = ax.get_legend_handles_labels()
    if "stick" in states:
        handles.append(Patch(facecolor=_STICK, edgecolor=_GREY, linewidth=0.5, label="stick"))
    if "slip" in states:
        handles.append(Patch(facecolor=_SLIP, hatch="////", edgecolor=_HATCH, label="slip"))
    ax.legend(
        handles=handles,
        loc="upper center",
        bbox_to_anchor=(0.5, -0.13),
        ncols=len(handles),
        frameon=False,
        fontsize="small",
    )


def _title(solution: Solution) -> str:
    title = solution.nip.title or "Pressure and shear in the nip"
    return title if solution.converged else f"{title} (NOT CONVERGED)"
