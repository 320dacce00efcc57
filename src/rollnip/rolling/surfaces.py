"""Influence functions of both rollers, and what the surfaces do on a mesh."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import ContactState, Subdivision
from rollnip.influence import (
    Kernel,
    KernelCache,
    SecondResponse,
    SurfaceKernels,
    covering_window,
    displacement_matrix,
    displacement_under,
    is_ring,
    load_weights,
)
from rollnip.model import Geometry
from rollnip.nip import Nip
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
    hoops : 1/R of the upper and the lower roller where its layers are rings, else 0 [1/mm].
    both : the influence functions of both as channels of one kernel; None where one is rigid.
    """

    upper: SurfaceKernels | None
    lower: SurfaceKernels | None
    second_upper: SecondResponse | None = None
    second_lower: SecondResponse | None = None
    held: SecondFields | None = None
    hoops: tuple[float, float] = (0.0, 0.0)
    both: Kernel | None = None

    @property
    def is_linear(self) -> bool:
        """Whether there is no second order."""
        return self.second_upper is None and self.second_lower is None

    def second_fields(self, nodes: Array, pressure: Array, shear: Array) -> SecondFields:
        """Second-order displacements under tractions at nodes[1:-1], as functions."""
        functions: list[Field | None] = []
        ends: list[tuple[float, float]] = []
        for response, sign in ((self.second_upper, 1.0), (self.second_lower, -1.0)):
            if response is None:
                functions += [None, None]
                ends += [(0.0, 0.0)] * 2
                continue
            functions += response.displacement(nodes, pressure, sign * shear)
            ends += [(float(response.x[0]), float(response.x[-1]))] * 2
        return SecondFields(tuple(functions), tuple(ends))


def pair_kernels(nip: Nip, geometry: Geometry, cache: KernelCache | None = None) -> PairKernels:
    """Tabulate the influence functions of both rollers on one window, or take them from a cache."""
    cache = KernelCache() if cache is None else cache
    window = covering_window((nip.upper, nip.lower), nip.speed)
    upper, lower = (
        None if roller.is_rigid else cache.surface(roller, nip.speed, geometry, window)
        for roller in (nip.upper, nip.lower)
    )
    hoops = hoop_curvature(nip.upper, geometry), hoop_curvature(nip.lower, geometry)
    both = None
    if upper is not None and lower is not None:
        both = Kernel.stacked((upper.xx, upper.zz, upper.xz, lower.xx, lower.zz, lower.xz))
    return PairKernels(upper, lower, hoops=hoops, both=both)


def hoop_curvature(roller: Roller, geometry: Geometry) -> float:
    """1/R in the stretch of the surface; 0 where the layers are taken as flat."""
    return roller.curvature if is_ring(roller, geometry) else 0.0


def with_second_order(
    kernels: PairKernels, nip: Nip, geometry: Geometry, half_width: float, cache: KernelCache
) -> PairKernels:
    """Add what the second order of "finite" needs, on grids fit for a contact of that size."""
    if geometry != "finite":
        return kernels
    upper, lower = (
        None if roller.is_rigid or roller.core else cache.second(roller, nip.speed, half_width)
        for roller in (nip.upper, nip.lower)
    )
    return replace(kernels, second_upper=upper, second_lower=lower)


@dataclass(frozen=True, slots=True)
class SurfaceMatrices:
    """Displacements of one surface at some points per nodal traction of its own frame.

    u_x = xx t_x + xz t_z and u_z = -xz t_x + zz t_z.

    Attributes
    ----------
    stack : (3, points, N-1) xx, zz and xz [mm/MPa]; None: a rigid surface.
    count : points.
    """

    stack: Array | None
    count: int

    @property
    def xx(self) -> Array:
        """(points, N-1) [mm/MPa]; not of a rigid surface."""
        assert self.stack is not None
        return np.asarray(self.stack[0])

    @property
    def zz(self) -> Array:
        """(points, N-1) [mm/MPa]; not of a rigid surface."""
        assert self.stack is not None
        return np.asarray(self.stack[1])

    @property
    def xz(self) -> Array:
        """(points, N-1) [mm/MPa]; not of a rigid surface."""
        assert self.stack is not None
        return np.asarray(self.stack[2])

    def under(self, pressure: Array, shear: Array) -> tuple[Array, Array]:
        """u_x and u_z under nodal tractions of the surface's own frame, each (points,) [mm]."""
        if self.stack is None:
            return np.zeros(self.count), np.zeros(self.count)
        tractions = np.empty((pressure.size, 2))
        tractions[:, 0], tractions[:, 1] = pressure, shear
        made = self.stack.reshape(-1, pressure.size) @ tractions
        (_, xx), (zz, _), (xz, zx) = made.reshape(3, self.count, 2).transpose(0, 2, 1)
        return xz + xx, zz - zx


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
        cls, upper: SurfaceMatrices, lower: SurfaceMatrices, pressure: Array, shear: Array
    ) -> Displacements:
        """Under the tractions of a solution: (q, p) on the upper surface, (-q, p) on the lower."""
        return cls(*upper.under(pressure, shear), *lower.under(pressure, -shear))


@dataclass(frozen=True, slots=True)
class Mesh:
    """Nodes, and what the surfaces do at nodes[1:] under unit tractions at nodes[1:-1].

    Attributes
    ----------
    nodes : (N+1,) [mm].
    fine : nodes between which the tractions are linear.
    upper, lower : displacements of either surface.
    influence : what a contact problem on these nodes makes of them.
    kernels : the influence functions they come from.
    held : second-order displacements at nodes[1:] that the kernels hold; None: they hold none.
    """

    nodes: Array
    fine: Subdivision
    upper: SurfaceMatrices
    lower: SurfaceMatrices
    influence: Array
    kernels: PairKernels
    held: Displacements | None

    @property
    def inner(self) -> Array:
        """Nodes that carry tractions, (N-1,) [mm]."""
        return self.nodes[1:-1]

    @property
    def dx(self) -> Array:
        """Lengths of the intervals between nodes[1:], (N-1,) [mm]."""
        return self.nodes[2:] - self.nodes[1:-1]

    @property
    def weights(self) -> Array:
        """Load of each nodal traction, (N-1,) [mm]."""
        fine = load_weights(self.fine.nodes)
        values = self.fine.values
        return fine if values is None else np.asarray(fine @ values[1:-1, 1:-1])

    def between(self, traction: Array) -> Array:
        """A traction at nodes[1:-1] as its values at the finer nodes, without both ends."""
        values = self.fine.values
        return traction if values is None else np.asarray(values[1:-1, 1:-1] @ traction)

    def work(self, traction: Array, displacement: Array) -> float:
        """Int t du of a traction at nodes[1:-1] and a displacement at nodes[1:]."""
        values = self.fine.values
        if values is not None:
            displacement = values[1:, 1:] @ displacement
        return pressure_work(self.between(traction), displacement)

    def finer(self, u: Displacements) -> Displacements:
        """Displacements at nodes[1:] carried on to the finer nodes but the first."""
        values = self.fine.values
        if values is None:
            return u
        four = np.stack([u.x_upper, u.z_upper, u.x_lower, u.z_lower], axis=1)
        return Displacements(*np.ascontiguousarray((values[1:, 1:] @ four).T))

    def sums(self, pieces: Array) -> Array:
        """Over the intervals of nodes[1:], of what belongs to those of the finer nodes."""
        return _sums(self.nodes, self.fine, pieces)

    def linear(self, state: ContactState) -> Displacements:
        """Displacements at nodes[1:], linear in the tractions."""
        return Displacements.under(self.upper, self.lower, state.pressure, state.shear)

    def displacements(self, state: ContactState) -> Displacements:
        """Displacements at nodes[1:], to the order of the model."""
        return self.with_second(self.linear(state), state)

    def with_second(self, linear: Displacements, state: ContactState) -> Displacements:
        """The linear displacements of a solution with those of second order, if there are any."""
        if self.kernels.is_linear:
            return linear
        held = self.held
        return linear + (self.second(state, self.nodes[1:]) if held is None else held)

    def holding(self, kernels: PairKernels) -> Mesh:
        """The same mesh with the second order that other influence functions hold."""
        return replace(self, kernels=kernels, held=_held_at(self.nodes, kernels))

    def second(self, state: ContactState, x: Array) -> Displacements:
        """Second-order displacements at ``x``: those held, or of the tractions of a solution."""
        held = self.kernels.held
        return (self.second_fields(state) if held is None else held).at(x)

    def second_fields(self, state: ContactState) -> SecondFields:
        """Second-order displacements under the tractions of a solution, as functions."""
        p, q = self.between(state.pressure), self.between(state.shear)
        return self.kernels.second_fields(self.fine.nodes, p, q)


def pressure_work(traction: Array, displacement: Array) -> float:
    """Int t du for a traction at nodes[1:-1] (0 at both ends) and u at nodes[1:]."""
    means = 0.5 * (traction + np.append(traction[1:], 0.0))
    return float(means @ (displacement[1:] - displacement[:-1]))


def mesh_on(nodes: Array, kernels: PairKernels, fine: Subdivision | None = None) -> Mesh:
    """Evaluate the influence functions of both surfaces on a mesh.

    Without ``fine`` tractions are linear between the nodes themselves.
    """
    fine = Subdivision(nodes) if fine is None else fine
    upper, lower = pair_matrices(kernels, nodes[1:], fine)
    influence = _influence(nodes, fine, upper, lower, kernels.hoops)
    return Mesh(nodes, fine, upper, lower, influence, kernels, _held_at(nodes, kernels))


def _held_at(nodes: Array, kernels: PairKernels) -> Displacements | None:
    return None if kernels.held is None else kernels.held.at(nodes[1:])


def pair_matrices(
    kernels: PairKernels, points: Array, fine: Subdivision
) -> tuple[SurfaceMatrices, SurfaceMatrices]:
    """Displacements of both surfaces at ``points`` per unit traction at the nodes subdivided."""
    if kernels.both is not None:
        six = _displacements_per(kernels.both, points, fine)
        return SurfaceMatrices(six[:3], points.size), SurfaceMatrices(six[3:], points.size)
    upper, lower = (
        SurfaceMatrices(
            None if surface is None else _displacements_per(surface.together, points, fine),
            points.size,
        )
        for surface in (kernels.upper, kernels.lower)
    )
    return upper, lower


def _displacements_per(kernel: Kernel, points: Array, fine: Subdivision) -> Array:
    """Displacement at ``points`` per unit traction at the inner nodes subdivided, by channel."""
    if fine.values is None:
        return displacement_matrix(kernel, points, fine.nodes)
    return displacement_under(kernel, points, fine.nodes, fine.values[1:-1, 1:-1])


def _influence(
    nodes: Array,
    fine: Subdivision,
    upper: SurfaceMatrices,
    lower: SurfaceMatrices,
    hoops: tuple[float, float],
) -> Array:
    """Gap and creep per nodal pressure and shear (theory section 5), `ContactProblem.influence`.

    The creep of an interval is the upper less the lower int (du_x/dx - u_z/R) dx.
    """
    n = nodes.size - 2
    out = np.zeros((2 * n, 2 * n))
    integrals = _integrals(nodes, fine) if any(hoops) and fine.values is not None else None
    # The pressure is the same on both surfaces, the shear the opposite.
    for surface, hoop, sign in ((upper, hoops[0], 1.0), (lower, hoops[1], -1.0)):
        if surface.stack is None:
            continue
        xx, zz, xz = surface.stack
        out[:n, :n] += zz[:-1]
        out[:n, n:] -= sign * xz[:-1]
        out[n:, :n] += sign * (xz[1:] - xz[:-1])
        out[n:, n:] += xx[1:] - xx[:-1]
        if hoop:
            out[n:, :n] -= sign * hoop * _integrated(nodes, zz, integrals)
            out[n:, n:] += hoop * _integrated(nodes, xz, integrals)
    return out


def _integrals(nodes: Array, fine: Subdivision) -> Array:
    """Int f dx over each interval of nodes[1:] per value of f there, (N-1, N) [mm]."""
    assert fine.values is not None
    values = fine.values[1:, 1:]
    dx = np.diff(fine.nodes[1:])[:, None]
    return _sums(nodes, fine, 0.5 * dx * (values[1:] + values[:-1]))


def _integrated(nodes: Array, values: Array, integrals: Array | None) -> Array:
    """Int f dx over each interval of nodes[1:] of functions with ``values`` there, (N, n)."""
    if integrals is not None:
        return np.asarray(integrals @ values)
    dx = (nodes[2:] - nodes[1:-1])[:, None]
    return np.asarray(0.5 * dx * (values[1:] + values[:-1]))


def _sums(nodes: Array, fine: Subdivision, pieces: Array) -> Array:
    """Sums over the intervals of nodes[1:] of what belongs to those of the finer nodes."""
    if fine.values is None:
        return pieces
    starts = np.searchsorted(fine.nodes[1:-1], nodes[1:-1] - 1e-12 * (nodes[-1] - nodes[0]))
    return np.asarray(np.add.reduceat(pieces, starts, axis=0))
