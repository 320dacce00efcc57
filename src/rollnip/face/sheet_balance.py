"""The equilibrium of a face with a sheet: rollers that bend, and a sheet fed and pulled everywhere.

At every place y the cross-section has a load F and tractions T_u, T_l, and

    delta(F, T_u, T_l) = delta_0 + b y - v_u - v_l + c_u + c_l - (y theta)^2/(2 (R_u + R_l)).

With the local radii R_u + c_u and R_l + c_l, and f the feed of the cross-section,

    ln(V_s/V_u) = ln(1 + f_u) + ln(1 + c_u/R_u),   ln(V_s/V_l) = ln(1 + f_l) + ln(1 + c_l/R_l),

where V_u, V_l are the speeds of both rollers by their nominal radii, and V_s is that of the sheet
free of tension.
- "free": the sheet behaves as if cut into strips. Every strip has the tensions of the sheet's
  table, T_u - T_l = tension_in - tension_out, and a speed of its own; V_u/V_l is one number.
- "one-speed": the sheet is whole, and no part of it can run ahead. V_s is one number, the tension
  at the outlet is even, and that at the inlet is tension_out + T_u - T_l at each place, with the
  mean tension_in.
T_u stands for T_l plus the pull, tension_in - tension_out: the levers of the shears on a curved
path, by which the upper roller gives more or less than that, are left out along a face.
Newton's method solves for ln F, s_u, s_l at all places, delta_0, b and both speeds together.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import log

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import ConvergenceError
from rollnip.face.problem import FaceProblem
from rollnip.face.sheet_law import SheetLaw
from rollnip.nip import Approach, Creepage, Torque, Traction

Array = NDArray[np.float64]

_MOST_STEPS = 80
_SETTLED = 1e-9
_LARGEST = (0.5, 0.1, 0.1)  # largest steps of ln F and of both s
_SPEEDS = 0.01  # typical feed, by which the equations of speeds are scaled


@dataclass(frozen=True, slots=True)
class SheetBalance:
    """The equilibrium of a face with a sheet.

    Attributes
    ----------
    points : (3, n) ln F [N/mm], s_u and s_l at the places.
    middle, tilt : delta_0 [mm] and b.
    feeds : (2, n) V_s/V_u - 1 and V_s/V_l - 1 at the places, by the rollers' nominal radii.
    creepage : of both rollers as wholes.
    """

    points: Array
    middle: float
    tilt: float
    feeds: Array
    creepage: float


@dataclass(frozen=True, slots=True)
class _FaceState:
    """The cross-sections at all places, with derivatives with respect to ln F, s_u and s_l.

    Attributes
    ----------
    load : (n,) [N/mm].
    approach, upper, lower : (n,) approach [mm], T_u and T_l [N/mm], with (3, n) derivatives.
    rates : (2, n) ln(V_s/V_u) and ln(V_s/V_l), with (2, 3, n) derivatives.
    """

    load: Array
    approach: tuple[Array, Array]
    upper: tuple[Array, Array]
    lower: tuple[Array, Array]
    rates: tuple[Array, Array]


def _state(problem: FaceProblem, law: SheetLaw, points: Array) -> _FaceState:
    load = np.exp(points[0])
    logarithm, slopes = law.surface("approach", points)
    approach = np.exp(logarithm)
    sides = []
    for i, (friction, values) in enumerate(zip(law.frictions, law.tractions(points), strict=True)):
        by = np.zeros((3, load.size))
        by[0] = values
        by[1 + i] = friction * load * 2.0 * (1.0 - np.abs(np.clip(points[1 + i], -1.0, 1.0)))
        sides.append((values, by))
    found = [law.surface(name, points) for name in ("feed_upper", "feed_lower")]
    rates = np.array([value for value, _ in found]) + np.log1p(problem.rise)
    return _FaceState(
        load,
        (approach, approach * slopes),
        sides[0],
        sides[1],
        (rates, np.array([by for _, by in found])),
    )


def sheet_balance(problem: FaceProblem, law: SheetLaw, start: Array, middle: float) -> SheetBalance:
    """Return the equilibrium of a face with a sheet.

    Parameters
    ----------
    problem, law : the face and its cross-sections.
    start : (3, n) initial ln F, s_u and s_l.
    middle : initial delta_0 [mm].

    Raises
    ------
    ConvergenceError
        where Newton's method does not settle, for example because the nip opens or the sheet slips
        through.
    """
    n = problem.grid.y.size
    rates = _state(problem, law, start).rates[0].mean(axis=1)
    unknowns = np.concatenate([start.ravel(), [middle, problem.tilt or 0.0, *rates]])
    largest = np.concatenate([np.repeat(_LARGEST, n), np.full(4, np.inf)])
    for _ in range(_MOST_STEPS):
        wrong, slopes = _residual(problem, law, unknowns)
        try:
            change = np.linalg.solve(slopes, -wrong)
        except np.linalg.LinAlgError:
            break
        share = min(1.0, float(np.min(largest / np.maximum(np.abs(change), 1e-300))))
        unknowns = unknowns + share * change
        if not np.all(np.isfinite(unknowns)):
            break
        if share == 1.0 and float(np.max(np.abs(change[: 3 * n]))) < _SETTLED:
            return _found(problem, law, unknowns)
    raise ConvergenceError(
        "The balance of the face with its sheet did not settle: the nip opens somewhere, or the "
        "sheet slips through. Try a smaller crown, skew, offset or pull, or a larger load."
    )


def _found(problem: FaceProblem, law: SheetLaw, unknowns: Array) -> SheetBalance:
    n = problem.grid.y.size
    points = unknowns[: 3 * n].reshape(3, n)
    middle, tilt, upper, lower = (float(one) for one in unknowns[3 * n :])
    ratio = float(np.exp(lower - upper))  # V_u/V_l
    feeds = np.expm1(_state(problem, law, points).rates[0])
    return SheetBalance(points, middle, tilt, feeds, 2.0 * (ratio - 1.0) / (ratio + 1.0))


def _residual(problem: FaceProblem, law: SheetLaw, unknowns: Array) -> tuple[Array, Array]:
    """Return the residuals of the equations, (3 n + 4,), and their derivatives."""
    n, y = problem.grid.y.size, problem.grid.y
    points, (middle, tilt, upper, lower) = unknowns[: 3 * n].reshape(3, n), unknowns[3 * n :]
    state = _state(problem, law, points)
    bends = problem.upper + problem.lower
    wrong, slopes = np.zeros(3 * n + 4), np.zeros((3 * n + 4, 3 * n + 4))

    def at(rows: int, values: Array, by: Array) -> None:
        wrong[rows : rows + n] = values
        for i in range(3):
            slopes[rows : rows + n, i * n : (i + 1) * n] += np.diag(by[i])

    approach, by = state.approach
    unit = 1.0 / float(np.mean(np.abs(approach)))
    at(0, unit * (approach + bends @ state.load - problem.still - middle - tilt * y), unit * by)
    slopes[:n, :n] += unit * bends * state.load[None, :]
    slopes[:n, 3 * n], slopes[:n, 3 * n + 1] = -unit, -unit * y
    rates, rate_by = state.rates
    if problem.face.sheet_across == "one-speed":
        for i, speed in enumerate((upper, lower)):
            at((1 + i) * n, (rates[i] - speed) / _SPEEDS, rate_by[i] / _SPEEDS)
            slopes[(1 + i) * n : (2 + i) * n, 3 * n + 2 + i] = -1.0 / _SPEEDS
    else:
        at(n, (rates[1] - rates[0] - lower + upper) / _SPEEDS, (rate_by[1] - rate_by[0]) / _SPEEDS)
        slopes[n : 2 * n, 3 * n + 2], slopes[n : 2 * n, 3 * n + 3] = 1.0 / _SPEEDS, -1.0 / _SPEEDS
        held = 1.0 / (sum(law.frictions) * float(np.mean(state.load)))
        pull = held * (state.upper[0] - state.lower[0] - _pull(law))
        at(2 * n, pull, held * (state.upper[1] - state.lower[1]))
    _carry(problem, state, (middle, tilt), wrong, slopes)
    _drive(problem, law, state, points, (upper, lower), wrong, slopes)
    return wrong, slopes


def _pull(law: SheetLaw) -> float:
    """Return the pull on the sheet given by its table [N/mm]."""
    sheet = law.nip.sheet
    assert sheet is not None
    return sheet.tension_in - sheet.tension_out


def _mean(row: int, n: int, weight: Array, by: Array, slopes: Array, factor: float) -> None:
    """Write the derivatives of a weighted sum over the face into a row."""
    for i in range(3):
        slopes[row, i * n : (i + 1) * n] = factor * weight * by[i]


def _carry(
    problem: FaceProblem, state: _FaceState, pose: tuple[float, float], wrong: Array, slopes: Array
) -> None:
    """Write the equations of load and moment, or of approach and tilt."""
    grid, n = problem.grid, problem.grid.y.size
    length, total, moment = problem.face.length, problem.total, problem.moment
    by = np.zeros((3, n))
    by[0] = state.load
    size = float(grid.weights @ state.load)
    if total is None:
        assert isinstance(problem.nip.normal, Approach)
        wrong[3 * n], slopes[3 * n, 3 * n] = pose[0] - problem.nip.normal.approach, 1.0
    else:
        wrong[3 * n] = float(grid.weights @ state.load) / size - total / size
        _mean(3 * n, n, grid.weights, by, slopes, 1.0 / size)
    row = 3 * n + 1
    if moment is None:
        assert problem.tilt is not None
        wrong[row], slopes[row, row] = (pose[1] - problem.tilt) * length, length
    else:
        weight = grid.weights * grid.y
        wrong[row] = (float(weight @ state.load) - moment) / (size * length)
        _mean(row, n, weight, by, slopes, 1.0 / (size * length))


def _drive(
    problem: FaceProblem,
    law: SheetLaw,
    state: _FaceState,
    points: Array,
    speeds: tuple[float, float],
    wrong: Array,
    slopes: Array,
) -> None:
    """Write the equations of both speeds: of the mean pull, and of the lower roller's drive."""
    n, weights, length = problem.grid.y.size, problem.grid.weights, problem.face.length
    held = 1.0 / (sum(law.frictions) * float(weights @ state.load))
    row, last = 3 * n + 2, 3 * n + 3
    if problem.face.sheet_across == "one-speed":
        wrong[row] = held * (
            float(weights @ (state.upper[0] - state.lower[0])) - _pull(law) * length
        )
        _mean(row, n, weights, state.upper[1] - state.lower[1], slopes, held)
    else:  # the sheet has no common speed; speeds are relative to V_u
        wrong[row], slopes[row, row] = speeds[0] / _SPEEDS, 1.0 / _SPEEDS
    control = problem.nip.tangential
    if isinstance(control, Creepage):
        half = 0.5 * control.creepage
        wrong[last] = (speeds[1] - speeds[0] - log((1.0 + half) / (1.0 - half))) / _SPEEDS
        slopes[last, row], slopes[last, last] = -1.0 / _SPEEDS, 1.0 / _SPEEDS
    elif isinstance(control, Traction):
        wrong[last] = held * (float(weights @ state.lower[0]) - control.traction * length)
        _mean(last, n, weights, state.lower[1], slopes, held)
    else:
        assert isinstance(control, Torque)
        values, by = law.surface("torque_lower", points)
        arm = 1.0 + problem.rise[1]
        by = state.load * by
        by[0] += state.load * values
        factor = held * problem.nip.lower.curvature
        goal = control.torque_lower * length
        wrong[last] = factor * (float(weights @ (arm * state.load * values)) - goal)
        _mean(last, n, weights * arm, by, slopes, factor)
