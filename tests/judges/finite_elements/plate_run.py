"""Solve a nip with a sheet that resists bending, step by step, and lay out what is found."""

from __future__ import annotations

from dataclasses import asdict, replace

import numpy as np

from finite_elements.case import Nip, Plate
from finite_elements.edges import first_guess
from finite_elements.figures import inputs, short
from finite_elements.mesh import Grading, Places
from finite_elements.plate_edges import SolvedPlate, solve_plate
from finite_elements.plate_figures import (
    PlateFigures,
    edges_of,
    middle_places,
    plate_figures,
    tension,
)

_COARSE = Grading(edge=0.02, inside=0.2, surface=0.06, growth=0.25)
_FIRST = 0.95, 0.82  # both contacts over that of the bare nip, less: a wide one is pulled open
_STEPS = 2  # in which tensions and traction are put on
_BETWEEN = 2.0  # between sizes of elements on the way to a fine mesh
COUNT = 21  # places of a profile


def plate_grading(edge: float) -> Grading:
    """Return a grading whose elements are all as fine as those at the ends of the contacts."""
    return Grading(edge=edge, inside=10.0 * edge, surface=3.0 * edge, growth=min(0.25, 20.0 * edge))


def coarse(nip: Nip, plate: Plate) -> SolvedPlate:
    """Solve on coarse elements: without friction, with it, then with more and more pull."""
    half = first_guess(nip).leading
    places = tuple(Places(-share * half, share * half) for share in _FIRST)
    free = replace(plate, friction=(0.0, 0.0), tension_in=0.0, tension_out=0.0)
    found = solve_plate(replace(nip, traction=0.0), free, _COARSE, (places[0], places[1]))
    rests = max(abs(nip.traction), plate.tension_in, plate.tension_out) == 0.0
    for share in (1.0,) if rests else np.linspace(0.0, 1.0, _STEPS + 1):
        inlet, outlet = share * plate.tension_in, share * plate.tension_out
        pulled_nip = replace(nip, traction=share * nip.traction)
        pulled = replace(plate, tension_in=inlet, tension_out=outlet)
        found = solve_plate(pulled_nip, pulled, _COARSE, found, tolerance=0.02)
    return found


def refined(found: SolvedPlate, edge: float) -> SolvedPlate:
    """Return the solution on elements of a size, by way of coarser ones."""
    while found.grading.edge / edge > _BETWEEN:
        grading = plate_grading(found.grading.edge / _BETWEEN)
        found = solve_plate(found.problem.nip, found.problem.plate, grading, found, tolerance=0.02)
    return solve_plate(found.problem.nip, found.problem.plate, plate_grading(edge), found)


def plate_profile(solved: SolvedPlate) -> dict[str, list[float]]:
    """Pressures, shears on the upper roller and below the sheet, tension and height over the nip.

    Values of neighbouring ends are taken together: alone they alternate on a rigid roller.
    """
    problem, state = solved.problem, solved.state
    ends = [edges_of(problem, state, number) for number in (0, 1)]
    low, high = (f(ends[0][0][k], ends[1][0][k]) for f, k in ((min, 0), (max, -1)))
    where = 0.5 * (low + high) + 0.49 * (high - low) * np.linspace(-1.0, 1.0, COUNT)
    columns = {"x": where}
    for name, (x, pressure, shear) in zip(("upper", "lower"), ends, strict=True):
        for kind, values in (("pressure", pressure), ("shear", shear)):
            smooth = values.copy()
            smooth[1:-1] = 0.25 * values[:-2] + 0.5 * values[1:-1] + 0.25 * values[2:]
            columns[f"{kind}_{name}"] = np.interp(where, x, smooth, left=0.0, right=0.0)
    at, pull = tension(problem, state)
    x, height = middle_places(problem, state)
    columns["tension"] = np.interp(where, np.interp(at, problem.sheet.arc, x), pull)
    columns["height"] = np.interp(where, x, height)
    return {name: [float(f"{v:.6g}") for v in values] for name, values in columns.items()}


def plate_entry(
    name: str, nip: Nip, limit: PlateFigures, error: PlateFigures, shown: SolvedPlate
) -> dict[str, object]:
    """Return one result in the layout of tests/data/plate_finite_elements.json."""
    places = ("trailing", "leading", "trailing_lower", "leading_lower")
    names = [key for key in asdict(limit) if key not in places]

    def contacts(of: PlateFigures, digits: str) -> dict[str, list[float]]:
        values = [float(f"{getattr(of, key):{digits}}") for key in places]
        return {"contact_x": values[:2], "contact_x_lower": values[2:]}

    return {
        **inputs(name, nip),
        "plate": asdict(shown.problem.plate),
        "traction": nip.traction,
        **{key: short(getattr(limit, key)) for key in names},
        **contacts(limit, ".7g"),
        "uncertainty": {key: float(f"{getattr(error, key):.1e}") for key in names}
        | contacts(error, ".1e"),
        "profile": plate_profile(shown),
    }


def run_plate(
    name: str, nip: Nip, plate: Plate, edge: float, factor: float
) -> tuple[dict[str, object], SolvedPlate]:
    """Solve on elements of two sizes; return the entry and the solution on the finer."""
    first = refined(coarse(nip, plate), edge)
    second = refined(first, edge / factor)
    limit, off = plate_figures(first).extrapolated(plate_figures(second), factor)
    return plate_entry(name, nip, limit, off, second), second
