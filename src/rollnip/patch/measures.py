"""Figures of a solution on a grid: sizes, forces, and the power lost in viscoelastic layers."""

from __future__ import annotations

import numpy as np

from rollnip.patch.coefficients import Array, Grid
from rollnip.patch.level import Level
from rollnip.patch.rolling import SHIFT

FIGURES = (
    "load",
    "approach",
    "length",
    "width",
    "area",
    "peak_pressure",
    "traction_x",
    "traction_y",
    "spin_moment",
    "creepage",
    "lateral_creepage",
    "load_centre",
    "viscous_resistance",
)
"""Figures whose error is estimated from the grid."""


def figures_of(level: Level) -> dict[str, float]:
    """Return the figures of a solution on one grid."""
    grid, pressure, shear = level.grid, level.normal.pressure, level.shear
    x, y = np.meshgrid(grid.x, grid.y)
    creepages = (0.0, 0.0, 0.0) if level.rolling is None else level.rolling.creepages
    element = grid.element
    arm = x - SHIFT * grid.hx  # the exact contact lies a quarter ahead: `RollingProblem.places`
    return {
        "load": float(np.sum(pressure)) * element,
        "approach": level.normal.approach,
        "length": _extent(np.max(pressure, axis=0), grid.hx),
        "width": _extent(np.max(pressure, axis=1), grid.hy),
        "area": _area(pressure, grid),
        "peak_pressure": float(np.max(pressure)),
        "traction_x": float(np.sum(shear[0])) * element,
        "traction_y": float(np.sum(shear[1])) * element,
        "spin_moment": float(np.sum(arm * shear[1] - y * shear[0])) * element,
        "creepage": creepages[0],
        "lateral_creepage": creepages[1],
        "load_centre": float(np.sum(x * pressure) / max(float(np.sum(pressure)), 1e-300)),
        "viscous_resistance": element * _lost_work(level),
    }


def _lost_work(level: Level) -> float:
    """Return minus the sum of tractions times the slope of their displacements [MPa].

    Symmetric compliances do not contribute: elastic bodies return the work that they take.
    """
    if level.products.coefficients.is_symmetric:
        return 0.0
    moved = level.products.displacement(level.normal.pressure, level.shear)
    tractions = np.stack([*level.shear, level.normal.pressure])
    return -float(np.sum(tractions * slope_of(moved, level.grid.hx)))


def slope_of(values: Array, side: float) -> Array:
    """Return the slope along x of values on a grid, (..., nx); 0 on the rim, out of contact."""
    out = np.zeros_like(values)
    out[..., 1:-1] = (values[..., 2:] - values[..., :-2]) / (2.0 * side)
    return out


def _extent(pressure: Array, side: float) -> float:
    """Return the length over which pressures, on rectangles of equal side, extend [mm]."""
    inside = np.flatnonzero(pressure > 0.0)
    if inside.size == 0:
        return 0.0
    low, high = _beyond(pressure[None, :])
    reach = inside[-1] - inside[0] + 1 + low[0, inside[0]] + high[0, inside[-1]]
    return float(reach) * side


def _area(pressure: Array, grid: Grid) -> float:
    """Return the area of the patch, with its edges interpolated row by row [mm2]."""
    low, high = _beyond(pressure)
    return float(np.sum(pressure > 0.0) + np.sum(low) + np.sum(high)) * grid.element


def _beyond(pressure: Array) -> tuple[Array, Array]:
    """Return how far each row extends beyond its end rectangles, in rectangles: low, high end.

    Near an edge the square of the pressure is linear in the distance from it. It is extrapolated to
    zero from the last two rectangles, by one rectangle at most. Where the contact ends with the
    grid, the face ends there.
    """
    touched, square = pressure > 0.0, pressure**2
    out = []
    for way in (slice(None), slice(None, None, -1)):
        t, s = touched[:, way], square[:, way]
        inner, outer = np.zeros_like(s), np.ones_like(t)
        inner[:, :-1] = s[:, 1:]
        outer[:, 1:] = t[:, :-1]
        ends = t & ~outer & (inner > s)
        reach = s / np.maximum(inner - s, 1e-300)
        out.append(np.where(ends, np.minimum(reach, 1.0) - 0.5, 0.0)[:, way])
    return out[0], out[1]
