"""What the tractions of a solution do to each roller: work on its surface, moment, loss inside."""

from __future__ import annotations

import numpy as np

from rollnip.contact import ContactState, ContactZone, State
from rollnip.contact.problem import Array, Mask
from rollnip.interior import SurfaceTractions, loss_per_distance
from rollnip.model import Geometry
from rollnip.nip import Nip
from rollnip.rollers import Side
from rollnip.rolling.displacements import Displacements
from rollnip.rolling.kinematics import arc_ratio, stretch_excess, surface_depths
from rollnip.rolling.rolling_contact import RollingContact
from rollnip.rolling.surfaces import Mesh, interval_means


def mean_shear(mesh: Mesh, state: ContactState) -> Array:
    """Return the mean acting shear on the intervals of the finer nodes[1:] [MPa]."""
    return interval_means(mesh.acting(state.shear))


def transmitted(
    contact: RollingContact, mesh: Mesh, state: ContactState, u: Displacements, slips: Mask
) -> tuple[Array, Array, tuple[Array, Array]]:
    """Return int q lambda ds of the upper and the lower surface, and its integrands.

    The integral is the power that the shear transmits, over the speed of that surface. Where they
    slip, lambda includes the short waves cut from the correction, as these belong to the actual
    tractions; without them lambda would belong to other, smoother tractions.

    Parameters
    ----------
    u : displacements at nodes[1:].
    slips : (n,) whether the surfaces slip in each interval of the finer nodes[1:].

    Returns
    -------
    The two integrals, (2,) [N/mm]; the mean shear in each of these intervals, per dx, (n,) [MPa];
    and in each of them `stretch_excess` as solved, and with the short waves, (2, n) each [mm].
    """
    nip, geometry = contact.nip, contact.geometry
    x, finer, uncut = mesh.fine.nodes[1:], mesh.finer(u), mesh.uncut(u)
    shear = mean_shear(mesh, state) * arc_ratio(x, nip, geometry, finer)
    excess = stretch_excess(x, nip, geometry, finer)
    whole = excess if uncut is u else stretch_excess(x, nip, geometry, mesh.finer(uncut))
    pulls = (x[1:] - x[:-1] + np.where(slips, whole, excess)) @ shear
    return pulls, shear, (excess, whole)


def slip_intervals(x: Array, zones: tuple[ContactZone, ...]) -> Mask:
    """Return which of the intervals between ``x`` have their middle in a slip zone, (n - 1,)."""
    middle = 0.5 * (x[1:] + x[:-1])
    slips = np.zeros(middle.size, dtype=bool)
    for zone in zones:
        if zone.state != State.STICK:
            slips |= (middle > zone.start) & (middle < zone.stop)
    return slips


def moment(
    side: Side,
    nip: Nip,
    geometry: Geometry,
    mesh: Mesh,
    state: ContactState,
    u: Displacements,
) -> float:
    """Return the moment of the tractions about one axle, divided by the radius [N/mm].

    ``u``: displacements at nodes[1:]. At height eta above the tangent and slope eta', the force per
    dx is (q - p eta', p + q eta') on the upper surface, (-q - p eta', p - q eta') on the lower.
    """
    number, roller, sign = (0, nip.upper, 1.0) if side == "upper" else (1, nip.lower, -1.0)
    x = mesh.fine.nodes[1:]
    dx, middle = np.diff(x), 0.5 * (x[1:] + x[:-1])
    p, q = interval_means(mesh.acting(state.pressure)), sign * mean_shear(mesh, state)
    depth = surface_depths(x, nip, geometry, mesh.finer(u))[number]
    slope, height = np.diff(depth) / dx, 0.5 * (depth[1:] + depth[:-1])
    arm = 1.0 - roller.curvature * height
    along, down = q - p * slope, p + q * slope
    return float((arm * along + roller.curvature * middle * down) @ dx)


def loss_inside(side: Side, nip: Nip, geometry: Geometry, mesh: Mesh, state: ContactState) -> float:
    """Return the viscous loss inside one roller per distance rolled by its surface [N/mm].

    It is the loss of the linear fields under the tractions of the solution; geometry "finite" adds
    the contribution of all orders. In "second" it neglects a share as large as the strains.
    """
    roller, sign = (nip.upper, 1.0) if side == "upper" else (nip.lower, -1.0)
    if not roller.is_viscoelastic:
        return 0.0
    shear, pressure = sign * mesh.acting(state.shear), mesh.acting(state.pressure)
    tractions = SurfaceTractions.on_inner(mesh.fine.nodes, shear, pressure)
    further = mesh.kernels.heat_beyond[0 if side == "upper" else 1]
    return loss_per_distance(roller, tractions, geometry, nip.speed) + further
