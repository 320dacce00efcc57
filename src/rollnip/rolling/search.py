"""Which zones a contact has: what a solution says of its own."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import inf

import numpy as np

from rollnip.contact import (
    CoupledActiveSet,
    Layout,
    State,
    States,
    contact_intervals,
    next_slip,
    next_states,
)
from rollnip.contact.features import runs
from rollnip.contact.secants import Secants
from rollnip.model import FINITE, Geometry, Model
from rollnip.nip import Nip
from rollnip.rolling.assemble import second_order
from rollnip.rolling.iterations import STILL
from rollnip.rolling.lengths import shortest_zone
from rollnip.rolling.round import Figures, Round
from rollnip.rolling.surfaces import PairKernels

_STICK_AND_SLIP = CoupledActiveSet(wanted=next_slip)
NEAR_ENOUGH = 0.1
"""How far ends may be off, over the width of the contact, to begin with and to see what slips.

Likewise the room beside edges that are not known yet, and the relative change of a half-width or
of a correction with which a contact is still a start for the next one.
"""


@dataclass(frozen=True, slots=True)
class SearchState:
    """State of the search for zones and their ends.

    Attributes
    ----------
    layout : where the zones are thought to be.
    before : the last solution.
    change : of the second-order terms when the second order of "second" was last evaluated, over
        the tolerance.
    expected : the change that all further evaluations would add up to, over the tolerance.
    misplacement : of the ends of zones at most, over the width of the contact.
    left : what that may still change of each figure; None: not known.
    effect : what ends misplaced by the width would change of each figure; None: not known.
    """

    layout: Layout
    before: Round
    change: float = inf
    expected: float = inf
    misplacement: float = NEAR_ENOUGH
    left: Figures | None = None
    effect: Figures | None = None

    @property
    def is_quiet(self) -> bool:
        """Return whether further evaluations of the second order would change too little."""
        return self.expected <= 1.0


@dataclass(frozen=True, slots=True)
class ZoneSearch:
    """The search for the zones of a nip, for one model and its influence functions."""

    nip: Nip
    model: Model
    kernels: PairKernels

    def other_zones(
        self,
        latest: Round,
        zones: tuple[Layout, Layout],
        ends: Secants,
        *,
        is_placed: bool,
        is_near: bool,
    ) -> Iterator[SearchState]:
        """Give the other zones that a solution calls for; none where it agrees with its own.

        Parameters
        ----------
        latest : the solution.
        zones : its zones, and with their ends where the solution puts them.
        ends : what meshes with the same zones have shown.
        is_placed, is_near : whether the ends lie where they should, or nearly.
        """
        layout, proposed = zones
        keeps_stick = _keeps_stick(latest)
        for number in np.flatnonzero(ends.vanishing(layout, proposed)):
            fewer = layout.without(int(number), keeps_stick=keeps_stick)
            if fewer is not None:
                yield SearchState(fewer, latest)
        if not (is_placed or is_near):
            return
        wanted = self.wanted(latest, layout, whole=is_placed)
        if wanted is not None:
            edges = proposed if proposed.is_proper else layout.towards(proposed)
            found = self.between_edges(latest, wanted, edges, self.model.geometry)
            # The ends of the same zones move without that.
            if found is not None and not found.layout.is_like(layout):
                yield found
        if not is_placed:
            return
        slipping = self.slipping_at_edges(latest, layout)
        if slipping is not None:
            yield SearchState(slipping, latest)
        if self.pulls(latest):
            parted = self.parted(latest, layout)
            if parted is not None:
                yield SearchState(parted, latest)

    def wanted(self, latest: Round, layout: Layout, *, whole: bool) -> States | None:
        """Return the states that a solution calls for; None where nodes in contact have them.

        Violations up to `STILL` of what the residual of a result may have are no reason for another
        state: with all of that, zones of slip at edges are missed on which the creepage of a wide,
        thin covering depends. At finite strain all of it is none, for the correction may leave it.
        Nor are those of the nodes next to the end of a zone, which may be misplaced. ``whole``:
        whether contact is examined too; until the edges are placed, only stick and slip.
        """
        slack, given = self.model.tolerance, latest.state.states
        if self.model.geometry not in FINITE:
            slack *= STILL
        wanted = (next_states if whole else next_slip)(latest.problem, latest.state, slack)
        differs = (wanted != given) & (given != State.FREE)
        ends = layout.ends(latest.problem.x)
        differs[ends] = False  # ends belong to two zones alike
        differs[ends[1:-1] - 1] = differs[ends[1:-1] + 1] = False
        if not differs.any():
            return None
        return next_slip(latest.problem, latest.state, slack) if whole else wanted

    def pulls(self, latest: Round) -> bool:
        """Return whether surfaces in contact pull at each other, but in the elements at edges."""
        return bool(np.any(latest.pressure[~latest.mesh.is_beside_edge] < 0.0))

    def parted(self, latest: Round, layout: Layout) -> Layout | None:
        """Return the zones with a free one where the surfaces pull hardest; None if not in one."""
        lowest, pulls = int(np.argmin(latest.pressure)), latest.pressure < 0.0
        first, last = next(run for run in runs(pulls) if run[0] <= lowest <= run[1])
        return layout.parted(float(latest.x[first]), float(latest.x[last]))

    def between_edges(
        self, latest: Round, wanted: States | None, edges: Layout, geometry: Geometry
    ) -> SearchState | None:
        """Find the zones between known edges, where a solution does not agree with its own.

        Return None where the nodes keep their states, or where the zones have no layout.
        """
        given = latest.state.states
        found = _STICK_AND_SLIP.solve(latest.problem, given if wanted is None else wanted)
        if np.array_equal(found.states, given):
            return None
        pieces = contact_intervals(edges.zones)
        layout = Layout.found(latest.problem.x, found, self.nip.friction, *pieces)
        if layout is None:
            return None
        layout = layout.of_length(self._shortest(layout), keeps_stick=_keeps_stick(latest))
        second = second_order(self.nip, geometry, latest.mesh, found)
        steps = latest.steps + found.steps
        return SearchState(layout, replace(latest, state=found, second=second, steps=steps))

    def slipping_at_edges(self, latest: Round, layout: Layout) -> Layout | None:
        """Return the layout with slip at edges, where it has a length beyond the errors of edges.

        Return None where there is none.
        """
        if self.nip.friction == 0.0:
            return None
        least = self._shortest(layout)
        x, state = latest.mesh.inner, latest.state
        slipping = layout.slipping_at_edges(x, state, self.nip.friction, least)
        return None if slipping.is_like(layout) else slipping

    def _shortest(self, layout: Layout) -> float:
        return shortest_zone(self.nip, self.model, layout.width)


def _keeps_stick(latest: Round) -> bool:
    """Return whether one zone of stick must be left, from which a wanted traction is found."""
    return latest.problem.control.traction is not None
