"""The search for the zones of both interfaces of a plate and their ends, on meshes of one size.

Edges and transitions lie at nodes of the interface that they belong to, and the tractions at the
first nodes beside them say where they move (`contact.Layout.moved`). A solution tells whether its
zones are right; where they are not, stick and slip are sought between the edges, and where this
does not settle, contact, stick and slip are sought together (`nodewise`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import inf

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import State, cosine_nodes, crowding_of, elements_of_zones, subdivided
from rollnip.influence import displacement_under
from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.rolling import PairKernels
from rollnip.rolling.displacements import NO_SECOND_ORDER
from rollnip.rolling.placing import boundary_layer
from rollnip.rolling.surfaces import Mesh
from rollnip.sheet.plate.factorised import FactorisedPlate, next_slip
from rollnip.sheet.plate.lagged import change_of, first_lagged, has_none, lagged_terms
from rollnip.sheet.plate.nodewise import Nodewise, slipping
from rollnip.sheet.plate.sides import side_mesh
from rollnip.sheet.plate.system import LaggedPlate, PlateProblem, PlateState
from rollnip.sheet.plate.zones import PlateZones
from rollnip.sheet.search import SHORTEST_LAYER, longest_run, sheet_layer, squeeze_layer
from rollnip.sheet.system import SIGNS as SIGNS_OF_STATES

Array = NDArray[np.float64]

_SLACK = 1e-3  # shear over the bound, relative, that counts as rounding
_FAIRLY_PLACED = 1e-3  # over the width: good enough to see what slips
_NEARLY_PLACED = 0.01  # over the width: so near that the move before tells of the next one
_CLOSELY = 0.1  # of the tolerance: what an end may be off, over the width
_ROUGHLY = 1.0  # the same where a solution only begins another one
_MOST_MESHES = 18
_MOST_ROUGH = 12  # meshes in a row on which ends only move
_MOST_CHANGES = 3  # of zones, before contact, stick and slip are sought together
_MOST_TURNS = 25
_STILL = 0.1  # of the tolerance: last change of the lagged terms
_SECANT_SLOPES = 0.7, 2.5  # of the distance of an end by its place
_OUTSIDE = np.array([0.003, 0.01, 0.03, 0.1, 0.3])  # over the width, where overlap is looked for


@dataclass(frozen=True, slots=True)
class PlateAttempt:
    """A solution on two meshes between the ends of some zones, and how well these are placed.

    Attributes
    ----------
    zones : where it puts the zones.
    problem, state, lagged : the solved problem.
    change : last change of the lagged terms, relative.
    off : how far ends were off, over the width.
    steps : linear systems solved so far.
    stands_still : whether zones and terms stand still.
    """

    zones: PlateZones
    problem: PlateProblem
    state: PlateState
    lagged: LaggedPlate
    change: float
    off: float
    steps: int
    stands_still: bool

    @property
    def wanted_traction(self) -> float | None:
        """T_l that is asked for [N/mm]; None where none is."""
        return self.lagged.traction


@dataclass(slots=True)
class _Moves:
    """Ends of like zones on the last meshes, and how far their solutions moved them."""

    zones: PlateZones | None = None
    step: Array | None = None

    def next(self, zones: PlateZones, asked: PlateZones, off: float) -> PlateZones:
        """Return where to put the ends next.

        Each end goes by the secant through its last two moves where these tell of the next one:
        where it is nearly placed, and where it turns back.
        """
        here, step = zones.breaks, asked.breaks - zones.breaks
        before, step_before = self.zones, self.step
        self.zones, self.step = zones, step
        if before is None or step_before is None or not zones.is_like(before):
            return asked
        with np.errstate(divide="ignore", invalid="ignore"):
            slope = (step_before - step) / (here - before.breaks)
        tells = (off <= _NEARLY_PLACED) | (step * step_before < 0.0)
        factor = np.where(tells, 1.0 / np.clip(np.nan_to_num(slope, nan=1.0), *_SECANT_SLOPES), 1.0)
        found = zones.with_breaks(here + factor * step)
        return found if found.is_proper else asked


@dataclass(frozen=True)
class PlateSearch:
    """The search for the zones of a nip with a plate, for one model."""

    nip: Nip
    model: Model
    kernels: PairKernels

    def begun(self, half_width: float, count: int) -> PlateAttempt:
        """Find a first solution, without terms that depend on it but a traction for a torque."""
        plain = replace(self, model=replace(self.model, geometry="linear"))
        closely = _CLOSELY if self.model.geometry == "linear" else _ROUGHLY
        zones = Nodewise(self.nip, plain._holding(None, 0)).first(half_width)
        stand = plain.placed(zones, count, None, closely)
        lagged = lagged_terms(stand.problem, self.model.geometry, stand.state)
        return replace(stand, lagged=lagged)

    def placed(
        self,
        zones: PlateZones,
        count: int,
        before: PlateAttempt | None,
        closely: float = _CLOSELY,
    ) -> PlateAttempt:
        """Find the solution on meshes of some size with nodes at the ends of its zones.

        ``closely``: what an end may be off, of the tolerance times the width.
        """
        placed = closely * self.model.tolerance
        try:
            stand = self._moved_until(zones, count, before, placed)
        except np.linalg.LinAlgError:
            if before is None:
                raise
            return replace(before, stands_still=False)
        if stand.stands_still:
            return stand
        start = stand.zones if stand.zones.is_proper else zones
        try:
            found = Nodewise(self.nip, self.kernels).again(start, stand.lagged)
            again = self._moved_until(found, count, stand, placed)
        except np.linalg.LinAlgError:
            return stand
        return again if again.stands_still or again.off < stand.off else stand

    def _moved_until(
        self, zones: PlateZones, count: int, before: PlateAttempt | None, placed: float
    ) -> PlateAttempt:
        """Move the ends of zones until they stand still, and change zones that are wrong.

        ``placed``: what an end may be off, over the width.
        """
        moves = _Moves()
        changes = rough_ones = 0
        known = 1.0 if before is None else min(before.off, 1.0)
        stand, off = before, inf
        for _ in range(_MOST_MESHES):
            zones = zones.without_slivers()
            if not zones.is_proper:
                break
            problem, is_fine = self._problem(zones, count, known, stand)
            start = first_lagged(problem) if stand is None else carried(stand, problem)
            steps = 0 if stand is None else stand.steps
            stand = self._solved(problem, zones, start, steps, off)
            asked = zones.moved(problem, stand.state)
            off = asked.distance(zones)
            known = min(known, off)
            rough = off > _FAIRLY_PLACED and rough_ones < _MOST_ROUGH
            rough_ones = rough_ones + 1 if rough else 0
            if rough or violation(stand) <= self._slack:
                if off <= placed and stand.stands_still and is_fine:
                    return replace(stand, zones=asked, off=off)
                zones = moves.next(zones, asked, off)
                continue
            changes += 1
            other = None if changes > _MOST_CHANGES else self._other(stand, asked)
            if other is None:
                break
            stand, zones = other
        if stand is None:
            raise np.linalg.LinAlgError("zones without length")
        proper = zones if zones.is_proper else stand.zones
        return replace(stand, zones=proper, stands_still=False, off=off)

    @cached_property
    def boundary(self) -> float:
        """Length of the shortest boundary layer at the ends of zones [mm]."""
        return min(boundary_layer(self.nip), sheet_layer(self.nip), squeeze_layer(self.nip))

    @property
    def _thickness(self) -> float:
        assert self.nip.sheet is not None
        return self.nip.sheet.thickness

    def _problem(
        self, zones: PlateZones, count: int, known: float, before: PlateAttempt | None
    ) -> tuple[PlateProblem, bool]:
        """Assemble the problem on meshes with nodes at the ends of zones.

        Return also whether nodes crowd there as much as boundary layers ask for; they do not
        where ends are ``known`` to a larger share of the width only.
        """
        meshes, is_fine = [], True
        for number, side in enumerate(zones.sides):
            least = max(self.boundary, SHORTEST_LAYER * side.width)
            breaks = zones.breaks_of_mesh(number, self._thickness)
            crowding = crowding_of(breaks, max(least, known * side.width))
            is_fine = is_fine and crowding == crowding_of(breaks, least)
            elements = elements_of_zones(breaks, count, crowding)
            nodes = cosine_nodes(breaks, elements, crowding)
            fine = subdivided(nodes, elements, crowding)
            meshes.append(side_mesh(nodes, fine, self._holding(before, number), number))
        return PlateProblem.on(self.nip, (meshes[0], meshes[1])), is_fine

    def _holding(self, before: PlateAttempt | None, side: int) -> PairKernels:
        """Return influence functions with the second order of one roller in the solution before."""
        if self.kernels.is_linear:
            return self.kernels
        held = NO_SECOND_ORDER
        if before is not None and (self.nip.upper, self.nip.lower)[side].layers:
            held = before.problem.meshes[side].second_fields(before.state.side(side))
        return replace(self.kernels, held=held)

    def _solved(
        self,
        problem: PlateProblem,
        zones: PlateZones,
        lagged: LaggedPlate,
        steps: int,
        off: float,
    ) -> PlateAttempt:
        """Solve on two meshes with given zones, in turns of the lagged terms."""
        nodes = problem.meshes[0].inner, problem.meshes[1].inner
        system = FactorisedPlate.of(problem, zones.states_on(nodes))
        change, still = 0.0, _STILL * self.model.tolerance
        for _ in range(2 if off > _FAIRLY_PLACED else _MOST_TURNS):
            state = system.solved(lagged)
            steps += 1
            if has_none(problem, self.model.geometry):
                break
            updated = lagged_terms(problem, self.model.geometry, state)
            change, lagged = change_of(updated, lagged, problem, state), updated
            if not change > still:
                break
        finite = all(bool(np.all(np.isfinite(one))) for one in state.pressure)
        return PlateAttempt(
            zones, problem, state, lagged, change, inf, steps, bool(change <= still and finite)
        )

    @property
    def _slack(self) -> float:
        return min(self.model.tolerance, _SLACK)

    def _other(
        self, stand: PlateAttempt, edges: PlateZones
    ) -> tuple[PlateAttempt, PlateZones] | None:
        """Find other zones between known edges, node by node; None where there are none."""
        problem = stand.problem
        states = next_slip(problem, stand.state, stand.lagged, self._slack)
        state, steps = slipping(problem, states, stand.lagged, self._slack)
        zones = edges.found(problem, state)
        if zones is None:
            return None
        return replace(stand, state=state, steps=stand.steps + steps), zones


def violation(stand: PlateAttempt) -> float:
    """Return how badly a solution violates the conditions of friction, relative.

    As without bending: shear beyond the traction bound over its largest value, and slip with its
    own shear over a twentieth of the nip's slope times its width or the creepage times it.
    """
    state, problem = stand.state, stand.problem
    slope = 0.5 * stand.zones.width * problem.nip.curvature
    parts = [0.0]
    for side, friction in enumerate(problem.frictions):
        creep = problem.gaps_and_creeps(state, stand.lagged)[side][1]
        pressure, states = state.pressure[side], state.states[side]
        peak, width = float(pressure.max()), float(np.ptp(problem.meshes[side].inner))
        if not peak > 0.0:
            return inf
        over = (np.abs(state.shear[side]) - friction * np.maximum(pressure, 0.0))[
            states == State.STICK
        ]
        parts.append(float(np.max(over, initial=0.0)) / (friction * peak))
        signs = SIGNS_OF_STATES.take(states)
        slips = (signs[:-1] != 0.0) & (signs[:-1] == signs[1:])
        wrong = np.where(slips, np.maximum(-signs[:-1] * creep[:-1], 0.0), 0.0)
        allowed = width * max(0.05 * slope, abs(state.creepage))
        parts.append(longest_run(wrong) / allowed)
    return max(parts)


def overlap(stand: PlateAttempt, kernels: PairKernels) -> float:
    """Return how far surfaces and sheet overlap outside the contacts, and tension, relative.

    Over the approach, or the depth of the gap at the edge; over the highest pressure.
    """
    problem, state, nip = stand.problem, stand.state, stand.problem.nip
    width = stand.zones.width
    depth = 0.125 * nip.curvature * width**2
    if not nip.has_half_space:
        depth = max(depth, abs(state.approach))
    parts = [0.0]
    for side, mesh in enumerate(problem.meshes):
        away = stand.zones.sides[side].width * _OUTSIDE
        x = np.concatenate([mesh.inner[0] - away, mesh.inner[-1] + away])
        gap = gap_at(problem, state, kernels, side, x)
        gap += np.interp(x, mesh.inner, stand.lagged.clearance[side])
        parts.append(float(np.max(-gap)) / depth)
        pressure = state.pressure[side]
        peak = float(pressure.max())
        parts.append(float(np.max(-pressure)) / peak if peak > 0.0 else inf)
    return max(parts)


def gap_at(
    problem: PlateProblem, state: PlateState, kernels: PairKernels, side: int, x: Array
) -> Array:
    """Return the gap between one roller and the sheet at some places, linear, (m,) [mm]."""
    sign, nip = (1.0, -1.0)[side], problem.nip
    curvature = (nip.upper.curvature, nip.lower.curvature)[side]
    gap = 0.5 * curvature * x**2 + problem.thinned_at(state, x)[side]
    gap -= sign * problem.height_at(state, x)
    gap += inward_at(problem.meshes[side], state, kernels, side, x)
    return np.asarray(gap - (state.approach if side == 0 else 0.0))


def inward_at(mesh: Mesh, state: PlateState, kernels: PairKernels, side: int, x: Array) -> Array:
    """Return the linear displacement of one roller inwards at some places, (m,) [mm]."""
    surface = (kernels.upper, kernels.lower)[side]
    if surface is None:
        return np.zeros(x.size)
    acting = mesh.acting(state.pressure[side]), (1.0, -1.0)[side] * mesh.acting(state.shear[side])
    made = displacement_under(surface.together, x, mesh.fine.nodes, np.stack(acting, axis=1))
    return np.asarray(made[1, :, 0] - made[2, :, 1])


def carried(stand: PlateAttempt, problem: PlateProblem) -> LaggedPlate:
    """Return the lagged terms of a solution on other meshes."""
    clearance, offsets, lagged = [], [], stand.lagged
    for side, (old, new) in enumerate(zip(stand.problem.meshes, problem.meshes, strict=True)):
        clearance.append(np.interp(new.inner, old.inner, lagged.clearance[side]))
        middles, places = (mesh.inner + 0.5 * mesh.dx for mesh in (old, new))
        rate = lagged.offsets[side] / old.dx
        offsets.append(new.dx * np.interp(places, middles, rate))
    return replace(lagged, clearance=(clearance[0], clearance[1]), offsets=(offsets[0], offsets[1]))
