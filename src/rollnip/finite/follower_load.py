"""Follower loads: tractions on the deformed surface of a mesh, as nodal forces.

The force on the surface per undeformed arc ds is  (q x' - p y', p x' + q y'), with the pressure p
and the shear q at the present place x(s).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

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
        local = displacement[surface.unknowns]
        x, along, up = surface.undeformed
        x = x + (surface.values @ local[..., :1])[..., 0]
        rates = surface.slopes @ local
        acting = surface.weights * tractions(x)
        return cls(strip, along + rates[..., 0], up + rates[..., 1], acting)

    @classmethod
    def undeformed(cls, strip: Strip, tractions: Tractions) -> FollowerLoad:
        """Return the loads of linear theory, with tractions given at undeformed arcs."""
        surface = strip.surface
        _, cos, sin = surface.undeformed
        return cls(strip, cos, sin, surface.weights * tractions(surface.arcs))

    @property
    def nodal_forces(self) -> Array:
        """External forces at the nodes, (unknowns,) [N/mm]."""
        along, up, (p, q, _, _) = self.along, self.up, self.tractions
        surface = self.strip.surface
        force = np.stack([q * along - p * up, p * along + q * up], axis=-1)
        made = surface.values.transpose(0, 2, 1) @ force
        return summed(surface.unknowns.ravel(), made.ravel(), self.strip.size)

    @property
    def stiffness(self) -> tuple[Indices, Array]:
        """Load stiffness, the derivative of the forces: places in banded storage, and entries."""
        surface = self.strip.surface
        n, d = surface.values, surface.slopes
        along, up, (p, q, p_slope, q_slope) = self.along, self.up, self.tractions
        turned, sheared = _between(n, p, d), _between(n, q, d)
        entries = np.empty((self.strip.columns, 3, 2, 3, 2))
        entries[:, :, 0, :, 0] = sheared + _between(n, q_slope * along - p_slope * up, n)
        entries[:, :, 1, :, 0] = turned + _between(n, p_slope * along + q_slope * up, n)
        entries[:, :, 0, :, 1], entries[:, :, 1, :, 1] = -turned, sheared
        row = np.broadcast_to(surface.unknowns[:, :, :, None, None], entries.shape)
        column = np.broadcast_to(surface.unknowns[:, None, None], entries.shape)
        return self.strip.place(row, column).ravel(), entries.ravel()


def summed(places: Indices, values: Array, count: int) -> Array:
    """Return the sums of the values with the same place, (count,)."""
    return np.asarray(np.bincount(places, values, minlength=count), dtype=float)


def _between(shape: Array, values: Array, other: Array) -> Array:
    """Return the sums over points of shape_a values other_b, (columns, 3, 3)."""
    return np.asarray((shape * values[..., None]).transpose(0, 2, 1) @ other)
