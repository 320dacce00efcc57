"""Torques, slip losses on both interfaces, and the power into the sheet.

As without a sheet, M_u V_u/R_u = V_u (int q_u lambda_u ds + w_u) and
M_l V_l/R_l = V_l (w_l - int q_l lambda_l ds), with the loss w inside each roller per rolled
distance. Slip dissipates int q_u (creep of the upper interface) V of that power, and likewise on
the lower interface. The rest goes into the sheet:
V_s int [q_u (1 + e - h kappa/2) - q_l (1 + e + h kappa/2)] ds. That is the work against its
tensions plus the elastic energy that it carries away, V_s [N + a N^2/2] from the outlet to the
inlet, but for products of pressure and strain: V_s b int p dN, in 22 sheets at most 1.3e-4 of the
largest of powers and V times tractions. Pressures on faces that are inclined because the thickness
changes would take it back; they are left out. A plate in `linear` has the curvature in the speed of
its faces, but not in its tension.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple, dataclass

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import State, States
from rollnip.model import Geometry
from rollnip.rollers import SIDES
from rollnip.rolling.power_balance import Powers, rates_of, slip_losses
from rollnip.rolling.surface_work import loss_inside, moment
from rollnip.sheet.friction import SIDE_SIGNS
from rollnip.sheet.iterate import AnyIterate

Array = NDArray[np.float64]
Pulls = Sequence[tuple[float, float]]
"""int q lambda ds of both rollers [N/mm], each with all short waves, and without those that the
contact conditions do not follow.
"""


@dataclass(frozen=True, slots=True)
class SheetPowers:
    """Losses and surface work per rolled distance and axial length; times V [mm/s] each is a power.

    Attributes
    ----------
    friction_upper, friction_lower : loss by slip on each interface [N/mm].
    lost_upper, lost_lower : loss inside each roller, per distance of its own surface [N/mm].
    pull_upper, pull_lower : int q lambda ds of each roller [N/mm].
    into_sheet : work into the sheet [N/mm].
    """

    friction_upper: float
    friction_lower: float
    lost_upper: float
    lost_lower: float
    pull_upper: float
    pull_lower: float
    into_sheet: float

    def array(self) -> Array:
        """Return all values in order, (7,)."""
        return np.array(astuple(self))

    @property
    def as_bare(self) -> Powers:
        """Return the losses and pulls in the form of a bare nip."""
        return Powers(
            friction=self.friction_upper + self.friction_lower,
            lost_upper=self.lost_upper,
            lost_lower=self.lost_lower,
            pull_upper=self.pull_upper,
            pull_lower=self.pull_lower,
        )


def sheet_powers(
    iterate: AnyIterate, geometry: Geometry, pulls: Pulls, into_sheet: float
) -> SheetPowers:
    """Return the losses and pulls of a solution."""
    problem, state = iterate.problem, iterate.state
    lost = [
        loss_inside(name, problem.nip, geometry, problem.meshes[side], state.side(side))
        for side, name in enumerate(SIDES)
    ]
    slip = [loss for loss, _ in slip_works(iterate, geometry, pulls)]
    return SheetPowers(
        friction_upper=slip[0],
        friction_lower=slip[1],
        lost_upper=lost[0],
        lost_lower=lost[1],
        pull_upper=pulls[0][0],
        pull_lower=pulls[1][0],
        into_sheet=into_sheet,
    )


def slip_works(iterate: AnyIterate, geometry: Geometry, pulls: Pulls) -> list[tuple[float, float]]:
    """Return the slip loss of each interface and its work along its own shear [N/mm].

    Short waves that the contact conditions do not follow change the stretch, and with it the work
    that a surface transmits by its shear; the slip loss changes by the same amount.
    """
    rates, out = rates_of(geometry, sum(iterate.state.creepages)), []
    for side, ((loss, reversed_slip), sign) in enumerate(
        zip(smooth_slip_works(iterate), SIDE_SIGNS, strict=True)
    ):
        whole, smooth = pulls[side]
        loss += sign * rates[side] * (whole - smooth)
        out.append((max(loss, 0.0), reversed_slip + max(-loss, 0.0)))
    return out


def smooth_slip_works(iterate: AnyIterate) -> list[tuple[float, float]]:
    """Return `slip_works` for only the creep that the contact conditions follow [N/mm]."""
    problem, state, out = iterate.problem, iterate.state, []
    for side, mesh in enumerate(problem.meshes):
        work = problem.shear_forces(state, side) * (iterate.creeps[side][:-1] / mesh.dx[:-1])
        out.append(slip_losses(work, slip_zones(state.side(side).states)))
    return out


def torque_mismatch(iterate: AnyIterate, geometry: Geometry, spent: SheetPowers) -> Array:
    """Return the mismatch of torques and moments of the tractions over the radii, (2,) [N/mm].

    In equilibrium of all orders they are equal. In "finite" both come from finite-element
    displacements, and a stretch of several times the original length beside a slipping edge is less
    accurate than the height there. In "second" they differ by the third order, and by what its
    viscous loss neglects.
    """
    problem, state, out = iterate.problem, iterate.state, np.zeros(2)
    driving = spent.as_bare.driving_upper, spent.as_bare.driving_lower
    for side, mesh in enumerate(problem.meshes):
        u = mesh.uncut(problem.displacements(state, side))
        turning = moment(SIDES[side], problem.nip, geometry, mesh, state.side(side), u)
        out[side] = abs(driving[side] - turning)
    return out


def slip_zones(states: States) -> list[NDArray[np.bool_]]:
    """Return which intervals between nodes belong to each zone of slip, (n - 1,) each.

    The interval from the last slipping node of a zone to the first sticking one is included: where
    the transition is misplaced by delta the shear jumps there, and the slip in that interval
    balances the rest of the zone to within delta^2. In the interval at the other end of the zone
    the creep is zero.
    """
    slips = states > State.STICK
    zone = np.cumsum(~slips)[:-1]  # constant from each node that does not slip to the next one
    slips = slips[:-1] & (states[1:] != State.FREE)
    return [slips & (zone == number) for number in np.unique(zone[slips])]
