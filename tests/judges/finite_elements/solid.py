"""Equilibrium of a neo-Hookean covering at finite strain: forces and tangent of its elements.

The nominal stress is  P = G F + c cof F.  Incompressible layers have  c = pi - G  with an unknown
pressure pi, linear in each element and not continuous, that belongs to J = 1 in the mean (the
stable pair of nine-node displacement and three-term pressure). Compressible layers have, with
Lame's constants G and lambda,
  "log":     psi = G/2 (I1 - 3 - 2 ln J) + lambda/2 (ln J)^2,    c = (lambda ln J - G)/J
  "square":  psi = G/2 (I1 - 3 - 2 ln J) + lambda/2 (J - 1)^2,   c = lambda (J - 1) - G/J.
Steady rolling without inertia is the statics of the rings as they stand: the material flows
through the mesh, its stress depends on F alone.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array

from finite_elements.mesh import Array, Ring

_GAUSS = np.polynomial.legendre.leggauss(3)
# The tangent lets the volume yield by this much times J - 1 over G, the residual does not: every
# Newton step reduces what is left of J - 1 by about this factor.
_YIELD = 1e-6


def quadratics(at: Array) -> tuple[Array, Array]:
    """Values and derivatives of the three quadratic shape functions on [-1, 1]; (..., 3)."""
    at = np.asarray(at, dtype=float)
    values = np.stack((0.5 * at * (at - 1.0), 1.0 - at * at, 0.5 * at * (at + 1.0)), axis=-1)
    slopes = np.stack((at - 0.5, -2.0 * at, at + 0.5), axis=-1)
    return values, slopes


@dataclass(frozen=True)
class Forces:
    """Internal forces (unknowns,), tangent (unknowns, unknowns) and what pi needs to follow."""

    force: Array
    tangent: coo_array
    pressure_rate: Array  # (elements, 3, 18)
    pressure_step: Array  # (elements, 3)


@dataclass(frozen=True)
class Solid:
    """The elements of a ring with what of them does not change."""

    ring: Ring

    @cached_property
    def _points(self) -> tuple[Array, Array, Array]:
        """Gradients (elements, points, 9, 2), volumes, and the basis of pi (points, 3)."""
        ring, (at, weight) = self.ring, _GAUSS
        along, down = (grid.ravel() for grid in np.meshgrid(at, at, indexing="ij"))
        (n_s, d_s), (n_z, d_z) = quadratics(along), quadratics(down)
        half_s, half_z = 0.5 * np.diff(ring.arc_ends), 0.5 * np.diff(ring.depth_ends)
        half_s, half_z = (np.ravel(g) for g in np.meshgrid(half_s, half_z, indexing="ij"))
        middle = np.meshgrid(ring.arc[1::2], ring.depth[1::2], indexing="ij")
        s = middle[0].reshape(-1, 1) + half_s[:, None] * along
        z = middle[1].reshape(-1, 1) + half_z[:, None] * down
        by_arc = np.einsum("qa,qb->qab", d_s, n_z).reshape(9, 9) / half_s[:, None, None]
        by_depth = np.einsum("qa,qb->qab", n_s, d_z).reshape(9, 9) / half_z[:, None, None]
        radius = self.ring.roller.radius
        shrink, angle = 1.0 - z / radius, s / radius
        arc_way = np.stack((np.cos(angle), np.sin(angle)), axis=-1) / shrink[..., None]
        depth_way = np.stack((-np.sin(angle), np.cos(angle)), axis=-1)
        gradient = (
            by_arc[..., None] * arc_way[:, :, None, :]
            + by_depth[..., None] * depth_way[:, :, None, :]
        )
        area = np.multiply.outer(weight, weight).ravel()
        volume = area * (half_s * half_z)[:, None] * shrink
        return gradient, volume, np.stack((np.ones(9), along, down), axis=-1)

    @cached_property
    def _of_layer(self) -> tuple[Array, Array, NDArray[np.bool_], NDArray[np.bool_]]:
        """G, lambda, incompressible?, "square"? of every element."""
        layers = self.ring.roller.layers
        pick = np.tile(self.ring.layer_of, self.ring.arc_ends.size - 1)
        return (
            np.array([layer.shear_modulus for layer in layers])[pick],
            np.array([layer.lame for layer in layers])[pick],
            np.array([layer.incompressible for layer in layers])[pick],
            np.array([layer.volumetric == "square" for layer in layers])[pick],
        )

    @cached_property
    def _slots(self) -> tuple[NDArray[np.int_], NDArray[np.int_], NDArray[np.bool_]]:
        """Row and column of every entry of the element matrices, and which of them are unknowns."""
        dofs = self.element_dofs
        rows, columns = (a.ravel() for a in np.broadcast_arrays(dofs[:, :, None], dofs[:, None, :]))
        kept = (rows >= 0) & (columns >= 0)
        return rows[kept], columns[kept], kept

    @cached_property
    def element_dofs(self) -> NDArray[np.int_]:
        return self.ring.dofs[self.ring.nodes].reshape(-1, 18)

    def no_pressure(self) -> Array:
        return np.zeros((self.element_dofs.shape[0], 3))

    def gradient(self, displacement: Array) -> Array:
        """F at every point of every element, shape (elements, 9, 2, 2)."""
        padded = np.append(displacement, 0.0)  # index -1: the core, which does not move
        local = padded[self.element_dofs].reshape(-1, 9, 2)
        return np.eye(2) + np.einsum("eai,eqaj->eqij", local, self._points[0])

    def _law(self, jacobian: Array, pressure: Array) -> tuple[Array, Array]:
        """Return c of P = G F + c cof F, and dc/dJ."""
        shear, lame, incompressible, square = (a[:, None] for a in self._of_layer)
        log = np.log(jacobian)
        c = np.where(
            square, lame * (jacobian - 1.0) - shear / jacobian, (lame * log - shear) / jacobian
        )
        rate = np.where(
            square,
            lame + shear / jacobian**2,
            (lame * (1.0 - log) + shear) / jacobian**2,
        )
        pi = np.einsum("ek,qk->eq", pressure, self._points[2])
        return np.where(incompressible, pi - shear, c), np.where(incompressible, 0.0, rate)

    def forces(self, displacement: Array, pressure: Array) -> Forces:
        """Internal forces and tangent, pi eliminated element by element."""
        gradient, volume, basis = self._points
        shear, _, incompressible, _ = self._of_layer
        deform = self.gradient(displacement)
        cofactor = np.empty_like(deform)
        cofactor[..., 0, 0], cofactor[..., 1, 1] = deform[..., 1, 1], deform[..., 0, 0]
        cofactor[..., 0, 1], cofactor[..., 1, 0] = -deform[..., 1, 0], -deform[..., 0, 1]
        jacobian = deform[..., 0, 0] * deform[..., 1, 1] - deform[..., 0, 1] * deform[..., 1, 0]
        c, rate = self._law(jacobian, pressure)
        stress = shear[:, None, None, None] * deform + c[..., None, None] * cofactor
        count = gradient.shape[0]
        force = np.einsum("eqij,eqaj,eq->eai", stress, gradient, volume).reshape(count, 18)
        swell = np.einsum("eqij,eqaj->eqai", cofactor, gradient).reshape(count, 9, 18)
        tangent = self._stiffness(c, rate, swell)
        # d pi = (mass^-1 / yield) (r + swell du), r the mean of J - 1 against the basis of pi
        mass = np.einsum("qk,ql,eq->ekl", basis, basis, volume)
        inverse = np.linalg.inv(mass) * (shear / _YIELD * incompressible)[:, None, None]
        volume_rate = np.einsum("qk,eqd,eq->ekd", basis, swell, volume)
        left = np.einsum("qk,eq,eq->ek", basis, jacobian - 1.0, volume)
        pressure_rate = inverse @ volume_rate
        pressure_step = np.einsum("ekl,el->ek", inverse, left)
        tangent += np.matmul(volume_rate.transpose(0, 2, 1), pressure_rate)
        force += np.einsum("ekd,ek->ed", volume_rate, pressure_step)
        rows, columns, kept = self._slots
        size = self.ring.unknowns
        matrix = coo_array((tangent.ravel()[kept], (rows, columns)), shape=(size, size))
        dofs = self.element_dofs.ravel()
        total = np.bincount(dofs[dofs >= 0], force.ravel()[dofs >= 0], minlength=size)
        return Forces(total, matrix, pressure_rate, pressure_step)

    def _stiffness(self, c: Array, rate: Array, swell: Array) -> Array:
        """dP/dF between all nodes of each element: G, the turning of cof F, and dc/dJ."""
        gradient, volume, _ = self._points
        shear = self._of_layer[0]
        count = gradient.shape[0]
        out = np.zeros((count, 9, 2, 9, 2))
        weighted = gradient * volume[:, :, None, None]
        by_x, by_y = gradient[..., 0], gradient[..., 1]
        same = np.matmul(weighted[..., 0].transpose(0, 2, 1), by_x)
        same += np.matmul(weighted[..., 1].transpose(0, 2, 1), by_y)
        same *= shear[:, None, None]
        out[:, :, 0, :, 0] = same
        out[:, :, 1, :, 1] = same
        turn = np.matmul((by_x * (c * volume)[..., None]).transpose(0, 2, 1), by_y)
        turn -= turn.transpose(0, 2, 1)
        out[:, :, 0, :, 1] += turn
        out[:, :, 1, :, 0] -= turn
        out = out.reshape(count, 18, 18)
        out += np.matmul((swell * (rate * volume)[..., None]).transpose(0, 2, 1), swell)
        return out

    def followed(self, forces: Forces, pressure: Array, step: Array) -> Array:
        """Return pi after the displacements have moved by ``step``."""
        local = np.append(step, 0.0)[self.element_dofs]
        return (
            pressure + forces.pressure_step + np.einsum("ekd,ed->ek", forces.pressure_rate, local)
        )
