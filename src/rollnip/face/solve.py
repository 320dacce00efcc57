"""The face of a nip in balance: cross-sections that carry load, rollers that bend under it.

    delta(y) = delta_0 + b y - v_u(y) - v_l(y) + c_u(y) + c_l(y) - (y theta)^2/(2 (R_u + R_l))
    w(y) = F(delta, xi),  t(y) = T(delta, xi),  xi(y) = xi_0 + c_u/R_u - c_l/R_l

delta_0 and the tilt b follow from the load and from its moment (or are given), xi_0 from the mean
traction (or is given). Newton's method on delta(y), delta_0, b and xi_0 together.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import ConvergenceError, InvalidInputError
from rollnip.face.beam import Beam, FaceGrid
from rollnip.face.law import NipLaw, Section
from rollnip.nip import Approach, Creepage, LineLoad, Nip, Traction
from rollnip.rollers import Roller
from rollnip.shafts import Face

Array = NDArray[np.float64]

_GRAVITY = 9.80665e-9  # N per (kg/m3) mm3
_MOST_STEPS = 60
_SETTLED = 1e-10  # largest change of an approach over the mean one
_SMALLEST_STEP = 1e-6


@dataclass(frozen=True, slots=True)
class FaceProblem:
    """Everything of a face but the law of its cross-sections.

    Attributes
    ----------
    nip, face : the problem.
    grid : places along the face.
    upper, lower : (n, n) deflection of each axis by the line load [mm2/N].
    weights : (2,) weight per length of each roller towards the lower one [N/mm].
    still : (n,) what delta has without load: crowns and skew, less what weight bends [mm].
    local : (n,) creepage that the local radii add.
    """

    nip: Nip
    face: Face
    grid: FaceGrid
    upper: Array
    lower: Array
    weights: tuple[float, float]
    still: Array
    local: Array

    @property
    def end_loads(self) -> tuple[float, float] | None:
        """Total load of the nip and its moment about the middle [N, N mm]; None if not given."""
        face, nip = self.face, self.nip
        own = self.weights[0] * face.length
        if face.end_loads is not None:
            first, second = face.end_loads
            assert nip.upper.shaft is not None
            reach = 0.5 * nip.upper.shaft.bearing_distance
            return first + second + own, (second - first) * reach
        if isinstance(nip.normal, LineLoad):
            return nip.normal.load * face.length, 0.0
        return None


def face_problem(nip: Nip, face: Face, count: int) -> FaceProblem:
    """Return beams, crowns and skew of a face on ``count`` places.

    Raises
    ------
    InvalidInputError
        where a shaft does not fit its roller, a crown is larger than the covering can take, or
        end loads are given without a shaft of the upper roller.
    """
    if face.end_loads is not None and nip.upper.shaft is None:
        raise InvalidInputError("`end_loads` need `upper.shaft`, for its distance of bearings.")
    grid = FaceGrid.of(face.length, count)
    upper, lower = (_flexibility(roller, face, grid) for roller in (nip.upper, nip.lower))
    down = cos(face.nip_angle)
    weights = (_weight(nip.upper) * down, _weight(nip.lower) * down)
    crowns = [_crown(roller, grid) for roller in (nip.upper, nip.lower)]
    for roller, crown in zip((nip.upper, nip.lower), crowns, strict=True):
        _require_covered(roller, crown)
    skew = (grid.y * face.skew) ** 2 / (2.0 * (nip.upper.radius + nip.lower.radius))
    ones = np.ones(grid.y.size)
    # Weight bends the upper roller towards the lower one, and the lower one away from it.
    bent = -upper @ (weights[0] * ones) + lower @ (weights[1] * ones)
    return FaceProblem(
        nip,
        face,
        grid,
        upper,
        lower,
        weights,
        crowns[0] + crowns[1] - skew - bent,
        crowns[0] * nip.upper.curvature - crowns[1] * nip.lower.curvature,
    )


def _flexibility(roller: Roller, face: Face, grid: FaceGrid) -> Array:
    if roller.shaft is None:
        return np.zeros((grid.y.size, grid.y.size))
    return Beam.of(roller, roller.shaft, face.length).flexibility(grid)


def _weight(roller: Roller) -> float:
    """Return the weight of a core per length [N/mm]; 0 where it has no density."""
    if roller.shaft is None or roller.shaft.density is None:
        return 0.0
    core = 2.0 * (roller.radius - roller.coating_thickness)
    area = np.pi / 4.0 * (core**2 - roller.shaft.bore**2)
    return float(_GRAVITY * roller.shaft.density * area)


def _crown(roller: Roller, grid: FaceGrid) -> Array:
    if roller.shaft is None:
        return np.zeros(grid.y.size)
    return roller.shaft.radial_crown(grid.y, grid.length)


def _require_covered(roller: Roller, crown: Array) -> None:
    size = float(np.ptp(crown))
    if roller.layers and size >= roller.coating_thickness:
        raise InvalidInputError(
            f"`crown` must be smaller than the covering, {roller.coating_thickness:g} mm thick, "
            f"got {2.0 * size:g} mm on the diameter."
        )


@dataclass(frozen=True, slots=True)
class Balance:
    """A face in balance.

    Attributes
    ----------
    approach : (n,) of the surfaces [mm]; negative where the nip is open.
    section : loads and tractions of the cross-sections.
    middle, tilt : delta_0 [mm] and b.
    creepage : xi_0.
    steps : of Newton's method.
    """

    approach: Array
    section: Section
    middle: float
    tilt: float
    creepage: float
    steps: int


def balance(problem: FaceProblem, law: NipLaw) -> Balance:
    """Return the face in balance.

    Raises
    ------
    ConvergenceError
        where Newton's method does not settle.
    """
    unknowns = _start(problem, law)
    wrong, slopes, section = _residual(problem, law, unknowns)
    size = _size(wrong)
    for step in range(1, _MOST_STEPS + 1):
        change = np.linalg.solve(slopes, -wrong)
        share = 1.0
        while True:
            tried = unknowns + share * change
            wrong, slopes, section = _residual(problem, law, tried)
            if _size(wrong) < size or share < _SMALLEST_STEP:
                break
            share *= 0.5
        unknowns, size = tried, _size(wrong)
        scale = max(float(np.mean(np.abs(unknowns[:-3]))), 1e-12)
        if float(np.max(np.abs(share * change[:-3]))) < _SETTLED * scale:
            middle, tilt, creepage = (float(v) for v in unknowns[-3:])
            return Balance(unknowns[:-3], section, middle, tilt, creepage, step)
    raise ConvergenceError(
        "The balance of the face did not settle; try a smaller crown or skew, or a larger load."
    )


def _size(wrong: Array) -> float:
    return float(np.sqrt(np.mean(wrong**2)))


def _start(problem: FaceProblem, law: NipLaw) -> Array:
    """Return approaches under an even load, and the creepage of free rolling there."""
    n = problem.grid.y.size
    given = problem.end_loads
    nip = problem.nip
    if given is not None:
        load = given[0] / problem.face.length
    else:
        load = float(np.sqrt(law.loads[0] * law.loads[-1]))
    share = 0.0
    if isinstance(nip.tangential, Traction) and nip.friction > 0.0:
        share = float(np.clip(nip.tangential.traction / (nip.friction * load), -0.99, 0.99))
    approach = law.approach_at(load, share)
    creepage = 0.0 if nip.friction == 0.0 else law.creepage_at(load, share)
    if isinstance(nip.normal, Approach) and problem.face.end_loads is None:
        approach = nip.normal.approach
    middle = approach
    if given is not None:
        # As if the load were even: what crown and bending take off is added in the mean.
        away = (problem.upper + problem.lower) @ np.full(n, load)
        middle += float(problem.grid.weights @ (away - problem.still)) / problem.face.length
    return np.concatenate([np.full(n, approach), [middle, 0.0, creepage]])


def _residual(problem: FaceProblem, law: NipLaw, unknowns: Array) -> tuple[Array, Array, Section]:
    """Return what is left of the equations, their derivatives, and the cross-sections."""
    nip, grid, y = problem.nip, problem.grid, problem.grid.y
    n = y.size
    delta, (middle, tilt, creepage) = unknowns[:n], unknowns[n:]
    section = law.at(delta, creepage + problem.local)
    bends = problem.upper + problem.lower
    wrong, slopes = np.zeros(n + 3), np.zeros((n + 3, n + 3))
    wrong[:n] = delta + bends @ section.load - problem.still - middle - tilt * y
    slopes[:n, :n] = np.eye(n) + bends * section.load_slope[None, :]
    slopes[:n, n], slopes[:n, n + 1] = -1.0, -y
    slopes[:n, n + 2] = bends @ section.load_by_creepage
    scale = law.approach_at(float(np.sqrt(law.loads[0] * law.loads[-1])), 0.0)
    given = problem.end_loads
    if given is None:
        assert isinstance(nip.normal, Approach)
        wrong[n], slopes[n, n] = middle - nip.normal.approach, 1.0
        wrong[n + 1], slopes[n + 1, n + 1] = tilt * problem.face.length, problem.face.length
    else:
        total, moment = given
        unit = scale / abs(total)
        arm = unit / (0.5 * problem.face.length)
        for row, weight, goal, factor in (
            (n, grid.weights, total, unit),
            (n + 1, grid.weights * y, moment, arm),
        ):
            wrong[row] = factor * (weight @ section.load - goal)
            slopes[row, :n] = factor * weight * section.load_slope
            slopes[row, n + 2] = factor * (weight @ section.load_by_creepage)
    _drive(problem, section, creepage, scale, wrong, slopes)
    return wrong, slopes, section


def _drive(
    problem: FaceProblem,
    section: Section,
    creepage: float,
    scale: float,
    wrong: Array,
    slopes: Array,
) -> None:
    """Write the equation of the mean traction, or of the creepage, into the last row."""
    nip, weights = problem.nip, problem.grid.weights
    n = weights.size
    if nip.friction == 0.0:
        wrong[n + 2], slopes[n + 2, n + 2] = scale * creepage, scale
    elif isinstance(nip.tangential, Creepage):
        wrong[n + 2] = scale * (creepage - nip.tangential.creepage)
        slopes[n + 2, n + 2] = scale
    elif isinstance(nip.tangential, Traction):
        carried = nip.friction * float(weights @ section.load)
        unit = scale / max(carried, 1e-300)
        goal = nip.tangential.traction * problem.face.length
        wrong[n + 2] = unit * (float(weights @ section.traction) - goal)
        slopes[n + 2, :n] = unit * weights * section.traction_slope
        slopes[n + 2, n + 2] = unit * float(weights @ section.traction_by_creepage)
    else:
        raise InvalidInputError(
            "`torque_lower` cannot be prescribed for a face; give `traction` or `creepage`."
        )
