"""Search for the zones of a plate: states and ends of stick and slip, on meshes of one size.

The search starts with zones from meshes that extend beyond the contacts, where the states of all
nodes are found at once (`initial_zones`). Edges and transitions then lie at nodes of the interface
to which they belong, and the tractions at the first nodes beside them show where they belong
(`contact.Layout.with_proposed_ends`). Where a solution violates its conditions, the nodal states
are determined again.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from math import inf

import numpy as np
from numpy.typing import NDArray

from rollnip._largest import largest
from rollnip.contact import Crowding, cosine_nodes, crowding_of, elements_of_zones, subdivided
from rollnip.model import Model
from rollnip.rolling import RollingContact
from rollnip.rolling.surfaces import Mesh
from rollnip.sheet.boundary_layers import SHORTEST_LAYER, mismatch_layer, shortest_layer
from rollnip.sheet.conditions import violation
from rollnip.sheet.formulation import END_TOLERANCE
from rollnip.sheet.iterate import kernels_after
from rollnip.sheet.lagged_terms import has_no_terms
from rollnip.sheet.plate.complementarity import settled_slip, solve_complementarity
from rollnip.sheet.plate.initial_zones import InitialZones
from rollnip.sheet.plate.interface import interface_mesh, path_ratio
from rollnip.sheet.plate.iterate import (
    PlateIterate,
    added_to_peaks,
    interpolated_terms,
    pulls_at_edges,
    shear_over,
)
from rollnip.sheet.plate.lagged_terms import (
    change_of_terms,
    initial_terms,
    lagged_terms,
)
from rollnip.sheet.plate.linear_system import FactorisedPlate
from rollnip.sheet.plate.system import PlateProblem, PlateTerms
from rollnip.sheet.plate.zones import PlateZones
from rollnip.sheet.secant import SecantSteps

Array = NDArray[np.float64]

_SLACK = 0.1  # over the tolerance: relative excess of the shear that counts as rounding
_FAIRLY_PLACED = 2e-3  # end error over the width, small enough for lagged terms to settle
_NEARLY_PLACED = 0.01  # end error over the width, small enough to judge the states
# Boundary layer of the pressure on a bare roller, and opposite one, over the sheet's thickness.
_OF_THICKNESS, _OPPOSITE = 0.25, 0.45
# Least share of all elements in each zone. The strip between the edges of both contacts matters as
# much as long zones: with six elements in it on all mesh sizes, these agreed on wrong figures.
_LEAST_SHARE = 0.2
_MOST_MESHES = 18
_MOST_CHANGES = 3  # of the zones' states, before the search starts again
_MOST_NODES = 320  # of a mesh whose states are determined all at once
_MOST_ITERATIONS = 25
# Last change of the lagged terms, over the tolerance and at most. In the coarse contacts of
# "finite", whose tolerance is large, more than that moves the edges beside stiff peaks to and fro.
_STILL = 0.1, 1e-4


_Shapes = dict[tuple[int, Crowding], NDArray[np.intp]]
"""Number of elements in each zone, by interface and by the crowding of nodes in the zones."""


@dataclass(frozen=True)
class PlateSearch:
    """The search for the zones of a nip with a plate."""

    contact: RollingContact
    secants: SecantSteps[PlateZones] = field(default_factory=SecantSteps)

    def start(self, half_width: float, count: int) -> PlateIterate:
        """Return a first solution in linear geometry whose zone ends are approximately right."""
        linear = replace(self.contact.model, geometry="linear")
        plain = replace(self, contact=self.contact.with_model(linear))
        zones = self._initial_zones.around(half_width, count).without_slivers()
        iterate, _ = plain._solve_with_zones(zones, (count, _Shapes()), (1.0, inf), None)
        moved = zones.moved(iterate.problem, iterate.state)
        lagged = lagged_terms(iterate.problem, self.contact.geometry, iterate.state)
        return replace(iterate, zones=moved, lagged=lagged, misplacement=moved.distance(zones))

    @property
    def _initial_zones(self) -> InitialZones:
        return InitialZones(self.contact)

    def settle_zones(
        self,
        zones: PlateZones,
        count: int,
        before: PlateIterate,
        end_tolerance: float,
    ) -> PlateIterate:
        """Return the solution on meshes of one size with nodes at the ends of its zones.

        ``before``: a solution with approximately these zones; ``end_tolerance``: allowed error of a
        zone end, over the tolerance times the width.
        """
        allowed = end_tolerance * self.contact.tolerance
        try:
            iterate = self._settle_ends(zones, count, before, allowed)
        except np.linalg.LinAlgError:
            return replace(before, settled=False)
        if iterate.settled:
            return iterate
        start = iterate.zones if iterate.zones.is_proper else zones
        try:
            found = self._initial_zones.closer(start, iterate.lagged, count)
            again = self._settle_ends(found, count, iterate, allowed)
        except np.linalg.LinAlgError:
            return iterate
        return again if again.settled or again.misplacement < iterate.misplacement else iterate

    def _settle_ends(
        self, zones: PlateZones, count: int, before: PlateIterate, allowed: float
    ) -> PlateIterate:
        """Move the zone ends until they converge, and change zones with wrong states.

        Each sequence of zones is changed to once. Where none is left to try, the solution with
        placed ends that violates its conditions least is returned. ``allowed``: allowed error of a
        zone end, over the width.
        """
        self.secants.begin_size()
        # With a finer tolerance, stick that has closed would open by less than shows where it ends.
        reopening = max(self.contact.tolerance, Model().tolerance)
        shapes, tried = _Shapes(), set[bytes]()
        known, misplacement = min(before.misplacement, 1.0), inf
        iterate, fair, least = before, None, self.contact.tolerance
        for _ in range(_MOST_MESHES):
            zones = zones.without_slivers().reopened(END_TOLERANCE * reopening)
            if not zones.is_proper:
                break
            iterate, is_fine = self._solve_with_zones(
                zones, (count, shapes), (known, misplacement), iterate
            )
            latest = self._judged(zones, iterate, allowed, is_fine=is_fine)
            proposed, misplacement = latest.proposed, latest.misplacement
            known = min(known, misplacement)
            if latest.is_placed and (latest.is_met or latest.violated <= least):
                fair, least = latest.placed, latest.violated
                if latest.is_met:
                    break
            found = self._consistent_zones(latest) if self._is_in_doubt(latest) else None
            if found is not None and _is_other(found, latest, tried):
                if len(tried) == _MOST_CHANGES:
                    break
                tried.add(found.key)
                zones = found
                shapes.clear()
                continue
            if found is not None and found.is_like(zones):
                proposed = self._proposed(zones, iterate, found)
            if latest.is_placed and proposed.distance(zones) <= allowed:
                break
            zones = self.secants.next(proposed)
        return _unsettled(zones, iterate, misplacement) if fair is None else fair

    def _judged(
        self, zones: PlateZones, iterate: PlateIterate, allowed: float, *, is_fine: bool
    ) -> _Judged:
        """Return what a solution says about its zones.

        ``is_fine``: whether nodes crowd at their ends as much as required.
        """
        proposed = self._proposed(zones, iterate)
        misplacement, violated = proposed.distance(zones), violation(iterate)
        is_at_rest = misplacement <= allowed and iterate.settled and is_fine
        is_placed = (
            is_at_rest
            and not pulls_at_edges(iterate)
            and added_to_peaks(iterate, proposed) <= self.contact.tolerance
            and zones.shows_roots(iterate.problem, iterate.state)
        )
        return _Judged(
            iterate=iterate,
            proposed=proposed,
            misplacement=misplacement,
            violated=violated,
            is_met=largest(violated, shear_over(iterate)) <= self._slack,
            is_at_rest=is_at_rest,
            is_placed=is_placed,
        )

    def _proposed(
        self, zones: PlateZones, iterate: PlateIterate, requested: PlateZones | None = None
    ) -> PlateZones:
        """Return the zones with their ends where a solution puts them; see `PlateZones.moved`."""
        problem, state = iterate.problem, iterate.state
        moved = zones.moved(problem, state, requested)
        return self.secants.learn(zones, moved, zones.singular(problem, state))

    def _is_in_doubt(self, latest: _Judged) -> bool:
        """Return whether a solution violates its conditions by more than ends that still move."""
        is_near = latest.misplacement <= _NEARLY_PLACED and latest.violated > self.contact.tolerance
        return not latest.is_met and (latest.is_at_rest or is_near)

    def _solve_with_zones(
        self,
        zones: PlateZones,
        sizes: tuple[int, _Shapes],
        misplacement: tuple[float, float],
        before: PlateIterate | None,
    ) -> tuple[PlateIterate, bool]:
        """Solve for given zones; for ``sizes`` and the second value returned see `_problem`.

        ``misplacement``: error of the zone ends, smallest so far and on the last mesh of this size.
        """
        problem, is_fine = self._problem(zones, sizes, misplacement[0], before)
        start = initial_terms(problem) if before is None else interpolated_terms(before, problem)
        steps = 0 if before is None else before.steps
        return self._solve_on_mesh(problem, zones, start, steps, misplacement[1]), is_fine

    @cached_property
    def boundary(self) -> float:
        """Length of the shortest boundary layer at zone ends [mm]."""
        return shortest_layer(self.contact.nip)

    def _boundary_of(self, side: int) -> float:
        """Return the length of the shortest boundary layer on one interface [mm].

        On a bare roller the pressure ends in a peak about as long as the sheet is thick. Through
        the sheet the other interface feels it.
        """
        both, shortest = (self.contact.nip.upper, self.contact.nip.lower), self.boundary
        for roller, share in ((both[side], _OF_THICKNESS), (both[1 - side], _OPPOSITE)):
            if not roller.layers:
                shortest = min(shortest, share * self._thickness)
        return shortest

    @property
    def _thickness(self) -> float:
        assert self.contact.nip.sheet is not None
        return self.contact.nip.sheet.thickness

    def _problem(
        self,
        zones: PlateZones,
        sizes: tuple[int, _Shapes],
        known: float,
        before: PlateIterate | None,
    ) -> tuple[PlateProblem, bool]:
        """Assemble the problem on meshes with nodes at the zone ends.

        ``sizes``: approximate number of elements, and the shapes of earlier meshes, which are
        reused: solutions on meshes of one shape differ only by the moves of the ends. Also return
        whether nodes crowd at the ends as much as the boundary layers require; they do not where
        the ends are ``known`` only to a larger fraction of the width.
        """
        meshes, is_fine, (count, shapes) = [], True, sizes
        for number, side in enumerate(zones.sides):
            roller = (self.contact.nip.upper, self.contact.nip.lower)[number]
            unlike = mismatch_layer((roller,), self.contact.tolerance) * side.width
            least = max(min(self._boundary_of(number), unlike), SHORTEST_LAYER * side.width)
            breaks = zones.breaks_of_mesh(number, self._thickness, peaks=not roller.layers)
            crowding = crowding_of(breaks, max(least, known * side.width))
            is_fine = is_fine and crowding == crowding_of(breaks, least)
            kept = shapes.get((number, crowding))
            if kept is None:
                kept = elements_of_zones(breaks, count, crowding, _LEAST_SHARE)
                shapes[number, crowding] = kept
            nodes = cosine_nodes(breaks, kept, crowding)
            fine = subdivided(nodes, kept, crowding)
            kernels = kernels_after(before, self.contact.kernels, number)
            meshes.append(interface_mesh(nodes, fine, kernels, number))
        both = meshes[0], meshes[1]
        return PlateProblem.on(self.contact.nip, both, self._path_ratios(both, before)), is_fine

    def _path_ratios(
        self, meshes: tuple[Mesh, Mesh], before: PlateIterate | None
    ) -> tuple[Array, Array] | None:
        """Return ds/dx of the sheet's path in the previous solution, at both meshes' nodes."""
        if before is None or not self.contact.has_finite_strain:
            return None
        out = []
        for side, (new, own) in enumerate(zip(meshes, before.problem.meshes, strict=True)):
            x = own.fine.nodes[1:]
            u = own.finer(before.problem.displacements(before.state, side))
            ratio = path_ratio(x, self.contact.nip, side, u)
            out.append(np.interp(new.inner, 0.5 * (x[1:] + x[:-1]), ratio))
        return out[0], out[1]

    def _solve_on_mesh(
        self,
        problem: PlateProblem,
        zones: PlateZones,
        lagged: PlateTerms,
        steps: int,
        misplacement: float,
    ) -> PlateIterate:
        """Solve on two meshes with given zones, iterating the lagged terms."""
        nodes = problem.meshes[0].inner, problem.meshes[1].inner
        system = FactorisedPlate.of(problem, zones.states_on(nodes))
        change, settled_change = 0.0, min(_STILL[0] * self.contact.tolerance, _STILL[1])
        state, steps = system.solved(lagged), steps + 1
        for _ in range(2 if misplacement > _FAIRLY_PLACED else _MOST_ITERATIONS):
            if has_no_terms(problem.nip, self.contact.geometry):
                break
            updated = lagged_terms(problem, self.contact.geometry, state, lagged)
            change, lagged = change_of_terms(updated, lagged, problem, state), updated
            state, steps = system.solved(lagged), steps + 1
            if not change > settled_change:
                break
        finite = all(bool(np.all(np.isfinite(one))) for one in state.pressure)
        return PlateIterate(
            zones,
            problem,
            state,
            lagged,
            change,
            inf,
            steps,
            bool(change <= settled_change and finite),
        )

    @property
    def _slack(self) -> float:
        return _SLACK * self.contact.tolerance

    def _consistent_zones(self, latest: _Judged) -> PlateZones | None:
        """Return zones with consistent states between known edges; None where there are none.

        Stick and slip are sought from those of the solution, with its contact. Where that does not
        settle and the ends are at rest, contact, stick and slip are determined at all nodes.
        """
        iterate, edges = latest.iterate, latest.proposed
        problem, lagged = iterate.problem, iterate.lagged
        nodes = max(mesh.inner.size for mesh in problem.meshes)
        try:
            state = settled_slip(problem, iterate.state, lagged, self._slack)
            if state is None and latest.is_at_rest and nodes <= _MOST_NODES:
                state, _ = solve_complementarity(problem, lagged, iterate.zones.edges)
        except np.linalg.LinAlgError:
            return None
        found = None if state is None else edges.found(problem, state)
        return None if found is None else found.without_slivers()


@dataclass(frozen=True, slots=True, kw_only=True)
class _Judged:
    """Judgement of a solution: where it puts the ends of its zones, and what it violates.

    Attributes
    ----------
    iterate : the solution.
    proposed : its zones with their ends where it puts them.
    misplacement : distance of these from its zones, over the width.
    violated : residual of its friction conditions.
    is_met : whether these are met but for rounding.
    is_at_rest : whether no end moves any more, and neither do lagged terms.
    is_placed : whether, besides, nothing at the ends denies that they are in place.
    """

    iterate: PlateIterate
    proposed: PlateZones
    misplacement: float
    violated: float
    is_met: bool
    is_at_rest: bool
    is_placed: bool

    @property
    def placed(self) -> PlateIterate:
        """The solution with its ends where it puts them."""
        return replace(self.iterate, zones=self.proposed, misplacement=self.misplacement)


def _is_other(found: PlateZones, latest: _Judged, tried: set[bytes]) -> bool:
    """Return whether zones that a solution calls for are to be tried.

    Fewer zones than it has may be tried again. Until they are at rest the ends of its own zones
    move anyway; then they are tried like others.
    """
    zones = latest.iterate.zones
    if found.is_like(zones) and not latest.is_at_rest:
        return False
    return found.count < zones.count or found.key not in tried


def _unsettled(zones: PlateZones, iterate: PlateIterate, misplacement: float) -> PlateIterate:
    """Return the last solution, marked as not converged."""
    proper = zones if zones.is_proper else iterate.zones
    return replace(iterate, zones=proper, settled=False, misplacement=misplacement)
