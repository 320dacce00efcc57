"""From a nip, its influence functions and a mesh to a discrete contact problem."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import ContactProblem, ContactState, Control
from rollnip.geometry import (
    linear_stretch,
    mean_of_neighbours,
    rotation_stretch,
    sagitta,
    second_stretch,
)
from rollnip.influence import (
    SecondResponse,
    SurfaceKernels,
    covering_window,
    displacement_matrix,
    is_ring,
    load_weights,
    second_response,
    surface_kernels,
)
from rollnip.model import Geometry
from rollnip.nip import Approach, Creepage, LineLoad, Nip, Torque, Traction
from rollnip.rollers import Roller

Array = NDArray[np.float64]


Field = Callable[[Array], Array]


@dataclass(frozen=True, slots=True)
class SecondFields:
    """Second-order displacements of both surfaces under given tractions, as functions of x.

    Attributes
    ----------
    functions : u_x and u_z of the upper, u_x and u_z of the lower surface; None: zero.
    ends : the places between which they hold [mm]; beyond they keep their last value.
    """

    functions: tuple[Field | None, ...]
    ends: tuple[tuple[float, float], ...]

    def at(self, x: Array) -> Displacements:
        """Displacements at some places."""
        return Displacements(
            *(
                np.zeros(x.size) if f is None else np.asarray(f(np.clip(x, *ends)))
                for f, ends in zip(self.functions, self.ends, strict=True)
            )
        )


NO_SECOND_ORDER = SecondFields((None,) * 4, ((0.0, 0.0),) * 4)


@dataclass(frozen=True, slots=True)
class PairKernels:
    """Influence functions of both surfaces; None for a bare rigid roller.

    Attributes
    ----------
    upper, lower : linear.
    second_upper, second_lower : to second order; None also where the model leaves it out.
    held : second-order displacements to use whatever the tractions; None: always those of the
        tractions at hand.
    """

    upper: SurfaceKernels | None
    lower: SurfaceKernels | None
    second_upper: SecondResponse | None = None
    second_lower: SecondResponse | None = None
    held: SecondFields | None = None

    @property
    def is_linear(self) -> bool:
        """Whether there is no second order."""
        return self.second_upper is None and self.second_lower is None

    def second(self, nodes: Array, state: ContactState, x: Array) -> Displacements:
        """Second-order displacements at ``x`` under the tractions of a solution."""
        held = self.second_fields(nodes, state) if self.held is None else self.held
        return held.at(x)

    def second_fields(self, nodes: Array, state: ContactState) -> SecondFields:
        """Second-order displacements under the tractions of a solution, as functions."""
        functions: list[Field | None] = []
        ends: list[tuple[float, float]] = []
        for response, sign in ((self.second_upper, 1.0), (self.second_lower, -1.0)):
            if response is None:
                functions += [None, None]
                ends += [(0.0, 0.0)] * 2
                continue
            functions += response.displacement(nodes, state.pressure, sign * state.shear)
            ends += [(float(response.x[0]), float(response.x[-1]))] * 2
        return SecondFields(tuple(functions), tuple(ends))


def pair_kernels(nip: Nip, geometry: Geometry) -> PairKernels:
    """Tabulate the influence functions of both rollers on one window."""
    window = covering_window((nip.upper, nip.lower), nip.speed)
    upper, lower = (
        None if roller.is_rigid else surface_kernels(roller, nip.speed, geometry, window)
        for roller in (nip.upper, nip.lower)
    )
    return PairKernels(upper, lower)


def with_second_order(
    kernels: PairKernels, nip: Nip, geometry: Geometry, half_width: float
) -> PairKernels:
    """Add what the second order of "finite" needs, on grids fit for a contact of that size."""
    if geometry != "finite":
        return kernels
    upper, lower = (
        None if roller.is_rigid or roller.core else second_response(roller, nip.speed, half_width)
        for roller in (nip.upper, nip.lower)
    )
    return replace(kernels, second_upper=upper, second_lower=lower)


@dataclass(frozen=True, slots=True)
class SurfaceMatrices:
    """Displacements of one surface at some points per nodal traction of its own frame.

    u_x = xx t_x + xz t_z and u_z = -xz t_x + zz t_z; each (points, N-1) [mm/MPa].
    """

    xx: Array
    zz: Array
    xz: Array


@dataclass(frozen=True, slots=True)
class Displacements:
    """Displacements of both surfaces, each in its own frame, at some points [mm]."""

    x_upper: Array
    z_upper: Array
    x_lower: Array
    z_lower: Array

    def __add__(self, other: Displacements) -> Displacements:
        return Displacements(
            self.x_upper + other.x_upper,
            self.z_upper + other.z_upper,
            self.x_lower + other.x_lower,
            self.z_lower + other.z_lower,
        )

    def but_last(self) -> Displacements:
        """At all points but the last."""
        return Displacements(
            self.x_upper[:-1], self.z_upper[:-1], self.x_lower[:-1], self.z_lower[:-1]
        )

    @classmethod
    def under(
        cls, upper: SurfaceMatrices, lower: SurfaceMatrices, state: ContactState
    ) -> Displacements:
        """Under the tractions of a solution: (q, p) on the upper surface, (-q, p) on the lower."""
        p, q = state.pressure, state.shear
        return cls(
            x_upper=upper.xz @ p + upper.xx @ q,
            z_upper=upper.zz @ p - upper.xz @ q,
            x_lower=lower.xz @ p - lower.xx @ q,
            z_lower=lower.zz @ p + lower.xz @ q,
        )


@dataclass(frozen=True, slots=True)
class Mesh:
    """Nodes, and what the surfaces do at nodes[1:] under unit tractions at nodes[1:-1]."""

    nodes: Array
    upper: SurfaceMatrices
    lower: SurfaceMatrices
    kernels: PairKernels

    @property
    def inner(self) -> Array:
        """Nodes that carry tractions, (N-1,) [mm]."""
        return self.nodes[1:-1]

    @property
    def dx(self) -> Array:
        """Lengths of the intervals between nodes[1:], (N-1,) [mm]."""
        return np.diff(self.nodes[1:])

    def linear(self, state: ContactState) -> Displacements:
        """Displacements at nodes[1:], linear in the tractions."""
        return Displacements.under(self.upper, self.lower, state)

    def displacements(self, state: ContactState) -> Displacements:
        """Displacements at nodes[1:], to the order of the model."""
        return self.linear(state) + self.kernels.second(self.nodes, state, self.nodes[1:])


def mesh_on(nodes: Array, kernels: PairKernels) -> Mesh:
    """Evaluate the influence functions of both surfaces on a mesh."""
    points = nodes[1:]
    return Mesh(
        nodes,
        surface_matrices(kernels.upper, points, nodes),
        surface_matrices(kernels.lower, points, nodes),
        kernels,
    )


def surface_matrices(
    kernels: SurfaceKernels | None, points: Array, nodes: Array
) -> SurfaceMatrices:
    """Displacements at ``points`` per unit traction at nodes[1:-1]; zero for a rigid roller."""
    if kernels is None:
        zero = np.zeros((points.size, nodes.size - 2))
        return SurfaceMatrices(zero, zero, zero)
    return SurfaceMatrices(*displacement_matrix(kernels.together, points, nodes))


@dataclass(frozen=True, slots=True)
class SecondOrder:
    """Terms that depend on the solution itself, taken from the last one.

    Attributes
    ----------
    clearance : (n,) added to the gap [mm].
    creep_length : (n,) added to the interval lengths that multiply xi [mm].
    creep_offset : (n,) added to the creep [mm].
    traction : the traction that gives the wanted torque [N/mm]; None where no torque is wanted.
    lean : line load that the shear takes from the pressure, int q slope dx [N/mm].
    """

    clearance: Array
    creep_length: Array
    creep_offset: Array
    traction: float | None
    lean: float = 0.0

    def change(self, before: SecondOrder, approach: float, strain: Array, traction: float) -> float:
        """Largest change since ``before``, relative to an approach, strains and a traction."""
        changes = [
            np.max(np.abs(self.clearance - before.clearance)) / max(abs(approach), 1e-300),
            np.max(np.abs(self.creep_offset - before.creep_offset) / strain),
            np.max(np.abs(self.creep_length - before.creep_length) / strain),
        ]
        if self.traction is not None and before.traction is not None:
            changes.append(abs(self.traction - before.traction) / traction)
        return float(np.max(changes))


def hoop_curvature(roller: Roller, geometry: Geometry) -> float:
    """1/R in the stretch of the surface; 0 where the layers are taken as flat."""
    return roller.curvature if is_ring(roller, geometry) else 0.0


def contact_problem(
    nip: Nip, geometry: Geometry, mesh: Mesh, second: SecondOrder
) -> ContactProblem:
    """Theory sections 5 and 6: gap and creep, linear in the tractions."""
    upper, lower = mesh.upper, mesh.lower
    creep_pressure = np.diff(upper.xz - lower.xz, axis=0)
    creep_shear = np.diff(upper.xx + lower.xx, axis=0)
    hoop_u, hoop_l = (hoop_curvature(r, geometry) for r in (nip.upper, nip.lower))
    if hoop_u or hoop_l:
        dx = mesh.dx[:, None]
        creep_pressure -= dx * mean_of_neighbours(hoop_u * upper.zz - hoop_l * lower.zz)
        creep_shear += dx * mean_of_neighbours(hoop_u * upper.xz + hoop_l * lower.xz)
    return ContactProblem(
        x=mesh.inner,
        weights=load_weights(mesh.nodes),
        clearance=0.5 * nip.curvature * mesh.inner**2 + second.clearance,
        normal_pressure=(upper.zz + lower.zz)[:-1],
        normal_shear=(lower.xz - upper.xz)[:-1],
        creep_pressure=creep_pressure,
        creep_shear=creep_shear,
        creep_length=mesh.dx + second.creep_length,
        creep_offset=second.creep_offset,
        friction=nip.friction,
        control=_control(nip, second),
    )


def first_guess(nip: Nip, mesh: Mesh) -> SecondOrder:
    """No second-order terms yet; free rolling where a torque is wanted."""
    zero = np.zeros(mesh.inner.size)
    return SecondOrder(zero, zero, zero, 0.0 if isinstance(nip.tangential, Torque) else None)


def second_order(nip: Nip, geometry: Geometry, mesh: Mesh, state: ContactState) -> SecondOrder:
    """Second-order terms of a solution on a mesh."""
    u = mesh.displacements(state)
    guess = first_guess(nip, mesh)
    clearance, length, offset = guess.clearance, guess.creep_length, guess.creep_offset
    lean = 0.0
    if geometry in ("corrected", "finite"):
        flat = mesh.linear(state)
        depth = sum(surface_depths(mesh.inner, nip, geometry, u.but_last()))
        approximate = 0.5 * nip.curvature * mesh.inner**2 + (flat.z_upper + flat.z_lower)[:-1]
        clearance = depth - approximate
    if geometry in ("curved", "finite"):
        length, offset = _stretch_terms(nip, geometry, mesh, state, u)
    if geometry == "finite":
        lean = _lean(nip, mesh, state, u)
    traction = guess.traction
    if isinstance(nip.tangential, Torque):
        traction = _traction_for_torque(nip, geometry, mesh, state, u)
    return SecondOrder(clearance, length, offset, traction, lean)


def _control(nip: Nip, second: SecondOrder) -> Control:
    normal, tangential = nip.normal, nip.tangential
    traction = tangential.traction if isinstance(tangential, Traction) else second.traction
    creepage = tangential.creepage if isinstance(tangential, Creepage) else None
    return Control(
        load=normal.load + second.lean if isinstance(normal, LineLoad) else None,
        approach=normal.approach if isinstance(normal, Approach) else None,
        traction=traction,
        creepage=creepage,
    )


def surface_depths(x: Array, nip: Nip, geometry: Geometry, u: Displacements) -> tuple[Array, Array]:
    """How far each surface lies from the tangent at first touch, before the approach [mm].

    In "finite" u_z is that of the material that is at x now: the radius there is R - u_z.
    """
    sides = (
        (nip.upper, u.x_upper, u.z_upper),
        (nip.lower, u.x_lower, u.z_lower),
    )
    depths = []
    for roller, u_x, u_z in sides:
        if geometry == "corrected":
            depths.append(sagitta(x, roller.curvature, u_x, u_z))
        elif geometry == "finite" and roller.core is None:
            depths.append(sagitta(x, roller.curvature, np.zeros_like(x), u_z))
        else:
            depths.append(0.5 * roller.curvature * x * x + u_z)
    return depths[0], depths[1]


def stretch_excess(x: Array, nip: Nip, geometry: Geometry, u: Displacements, *, side: str) -> Array:
    """Int (stretch - 1) dx of one surface over each interval [mm]."""
    dx = np.diff(x)
    roller = nip.upper if side == "upper" else nip.lower
    u_x, u_z = (u.x_upper, u.z_upper) if side == "upper" else (u.x_lower, u.z_lower)
    if roller.is_rigid:
        return np.zeros(dx.size)
    hoop = hoop_curvature(roller, geometry)
    if geometry == "finite" and roller.core is None:
        return second_stretch(x, hoop, u_x, u_z)
    excess = linear_stretch(dx, hoop, u_x, u_z)
    if geometry in ("curved", "finite"):
        excess = excess + rotation_stretch(dx, hoop, u_x, u_z)
    return excess


def _stretch_terms(
    nip: Nip, geometry: Geometry, mesh: Mesh, state: ContactState, u: Displacements
) -> tuple[Array, Array]:
    """What the creep (1 + xi/2) stretch_u - (1 - xi/2) stretch_l has beyond its linear part."""
    flat = mesh.linear(state)
    upper = stretch_excess(mesh.nodes[1:], nip, geometry, u, side="upper")
    lower = stretch_excess(mesh.nodes[1:], nip, geometry, u, side="lower")
    hoop_u, hoop_l = (hoop_curvature(roller, geometry) for roller in (nip.upper, nip.lower))
    linear = linear_stretch(mesh.dx, hoop_u, flat.x_upper, flat.z_upper)
    linear -= linear_stretch(mesh.dx, hoop_l, flat.x_lower, flat.z_lower)
    return 0.5 * (upper + lower), upper - lower - linear


def _lean(nip: Nip, mesh: Mesh, state: ContactState, u: Displacements) -> float:
    """Int q slope dx, the slope of the interface that of both surfaces on average."""
    levers = load_weights(mesh.nodes) @ (state.shear * mesh.inner)
    undeformed = (nip.lower.curvature - nip.upper.curvature) * levers
    return 0.5 * float(undeformed + pressure_work(state.shear, u.z_lower - u.z_upper))


def _traction_for_torque(
    nip: Nip, geometry: Geometry, mesh: Mesh, state: ContactState, u: Displacements
) -> float:
    """T at which the lower torque R_l (-int q (1 - u_z/R_l) dx - int p du_z) is the wanted one."""
    assert isinstance(nip.tangential, Torque)
    lower = nip.lower
    leaning = pressure_work(state.pressure, u.z_lower)
    traction = -nip.tangential.torque_lower * lower.curvature - leaning
    if geometry != "linear":
        weights = load_weights(mesh.nodes)
        traction += lower.curvature * float(weights @ (state.shear * u.z_lower[:-1]))
    return traction


def pressure_work(traction: Array, displacement: Array) -> float:
    """Int t du for a traction at nodes[1:-1] (0 at both ends) and u at nodes[1:]."""
    means = 0.5 * (traction + np.append(traction[1:], 0.0))
    return float(means @ np.diff(displacement))
