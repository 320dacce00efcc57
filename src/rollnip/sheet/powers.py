"""Torques, losses by slip on both interfaces, and the power that goes into the sheet.

As without a sheet, M_u V_u/R_u = V_u (int q_u lambda_u ds + w_u) and
M_l V_l/R_l = V_l (w_l - int q_l lambda_l ds), w the loss inside a roller per rolled distance. Of
that power slip takes int q_u (creep of the upper interface) V and the like below, and the sheet
takes the rest: V_s int [q_u (1 + e - h kappa/2) - q_l (1 + e + h kappa/2)] ds, which is the work
against its tensions and the elastic energy that it carries away.
"""

from __future__ import annotations

from dataclasses import astuple, dataclass

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import State, States
from rollnip.model import Geometry
from rollnip.rolling.assemble import loss_inside, moment
from rollnip.rolling.power_balance import Powers, rates_of, slip_losses
from rollnip.sheet.lagged import path_turn, pulls_of, sheet_rate
from rollnip.sheet.system import Lagged, SheetProblem, SheetState

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class SheetPowers:
    """Losses and pulls per rolled distance and axial length; times V [mm/s] each is a power.

    Attributes
    ----------
    friction_upper, friction_lower : lost by slip on either interface [N/mm].
    lost_upper, lost_lower : inside each roller, per distance of its own surface [N/mm].
    pull_upper, pull_lower : int q lambda ds of each roller [N/mm].
    into_sheet : what the sheet takes [N/mm].
    """

    friction_upper: float
    friction_lower: float
    lost_upper: float
    lost_lower: float
    pull_upper: float
    pull_lower: float
    into_sheet: float

    def array(self) -> Array:
        """Return all of them in order, (7,)."""
        return np.array(astuple(self))

    @property
    def as_bare(self) -> Powers:
        """Return losses and pulls as those of a bare nip."""
        return Powers(
            friction=self.friction_upper + self.friction_lower,
            lost_upper=self.lost_upper,
            lost_lower=self.lost_lower,
            pull_upper=self.pull_upper,
            pull_lower=self.pull_lower,
        )


def sheet_powers(
    problem: SheetProblem, geometry: Geometry, state: SheetState, lagged: Lagged
) -> SheetPowers:
    """Return torques over radii and losses of a solution."""
    nip, mesh = problem.nip, problem.mesh
    pulls = pulls_of(problem, geometry, state, mesh.uncut(mesh.displacements(state)))
    lost = [
        loss_inside("upper", nip, geometry, mesh, state),
        loss_inside("lower", nip, geometry, mesh, state.side(1)),
    ]
    friction = [lost for lost, _ in slip_works(problem, geometry, state, lagged, pulls)]
    return SheetPowers(
        friction_upper=friction[0],
        friction_lower=friction[1],
        lost_upper=lost[0],
        lost_lower=lost[1],
        pull_upper=pulls[0],
        pull_lower=pulls[1],
        into_sheet=_into_sheet(problem, geometry, state),
    )


def slip_works(
    problem: SheetProblem,
    geometry: Geometry,
    state: SheetState,
    lagged: Lagged,
    pulls: tuple[float, float],
) -> list[tuple[float, float]]:
    """Return what slip on either interface loses, and its work along its own shear [N/mm].

    Short waves that the contact does not follow change the stretch, and by it what the shear of a
    surface hands over; the loss changes by as much. ``pulls``: see `pulls_of`, with these waves.
    """
    works = smooth_works(problem, state, lagged)
    if problem.mesh.held is None:
        return works
    out = []
    smooth = pulls_of(problem, geometry, state, problem.mesh.displacements(state))
    for side, (sign, rate) in enumerate(zip((1.0, -1.0), rates(geometry, state), strict=True)):
        lost = works[side][0] + sign * rate * (pulls[side] - smooth[side])
        out.append((max(lost, 0.0), works[side][1] + max(-lost, 0.0)))
    return out


def smooth_works(
    problem: SheetProblem, state: SheetState, lagged: Lagged
) -> list[tuple[float, float]]:
    """Return the same of the creep that the contact follows [N/mm]."""
    creeps, out = problem.gap_and_creeps(state, lagged)[1:], []
    for side in (0, 1):
        sheared = -np.diff(problem.tension @ state.shears[side])  # int q ds over each interval
        rate = creeps[side, :-1] / problem.mesh.dx[:-1]
        out.append(slip_losses(sheared * rate, slip_zones(state.both_states[side])))
    return out


def off_the_moments(
    problem: SheetProblem, geometry: Geometry, state: SheetState, spent: SheetPowers
) -> Array:
    """Return by how much torques differ from moments of the tractions, over the radii, (2,) [N/mm].

    In equilibrium they are the same. Both come from the displacements of finite elements, and a
    stretch of several times beside a slipping edge is less well known than the height there.
    """
    mesh, bare = problem.mesh, spent.as_bare
    u = mesh.uncut(mesh.displacements(state))
    driving = np.array([bare.driving_upper, bare.driving_lower])
    upper = moment("upper", problem.nip, geometry, mesh, state, u)
    lower = moment("lower", problem.nip, geometry, mesh, state.side(1), u)
    return np.asarray(np.abs(driving - [upper, lower]))


def slip_zones(states: States) -> list[NDArray[np.bool_]]:
    """Return which intervals between nodes belong to each zone of slip, (n - 1,) each.

    The one from its last node to the first that sticks belongs to it: where a transition is off by
    delta the shear jumps there, and what that slips makes up for the rest of the zone but for
    delta^2. On that to the other side the creep is zero.
    """
    slips = states > State.STICK
    zone = np.cumsum(~slips)[:-1]  # the same number from one node that does not slip to the next
    slips = slips[:-1] & (states[1:] != State.FREE)
    return [slips & (zone == number) for number in np.unique(zone[slips])]


def _into_sheet(problem: SheetProblem, geometry: Geometry, state: SheetState) -> float:
    """Return the power of the shears on the faces of the sheet over V [N/mm].

    Its faces run at V_s (1 + e -+ h kappa/2). "linear" leaves out products of creepage and strain.
    """
    mesh = problem.mesh
    above, below = -np.diff(problem.tension @ state.shears.T, axis=0).T
    pushed, sheared = above - below, above + below
    strain = (problem.strain_over(state) / mesh.dx)[:-1]
    rate = sheet_rate(state.creepage, state.creepage_lower)
    taken = rate * float(pushed.sum())
    if geometry == "linear":
        return taken + float(pushed @ strain)
    turn = path_turn(problem, mesh.displacements(state))[:-1] / mesh.dx[:-1]
    bent = 0.5 * problem.sheet.thickness * float(sheared @ turn)
    return taken + rate * (float(pushed @ strain) - bent)


def rates(geometry: Geometry, state: SheetState) -> tuple[float, float]:
    """Return the speeds of both rollers over V, to the order of the model."""
    return rates_of(geometry, state.creepage + state.creepage_lower)
