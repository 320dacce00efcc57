"""A result as a tree of finite numbers, texts and None."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING, Any

from rollnip._results.case import case_tree, problem_hash
from rollnip._results.summary import inside_notes
from rollnip.figures import CLAIMED, FIGURES, INTERFACE_FIGURES, PROFILES
from rollnip.sheet_figures import SHEET_FIGURES, SHEET_PROFILES

if TYPE_CHECKING:
    from rollnip._results.records import Zone

SCHEMA = 1


def result_dict(solution: Any, *, interfaces: bool = True) -> dict[str, Any]:
    """Return the result as a tree of finite numbers, texts and None: the contents of the JSON.

    Units are mm, N, MPa and s, per axial length, except in ``totals`` (N, N m, W), which exists
    where the nip has a face width. ``case`` is what was solved, as the tree of a case file. What is
    not finite or not defined is None. The stresses on interfaces may take longer than the solution
    itself. Without ``interfaces`` their key is left out, and so is the warning that they could not
    be computed at finite strain.
    """
    tree: dict[str, Any] = {
        "schema": SCHEMA,
        "title": solution.nip.title,
        "converged": bool(solution.converged),
        "geometry": solution.model.geometry,
        "tolerance": solution.model.tolerance,
        "version": solution.solver.version,
        "case_hash": problem_hash(solution.nip, solution.model),
        "case": case_tree(solution.nip, solution.model),
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
    if solution.sheet is not None:
        tree["sheet"] = _sheet(solution)
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
        tree["warnings"] += inside_notes(solution)
    return tree


def _sheet(solution: Any) -> dict[str, Any]:
    """Return the figures of the sheet."""
    sheet = solution.sheet
    tree: dict[str, Any] = {
        key.partition(".")[2]: figure.value(solution) for key, figure in SHEET_FIGURES.items()
    }
    tree["zones_lower"] = [_zone(zone) for zone in sheet.zones_lower]
    tree["bending_length"] = _number(sheet.bending_length)
    tree["bends"] = bool(sheet.bends)
    grip = sheet.grip
    tree["grip"] = {
        "pull": _number(grip.pull),
        "largest": _number(grip.largest),
        "smallest": _number(grip.smallest),
        "first": grip.first,
        "use_upper": _number(grip.use_upper),
        "use_lower": _number(grip.use_lower),
    }
    tree["error"] = {
        key.partition(".")[2]: figure.error(solution)
        for key, figure in SHEET_FIGURES.items()
        if figure.claimed
    }
    tree["profiles"] = {name: _numbers(getattr(sheet.profiles, name)) for name in SHEET_PROFILES}
    return tree


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


def _totals(solution: Any, width: float) -> dict[str, float | None]:
    """Return the figures of the whole face, in N, N m and W."""
    totals: dict[str, float | None] = {"face_width": width}
    for figure in FIGURES.values():
        if figure.total is not None:
            value = figure.value(solution)
            scale = width * figure.total.factor
            totals[figure.name] = None if value is None else _number(value * scale)
    return totals
