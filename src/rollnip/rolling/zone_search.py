"""The search for the zones of a contact: which other zones a solution calls for."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from rollnip.contact import (
    Layout,
    State,
    States,
    active_set,
    contact_intervals,
    next_states,
    slipping_at_edges,
)
from rollnip.contact.features import runs
from rollnip.rolling.assemble import lagged_terms
from rollnip.rolling.changes import NEGLIGIBLE
from rollnip.rolling.end_search import EndSearch
from rollnip.rolling.mesh_solution import MeshSolution
from rollnip.rolling.neglected_slip import (
    is_negligible,
    negligible_change,
    negligible_slip,
    overlooked_states,
)
from rollnip.rolling.zone_solver import SearchState


def other_zones(search: EndSearch, *, is_placed: bool, is_near: bool) -> Iterator[SearchState]:
    """Yield the zones that the last solution of a search calls for, in the order to try them.

    There are none if the solution is consistent with its own zones. Once its ends are placed
    they may be its own zones with other ends.

    ``is_placed``, ``is_near`` : whether the ends are placed, or nearly so.
    """
    latest, layout, proposed = search.latest, search.layout, search.proposed
    for number in search.vanishing:
        fewer = layout.without(number, keeps_stick=_keeps_stick(latest))
        if fewer is not None:
            yield SearchState(fewer, latest)
    if not (is_placed or is_near):
        return
    wanted = changed_states(search, checks_contact=is_placed)
    if wanted is not None:
        edges = proposed if proposed.is_proper else layout.stepped_towards(proposed)
        found = _between_edges(latest, wanted, edges)
        # Until they are placed the ends of the same zones move anyway.
        if found is not None and (is_placed or not found.layout.is_like(layout)):
            yield found
    if is_placed:
        yield from _unresolved_zones(search)


def _unresolved_zones(search: EndSearch) -> Iterator[SearchState]:
    """Yield zones that no nodal state shows: slip at an edge, a gap at tension, weak changes.

    The ends of the solution are placed. Changes of state are weak that violate the conditions by
    less than counts, but change the creepage.
    """
    latest, layout = search.latest, search.layout
    slipping = _with_slip_at_edges(latest, layout)
    if slipping is not None:
        yield SearchState(slipping, latest)
    if latest.has_tension:
        opened = _with_gap_at_tension(latest, layout)
        if opened is not None:
            yield SearchState(opened, latest)
    wanted, change = overlooked_states(latest)
    if not change <= negligible_change(latest):
        found = _between_edges(latest, wanted, search.proposed)
        if found is not None:
            yield found


def changed_states(search: EndSearch, *, checks_contact: bool) -> States | None:
    """Return the states that the last solution calls for; None if no node in contact changes.

    Violations up to `NEGLIGIBLE` times the tolerance change no state. If all of the tolerance
    were allowed, slip zones at edges would be missed on which the creepage of a wide, thin
    covering depends. At finite strain all of it is allowed, as the correction may leave as
    much. Nodes next to the ends of zones do not count, as the ends may be misplaced, nor do
    those that negligible slip covers.

    ``checks_contact``: whether to check contact too; until the edges are placed, only stick and
    slip are checked.
    """
    latest = search.latest
    slack, given = latest.contact.tolerance, latest.state.states
    if not latest.contact.has_finite_strain:
        slack *= NEGLIGIBLE
    implied = partial(next_states, latest.problem, latest.state, slack)
    wanted = implied(holds_contact=not checks_contact)
    differs = (wanted != given) & (given != State.FREE)
    ends = search.layout.ends(latest.problem.x)
    differs[ends] = False  # a node at an end belongs to both zones
    differs[ends[1:-1] - 1] = differs[ends[1:-1] + 1] = False
    for slip in negligible_slip(latest):
        differs[slip.covers(latest.problem.x)] = False
    if not differs.any():
        return None
    return implied(holds_contact=True) if checks_contact else wanted


def _with_gap_at_tension(latest: MeshSolution, layout: Layout) -> Layout | None:
    """Return the zones with a free zone where the tension is highest.

    Return None where the interval under tension is not within one zone.
    """
    lowest, pulls = int(np.argmin(latest.pressure)), latest.pressure < 0.0
    first, last = next(run for run in runs(pulls) if run[0] <= lowest <= run[1])
    return layout.with_gap(float(latest.x[first]), float(latest.x[last]))


def _between_edges(latest: MeshSolution, wanted: States, edges: Layout) -> SearchState | None:
    """Return the stick and slip zones between given edges, by the active set.

    It holds the contact set, and starts from the states ``wanted``. Return None where the nodes
    keep the states of the solution, or the zones have no layout.
    """
    found = active_set(latest.problem, wanted, holds_contact=True)
    if not found.settled or np.array_equal(found.states, latest.state.states):
        return None
    pieces = contact_intervals(edges.zones)
    layout = Layout.from_nodes(latest.problem.x, found, latest.nip.friction, *pieces)
    if layout is None:
        return None
    shortest = latest.contact.shortest_zone(layout.width)
    layout = layout.without_short_zones(shortest, edges, keeps_stick=_keeps_stick(latest))
    for slip in negligible_slip(latest):
        layout = slip.left_out_of(layout, keeps_stick=_keeps_stick(latest))
    lagged = lagged_terms(latest.contact, latest.mesh, found)
    steps = latest.steps + found.steps
    return SearchState(layout, replace(latest, state=found, lagged=lagged, steps=steps))


def _with_slip_at_edges(latest: MeshSolution, layout: Layout) -> Layout | None:
    """Return the layout with slip zones added at edges that the solution sticks up to.

    Return None if none would be as long as the shortest relevant zone.
    """
    friction = latest.nip.friction
    if friction == 0.0:
        return None
    slipping = slipping_at_edges(
        layout,
        latest.edges,
        friction,
        latest.contact.shortest_zone(layout.width),
        matters=lambda slip: not is_negligible(latest, slip),
    )
    return None if slipping.is_like(layout) else slipping


def _keeps_stick(latest: MeshSolution) -> bool:
    """Return whether a stick zone must remain, as a prescribed traction needs one."""
    return latest.problem.control.traction is not None
