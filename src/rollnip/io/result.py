"""The result of a solution as files: JSON and netCDF."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rollnip._errors import require_instance
from rollnip._files import check_target, write_whole
from rollnip._json import json_text
from rollnip._results.tree import result_dict
from rollnip.io.netcdf import require_netcdf, result_groups, write_netcdf

if TYPE_CHECKING:
    from rollnip.solution import Solution

__all__ = ["check_result_target", "result_dict", "result_text", "write_result"]

SUFFIXES = (".json", ".nc")


def result_text(solution: Solution, parts: Mapping[str, Any] | None = None) -> str:
    """Return the result as JSON, a line for each key; ``parts`` adds keys such as "face"."""
    tree = {**result_dict(solution), **(parts or {})}
    lines = [f"{json_text(name)}: {json_text(value, indent=None)}" for name, value in tree.items()]
    return "{\n  " + ",\n  ".join(lines) + "\n}\n"


def write_result(
    solution: Solution, path: str | Path, parts: Mapping[str, Any] | None = None
) -> None:
    """Write a solution to a file, all or nothing.

    Parameters
    ----------
    solution :
        what `solve` returned.
    path :
        ends in .json or .nc (netCDF, with the extra ``rollnip[netcdf]``).
    parts :
        keys that the file gets besides, such as "face".

    Raises
    ------
    RollnipError
        where ``solution`` is of another kind, the ending is another, the extra is missing, or the
        file cannot be written; a file of that name stays as it was.
    """
    from rollnip.solution import Solution  # loading it takes time that a schema does not need

    require_instance("solution", solution, Solution, "; give what `solve` returned")
    target = Path(path)
    check_result_target(target)
    if target.suffix.lower() == ".nc":
        tree = {**result_dict(solution), **(parts or {})}
        write_netcdf(result_groups(tree), target)
    else:
        text = result_text(solution, parts)
        write_whole(target, lambda file: file.write_text(text, encoding="utf-8", newline="\n"))


def check_result_target(path: Path) -> None:
    """Raise RollnipError where a result could not be written to ``path``; costs next to nothing."""
    check_target(path, SUFFIXES)
    if path.suffix.lower() == ".nc":
        require_netcdf()
