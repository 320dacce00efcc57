"""Patches for the page: solved in three dimensions, with fields thin enough for a picture."""

from __future__ import annotations

from collections.abc import Mapping
from math import ceil
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import CaseFileError
from rollnip.io.patch_case import PatchCase, parse_patch_case
from rollnip.patch import solve_patch
from rollnip.patch.report import fields_of, patch_dict
from rollnip.patch.solution import PatchSolution
from rollnip.rollers import Roller
from rollnip.web.answers import SOURCE, at_keys
from rollnip.web.limits import Limits

Array = NDArray[np.float64]

COARSE = 32
"""Most rectangles along a side of a grid that counts as coarse: answered in the time of a solve."""
_SHOWN = 128  # places along a side of the fields that are sent
_FIELDS = ("pressure", "shear_x", "shear_y", "slip", "gap", "state")
_DIGITS = 5
_TOLERANCE = 0.01  # where the case has none
_KEYS = {
    "grid": "patch.grid",
    "tolerance": "solver.tolerance",
    "load": "nip.load",
    "approach": "nip.approach",
}


def is_coarse(case: Mapping[str, Any]) -> bool:
    """Return whether a case asks for a grid so coarse that it is answered quickly."""
    table = case.get("patch")
    grid = table.get("grid") if isinstance(table, Mapping) else None
    if not isinstance(grid, list) or not grid:
        return False
    return all(isinstance(count, int) and count <= COARSE for count in grid)


def solved_patch(tree: Mapping[str, Any], limits: Limits) -> dict[str, Any]:
    """Return the result of a case with a patch, and its fields.

    The tree is that of `rollnip.patch.report.patch_dict`; of the fields, pressure and shear [MPa],
    slip (its size over the rolling speed), gap [mm], None where a face has ended, and state (0
    apart, 1 stick, 2 slip) at every ``every[0]``-th rectangle along x and every
    ``every[1]``-th along y, rows of y over columns of x. ``grids`` are the numbers of rectangles of
    all grids, coarsest first.

    Raises
    ------
    CaseFileError
        where the case is wrong or beyond the limits; says at which key.
    """
    case = parse_patch_case(tree, source=SOURCE)
    _check(case, limits)
    tolerance = _TOLERANCE if case.tolerance is None else case.tolerance
    with at_keys(_KEYS, "patch"):
        solution = solve_patch(case.patch, tolerance=tolerance, grid=case.grid)
    answer = patch_dict(solution, fields=False)
    answer["grids"] = [list(size) for size in solution.levels]
    return answer | {"fields": _fields(solution)}


def _check(case: PatchCase, limits: Limits) -> None:
    lines = []
    for name, roller in (("upper", case.patch.upper), ("lower", case.patch.lower)):
        lines += _too_many(name, roller, limits)
    if lines:
        raise CaseFileError("\n".join(f"{SOURCE}: {line}" for line in lines))


def _too_many(name: str, roller: Roller, limits: Limits) -> list[str]:
    count = len(roller.layers)
    if count <= limits.layers:
        return []
    return [f"{name}.layers: must be at most {limits.layers} here, got {count}."]


def _fields(solution: PatchSolution) -> dict[str, Any]:
    grid, whole = solution.grid, fields_of(solution)
    whole["slip"] = np.hypot(whole["slip_x"], whole["slip_y"])
    every = [ceil(count / _SHOWN) for count in (grid.nx, grid.ny)]
    columns, rows = (slice(step // 2, None, step) for step in every)
    tree: dict[str, Any] = {
        "every": every,
        "x": rounded(grid.x[columns]),
        "y": rounded(grid.y[rows]),
    }
    for name in _FIELDS:
        values = whole[name][rows, columns]
        tree[name] = values.astype(int).tolist() if name == "state" else rounded(values)
    return tree


def rounded(values: Array) -> Any:
    """Return nested lists of numbers to five digits of the largest, None for an infinite one."""
    is_finite = np.isfinite(values)
    largest = float(np.max(np.abs(values), initial=0.0, where=is_finite))
    digits = 0 if largest == 0.0 else int(_DIGITS - np.floor(np.log10(largest)) - 1)
    rows = np.round(values, digits).astype(object)
    rows[~is_finite] = None
    return rows.tolist()
