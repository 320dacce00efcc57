"""Figures 4 to 8 of Braat & Kalker (1993), computed."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rollnip._files import write_whole
from rollnip.figures import FIELDS, INTERFACE_FIGURES, PROFILES
from rollnip.interior import InteriorField
from rollnip.model import Geometry
from rollnip.paper import (
    ContourFigure,
    PressureFigure,
    StrainFigure,
    StrainPanel,
    contour_figure,
    pressure_figure,
    strain_figure,
)
from rollnip.solution import Solution

_GREY, _NIP, _POINT = "#595959", "#e3edf4", "#000000"
_COLORS = ("#000000", "#0072b2", "#009e73", "#d55e00")  # Okabe & Ito
_STYLES: dict[Geometry, tuple[str, str]] = {
    "linear": ("#d55e00", "--"),
    "corrected": ("#009e73", "-."),
    "curved": ("#0072b2", "-"),
}
_ALONG = f"{PROFILES['x'].axis}  (← outlet, inlet →)"
_STRESS = FIELDS["s_zz"].axis_for(f"{FIELDS['s_zz'].label} ${FIELDS['s_zz'].symbol}$")
_STEP = 0.1  # MPa between contour lines
_WIDE = (11.0, 4.6)  # inches
_BESIDE = 0.75  # shown on either side of the contact, in nip widths
_ROMAN = {1: "I", 2: "II", 3: "III"}
PICTURES = tuple(f"figure_{number}.png" for number in (4, 5, 6, 7, 8))


def save_paper(folder: Path, *, prefix: str = "") -> list[Path]:
    """Compute and draw figures 4 to 8 into an existing folder, each all or nothing.

    Parameters
    ----------
    prefix : before the names figure_4.png to figure_8.png.

    Returns
    -------
    The files written.

    Raises
    ------
    RollnipError
        where a file cannot be written or a solution could not be verified.
    """
    figures: list[Callable[[], Figure]] = [
        lambda: draw_pressure(pressure_figure()),
        lambda: draw_contours(contour_figure()),
        lambda: draw_strain(strain_figure(1)),
        lambda: draw_strain(strain_figure(2)),
        lambda: draw_strain(strain_figure(3)),
    ]
    written = []
    for name, draw in zip(PICTURES, figures, strict=True):
        path, figure = folder / f"{prefix}{name}", draw()
        write_whole(path, partial(figure.savefig, format="png", dpi=150))
        written.append(path)
    return written


def draw_pressure(data: PressureFigure) -> Figure:
    """Figure 4: pressure for each thickness of the top layer."""
    figure = Figure(figsize=(8.0, 5.0), layout="constrained")
    ax = figure.subplots()
    for thickness, solution, color in zip(data.thicknesses, data.solutions, _COLORS, strict=True):
        first, last = solution.contact[0][0], solution.contact[-1][1]
        inside = (solution.profiles.x >= first) & (solution.profiles.x <= last)
        x = np.concatenate([[first], solution.profiles.x[inside], [last]])
        pressure = np.pad(solution.profiles.pressure[inside], 1)  # 0 at both edges
        peak = f"{solution.peak_pressure:.2f} {PROFILES['pressure'].shown_unit}"
        label = f"d = {thickness:g} mm, peak {peak}"
        ax.plot(x, pressure, color=color, linewidth=1.6, label=label)
    ax.axhline(0.0, color=_GREY, linewidth=0.8)
    ax.set_ylabel(PROFILES["pressure"].axis_for("pressure p"))
    ax.set_title(
        "Figure 4: a hard top layer on a soft one (load and radii assumed)", loc="left", size=11
    )
    ax.legend(frameon=False, loc="upper center")
    return _placed(ax, figure)


def draw_contours(data: ContourFigure) -> Figure:
    """Figure 5: lines of equal normal stress s_zz in the coating, the surface at the top."""
    figure = Figure(figsize=_WIDE, layout="constrained")
    axes = figure.subplots(1, 2, sharey=True, sharex=True)
    titles = ("A  elastic, T = 1.0 N/mm", "B  viscoelastic, T = 0")
    parts = zip(axes, data.solutions, data.fields, data.centres, titles, strict=True)
    for ax, solution, field, centre, title in parts:
        _contours(ax, solution, field)
        ax.plot(centre, field.z, color=_COLORS[3], linestyle="--", linewidth=1.6)
        ax.set_title(title, loc="left", size=11)
    axes[0].set_ylabel(INTERFACE_FIGURES["depth"].axis_for("depth z"))
    axes[0].invert_yaxis()
    figure.suptitle(
        f"Figure 5: {_STRESS}; dashed: its centre, dotted: middle of the contact",
        size=11,
    )
    return figure


def draw_strain(data: StrainFigure) -> Figure:
    """Figures 6 to 8: strain of the glass roller's surface, three geometries, simulated points."""
    figure = Figure(figsize=_WIDE, layout="constrained")
    axes = figure.subplots(1, 2)
    for ax, panel, name in zip(axes, (data.free, data.driven), "AB", strict=True):
        traction = round(panel.solutions["curved"].traction, 6)
        _strain(ax, panel)
        ax.set_title(f"{name}  T = {traction:g} N/mm".replace("= -0", "= 0"), loc="left", size=11)
        _placed(ax, figure)
    axes[0].legend(frameon=False, fontsize="small", loc="best")
    _enlarged(axes[1], data.driven)
    load = data.free.solutions["curved"].load
    figure.suptitle(
        f"Figure {data.number + 5}: configuration {_ROMAN[data.number]}, F = {load:g} N/mm. "
        "The points are SIMULATED from the curved model, not measured.",
        size=11,
    )
    return figure


def _contours(ax: Axes, solution: Solution, field: InteriorField) -> None:
    count = int(-np.min(field.s_zz) / _STEP)
    levels = -_STEP * np.arange(count, 0, -1)
    drawn = ax.contour(
        field.x, field.z, field.s_zz, levels=levels, colors=_COLORS[1], linestyles="-"
    )
    ax.clabel(drawn, levels[::2], fontsize=7, fmt="%.1f")
    for edge in (solution.contact[0][0], solution.contact[-1][1]):
        ax.plot([edge], [0.0], marker="v", color=_GREY, markersize=7, clip_on=False)
    middle = 0.5 * (solution.contact[0][0] + solution.contact[-1][1])
    ax.axvline(middle, color=_GREY, linewidth=0.8, linestyle=":")
    ax.set_xlabel(_ALONG)


def _strain(ax: Axes, panel: StrainPanel) -> None:
    curved = panel.solutions["curved"]
    first, last = curved.contact[0][0], curved.contact[-1][1]
    ax.axvspan(first, last, facecolor=_NIP, linewidth=0.0)
    ax.axhline(0.0, color=_GREY, linewidth=0.8)
    _curves(ax, panel)
    side = _BESIDE * curved.nip_width
    ax.set_xlim(first - side, last + side)
    ax.set_ylabel("strain $\\epsilon_x = v/V - 1$")


def _curves(ax: Axes, panel: StrainPanel) -> None:
    for geometry, solution in panel.solutions.items():
        color, line = _STYLES[geometry]
        profiles = solution.profiles
        ax.plot(
            profiles.x, profiles.strain_upper, color=color, linestyle=line, linewidth=1.4,
            label=geometry,
        )  # fmt: skip
    points = panel.points
    ax.errorbar(
        points.x, points.strain, yerr=2.0 * points.strain_error, fmt="o", color=_POINT,
        markersize=3.0, markerfacecolor="none", linewidth=0.8, label="SIMULATED LDA",
    )  # fmt: skip


def _enlarged(ax: Axes, panel: StrainPanel) -> None:
    """The strain about the slip zone, in a corner of the panel."""
    curved = panel.solutions["curved"]
    slip = [zone for zone in curved.zones if zone.state == "slip"]
    if not slip:
        return
    width = slip[0].stop - slip[0].start
    inset = ax.inset_axes((0.45, 0.45, 0.53, 0.5))
    _curves(inset, panel)
    inset.set_xlim(slip[0].start - 1.5 * width, slip[0].stop + 1.5 * width)
    inset.axvspan(slip[0].start, slip[0].stop, facecolor="#f9e6d3", linewidth=0.0)
    inset.tick_params(labelsize=7)
    inset.set_title("slip zone, enlarged", size=8, loc="left")


def _placed(ax: Axes, figure: Figure) -> Figure:
    ax.set_xlabel(_ALONG)
    return figure
