"""Find the ends of the contact: the mesh moves until the pressure vanishes at both.

A contact that is too wide has tension at its ends, one too narrow has pressure there, so that
p = 0 at both ends determines them; all figures then depend smoothly on the mesh, and no end is
known only to within an element.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from finite_elements.case import Nip
from finite_elements.mesh import Array, Grading, Places, ring
from finite_elements.newton import NoConvergenceError, Problem, State


@dataclass(frozen=True)
class Solved:
    """A solution with its mesh."""

    problem: Problem
    state: State
    places: Places

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
    return Problem(nip, upper, lower, 1.5 * half_plane_width(nip) + places.half_width, report)


def first_guess(nip: Nip, report: Callable[[str], None] = _quiet) -> Places:
    """Return the contact without friction on a coarse mesh."""
    nip = replace(nip, friction=0.0, traction=0.0)
    half = 0.8 * half_plane_width(nip)
    grading = Grading(edge=0.05, inside=0.1, surface=0.05, growth=0.3, growth_depth=0.6)
    for _ in range(2):
        problem = meshed(nip, Places(-half, half), grading, report=report)
        state = problem.solve(problem.start(-0.8 * half, 0.8 * half), free=True, tolerance=1e-5)
        at = problem.interface.ends[np.flatnonzero(state.closed)[[0, -1]]]
        half = 0.5 * (at[1] - at[0])
    return Places(-half, half)


def solve(
    nip: Nip,
    grading: Grading,
    start: Places | Solved | None = None,
    report: Callable[[str], None] = _quiet,
    tolerance: float = 2e-3,
    most: int = 25,
) -> Solved:
    """Solve a nip; start from a contact, or from the solution of one like it on such a mesh."""
    if start is None:
        rough = grading.refined(0.5)
        start = solve(nip, rough, first_guess(nip, report), report, 0.03).places
    if isinstance(start, Solved):
        places, like, state = start.places, start.problem, start.state
    else:
        places, like, state = start, None, None
    before: tuple[Array, Array, Array] | None = None
    for _ in range(most):
        problem = meshed(nip, places, grading, like, report)
        like = problem
        state = problem.solve(state or problem.start(places.trailing, places.leading))
        found = Solved(problem, state, places)
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
