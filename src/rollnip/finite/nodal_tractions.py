"""Tractions of a contact, linear between nodes.

They are given at present places, can be moved with the material to its undeformed arcs, and know
the displacement that linear theory has under them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rollnip.finite.follower_load import Tractions
from rollnip.finite.strip import Array

Linear = Callable[[Array, Array, Array, Array], tuple[Array, Array]]
"""Displacements u_x and u_z of linear theory under tractions that are linear between nodes.

Arguments: the places x (n,), the nodes (N+1,), and pressure and shear at nodes[1:-1]."""


def linear_between_nodes(nodes: Array, pressure: Array, shear: Array) -> Tractions:
    """Return tractions that are linear between nodes and zero at the first and the last node.

    Parameters
    ----------
    nodes : (N+1,) increasing places [mm].
    pressure, shear : (N-1,) at nodes[1:-1] [MPa].
    """
    values = np.zeros((2, nodes.size))
    values[0, 1:-1], values[1, 1:-1] = pressure, shear
    slopes = np.diff(values) / np.diff(nodes)
    # p, q and their slopes in every interval; all zero on either side of the nodes
    pieces = np.zeros((4, nodes.size + 1))
    pieces[:2, 1:-1], pieces[2:, 1:-1] = values[:, :-1], slopes
    starts = np.concatenate([nodes[:1], nodes])

    def at(x: Array) -> Array:
        piece = np.searchsorted(nodes, x)
        out = pieces.take(piece, axis=1)
        out[:2] += out[2:] * (x - starts[piece])
        return out

    return at


@dataclass(frozen=True)
class NodalTractions:
    """Tractions on a surface: a weighted sum of some that are linear between nodes.

    Attributes
    ----------
    parts : of each summand its weight, nodes (N+1,) [mm], pressure and shear at nodes[1:-1] [MPa].
    """

    parts: tuple[tuple[float, Array, Array, Array], ...]

    @classmethod
    def on(cls, nodes: Array, pressure: Array, shear: Array) -> NodalTractions:
        """Return tractions that are linear between some nodes, with the weight 1."""
        return cls(((1.0, nodes, pressure, shear),))

    def towards(self, other: NodalTractions, share: float) -> NodalTractions:
        """Return (1 - share) times these tractions plus ``share`` times the others."""
        return NodalTractions(self.times(1.0 - share).parts + other.times(share).parts)

    def times(self, factor: float) -> NodalTractions:
        """Return the tractions times a factor."""
        return NodalTractions(
            tuple((factor * share, nodes, p, q) for share, nodes, p, q in self.parts)
        )

    def at_arcs(self, x: Array, arcs: Array) -> NodalTractions:
        """Return the tractions at the undeformed arcs of the material that they act on.

        ``x`` (n,) are increasing present places and ``arcs`` (n,) the arcs of the material there,
        linear between them [mm]; outside them nodes keep their distances.
        """

        def at(nodes: Array) -> Array:
            return np.interp(nodes, x, arcs) + nodes - np.clip(nodes, x[0], x[-1])

        return NodalTractions(tuple((share, at(nodes), p, q) for share, nodes, p, q in self.parts))

    @property
    def as_function(self) -> Tractions:
        """Pressure, shear and their derivatives, as a function of the place."""
        parts = [(share, linear_between_nodes(*rest)) for share, *rest in self.parts]
        if len(parts) == 1 and parts[0][0] == 1.0:
            return parts[0][1]
        return lambda x: np.asarray(sum(share * one(x) for share, one in parts))

    def linear_displacement(self, linear: Linear, x: Array) -> Array:
        """Return u_x and u_z of linear theory at the places ``x`` (n,), (2, n) [mm]."""
        return np.asarray(sum(share * np.stack(linear(x, *rest)) for share, *rest in self.parts))
