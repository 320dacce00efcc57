"""The free boundary at one mesh size: meshes whose nodes follow the ends of zones.

The tractions at the first nodes beside each end propose where it should be
(`contact.Layout.with_proposed_ends`), and Broyden's method moves it there (`contact.secants`). Once
the ends are nearly right, a solution shows whether its zones are the right ones
(`zone_search`).
"""

from __future__ import annotations

from dataclasses import replace
from enum import IntEnum
from math import inf, log10

import numpy as np

from rollnip.contact import NEAR_ENOUGH, Layout
from rollnip.rolling.changes import NEGLIGIBLE
from rollnip.rolling.end_search import EndSearch
from rollnip.rolling.lengths import boundary_layer, thinnest_covering
from rollnip.rolling.mesh_solution import MeshSolution
from rollnip.rolling.rolling_contact import RollingContact
from rollnip.rolling.zone_search import changed_states, other_zones
from rollnip.rolling.zone_solver import SearchState, are_too_many, crowding_for, crowds_more

# Most meshes of one size with the same zones, at a tolerance of 1e-3; one more for each further
# digit. Of 708 sizes of 200 random nips one needed more; those that failed would have taken 10 to
# 19.
MOST_MESHES = 8


class Aim(IntEnum):
    """The purpose of placing ends; each one asks for more exact ends than the one before."""

    ZONES = 0  # to find the zones
    ENDS = 1  # where the zones are known
    FIGURES = 2  # for a solution that may be the last: figures must not change with the ends


def place_ends(
    start: SearchState, count: int, aim: Aim, *, correction_still_changes: bool = False
) -> SearchState | None:
    """Return the solution with placed ends on a mesh of given size, and its zones.

    Each step solves on one mesh and moves its ends, or changes the zones if the solution shows that
    there are others.

    Parameters
    ----------
    start : state of the search, with the zones and a solution to start from.
    count : rough number of elements.
    aim : how exactly. Two meshes show how figures depend on ends, or one if the previous size has
        shown it.
    correction_still_changes : whether the correction held has moved the ends and will move them
        again, on meshes like the last one. Then they need only agree, see `_ends_agree`.

    Returns
    -------
    None where no such solution is found.
    """
    # The second order held so far is from a coarser mesh: each size evaluates its own.
    search = EndSearch.of(replace(start, to_come=inf), count)
    if correction_still_changes:
        fine = start.solution.mesh.fine
        search.shape = np.array(fine.elements), fine.crowding
    most_meshes = _most_meshes(start.contact, start.layout)
    while search.meshes < most_meshes and _can_be_placed(search.layout):
        search.solve_mesh()
        if correction_still_changes and _ends_agree(search, aim):
            return search.result()
        # The figures show errors of ends only with the zones of the previous size.
        is_new = aim is Aim.FIGURES and not search.layout.is_like(start.layout)
        is_placed = _is_placed(search, Aim.ENDS if is_new else aim)
        is_near = aim is Aim.ZONES and search.is_near
        other = search.untried(other_zones(search, is_placed=is_placed, is_near=is_near))
        if other is not None:
            search.change_zones(other)
        elif not is_placed:
            search.move_ends()
        elif search.latest.has_tension:
            break
        else:
            return search.result()
    return None


def _ends_agree(search: EndSearch, aim: Aim) -> bool:
    """Return whether all ends lie within the tolerance of where the solution puts them.

    That is enough while the correction still changes. A transition that is misplaced by more has
    shears beyond the bound beside it, and the correction of such shears would move it again. The
    solution must call for no other zones. Beside a boundary layer or a short zone that is not exact
    enough for the last contact: there pressure and shear must be right.
    """
    proposed, latest = search.proposed, search.latest
    distance = proposed.distance(search.layout, transitions_count=1.0)
    if not (proposed.is_proper and distance <= search.contact.tolerance):
        return False
    if aim is Aim.FIGURES and (
        _shows_misplaced_edge(latest) or _shows_misplaced_transition(search)
    ):
        return False
    return changed_states(search, checks_contact=_are_ends_near(search, aim)) is None


def _is_placed(search: EndSearch, aim: Aim) -> bool:
    """Return whether the ends on a mesh are placed, and nothing in its solution denies it."""
    contact, layout, latest = search.contact, search.layout, search.latest
    is_last = aim is Aim.FIGURES
    return (
        _are_ends_near(search, aim)
        and (search.proposed.is_proper and latest.settled and search.state.second_order_settled)
        and not (_figures_decide(search, aim) and _figures_change(search))
        and not (_shows_misplaced_edge(latest) or (is_last and _shows_misplaced_transition(search)))
        and not crowds_more(crowding_for(contact, layout), latest.mesh.fine.crowding)
    )


def _are_ends_near(search: EndSearch, aim: Aim) -> bool:
    """Return whether the errors of the ends are small relative to the width of the contact.

    If the figures decide how exactly ends are placed, the tolerance will do; otherwise a tenth of
    it. Without friction, the edges of zones that are known are placed relative to the boundary
    layer instead, if it is shorter, as the pressure changes within it.
    """
    contact, layout = search.contact, search.layout
    most = contact.tolerance * (1.0 if _figures_decide(search, aim) else NEGLIGIBLE)
    length = layout.width
    if aim > Aim.ZONES and contact.nip.friction == 0.0:
        length = min(length, boundary_layer(contact.nip))
    shortest = float(layout.lengths.min())
    return search.misplacement * layout.width <= min(most * length, NEAR_ENOUGH * shortest)


def _figures_decide(search: EndSearch, aim: Aim) -> bool:
    """Return whether the figures decide how exactly ends are placed.

    Without friction they hardly depend on the ends; at finite strain corrections need ends to be
    exact, whatever the figures do.
    """
    contact = search.contact
    is_exact = contact.nip.friction == 0.0 or contact.has_finite_strain
    return aim is Aim.FIGURES and not is_exact


def _figures_change(search: EndSearch) -> bool:
    """Return whether the figures still change with the ends, by more than iterations may leave.

    All figures but the width are linear functionals of the tractions, so they depend on the ends to
    second order. Where it is not known how much, ends count that are placed a tenth as exactly as
    where figures do not decide, over the width or the thickness of a thin covering.
    """
    end_error = search.end_error
    if end_error is None:
        length = min(search.layout.width, thinnest_covering(search.contact.nip))
        most = NEGLIGIBLE**2 * search.contact.tolerance * length
        return search.misplacement * search.layout.width > most
    return replace(search.latest, error=end_error).error_ratio > NEGLIGIBLE


def _shows_misplaced_transition(search: EndSearch) -> bool:
    """Return whether shear or pressure show that a transition is misplaced.

    Between unlike surfaces the pressure beside a transition may rise to a cusp. Where that is the
    peak, the pressure there must not change by more than the tolerance over the misplacement.
    """
    latest, moves = search.latest, np.abs(search.proposed.breaks - search.layout.breaks)
    x, pressure, fine = latest.mesh.inner, latest.state.pressure, latest.mesh.fine
    slopes = np.abs(np.diff(pressure) / np.diff(x))
    most = search.contact.tolerance * pressure.max()
    changes = (
        max(slopes[node - 1], slopes[node]) * moves[fine.breaks.index(node)]
        for node in latest.transitions_at_peak
        if fine.exponent_at(node)
    )
    return any(change > most for change in changes) or _exceeds_bound(latest)


def _exceeds_bound(latest: MeshSolution) -> bool:
    """Return whether the shear beside a transition exceeds its bound by more than allowed.

    A stick zone that is too long by delta has a shear beyond the bound in its last element; under a
    stiff skin, where the slightest stretch causes shear, far beyond it.
    """
    least = latest.contact.tolerance * latest.nip.friction * latest.figures.peak_pressure
    exceeds = latest.over_bound > least
    cells = set(latest.mesh.inner.searchsorted(latest.x[exceeds]).tolist())
    return any(not cells.isdisjoint((end, end + 1)) for end in latest.mesh.fine.inner_breaks)


def _most_meshes(contact: RollingContact, layout: Layout) -> int:
    """Return the most meshes of one size with the same zones."""
    crowding = crowding_for(contact, layout)
    most = MOST_MESHES + max(0, round(-3.0 - log10(contact.tolerance)))
    strongest = min(map(min, crowding))
    most += round(-log10(strongest))  # crowding can increase tenfold from mesh to mesh
    # An edge that is misplaced by more than a boundary layer is found by bisection, as a solution
    # shows only in which direction it should move. Likewise the length of stick where slip changes
    # its sign is halved.
    if (len(crowding) == 1 and strongest < 1.0) or layout.reversals:
        most += MOST_MESHES // 2
    return most


def _shows_misplaced_edge(latest: MeshSolution) -> bool:
    """Return whether the pressure at an edge shows that the edge is misplaced."""
    pressure = latest.state.pressure
    return latest.mesh.has_tension_at_edge(pressure) or latest.mesh.peaks_at_edge(pressure)


def _can_be_placed(layout: Layout) -> bool:
    """Return whether all zones have a length, and are not too many."""
    return layout.is_proper and not are_too_many(layout.states.size)
