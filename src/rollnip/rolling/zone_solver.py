"""The contact with given zones, solved on a mesh whose nodes lie at their ends."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import ceil, inf

import numpy as np

from rollnip.contact import (
    NEAR_ENOUGH,
    Crowding,
    Layout,
    cosine_nodes,
    crowding_of,
    elements_of_zones,
    subdivided,
    uncrowded,
)
from rollnip.contact.coupled import solve_states
from rollnip.contact.mesh import LEAST_SHARE_OF_A_ZONE, PIECES_PER_ELEMENT
from rollnip.contact.problem import Array, Indices
from rollnip.influence import has_stiff_skin
from rollnip.rolling.changes import NEGLIGIBLE, to_come_after
from rollnip.rolling.iterations import own_second_order, solve_on_mesh
from rollnip.rolling.lengths import boundary_layer, dundurs, thinnest_covering
from rollnip.rolling.mesh_solution import Figures, MeshSolution
from rollnip.rolling.rolling_contact import RollingContact
from rollnip.rolling.surfaces import Mesh, PairKernels

# Poisson ratio from which a thin covering on a rigid core moves as the second derivative of the
# pressure.
_NEARLY_INCOMPRESSIBLE = 0.45
_WIDTH_PER_PIECE = 7.0  # of the contact, in thicknesses of such a covering
_MOST_PIECES = 16  # bounds memory
_MORE_UNDER_SKIN = 100.0  # times as exactly lagged terms settle under a stiff skin

Shape = tuple[Indices, Crowding]
"""Number of elements in each zone, and how strongly their nodes crowd (`cosine_nodes`)."""


@dataclass(frozen=True, slots=True)
class SearchState:
    """State of the search for zones and their ends.

    Attributes
    ----------
    layout : the zones to solve with next.
    solution : the last one.
    change : of the lagged terms when the second order of "second" was last evaluated, over
        the tolerance.
    to_come : sum of the changes that further evaluations would make, over the tolerance.
    misplacement : largest error of the ends of zones, over the width of the contact.
    end_error : change of each figure that this misplacement may cause; None: not known.
    end_sensitivity : change of each figure per misplacement of the ends, over the width; None: not
        known.
    jacobian : of the moves that ends propose, see `Secants`; None: not known.
    """

    layout: Layout
    solution: MeshSolution
    change: float = inf
    to_come: float = inf
    misplacement: float = NEAR_ENOUGH
    end_error: Figures | None = None
    end_sensitivity: Figures | None = None
    jacobian: Array | None = None

    @property
    def second_order_settled(self) -> bool:
        """Whether the second order is fixed, or further evaluations would hardly change it."""
        return self.contact.kernels.is_fixed or self.to_come <= 1.0

    @property
    def contact(self) -> RollingContact:
        """The contact to solve: that of the last solution."""
        return self.solution.contact

    def renewed(self) -> SearchState:
        """Return the state with the second order evaluated from its last solution.

        It is unchanged if the second order has converged, or is fixed.
        """
        if self.second_order_settled:
            return self
        mesh, lagged, change = own_second_order(self.solution)
        change /= self.contact.tolerance
        solution = replace(self.solution, mesh=mesh, lagged=lagged)
        return SearchState(self.layout, solution, change, to_come_after(change, self.change))


def crowding_for(contact: RollingContact, layout: Layout, coarsest: float = 0.0) -> Crowding:
    """Return the crowding that resolves the boundary layers of each zone.

    In stick, tractions change, too, over the length of slip between it and a leading edge.
    ``coarsest``: length below which nothing need be resolved [mm].
    """
    least = max(boundary_layer(contact.nip), coarsest)
    shortest = [(least, min(least, max(slip, coarsest))) for slip in layout.slip_beyond_stick]
    return crowding_of(layout.breaks, np.array(shortest))


def mesh_at_ends(
    contact: RollingContact, layout: Layout, shape: Shape, kernels: PairKernels
) -> Mesh:
    """Return the mesh with nodes at the ends of the zones of a solution."""
    nodes = cosine_nodes(layout.breaks, *shape)
    edges = np.cumsum([0, *shape[0]])[layout.is_edge].tolist()
    exponents = layout.exponents(dundurs(contact.nip), contact.nip.friction)
    fine = subdivided(nodes, *shape, pieces_of(contact, layout), edges, exponents)
    return Mesh.on(nodes, kernels, fine)


def mesh_around(contact: RollingContact, zones: Layout, count: int, kernels: PairKernels) -> Mesh:
    """Return a mesh on roughly known zones, to seek states node by node."""
    shape = elements_of_zones(zones.breaks, count), uncrowded(zones.states.size)
    nodes = cosine_nodes(zones.breaks, *shape)
    fine = subdivided(nodes, *shape, pieces_of(contact, zones))
    return Mesh.on(nodes, kernels, replace(fine, elements=(), crowding=()))


def pieces_of(contact: RollingContact, layout: Layout) -> int:
    """Return the number of linear pieces of an element.

    A thin incompressible covering on a rigid core moves as the second derivative of the pressure,
    which linear pieces longer than its thickness cannot represent. The number does not depend on
    that of the elements: pieces of the same length on all sizes of mesh would leave the same error,
    which no comparison of sizes shows.
    """
    thinnest = thinnest_covering(contact.nip, _NEARLY_INCOMPRESSIBLE)
    wanted = ceil(layout.width / (_WIDTH_PER_PIECE * thinnest))
    return max(min(wanted, _MOST_PIECES), PIECES_PER_ELEMENT)


def solve_with_zones(state: SearchState, shape: Shape) -> tuple[MeshSolution, Layout]:
    """Return the solution on one mesh, and the zones with the ends that it proposes."""
    contact, layout, before = state.contact, state.layout, state.solution
    nip = contact.nip
    has_skin = has_stiff_skin((nip.upper, nip.lower))
    mesh = mesh_at_ends(contact, layout, shape, before.mesh.kernels)
    start = layout.states_on(mesh.inner), before.lagged.carried(before.mesh, mesh), before.steps
    # Under a stiff skin the pressure beside an edge responds many times more to a change of the
    # gap, and the shear to a change of the creep.
    settled_change = NEGLIGIBLE / _MORE_UNDER_SKIN if has_skin else NEGLIGIBLE
    latest = solve_on_mesh(contact, mesh, start, solve_states, settled_change, layout.zones)
    proposed = layout.with_proposed_ends(
        mesh.inner, latest.state, nip.friction, mesh.fine.exponents
    )
    # Under a stiff skin ends without a place are found one by one (decisions 83 and 88).
    if not has_skin:
        least = NEGLIGIBLE * contact.shortest_zone(layout.width)
        proposed = layout.with_reversals(proposed, least)
    return latest, proposed


def singular(latest: MeshSolution, layout: Layout) -> Array | None:
    """Return `Layout.singular`; None with friction, or with several zones.

    With friction, unlike surfaces that stick up to an edge have an oscillating inverse square root
    in the shear, which the pressure follows.
    """
    if latest.nip.friction > 0.0 or layout.states.size > 1:
        return None
    return layout.singular(latest.mesh.inner, latest.state)


def crowds_more(one: Crowding, other: Crowding) -> bool:
    """Return whether nodes crowd more in any zone of ``one``, or the number of zones differs."""
    return len(one) != len(other) or any(
        a < b for ratios in zip(one, other, strict=True) for a, b in zip(*ratios, strict=True)
    )


def are_too_many(zones: int) -> bool:
    """Return whether there are more zones than a mesh can resolve; only errors make that many."""
    return zones * LEAST_SHARE_OF_A_ZONE > 1.0
