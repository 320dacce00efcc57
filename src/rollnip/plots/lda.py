"""Pictures of laser-Doppler measurements: a record, a velocity profile, a comparison."""

from __future__ import annotations

from pathlib import Path
from typing import cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rollnip._files import check_target, write_whole
from rollnip.figures import MEASURED, PROFILES
from rollnip.lda import Comparison, Scan, VelocityProfile, detect_bursts

_SUFFIXES = (".png", ".svg", ".pdf")
_SIZE = (8.0, 4.8)  # inches
_BLUE, _RED, _GREY, _NIP = "#0072b2", "#d55e00", "#595959", "#e3edf4"
_SHOWN = 12  # bursts in the picture of a record


def plot_comparison(
    comparison: Comparison, ax: Axes | None = None, *, simulated: bool = False
) -> Axes:
    """Draw measured and computed strain over x, with error bars; the nip is shaded.

    Parameters
    ----------
    comparison : from `rollnip.lda.compare`.
    ax : axes to draw on; None makes a figure of its own (``ax.figure``).
    simulated : whether the points are simulated; the legend then says so.
    """
    ax = _axes(ax)
    curve = comparison.curve
    ax.axvspan(*comparison.contact, facecolor=_NIP, linewidth=0.0, label="contact")
    ax.axhline(0.0, color=_GREY, linewidth=0.8)
    ax.plot(curve.x, curve.speed, color=_BLUE, linewidth=1.8, label="computed")
    ax.errorbar(
        comparison.x,
        comparison.strain,
        yerr=2.0 * comparison.strain_error,
        fmt="o",
        color=_RED,
        markersize=3.5,
        markerfacecolor="none",
        linewidth=1.0,
        label=f"{'SIMULATED' if simulated else 'measured'} LDA ± 2 standard errors",
    )
    fit = comparison
    ax.set_title(
        f"rms {fit.rms:.2g} (noise {fit.noise:.2g}), χ²/n = "
        f"{fit.chi_square:.3g}/{fit.degrees}, p = {fit.probability:.2g}",
        loc="left",
        fontsize="medium",
    )
    return _finished(ax, "strain $\\epsilon_x = v/V - 1$")


def plot_velocity(profile: VelocityProfile, ax: Axes | None = None) -> Axes:
    """Draw the velocity at each position with its own and the joint confidence interval."""
    ax = _axes(ax)
    for band, width, called in (
        (profile.joint_band, 1.0, "all positions together"),
        (profile.band, 3.0, "each position"),
    ):
        label = f"{100.0 * profile.confidence:g} %, {called}"
        ax.errorbar(
            profile.x, profile.velocity, yerr=band, fmt="none", color=_BLUE, elinewidth=width,
            label=label,
        )  # fmt: skip
    ax.plot(profile.x, profile.velocity, "o", color=_RED, markersize=2.5, label="mean")
    if profile.speed is not None:
        label = "circumferential speed"
        ax.axhline(profile.speed, color=_GREY, linewidth=0.9, linestyle=":", label=label)
    return _finished(ax, MEASURED["velocity"].axis_for("velocity v"))


def plot_record(scan: Scan, ax: Axes | None = None) -> Axes:
    """Draw the beginning of a simulated record; validated bursts are marked with their velocity."""
    ax = _axes(ax)
    record, instrument = scan.example, scan.instrument
    bursts = detect_bursts(record.samples, instrument, scan.roller_speed)[:_SHOWN]
    stay = instrument.envelope_time(scan.roller_speed)
    end = (bursts[-1].time if bursts else 0.0) + 10.0 * stay
    count = min(record.samples.size, int(end * record.rate) + 1)
    time = 1e3 * np.arange(count) / record.rate
    ax.plot(time, record.samples[:count], color=_GREY, linewidth=0.4)
    top = float(np.max(np.abs(record.samples[:count])))
    last = -np.inf
    for burst in bursts:
        ax.axvspan(
            1e3 * (burst.time - 2.0 * stay),
            1e3 * (burst.time + 2.0 * stay),
            facecolor=_NIP,
            linewidth=0.0,
        )
        if burst.time - last < 0.02 * count / record.rate:
            continue  # its label would stand on the one before
        last = burst.time
        velocity = float(instrument.velocity(burst.frequency))
        ax.text(
            1e3 * burst.time, 1.08 * top, f"{velocity:.2f}", rotation=90, size=7, color=_RED,
            ha="center", va="bottom",
        )  # fmt: skip
    ax.set_ylim(-1.1 * top, 1.6 * top)
    ax.set_xlim(0.0, time[-1])
    ax.set_xlabel(MEASURED["record_time"].axis)
    ax.set_ylabel("signal / noise (standard deviation)")
    shown = MEASURED["velocity"].axis
    ax.set_title(f"SIMULATED bursts; validated ones with {shown}", loc="left", size="medium")
    return ax


def save_comparison(comparison: Comparison, path: str | Path, *, simulated: bool = False) -> None:
    """Draw `plot_comparison` into a file, all or nothing. Raises RollnipError."""
    ax = plot_comparison(comparison, simulated=simulated)
    _save(ax, Path(path))


def save_velocity(profile: VelocityProfile, path: str | Path) -> None:
    """Draw `plot_velocity` into a file, all or nothing. Raises RollnipError."""
    _save(plot_velocity(profile), Path(path))


def save_record(scan: Scan, path: str | Path) -> None:
    """Draw `plot_record` into a file, all or nothing. Raises RollnipError."""
    _save(plot_record(scan), Path(path))


def _axes(ax: Axes | None) -> Axes:
    return Figure(figsize=_SIZE, layout="constrained").subplots() if ax is None else ax


def _finished(ax: Axes, quantity: str) -> Axes:
    ax.margins(x=0.01)
    ax.set_xlabel(f"{PROFILES['x'].axis}  (← outlet, inlet →)")
    ax.set_ylabel(quantity)
    ax.legend(frameon=False, fontsize="small", loc="best")
    return ax


def _save(ax: Axes, path: Path) -> None:
    check_target(path, _SUFFIXES)
    figure = cast(Figure, ax.figure)
    kind = path.suffix.lower().removeprefix(".")
    write_whole(path, lambda file: figure.savefig(file, format=kind, dpi=150))
