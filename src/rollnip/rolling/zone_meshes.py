"""Meshes of a nip whose nodes lie at the ends of zones."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import inf

import numpy as np

from rollnip.contact import (
    Crowding,
    Layout,
    cosine_nodes,
    crowding_of,
    elements_of_zones,
    subdivided,
    uncrowded,
)
from rollnip.contact.mesh import LEAST_SHARE_OF_A_ZONE
from rollnip.contact.problem import Indices
from rollnip.nip import Nip
from rollnip.rolling.lengths import boundary_layer, dundurs
from rollnip.rolling.surfaces import Mesh, PairKernels, mesh_on

_NEARLY_INCOMPRESSIBLE = 0.45  # Poisson ratio
_PIECES_PER_THICKNESS = 6.0  # least number of linear pieces along a thickness of such a covering

Shape = tuple[Indices, Crowding]
"""Number of elements in each zone, and how strongly their nodes crowd (`cosine_nodes`)."""


@dataclass(frozen=True)
class ZoneMeshes:
    """Meshes of a nip with nodes at the ends of zones, and the lengths that they must resolve."""

    nip: Nip

    @cached_property
    def boundary(self) -> float:
        """Length of the shortest boundary layer of the nip, see `boundary_layer` [mm]."""
        return boundary_layer(self.nip)

    @cached_property
    def _beta(self) -> float:
        return dundurs(self.nip)

    def exponents(self, layout: Layout) -> tuple[complex, ...]:
        """Return the exponents of the tractions at the edges of a solution, see `contact`."""
        return layout.edge_exponents(self._beta, self.nip.friction)

    @cached_property
    def longest_piece(self) -> float:
        """Largest length of the linear pieces of the acting tractions [mm].

        A thin incompressible covering on a rigid core moves as the second derivative of the
        pressure, which linear pieces longer than its thickness cannot represent.
        """
        coverings = [
            roller.coating_thickness
            for roller in (self.nip.upper, self.nip.lower)
            if not roller.is_rigid and roller.core is None
            if all(layer.material.poisson > _NEARLY_INCOMPRESSIBLE for layer in roller.layers)
        ]
        return min(coverings, default=inf) / _PIECES_PER_THICKNESS

    def crowding(self, layout: Layout, coarsest: float = 0.0) -> Crowding:
        """Return the crowding that resolves the boundary layers of each zone.

        In stick, tractions change, too, over the length of slip between it and a leading edge.
        ``coarsest``: length below which nothing need be resolved [mm].
        """
        least = max(self.boundary, coarsest)
        shortest = [(least, min(least, max(slip, coarsest))) for slip in layout.slip_beyond_stick]
        return crowding_of(layout.breaks, np.array(shortest))

    def resolves(self, layout: Layout, crowding: Crowding) -> bool:
        """Return whether nodes that crowd so resolve the boundary layers of each zone."""
        return not crowds_more(self.crowding(layout), crowding)

    def at_ends(self, layout: Layout, shape: Shape, kernels: PairKernels) -> Mesh:
        """Return the mesh with nodes at the ends of the zones of a solution."""
        nodes = cosine_nodes(layout.breaks, *shape)
        edges = np.cumsum([0, *shape[0]])[layout.is_edge].tolist()
        exponents = self.exponents(layout)
        fine = subdivided(nodes, *shape, self.longest_piece, edges, exponents)
        return mesh_on(nodes, kernels, fine)

    def around(self, zones: Layout, count: int, kernels: PairKernels) -> Mesh:
        """Return a mesh on roughly known zones, to seek states node by node."""
        shape = elements_of_zones(zones.breaks, count), uncrowded(zones.states.size)
        nodes = cosine_nodes(zones.breaks, *shape)
        fine = subdivided(nodes, *shape, self.longest_piece)
        return mesh_on(nodes, kernels, replace(fine, elements=(), crowding=()))


def crowds_more(one: Crowding, other: Crowding) -> bool:
    """Return whether nodes crowd more in any zone of ``one``, or the number of zones differs."""
    return len(one) != len(other) or bool(np.any(np.array(one) < np.array(other)))


def are_too_many(zones: int) -> bool:
    """Return whether there are more zones than a mesh can resolve; only errors make that many."""
    return zones * LEAST_SHARE_OF_A_ZONE > 1.0
