"""The part of the status that names errors beyond the tolerance."""

from __future__ import annotations

from dataclasses import replace
from math import isfinite
from typing import TypeVar

from rollnip.sheet.checks import not_prescribed
from rollnip.sheet.figures import NAMES, scales
from rollnip.sheet.solution import SheetSolution
from rollnip.verdict import WORDS, left_open

Solved = TypeVar("Solved", bound=SheetSolution)


def with_errors_in_status(solution: Solved) -> Solved:
    """Return a valid solution with all errors beyond the tolerance named in its status.

    Where the model leaves a figure uncertain by more than the tolerance, the mesh may contribute as
    much.
    """
    if not solution.converged:
        return solution
    tolerance = solution.model.tolerance
    left = left_open(relative_errors(solution), tolerance, "the model and the mesh leave")
    return replace(solution, status=f"{solution.status} {tolerance:g}{left}.")


def relative_errors(solution: SheetSolution) -> dict[str, float]:
    """Return the claimed relative errors of all figures to which the tolerance applies.

    The keys are words for the figures. That for the creepages, of the rollers and of each roller
    against the sheet, is the largest of the three. A plate has a width and a peak pressure of its
    own on the lower roller.
    """
    figures, errors = solution.refined.figures, solution.sheet_errors()
    sizes = dict(zip(NAMES, scales(solution.nip, figures).tolist(), strict=True))
    own = [name for name in not_prescribed(solution.nip) if name != "creepage"]
    out = {WORDS[name]: solution.error[name] / sizes[name] for name in own}
    sides = [errors[name] / sizes[name] for name in ("creepage_upper", "creepage_lower")]
    out["creepages"] = max(solution.error["creepage"] / sizes["creepage"], *sides)
    if solution.bends:
        names = ("nip_width", "peak_pressure")
        for name, size in zip(names, solution.on_lower_side, strict=True):
            out[f"{WORDS[name]} on the lower roller"] = errors[f"{name}_lower"] / size
    return {name: float(error) for name, error in out.items() if isfinite(error)}
