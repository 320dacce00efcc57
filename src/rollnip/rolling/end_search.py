"""The search for the ends of zones at one mesh size, mesh by mesh.

Each mesh has its nodes at the ends of the zones. Its solution proposes other places for the ends,
and Broyden's method (`contact.secants`) says where they lie on the next mesh. What decides that the
ends are placed, or that the zones are others, is left to `placing`.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property

from rollnip.contact import GivenStates, Layout, elements_of_zones
from rollnip.contact.secants import Secants
from rollnip.influence import has_stiff_skin
from rollnip.influence.surface import STIFF_SKIN
from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.rolling.changes import NEGLIGIBLE, to_come_after
from rollnip.rolling.estimates import length_change_ratio
from rollnip.rolling.iterations import own_second_order, solve_on_mesh
from rollnip.rolling.lengths import shortest_zone
from rollnip.rolling.mesh_solution import Figures, MeshSolution
from rollnip.rolling.search import SearchState
from rollnip.rolling.surfaces import Array, PairKernels
from rollnip.rolling.zone_meshes import Shape, ZoneMeshes, crowds_more


@dataclass(frozen=True)
class ZoneSolver:
    """Solver of a contact with given zones, on meshes with nodes at their ends."""

    nip: Nip
    model: Model
    kernels: PairKernels
    given: GivenStates = field(default_factory=GivenStates)

    @cached_property
    def meshes(self) -> ZoneMeshes:
        """The meshes whose nodes follow the ends of zones."""
        return ZoneMeshes(self.nip)

    @cached_property
    def settled_change(self) -> float:
        """Change of the second-order terms at which iterations stop, over the tolerance.

        Under a stiff skin the pressure beside an edge responds as much more to a change of the gap
        as the skin is stiffer than what it covers. A mesh that only looks for zones needs no such
        accuracy.
        """
        return NEGLIGIBLE / STIFF_SKIN if self._has_skin else NEGLIGIBLE

    @cached_property
    def _has_skin(self) -> bool:
        return has_stiff_skin((self.nip.upper, self.nip.lower))

    def renewed(self, state: SearchState) -> SearchState:
        """Return the state with the second order evaluated from its last solution.

        It is unchanged if the second order has converged, or is fixed.
        """
        before = state.before
        if self.kernels.is_fixed or state.is_quiet:
            return state
        mesh, second, change = own_second_order(self.nip, self.model.geometry, self.kernels, before)
        change /= self.model.tolerance
        expected = to_come_after(change, state.change)
        before = replace(before, mesh=mesh, second=second)
        return SearchState(state.layout, before, change, expected)

    def solve(self, state: SearchState, shape: Shape) -> tuple[MeshSolution, Layout]:
        """Return the solution on one mesh, and the zones with the ends that it proposes."""
        layout, before = state.layout, state.before
        mesh = self.meshes.at_ends(layout, shape, before.mesh.kernels)
        start = layout.states_on(mesh.inner), before.second.carried(before.mesh, mesh), before.steps
        latest = solve_on_mesh(
            self.nip, self.model, mesh, start, self.given, self.settled_change, layout.zones
        )
        proposed = layout.with_proposed_ends(
            mesh.inner, latest.state, self.nip.friction, mesh.fine.exponents
        )
        # Under a stiff skin ends without a place are found one by one (decisions 83 and 88).
        if not self._has_skin:
            shortest = shortest_zone(self.nip, self.model, layout.width)
            proposed = layout.with_reversals(proposed, shortest)
        return latest, proposed

    def singular(self, latest: MeshSolution, layout: Layout) -> Array | None:
        """Return `Layout.singular`; None with friction, or with several zones.

        With friction, unlike surfaces that stick up to an edge have an oscillating inverse square
        root in the shear, which the pressure follows.
        """
        if self.nip.friction > 0.0 or layout.states.size > 1:
            return None
        return layout.singular(latest.mesh.inner, latest.state)


@dataclass(slots=True)
class EndSearch:
    """The search for the ends of zones at one mesh size, and its last solution.

    Attributes
    ----------
    solver : of the contact with given zones.
    count : rough number of elements.
    state : state of the search, with the zones of the last mesh, or of the next one.
    nearest : smallest misplacement so far, over the width.
    ends : Broyden's method for the ends of the current zones.
    end_sensitivity : see `SearchState`.
    shape : of the meshes with the current zones; None: choose one.
    last : zones and figures of the last mesh of this shape; None: there is none.
    meshes : number of meshes with the current zones.
    tried : keys of zones tried before.
    shows_sensitivity : whether ``end_sensitivity`` may be used for the next mesh size.
    latest : the solution on the last mesh.
    proposed : its zones with the ends where the solution puts them.
    next_layout : its zones with the ends at the next places to try.
    misplacement : distance of the ends from the proposed places, over the width.
    """

    solver: ZoneSolver
    count: int
    state: SearchState
    nearest: float
    ends: Secants
    end_sensitivity: Figures | None
    shape: Shape | None = None
    last: tuple[Layout, Figures] | None = None
    meshes: int = 0
    tried: set[bytes] = field(default_factory=set)
    shows_sensitivity: bool = True
    latest: MeshSolution = field(init=False)
    proposed: Layout = field(init=False)
    next_layout: Layout = field(init=False)
    misplacement: float = field(init=False)

    @classmethod
    def of(cls, solver: ZoneSolver, start: SearchState, count: int) -> EndSearch:
        """Begin a search with the zones of ``start``."""
        ends = Secants(start.misplacement * start.layout.width, start.jacobian)
        state = solver.renewed(start)
        return cls(solver, count, state, start.misplacement, ends, start.end_sensitivity)

    @property
    def layout(self) -> Layout:
        """The zones of the last mesh."""
        return self.state.layout

    @property
    def is_quiet(self) -> bool:
        """Whether the second order will no longer change."""
        return self.solver.kernels.is_fixed or self.state.is_quiet

    @property
    def end_error(self) -> Figures | None:
        """Change of each figure that the misplacement may cause; None: not known."""
        moved = self.next_layout.distance(self.layout)
        return None if self.end_sensitivity is None else self.end_sensitivity.times(moved)

    def solve_mesh(self) -> None:
        """Solve on the next mesh, and find where its solution puts the ends."""
        self.meshes += 1
        solver, layout, shape = self.solver, self.layout, self._choose_shape()
        self.latest, self.proposed = solver.solve(self.state, shape)
        self.misplacement = self.proposed.distance(layout)
        self.nearest = min(self.nearest, self.misplacement)
        self.next_layout = self.ends.next_layout(
            layout,
            self.proposed,
            solver.singular(self.latest, layout),
            only_ends_move=self.latest.settled and self.is_quiet,
        )
        self._learn_sensitivity()

    def _choose_shape(self) -> Shape:
        """Return the shape of the next mesh: the last one, unless nodes must crowd more.

        Elements are kept while ends are sought, as another mesh would shift the ends.
        """
        layout = self.layout
        crowding = self.solver.meshes.crowding(layout, self.nearest * layout.width)
        if self.shape is None or crowds_more(crowding, self.shape[1]):
            self.shape = elements_of_zones(layout.breaks, self.count, crowding), crowding
            self.ends.forget()
            self.last = None
        return self.shape

    def _learn_sensitivity(self) -> None:
        """Update how figures depend on the ends, from the last two meshes.

        A single mesh uses what another size has shown, unless its zones change too much for that.
        """
        layout, figures = self.layout, self.latest.figures
        breaks, tolerance = self.next_layout.breaks, self.solver.model.tolerance
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

    def change_zones(self, other: SearchState, *, was_placed: bool) -> None:
        """Go on with other zones; ``was_placed``: whether the ends of the last ones were placed."""
        self.tried.add(other.layout.key)
        self.ends = Secants(self.nearest * self.layout.width)
        self.state, self.shape = self.solver.renewed(other), None
        # Ends that have been placed before hardly move: their effect cannot be measured.
        self.shows_sensitivity = self.shows_sensitivity and not was_placed
        self.end_sensitivity, self.meshes = None, 0

    def move_ends(self) -> None:
        """Go on with the same zones, and their ends at the next places."""
        state = self.state
        self.state = self.solver.renewed(
            SearchState(self.next_layout, self.latest, state.change, state.expected)
        )

    def result(self) -> SearchState:
        """Return the state of the search with the ends placed."""
        return replace(
            state_at(self.next_layout, self.latest, self.state, self.misplacement),
            end_error=self.end_error,
            end_sensitivity=self.end_sensitivity if self.shows_sensitivity else None,
            jacobian=self.ends.jacobian,
        )


def state_at(
    proposed: Layout, latest: MeshSolution, state: SearchState, misplacement: float
) -> SearchState:
    """Return the state of the search with the ends of zones at their proposed places."""
    figures = replace(latest.figures, nip_width=proposed.width)
    latest = replace(latest, zones=proposed.zones, figures=figures)
    return SearchState(proposed, latest, state.change, state.expected, misplacement)
