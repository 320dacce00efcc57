"""Pictures of dynamic-mechanical data: master curve, shifts, phase, deviation."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from rollnip.dma.fit import DmaFit
from rollnip.dma.quality import relative_deviations
from rollnip.dma.timefit import TimeFit
from rollnip.figures import MEASURED
from rollnip.materials import creep_compliance, relaxation_modulus
from rollnip.plots.style import FULL, MARK, Look, Style, label, page, palette_of, prepare

_HEIGHT = 150.0  # mm


def plot_dma(fit: DmaFit, style: Style = "light") -> Figure:
    """Draw master curve, shift factors, phase over modulus and deviations on one page.

    Parameters
    ----------
    fit :
        from `fit_dma`.
    style :
        "light" or "dark".

    Returns
    -------
    Figure
        180 by 150 mm, not registered with pyplot.
    """
    figure = page(style, _HEIGHT)
    (master, shifts), (phase, deviation) = figure.subplots(2, 2)
    plot_master(fit, master, style=style)
    plot_shifts(fit, shifts, style=style)
    plot_phase(fit, phase, style=style)
    plot_deviation(fit, deviation, style=style)
    return figure


def plot_master(fit: DmaFit, ax: Axes | None = None, style: Style | None = None) -> Axes:
    """Draw storage and loss modulus over reduced frequency, with the fitted material as curves."""
    ax, look = prepare(ax, style)
    colours, data = look.palette, fit.master.reduced
    frequency = data.omega / (2.0 * np.pi)
    grid = np.geomspace(float(np.min(frequency)), float(np.max(frequency)), 400)
    plain = replace(fit.material, temperature=None, shift=None)
    found = plain.modulus_at(2j * np.pi * grid)
    for values, curve, colour, mark, name in (
        (data.storage, found.real, colours.pressure, "o", "storage"),
        (data.loss, found.imag, colours.shear, "s", "loss"),
    ):
        ax.loglog(
            frequency,
            values,
            mark,
            color=colour,
            markersize=MARK * look.size,
            markerfacecolor="none",
            markeredgewidth=look.thin,
            label=name,
        )
        name = "material" if mark == "s" else "_"
        ax.loglog(grid, curve, color=colours.ink, linewidth=0.7 * look.line, label=name)
    label(
        ax,
        look,
        _at_reference("frequency", fit.master.reference),
        MEASURED["young_modulus"].axis,
    )
    _legend(ax, look)
    return ax


def _at_reference(key: str, reference: float) -> str:
    """Return the axis label of a quantity shifted to the reference temperature [degC]."""
    figure = MEASURED[key]
    return figure.axis_for(f"{figure.label} at {reference:g} {MEASURED['temperature'].shown_unit}")


def plot_time(fit: TimeFit, style: Style = "light") -> Figure:
    """Draw a relaxation modulus or creep compliance over reduced time, with the fitted material.

    Returns
    -------
    Figure
        88 by 66 mm, not registered with pyplot.
    """
    figure = page(style, 66.0, 0.49 * FULL)
    ax, look = prepare(figure.subplots(), style)
    colours, data = look.palette, fit.master.reduced
    grid = np.geomspace(*fit.time_range, 300)
    plain = replace(fit.material, temperature=None, shift=None)
    creeps = data.kind == "creep"
    curve = creep_compliance(plain, grid) if creeps else relaxation_modulus(plain, grid)
    ax.loglog(
        1.0 / data.omega,
        data.storage,
        "o",
        color=colours.pressure,
        markersize=MARK * look.size,
        markerfacecolor="none",
        markeredgewidth=look.thin,
        label="measured",
    )
    ax.loglog(grid, curve, color=colours.ink, linewidth=0.7 * look.line, label="material")
    name = MEASURED["creep_compliance" if creeps else "relaxation_modulus"].axis
    label(ax, look, _at_reference("duration", fit.master.reference), name)
    _legend(ax, look)
    return figure


def plot_shifts(fit: DmaFit, ax: Axes | None = None, style: Style | None = None) -> Axes:
    """Draw the independent shift of each isotherm with two standard errors, and the law."""
    ax, look = prepare(ax, style)
    colours, master = look.palette, fit.master
    if fit.shift.law is not None:
        cold, warm = fit.temperature_range
        grid = np.linspace(cold, warm, 200)
        law = [np.log10(fit.shift.law.factor(float(t))) for t in grid]
        name = type(fit.shift.law).__name__
        ax.plot(grid, law, color=colours.pressure, linewidth=look.line, label=name)
    free = fit.free
    if free is not None:
        ax.errorbar(
            master.temperatures,
            free.horizontal,
            yerr=2.0 * fit.free_errors,
            fmt="o",
            color=colours.shear,
            markerfacecolor="none",
            markersize=0.45 * look.size,
            linewidth=1.5 * look.thin,
            label="each by itself, ± 2 standard errors",
        )
    else:
        ax.plot(master.temperatures, master.horizontal, "o", color=colours.shear, label="isotherms")
    label(ax, look, MEASURED["temperature"].axis, "$\\log_{10}\\,a_T$")
    _legend(ax, look)
    return ax


def plot_phase(fit: DmaFit, ax: Axes | None = None, style: Style | None = None) -> Axes:
    """Draw phase over magnitude of the complex modulus (van Gurp & Palmen 1998), by isotherm.

    The frequency does not enter: isotherms that do not fall on one curve cannot be made to coincide
    by
    shifts along the frequency axis alone.
    """
    ax, look = prepare(ax, style)
    master, data = fit.master, fit.master.data
    cold, warm = fit.temperature_range
    scale = Normalize(cold, warm if warm > cold else cold + 1.0)
    colours = look.palette.sequential
    for group, temperature in zip(master.groups, master.temperatures, strict=True):
        modulus = data.storage[group] + 1j * data.loss[group]
        ax.semilogx(
            np.abs(modulus),
            np.degrees(np.angle(modulus)),
            "o",
            color=colours(0.25 + 0.7 * float(scale(temperature))),
            markersize=MARK * look.size,
            markerfacecolor="none",
            markeredgewidth=look.thin,
        )
    label(ax, look, MEASURED["complex_modulus"].axis, MEASURED["phase"].axis)
    ax.set_title(
        f"darkest: {warm:.0f} °C, lightest: {cold:.0f} °C"
        if look.palette is palette_of("light")
        else f"lightest: {warm:.0f} °C, darkest: {cold:.0f} °C",
        loc="left",
        fontsize=look.small,
        color=look.palette.muted,
    )
    return ax


def plot_deviation(fit: DmaFit, ax: Axes | None = None, style: Style | None = None) -> Axes:
    """Draw the deviation of the material from the measured moduli in per cent of the latter."""
    ax, look = prepare(ax, style)
    colours, data = look.palette, fit.master.reduced
    storage, loss = relative_deviations(fit.material, data)
    frequency = data.omega / (2.0 * np.pi)
    for values, rms, colour, mark, name in (
        (storage, fit.deviation[0], colours.pressure, "o", "storage"),
        (loss, fit.deviation[1], colours.shear, "s", "loss"),
    ):
        ax.semilogx(
            frequency,
            100.0 * values,
            mark,
            color=colour,
            markersize=MARK * look.size,
            markerfacecolor="none",
            markeredgewidth=look.thin,
            label=f"{name}, {100.0 * rms:.2g} % rms",
        )
    ax.axhline(0.0, color=colours.muted, linewidth=look.thin)
    across = _at_reference("frequency", fit.master.reference)
    label(ax, look, across, MEASURED["deviation"].axis)
    # The points fill the axes, so the legend stands above them.
    _legend(ax, look, above=True)
    return ax


def _legend(ax: Axes, look: Look, *, above: bool = False) -> None:
    ink = look.palette.ink
    if above:
        ax.legend(
            frameon=False,
            fontsize=look.small,
            labelcolor=ink,
            loc="lower left",
            bbox_to_anchor=(0.0, 1.0),
            ncols=2,
            borderaxespad=0.2,
        )
    else:
        ax.legend(frameon=False, fontsize=look.small, labelcolor=ink, loc="best")
