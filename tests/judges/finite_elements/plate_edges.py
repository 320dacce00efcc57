"""Find the ends of both contacts of a nip with a sheet that resists bending, as `edges.py` does."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from finite_elements.carry import by_element, nodal
from finite_elements.case import Nip, Plate
from finite_elements.mesh import Array, Grading, Places, ring
from finite_elements.newton import NoConvergenceError
from finite_elements.plate import PlateProblem, PlateState
from finite_elements.strip import strip


def carried(start: SolvedPlate, problem: PlateProblem) -> PlateState:
    """Return a solution interpolated to other meshes of the same contacts."""
    old, was = start.problem, start.state
    new = problem.start(start.places)
    before_after = (
        (old.upper, problem.upper), (old.sheet, problem.sheet), (old.lower, problem.lower)
    )  # fmt: skip
    moved, inside, sides = [], [], []
    for number, (before, after) in enumerate(before_after):
        if before is None or after is None:
            moved.append(was.moved[number])
            inside.append(was.inside[number])
        else:
            moved.append(nodal(before, was.moved[number], after))
            inside.append(by_element(before, was.inside[number], after))
    for number, side in enumerate(new.sides):
        last = was.sides[number]
        at = old.contacts[number].interface.ends
        to = problem.contacts[number].interface.ends
        nearest = np.clip(np.searchsorted(at, to, side="right") - 1, 0, at.size - 1)
        sides.append(
            replace(
                side,
                pressure=np.where(side.closed, np.interp(to, at, last.pressure), 0.0),
                shear=np.where(side.closed, np.interp(to, at, last.shear), 0.0),
                slip=np.where(side.closed, last.slip[nearest], 0),
                approach=last.approach,
                creepage=last.creepage,
            )
        )
    return PlateState(tuple(moved), tuple(inside), (sides[0], sides[1]))  # type: ignore[arg-type]


@dataclass(frozen=True)
class SolvedPlate:
    """A solution with its meshes."""

    problem: PlateProblem
    state: PlateState
    places: tuple[Places, Places]
    grading: Grading

    @property
    def ends(self) -> Array:
        """Pressure at the ends of the upper and the lower contact over the mean pressures."""
        out = []
        for side, place in zip(self.state.sides, self.places, strict=True):
            at = np.flatnonzero(side.closed)[[0, -1]]
            out.extend(side.pressure[at] * 2.0 * place.half_width / self.problem.nip.load)
        return np.array(out)


def meshed(
    nip: Nip,
    plate: Plate,
    places: tuple[Places, Places],
    grading: Grading,
    like: PlateProblem | None = None,
    report: Callable[[str], None] = lambda line: None,
) -> PlateProblem:
    """Mesh both coverings and the sheet for given contacts."""
    rigid, lower = not nip.lower.layers, None
    if not rigid:
        lower = ring(nip.lower, places[1], grading, like.lower if like else None)
    upper = ring(nip.upper, places[0], grading, like.upper if like else None)
    sheet = strip(plate, places, grading, rigid, like.sheet if like else None)
    reach = 2.0 * max(place.half_width for place in places)
    return PlateProblem(nip, plate, upper, sheet, lower, reach, report)


def solve_plate(
    nip: Nip,
    plate: Plate,
    grading: Grading,
    start: tuple[Places, Places] | SolvedPlate,
    report: Callable[[str], None] = lambda line: None,
    tolerance: float = 2e-3,
    most: int = 25,
) -> SolvedPlate:
    """Solve a nip: move the meshes until the pressure vanishes at all four ends (Broyden).

    It begins with two contacts, or with the solution of a nip like it.
    """
    like, state, before, slopes = None, None, None, None
    if isinstance(start, SolvedPlate):
        places = start.places
        like, state = start.problem, start.state
        if start.grading != grading:
            state, like = carried(start, meshed(nip, plate, places, grading)), None
    else:
        places = start
    for _ in range(most):
        problem = meshed(nip, plate, places, grading, like, report)
        like = problem
        state = problem.solve(state or problem.start(places))
        found = SolvedPlate(problem, state, places, grading)
        at = np.array([v for p in places for v in (-p.trailing, p.leading)])
        end = found.ends
        report(f"    ends {at} pressure there {end}")
        if np.max(np.abs(end)) < tolerance:
            return found
        if slopes is None or before is None:
            slopes = np.diag(_slopes(found))
        else:
            moved = at - before[0]
            slopes = slopes + np.outer(end - before[1] - slopes @ moved, moved) / (moved @ moved)
        before = at, end
        halves = np.repeat([place.half_width for place in places], 2)
        way = np.linalg.solve(slopes, -end)
        at = at + way * min(1.0, float(np.min(0.1 * halves / np.maximum(np.abs(way), 1e-30))))
        places = Places(-at[0], at[1]), Places(-at[2], at[3])
    raise NoConvergenceError("the ends of the contacts were not found")


def _slopes(found: SolvedPlate) -> Array:
    """Estimate how the pressures at the ends fall as they move outwards, see `edges.py`."""
    out = []
    for contact, side, place in zip(
        found.problem.contacts, found.state.sides, found.places, strict=True
    ):
        at, ends = np.flatnonzero(side.closed), contact.interface.ends
        mean = 0.5 * found.problem.nip.load / place.half_width
        for end, inner, outer in ((at[0], at[4], at[0] - 1), (at[-1], at[-5], at[-1] + 1)):
            factor = side.pressure[inner] / np.sqrt(abs(ends[inner] - ends[end])) / mean
            out.append(-1.5 * abs(factor) / np.sqrt(abs(ends[end] - ends[outer])))
    return np.array(out)
