"""The equilibrium of a face: cross-sections that carry load, and rollers that bend under it.

    delta(y) = delta_0 + b y - v_u(y) - v_l(y) + c_u(y) + c_l(y) - (y theta)^2/(2 (R_u + R_l))
    w(y) = F(delta, xi),  t(y) = T(delta, xi),  xi(y) = xi_0 + c_u/R_u - c_l/R_l

delta_0 and the tilt b follow from the load and its moment (or are given), xi_0 from the mean
traction or torque (or is given). Newton's method solves for delta(y), delta_0, b and xi_0 together.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import ConvergenceError
from rollnip.face.law import CrossSections, NipLaw, Places
from rollnip.face.problem import FaceProblem
from rollnip.nip import Approach, Creepage, Torque, Traction

Array = NDArray[np.float64]

_MOST_STEPS = 60
_SETTLED = 1e-10  # largest change of an approach in the last step, over the mean approach
_SMALLEST_STEP = 1e-6


@dataclass(frozen=True, slots=True)
class Balance:
    """The equilibrium of a face.

    Attributes
    ----------
    approach : (n,) of the surfaces [mm]; negative where the nip is open.
    section : loads and tractions of the cross-sections.
    places : coverings in the form that the law uses.
    middle, tilt : delta_0 [mm] and b.
    creepage : xi_0.
    steps : number of steps of Newton's method.
    """

    approach: Array
    section: CrossSections
    places: Places
    middle: float
    tilt: float
    creepage: float
    steps: int


@dataclass(frozen=True, slots=True)
class _System:
    """The equations of a face.

    Attributes
    ----------
    problem, law : the face and its cross-sections.
    places : coverings in the form that the law uses.
    scale : typical approach, by which equations in other units are scaled [mm].
    """

    problem: FaceProblem
    law: NipLaw
    places: Places
    scale: float


def balance(problem: FaceProblem, law: NipLaw, start: Balance | None = None) -> Balance:
    """Return the equilibrium of a face.

    Parameters
    ----------
    problem, law : the face and its cross-sections.
    start : a balance to start from, on as many places or on twice as many; None: an even load.

    Raises
    ------
    ConvergenceError
        where Newton's method does not settle.
    """
    places = problem.places(law)
    middle_load = float(np.sqrt(law.loads[0] * law.loads[-1])) * float(np.mean(places.scale))
    system = _System(problem, law, places, law.approach_at(middle_load, 0.0, places.mean))
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        found = _newton(system, _start(system) if start is None else _start_at(system, start))
    if found is None:
        raise ConvergenceError(_why_not(problem))
    return found


def _newton(system: _System, unknowns: Array) -> Balance | None:
    """Return the equilibrium of a face; None where Newton's method does not settle."""
    wrong, slopes, section = _residual(system, unknowns)
    size = _size(wrong)
    for step in range(1, _MOST_STEPS + 1):
        if not (np.isfinite(size) and np.all(np.isfinite(slopes))):
            return None
        try:
            change = np.linalg.solve(slopes, -wrong)
        except np.linalg.LinAlgError:
            return None
        share = 1.0
        while True:
            tried = unknowns + share * change
            wrong, slopes, section = _residual(system, tried)
            if _size(wrong) < size or share < _SMALLEST_STEP:
                break
            share *= 0.5
        unknowns, size = tried, _size(wrong)
        scale = max(float(np.mean(np.abs(unknowns[:-3]))), 1e-12)
        if float(np.max(np.abs(share * change[:-3]))) < _SETTLED * scale:
            middle, tilt, creepage = (float(v) for v in unknowns[-3:])
            return Balance(unknowns[:-3], section, system.places, middle, tilt, creepage, step)
    return None


def _why_not(problem: FaceProblem) -> str:
    """Return the message on a face whose balance did not settle, and what may help."""
    nip = problem.nip
    if isinstance(nip.tangential, Torque) and problem.total is not None:
        carried = nip.friction * problem.total / problem.face.length * nip.lower.radius
        return (
            "The balance of the face did not settle; friction carries a torque on the lower axle "
            f"of about {carried:.4g} N per width, `torque_lower` asks for "
            f"{nip.tangential.torque_lower:.4g} N. Try a smaller torque, crown or skew, or a "
            "larger load."
        )
    return (
        "The balance of the face did not settle; try a smaller crown, skew or offset, or a larger "
        "load."
    )


def _size(wrong: Array) -> float:
    return float(np.sqrt(np.mean(wrong**2)))


def _start(system: _System) -> Array:
    """Return approaches under an even load, and the creepage of free rolling there."""
    problem, law, places = system.problem, system.law, system.places
    n, nip, total = problem.grid.y.size, problem.nip, problem.total
    load = float(np.sqrt(law.loads[0] * law.loads[-1])) * float(np.mean(places.scale))
    if total is not None:
        load = total / problem.face.length
    share = 0.0
    if isinstance(nip.tangential, Traction) and nip.friction > 0.0:
        share = float(np.clip(nip.tangential.traction / (nip.friction * load), -0.99, 0.99))
    approach = law.approach_at(load, share, places.mean)
    creepage = 0.0 if nip.friction == 0.0 else law.creepage_at(load, share, places.mean)
    middle = approach
    if total is not None:
        # For an even load: the mean of what crown and bending take away is added.
        away = (problem.upper + problem.lower) @ np.full(n, load)
        middle += float(problem.grid.weights @ (away - problem.still)) / problem.face.length
    elif isinstance(nip.normal, Approach):
        approach = middle = nip.normal.approach
    return np.concatenate([np.full(n, approach), [middle, problem.tilt or 0.0, creepage]])


def _start_at(system: _System, start: Balance) -> Array:
    """Return the unknowns of a balance, at every other place if it has twice as many."""
    every = (start.approach.size - 1) // (system.problem.grid.y.size - 1)
    return np.array([*start.approach[::every], start.middle, start.tilt, start.creepage])


def _residual(system: _System, unknowns: Array) -> tuple[Array, Array, CrossSections]:
    """Return the residuals of the equations, their derivatives, and the cross-sections."""
    problem, grid, y = system.problem, system.problem.grid, system.problem.grid.y
    n = y.size
    delta, (middle, tilt, creepage) = unknowns[:n], unknowns[n:]
    section = system.law.at(delta, creepage + problem.local, system.places)
    bends = problem.upper + problem.lower
    wrong, slopes = np.zeros(n + 3), np.zeros((n + 3, n + 3))
    wrong[:n] = delta + bends @ section.load - problem.still - middle - tilt * y
    slopes[:n, :n] = np.eye(n) + bends * section.load_slope[None, :]
    slopes[:n, n], slopes[:n, n + 1] = -1.0, -y
    slopes[:n, n + 2] = bends @ section.load_by_creepage
    total, moment, length = problem.total, problem.moment, problem.face.length
    mean = float(grid.weights @ section.load) if total is None else total
    unit = system.scale / max(abs(mean), 1e-300)

    def carried(row: int, weight: Array, goal: float, factor: float) -> None:
        wrong[row] = factor * (weight @ section.load - goal)
        slopes[row, :n] = factor * weight * section.load_slope
        slopes[row, n + 2] = factor * (weight @ section.load_by_creepage)

    if total is None:
        assert isinstance(problem.nip.normal, Approach)
        wrong[n], slopes[n, n] = middle - problem.nip.normal.approach, 1.0
    else:
        carried(n, grid.weights, total, unit)
    if moment is None:
        assert problem.tilt is not None
        wrong[n + 1], slopes[n + 1, n + 1] = (tilt - problem.tilt) * length, length
    else:
        carried(n + 1, grid.weights * y, moment, 2.0 * unit / length)
    _drive(system, section, creepage, wrong, slopes)
    return wrong, slopes, section


def _drive(
    system: _System, section: CrossSections, creepage: float, wrong: Array, slopes: Array
) -> None:
    """Write the equation of traction, torque or creepage into the last row."""
    problem, scale = system.problem, system.scale
    nip, weights = problem.nip, problem.grid.weights
    n = weights.size
    if nip.friction == 0.0:
        wrong[n + 2], slopes[n + 2, n + 2] = scale * creepage, scale
        return
    if isinstance(nip.tangential, Creepage):
        wrong[n + 2] = scale * (creepage - nip.tangential.creepage)
        slopes[n + 2, n + 2] = scale
        return
    unit = scale / max(nip.friction * float(weights @ section.load), 1e-300)
    if isinstance(nip.tangential, Traction):
        goal, values = nip.tangential.traction, section.traction
        by_approach, by_creepage = section.traction_slope, section.traction_by_creepage
    else:
        assert isinstance(nip.tangential, Torque)
        goal, unit = nip.tangential.torque_lower, unit * nip.lower.curvature
        values = torque(problem, system.law, section, system.places, "lower")
        arm = 1.0 + problem.rise[1]
        slope = system.law.slopes("torque_lower", section, system.places)
        by_approach, by_creepage = (arm * one for one in slope)
    wrong[n + 2] = unit * (float(weights @ values) - goal * problem.face.length)
    slopes[n + 2, :n] = unit * weights * by_approach
    slopes[n + 2, n + 2] = unit * float(weights @ by_creepage)


def plane_load(problem: FaceProblem, found: Balance) -> Array:
    """Return the line loads of plane nips at the approaches of a face, (n,) [N/mm]."""
    if problem.relief is None:
        return found.section.load
    load = np.exp(found.section.log_load) * problem.coverings.scale
    return np.where(found.approach > 0.0, load, 0.0)


def torque(
    problem: FaceProblem, law: NipLaw, section: CrossSections, places: Places, roller: str
) -> Array:
    """Return the driving torque on one axle per length, (n,) [N], with the local radius."""
    values = law.figure(f"torque_{roller}", section.log_load, section.s, places)
    arm = 1.0 + problem.rise[0 if roller == "upper" else 1]
    return np.asarray(np.where(section.load > 0.0, arm * values, 0.0))
