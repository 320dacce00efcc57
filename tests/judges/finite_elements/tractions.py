"""Forces of the interface on both rollers, with all their derivatives.

Three kinds of points enter: where a force acts on the upper roller, on the lower one (in its
mirrored frame, hence the signs), and the place on the lower roller that moves along with x.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from finite_elements.interface import CoatedSurface, Facing, Interface, Points
from finite_elements.mesh import Array

Indices = NDArray[np.int_]
Entries = tuple[Array, Indices, Indices]  # values, rows, columns, all of one shape
LOWER = np.array([-1.0, 1.0])  # what acts upwards on the upper roller does so on the lower one


@dataclass(frozen=True)
class Loads:
    """Forces of the interface and their derivatives.

    ``force`` on all unknowns (upper, then lower); ``by_displacement`` (unknowns, unknowns);
    ``by_pressure`` and ``by_shear`` (unknowns, ends); load and traction with theirs.
    """

    force: Array
    by_displacement: csr_array
    by_pressure: csr_array
    by_shear: csr_array
    load: float
    traction: float
    totals: Array  # derivatives of (load, traction) by the unknowns, (2, unknowns)
    totals_by_pressure: Array  # (2, ends)
    totals_by_shear: Array  # (2, ends)


def loads(
    interface: Interface,
    upper: Array,
    lower: Array,
    pressure: Array,
    shear: Array,
    elements: NDArray[np.int_],
) -> Loads:
    """Integrate the tractions over the given elements of the upper roller."""
    ring = interface.ring
    points = interface.points(upper, elements)
    below = interface.lower.facing(lower, points.x)
    pair = np.stack((points.element, (points.element + 1) % interface.ends.size), axis=-1)
    p = np.einsum("pj,pj->p", points.hats, pressure[pair])
    q = np.einsum("pj,pj->p", points.hats, shear[pair])
    acting = Acting.of(points, p, q)
    size = ring.unknowns + interface.lower.unknowns
    dofs = ring.surface_dofs[points.upper.nodes]
    found = acting.on(points.upper, dofs, dofs, np.ones(2), pair)
    if isinstance(interface.lower, CoatedSurface):
        there = interface.lower.ring.surface_dofs[below.nodes] + ring.unknowns
        found = [
            [*one, *other]
            for one, other in zip(found, acting.on(below, there, dofs, LOWER, pair), strict=True)
        ]
        found[1] += acting.moving(below, there, dofs)
    forces, by_u, by_p, by_q = found
    force = np.zeros(size)
    for value, rows, _ in forces:
        np.add.at(force, rows, value)
    ends = pressure.size
    return Loads(
        force=force,
        by_displacement=sparse(by_u, (size, size)),
        by_pressure=sparse(by_p, (size, ends)),
        by_shear=sparse(by_q, (size, ends)),
        **totals_of(points, p, q, dofs, pair, (size, ends)),
    )


@dataclass(frozen=True)
class Acting:
    """Force on the upper roller per ds at the points, (points, 2), and its derivatives."""

    points: Points
    force: Array
    by_p: Array  # (points, 2)
    by_q: Array  # (points, 2)
    by_u: Array  # (points, 2, 3, 2): by the displacements of the three nodes

    @staticmethod
    def of(points: Points, p: Array, q: Array) -> Acting:
        along, up = points.upper.along, points.upper.up
        turn = np.stack((np.stack((q, -p), axis=-1), np.stack((p, q), axis=-1)), axis=1)
        return Acting(
            points,
            force=np.stack((q * along - p * up, p * along + q * up), axis=-1),
            by_p=np.stack((-up, along), axis=-1),
            by_q=np.stack((along, up), axis=-1),
            by_u=turn[:, :, None, :] * points.upper.slope[:, None, :, None],
        )

    def on(
        self, surface: Facing, rows: Indices, columns: Indices, sign: Array, pair: Indices
    ) -> list[list[Entries]]:
        """Forces on the nodes of a surface; derivatives by displacement, pressure and shear."""
        scaled = surface.shape * self.points.weight[:, None]
        force = scaled[..., None] * (self.force * sign)[:, None, :]
        out: list[list[Entries]] = [[(force, rows, rows)]]
        out.append([block(scaled, self.by_u * sign[:, None, None], rows, columns)])
        for rate in (self.by_p, self.by_q):
            value = scaled[:, :, None, None] * (rate * sign)[:, None, :, None]
            value = value * self.points.hats[:, None, None, :]
            row, column = np.broadcast_arrays(rows[..., None], pair[:, None, None, :])
            out.append([(value, row, column)])
        return out

    def moving(self, below: Facing, there: Indices, here: Indices) -> list[Entries]:
        """The place below moves as x does: ds_l = (dx_u - dx_l)/x_l'."""
        moved = below.slope * (self.points.weight / below.along)[:, None]
        out = []
        for shape, dofs, sign in (
            (self.points.upper.shape, here, 1.0),
            (below.shape, there, -1.0),
        ):
            rate = np.zeros((shape.shape[0], 2, 3, 2))
            rate[..., 0] = sign * (self.force * LOWER)[:, :, None] * shape[:, None, :]
            out.append(block(moved, rate, there, dofs))
        return out


def totals_of(
    points: Points, p: Array, q: Array, dofs: Indices, pair: Indices, shape: tuple[int, int]
) -> dict[str, Any]:
    """Vertical force and the shear over the deformed length, with their derivatives."""
    along, up = points.upper.along, points.upper.up
    length = np.hypot(along, up)
    slopes = ((p, q), (q * along / length, q * up / length))  # by (x', y')
    tractions = ((along, up), (0.0 * p, length))  # by (p, q)
    totals = np.zeros((2, shape[0]))
    of_p, of_q = np.zeros((2, shape[1])), np.zeros((2, shape[1]))
    for row in range(2):
        rate = points.upper.slope[:, :, None] * np.stack(slopes[row], axis=-1)[:, None, :]
        np.add.at(totals[row], dofs, rate * points.weight[:, None, None])
        for out, value in zip((of_p, of_q), tractions[row], strict=True):
            np.add.at(out[row], pair, points.hats * (value * points.weight)[:, None])
    return {
        "load": float(np.sum(points.weight * (p * along + q * up))),
        "traction": float(np.sum(points.weight * q * length)),
        "totals": totals,
        "totals_by_pressure": of_p,
        "totals_by_shear": of_q,
    }


def block(shape: Array, rate: Array, rows: Indices, columns: Indices) -> Entries:
    """Entries shape_a rate_i,bj at rows (a, i) and columns (b, j), all per point."""
    value = shape[:, :, None, None, None] * rate[:, None]
    row, column = np.broadcast_arrays(rows[:, :, :, None, None], columns[:, None, None])
    return value, row, column


def sparse(blocks: list[Entries], shape: tuple[int, int]) -> csr_array:
    values, rows, columns = (np.concatenate([np.ravel(b[k]) for b in blocks]) for k in range(3))
    return csr_array((values, (rows, columns)), shape=shape)
