"""A solved face as a tree for JSON, and as lines for a terminal."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from rollnip._results.case import case_tree, problem_hash
from rollnip.face.solution import FaceSolution

_LISTS = (
    "y",
    "load",
    "approach",
    "nip_width",
    "peak_pressure",
    "traction",
    "local_creepage",
    "deflection_upper",
    "deflection_lower",
    "friction_loss",
    "viscous_loss",
)


def face_dict(solution: FaceSolution) -> dict[str, Any]:
    """Return the key "face" of a result: lists over y, uniformity, totals, bearings, errors."""
    lists = {name: getattr(solution, name) for name in _LISTS}
    bearings = {
        name: None if one is None else [one.first, one.second]
        for name, one in ((name, solution.bearings(name)) for name in ("upper", "lower"))
    }
    return {
        "converged": solution.converged,
        "status": solution.status,
        "creepage": None if solution.nip.friction == 0.0 else solution.creepage,
        "mean_load": solution.mean_load,
        "total_load": solution.total_load,
        "total_traction": solution.total_traction,
        "evenness": solution.evenness,
        "even_share": solution.even_share,
        "largest_scrub": solution.largest_scrub,
        "bearing_forces": bearings,
        "error": dict(solution.error),
        "warnings": list(solution.warnings),
        **{name: None if values is None else values.tolist() for name, values in lists.items()},
    }


def face_parts(solution: FaceSolution) -> dict[str, Any]:
    """Return the keys of a result that a face adds or changes: "face", "case" and "case_hash"."""
    face = solution.face
    table: dict[str, Any] = {
        "length": face.length,
        "skew": face.skew,
        "nip_angle": face.nip_angle,
    }
    case = case_tree(solution.nip, solution.model) | {"face": table}
    if face.end_loads is not None:
        table["end_loads"] = list(face.end_loads)
        del case["nip"]["load"]
    digits = problem_hash(solution.nip, solution.model, face)
    return {"case": case, "case_hash": digits, "face": face_dict(solution)}


def face_lines(solution: FaceSolution) -> Iterator[str]:
    """Yield the summary of a face, line by line."""
    word = "converged and verified" if solution.converged else "NOT CONVERGED"
    yield f"Face ({word}; {solution.law.solves} cross-sections)"
    yield f"  {'':22s} {'y < 0 end':>12s} {'middle':>12s} {'y > 0 end':>12s}"
    middle = solution.y.size // 2
    rows = (
        ("line load", solution.load, "N/mm"),
        ("approach", solution.approach, "mm"),
        ("nip width", solution.nip_width, "mm"),
        ("peak pressure", solution.peak_pressure, "MPa"),
        ("traction", solution.traction, "N/mm"),
    )
    for label, values, unit in rows:
        shown = "".join(f" {_four(values[i], values):>12s}" for i in (0, middle, -1))
        yield f"  {label:22s}{shown} {unit}"
    yield f"  {'total load':22s} {solution.total_load:12.5g} N"
    if solution.nip.friction > 0.0:
        yield f"  {'creepage of the face':22s} {100.0 * solution.creepage:12.4g} %"
        yield f"  {'largest scrub':22s} {solution.largest_scrub:12.4g} N/mm"
    yield f"  {'smallest/largest load':22s} {solution.evenness:12.4g}"
    yield f"  {'within 10 % of mean':22s} {100.0 * solution.even_share:12.4g} % of the face"
    for name in ("upper", "lower"):
        forces = solution.bearings(name)
        if forces is not None:
            ends = f"{forces.first:12.5g} {'':12s} {forces.second:12.5g}"
            yield f"  {'bearings, ' + name:22s} {ends} N"
    for warning in solution.warnings:
        yield f"  note: {warning}"


def _four(value: float, values: np.ndarray[Any, np.dtype[np.float64]]) -> str:
    """Return four digits of a value; 0 where it is rounding beside the largest."""
    size = float(np.max(np.abs(values), initial=0.0))
    return "0" if abs(value) < 1e-9 * max(size, 1e-12) else f"{value:.4g}"
