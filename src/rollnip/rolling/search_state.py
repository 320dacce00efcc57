"""The state of the search for zones and their ends, which goes on from mesh to mesh."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf

from rollnip.contact import NEAR_ENOUGH, Layout
from rollnip.contact.problem import Array
from rollnip.rolling.changes import to_come_after
from rollnip.rolling.iterations import own_second_order
from rollnip.rolling.mesh_solution import Figures, MeshSolution
from rollnip.rolling.rolling_contact import RollingContact


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
        """Return whether further evaluations of the second order would change it negligibly."""
        return self.to_come <= 1.0

    def renewed(self, contact: RollingContact) -> SearchState:
        """Return the state with the second order evaluated from its last solution.

        It is unchanged if the second order has converged, or is fixed.
        """
        if contact.kernels.is_fixed or self.second_order_settled:
            return self
        mesh, lagged, change = own_second_order(contact, self.solution)
        change /= contact.tolerance
        solution = replace(self.solution, mesh=mesh, lagged=lagged)
        return SearchState(self.layout, solution, change, to_come_after(change, self.change))
