"""Files of a nip in thermal balance: JSON and netCDF."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from rollnip._errors import require_instance
from rollnip.io.result import result_text, write_result

if TYPE_CHECKING:
    from rollnip.heat import Branch, HeatSolution, WarmUp


def heat_text(
    solution: HeatSolution, course: WarmUp | None = None, branch: Branch | None = None
) -> str:
    """Return the result of the warm nip as JSON, with "heat", "warm_up" and "branch"."""
    return result_text(solution.warm, _parts(solution, course, branch))


def write_heat(
    solution: HeatSolution,
    path: str | Path,
    course: WarmUp | None = None,
    branch: Branch | None = None,
) -> None:
    """Write a nip in thermal balance to a file, all or nothing.

    Parameters
    ----------
    solution : what `solve_heat` returned.
    path : ends in .json, or in .nc (netCDF): the root holds the warm nip, the groups ``upper``
        and ``lower`` the temperatures over the radius, ``warm_up`` and ``branch`` the rest.
    course, branch : what `warm_up` and `follow_heat` returned; None: without.

    Raises
    ------
    RollnipError
        where the ending is another, the extra is missing, or the file cannot be written; a file
        of that name stays as it was.
    """
    from rollnip.heat import HeatSolution  # loading it takes time that a schema does not need

    require_instance("solution", solution, HeatSolution, "; give what `solve_heat` returned")
    write_result(solution.warm, path, _parts(solution, course, branch))


def _parts(solution: HeatSolution, course: WarmUp | None, branch: Branch | None) -> dict[str, Any]:
    from rollnip.heat.report import branch_dict, heat_parts, warm_up_dict

    parts = {"title": solution.nip.title} | heat_parts(solution)
    if course is not None:
        parts["warm_up"] = warm_up_dict(course)
    if branch is not None:
        parts["branch"] = branch_dict(branch)
    return parts
