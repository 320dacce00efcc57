"""The search for the zones of a contact and their ends, by Newton's method on meshes of one size.

Edges and transitions are at nodes, and the tractions at the first nodes beside them say where they
move (`contact.Layout.moved`). Once the ends are about right, a solution tells whether its zones
are right too.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from math import inf, log10

import numpy as np

from rollnip.contact import (
    ContactZone,
    GivenStates,
    HeldContact,
    Layout,
    State,
    States,
    cosine_nodes,
    crowding_of,
    elements_of_zones,
    next_slip,
    next_states,
    subdivided,
)
from rollnip.contact.problem import Indices
from rollnip.model import Geometry, Model
from rollnip.nip import Nip
from rollnip.rollers import Roller
from rollnip.rolling.assemble import (
    SecondOrder,
    first_guess,
    has_no_second_order,
    second_order,
)
from rollnip.rolling.round import Round
from rollnip.rolling.surfaces import Mesh, PairKernels, mesh_on
from rollnip.rolling.turns import MOST_TURNS, NEARLY_STILL, change_of, held_from, solve_on_mesh

_STICK_AND_SLIP = HeldContact()
_MOST_MESHES = 4  # of one size at a tolerance of 1e-3, and one more for each further digit
_MOST_IMPROPER = 3  # meshes in a row that ask for ends beyond each other
_MOST_ZONE_CHANGES = 2  # changes of the zones, on meshes of one size
# Meshes more: to place the new ends after a change, and for the second order of "second", which is
# held while a mesh is solved on.
_MORE_MESHES = 3
_SECANT_SLOPES = 0.5, 3.0  # bounds of the move computed for a break over how far it is off
_NEAR_ENOUGH_FOR_SLIP = 0.1  # over the width of the contact: good enough to see what slips
# Largest ratio of how far ends are off, from mesh to mesh: Newton's method does better. It does not
# apply to nearly placed ends, which second-order terms that still change may move further.
_WEAKEST_CONTRACTION = 0.7
_NEARLY_PLACED = 0.008  # over the width of the contact
# Of the tolerance: what an end of a zone may be off, over the width of the contact.
_PLACEMENT_TOLERANCE = 0.1
COARSE_PLACEMENT_FACTOR = 3.0  # times `_PLACEMENT_TOLERANCE` on the first size of mesh
# Shear over the bound counts as rounding up to the tolerance, and never beyond this.
_MOST_SHEAR_SLACK = 1e-3
_TURNS_WHILE_MOVING = 2  # of the second-order terms on one mesh, while ends still move, but not far
_LARGEST_SERIES_RATIO = 0.9
_NEARLY_INCOMPRESSIBLE = 0.45  # Poisson ratio
_PIECES_PER_THICKNESS = 6.0  # at least, in which tractions act along a thickness of such a covering
_TINY = float(np.finfo(float).tiny)


# Elements in each zone and how they crowd there.
Shape = tuple[Indices, tuple[float, ...]]


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
    off : how far the ends of zones may be off, over the width of the contact.
    """

    layout: Layout
    before: Round
    change: float = inf
    expected: float = inf
    off: float = _NEAR_ENOUGH_FOR_SLIP

    @property
    def is_quiet(self) -> bool:
        """Return whether further evaluations of the second order would change too little."""
        return self.expected <= 1.0


@dataclass(frozen=True)
class Placing:
    """The search for the zones of a nip and their ends, for one model."""

    nip: Nip
    model: Model
    kernels: PairKernels
    given: GivenStates = field(default_factory=GivenStates)

    def guessed(self, layout: Layout, count: int) -> SearchState | None:
        """Find which zones there are, and about where, from one mesh on a guess.

        Ends that are far off leave singular tractions. Where these slip, second-order terms under
        them mean nothing, so zones are sought without these terms. Where all sticks, the mesh is
        solved once more with them.

        Returns
        -------
        None where the zones that the solution calls for have no layout.
        """
        kernels = held_from(self.kernels, None)
        even = (1.0,) * layout.states.size
        elements = elements_of_zones(layout.breaks, count)
        mesh = _mesh(layout, (elements, even), self.thinnest, kernels)
        states, zones = layout.states_on(mesh.inner), layout.zones
        start = states, first_guess(self.nip, mesh), 0
        latest = self._solve_on_mesh(
            replace(self.model, geometry="linear"), mesh, start, zones, _TURNS_WHILE_MOVING
        )
        asked = layout.moved(mesh.inner, latest.state, self.nip.friction)
        is_near = asked.distance(layout) < _NEAR_ENOUGH_FOR_SLIP
        wanted = self._wanted(latest, layout, whole=False) if is_near else None
        if wanted is not None or not asked.is_proper:
            return self._other(latest, wanted, _proper(asked, layout), "linear")
        if self.kernels.is_fixed and not has_no_second_order(self.nip, self.model.geometry):
            second = second_order(self.nip, self.model.geometry, mesh, latest.state)
            latest = self._solve_on_mesh(self.model, mesh, (states, second, latest.steps), zones, 1)
            asked = layout.moved(mesh.inner, latest.state, self.nip.friction)
        return SearchState(_proper(asked, layout), latest, off=asked.distance(layout))

    def placed(self, start: SearchState, count: int, *, known: bool) -> SearchState | None:
        """Find the solution on a mesh of some size whose nodes lie at the ends of its zones.

        Parameters
        ----------
        start : where the search stands.
        count : elements, about.
        known : whether the zones are right.

        Returns
        -------
        None where there is no such solution.
        """
        # The second order held so far is that of a coarser mesh: each size evaluates it anew.
        stand, off, known_to = self._renewed(replace(start, expected=inf)), inf, start.off
        loosely = self.kernels.is_fixed and not known
        placed = (
            _PLACEMENT_TOLERANCE
            * self.model.tolerance
            * (COARSE_PLACEMENT_FACTOR if loosely else 1.0)
        )
        elements: Indices | None = None
        crowding: tuple[float, ...] = ()
        earlier: tuple[Layout, Layout] | None = None
        meshes = changes = improper = 0
        most_meshes = self._most_meshes(crowding_of(start.layout.breaks, self.boundary))
        while meshes < most_meshes + _MORE_MESHES * changes:
            meshes += 1
            layout = stand.layout
            crowd = crowding_of(layout.breaks, max(self.boundary, known_to * layout.width))
            if elements is None or crowd != crowding:
                # Elements stay as they are while edges are sought: other ones would move the edges.
                crowding, elements = crowd, elements_of_zones(layout.breaks, count, crowd)
                earlier, off = None, inf
            hasty = loosely and off > _NEARLY_PLACED
            # Transitions that come from a guess will move again, whatever the second order.
            most = 1 if hasty and layout.states.size > 1 else _TURNS_WHILE_MOVING
            latest, asked = self._solved_on(stand, (elements, crowding), placed, most)
            off, off_before = asked.distance(layout), off
            known_to = min(known_to, off)
            if self.kernels.is_linear and off > max(
                _WEAKEST_CONTRACTION * off_before, _NEARLY_PLACED
            ):
                return None
            is_fine = crowd == crowding_of(layout.breaks, self.boundary)
            is_placed = off <= placed and (self.kernels.is_fixed or stand.is_quiet)
            is_placed = is_placed and is_fine
            doubted = is_placed or (not known and off < _NEAR_ENOUGH_FOR_SLIP)
            known = known or (doubted and not hasty)
            wanted = self._wanted(latest, layout, whole=is_placed) if doubted else None
            if asked.is_proper and wanted is None:
                if is_placed and latest.stands_still:
                    return _standing_at(asked, latest, stand, off)
                there = _hastened(layout, asked, earlier)
                stand = self._renewed(SearchState(there, latest, stand.change, stand.expected))
                earlier = (layout, asked) if latest.stands_still else None
                improper = 0
                continue
            improper += not asked.is_proper
            if wanted is None and improper < _MOST_IMPROPER:
                there = layout.towards(asked)
                stand = self._renewed(SearchState(there, latest, stand.change, stand.expected))
                earlier, off, most_meshes = None, inf, most_meshes + 1
                continue
            changes += 1
            improper = 0
            other = self._other(latest, wanted, _proper(asked, layout), self.model.geometry)
            if other is None or changes > _MOST_ZONE_CHANGES:
                return None
            stand, elements, earlier, off = self._renewed(other), None, None, inf
        return None

    @cached_property
    def boundary(self) -> float:
        """Length of the shortest boundary layer of the nip, see `boundary_layer` [mm]."""
        return boundary_layer(self.nip)

    @cached_property
    def thinnest(self) -> float:
        """Thickness of the thinnest covering that moves as the second derivative [mm]."""
        rollers = self.nip.upper, self.nip.lower
        return min(_incompressible(roller) for roller in rollers if not roller.is_rigid)

    def _most_meshes(self, crowding: tuple[float, ...]) -> int:
        most = _MOST_MESHES + max(0, round(-3.0 - log10(self.model.tolerance)))
        most += round(-log10(min(crowding)))  # each mesh can crowd its nodes tenfold
        return most + (0 if self.kernels.is_linear else _MORE_MESHES)

    def _renewed(self, stand: SearchState) -> SearchState:
        """Evaluate the second order of the last solution and what follows, if it still moves."""
        before = stand.before
        if self.kernels.is_fixed or stand.is_quiet:
            return stand
        mesh = before.mesh.holding(held_from(self.kernels, before))
        second = second_order(self.nip, self.model.geometry, mesh, before.state)
        change = change_of(second, before.second, mesh, self.nip, before.state)
        change /= self.model.tolerance
        # Changes shrink by a ratio; those to come add up as a geometric series.
        ratio = min(change / max(stand.change, _TINY), _LARGEST_SERIES_RATIO)
        expected = inf if stand.change == inf else change * ratio / (1.0 - ratio)
        return SearchState(
            stand.layout, replace(before, mesh=mesh, second=second), change, expected
        )

    def _solved_on(
        self,
        stand: SearchState,
        shape: Shape,
        placed: float,
        most: int,
    ) -> tuple[Round, Layout]:
        """Solve on one mesh; return the solution, and where it puts the ends of zones.

        At ``most`` so many turns of the second-order terms while ends still move by more than
        ``placed``, over the width; then as many as these need.
        """
        layout, before = stand.layout, stand.before
        mesh = _mesh(layout, shape, self.thinnest, before.mesh.kernels)
        states, zones = layout.states_on(mesh.inner), layout.zones
        start = states, before.second.carried(before.mesh, mesh), before.steps
        latest = self._solve_on_mesh(self.model, mesh, start, zones, most)
        asked = layout.moved(mesh.inner, latest.state, self.nip.friction)
        if not latest.stands_still and asked.distance(layout) <= placed:
            start = states, latest.second, latest.steps
            latest = self._solve_on_mesh(self.model, mesh, start, zones)
            asked = layout.moved(mesh.inner, latest.state, self.nip.friction)
        return latest, asked

    def _solve_on_mesh(
        self,
        model: Model,
        mesh: Mesh,
        start: tuple[States, SecondOrder, int],
        zones: tuple[ContactZone, ...],
        most: int = MOST_TURNS,
    ) -> Round:
        return solve_on_mesh(self.nip, model, mesh, start, self.given, NEARLY_STILL, zones, most)

    def _wanted(self, latest: Round, layout: Layout, *, whole: bool) -> States | None:
        """Return the states that a solution calls for; None where nodes in contact have them.

        ``whole``: whether contact is examined too; until the edges are placed, only stick and slip.
        """
        slack, given = min(self.model.tolerance, _MOST_SHEAR_SLACK), latest.state.states
        wanted = (next_states if whole else next_slip)(latest.problem, latest.state, slack)
        differs = (wanted != given) & (given != State.FREE)
        differs[layout.ends(latest.problem.x)] = False  # ends belong to two zones alike
        if not differs.any():
            return None
        return next_slip(latest.problem, latest.state, slack) if whole else wanted

    def _other(
        self, latest: Round, wanted: States | None, edges: Layout, geometry: Geometry
    ) -> SearchState | None:
        """Find other zones between known edges, where a solution does not agree with its own.

        Return None where the zones are the same, or where they have no layout.
        """
        given = latest.state.states
        found = _STICK_AND_SLIP.solve(latest.problem, given if wanted is None else wanted)
        if np.array_equal(found.states, given):
            return None
        layout = Layout.found(latest.problem.x, found, self.nip.friction, edges.edges)
        if layout is None:
            return None
        second = second_order(self.nip, geometry, latest.mesh, found)
        steps = latest.steps + found.steps
        return SearchState(layout, replace(latest, state=found, second=second, steps=steps))


def boundary_layer(nip: Nip) -> float:
    """Return the length of the shortest boundary layer at the ends of zones [mm].

    Over lengths up to the depth of the first interface the surface responds as a half-plane of its
    top layer; over larger ones the layers below count, and the tractions change between the two.
    """
    return min(_first_interface(nip.upper), _first_interface(nip.lower))


def _incompressible(roller: Roller) -> float:
    """Return the thickness of a nearly incompressible covering on a rigid core, or inf [mm]."""
    nearly = all(layer.material.poisson > _NEARLY_INCOMPRESSIBLE for layer in roller.layers)
    return (
        roller.coating_thickness / _PIECES_PER_THICKNESS if nearly and roller.core is None else inf
    )


def _first_interface(roller: Roller) -> float:
    """Return the depth at which the material changes first [mm]; infinite for a rigid roller."""
    depth = 0.0
    materials = [*(layer.material for layer in roller.layers), roller.core]
    for layer, below in zip(roller.layers, materials[1:], strict=True):
        depth += layer.thickness
        if layer.material != below:
            return depth
    return inf


def _mesh(layout: Layout, shape: Shape, shortest: float, kernels: PairKernels) -> Mesh:
    """Make a mesh whose nodes lie at the ends of zones; ``shortest``: see `subdivided`."""
    nodes = cosine_nodes(layout.breaks, *shape)
    return mesh_on(nodes, kernels, subdivided(nodes, *shape, shortest))


def _proper(asked: Layout, layout: Layout) -> Layout:
    """Return the ends that a solution calls for, or some on the way if those are no layout."""
    return asked if asked.is_proper else layout.towards(asked)


def _standing_at(asked: Layout, latest: Round, stand: SearchState, off: float) -> SearchState:
    """Return the state of a search that has come to its end."""
    figures = replace(latest.figures, nip_width=asked.width)
    latest = replace(latest, zones=asked.zones, figures=figures)
    return SearchState(asked, latest, stand.change, stand.expected, off)


def _hastened(here: Layout, asked: Layout, earlier: tuple[Layout, Layout] | None) -> Layout:
    """Return the next places of the breaks, each by the secant through its last two.

    ``earlier``: where the breaks were on the mesh before, and where that solution put them. Where
    the surface does not respond as a half-plane over the first elements, say under a stiff skin,
    a solution moves the breaks too far, or not far enough.
    """
    if earlier is None:
        return asked
    steps, steps_before = asked.breaks - here.breaks, earlier[1].breaks - earlier[0].breaks
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = (steps_before - steps) / (here.breaks - earlier[0].breaks)
    factor = 1.0 / np.clip(np.nan_to_num(slope, nan=1.0), *_SECANT_SLOPES)
    hastened = Layout(here.breaks + factor * steps, here.states)
    return hastened if hastened.is_proper else asked
