"""A solved patch as a tree for JSON, and as lines of text for a terminal."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from importlib.metadata import version
from math import isfinite
from typing import Any

import numpy as np

from rollnip._results.case import patch_case_tree, patch_problem_hash
from rollnip.figure import Units
from rollnip.figures import CLAIMED as PLANE_CLAIMED
from rollnip.figures import FIGURES, PROFILES
from rollnip.patch.coefficients import Array
from rollnip.patch.depth import PatchStress
from rollnip.patch.ends import FaceEnd
from rollnip.patch.figures import CLAIMED, PATCH_FIELDS, PATCH_FIGURES, is_shown
from rollnip.patch.solution import PatchSolution


def patch_dict(solution: PatchSolution, *, fields: bool = False) -> dict[str, Any]:
    """Return a result in three dimensions as plain values.

    Parameters
    ----------
    solution : what `solve_patch` returned.
    fields : whether to include the fields over the grid, as lists of rows along x.

    Returns
    -------
    A tree of numbers, texts and None, in mm, N, MPa and s. ``case`` is what was solved, as the tree
    of a case file in base units; solving it again gives the same result.
    """
    grid = solution.grid
    figures: dict[str, Any] = {key: one.value(solution) for key, one in PATCH_FIGURES.items()}
    figures["error"] = {key: one.error(solution) for key, one in CLAIMED.items()}
    tree: dict[str, Any] = {
        "schema": 1,
        "title": solution.patch.title,
        "converged": solution.converged,
        "status": solution.status,
        "geometry": "linear",
        **origin_of(solution),
        **plane_dict(solution),
        "patch": figures,
        "warnings": list(solution.warnings),
        "solver": {
            "elements": grid.nx * grid.ny,
            "iterations": solution.level.turns,
            "residual": None,
            "seconds": None,
            "version": version("rollnip"),
            "status": solution.status,
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


def plane_dict(solution: PatchSolution) -> dict[str, Any]:
    """Return the keys that results of every kind have: forces are in N, torques in N mm.

    The nip width is the length of the patch along x. What a patch does not have is None; its fields
    take the place of zones and profiles.
    """
    found = _plane_values(solution)
    tree: dict[str, Any] = {}
    for figure in FIGURES.values():
        table, _, key = figure.key.rpartition(".")
        (tree.setdefault(table, {}) if table else tree)[key] = found.get(figure.name)
    tree["contact"] = [_along_rolling(solution)]
    tree["zones"] = []
    claimed = {key: CLAIMED.get(PLANE_KEYS.get(key, "")) for key in PLANE_CLAIMED}
    tree["error"] = {key: one and one.error(solution) for key, one in claimed.items()}
    tree["profiles"] = dict.fromkeys(PROFILES)
    return tree


def _plane_values(solution: PatchSolution) -> dict[str, float | None]:
    """Return the figures of a nip that a patch has, by name."""
    found: dict[str, float | None] = {
        key: PATCH_FIGURES[own].value(solution) for key, own in PLANE_KEYS.items()
    }
    speed, creepage, load = solution.patch.speed, found["creepage"], solution.load
    _, highest = np.unravel_index(int(np.argmax(solution.pressure)), solution.pressure.shape)
    if creepage is not None:
        found["speed_ratio"] = (1.0 + 0.5 * creepage) / (1.0 - 0.5 * creepage)
    if speed:
        found["dwell_time"] = solution.length / speed
    found["peak_pressure_x"] = float(solution.x[highest])
    found["mean_pressure"] = load / solution.area
    found["rolling_resistance"] = solution.viscous_resistance / load
    return found


def _along_rolling(solution: PatchSolution) -> list[float]:
    """Return the trailing and the leading end of the patch [mm]."""
    (touching,) = np.nonzero((solution.pressure > 0.0).any(axis=0))
    middle = 0.5 * float(solution.x[touching[0]] + solution.x[touching[-1]])
    return [middle - 0.5 * solution.length, middle + 0.5 * solution.length]


def origin_of(solution: PatchSolution) -> dict[str, Any]:
    """Return what was solved, and by which rollnip: tolerance, version, case and its hash."""
    problem = (solution.patch, solution.tolerance, solution.prescribed)
    return {
        "tolerance": solution.tolerance,
        "version": version("rollnip"),
        "case_hash": patch_problem_hash(*problem),
        "case": patch_case_tree(*problem),
    }


def fields_of(solution: PatchSolution) -> dict[str, Array]:
    """Return the fields over the grid by name, (ny, nx) each."""
    return {key: getattr(solution, key).astype(float) for key in PATCH_FIELDS}


def patch_lines(solution: PatchSolution, units: Units = "metric") -> Iterator[str]:
    """Yield the summary of a patch, line by line, in metric or US units."""
    yield solution.patch.title or "Patch"
    yield f"  {solution.status}"
    grid = solution.grid
    yield f"  {'grid':22s} {grid.nx} x {grid.ny} rectangles"
    for one in PATCH_FIGURES.values():
        if is_shown(one, solution):
            yield f"  {one.label:22s} {_shown(one.in_units(units), solution)}"
    for warning in solution.warnings:
        yield f"  note: {warning}"


def _shown(figure: Any, solution: PatchSolution) -> str:
    """Return a figure with its error in the unit shown, or 0 where the error is larger than it."""
    value, error = figure.value(solution), figure.error(solution)
    unit = f" {figure.shown_unit}" if figure.shown_unit else ""
    if error is None:
        return f"{value * figure.factor:12.5g}{unit}"
    shown = 0.0 if abs(value) <= error and figure.when != "always" else value
    return f"{shown * figure.factor:12.5g}{unit}  (± {error * figure.factor:.1g})"


def stress_rows(field: PatchStress) -> list[dict[str, float]]:
    """Return the largest stresses at each depth, and the place of the largest von Mises stress."""
    rows = []
    for i, z in enumerate(field.z):
        worst = field.von_mises[i]
        j, k = np.unravel_index(int(np.argmax(worst)), worst.shape)
        rows.append(
            {
                "z": float(z),
                "von_mises": float(worst[j, k]),
                "x": float(field.x[k]),
                "y": float(field.y[j]),
                "max_shear": float(field.max_shear[i].max()),
                "largest_tension": float(field.principal[0, i].max()),
                "largest_compression": float(-field.principal[2, i].min()),
                "bond_shear": float(np.hypot(field.s_xz[i], field.s_yz[i]).max()),
            }
        )
    return rows


def stress_lines(
    title: str, side: str, rows: list[dict[str, float]], warnings: Iterable[str] = ()
) -> Iterator[str]:
    """Yield the largest stresses at each depth and the warnings of the patch, line by line."""
    yield title or "Patch"
    yield f"  largest stresses in the {side} roller [MPa]; von Mises' at (x, y)"
    yield "  depth [mm]  von Mises       x       y  max shear  tension  compression  bond shear"
    for row in rows:
        yield (
            f"  {row['z']:10.4g}  {row['von_mises']:9.4g}  {row['x']:6.3g}  {row['y']:6.3g}"
            f"  {row['max_shear']:9.4g}  {row['largest_tension']:7.3g}"
            f"  {row['largest_compression']:11.4g}  {row['bond_shear']:10.4g}"
        )
    for warning in warnings:
        yield f"  note: {warning}"


def end_dict(end: FaceEnd) -> dict[str, Any]:
    """Return the end of a face as plain values, with lists over the distance from it."""
    return {
        "line_load": end.line_load,
        "added_length": end.added_length,
        "error": {"added_length": end.error},
        "distance": end.distance.tolist(),
        "load": end.load.tolist(),
        "peak_pressure": end.peak_pressure.tolist(),
        "converged": not end.status,
        "status": end.status,
        "warnings": list(end.warnings),
    }


def end_lines(end: FaceEnd) -> Iterator[str]:
    """Yield the end of a face, line by line."""
    yield f"Line load far from the end: {end.line_load:.4g} N/mm"
    yield f"Length that the end adds to the load: {end.added_length:.3g} mm (± {end.error:.1g})"
    yield "  distance [mm]  load  peak pressure (over those far from the end)"
    for share in _ENDS:
        i = int(np.searchsorted(end.distance, share * end.distance[-1]))
        yield f"  {end.distance[i]:13.3g}  {end.load[i]:4.2f}  {end.peak_pressure[i]:13.2f}"
    for warning in end.warnings:
        yield f"note: {warning}"


PLANE_KEYS = {
    "load": "load",
    "approach": "approach",
    "traction": "traction_x",
    "creepage": "creepage",
    "nip_width": "length",
    "peak_pressure": "peak_pressure",
    "torque_upper": "torque_upper",
    "torque_lower": "torque_lower",
    "dissipation_friction": "dissipation_friction",
    "dissipation_viscous": "dissipation_viscous",
}
"""Figures of a nip that are figures of a patch, too, and their keys there."""

_ENDS = (0.0, 0.01, 0.02, 0.04, 0.07, 0.1, 0.15, 0.2, 0.3, 0.5, 1.0)
"""Places in the summary, over the longest distance."""


def _rows(field: Array) -> list[list[float | None]]:
    return [[float(v) if isfinite(v) else None for v in row] for row in field.tolist()]
