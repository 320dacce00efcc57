"""The search for the zones of a contact: which other zones a solution calls for."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import inf

import numpy as np

from rollnip.contact import (
    NEAR_ENOUGH,
    CoupledActiveSet,
    Layout,
    State,
    States,
    contact_intervals,
    next_states,
    slipping_at_edges,
)
from rollnip.contact.features import runs
from rollnip.contact.problem import Array
from rollnip.model import FINITE, Model
from rollnip.nip import Nip
from rollnip.rolling.assemble import lagged_terms
from rollnip.rolling.changes import NEGLIGIBLE
from rollnip.rolling.lengths import shortest_zone
from rollnip.rolling.mesh_solution import Figures, MeshSolution
from rollnip.rolling.neglected_slip import (
    is_negligible,
    negligible_change,
    negligible_slip,
    overlooked_states,
)

_STICK_AND_SLIP = CoupledActiveSet(holds_contact=True)


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


@dataclass(frozen=True, slots=True)
class ZoneSearch:
    """The search for the other zones that a solution calls for."""

    nip: Nip
    model: Model

    def other_zones(
        self,
        latest: MeshSolution,
        layout: Layout,
        proposed: Layout,
        vanishing: Sequence[int],
        *,
        is_placed: bool,
        is_near: bool,
    ) -> Iterator[SearchState]:
        """Yield the zones that a solution calls for, in the order to try them.

        There are none if the solution is consistent with its own zones. Once its ends are placed
        they may be its own zones with other ends.

        Parameters
        ----------
        latest, layout : the solution, and its zones.
        proposed : these zones with the ends where the solution puts them.
        vanishing : numbers of the zones to which solutions leave no length.
        is_placed, is_near : whether the ends are placed, or nearly so.
        """
        keeps_stick = _keeps_stick(latest)
        for number in vanishing:
            fewer = layout.without(number, keeps_stick=keeps_stick)
            if fewer is not None:
                yield SearchState(fewer, latest)
        if not (is_placed or is_near):
            return
        wanted = self.changed_states(latest, layout, checks_contact=is_placed)
        if wanted is not None:
            edges = proposed if proposed.is_proper else layout.stepped_towards(proposed)
            found = self.between_edges(latest, wanted, edges)
            # Until they are placed the ends of the same zones move anyway.
            if found is not None and (is_placed or not found.layout.is_like(layout)):
                yield found
        if is_placed:
            yield from self._zones_that_states_do_not_show(latest, layout, proposed)

    def _zones_that_states_do_not_show(
        self, latest: MeshSolution, layout: Layout, proposed: Layout
    ) -> Iterator[SearchState]:
        """Yield the zones that a solution with placed ends calls for, though no node's state does.

        Parameters are those of `other_zones`.
        """
        slipping = self.slipping_at_edges(latest, layout)
        if slipping is not None:
            yield SearchState(slipping, latest)
        if self.has_tension(latest):
            opened = self.with_gap_at_tension(latest, layout)
            if opened is not None:
                yield SearchState(opened, latest)
        wanted, change = overlooked_states(latest)
        if not change <= negligible_change(self.nip, self.model, latest.figures):
            found = self.between_edges(latest, wanted, proposed)
            if found is not None:
                yield found

    def changed_states(
        self, latest: MeshSolution, layout: Layout, *, checks_contact: bool
    ) -> States | None:
        """Return the states that a solution calls for; None if no node in contact changes.

        Violations up to `NEGLIGIBLE` times the tolerance change no state. If all of the tolerance
        were allowed, slip zones at edges would be missed on which the creepage of a wide, thin
        covering depends. At finite strain all of it is allowed, as the correction may leave as
        much. Nodes next to the ends of zones do not count, as the ends may be misplaced, nor do
        those that negligible slip covers.

        ``checks_contact``: whether to check contact too; until the edges are placed, only stick and
        slip are checked.
        """
        slack, given = self.model.tolerance, latest.state.states
        if self.model.geometry not in FINITE:
            slack *= NEGLIGIBLE
        implied = partial(next_states, latest.problem, latest.state, slack)
        wanted = implied(holds_contact=not checks_contact)
        differs = (wanted != given) & (given != State.FREE)
        ends = layout.ends(latest.problem.x)
        differs[ends] = False  # a node at an end belongs to both zones
        differs[ends[1:-1] - 1] = differs[ends[1:-1] + 1] = False
        for slip in negligible_slip(self.nip, self.model, latest):
            differs[slip.covers(latest.problem.x)] = False
        if not differs.any():
            return None
        return implied(holds_contact=True) if checks_contact else wanted

    def has_tension(self, latest: MeshSolution) -> bool:
        """Return whether there is tension in the contact, outside the elements at edges."""
        return bool(np.any(latest.pressure[~latest.mesh.is_beside_edge] < 0.0))

    def with_gap_at_tension(self, latest: MeshSolution, layout: Layout) -> Layout | None:
        """Return the zones with a free zone where the tension is highest.

        Return None where the interval under tension is not within one zone.
        """
        lowest, pulls = int(np.argmin(latest.pressure)), latest.pressure < 0.0
        first, last = next(run for run in runs(pulls) if run[0] <= lowest <= run[1])
        return layout.with_gap(float(latest.x[first]), float(latest.x[last]))

    def between_edges(
        self, latest: MeshSolution, wanted: States, edges: Layout
    ) -> SearchState | None:
        """Return the stick and slip zones between given edges, by the active set.

        It holds the contact set, and starts from the states ``wanted``. Return None where the nodes
        keep the states of the solution, or the zones have no layout.
        """
        found = _STICK_AND_SLIP.solve(latest.problem, wanted)
        if not found.settled or np.array_equal(found.states, latest.state.states):
            return None
        pieces = contact_intervals(edges.zones)
        layout = Layout.from_nodes(latest.problem.x, found, self.nip.friction, *pieces)
        if layout is None:
            return None
        layout = layout.without_short_zones(
            self._shortest(layout), edges, keeps_stick=_keeps_stick(latest)
        )
        for slip in negligible_slip(self.nip, self.model, latest):
            layout = slip.left_out_of(layout, keeps_stick=_keeps_stick(latest))
        lagged = lagged_terms(self.nip, self.model.geometry, latest.mesh, found)
        steps = latest.steps + found.steps
        return SearchState(layout, replace(latest, state=found, lagged=lagged, steps=steps))

    def slipping_at_edges(self, latest: MeshSolution, layout: Layout) -> Layout | None:
        """Return the layout with slip zones added at edges that the solution sticks up to.

        Return None if none would be as long as the shortest relevant zone.
        """
        if self.nip.friction == 0.0:
            return None
        figures = latest.figures
        slipping = slipping_at_edges(
            layout,
            latest.mesh.inner,
            latest.state,
            self.nip.friction,
            self._shortest(layout),
            latest.mesh.fine.exponents,
            matters=lambda slip: not is_negligible(self.nip, self.model, figures, slip),
        )
        return None if slipping.is_like(layout) else slipping

    def _shortest(self, layout: Layout) -> float:
        return shortest_zone(self.nip, self.model, layout.width)


def _keeps_stick(latest: MeshSolution) -> bool:
    """Return whether a stick zone must remain, as a prescribed traction needs one."""
    return latest.problem.control.traction is not None
