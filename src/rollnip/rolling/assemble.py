"""Assembly of the discrete contact problem of a nip on a mesh, with its second-order terms."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite, isnan, nan, sqrt

import numpy as np
from numpy.typing import NDArray

from rollnip._largest import largest
from rollnip.contact import (
    ContactProblem,
    ContactState,
    ContactZone,
    Control,
    State,
    carry,
    contact_zones,
)
from rollnip.geometry import (
    linear_stretch,
    rotation_stretch,
    sagitta,
    second_stretch,
)
from rollnip.interior import SurfaceTractions, loss_per_distance
from rollnip.model import FINITE, RINGS, Geometry
from rollnip.nip import Approach, Creepage, LineLoad, Nip, Torque, Traction
from rollnip.rollers import Side
from rollnip.rolling.displacements import Displacements
from rollnip.rolling.surfaces import Mesh, PairKernels, has_no_second_order, hoop_curvature

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class SecondOrder:
    """Terms of the contact conditions that depend on the solution, from the last iterate.

    Attributes
    ----------
    clearance : (n,) added to the gap [mm].
    creep_length : (n,) added to the interval lengths that multiply xi [mm].
    creep_offset : (n,) added to the creep [mm].
    traction : traction that gives the prescribed torque [N/mm]; None where no torque is prescribed.
    lean : line load that the shear takes off that of the pressure, as the interface is tilted:
        int q slope dx [N/mm].
    """

    clearance: Array
    creep_length: Array
    creep_offset: Array
    traction: float | None
    lean: float = 0.0

    def carried(self, old: Mesh, new: Mesh) -> SecondOrder:
        """Return these terms interpolated to another mesh, zone by zone if both have like zones."""
        matrices = carry(old.fine, new.fine)
        rates = self.creep_length / old.dx, self.creep_offset / old.dx
        if matrices is not None:
            nodes, intervals = matrices
            clearance = nodes @ self.clearance
            length, offset = (intervals @ rate for rate in rates)
        else:
            clearance = np.interp(new.inner, old.inner, self.clearance)
            middles, places = (0.5 * (x[1:-1] + x[2:]) for x in (old.nodes, new.nodes))
            length, offset = (np.interp(places, middles, rate) for rate in rates)
        return SecondOrder(clearance, new.dx * length, new.dx * offset, self.traction, self.lean)

    def change(
        self, before: SecondOrder, creepage: float, dx: Array, scales: tuple[float, float, float]
    ) -> float:
        """Return the largest relative change from ``before`` of gap, creep per length and traction.

        The change of the creep is a root mean square, as the strain right at an edge varies from
        mesh to mesh.

        Parameters
        ----------
        creepage : of the solution, as factor of the creep lengths.
        dx : (n,) lengths of the intervals [mm].
        scales : an approach [mm], a strain and a traction [N/mm] to which changes are relative.
        """
        approach, strain, traction = scales
        creep = self.creep_offset - before.creep_offset
        if not isnan(creepage):
            creep = creep + creepage * (self.creep_length - before.creep_length)
        changes = [
            float(np.abs(self.clearance - before.clearance).max()) / approach,
            sqrt(float(creep @ (creep / dx)) / float(dx.sum())) / strain,
        ]
        if self.traction is not None and before.traction is not None:
            changes.append(abs(self.traction - before.traction) / traction)
        return largest(*changes)


def contact_problem(nip: Nip, mesh: Mesh, second: SecondOrder) -> ContactProblem:
    """Return the contact problem of theory sections 5 and 6, linear in the tractions."""
    tangential = nip.tangential
    return ContactProblem(
        x=mesh.inner,
        weights=mesh.weights,
        clearance=0.5 * nip.curvature * mesh.inner**2 + second.clearance,
        influence=mesh.influence,
        creep_length=mesh.dx + second.creep_length,
        creep_offset=second.creep_offset,
        friction=nip.friction,
        control=Control(
            load=nip.normal.load + second.lean if isinstance(nip.normal, LineLoad) else None,
            approach=nip.normal.approach if isinstance(nip.normal, Approach) else None,
            traction=tangential.traction if isinstance(tangential, Traction) else second.traction,
            creepage=tangential.creepage if isinstance(tangential, Creepage) else None,
        ),
    )


def first_guess(nip: Nip, mesh: Mesh) -> SecondOrder:
    """Return zero second-order terms, and zero traction where a torque is prescribed."""
    zero = np.zeros(mesh.inner.size)
    return SecondOrder(zero, zero, zero, 0.0 if isinstance(nip.tangential, Torque) else None)


def second_order(nip: Nip, geometry: Geometry, mesh: Mesh, state: ContactState) -> SecondOrder:
    """Return the second-order terms that follow from a solution on a mesh."""
    if has_no_second_order(nip, geometry):
        return first_guess(nip, mesh)
    flat = mesh.linear_displacements(state)
    u = mesh.with_second(flat, state)
    guess = first_guess(nip, mesh)
    clearance, length, offset = guess.clearance, guess.creep_length, guess.creep_offset
    lean = 0.0
    if geometry in ("corrected", *FINITE):
        depth = sum(surface_depths(mesh.inner, nip, geometry, u.but_last()))
        approximate = 0.5 * nip.curvature * mesh.inner**2 + (flat.z_upper + flat.z_lower)[:-1]
        clearance = depth - approximate
    if geometry in RINGS and nip.friction > 0.0:
        length, offset = _stretch_terms(nip, geometry, mesh, flat, u)
    if geometry in FINITE:
        lean = _lean(nip, mesh, state, u)
    traction = guess.traction
    if isinstance(nip.tangential, Torque):
        traction = _traction_for_torque(nip, geometry, mesh, state, u)
    return SecondOrder(clearance, length, offset, traction, lean)


def surface_depths(x: Array, nip: Nip, geometry: Geometry, u: Displacements) -> tuple[Array, Array]:
    """Return the depth of each deformed surface below the tangent at first touch, (n,) each [mm].

    The approach is left out. At finite strain u_z belongs to the material that is at x after
    deformation: the radius there is R - u_z.
    """
    sides = (
        (nip.upper, u.x_upper, u.z_upper),
        (nip.lower, u.x_lower, u.z_lower),
    )
    depths = []
    for roller, u_x, u_z in sides:
        if geometry == "corrected":
            depths.append(sagitta(x, roller.curvature, u_x, u_z))
        elif geometry in FINITE and roller.core is None:
            depths.append(sagitta(x, roller.curvature, np.zeros_like(x), u_z))
        else:
            depths.append(0.5 * roller.curvature * x * x + u_z)
    return depths[0], depths[1]


def stretch_excess(x: Array, nip: Nip, geometry: Geometry, u: Displacements) -> Array:
    """Return int (stretch - 1) dx of the upper and lower surface per interval, (2, n - 1) [mm].

    It is 0 for a rigid roller.
    """
    rollers = (nip.upper, nip.lower)
    hoops = np.array([[hoop_curvature(roller, geometry)] for roller in rollers])
    is_whole = [roller.core is None and not roller.is_rigid for roller in rollers]
    if geometry in FINITE and all(is_whole):
        return second_stretch(x, hoops, *u.rows)
    excess = linear_stretch(x[1:] - x[:-1], hoops, *u.rows)
    if geometry in RINGS:
        excess += rotation_stretch(x[1:] - x[:-1], hoops, *u.rows)
    if geometry in FINITE:
        for out, whole, hoop, u_x, u_z in zip(excess, is_whole, hoops, *u.rows, strict=True):
            if whole:
                out[:] = second_stretch(x, hoop, u_x, u_z)
    return excess


def _stretch_terms(
    nip: Nip, geometry: Geometry, mesh: Mesh, flat: Displacements, u: Displacements
) -> tuple[Array, Array]:
    """Return ``creep_length`` and ``creep_offset`` of `SecondOrder` due to stretch [mm].

    The creep is the integral of (1 + xi/2) stretch_u - (1 - xi/2) stretch_l over an interval. The
    first term is the factor of xi minus the length of the interval; the second is the part
    independent of xi minus its linear part.
    """
    finer = mesh.finer(u)
    flat = finer if flat is u else mesh.finer(flat)
    linear, beyond = stretch_parts(mesh.fine.nodes[1:], nip, geometry, mesh.kernels, flat, finer)
    excess = linear + beyond
    return mesh.sums(0.5 * (excess[0] + excess[1])), mesh.sums(beyond[0] - beyond[1])


def stretch_parts(
    x: Array,
    nip: Nip,
    geometry: Geometry,
    kernels: PairKernels,
    flat: Displacements,
    u: Displacements,
) -> tuple[Array, Array]:
    """Return `stretch_excess` split into its linear part and the rest.

    The rest is that held by ``kernels`` if they hold a stretch. ``flat``: the linear part of the
    displacements ``u``.
    """
    dx, hoops = x[1:] - x[:-1], np.array(kernels.hoops)[:, None]
    linear, beyond = linear_stretch(dx, hoops, *flat.rows), kernels.held_stretch(x)
    if beyond is not None:
        return linear, beyond
    if geometry == "curved":
        return linear, rotation_stretch(dx, hoops, *u.rows)
    return linear, stretch_excess(x, nip, geometry, u) - linear


def creep_of(dx: Array, geometry: Geometry, excess: Array, creepage: float) -> Array:
    """Return the creep over intervals of lengths ``dx`` (n,), from `stretch_excess` (2, n) [mm].

    It is int (1 + xi/2) stretch_u - (1 - xi/2) stretch_l dx.
    """
    upper, lower = excess
    if geometry in ("linear", "corrected"):
        # At small strain the product of creepage and strain is neglected.
        return np.asarray(creepage * dx + upper - lower)
    half = 0.5 * creepage
    return np.asarray(creepage * dx + (1.0 + half) * upper - (1.0 - half) * lower)


def arc_ratio(x: Array, nip: Nip, geometry: Geometry, u: Displacements) -> Array | float:
    """Return the length of the deformed interface over dx in each interval, (n - 1,).

    It is 1 unless the strain is finite. Only then is x a place in the deformed state, and the shear
    a force per length of interface; otherwise the shear is a force per dx.
    """
    if geometry not in FINITE:
        return 1.0
    middle, dx = 0.5 * (x[1:] + x[:-1]), x[1:] - x[:-1]
    tilt = u.z_lower - u.z_upper
    slope = (nip.lower.curvature - nip.upper.curvature) * middle + (tilt[1:] - tilt[:-1]) / dx
    return np.asarray(np.sqrt(1.0 + 0.25 * slope**2))


def mean_shear(mesh: Mesh, state: ContactState) -> Array:
    """Return the mean acting shear on the intervals of the finer nodes[1:] [MPa]."""
    shear = mesh.acting(state.shear)
    return np.asarray(0.5 * (shear + np.append(shear[1:], 0.0)))


def transmitted(
    nip: Nip, geometry: Geometry, mesh: Mesh, state: ContactState, u: Displacements, slips: Bools
) -> tuple[Array, Array, tuple[Array, Array]]:
    """Return int q lambda ds of the upper and the lower surface, (2,) [N/mm], and what it is of.

    This is the power that the shear transmits, divided by the speed of that surface. Where surfaces
    slip, lambda includes the short waves cut from the correction, as these belong to the actual
    tractions; without them lambda would be that of other, smoother tractions.

    Parameters
    ----------
    u : displacements at nodes[1:].
    slips : (n,) whether the surfaces slip in each interval of the finer nodes[1:].

    Returns
    -------
    The two integrals; the mean shear in each of these intervals, per dx, (n,) [MPa]; and in each of
    them `stretch_excess` as solved, and with the short waves, (2, n) each.
    """
    x, finer, uncut = mesh.fine.nodes[1:], mesh.finer(u), mesh.uncut(u)
    shear = mean_shear(mesh, state) * arc_ratio(x, nip, geometry, finer)
    excess = stretch_excess(x, nip, geometry, finer)
    whole = excess if uncut is u else stretch_excess(x, nip, geometry, mesh.finer(uncut))
    pulls = (x[1:] - x[:-1] + np.where(slips, whole, excess)) @ shear
    return pulls, shear, (excess, whole)


def slip_intervals(x: Array, zones: tuple[ContactZone, ...]) -> Bools:
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
    p, q = mesh.acting(state.pressure), sign * mean_shear(mesh, state)
    p = 0.5 * (p + np.append(p[1:], 0.0))
    depth = surface_depths(x, nip, geometry, mesh.finer(u))[number]
    slope, height = np.diff(depth) / dx, 0.5 * (depth[1:] + depth[:-1])
    arm = 1.0 - roller.curvature * height
    along, down = q - p * slope, p + q * slope
    return float((arm * along + roller.curvature * middle * down) @ dx)


def loss_inside(side: Side, nip: Nip, geometry: Geometry, mesh: Mesh, state: ContactState) -> float:
    """Return the viscous loss inside one roller per distance rolled by its surface [N/mm].

    It is that of the linear fields under the tractions of the solution; geometry "finite" adds the
    contribution of all orders. In "second" it neglects a share as large as the strains.
    """
    roller, sign = (nip.upper, 1.0) if side == "upper" else (nip.lower, -1.0)
    if not roller.is_viscoelastic:
        return 0.0
    shear, pressure = sign * mesh.acting(state.shear), mesh.acting(state.pressure)
    tractions = SurfaceTractions.on_inner(mesh.fine.nodes, shear, pressure)
    further = mesh.kernels.heat_beyond[0 if side == "upper" else 1]
    return loss_per_distance(roller, tractions, geometry, nip.speed) + further


def _lean(nip: Nip, mesh: Mesh, state: ContactState, u: Displacements) -> float:
    """Return int q slope dx, with the mean slope of both surfaces as that of the interface."""
    levers = mesh.weights @ (state.shear * mesh.inner)
    undeformed = (nip.lower.curvature - nip.upper.curvature) * levers
    return 0.5 * float(undeformed + mesh.work(state.shear, u.z_lower - u.z_upper))


def _traction_for_torque(
    nip: Nip, geometry: Geometry, mesh: Mesh, state: ContactState, u: Displacements
) -> float:
    """Return T for which the lower torque R_l (w_l - int q lambda_l ds) is as prescribed [N/mm].

    It is nan where the second-order terms have diverged; such a solution is not verified.
    """
    assert isinstance(nip.tangential, Torque)
    zones = contact_zones(mesh.inner, state, nip.friction)
    slips = slip_intervals(mesh.fine.nodes[1:], zones)
    pull = float(transmitted(nip, geometry, mesh, state, u, slips)[0][1])
    if not isfinite(pull):
        return nan
    lost = loss_inside("lower", nip, geometry, mesh, state)
    wanted = nip.tangential.torque_lower * nip.lower.curvature
    return lost - wanted - (pull - float(mesh.weights @ state.shear))
