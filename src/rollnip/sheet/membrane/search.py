"""Search for the zones of a membrane: states and ends of stick and slip, on meshes of one size.

Edges and transitions lie at nodes. The tractions at the first nodes beside them show where they
belong (`contact.Layout.with_proposed_ends`), which makes the search Newton's method for the zone
ends. Once the ends are approximately right, the solution also shows whether its zones have the
right states; where they do not, stick and slip are determined node by node.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from math import inf

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import (
    Crowding,
    Layout,
    State,
    States,
    cosine_nodes,
    crowding_of,
    elements_of_zones,
    subdivided,
    uncrowded,
)
from rollnip.contact.mesh import FEWEST_ELEMENTS_OF_A_ZONE
from rollnip.model import Geometry
from rollnip.rolling import RollingContact, surface_depths
from rollnip.rolling.kinematics import arc_ratio
from rollnip.sheet.boundary_layers import SHORTEST_LAYER, mismatch_layer, shortest_layer
from rollnip.sheet.conditions import OUTSIDE, violation, violation_outside
from rollnip.sheet.formulation import FIRST_SIZE
from rollnip.sheet.iterate import SheetIterate, kernels_after
from rollnip.sheet.lagged_terms import has_no_terms, interpolated, traction_within_friction
from rollnip.sheet.local_deformation import thickness_loss
from rollnip.sheet.membrane.complementarity import (
    settled_slip,
    solve_complementarity,
    wanted_slip,
)
from rollnip.sheet.membrane.lagged_terms import (
    change_of_terms,
    initial_terms,
    lagged_terms,
)
from rollnip.sheet.membrane.linear_system import FactorisedMembrane
from rollnip.sheet.membrane.system import (
    MembraneMesh,
    MembraneProblem,
    MembraneState,
    MembraneTerms,
)
from rollnip.sheet.membrane.zones import MembraneZones
from rollnip.sheet.secant import SecantSteps

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_LEAST_SHARE = FEWEST_ELEMENTS_OF_A_ZONE / FIRST_SIZE  # so that every zone is refined with the size
_SLACK = 1e-3  # relative excess of the shear over its bound that counts as rounding
_FAIRLY_PLACED = 0.1  # end error over the width, small enough to judge the states
_NEARLY_PLACED = 0.01  # end error over the width, small enough for secant steps
_MOST_MESHES = 14
_MOST_CHANGES = 5  # of the zones' states, on meshes of one size
_REACH = 1.12  # half-length of the first mesh over the half-width of the rollers alone
_WIDER = 1.5  # growth of the first mesh where the contact does not fit into it
_MOST_REACHES = 4
_MOST_ITERATIONS = 10
_STILL = 0.1  # of the tolerance: last change of the lagged terms


MembraneIterate = SheetIterate[MembraneZones, MembraneProblem, MembraneState, MembraneTerms]
"""The iterate of the search for a membrane."""


@dataclass(frozen=True)
class MembraneSearch:
    """The search for the zones of a nip with a membrane."""

    contact: RollingContact
    secants: SecantSteps[MembraneZones] = field(default_factory=SecantSteps)

    def start(self, half_width: float, count: int) -> MembraneIterate:
        """Return a first solution in linear geometry, on a mesh that extends beyond the contact.

        ``half_width``: approximate half-width of the nip [mm]; ``count``: number of elements.
        """
        reach, shape = _REACH * half_width, (np.array([count]), uncrowded(1))
        for _ in range(_MOST_REACHES):
            problem = self._problem(MembraneZones.sticking(reach), shape, None)
            lagged = initial_terms(problem)
            state = solve_complementarity(problem, lagged, half_width)
            if not has_no_terms(problem.nip, "linear"):
                state, lagged = self._for_torque(problem, state, half_width)
            if state.states[0] == state.states[-1] == State.FREE:
                break
            reach *= _WIDER
        zones = MembraneZones.around(problem.mesh.inner, state, problem.frictions)
        return MembraneIterate(zones, problem, state, lagged, inf, 1.0, state.steps, False)

    def _for_torque(
        self, problem: MembraneProblem, state: MembraneState, half_width: float
    ) -> tuple[MembraneState, MembraneTerms]:
        """Return the solution for about the traction that a torque asks for, from one without it.

        ``state.steps`` counts those of both.
        """
        for _ in range(_MOST_ITERATIONS):
            asked = lagged_terms(problem, "linear", state)
            lagged = replace(
                asked, traction=traction_within_friction(problem, state, asked.traction)
            )
            found = solve_complementarity(problem, lagged, half_width)
            state = replace(found, steps=state.steps + found.steps)
            if lagged.traction == asked.traction:
                break
        return state, lagged

    def settle_zones(
        self, zones: MembraneZones, count: int, before: MembraneIterate, end_tolerance: float
    ) -> MembraneIterate:
        """Return the solution on a mesh of one size with nodes at the ends of its zones.

        ``end_tolerance``: allowed error of a zone end, over the tolerance times the width.
        """
        allowed = end_tolerance * self.contact.tolerance
        steps, misplacement = before.steps, before.misplacement
        changes = 0
        known = min(misplacement, 1.0)
        # On the first mesh ends count as near, because its lagged terms come from a solution.
        near = min(misplacement, _NEARLY_PLACED)
        elements: NDArray[np.intp] | None = None
        crowding: Crowding = ()
        iterate = before
        self.secants.begin_size()
        for _ in range(_MOST_MESHES):
            zones = zones.without_slivers().aligned()
            if not zones.is_proper:
                break
            breaks = zones.breaks
            wanted_crowding = self._crowding(breaks, known)
            is_fine = wanted_crowding == self._crowding(breaks, 0.0)
            if elements is None or wanted_crowding != crowding or elements.size != breaks.size - 1:
                elements = elements_of_zones(breaks, count, wanted_crowding, _LEAST_SHARE)
                crowding = wanted_crowding
            problem = self._problem(zones, (elements, crowding), iterate)
            start = interpolated_terms(iterate, problem)
            iterate = self._solve_on_mesh(problem, zones, start, steps, (near, misplacement))
            steps = iterate.steps
            requested = _ZonesByStates(iterate, self._slack)
            is_near = known <= _NEARLY_PLACED
            proposed = zones.moved(problem, iterate.state, requested, is_near=is_near)
            misplacement = proposed.distance(zones)
            near = known = min(known, misplacement)
            is_met = violation(iterate) <= self._slack
            keep_states = misplacement > _FAIRLY_PLACED and not changes
            # If conditions are violated and the nodal states call for unlike zones, the states
            # are checked at once; without violation only when no end moves any more, and once.
            moves = misplacement > allowed
            if is_met:
                keep_states = keep_states or moves or changes > 0 or requested.are_like
            else:
                keep_states = keep_states or (moves and requested.are_like)
            if keep_states:
                if misplacement <= allowed and iterate.settled and is_fine and is_met:
                    return replace(iterate, zones=proposed, misplacement=misplacement)
                zones = (
                    proposed
                    if misplacement > _NEARLY_PLACED
                    else self.secants.next(self.secants.learn(zones, proposed))
                )
                continue
            changes += 1
            if changes > _MOST_CHANGES:
                break
            other = self._other_zones(iterate, proposed)
            iterate, zones = (iterate, proposed) if other is None else other
            steps, elements = iterate.steps, None
        proper = zones if zones.is_proper else iterate.zones
        return replace(iterate, zones=proper, settled=False, misplacement=misplacement)

    def _crowding(self, breaks: Array, known: float) -> Crowding:
        """Return the crowding of nodes at zone ends, ``known`` to this fraction of the width."""
        width, rollers = (
            float(breaks[-1] - breaks[0]),
            (self.contact.nip.upper, self.contact.nip.lower),
        )
        shortest = min(self.boundary, mismatch_layer(rollers, self.contact.tolerance) * width)
        return crowding_of(breaks, max(shortest, max(known, SHORTEST_LAYER) * width))

    @cached_property
    def boundary(self) -> float:
        """Length of the shortest boundary layer at zone ends [mm]."""
        return shortest_layer(self.contact.nip)

    def _problem(
        self,
        zones: MembraneZones,
        shape: tuple[NDArray[np.intp], Crowding],
        before: MembraneIterate | None,
    ) -> MembraneProblem:
        """Assemble the problem on a mesh with nodes at the zone ends."""
        nodes = cosine_nodes(zones.breaks, *shape)
        kernels = kernels_after(before, self.contact.kernels)
        mesh = MembraneMesh.on(nodes, kernels, subdivided(nodes, *shape))
        bends = before is not None and self.contact.geometry != "linear"
        return MembraneProblem.on(
            self.contact.nip, mesh, self._path_ratios(mesh, before), has_path=bends
        )

    def _path_ratios(self, mesh: MembraneMesh, before: MembraneIterate | None) -> Array | None:
        """Return ds/dx of the sheet's path in the previous solution; None: all 1."""
        if before is None or not self.contact.has_finite_strain:
            return None
        own = before.problem.mesh
        x, u = own.fine.nodes[1:], own.finer(own.displacements(before.state))
        ratio = arc_ratio(x, self.contact.nip, self.contact.geometry, u)
        places = 0.5 * (mesh.fine.nodes[1:] + mesh.fine.nodes[:-1])
        return np.interp(places, 0.5 * (x[1:] + x[:-1]), ratio)

    def _solve_on_mesh(
        self,
        problem: MembraneProblem,
        zones: MembraneZones,
        lagged: MembraneTerms,
        steps: int,
        misplacement: tuple[float, float],
    ) -> MembraneIterate:
        """Solve on one mesh with given zones, iterating the lagged terms.

        ``misplacement``: error of the zone ends, smallest so far and on the last mesh of this size.
        Ends that are far off leave singular tractions, for which updated terms are meaningless.
        """
        system = FactorisedMembrane.of(problem, zones.states_on(problem.mesh.inner))
        change, settled_change = 0.0, _STILL * self.contact.tolerance
        most = _MOST_ITERATIONS if misplacement[1] < _NEARLY_PLACED else 2
        for _ in range(most):
            state = system.solved(lagged)
            steps += 1
            if has_no_terms(problem.nip, self.contact.geometry):
                break
            if misplacement[0] > _NEARLY_PLACED:
                change = 1.0
                break
            updated = lagged_terms(problem, self.contact.geometry, state)
            change, lagged = change_of_terms(updated, lagged, problem, state), updated
            if not change > settled_change:
                break
        if not (np.isfinite(change) and np.all(np.isfinite(state.pressure))):
            raise np.linalg.LinAlgError("no finite solution")
        return MembraneIterate(
            zones, problem, state, lagged, change, inf, steps, bool(change <= settled_change)
        )

    @property
    def _slack(self) -> float:
        return min(self.contact.tolerance, _SLACK)

    def _other_zones(
        self, iterate: MembraneIterate, edges: MembraneZones
    ) -> tuple[MembraneIterate, MembraneZones] | None:
        """Return other zones between known edges, found node by node; None where there are none."""
        problem = iterate.problem
        state = settled_slip(problem, iterate.state, iterate.lagged, self._slack)
        if state is None:
            state = solve_complementarity(problem, iterate.lagged, 0.5 * iterate.zones.width)
        zones = MembraneZones.found(problem.mesh.inner, state, problem.frictions, edges.edges)
        if zones is None:
            return None
        return replace(iterate, state=state, steps=iterate.steps + state.steps), zones


@dataclass(frozen=True)
class _ZonesByStates:
    """Zones that follow from the nodal states a solution calls for, computed on demand.

    Attributes
    ----------
    iterate : the solution.
    slack : see `wanted_slip`.
    """

    iterate: MembraneIterate
    slack: float

    @cached_property
    def _wanted(self) -> States:
        iterate = self.iterate
        return wanted_slip(iterate.problem, iterate.state, iterate.creeps, self.slack)

    @cached_property
    def _consistent_zones(self) -> MembraneZones | None:
        """Return the zones of these states, if they are like those of the solution."""
        iterate, wanted = self.iterate, self._wanted
        state = replace(iterate.state, states=wanted[0], states_lower=wanted[1])
        frictions, x = iterate.problem.frictions, iterate.problem.mesh.inner
        found = MembraneZones.found(x, state, frictions, iterate.zones.edges)
        found = None if found is None else found.without_slivers()
        return found if found is not None and found.is_like(iterate.zones) else None

    @cached_property
    def are_like(self) -> bool:
        """Return whether the states make zones like those of the solution."""
        same = np.array_equal(self._wanted, self.iterate.state.both_states)
        return same or self._consistent_zones is not None

    def creeps_against_shear(self, number: int) -> Mask:
        """Return at which transitions of an interface the slip beside it must stick again, (m,).

        There the surfaces creep against their own shear, at the node of the transition and at the
        next one: the shear reaches its bound as at the end of a zone, but not for the first time.
        """
        side = self.iterate.zones.sides[number]
        ends = side.ends(self.iterate.problem.mesh.inner)[1:-1]
        sticks = self._wanted[number] == State.STICK
        into_slip = np.where(side.states[:-1] == State.STICK, 1, -1)
        return np.asarray(sticks[ends] & sticks[ends + into_slip])

    @property
    def sides(self) -> tuple[Layout, Layout]:
        """Return the resulting zones of both interfaces; if unlike, those of the solution."""
        return (self._consistent_zones or self.iterate.zones).sides


def overlap(iterate: MembraneIterate, geometry: Geometry) -> float:
    """Return the relative overlap outside the contact, or the relative tension in it."""
    problem, state = iterate.problem, iterate.state
    nip, mesh, width = problem.nip, problem.mesh, iterate.zones.width
    away = width * OUTSIDE
    x = np.concatenate([mesh.inner[0] - away, mesh.inner[-1] + away])
    u = mesh.linear_displacements_at(x, state)
    u = u if mesh.kernels.is_linear else u + mesh.second(state, x)
    gap = sum(surface_depths(x, nip, geometry, u)) - state.approach
    sides = np.repeat([problem.sheet.tension_out, problem.sheet.tension_in], away.size)
    gap += problem.sheet.stretch_by_pressure * sides
    pressed = mesh.acting(state.pressure)[:, None]
    gap += thickness_loss(problem.sheet, x, mesh.fine.nodes, pressed)[:, 0]
    return violation_outside(nip, gap, state.pressure, width, state.approach)


def interpolated_terms(iterate: MembraneIterate, problem: MembraneProblem) -> MembraneTerms:
    """Return the lagged terms of a solution, interpolated to another mesh."""
    old, new, lagged = iterate.problem.mesh, problem.mesh, iterate.lagged
    (clearance, upper), (_, lower) = (
        interpolated(old, new, lagged.clearance, offset) for offset in lagged.offsets
    )
    return replace(lagged, clearance=clearance, offsets=np.stack([upper, lower]))
