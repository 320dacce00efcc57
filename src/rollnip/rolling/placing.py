"""The free boundary at one mesh size: meshes whose nodes follow the ends of zones.

The tractions at the first nodes beside each end propose where it should be
(`contact.Layout.with_proposed_ends`), and Broyden's method moves it there (`contact.secants`). Once
the ends are nearly right, a solution shows whether its zones are the right ones
(`search.ZoneSearch`).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import inf, log10

import numpy as np

from rollnip.contact import GivenStates, Layout, elements_of_zones
from rollnip.contact.secants import Secants
from rollnip.influence import has_stiff_skin
from rollnip.model import FINITE, Model
from rollnip.nip import Nip
from rollnip.rolling.assemble import second_order
from rollnip.rolling.changes import to_come_after
from rollnip.rolling.estimates import length_change_ratio
from rollnip.rolling.iterations import (
    NEGLIGIBLE,
    NEGLIGIBLE_UNDER_SKIN,
    change_of,
    held_from,
    solve_on_mesh,
)
from rollnip.rolling.mesh_solution import Figures, MeshSolution, error_ratio
from rollnip.rolling.search import NEAR_ENOUGH, SearchState, ZoneSearch
from rollnip.rolling.surfaces import Array, PairKernels
from rollnip.rolling.zone_meshes import Shape, ZoneMeshes, are_too_many, crowds_more

# Most meshes of one size with the same zones, at a tolerance of 1e-3; one more for each further
# digit. Of 708 sizes of 200 random nips one needed more; those that failed would have taken 10 to
# 19.
MOST_MESHES = 8
# Additional meshes for the edges of a single zone with boundary layers: an edge that is misplaced
# by more than a boundary layer is found by bisection, as a solution shows only in which direction
# it should move.
_MOST_HALVINGS = 6


@dataclass(frozen=True)
class Placing:
    """Solver for the zones of a nip and their ends, on meshes of a given size."""

    nip: Nip
    model: Model
    kernels: PairKernels
    given: GivenStates = field(default_factory=GivenStates)

    def solve(
        self, start: SearchState, count: int, *, zones_known: bool, settles_figures: bool = False
    ) -> SearchState | None:
        """Return the solution with placed ends on a mesh of given size, and its zones.

        Each step solves on one mesh and moves its ends, or changes the zones if the solution shows
        that there are others.

        Parameters
        ----------
        start : state of the search, with the zones to start from.
        count : rough number of elements.
        zones_known : whether the zones are known to be right.
        settles_figures : whether to place the ends so exactly that the figures no longer change
            with them. Two meshes show how figures depend on ends, or one if the previous size has
            shown it.

        Returns
        -------
        None where no such solution is found.
        """
        # The second order held so far is from a coarser mesh: each size evaluates its own.
        state, known_to = self._renewed(replace(start, expected=inf)), start.misplacement
        shape: Shape | None = None
        ends, meshes, is_seen = Secants(known_to * start.layout.width), 0, True
        last: tuple[Layout, Figures] | None = None
        end_sensitivity = start.end_sensitivity
        tried: set[bytes] = set()
        most_meshes = self._most_meshes(self.meshes.crowding(start.layout))
        while meshes < most_meshes and _can_be_placed(state.layout):
            meshes += 1
            layout = state.layout
            crowding = self.meshes.crowding(layout, known_to * layout.width)
            if shape is None or crowds_more(crowding, shape[1]):
                # Elements are kept while ends are sought, as another mesh would shift the ends.
                shape = elements_of_zones(layout.breaks, count, crowding), crowding
                ends.forget()
                last = None
            latest, proposed = self._solved_on(state, shape)
            misplacement = proposed.distance(layout)
            known_to = min(known_to, misplacement)
            is_quiet = self.kernels.is_fixed or state.is_quiet
            is_near = not zones_known and misplacement < NEAR_ENOUGH and is_quiet
            is_settled = latest.settled and is_quiet
            # Errors are estimated from sizes with the same zones only.
            is_close = settles_figures and layout.is_like(start.layout)
            next_layout = ends.next_layout(
                layout, proposed, self._singular(latest, layout), only_ends_move=is_settled
            )
            if last is not None:
                end_sensitivity = _sensitivity_to_ends(last, (layout, latest.figures))
            elif length_change_ratio(layout.breaks, next_layout.breaks, self.model.tolerance) > 1.0:
                end_sensitivity = (
                    None  # zones change too much for what another size has shown to apply
                )
            end_error = (
                None
                if end_sensitivity is None
                else end_sensitivity.times(next_layout.distance(layout))
            )
            last = layout, latest.figures
            by_figures = is_close and self._judges_ends_by_figures
            is_placed = (
                self._is_placed(layout, proposed, zones_known=zones_known, by_figures=by_figures)
                and (proposed.is_proper and is_settled)
                and not (by_figures and self._changes(latest, end_error))
                and not (_is_false_at_edge(latest) or (is_close and self._exceeds_bound(latest)))
                and self.meshes.resolves(layout, shape)
            )
            others = self.search.other_zones(
                latest, (layout, proposed), ends, is_placed=is_placed, is_near=is_near
            )
            other = _untried(others, layout, tried)
            if other is not None:
                tried.add(other.layout.key)
                state, shape = self._renewed(other), None
                ends = Secants(known_to * layout.width)
                # Ends that have been placed before hardly move: their effect cannot be measured.
                is_seen, end_sensitivity = is_seen and not is_placed, None
                meshes = 0
            elif is_placed:
                if self.search.has_tension(latest):
                    return None
                placed = _state_at(next_layout, latest, state, misplacement)
                return replace(
                    placed,
                    end_error=end_error,
                    end_sensitivity=end_sensitivity if is_seen else None,
                )
            else:
                state = self._renewed(
                    SearchState(next_layout, latest, state.change, state.expected)
                )
        return None

    def solve_at_moved_ends(self, state: SearchState) -> SearchState | None:
        """Return the solution with the ends moved to where the last solution put them.

        It takes one mesh like the last one if the ends hardly move, otherwise two. The ends need
        not be placed.

        Returns
        -------
        None where the solution calls for other zones, or the ends move by more than before.
        """
        fine = state.before.mesh.fine
        shape, misplacement = (np.array(fine.elements), fine.crowding), inf
        for _ in range(2):
            layout, before = state.layout, misplacement
            latest, proposed = self._solved_on(state, shape)
            misplacement = proposed.distance(layout)
            is_placed = self._is_placed(layout, proposed, zones_known=True)
            if (
                not proposed.is_proper
                or self.search.changed_states(latest, layout, checks_contact=is_placed) is not None
            ):
                return None
            if misplacement > max(self.model.tolerance, before):
                return None
            state = _state_at(proposed, latest, state, misplacement)
            if misplacement <= self.model.tolerance:
                break
        return state

    @cached_property
    def meshes(self) -> ZoneMeshes:
        """The meshes whose nodes follow the ends of zones."""
        return ZoneMeshes(self.nip)

    @cached_property
    def search(self) -> ZoneSearch:
        """The search for other zones that a solution calls for."""
        return ZoneSearch(self.nip, self.model, self.kernels)

    @cached_property
    def settled_change(self) -> float:
        """Change of the second-order terms at which iterations stop, over the tolerance.

        It is smaller under a stiff skin, where the pressure beside an edge responds strongly to
        small changes of the gap.
        """
        return (
            NEGLIGIBLE_UNDER_SKIN
            if has_stiff_skin((self.nip.upper, self.nip.lower))
            else NEGLIGIBLE
        )

    @property
    def _judges_ends_by_figures(self) -> bool:
        """Whether ends count as placed once the figures no longer change with them.

        Without friction figures hardly depend on the ends; at finite strain corrections need exact
        ends, whatever the figures do.
        """
        return self.nip.friction > 0.0 and self.model.geometry not in FINITE

    def _is_placed(
        self, layout: Layout, proposed: Layout, *, zones_known: bool, by_figures: bool = False
    ) -> bool:
        """Return whether the errors of the ends are small relative to the width of the contact.

        If the figures decide how exactly ends are placed (``by_figures``), the tolerance will do;
        otherwise a tenth of it. Without friction, the edges of zones that are known are placed
        relative to the boundary layer instead, if it is shorter, as the pressure changes within it.
        """
        most = self.model.tolerance * (1.0 if by_figures else NEGLIGIBLE)
        length = layout.width
        if zones_known and self.nip.friction == 0.0:
            length = min(length, self.meshes.boundary)
        return proposed.distance(layout) * layout.width <= most * length

    def _changes(self, latest: MeshSolution, end_error: Figures | None) -> bool:
        """Return whether the figures still change with the ends, by more than iterations may leave.

        ``end_error``: the expected changes; None: unknown, and taken as too large.
        """
        if end_error is None:
            return True
        return (
            error_ratio(self.nip, replace(latest, error=end_error), self.model.tolerance)
            > NEGLIGIBLE
        )

    def _exceeds_bound(self, latest: MeshSolution) -> bool:
        """Return whether the shear beside a transition exceeds its bound by more than allowed.

        A stick zone that is too long by delta has a shear beyond the bound in its last element;
        under a stiff skin, where the slightest stretch causes shear, far beyond it.
        """
        breaks = np.cumsum((0, *latest.mesh.fine.elements))[1:-1]
        x = latest.mesh.inner
        over = np.abs(latest.shear) - self.nip.friction * np.maximum(latest.pressure, 0.0)
        least = self.model.tolerance * self.nip.friction * latest.figures.peak_pressure
        places = latest.x[over > least]
        cell = np.searchsorted(x, places)
        return bool(np.isin(cell, (breaks, breaks + 1)).any())

    def _singular(self, latest: MeshSolution, layout: Layout) -> Array | None:
        """Return `Layout.singular`; None with friction, or with several zones.

        With friction, unlike surfaces that stick up to an edge have an oscillating inverse square
        root in the shear, which the pressure follows.
        """
        if self.nip.friction > 0.0 or layout.states.size > 1:
            return None
        return layout.singular(latest.mesh.inner, latest.state)

    def _most_meshes(self, crowding: tuple[float, ...]) -> int:
        most = MOST_MESHES + max(0, round(-3.0 - log10(self.model.tolerance)))
        most += round(-log10(min(crowding)))  # crowding can increase tenfold from mesh to mesh
        if len(crowding) == 1 and crowding[0] < 1.0:
            most += _MOST_HALVINGS
        return most

    def _renewed(self, state: SearchState) -> SearchState:
        """Return the state with the second order evaluated from its last solution.

        It is unchanged if the second order has converged, or is fixed.
        """
        before = state.before
        if self.kernels.is_fixed or state.is_quiet:
            return state
        mesh = before.mesh.holding(held_from(self.kernels, before))
        second = second_order(self.nip, self.model.geometry, mesh, before.state)
        change = change_of(second, before.second, mesh, self.nip, before.state)
        change /= self.model.tolerance
        expected = to_come_after(change, state.change)
        return SearchState(
            state.layout, replace(before, mesh=mesh, second=second), change, expected
        )

    def _solved_on(self, state: SearchState, shape: Shape) -> tuple[MeshSolution, Layout]:
        """Return the solution on one mesh, and the zones with the ends that it proposes."""
        layout, before = state.layout, state.before
        mesh = self.meshes.at_ends(layout, shape, before.mesh.kernels)
        start = layout.states_on(mesh.inner), before.second.carried(before.mesh, mesh), before.steps
        latest = solve_on_mesh(
            self.nip, self.model, mesh, start, self.given, self.settled_change, layout.zones
        )
        return latest, layout.with_proposed_ends(mesh.inner, latest.state, self.nip.friction)


def _untried(
    others: Iterable[SearchState], layout: Layout, tried: set[bytes]
) -> SearchState | None:
    """Return the first candidate not tried before; one with fewer zones than now may be retried."""
    for other in others:
        if other.layout.states.size < layout.states.size or other.layout.key not in tried:
            return other
    return None


def _sensitivity_to_ends(before: tuple[Layout, Figures], now: tuple[Layout, Figures]) -> Figures:
    """Return the change of the figures by the last move of the ends, per length of the move."""
    step = now[0].distance(before[0])
    return now[1].change_from(before[1]).times(1.0 / step if step > 0.0 else 0.0)


def _is_false_at_edge(latest: MeshSolution) -> bool:
    """Return whether the pressure at an edge shows that the edge is misplaced."""
    pressure = latest.state.pressure
    return latest.mesh.has_tension_at_edge(pressure) or latest.mesh.peaks_at_edge(pressure)


def _can_be_placed(layout: Layout) -> bool:
    """Return whether all zones have a length, and are not too many."""
    return layout.is_proper and not are_too_many(layout.states.size)


def _state_at(
    proposed: Layout, latest: MeshSolution, state: SearchState, misplacement: float
) -> SearchState:
    """Return the state of the search with the ends of zones at their proposed places."""
    figures = replace(latest.figures, nip_width=proposed.width)
    latest = replace(latest, zones=proposed.zones, figures=figures)
    return SearchState(proposed, latest, state.change, state.expected, misplacement)
