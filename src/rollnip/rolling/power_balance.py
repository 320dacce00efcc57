"""The power of the axles: torques, the loss by slip, the losses in viscoelastic layers.

An axle supplies the power that its roller transmits and the power that it loses inside (theory
section 7):

    M_u V_u/R_u = V_u (int q lambda_u ds + w_u),   M_l V_l/R_l = V_l (w_l - int q lambda_l ds),

with the stretch lambda of a surface, the loss w inside a roller per distance rolled, and ds along
the deformed interface. The sum of both is the friction loss plus the viscous loss V_u w_u + V_l w_l
in every geometry, provided the stretch is the one in its creep; and no large terms cancel in a
torque. The moments of pressure and shear about both axles must give the same torques to the order
of the geometry; tests confirm it.

Shear opposes slip, so the loss of a slip zone is never negative. A solution meets this only to its
residual: in a zone of a thousandth of the contact slip may be reversed, by as little as the
residual allows. The loss of such a zone is set to 0, which is the possible loss closest to the
computed one, and closer to the true one than that. The difference counts as an error of the loss,
and the powers miss their balance by as much.

The secondary figures are these, a length and a place: figures whose errors are estimated but not
held to the tolerance.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import isnan, nan

import numpy as np

from rollnip.contact import contact_intervals
from rollnip.contact.problem import Array, Mask
from rollnip.model import FINITE, Geometry
from rollnip.rollers import SIDES
from rollnip.rolling.changes import LEAST_SIZE
from rollnip.rolling.kinematics import creep_of
from rollnip.rolling.mesh_solution import MeshSolution, SecondaryFigures, peak_on
from rollnip.rolling.surface_work import loss_inside, moment, slip_intervals, transmitted


@dataclass(frozen=True, slots=True)
class Powers:
    """Losses and transmitted work per distance rolled and axial length; times V they are powers.

    Attributes
    ----------
    friction : loss by slip, -int q s ds/V [N/mm].
    lost_upper, lost_lower : loss inside each roller, per distance of its own surface [N/mm].
    pull_upper, pull_lower : int q lambda ds, work of the shear at the surface of each roller, per
        distance of that surface [N/mm].
    cut : change of ``friction`` by the short waves that the solution leaves out [N/mm].
    reversed_slip : work of slip in the direction of its own shear, set to 0 in ``friction`` [N/mm].
    moment_upper, moment_lower : moments of the tractions about both axles, over the radii [N/mm];
        nan except in "second" and "finite". In equilibrium, so in "finite", they equal the torques;
        in "second" they do so to the third order.
    """

    friction: float
    lost_upper: float
    lost_lower: float
    pull_upper: float
    pull_lower: float
    cut: float = 0.0
    reversed_slip: float = 0.0
    moment_upper: float = nan
    moment_lower: float = nan

    @property
    def driving_upper(self) -> float:
        """Torque on the upper axle over the radius, M_u/R_u [N/mm]."""
        return self.pull_upper + self.lost_upper

    @property
    def driving_lower(self) -> float:
        """Torque on the lower axle over the radius, M_l/R_l [N/mm]."""
        return self.lost_lower - self.pull_lower


def rates_of(geometry: Geometry, creepage: float) -> tuple[float, float]:
    """Return the speeds of both rollers, divided by V, to the order of the model."""
    half = 0.0 if isnan(creepage) else 0.5 * creepage
    return (1.0, 1.0) if geometry in ("linear", "corrected") else (1.0 + half, 1.0 - half)


def powers(found: MeshSolution) -> Powers:
    """Return the losses and the transmitted work of a solution."""
    nip, geometry, mesh, state = found.nip, found.geometry, found.mesh, found.state
    x, u = mesh.fine.nodes[1:], found.displacements
    inside = [slip_intervals(x, (zone,)) for zone in found.zones]  # none where surfaces stick
    slips = np.any(inside, axis=0)
    pulls, shear, both = transmitted(found.contact, mesh, state, u, slips)
    friction = cut = reversed_slip = 0.0
    if nip.friction > 0.0 and not isnan(state.creepage):
        dx = x[1:] - x[:-1]
        works = [shear * creep_of(dx, geometry, excess, state.creepage) for excess in both]
        (smooth, _), (friction, reversed_slip) = (slip_losses(work, inside) for work in works)
        cut = abs(friction - smooth)
    moments = [nan, nan]
    if geometry in FINITE:
        uncut = mesh.uncut(u)
        moments = [moment(side, nip, geometry, mesh, state, uncut) for side in SIDES]
    return Powers(
        friction=friction,
        lost_upper=loss_inside("upper", nip, geometry, mesh, state),
        lost_lower=loss_inside("lower", nip, geometry, mesh, state),
        pull_upper=float(pulls[0]),
        pull_lower=float(pulls[1]),
        cut=cut,
        reversed_slip=reversed_slip,
        moment_upper=moments[0],
        moment_lower=moments[1],
    )


def slip_losses(work: Array, zones: Sequence[Mask]) -> tuple[float, float]:
    """Return the loss by slip, and the work of slip that is reversed, along its own shear.

    Parameters
    ----------
    work : (n,) work of the shear on the creep of each interval.
    zones : (n,) each: the intervals of one zone; in stick there are none.
    """
    of_zones = [float(work[inside].sum()) for inside in zones]
    return sum(max(one, 0.0) for one in of_zones), sum(max(-one, 0.0) for one in of_zones)


def secondary_figures(found: MeshSolution) -> SecondaryFigures:
    """Return the secondary figures of a solution."""
    return secondary_figures_of(powers(found), found)


def secondary_figures_of(spent: Powers, found: MeshSolution) -> SecondaryFigures:
    """Return the secondary figures of a solution, given its powers."""
    mesh, state = found.mesh, found.state
    _, place = peak_on(mesh, state.pressure)
    return SecondaryFigures(
        traction=float(mesh.weights @ state.shear),
        driving_upper=spent.driving_upper,
        driving_lower=spent.driving_lower,
        friction=spent.friction,
        lost_upper=spent.lost_upper,
        lost_lower=spent.lost_lower,
        contact_length=sum(stop - start for start, stop in contact_intervals(found.zones)),
        peak_pressure_x=place,
    )


def secondary_sizes(latest: MeshSolution, figures: SecondaryFigures) -> Array:
    """Return the sizes that errors of `SecondaryFigures` are relative to, (8,).

    Each is at least `LEAST_SIZE` of the largest value that the figure may have. A figure that
    vanishes for lack of friction or viscosity has size 0, so no error.
    """
    nip, load, width = latest.nip, latest.figures.load, latest.figures.nip_width
    work = load * 0.5 * width * nip.curvature  # of the load on the slope of the gap at an edge
    grip = min(nip.friction, 1.0)
    traction = max(abs(figures.traction), LEAST_SIZE * grip * load)
    friction = max(abs(figures.friction), LEAST_SIZE * grip * work)
    both = (nip.upper, figures.lost_upper), (nip.lower, figures.lost_lower)
    lost = [max(one, LEAST_SIZE**2 * work) if of.is_viscoelastic else 0.0 for of, one in both]
    driving = [work if nip.friction > 0.0 or of.is_viscoelastic else 0.0 for of, _ in both]
    return np.array([traction, *driving, friction, *lost, width, width])
