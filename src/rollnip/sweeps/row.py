"""The row of results of one case; whatever goes wrong with it becomes a message in the row."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from math import isfinite
from typing import Any

from rollnip._errors import ConvergenceError, RollnipError
from rollnip.face import FaceSolution, NipRows, solve_face
from rollnip.face.figures import FACE_FIGURES, SHEET_FACE_FIGURES, figures_of
from rollnip.figure import Figure, axis_label
from rollnip.figures import CLAIMED, FIGURES
from rollnip.heat import HeatSolution, solve_heat
from rollnip.heat.report import HEAT_SCALARS, heat_scalar
from rollnip.influence import KernelCache
from rollnip.io import Case, case_hash
from rollnip.io.patch_case import PatchCase, any_case, patch_hash
from rollnip.patch import PATCH_TOLERANCE, PatchSolution, solve_patch
from rollnip.patch.figures import CLAIMED as PATCH_CLAIMED
from rollnip.patch.figures import PATCH_FIGURES
from rollnip.sheet_figures import SHEET_FIGURES
from rollnip.solution import Solution
from rollnip.solver import solve

Row = dict[str, float | bool | str | None]

SCALARS: Mapping[str, str] = {
    **{key: figure.unit for key, figure in FIGURES.items()},
    **{key: figure.unit for key, figure in SHEET_FIGURES.items()},
    **{f"error.{name}": figure.unit for name, figure in CLAIMED.items()},
    **{f"error.{key}": figure.unit for key, figure in SHEET_FIGURES.items() if figure.claimed},
    "solver.elements": "1",
    "solver.iterations": "1",
    "solver.residual": "1",
    "solver.geometry_change": "1",
    **{f"face.{key}": one.unit for key, one in {**FACE_FIGURES, **SHEET_FACE_FIGURES}.items()},
    **{f"heat.{key}": unit for key, unit in HEAT_SCALARS.items()},
    **{f"patch.{key}": figure.unit for key, figure in PATCH_FIGURES.items()},
    **{f"patch.error.{key}": figure.unit for key, figure in PATCH_CLAIMED.items()},
}
"""Unit of every scalar result; ``error.load`` is the key ``load`` of ``error``.

Those of face, heat and sheet are None for a case without that table; a case with a patch has only
those of ``patch``.
"""

_FIGURES: Mapping[str, Figure] = {
    **FIGURES,
    **SHEET_FIGURES,
    **{f"face.{key}": one for key, one in {**FACE_FIGURES, **SHEET_FACE_FIGURES}.items()},
    **{f"patch.{key}": one for key, one in PATCH_FIGURES.items()},
}

STATUSES = ("solved", "unverified", "refused", "failed", "lost")
"""What became of a case; only the first two have numbers.

"lost" occurs in sweeps alone: the process that worked on the case ended without an answer.
"""

_NAME = "case"


def scalar_label(name: str) -> str:
    """Return the name of one of `SCALARS` as it stands in pictures."""
    figure = _FIGURES.get(name)
    return name.replace("_", " ") if figure is None else figure.label


def scalar_axis(name: str) -> str:
    """Return the axis label of one of `SCALARS` with its unit, as in the heads of tables."""
    return axis_label(scalar_label(name), SCALARS[name])


def evaluate(tree: Mapping[str, Any]) -> Row:
    """Solve one case and return its scalar results; an error becomes a message, never an exception.

    Parameters
    ----------
    tree :
        the tree of a case file, such as `rollnip.io.with_values` returns.

    Returns
    -------
    A flat dict, always with the same keys in the same order:

    - ``status``: "solved" (and verified), "unverified" (there are numbers, but they were not
      verified), "refused" (the case is invalid) or "failed" (no solution was found);
    - ``message``: the reason, in one line; empty where solved;
    - ``converged``: whether the status is "solved";
    - ``geometry``: the geometry model used, which may be simpler than the requested one; None
      without a solution;
    - the names of `SCALARS`: numbers in the units given there, per unit axial length; None where a
      value is not finite, not defined or not solved; those of ``heat`` have values where the case
      has such a table. ``max_surface_strain`` is the largest strain of either surface in the
      contact, averaged over an element;
    - ``warnings``: reservations, separated by blanks.
    """
    return solved(ready(lambda: tree), own_kernels())[0]


@cache
def own_kernels() -> KernelCache:
    """Return this process's cache of kernels, shared between neighbouring cases."""
    return KernelCache()


@cache
def _own_rows() -> NipRows:
    """Return this process's store of plane nips of faces, shared between neighbouring cases."""
    return NipRows(own_kernels())


@dataclass(frozen=True, slots=True)
class Ready:
    """A case that was read and is ready to be solved.

    Attributes
    ----------
    case : the case; None where it is invalid.
    name : its hash; None where it is invalid.
    refusal : the row that says why it is invalid; else None.
    """

    case: Case | PatchCase | None = None
    name: str | None = None
    refusal: Row | None = None


def ready(make: Callable[[], Mapping[str, Any]]) -> Ready:
    """Read the case whose tree ``make`` returns; an exception becomes a message in a row."""
    try:
        case = any_case(make(), _NAME)
        return Ready(case, patch_hash(case) if isinstance(case, PatchCase) else case_hash(case))
    except Exception as error:  # noqa: BLE001 - one bad case must not end a thousand others
        return Ready(refusal=_row_of(error))


def solved(one: Ready, kernels: KernelCache | None = None) -> tuple[Row, Solution | None]:
    """Return the row of a case, as `evaluate` does, and its solution where there is one."""
    if one.case is None:
        assert one.refusal is not None
        return one.refusal, None
    try:
        case = one.case
        if isinstance(case, PatchCase):
            wanted = case.tolerance or PATCH_TOLERANCE
            return patch_row(solve_patch(case.patch, tolerance=wanted, grid=case.grid)), None
        solution = solve(case.nip, case.model, cache=kernels, on_failure="return")
        along = warm = None
        if case.face is not None:
            along = solve_face(case.nip, case.face, case.model, rows=_own_rows())
        if case.heat is not None:
            warm = solve_heat(case.nip, case.heat, case.model, cache=kernels)
        return scalars(solution, along, warm), solution
    except Exception as error:  # noqa: BLE001 - as above
        return _row_of(error), None


def _row_of(error: Exception) -> Row:
    if isinstance(error, ConvergenceError):
        return without_solution("failed", str(error))
    if isinstance(error, RollnipError):
        lines = (line.removeprefix(f"{_NAME}: ") for line in str(error).splitlines())
        return without_solution("refused", " ".join(lines))
    said = " ".join(str(error).split())
    return without_solution("failed", f"Unforeseen {type(error).__name__}: {said}")


def scalars(
    solution: Solution, along: FaceSolution | None = None, warm: HeatSolution | None = None
) -> Row:
    """Return the row of a solution, its face and its heat balance, in the form of `evaluate`."""
    parts = [part for part in (solution, along, warm) if part is not None]
    messages = [part.status for part in parts if not part.converged]
    row: Row = {
        "status": "unverified" if messages else "solved",
        "message": " ".join(messages),
        "converged": not messages,
        "geometry": solution.model.geometry,
    }
    row |= {name: _value(solution, along, warm, name) for name in SCALARS}
    lines = dict.fromkeys(line for part in parts for line in part.warnings)
    return row | {"warnings": " ".join(lines)}


def patch_row(solution: PatchSolution) -> Row:
    """Return the row of a patch, in the form of `evaluate`."""
    row: Row = {
        "status": "solved" if solution.converged else "unverified",
        "message": "" if solution.converged else solution.status,
        "converged": solution.converged,
        "geometry": "linear",
    }
    row |= dict.fromkeys(SCALARS)
    row |= {f"patch.{key}": one.value(solution) for key, one in PATCH_FIGURES.items()}
    row |= {f"patch.error.{key}": one.error(solution) for key, one in PATCH_CLAIMED.items()}
    return row | {"warnings": " ".join(solution.warnings)}


def _value(
    solution: Solution, along: FaceSolution | None, warm: HeatSolution | None, name: str
) -> float | None:
    if name in FIGURES:
        return FIGURES[name].value(solution)
    if name in SHEET_FIGURES:
        return SHEET_FIGURES[name].value(solution)
    table, _, key = name.partition(".")
    if key in SHEET_FIGURES:
        return SHEET_FIGURES[key].error(solution)
    if table == "face":
        figure = None if along is None else figures_of(along).get(key)
        return None if figure is None else figure.value(along)
    if table == "patch":
        return None
    if table == "error":
        return CLAIMED[key].error(solution)
    if table == "heat":
        return None if warm is None else heat_scalar(warm, key)
    return _number(getattr(solution.solver, key))


def _number(value: float | None) -> float | None:
    return float(value) if value is not None and isfinite(value) else None


def without_solution(status: str, message: str) -> Row:
    """Return a row that says what went wrong and holds no numbers."""
    row: Row = {"status": status, "message": message, "converged": False, "geometry": None}
    return row | dict.fromkeys(SCALARS) | {"warnings": ""}
