"""Run the cases of a data file: python -m finite_elements FILE [--only NAME] [--write OUT].

Every case is solved on two meshes, the second finer by a factor of 1.5, and extrapolated to none.
Stored results, where the file has them, are printed beside the new ones.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from finite_elements.case import Nip, Sheet, nip_of, plate_of
from finite_elements.edges import Solved, solve
from finite_elements.figures import checks, entry, figures
from finite_elements.mesh import Grading
from finite_elements.newton import NoConvergenceError
from finite_elements.plate_figures import plate_checks
from finite_elements.plate_run import run_plate
from finite_elements.sheet_figures import sheet_entry, sheet_figures

GRADING = Grading(edge=0.002, inside=0.05, plies=3)
FACTOR = 1.5
COARSE_EDGE = 0.02  # elements at the edges on which a sheet is first pulled
MOST_STEPS = 50
INPUTS = ("case", "upper", "lower", "load", "friction", "traction", "sheet", "plate", "profile")


def with_sheet(nip: Nip, sheet: Sheet, grading: Grading) -> Solved:
    """Pull the sheet step by step on a coarse mesh, then take finer ones, last let it wrap."""
    coarse = replace(grading, edge=COARSE_EDGE, inside=2.0 * grading.inside)
    share, step, found = 0.0, 1.0 / 3.0, None
    while found is None or share < 1.0:
        to = 0.0 if found is None else min(1.0, share + step)
        plain = replace(
            sheet, wraps=False, tension_in=to * sheet.tension_in, tension_out=to * sheet.tension_out
        )
        pulled = replace(nip, traction=to * nip.traction, sheet=plain)
        try:
            found, share = solve(pulled, coarse, found, tolerance=0.02), to
        except NoConvergenceError:
            step *= 0.5
            if found is None or step < MOST_STEPS**-1:
                raise
    for between in np.geomspace(COARSE_EDGE, grading.edge, 5)[1:]:
        found = solve(
            found.problem.nip, replace(grading, edge=float(between)), found, tolerance=0.02
        )
    return solve(nip, grading, found)


@dataclass
class Chain:
    """Solve nips that differ in traction one from the other, on meshes of one grading."""

    grading: Grading
    known: dict[Nip, dict[float, Solved]] = field(default_factory=dict)

    def solve(self, nip: Nip) -> Solved:
        """Go from the nearest traction that is known by steps of at most a tenth of the load."""
        if nip.sheet:
            return with_sheet(nip, nip.sheet, self.grading)
        known = self.known.setdefault(replace(nip, traction=0.0), {})
        if not known:
            free = replace(nip, traction=0.0)
            known[0.0] = solve(free, self.grading)
        nearest = min(known, key=lambda traction: abs(traction - nip.traction))
        steps = int(np.ceil(abs(nip.traction - nearest) / (0.101 * nip.load)))
        for traction in np.linspace(nearest, nip.traction, steps + 1)[1:]:
            step = replace(nip, traction=float(traction))
            known[step.traction] = solve(step, self.grading, known[nearest])
            nearest = step.traction
        return known[nearest]


def run(case: Mapping[str, Any], coarse: Chain, fine: Chain) -> tuple[dict[str, Any], Solved]:
    """Solve one case on both meshes; return its entry and the solution on the finer."""
    nip = nip_of(case)
    first, second = coarse.solve(nip), fine.solve(nip)
    if nip.sheet:
        at_limit, off = sheet_figures(first).extrapolated(sheet_figures(second), FACTOR)
        return sheet_entry(str(case["case"]), nip, at_limit, off, second), second
    limit, error = figures(first).extrapolated(figures(second), FACTOR)
    return entry(str(case["case"]), nip, limit, error, second), second


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file", type=Path)
    parser.add_argument("--only", help="run the cases of this name")
    parser.add_argument("--refine", type=float, default=1.0, help="smaller elements by a factor")
    parser.add_argument("--edge", type=float, help="elements at the edges, over the half-width")
    parser.add_argument("--growth", type=float, help="of elements by the distance from an edge")
    parser.add_argument("--plies", type=int, help="elements through each layer, at least")
    parser.add_argument("--write", type=Path, help="write the results to this file")
    options = parser.parse_args()
    stored = json.loads(options.file.read_text(encoding="utf-8"))
    names = ("edge", "growth", "plies")
    given = {name: getattr(options, name) for name in names if getattr(options, name)}
    grading = replace(GRADING.refined(options.refine), **given)
    coarse, fine = Chain(grading), Chain(grading.refined(FACTOR))
    results = []
    for case in stored["results"]:
        if options.only and case["case"] != options.only:
            continue
        began = time.process_time()
        traction = case.get("traction", 0.0)
        print(f"{case['case']}, mu {case.get('friction', '-')}, T {traction:g}:", end=" ")
        try:
            if "plate" in case:
                found, shown = run_plate(
                    case["case"], nip_of(case), plate_of(case["plate"]), grading.edge, FACTOR
                )
                told = plate_checks(shown)
            else:
                found, second = run(case, coarse, fine)
                told = checks(second)
        except NoConvergenceError as error:
            print(f"not solved, {error}; another --refine may do", flush=True)
            continue
        results.append(found)
        print(f"{time.process_time() - began:.0f} s of processor, {told}")
        for name in [key for key in found if key not in INPUTS]:
            print(f"  {name:15s} {found[name]}   stored: {case.get(name, '-')}", flush=True)
        if options.write:
            text = json.dumps({"note": stored.get("note", ""), "results": results}, indent=1)
            options.write.write_text(text + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
