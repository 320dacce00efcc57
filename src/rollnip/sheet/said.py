"""What a status says of the errors of a nip with a sheet."""

from __future__ import annotations

from dataclasses import replace
from math import isfinite
from typing import TypeVar

from rollnip.sheet.common import not_prescribed
from rollnip.sheet.figures import NAMES, scales
from rollnip.sheet.solution import SheetSolution
from rollnip.verdict import WORDS, left_open

Solved = TypeVar("Solved", bound=SheetSolution)


def with_errors_said(solution: Solved) -> Solved:
    """Return a solution whose status names each error beyond the tolerance, if it is valid.

    Figures of which the model leaves more than the tolerance open may have as much from the mesh.
    """
    if not solution.converged:
        return solution
    tolerance = solution.model.tolerance
    left = left_open(relative_errors(solution), tolerance, "the model and the mesh leave")
    return replace(solution, status=f"{solution.status} {tolerance:g}{left}.")


def relative_errors(solution: SheetSolution) -> dict[str, float]:
    """Return the claimed errors of all figures that the tolerance is for, over their sizes.

    Their names are words for the figures; that of the creepages, of the rollers and of either one
    against the sheet, is the largest. On the lower roller a sheet that bends has a width and a
    highest pressure of its own.
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
