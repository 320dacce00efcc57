"""What faces and heat add to the result of a nip, in one tree."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rollnip._results.case import problem_hash

if TYPE_CHECKING:
    from rollnip.face import FaceSolution
    from rollnip.heat import HeatSolution


def case_parts(along: FaceSolution | None, warm: HeatSolution | None) -> dict[str, Any]:
    """Return the keys that a face and a heat balance add to a result or change.

    Parameters
    ----------
    along : the nip along its face; None where the case has none.
    warm : the nip in thermal balance; None where the case has no table ``heat``.

    Returns
    -------
    dict with "face" and "heat" where they are there, "case" and "case_hash"; {} without both.
    """
    if along is None and warm is None:
        return {}
    from rollnip.face.report import face_parts
    from rollnip.heat.report import heat_parts
    from rollnip.rollers import SIDES

    if warm is None:
        return {} if along is None else face_parts(along)
    heated = heat_parts(warm)
    if along is None:
        return heated
    parts = face_parts(along)
    case = parts["case"] | {"heat": heated["case"]["heat"]}
    for side in SIDES:
        case[side] = case[side] | {"heat": heated["case"][side]["heat"]}
    digits = problem_hash(warm.nip, warm.model, face=along.face, heat=warm.heat)
    return parts | {"case": case, "case_hash": digits, "heat": heated["heat"]}
