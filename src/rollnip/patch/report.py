"""A solved patch as a tree for JSON, and as lines for a terminal."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite
from typing import Any

import numpy as np

from rollnip.patch.coefficients import Array
from rollnip.patch.measures import FIGURES
from rollnip.patch.solution import PatchSolution

UNITS = {
    "load": "N",
    "approach": "mm",
    "length": "mm",
    "width": "mm",
    "area": "mm2",
    "peak_pressure": "MPa",
    "traction_x": "N",
    "traction_y": "N",
    "spin_moment": "N mm",
    "creepage": "",
    "lateral_creepage": "",
    "load_centre": "mm",
    "viscous_resistance": "N",
}
"""Units of the figures."""

_LOSSES = ("load_centre", "viscous_resistance")
_ALWAYS = FIGURES[:6]

FIELDS = {
    "pressure": ("MPa", "contact pressure"),
    "shear_x": ("MPa", "shear traction on the upper roller along x"),
    "shear_y": ("MPa", "shear traction on the upper roller along y"),
    "slip_x": ("1", "slip velocity over rolling speed, along x"),
    "slip_y": ("1", "slip velocity over rolling speed, along y"),
    "gap": ("mm", "gap of the deformed surfaces"),
    "state": ("1", "0 apart, 1 stick, 2 slip"),
}
"""Units and descriptions of the fields."""


def patch_dict(solution: PatchSolution, *, fields: bool = False) -> dict[str, Any]:
    """Return a result in three dimensions as plain values.

    Parameters
    ----------
    solution : what `solve_patch` returned.
    fields : whether the fields over the grid are part of it, as lists of rows along x.
    """
    patch, grid = solution.patch, solution.grid
    figures = {name: _plain(solution.figures[name]) for name in FIGURES}
    figures["creepage"] = solution.creepage
    figures["lateral_creepage"] = solution.lateral_creepage
    tree: dict[str, Any] = {
        "schema": 1,
        "title": patch.title,
        "converged": solution.converged,
        "status": solution.status,
        "patch": figures | _losses(solution),
        "warnings": list(solution.warnings),
        "solver": {
            "rectangles": [grid.nx, grid.ny],
            "side_x": grid.hx,
            "side_y": grid.hy,
            "turns": solution.level.turns,
            "tolerance": solution.tolerance,
        },
    }
    if fields:
        values = {name: _rows(field) for name, field in fields_of(solution).items()}
        tree["fields"] = {"x": grid.x.tolist(), "y": grid.y.tolist()} | values
    return tree


def _losses(solution: PatchSolution) -> dict[str, Any]:
    """Return spin, losses, torques and all errors by key."""
    errors = {name: _plain(value) for name, value in solution.error.items()}
    errors |= {
        "friction_resistance": solution.friction_resistance_error,
        "rolling_resistance": solution.rolling_resistance_error,
    }
    return {
        "spin": solution.patch.spin,
        "friction_resistance": solution.friction_resistance,
        "rolling_resistance": solution.rolling_resistance,
        "dissipation_friction": solution.dissipation_friction,
        "dissipation_viscous": solution.dissipation_viscous,
        "torque_upper": solution.torque_upper,
        "torque_lower": solution.torque_lower,
        "error": errors,
    }


def fields_of(solution: PatchSolution) -> dict[str, Array]:
    """Return the fields over the grid by name, (ny, nx) each."""
    slip_x, slip_y = solution.slip
    return {
        "pressure": solution.pressure,
        "shear_x": solution.shear_x,
        "shear_y": solution.shear_y,
        "slip_x": slip_x,
        "slip_y": slip_y,
        "gap": solution.gap,
        "state": solution.state.astype(float),
    }


def patch_lines(solution: PatchSolution) -> Iterator[str]:
    """Yield the summary of a patch, line by line."""
    yield solution.patch.title or "Patch"
    yield f"  {solution.status}"
    grid = solution.grid
    yield f"  {'grid':22s} {grid.nx} x {grid.ny} rectangles"
    for name in _shown(solution):
        value, error = solution.figures[name], solution.error[name]
        unit = f" {UNITS[name]}" if UNITS[name] else ""
        shown = 0.0 if abs(value) <= error and name not in _ALWAYS else value
        yield f"  {name.replace('_', ' '):22s} {shown:12.5g}{unit}  (+- {error:.1g})"
    yield from _loss_lines(solution)
    for warning in solution.warnings:
        yield f"  note: {warning}"


def _shown(solution: PatchSolution) -> list[str]:
    """Return the names of figures that mean something: not all do without friction or losses."""
    names = list(_ALWAYS if solution.patch.friction == 0.0 else FIGURES[:-2])
    return names + (list(_LOSSES) if solution.patch.is_viscoelastic else [])


def _loss_lines(solution: PatchSolution) -> Iterator[str]:
    off = f"N  (+- {solution.rolling_resistance_error:.1g})"
    if solution.patch.friction > 0.0:
        yield f"  {'spin':22s} {solution.patch.spin:12.5g} 1/mm"
        slips = float(np.mean(solution.state[solution.pressure > 0.0] == 2))
        yield f"  {'slips':22s} {100.0 * slips:12.3g} % of the patch"
        yield f"  {'friction resistance':22s} {solution.friction_resistance:12.5g} {off}"
    if solution.patch.is_viscoelastic:
        yield f"  {'rolling resistance':22s} {solution.rolling_resistance:12.5g} {off}"
    for name, power in (
        ("friction power", solution.dissipation_friction),
        ("viscous power", solution.dissipation_viscous),
    ):
        if power is not None:
            yield f"  {name:22s} {1e-3 * power:12.5g} W"


def _plain(value: float) -> float | None:
    return float(value) if isfinite(value) else None


def _rows(field: Array) -> list[list[float | None]]:
    return [[_plain(value) for value in row] for row in field.tolist()]
