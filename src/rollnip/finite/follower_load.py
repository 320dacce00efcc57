"""Follower loads: tractions on the deformed surface of a mesh, as nodal forces.

The force on the surface per undeformed arc ds is  (q x' - p y', p x' + q y'), with the pressure p
and the shear q at the present place x(s).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rollnip.finite.strip import Array, Indices, Strip

Tractions = Callable[[Array], Array]
"""Pressure and shear [MPa] and their derivatives [MPa/mm] at some places, (4, ...)."""


@dataclass(frozen=True)
class FollowerLoad:
    """Tractions on the surface of a mesh in some state, at the Gauss points of the surface.

    Attributes
    ----------
    strip : the mesh.
    along, up : (columns, 4) derivatives of the present x and y by the arc.
    tractions : (4, columns, 4) p, q and their derivatives by the place, each times the weight of
        the Gauss point [mm].
    """

    strip: Strip
    along: Array
    up: Array
    tractions: Array

    @classmethod
    def of(cls, strip: Strip, displacement: Array, tractions: Tractions) -> FollowerLoad:
        """Return the loads at displacements (unknowns,), with tractions given at present places."""
        surface = strip.surface
        (u_x, _), (x_rate, y_rate) = surface.moved(displacement)
        x, along, up = surface.undeformed
        return cls(strip, along + x_rate, up + y_rate, surface.weights * tractions(x + u_x))

    @classmethod
    def undeformed(cls, strip: Strip, tractions: Tractions) -> FollowerLoad:
        """Return the loads of linear theory, with tractions given at undeformed arcs."""
        surface = strip.surface
        _, cos, sin = surface.undeformed
        return cls(strip, cos, sin, surface.weights * tractions(surface.arcs))

    @cached_property
    def nodal_forces(self) -> Array:
        """External forces at the nodes, (unknowns,) [N/mm]."""
        along, up, (p, q, _, _) = self.along, self.up, self.tractions
        force = np.empty((2, *p.shape))
        force[0], force[1] = q * along - p * up, p * along + q * up
        surface = self.strip.surface
        return summed(surface.unknowns.ravel(), surface.at_nodes(force).ravel(), self.strip.size)

    @property
    def stiffness(self) -> tuple[Indices, Array]:
        """Load stiffness, the derivative of the forces: places in banded storage, and entries."""
        surface = self.strip.surface
        along, up, (p, q, p_slope, q_slope) = self.along, self.up, self.tractions
        turned, sheared = (surface.between_shape_and_slope(one) for one in (p, q))
        entries = np.empty((2, 2, self.strip.columns, 3, 3))
        entries[0, 0] = sheared + surface.between_shapes(q_slope * along - p_slope * up)
        entries[1, 0] = turned + surface.between_shapes(p_slope * along + q_slope * up)
        entries[0, 1], entries[1, 1] = -turned, sheared
        row, column = surface.unknowns[:, None, :, :, None], surface.unknowns[:, :, None]
        return self.strip.place(*np.broadcast_arrays(row, column)).ravel(), entries.ravel()


def summed(places: Indices, values: Array, count: int) -> Array:
    """Return the sums of the values with the same place, (count,)."""
    return np.asarray(np.bincount(places, values, minlength=count), dtype=float)
