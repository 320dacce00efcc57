"""Figures of a nip with a sheet that resists bending, and their layout in tests/data.

The axles and the tensions put in  M_u V_u/R_u + M_l V_l/R_l + V_s [N + N^2/(2K)]_in^out, friction
takes it on both sides; nothing in the program enforces that both agree.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np

from finite_elements.figures import Checks, contact_checks, peak
from finite_elements.mesh import Array
from finite_elements.plate import PlateProblem, PlateState
from finite_elements.plate_edges import SolvedPlate


@dataclass(frozen=True)
class PlateFigures:
    """What is compared; mm, N, MPa, signs as in rollnip. Places are those of the sheet."""

    approach: float
    trailing: float
    leading: float
    trailing_lower: float
    leading_lower: float
    peak_pressure: float
    peak_pressure_lower: float
    creepage_upper: float
    creepage_lower: float
    traction_upper: float
    tension_max: float
    torque_upper: float
    torque_lower: float
    power_in: float
    friction_power: float

    def extrapolated(self, finer: PlateFigures, factor: float) -> tuple[PlateFigures, PlateFigures]:
        """Return the limit of ever smaller elements (first order), and how far it is off."""
        coarse, fine = asdict(self), asdict(finer)
        change = {name: (fine[name] - coarse[name]) / (factor - 1.0) for name in fine}
        return (
            type(self)(**{name: fine[name] + change[name] for name in fine}),
            type(self)(**{name: abs(value) for name, value in change.items()}),
        )


def speeds(state: PlateState, rigid: bool) -> tuple[float, float, float]:
    """Return V_u, V_s and V_l over V, the mean of V_u and V_l."""
    upper, lower = (side.creepage for side in state.sides)
    if rigid:  # the sheet carries the tractions of the lower contact
        lower = -lower
    ratios = [(1.0 + 0.5 * xi) / (1.0 - 0.5 * xi) for xi in (upper, lower)]
    mean = 0.5 * sum(ratios)
    return ratios[0] / mean, 1.0 / mean, ratios[1] / mean


@dataclass(frozen=True)
class Side:
    """One contact at its points of Gauss; forces are those on the roller, y into it."""

    x: Array
    height: Array  # of the roller's surface
    path: Array  # deformed length
    along: Array  # dx over it
    force: tuple[Array, Array]
    shear: Array
    stretches: tuple[Array, Array]  # of the roller and of the sheet


def side_of(problem: PlateProblem, state: PlateState, number: int) -> Side:
    """Evaluate one contact."""
    contact, here = problem.contacts[number], problem.side(state, number)
    at = np.flatnonzero(here.closed)
    points = contact.interface.points(here.upper, at[:-1])
    faced = contact.interface.lower.facing(here.lower, points.x)
    pair = np.stack((points.element, points.element + 1), axis=-1)
    p, q = (np.sum(points.hats * v[pair], axis=1) for v in (here.pressure, here.shear))
    own = points.upper
    stretch = np.hypot(own.along, own.up), np.hypot(faced.along, faced.up)
    force = q * own.along - p * own.up, p * own.along + q * own.up
    if number == 1 and problem.lower is None:  # on the sheet; the roller takes the opposite
        return Side(
            points.x, faced.height, points.weight * stretch[0], own.along / stretch[0],
            (-points.weight * force[0], points.weight * force[1]), -q, stretch[::-1],
        )  # fmt: skip
    return Side(
        points.x, own.height, points.weight * stretch[0], own.along / stretch[0],
        (points.weight * force[0], points.weight * force[1]), q, stretch,
    )  # fmt: skip


def tension(problem: PlateProblem, state: PlateState) -> tuple[Array, Array]:
    """Return the sheet's tension along its path at the columns of Gauss, and their places."""
    sheet, solid = problem.sheet, problem.solids[1]
    deform = solid.gradient(state.moved[1])
    shear = sheet.roller.layers[0].shear_modulus
    jacobian = np.linalg.det(deform)
    c, _ = solid._law(jacobian, state.inside[1])
    plies = sheet.depth_ends.size - 1
    nominal = shear * deform[..., 0] + c[..., None] * np.stack(
        (deform[..., 1, 1], -deform[..., 0, 1]), axis=-1
    )  # P e_1, per undeformed height
    way = deform[..., 0] / np.linalg.norm(deform[..., 0], axis=-1)[..., None]
    weights = np.tile(np.array([5.0, 8.0, 5.0]) / 18.0, 3).reshape(3, 3)
    pulled = np.sum(nominal * way, axis=-1).reshape(-1, plies, 3, 3)
    high = np.diff(sheet.depth_ends)[None, :, None, None]
    total = np.sum(pulled * weights * high, axis=(1, 3)).ravel()
    half = 0.5 * np.diff(sheet.arc_ends)
    gauss = np.array([-1.0, 0.0, 1.0]) * np.sqrt(0.6)
    return (sheet.arc[1::2][:, None] + half[:, None] * gauss).ravel(), total


def edges_of(problem: PlateProblem, state: PlateState, number: int) -> tuple[Array, Array, Array]:
    """Return places, pressures and shears of the closed ends of one contact."""
    here = problem.side(state, number)
    at = np.flatnonzero(here.closed)
    x, _ = problem.contacts[number].interface.places(here.upper)
    sign = -1.0 if number == 1 and problem.lower is not None else 1.0
    return x[at], here.pressure[at], sign * here.shear[at]


def middle_places(problem: PlateProblem, state: PlateState) -> tuple[Array, Array]:
    """Return x and height of the middle of the sheet at its columns of nodes."""
    sheet = problem.sheet
    nodes = sheet.dofs.reshape(sheet.columns, sheet.rows, 2)[:, sheet.rows // 2]
    moved = state.moved[1][nodes]
    return sheet.arc + moved[:, 0], moved[:, 1]


def plate_checks(solved: SolvedPlate) -> tuple[Checks, Checks]:
    """Evaluate the conditions of both contacts that the solution does not impose."""
    problem, state = solved.problem, solved.state
    out = []
    for number in (0, 1):
        contact, here = problem.contacts[number], problem.side(state, number)
        out.append(contact_checks(contact, here, state.approach))
    return out[0], out[1]


def plate_figures(solved: SolvedPlate) -> PlateFigures:
    """Return the figures of one mesh."""
    problem, state = solved.problem, solved.state
    plate, nip = problem.plate, problem.nip
    upper, lower = (side_of(problem, state, number) for number in (0, 1))
    v_u, v_s, v_l = speeds(state, problem.lower is None)
    torques = []
    for side, radius in ((upper, nip.upper.radius), (lower, nip.lower.radius)):
        f_x, f_y = side.force
        torques.append(float(np.sum(side.x * f_y + (radius - side.height) * f_x)))
    inlet, outlet = plate.tension_in, plate.tension_out
    stiffness = plate.modulus * plate.thickness / (1.0 - plate.poisson**2)
    pulls = outlet - inlet + 0.5 * (outlet**2 - inlet**2) / stiffness
    power = torques[0] * v_u / nip.upper.radius + torques[1] * v_l / nip.lower.radius + v_s * pulls
    heat = 0.0
    for side, speed in ((upper, v_u), (lower, v_l)):
        slip = speed * side.stretches[0] - v_s * side.stretches[1]
        heat += float(np.sum(side.path * side.shear * slip))
    _, pull = tension(problem, state)
    ends = [edges_of(problem, state, number) for number in (0, 1)]
    return PlateFigures(
        approach=state.approach,
        trailing=float(ends[0][0][0]),
        leading=float(ends[0][0][-1]),
        trailing_lower=float(ends[1][0][0]),
        leading_lower=float(ends[1][0][-1]),
        peak_pressure=peak(ends[0][0], ends[0][1]),
        peak_pressure_lower=peak(ends[1][0], ends[1][1]),
        creepage_upper=v_u - v_s,
        creepage_lower=v_s - v_l,
        traction_upper=float(np.sum(upper.path * upper.along * upper.shear)),
        tension_max=float(pull.max()),
        torque_upper=torques[0],
        torque_lower=torques[1],
        power_in=float(power),
        friction_power=heat,
    )
