"""Influence functions of both rollers, and displacements of the surfaces on a mesh."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import ClassVar, Self

import numpy as np

from rollnip.contact import ContactState, Subdivision
from rollnip.contact.problem import Array, Mask
from rollnip.influence import (
    Ellipses,
    Kernel,
    KernelCache,
    SecondResponse,
    SurfaceKernels,
    covering_window,
    displacement_under,
    is_ring,
    load_weights,
)
from rollnip.model import Geometry
from rollnip.nip import Nip
from rollnip.rollers import Roller
from rollnip.rolling.displacements import Displacements, Field, SecondFields
from rollnip.rolling.influence_matrix import (
    hoop_shortening,
    influence_matrix,
    unit_tractions,
)


@dataclass(frozen=True, slots=True)
class PairKernels:
    """Influence functions of both surfaces; None for a bare rigid roller.

    Attributes
    ----------
    upper, lower : of the linear displacements.
    second_upper, second_lower : of those of second order; None also where the model neglects them.
    held : displacements beyond the linear ones, kept fixed whatever the tractions; None: compute
        them from the tractions.
    hoops : 1/R of the upper and the lower roller where its layers are rings, else 0 [1/mm].
    together : xx, zz and xz of the upper, then of the lower surface, as channels of one kernel;
        without those of a rigid one.
    pressed : sum of u_z of both surfaces under elliptic pressures on contacts of any width up to
        the smaller radius.
    """

    upper: SurfaceKernels | None
    lower: SurfaceKernels | None
    together: Kernel
    pressed: Ellipses
    second_upper: SecondResponse | None = None
    second_lower: SecondResponse | None = None
    held: SecondFields | None = None
    hoops: tuple[float, float] = (0.0, 0.0)

    @property
    def heat_beyond(self) -> tuple[float, float]:
        """Viscous loss in the upper and the lower roller beyond the linear one [N/mm]."""
        return (0.0, 0.0) if self.held is None else self.held.lost

    @property
    def is_linear(self) -> bool:
        """Return whether neither surface has a displacement beyond the linear one."""
        return self.is_fixed and self.held is None

    @property
    def is_fixed(self) -> bool:
        """Return whether displacements beyond the linear ones, if any, are held fixed."""
        return self.second_upper is None and self.second_lower is None

    def held_stretch(self, x: Array) -> Array | None:
        """Return int of the held stretch beyond the linear one, (2, n-1); None if none is held."""
        if self.held is None or self.held.stretch is None:
            return None
        return np.stack([one.over(x) for one in self.held.stretch])

    def second_fields(self, nodes: Array, pressure: Array, shear: Array) -> SecondFields:
        """Return the displacements beyond the linear ones due to tractions at nodes[1:-1]."""
        functions: list[Field | None] = []
        ends: list[tuple[float, float]] = []
        sides = (self.upper, self.second_upper, 1.0), (self.lower, self.second_lower, -1.0)
        for surface, response, sign in sides:
            if surface is None or response is None:
                functions += [None, None]
                ends += [(0.0, 0.0)] * 2
                continue
            own = nodes, pressure, sign * shear
            if response.is_short:
                functions += response.displacement(*own, surface.inward_at(0.0, *own))
            else:
                functions += response.displacement(*own)
            ends += [(float(response.x[0]), float(response.x[-1]))] * 2
        return SecondFields(tuple(functions), tuple(ends))


def pair_kernels(nip: Nip, geometry: Geometry, cache: KernelCache | None = None) -> PairKernels:
    """Return the influence functions of both rollers, tabulated on one window or from a cache."""
    cache = KernelCache() if cache is None else cache
    make = partial(_pair_kernels, nip, geometry, cache)
    return cache.pair((nip.upper, nip.lower), nip.speed, geometry, make)


def _pair_kernels(nip: Nip, geometry: Geometry, cache: KernelCache) -> PairKernels:
    window = covering_window((nip.upper, nip.lower), nip.speed)
    upper, lower = (
        None if roller.is_rigid else cache.surface(roller, nip.speed, geometry, window)
        for roller in (nip.upper, nip.lower)
    )
    hoops = hoop_curvature(nip.upper, geometry), hoop_curvature(nip.lower, geometry)
    parts = [surface for surface in (upper, lower) if surface is not None]
    if len(parts) == 1:
        together, normal = parts[0].together, parts[0].zz
    else:
        together = Kernel.stacked((parts[0].together, parts[1].together))
        normal = parts[0].zz + parts[1].zz
    pressed = Ellipses.under(normal, min(nip.upper.radius, nip.lower.radius))
    return PairKernels(upper, lower, together, pressed, hoops=hoops)


def hoop_curvature(roller: Roller, geometry: Geometry) -> float:
    """Return 1/R in the stretch of the surface; 0 where the layers are taken as flat."""
    return roller.curvature if is_ring(roller, geometry) else 0.0


@dataclass(frozen=True, slots=True)
class Mesh:
    """A mesh, and the response of both surfaces at nodes[1:] to unit tractions at nodes[1:-1].

    Attributes
    ----------
    nodes : (N+1,) [mm].
    fine : nodes between which the tractions are linear.
    inner : (N-1,) nodes that carry tractions [mm].
    dx : (N-1,) lengths of the intervals between nodes[1:] [mm].
    weights : (N-1,) load of each nodal traction [mm].
    per_traction : (6, N, N-1) displacements of both surfaces, see `pair_displacements` [mm/MPa].
    influence : of a contact problem on these nodes; empty with a sheet.
    kernels : the influence functions evaluated.
    held : displacements beyond the linear ones at nodes[1:] that ``kernels`` hold; None: none.
    """

    nodes: Array
    fine: Subdivision
    inner: Array
    dx: Array
    weights: Array
    per_traction: Array
    influence: Array
    kernels: PairKernels
    held: Displacements | None
    is_bare: ClassVar[bool] = True  # whether the rollers touch, without a sheet between them

    @classmethod
    def on(cls, nodes: Array, kernels: PairKernels, fine: Subdivision | None = None) -> Self:
        """Return the mesh with the influence functions of both surfaces evaluated on it.

        Without ``fine`` tractions are linear between the nodes themselves.
        """
        fine = Subdivision(nodes) if fine is None else fine
        unit = unit_tractions(fine)
        per_traction, n = pair_displacements(kernels, nodes[1:], fine.nodes, unit), nodes.size - 2
        influence = np.empty((0, 0))
        if cls.is_bare:
            xx_u, zz_u, xz_u, xx_l, zz_l, xz_l = per_traction
            both = np.array([zz_u + zz_l, xz_u - xz_l, xx_u + xx_l])
            per_traction = np.ascontiguousarray(per_traction[:, :, :n])
            influence = influence_matrix(fine, both, hoop_shortening(per_traction, kernels.hoops))
        weights = load_weights(fine.nodes)
        return cls(
            nodes=nodes,
            fine=fine,
            inner=nodes[1:-1],
            dx=nodes[2:] - nodes[1:-1],
            weights=weights if unit is None else weights @ unit[:, :n],
            per_traction=per_traction,
            influence=influence,
            kernels=kernels,
            held=_held_at(nodes, kernels),
        )

    def acting(self, traction: Array) -> Array:
        """Return the traction that acts at the finer nodes[1:-1], see `Subdivision`."""
        acting = self.fine.acting
        return traction if acting is None else np.asarray(acting[1:-1, 1:-1] @ traction)

    def between(self, traction: Array) -> Array:
        """Return a traction at nodes[1:-1] interpolated to the finer nodes[1:-1]."""
        values = self.fine.values
        return traction if values is None else np.asarray(values[1:-1, 1:-1] @ traction)

    def has_tension_at_edge(self, pressure: Array) -> bool:
        """Return whether there is tension in the elements at the edges.

        An edge that lies too far out by delta has p ~ sqrt(y) - delta/(2 sqrt(y)) beside it, which
        is negative where y < delta/2. So tension shows an error of part of that element, which
        beside a short zone is far less than the tolerance.

        ``pressure``: at nodes[1:-1] of the mesh [MPa].
        """
        return bool(np.any(self.acting(pressure)[self.is_beside_edge] < 0.0))

    def peaks_at_edge(self, pressure: Array) -> bool:
        """Return whether the pressure is highest in the element at an edge, or at its inner node.

        An edge that lies too far in by delta has p ~ sqrt(y) + delta/(2 sqrt(y)) beside it. In a
        short enough element this exceeds all other pressures: not a peak but a singularity, which
        grows with finer meshes.

        ``pressure``: at nodes[1:-1] of the mesh [MPa].
        """
        edges, highest = self.fine.edges, int(pressure.argmax())
        if highest - 1 in edges[::2] or highest + 1 in edges[1::2]:
            return True
        return bool(self.is_beside_edge[self.acting(pressure).argmax()])

    @property
    def is_beside_edge(self) -> Mask:
        """Return which of the finer nodes[1:-1] lie at an edge or in the element inside it."""
        edges, pieces = self.fine.edges, self.fine.pieces
        out = np.zeros(self.fine.nodes.size - 2, dtype=bool)
        for trailing, leading in zip(edges[::2], edges[1::2], strict=True):
            out[pieces * trailing : pieces * (trailing + 1)] = True
            out[pieces * (leading - 1) + 1 : pieces * leading + 1] = True
        return out

    def work(self, traction: Array, displacement: Array) -> float:
        """Return int t du of a traction at nodes[1:-1] and a displacement at nodes[1:]."""
        values = self.fine.values
        if values is not None:
            displacement = values[1:, 1:] @ displacement
        return traction_work(self.acting(traction), displacement)

    def finer(self, u: Displacements) -> Displacements:
        """Return displacements at nodes[1:] interpolated to the finer nodes[1:]."""
        values = self.fine.values
        return u if values is None else Displacements(u.four @ values[1:, 1:].T)

    def sums(self, pieces: Array) -> Array:
        """Return, for each interval of nodes[1:], the sum of ``pieces`` within it."""
        return self.fine.sums(pieces)

    def linear_displacements(self, state: ContactState) -> Displacements:
        """Return the linear part of the displacements at nodes[1:]."""
        tractions = np.array([state.pressure, state.shear]).T
        six, m, n = self.per_traction.shape  # one product is faster than six
        made = self.per_traction.reshape(-1, n) @ tractions
        return Displacements.under(made.reshape(six, m, 2))

    def linear_displacements_at(self, x: Array, state: ContactState) -> Displacements:
        """Return the linear part of the displacements at ``x``."""
        acting = self.acting(np.array([state.pressure, state.shear]).T)
        return Displacements.under(pair_displacements(self.kernels, x, self.fine.nodes, acting))

    def displacements(self, state: ContactState) -> Displacements:
        """Return the displacements at nodes[1:], to the order of the model."""
        return self.with_second(self.linear_displacements(state), state)

    def with_second(self, linear: Displacements, state: ContactState) -> Displacements:
        """Return linear displacements of a solution plus those of second order, if any."""
        if self.kernels.is_linear:
            return linear
        held = self.held
        return linear + (self.second(state, self.nodes[1:]) if held is None else held)

    def uncut(self, u: Displacements) -> Displacements:
        """Return displacements at nodes[1:] including the short waves cut from those held."""
        held = self.kernels.held
        if held is None or self.held is None or not held.rough:
            return u
        four = held.uncut.at(self.nodes[1:]).four - self.held.four
        return Displacements(u.four + four)

    def holding(self, kernels: PairKernels) -> Self:
        """Return this mesh with the displacements beyond the linear ones that ``kernels`` hold."""
        return replace(self, kernels=kernels, held=_held_at(self.nodes, kernels))

    def second(self, state: ContactState, x: Array) -> Displacements:
        """Return second-order displacements at ``x``: those held, otherwise the solution's."""
        held = self.kernels.held
        return (self.second_fields(state) if held is None else held).at(x)

    def second_fields(self, state: ContactState) -> SecondFields:
        """Return the second-order displacements under a solution's tractions, as functions."""
        p, q = self.acting(state.pressure), self.acting(state.shear)
        return self.kernels.second_fields(self.fine.nodes, p, q)


def traction_work(traction: Array, displacement: Array) -> float:
    """Return int t du for a traction at nodes[1:-1] (0 at both ends) and u at nodes[1:]."""
    return float(interval_means(traction) @ (displacement[1:] - displacement[:-1]))


def interval_means(traction: Array) -> Array:
    """Return the means of a traction at nodes[1:-1] over the intervals between nodes[1:]."""
    return np.asarray(0.5 * (traction + np.append(traction[1:], 0.0)))


def _held_at(nodes: Array, kernels: PairKernels) -> Displacements | None:
    return None if kernels.held is None else kernels.held.at(nodes[1:])


def pair_displacements(
    kernels: PairKernels, x: Array, nodes: Array, tractions: Array | None = None
) -> Array:
    """Return the displacements of both surfaces at ``x`` (m,), with tractions linear between nodes.

    For each surface u_x = xx t_x + xz t_z and u_z = -xz t_x + zz t_z in its own frame.

    Parameters
    ----------
    tractions : (N-1, s) sets of values at nodes[1:-1]; None: a unit value at each in turn.

    Returns
    -------
    (6, m, s) by xx, zz, xz of the upper, then of the lower surface; 0 for a rigid one.
    """
    made = displacement_under(kernels.together, x, nodes, tractions)
    if kernels.together.count == 6:
        return made
    six = np.zeros((6, *made.shape[1:]))
    six[slice(0 if kernels.upper else 3, 6 if kernels.lower else 3)] = made
    return six
