"""Sizes of mesh for a plate, finer and finer, until the estimated errors are small enough."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf

import numpy as np
from numpy.typing import NDArray

from rollnip.model import FINITE, Geometry, Model
from rollnip.nip import Nip
from rollnip.rollers import SIDES
from rollnip.rolling import PairKernels
from rollnip.rolling.assemble import moment
from rollnip.rolling.claimed_errors import SHARE_OF_EDGE_PEAK
from rollnip.rolling.power_balance import rates_of, slip_losses
from rollnip.sheet.bending import bending_length
from rollnip.sheet.figures import NAMES, SheetFigures, ratio
from rollnip.sheet.lagged import sheet_rate
from rollnip.sheet.plate.attempt import PlateAttempt, overlap, violation
from rollnip.sheet.plate.curved import direction_of
from rollnip.sheet.plate.lagged import displacements_of, lost_inside, pull_of
from rollnip.sheet.plate.search import PlateSearch
from rollnip.sheet.plate.sides import SIGNS, highest
from rollnip.sheet.plate.system import PlateProblem, PlateState
from rollnip.sheet.plate.zones import PlateZones
from rollnip.sheet.powers import SheetPowers, slip_zones
from rollnip.sheet.refine import (
    FEWEST,
    FEWEST_WITH_SLIP,
    FIRST_COUNT,
    LAST_CLOSELY,
    claimed_of_powers,
    estimated_errors,
    next_count,
)

Array = NDArray[np.float64]

_MOST_COUNT = 340
_FIRST_PER_LENGTH = 1.6  # elements of the first size over the bending lengths in the width
_MOST_FIRST = 60.0  # of the first size
_FIRST_CLOSELY = 0.3  # of the tolerance: allowed error of ends on the first size
_MOST_FAILED = 3  # sizes of mesh in a row on which zones do not settle


@dataclass(frozen=True, slots=True)
class PlateRefined:
    """The last solution, its figures and their estimated errors.

    Attributes
    ----------
    attempt : the solution on the finest meshes.
    figures, errors : see `SheetFigures`; nip width and pressure are those of the upper interface;
        errors inf where unknown.
    residual : how badly it violates the conditions.
    lower, lower_errors : the same with nip width and pressure of the lower interface.
    count : about how many elements the meshes were to have.
    cut : how far the conditions are violated by what "finite" leaves out of its correction.
    cut_losses : how much that changes the friction loss of either side [N/mm].
    """

    attempt: PlateAttempt
    figures: SheetFigures
    errors: SheetFigures
    residual: float
    lower: SheetFigures
    lower_errors: SheetFigures
    count: int
    cut: float = 0.0
    cut_losses: tuple[float, float] = (0.0, 0.0)

    def ratio(self, nip: Nip, model: Model) -> float:
        """Return the largest relative error of the figures that the tolerance is for.

        That of a peak over its own tolerance, see `peak_allowed`, times that of the others.
        """
        parts, at = [], NAMES.index("peak_pressure")
        sides = (self.figures, self.errors), (self.lower, self.lower_errors)
        for side, (figures, errors) in enumerate(sides):
            values = errors.values.copy()
            values[at] *= model.tolerance / peak_allowed(nip, model, side)
            parts.append(ratio(nip, figures, SheetFigures(values)))
        return max(parts)


def peak_allowed(nip: Nip, model: Model, side: int) -> float:
    """Return the relative error that is allowed of the highest pressure on one side.

    On a bare roller finite strain leaves more of the peak open than the tolerance asks for.
    """
    is_rigid = (nip.upper, nip.lower)[side].is_rigid
    left = SHARE_OF_EDGE_PEAK["finite"] if is_rigid and model.geometry in FINITE else 0.0
    return max(model.tolerance, left)


def first_count(nip: Nip, half_width: float) -> float:
    """Return the first size of mesh: its elements are about as long as the bending length."""
    share = bending_length(nip) / (2.0 * half_width)
    return float(np.clip(_FIRST_PER_LENGTH / share, FIRST_COUNT, _MOST_FIRST))


def refine_plate(
    nip: Nip,
    model: Model,
    kernels: PairKernels,
    half_width: float,
    before: PlateAttempt | None = None,
) -> PlateRefined:
    """Solve on ever finer meshes until the estimated errors are below the tolerance.

    Parameters
    ----------
    nip, model, kernels : the problem, how it is computed, and its influence functions.
    half_width : about that of a sheet that bends freely [mm].
    before : a solution to begin with; None: one of the linear geometry.

    Raises
    ------
    numpy.linalg.LinAlgError
        where no solution is found at all.
    """
    search, count = PlateSearch(nip, model, kernels), first_count(nip, half_width)
    history: list[tuple[float, SheetFigures, PlateZones]] = []
    below: list[tuple[float, SheetFigures, PlateZones]] = []
    best: PlateRefined | None = None
    attempt = search.begun(half_width, round(count)) if before is None else before
    failed = 0
    while count <= _MOST_COUNT:
        closely = LAST_CLOSELY if history else _FIRST_CLOSELY
        attempt = search.placed(attempt.zones, round(count), attempt, closely)
        figures = plate_figures(attempt, model.geometry)
        here = (count, figures, attempt.zones)
        lower = of_lower(figures, attempt)
        here_below = (count, lower, attempt.zones)
        meshes = attempt.problem.meshes
        errors = estimated_errors(nip, meshes, [*history, here])
        lower_errors = estimated_errors(nip, meshes, [*below, here_below])
        left = violation(attempt)
        latest = PlateRefined(attempt, figures, errors, left, lower, lower_errors, round(count))
        slips = any(side.states.size > 1 for side in attempt.zones.sides)
        fewest = FEWEST_WITH_SLIP if slips else FEWEST
        if attempt.settled:
            history.append(here)
            below.append(here_below)
            best = latest
            if len(history) >= fewest and max(left, latest.ratio(nip, model)) <= model.tolerance:
                best = _with_overlap(latest, kernels, model.geometry)
                if best.residual <= model.tolerance:
                    return best
            failed = 0
        else:
            best, failed = best or latest, failed + 1
        if failed == _MOST_FAILED:
            break
        left = latest.ratio(nip, model) / model.tolerance if len(history) >= fewest else inf
        count = next_count(count, left, _MOST_COUNT)
    assert best is not None
    return _with_overlap(best, kernels, model.geometry)


def _with_overlap(refined: PlateRefined, kernels: PairKernels, geometry: Geometry) -> PlateRefined:
    """Return a solution with what it overlaps outside the contacts, too."""
    left = max(refined.residual, overlap(refined.attempt, kernels, geometry))
    return with_errors_of_powers(replace(refined, residual=left), geometry)


def with_errors_of_powers(refined: PlateRefined, geometry: Geometry) -> PlateRefined:
    """Return a solution that claims slip along its own shear, and errors of torques."""
    attempt = refined.attempt
    works = _slip_works(attempt, geometry, _pulls_of(attempt, geometry))
    off = (
        _error_of_torques(attempt, refined.figures.powers) if geometry == "finite" else np.zeros(2)
    )
    errors = claimed_of_powers(refined.errors, works, off)
    return replace(refined, errors=errors)


def plate_figures(attempt: PlateAttempt, geometry: Geometry) -> SheetFigures:
    """Return the figures of a solution."""
    problem, state, meshes = attempt.problem, attempt.state, attempt.problem.meshes
    upper = meshes[0]
    peak, place = highest(upper, state.pressure[0])
    x = _turning_places(problem, state)
    tension, strain = problem.tension_at(state, x), problem.strain_at(state, x)
    pulls = [float(mesh.weights @ q) for mesh, q in zip(meshes, state.shear, strict=True)]
    first = [
        state.approach,
        float(upper.weights @ state.pressure[0]) - attempt.lagged.lean,
        state.creepage,
        attempt.zones.width,
        peak,
        *state.creepages,
        *pulls,
        float(tension.max()),
        float(tension.min()),
    ]
    spent = plate_powers(attempt, geometry)
    last = [place, float(strain[np.argmax(np.abs(strain))])]
    return SheetFigures(np.array([*first, *spent.array().tolist(), *last]))


def _turning_places(problem: PlateProblem, state: PlateState) -> Array:
    """Return the finer nodes of both meshes, and where tension turns between them, (m,) [mm].

    Between these nodes its slope q_u - q_l is a straight line.
    """
    x = np.unique(np.concatenate([one.nodes for one in problem.pulls]))
    upper, lower = (
        np.interp(x, one.nodes, one.of(shear).lines[:, 0])
        for one, shear in zip(problem.pulls, state.shear, strict=True)
    )
    slope = upper - lower
    turns = np.flatnonzero(slope[:-1] * slope[1:] < 0.0)
    share = slope[turns] / (slope[turns] - slope[turns + 1])
    return np.unique(np.append(x, x[turns] + share * np.diff(x)[turns]))


def of_lower(figures: SheetFigures, attempt: PlateAttempt) -> SheetFigures:
    """Return figures with width, highest pressure and its place on the lower interface."""
    mesh = attempt.problem.meshes[1]
    peak, place = highest(mesh, attempt.state.pressure[1])
    values = figures.values.copy()
    values[[NAMES.index(name) for name in ("nip_width", "peak_pressure", "peak_pressure_x")]] = (
        attempt.zones.lower.width,
        peak,
        place,
    )
    return SheetFigures(values)


def plate_powers(attempt: PlateAttempt, geometry: Geometry) -> SheetPowers:
    """Return torques over radii and losses of a solution."""
    problem, state, pulls = attempt.problem, attempt.state, _pulls_of(attempt, geometry)
    friction = [lost for lost, _ in _slip_works(attempt, geometry, pulls)]
    return SheetPowers(
        friction_upper=friction[0],
        friction_lower=friction[1],
        lost_upper=lost_inside(problem, geometry, state, 0),
        lost_lower=lost_inside(problem, geometry, state, 1),
        pull_upper=pulls[0][0],
        pull_lower=pulls[1][0],
        into_sheet=_into_sheet(attempt),
    )


def _pulls_of(attempt: PlateAttempt, geometry: Geometry) -> list[tuple[float, float]]:
    """Return int q lambda ds of each roller, with all short waves and without those cut [N/mm]."""
    problem, state, out = attempt.problem, attempt.state, []
    for side, mesh in enumerate(problem.meshes):
        u = displacements_of(problem, state, side)
        smooth = pull_of(problem, geometry, state, side, u)
        held = mesh.kernels.held is not None
        whole = pull_of(problem, geometry, state, side, mesh.uncut(u)) if held else smooth
        out.append((whole, smooth))
    return out


def _error_of_torques(attempt: PlateAttempt, spent: SheetPowers) -> Array:
    """Return by how much torques differ from moments of the tractions, over the radii, (2,) [N/mm].

    See `rollnip.sheet.powers.off_the_moments`.
    """
    nip, off = attempt.problem.nip, np.zeros(2)
    driving = spent.as_bare.driving_upper, spent.as_bare.driving_lower
    for side, mesh in enumerate(attempt.problem.meshes):
        u = mesh.uncut(displacements_of(attempt.problem, attempt.state, side))
        state = attempt.state.side(side)
        off[side] = abs(driving[side] - moment(SIDES[side], nip, "finite", mesh, state, u))
    return off


def _pushed(attempt: PlateAttempt, side: int) -> Array:
    """Return int q ds over the intervals of one interface but the last, (n - 1,) [N/mm]."""
    mesh, one = attempt.problem.meshes[side], attempt.problem.pulls[side]
    return -np.diff(one.of(attempt.state.shear[side]).moments_beyond(mesh.inner)[0, :, 0])


def _slip_works(
    attempt: PlateAttempt, geometry: Geometry, pulls: list[tuple[float, float]]
) -> list[tuple[float, float]]:
    """Return what slip on either interface loses, and its work along its own shear [N/mm].

    See `rollnip.sheet.powers.slip_works`. ``pulls``: see `_pulls_of`.
    """
    rates, out = rates_of(geometry, attempt.state.creepage), []
    for side, (lost, reversed_slip) in enumerate(smooth_works(attempt)):
        whole, smooth = pulls[side]
        lost += SIGNS[side] * rates[side] * (whole - smooth)
        out.append((max(lost, 0.0), reversed_slip + max(-lost, 0.0)))
    return out


def smooth_works(attempt: PlateAttempt) -> list[tuple[float, float]]:
    """Return the same of the creep that the contacts follow [N/mm]."""
    creeps, out = attempt.problem.gaps_and_creeps(attempt.state, attempt.lagged), []
    for side, mesh in enumerate(attempt.problem.meshes):
        rate = creeps[side][1][:-1] / mesh.dx[:-1]
        out.append(
            slip_losses(_pushed(attempt, side) * rate, slip_zones(attempt.state.states[side]))
        )
    return out


def _into_sheet(attempt: PlateAttempt) -> float:
    """Return the power of the shears on the faces of the sheet over V [N/mm].

    Its faces run at V_s (1 + e -+ h y''/2); "linear" keeps the products with the strains, which
    are of second order.
    """
    problem, state = attempt.problem, attempt.state
    rate, taken = sheet_rate(*state.creepages), 0.0
    curved = attempt.lagged.curved
    rotations = problem.rotations(state, curved)
    for side, mesh in enumerate(problem.meshes):
        pushed, sign = _pushed(attempt, side), SIGNS[side]
        strained = problem.strain_over(state, side)[:-1]
        turned = np.diff(direction_of(rotations[side][:-1], curved))
        face = (strained - sign * 0.5 * problem.sheet.thickness * turned) / mesh.dx[:-1]
        taken += sign * float(pushed @ (1.0 + face))
    return rate * taken
