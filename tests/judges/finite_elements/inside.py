"""Cauchy stresses inside a covering, at the points of Gauss of its elements."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from finite_elements.mesh import Array
from finite_elements.newton import Problem, State


@dataclass(frozen=True)
class Inside:
    """Stresses of the upper covering; each (elements, 9).

    Attributes
    ----------
    depth : undeformed [mm].
    x, y : where the material is now; y from the tangent into the roller [mm].
    hoop, peel, shear : stress along and across the present line of that depth, and between [MPa].
    axial : stress along the axle [MPa].
    """

    depth: Array
    x: Array
    y: Array
    hoop: Array
    peel: Array
    shear: Array
    axial: Array


def inside(problem: Problem, state: State) -> Inside:
    """Return the stresses of the upper covering of a solution."""
    solid, ring = problem.solids[0], problem.upper
    at = np.polynomial.legendre.leggauss(3)[0]
    along, down = (grid.ravel() for grid in np.meshgrid(at, at, indexing="ij"))
    rows = ring.depth_ends.size - 1
    half_s = np.repeat(0.5 * np.diff(ring.arc_ends), rows)[:, None]
    half_z = np.tile(0.5 * np.diff(ring.depth_ends), ring.arc_ends.size - 1)[:, None]
    s = np.repeat(ring.arc[1::2], rows)[:, None] + half_s * along
    z = np.tile(ring.depth[1::2], ring.arc_ends.size - 1)[:, None] + half_z * down
    radius = ring.roller.radius
    angle = s / radius
    deform = solid.gradient(state.upper)
    volume = np.linalg.det(deform)
    c, _ = solid._law(volume, state.pi_upper)
    shear = solid._of_layer[0][:, None]
    stress = np.einsum("eqij,eqkj->eqik", deform, deform) * (shear / volume)[..., None, None]
    stress += c[..., None, None] * np.eye(2)
    way = np.stack((np.cos(angle), np.sin(angle)), axis=-1)
    tangent = np.einsum("eqij,eqj->eqi", deform, way)
    tangent /= np.linalg.norm(tangent, axis=-1, keepdims=True)
    normal = np.stack((-tangent[..., 1], tangent[..., 0]), axis=-1)

    def component(one: Array, other: Array) -> Array:
        return np.einsum("eqi,eqij,eqj->eq", one, stress, other)

    local = np.append(state.upper, 0.0)[solid.element_dofs].reshape(-1, 9, 2)
    shape = _shapes(along, down)
    moved = np.einsum("qa,eai->eqi", shape, local)
    return Inside(
        depth=z,
        x=(radius - z) * np.sin(angle) + moved[..., 0],
        y=radius - (radius - z) * np.cos(angle) + moved[..., 1],
        hoop=component(tangent, tangent),
        peel=component(normal, normal),
        shear=component(tangent, normal),
        axial=shear / volume + c,
    )


def _shapes(along: Array, down: Array) -> Array:
    def three(at: Array) -> Array:
        return np.stack((0.5 * at * (at - 1.0), 1.0 - at * at, 0.5 * at * (at + 1.0)), axis=-1)

    return np.einsum("qa,qb->qab", three(along), three(down)).reshape(-1, 9)
