"""The result of a solution as a tree of plain values, and files of it."""

from __future__ import annotations

import json
from math import isfinite
from pathlib import Path
from typing import Any

from rollnip._files import check_target, write_whole
from rollnip.figures import CLAIMED, FIGURES, PROFILES
from rollnip.interior import INTERFACE_FIGURES
from rollnip.io.netcdf import require_netcdf, write_netcdf
from rollnip.solution import Solution, Zone

SCHEMA = 1
SUFFIXES = (".json", ".nc")


def result_dict(solution: Solution, *, interfaces: bool = True) -> dict[str, Any]:
    """The result as a tree of finite numbers, texts and None: what the JSON holds.

    Units mm, N, MPa, s; per axial length, save ``totals`` (N, N m, W), which is there where the
    nip has a face width. What is not finite or not defined is None. The stresses on interfaces
    may take longer than the solution itself; without ``interfaces`` their key is not there.
    """
    tree: dict[str, Any] = {
        "schema": SCHEMA,
        "title": solution.nip.title,
        "converged": bool(solution.converged),
        "geometry": solution.model.geometry,
    }
    for figure in FIGURES.values():
        table, _, key = figure.key.rpartition(".")
        (tree.setdefault(table, {}) if table else tree)[key] = figure.value(solution)
    tree["contact"] = [[_number(edge) for edge in interval] for interval in solution.contact]
    tree["zones"] = [_zone(zone) for zone in solution.zones]
    if solution.nip.face_width is not None:
        tree["totals"] = _totals(solution, solution.nip.face_width)
    tree["error"] = {name: figure.error(solution) for name, figure in CLAIMED.items()}
    profiles = solution.profiles
    tree["profiles"] = {name: _numbers(getattr(profiles, name)) for name in PROFILES}
    tree["solver"] = {
        "elements": int(solution.solver.elements),
        "iterations": int(solution.solver.iterations),
        "residual": _number(solution.solver.residual),
        "seconds": _number(solution.solver.seconds),
        "version": solution.solver.version,
        "geometry_change": _number(solution.solver.geometry_change),
        "status": solution.status,
    }
    tree["warnings"] = list(solution.warnings)
    if interfaces:
        tree["interfaces"] = [
            {"roller": interface.roller, "bond": interface.is_bond}
            | {name: _number(getattr(interface, name)) for name in INTERFACE_FIGURES}
            for interface in solution.interfaces
        ]
    return tree


def result_text(solution: Solution) -> str:
    """The result as JSON, a line for each key."""
    lines = [
        f"{json.dumps(name)}: {json.dumps(value, allow_nan=False)}"
        for name, value in result_dict(solution).items()
    ]
    return "{\n  " + ",\n  ".join(lines) + "\n}\n"


def write_result(solution: Solution, path: str | Path) -> None:
    """Write a solution to a file, all or nothing.

    Parameters
    ----------
    solution :
        what `solve` returned.
    path :
        ends in .json or .nc (netCDF, with the extra ``rollnip[netcdf]``).

    Raises
    ------
    RollnipError
        where the ending is another, the extra is missing, or the file cannot be written; a file
        of that name stays as it was.
    """
    target = Path(path)
    check_result_target(target)
    if target.suffix.lower() == ".nc":
        tree = result_dict(solution)
        write_whole(target, lambda file: write_netcdf(tree, file))
    else:
        text = result_text(solution)
        write_whole(target, lambda file: file.write_text(text, encoding="utf-8", newline="\n"))


def check_result_target(path: Path) -> None:
    """Raise RollnipError where a result could not be written to ``path``; costs next to nothing."""
    check_target(path, SUFFIXES)
    if path.suffix.lower() == ".nc":
        require_netcdf()


def _number(value: float | None) -> float | None:
    if value is None or not isfinite(value):
        return None
    return float(value)


def _numbers(values: Any) -> list[float | None] | None:
    if values is None:
        return None
    return [_number(value) for value in values.tolist()]


def _zone(zone: Zone) -> dict[str, Any]:
    tree = {"from": _number(zone.start), "to": _number(zone.stop), "state": zone.state}
    if zone.direction is not None:
        tree["direction"] = int(zone.direction)
    return tree


def _totals(solution: Solution, width: float) -> dict[str, float | None]:
    """The figures of the whole face: N, N m, W."""
    totals: dict[str, float | None] = {"face_width": width}
    for figure in FIGURES.values():
        if figure.total is not None:
            value = figure.value(solution)
            scale = width * figure.total.factor
            totals[figure.name] = None if value is None else _number(value * scale)
    return totals
