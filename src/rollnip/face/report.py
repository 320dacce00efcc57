"""A solved face as a tree for JSON, and as lines of text for a terminal."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rollnip._results.case import case_tree, problem_hash
from rollnip.face.figures import (
    BEARING_FORCES,
    FACE_FIGURES,
    FACE_PROFILES,
    SHEET_FACE_FIGURES,
    SHEET_FACE_PROFILES,
    figures_of,
    profiles_of,
)
from rollnip.figure import Units

if TYPE_CHECKING:
    from rollnip.face.impression import ImpressionReading
    from rollnip.face.solution import FaceSolution

Array = NDArray[np.float64]

_SILENT = ("mean_load", "evenness")
_SHOWN_OVER_Y = (
    *("load", "approach", "nip_width", "peak_pressure", "traction"),
    *("traction_upper", "feed_upper", "tension_in"),
)
_OF_FRICTION = ("creepage", "total_traction", "largest_scrub")


def face_dict(solution: FaceSolution) -> dict[str, Any]:
    """Return the value of the key "face" of a result: scalars, bearings, errors, lists over y."""
    bearings = {
        name: None if one is None else [one.first, one.second]
        for name, one in ((name, solution.bearings(name)) for name in ("upper", "lower"))
    }
    tree: dict[str, Any] = {"converged": solution.converged, "status": solution.status}
    tree |= {key: figure.value(solution) for key, figure in figures_of(solution).items()}
    if not _has_friction(solution):
        tree["creepage"] = None
    tree |= {
        "bearing_forces": bearings,
        "error": dict(solution.error),
        "warnings": list(solution.warnings),
    }
    return tree | {key: figure.values(solution) for key, figure in profiles_of(solution).items()}


def face_variables(tree: dict[str, Any]) -> tuple[dict[str, tuple[Any, ...]], dict[str, Any]]:
    """Return the contents of the key "face" as variables and attributes of an xarray dataset.

    Variables are over ``y``; their names begin with ``face_``, and None becomes nan.
    """
    variables: dict[str, tuple[Any, ...]] = {}
    for key, figure in {**FACE_PROFILES, **SHEET_FACE_PROFILES}.items():
        if key not in tree:
            continue
        values = tree[key]
        row = [None] * len(tree["y"]) if values is None else values
        name = key if key == "y" else f"face_{key}"
        variables[name] = ("y", _floats(row), figure.described)
    for key, figure in {**FACE_FIGURES, **SHEET_FACE_FIGURES}.items():
        if key not in tree:
            continue
        variables[f"face_{key}"] = ((), _floats([tree[key]])[0], figure.described)
    for key, error in tree["error"].items():
        about = {"units": "1", "long_name": f"relative error over the face: {key}"}
        variables[f"face_error_{key}"] = ((), error, about)
    for name, forces in tree["bearing_forces"].items():
        figure = BEARING_FORCES[name]
        values = [None, None] if forces is None else forces
        variables[f"face_{figure.key}"] = ("bearing", _floats(values), figure.described)
    attributes = {
        "face_converged": int(tree["converged"]),
        "face_status": tree["status"],
        "face_warnings": "\n".join(tree["warnings"]),
    }
    return variables, attributes


def _floats(values: list[float | None]) -> list[float]:
    return [float("nan") if one is None else one for one in values]


def reading_dict(reading: ImpressionReading) -> dict[str, Any]:
    """Return a reading of impressions as a tree: estimates with intervals, and the fit."""
    return {
        "estimates": {
            one.name: {"value": one.value, "low": one.low, "high": one.high, "unit": one.unit}
            for one in reading.estimates
        },
        "chi_squared": reading.chi_squared,
        "freedom": reading.freedom,
        "shop_crown": reading.shop_crown,
        "needed_crown": reading.needed_crown,
        "bearing_offset": reading.bearing_offset,
        "warnings": list(reading.warnings),
    }


def face_parts(solution: FaceSolution) -> dict[str, Any]:
    """Return the keys of a result that a face adds or changes: "face", "case" and "case_hash"."""
    face = solution.face
    table: dict[str, Any] = {
        "length": face.length,
        "skew": face.skew,
        "nip_angle": face.nip_angle,
    }
    if solution.nip.sheet is not None:
        table["sheet_across"] = face.sheet_across
    if face.ends != "plane":
        table |= {"ends": face.ends, "end_radius": face.end_radius}
    if face.bearing_offset is not None:
        table["bearing_offset"] = face.bearing_offset
    case = case_tree(solution.nip, solution.model) | {"face": table}
    if face.end_loads is not None:
        table["end_loads"] = list(face.end_loads)
        del case["nip"]["load"]
    digits = problem_hash(solution.nip, solution.model, face)
    return {"case": case, "case_hash": digits, "face": face_dict(solution)}


def face_lines(
    solution: FaceSolution, said: Collection[str] = (), units: Units = "metric"
) -> Iterator[str]:
    """Yield the summary of a face, line by line.

    Parameters
    ----------
    said : warnings that were shown before, and are left out.
    units : metric or US ones.
    """
    word = "converged and verified" if solution.converged else "NOT CONVERGED"
    yield f"Face ({word}; {solution.law.solves} cross-sections)"
    yield f"  {'':28s} {'y < 0 end':>12s} {'middle':>12s} {'y > 0 end':>12s}"
    middle = solution.y.size // 2
    for key, figure in profiles_of(solution).items():
        if key in _SHOWN_OVER_Y:
            one = figure.in_units(units)
            values = one.factor * getattr(solution, key)
            shown = "".join(f" {_four(values[i], values):>12s}" for i in (0, middle, -1))
            yield f"  {one.label:28s}{shown} {one.shown_unit}"
    for key, figure in figures_of(solution).items():
        value = figure.value(solution)
        hidden = not _has_friction(solution) and key in _OF_FRICTION
        if value is not None and key not in _SILENT and not hidden:
            text = figure.in_units(units).text(_quiet(key, value, solution))
            yield f"  {figure.label:28s} {text}"
    for name in ("upper", "lower"):
        forces = solution.bearings(name)
        if forces is not None:
            figure = BEARING_FORCES[name].in_units(units)
            ends = f"{figure.number(forces.first)} and {figure.text(forces.second)}"
            yield f"  {figure.label:28s} {ends}"
    for warning in solution.warnings:
        if warning not in said:
            yield f"  Note: {warning}"


def _has_friction(solution: FaceSolution) -> bool:
    return solution.nip.friction > 0.0 or solution.nip.sheet is not None


def _quiet(key: str, value: float, solution: FaceSolution) -> float:
    """Return a total, or 0 where it is a rounding error beside its size."""
    sizes = {
        "total_traction": solution.total_load,
        "feed_difference": 1.0,
        "total_torque_upper": solution.total_load * solution.nip_width.max(),
        "total_torque_lower": solution.total_load * solution.nip_width.max(),
        "bearing_offset": float(np.max(np.abs(solution.approach))),
    }
    return 0.0 if abs(value) < 1e-7 * sizes.get(key, 0.0) else value


def _four(value: float, values: Array) -> str:
    """Return a value with four digits; 0 where it is a rounding error beside the largest."""
    size = float(np.max(np.abs(values), initial=0.0))
    return "0" if abs(value) < 1e-9 * max(size, 1e-12) else f"{value:.4g}"
