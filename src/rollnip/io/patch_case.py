"""Case files in three dimensions: a patch from a path or a text."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rollnip._errors import InvalidInputError, RollnipError
from rollnip._results.case import patch_problem_hash
from rollnip.io.build import Builder
from rollnip.io.case import Case, built_case
from rollnip.io.document import folder_of, read_document, tree_of
from rollnip.io.kinds import require_kind
from rollnip.io.messages import checked_form, more_than_one, placed, refuse
from rollnip.io.profile import read_profile
from rollnip.io.tables import CaseTable, NipTable, RollerTable
from rollnip.io.tables_patch import PATCH_TABLES, PatchCaseTable, PatchNipTable, PatchRollerTable
from rollnip.nip import Approach, Creepage
from rollnip.patches import PATCH_TOLERANCE, Across, Force, Patch

_CHOICES = (
    ("load", "approach"),
    ("traction", "creepage"),
    ("lateral_traction", "lateral_creepage"),
)
_PLACES = {
    "force": "nip.traction, nip.lateral_traction",
    "lateral_radius": "upper.lateral_radius, lower.lateral_radius",
    "radius": "upper.radius, lower.radius",
    "material": "upper.layers, lower.layers",
    "upper": "upper",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class PatchCase:
    """A case file in three dimensions as read.

    Attributes
    ----------
    patch :
        the problem.
    tolerance :
        wanted relative accuracy; None where the file has none.
    grid :
        numbers of rectangles along x and y; None where the file has none.
    source :
        the file's name.
    """

    patch: Patch
    tolerance: float | None
    grid: tuple[int, int] | None
    source: str


def read_patch_case(path: str | Path) -> PatchCase:
    """Read a case file in three dimensions, one with a table ``[patch]``.

    Parameters and errors are those of `rollnip.io.read_case`; a case without that table is refused.
    """
    tree = read_document(path, hint="`rollnip.io.parse_patch_case` takes a tree")
    return _built(tree, str(path), folder_of(path))


def parse_patch_case(case: str | Mapping[str, Any], *, source: str = "case") -> PatchCase:
    """Read a case in three dimensions from a text, or from the tree that such a text holds.

    Raises CaseFileError as `read_patch_case` does, and where the case names a file.
    """
    return _built(tree_of(case, source), source, None)


def read_any_case(path: str | Path) -> Case | PatchCase:
    """Read a case file of a nip, or one in three dimensions where it has a table ``[patch]``.

    Raises CaseFileError as `rollnip.io.read_case` and `read_patch_case`.
    """
    return any_case(read_document(path), str(path), folder_of(path))


def any_case(tree: Mapping[str, Any], source: str, folder: Path | None = None) -> Case | PatchCase:
    """Read the case that a tree holds, in three dimensions where it has a table ``patch``.

    Parameters
    ----------
    tree : of a case file.
    source : its name, for messages.
    folder : where profiles are looked for; None: a case that names a file is refused.
    """
    if "patch" in tree:
        return _built(dict(tree), source, folder)
    return built_case(dict(tree), source, folder)


def patch_hash(case: PatchCase) -> str:
    """Return 16 hexadecimal digits of the patch, its tolerance and grid; titles do not count."""
    return patch_problem_hash(case.patch, case.tolerance or PATCH_TOLERANCE, case.grid)


def _built(tree: dict[str, Any], source: str, folder: Path | None) -> PatchCase:
    require_kind(tree, source, "case")
    if "patch" not in tree:
        refuse(source, ["patch: is missing; add a table [patch], it may be empty."])
    table = checked_form(tree, source, PatchCaseTable, PATCH_TABLES)
    errors = _wrong_choices(table.nip)
    builder = Builder(_plane(table), folder)
    rollers = builder.rollers()
    errors += builder.errors
    shapes = [
        _across(path, roller, folder, errors)
        for path, roller in (("upper", table.upper), ("lower", table.lower))
    ]
    grid = table.patch.grid
    if grid is not None and len(grid) != 2:
        errors.append(f"patch.grid: must hold two whole numbers, got {grid}.")
    patch = None
    if not errors and rollers is not None:
        try:
            patch = _patch(table, rollers, shapes)
        except InvalidInputError as error:
            errors.append(placed("nip", str(error), _PLACES))
    if patch is None:
        refuse(source, errors)
    numbers = None if grid is None else (grid[0], grid[1])
    return PatchCase(patch=patch, tolerance=table.solver.tolerance, grid=numbers, source=source)


def _wrong_choices(nip: PatchNipTable) -> list[str]:
    """Lines about keys of which [nip] takes one."""
    given = {name for names in _CHOICES for name in names if getattr(nip, name) is not None}
    lines = more_than_one(_CHOICES, given)
    if not given.intersection(_CHOICES[0]):
        lines.append("nip: must hold load or approach, got neither.")
    return lines


def _plane(table: PatchCaseTable) -> CaseTable:
    """Return the parts of a case that are those of a plane one."""
    upper, lower = (
        RollerTable(radius=one.radius, core=one.core, layers=one.layers, profile=None)
        for one in (table.upper, table.lower)
    )
    return CaseTable(
        nip=NipTable(friction=0.0), upper=upper, lower=lower, materials=table.materials
    )


def _across(path: str, table: PatchRollerTable, folder: Path | None, errors: list[str]) -> Across:
    """Return the shape of a roller along its axis; what is wrong becomes lines in ``errors``."""
    profile = None
    if table.lateral_profile is not None and folder is None:
        errors.append(f"{path}.lateral_profile: names a file, which is read for a case file alone.")
    elif table.lateral_profile is not None and folder is not None:
        try:
            profile = read_profile(folder / table.lateral_profile)
        except RollnipError as error:
            errors.append(f"{path}.lateral_profile: {error}")
    try:
        return Across(
            radius=table.lateral_radius,
            face=table.face,
            end_radius=table.end_radius,
            profile=profile,
        )
    except InvalidInputError as error:
        errors.append(placed(path, str(error)))
        return Across()


def _patch(table: PatchCaseTable, rollers: tuple[Any, Any], shapes: list[Across]) -> Patch:
    nip = table.nip
    normal = Force(nip.load) if nip.load is not None else Approach(nip.approach or 0.0)
    along = Creepage(nip.creepage) if nip.creepage is not None else Force(nip.traction or 0.0)
    across: Creepage | Force = Creepage(nip.lateral_creepage or 0.0)
    if nip.lateral_traction is not None:
        across = Force(nip.lateral_traction)
    return Patch(
        upper=rollers[0],
        lower=rollers[1],
        across_upper=shapes[0],
        across_lower=shapes[1],
        normal=normal,
        along=along,
        across=across,
        spin=nip.spin,
        friction=nip.friction,
        speed=nip.speed,
        title=table.title,
    )
