"""Find the ends of the contact: the mesh moves until the pressure vanishes at both.

A contact that is too wide has tension at its ends, one too narrow has pressure there, so that
p = 0 at both ends determines them; all figures then depend smoothly on the mesh, and no end is
known only to within an element.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from finite_elements.carry import by_element, nodal
from finite_elements.case import Nip
from finite_elements.mesh import Array, Grading, Places, ring
from finite_elements.newton import NoConvergenceError, Problem, State
from finite_elements.sheet import SheetProblem

_FINE = 0.004  # elements at the edges below which a solution begins with one on coarser elements


@dataclass(frozen=True)
class Solved:
    """A solution with its mesh."""

    problem: Problem
    state: State
    places: Places
    grading: Grading

    @property
    def mean_pressure(self) -> float:
        return 0.5 * self.problem.nip.load / self.places.half_width

    @property
    def ends(self) -> Array:
        """Pressure at the trailing and the leading end over the mean pressure."""
        at = np.flatnonzero(self.state.closed)
        return self.state.pressure[at[[0, -1]]] / self.mean_pressure


def _quiet(line: str) -> None:
    del line


def half_plane_width(nip: Nip) -> float:
    """Half-width after Hertz for coverings of infinite thickness: more than the true one."""
    curvature = 1.0 / nip.upper.radius + 1.0 / nip.lower.radius
    softness = sum(
        (1.0 - layer.poisson**2) / layer.modulus
        for roller in (nip.upper, nip.lower)
        for layer in roller.layers[-1:]
    )
    return float(np.sqrt(4.0 * nip.load * softness / (np.pi * curvature)))


def meshed(
    nip: Nip,
    places: Places,
    grading: Grading,
    like: Problem | None = None,
    report: Callable[[str], None] = _quiet,
) -> Problem:
    """Mesh both coverings for a contact."""
    lower = None
    if nip.lower.layers:
        # the same places in space; the arcs of the two rollers differ by strains only
        lower = ring(nip.lower, places, grading, like.lower if like else None)
    upper = ring(nip.upper, places, grading, like.upper if like else None)
    kind = SheetProblem if nip.sheet else Problem
    return kind(nip, upper, lower, 1.5 * half_plane_width(nip) + places.half_width, report)


def first_guess(nip: Nip, report: Callable[[str], None] = _quiet) -> Places:
    """Return the contact without friction on a coarse mesh."""
    nip = replace(nip, friction=0.0, traction=0.0, sheet=None)
    half = 0.8 * half_plane_width(nip)
    grading = Grading(edge=0.05, inside=0.1, surface=0.05, growth=0.3, growth_depth=0.6)
    for _ in range(2):
        problem = meshed(nip, Places(-half, half), grading, report=report)
        state = problem.solve(problem.start(-0.8 * half, 0.8 * half), free=True, tolerance=1e-5)
        at = problem.interface.ends[np.flatnonzero(state.closed)[[0, -1]]]
        half = 0.5 * (at[1] - at[0])
    return Places(-half, half)


def carried(start: Solved, problem: Problem) -> State:
    """Return a solution interpolated to another mesh of the same contact."""
    old, was = start.problem, start.state
    at, to = old.interface.ends, problem.interface.ends
    new = problem.start(start.places.trailing, start.places.leading)

    def moved(values: Array) -> Array:
        return np.array([np.interp(to, at, row) for row in np.atleast_2d(values)])

    nearest = np.clip(np.searchsorted(at, to, side="right") - 1, 0, at.size - 1)
    shape = new.shear.shape
    lower = old.lower is not None and problem.lower is not None
    return replace(
        new,
        upper=nodal(old.upper, was.upper, problem.upper),
        pi_upper=by_element(old.upper, was.pi_upper, problem.upper),
        lower=nodal(old.lower, was.lower, problem.lower) if lower else new.lower,
        pi_lower=by_element(old.lower, was.pi_lower, problem.lower) if lower else new.pi_lower,
        pressure=np.where(new.closed, moved(was.pressure)[0], 0.0),
        shear=np.where(new.closed, moved(was.shear).reshape(shape), 0.0),
        slip=np.where(new.closed, was.slip[..., nearest], 0),
        tension=moved(was.tension)[0] if was.tension.size else was.tension,
        approach=was.approach,
        creepage=was.creepage,
    )


def solve(
    nip: Nip,
    grading: Grading,
    start: Places | Solved | None = None,
    report: Callable[[str], None] = _quiet,
    tolerance: float = 2e-3,
    most: int = 25,
) -> Solved:
    """Solve a nip; start from a contact, or from the solution of one like it on such a mesh."""
    rough = grading.refined(0.5)
    if start is None and grading.edge < _FINE:
        start = solve(nip, rough, None, report, 0.03)
    elif start is None:
        start = solve(nip, rough, first_guess(nip, report), report, 0.03).places
    if isinstance(start, Solved) and start.grading != grading:
        places, like = start.places, None
        state = carried(start, meshed(nip, places, grading, None, report))
    elif isinstance(start, Solved):
        places, like, state = start.places, start.problem, start.state
    else:
        places, like, state = start, None, None
    before: tuple[Array, Array, Array] | None = None
    for _ in range(most):
        problem = meshed(nip, places, grading, like, report)
        like = problem
        state = problem.solve(state or problem.start(places.trailing, places.leading))
        found = Solved(problem, state, places, grading)
        at, end = np.array([-places.trailing, places.leading]), found.ends
        report(f"    ends {-at[0]:.6f} {at[1]:.6f} pressure there {end[0]:+.4f} {end[1]:+.4f}")
        if np.max(np.abs(end)) < tolerance:
            return found
        slopes = _slopes(found) if before is None else _secants(before, at, end)
        before = (at, end, slopes)
        at = at + np.clip(-end / slopes, -0.1 * places.half_width, 0.1 * places.half_width)
        places = replace(places, trailing=-at[0], leading=at[1])
    raise NoConvergenceError("the ends of the contact were not found")


def _slopes(found: Solved) -> Array:
    """Estimate how the pressure at the ends falls as they move outwards: as on half-planes.

    Beside an end too far by e, elements of length h there, p = k (sqrt(d) - e/(2 sqrt(d))) at a
    distance d of about h, with k from the pressure a few elements further in.
    """
    at = np.flatnonzero(found.state.closed)
    ends, pressure = found.problem.interface.ends, found.state.pressure
    out = []
    for end, inner, outer in ((at[0], at[4], at[0] - 1), (at[-1], at[-5], at[-1] + 1)):
        factor = pressure[inner] / np.sqrt(abs(ends[inner] - ends[end])) / found.mean_pressure
        out.append(-1.5 * abs(factor) / np.sqrt(abs(ends[end] - ends[outer])))
    return np.array(out)


def _secants(before: tuple[Array, Array, Array], at: Array, end: Array) -> Array:
    """Return the slopes between two contacts, changed by no more than a factor of 4 at a time."""
    old_at, old_end, old = before
    moved = at - old_at
    small = np.abs(moved) < 1e-9 * np.abs(at)
    secant = np.where(small, old, (end - old_end) / np.where(small, 1.0, moved))
    return np.clip(secant, 4.0 * old, 0.25 * old)
