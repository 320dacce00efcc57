"""The search for the ends of zones at one mesh size, mesh by mesh.

Each mesh has its nodes at the ends of the zones. Its solution proposes other places for the ends,
and Broyden's method (`contact.secants`) says where they lie on the next mesh. What decides that the
ends are placed, or that the zones are others, is left to `placing`.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace

import numpy as np

from rollnip.contact import NEAR_ENOUGH, Layout, elements_of_zones
from rollnip.contact.problem import Array
from rollnip.contact.secants import Secants
from rollnip.rolling.changes import LEAST_SIZE
from rollnip.rolling.mesh_solution import Figures, MeshSolution
from rollnip.rolling.neglected_slip import creepage_by_ends
from rollnip.rolling.rolling_contact import RollingContact
from rollnip.rolling.zone_solver import (
    SearchState,
    Shape,
    crowding_for,
    crowds_more,
    singular,
    solve_with_zones,
)


@dataclass(slots=True)
class EndSearch:
    """The search for the ends of zones at one mesh size, and its last solution.

    Attributes
    ----------
    count : rough number of elements.
    state : state of the search, with the zones of the last mesh, or of the next one.
    least_misplacement : the smallest so far, over the width.
    secants : Broyden's method for the ends of the current zones.
    end_sensitivity : see `SearchState`.
    shape : of the meshes with the current zones; None: choose one.
    last : zones and figures of the last mesh of this shape; None: there is none.
    meshes : number of meshes with the current zones.
    tried : keys of zones tried before.
    latest : the solution on the last mesh.
    proposed : its zones with the ends where the solution puts them.
    vanishing : numbers of the zones to which the last two solutions leave no length.
    next_layout : its zones with the ends at the next places to try.
    misplacement : distance of the ends from the proposed places, over the width.
    """

    count: int
    state: SearchState
    least_misplacement: float
    secants: Secants
    end_sensitivity: Figures | None
    shape: Shape | None = None
    last: tuple[Layout, Figures] | None = None
    meshes: int = 0
    tried: set[bytes] = field(default_factory=set)
    latest: MeshSolution = field(init=False)
    proposed: Layout = field(init=False)
    vanishing: list[int] = field(init=False)
    next_layout: Layout = field(init=False)
    misplacement: float = field(init=False)

    @classmethod
    def of(cls, start: SearchState, count: int) -> EndSearch:
        """Begin a search with the zones of ``start``."""
        secants = Secants(start.misplacement * start.layout.width, start.jacobian)
        return cls(count, start.renewed(), start.misplacement, secants, start.end_sensitivity)

    @property
    def contact(self) -> RollingContact:
        """The contact to solve."""
        return self.state.contact

    @property
    def layout(self) -> Layout:
        """The zones of the last mesh."""
        return self.state.layout

    @property
    def is_near(self) -> bool:
        """Whether the ends are near enough for a solution to show what slips."""
        return self.misplacement < NEAR_ENOUGH and self.state.second_order_settled

    @property
    def end_error(self) -> Figures | None:
        """Change of each figure that the misplacement may cause; None: not known."""
        if self.end_sensitivity is None:
            return None
        error = self.end_sensitivity.times(self.next_layout.distance(self.layout))
        unseen = creepage_by_ends(self.contact.nip, self.layout, self.proposed)
        return replace(error, creepage=error.creepage + unseen)

    def solve_mesh(self) -> None:
        """Solve on the next mesh, and find where its solution puts the ends."""
        self.meshes += 1
        layout, shape = self.layout, self._choose_shape()
        self.latest, self.proposed = solve_with_zones(self.state, shape)
        self.vanishing = self.secants.vanishing(layout, self.proposed)
        self.misplacement = self.proposed.distance(layout)
        self.least_misplacement = min(self.least_misplacement, self.misplacement)
        self.next_layout = self.secants.next_layout(
            layout,
            self.proposed,
            singular(self.latest, layout),
            only_ends_move=self.latest.settled and self.state.second_order_settled,
        )
        self._learn_sensitivity()

    def _choose_shape(self) -> Shape:
        """Return the shape of the next mesh: the last one, unless nodes must crowd more.

        Elements are kept while ends are sought, as another mesh would shift the ends.
        """
        layout = self.layout
        coarsest = self.least_misplacement * layout.width
        crowding = crowding_for(self.contact, layout, coarsest)
        if self.shape is None or crowds_more(crowding, self.shape[1]):
            self.shape = elements_of_zones(layout.breaks, self.count, crowding), crowding
            self.secants.forget()
            self.last = None
        return self.shape

    def _learn_sensitivity(self) -> None:
        """Update how figures depend on the ends, from the last two meshes.

        A single mesh uses what another size has shown, unless its zones change too much for that.
        """
        layout, figures = self.layout, self.latest.figures
        breaks, tolerance = self.next_layout.breaks, self.contact.tolerance
        if self.last is not None:
            before, figures_before = self.last
            step = layout.distance(before)
            change = figures.change_from(figures_before)
            self.end_sensitivity = change.times(1.0 / step if step > 0.0 else 0.0)
        elif length_change_ratio(layout.breaks, breaks, tolerance) > 1.0:
            self.end_sensitivity = None
        self.last = layout, figures

    def untried(self, others: Iterable[SearchState]) -> SearchState | None:
        """Return the first candidate not tried before; fewer zones than now may be retried."""
        count = self.layout.states.size
        return next(
            (
                other
                for other in others
                if other.layout.states.size < count or other.layout.key not in self.tried
            ),
            None,
        )

    def change_zones(self, other: SearchState) -> None:
        """Go on with other zones."""
        self.tried.add(other.layout.key)
        self.secants = Secants(self.least_misplacement * self.layout.width)
        self.state, self.shape = other.renewed(), None
        self.end_sensitivity, self.meshes = None, 0

    def move_ends(self) -> None:
        """Go on with the same zones, and their ends at the next places."""
        state = self.state
        moved = SearchState(self.next_layout, self.latest, state.change, state.to_come)
        self.state = moved.renewed()

    def result(self) -> SearchState:
        """Return the state of the search with the ends at their next places."""
        layout, state = self.next_layout, self.state
        figures = replace(self.latest.figures, nip_width=layout.width)
        return SearchState(
            layout,
            replace(self.latest, zones=layout.zones, figures=figures),
            state.change,
            state.to_come,
            misplacement=self.misplacement,
            end_error=self.end_error,
            end_sensitivity=self.end_sensitivity,
            jacobian=self.secants.jacobian,
        )


def length_change_ratio(before: Array, after: Array, tolerance: float) -> float:
    """Return the largest change of a zone's length, over what is small.

    Small is three times the tolerance, times the length of the zone or `LEAST_SIZE` of the width if
    that is more.
    """
    lengths = after[1:] - after[:-1]
    allowed = 3.0 * tolerance * np.maximum(lengths, LEAST_SIZE * lengths.sum())
    return float((np.abs(lengths - (before[1:] - before[:-1])) / allowed).max())
