"""Contact, stick and slip of both interfaces of a plate, found node by node, edges and all.

Meshes reach beyond the edges, so that contact may grow as well as shrink. Nodes come into contact
and leave it in blocks, and one at a time where blocks turn in a circle (block principal pivoting,
Judice and Pires, Computers Ops Res. 21 (1994) 587); on each contact stick and slip are found.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import Layout, State, States, cosine_nodes, elements_of_zones, subdivided
from rollnip.nip import LineLoad, Nip
from rollnip.rolling import PairKernels
from rollnip.sheet.plate.factorised import FactorisedPlate, next_slip
from rollnip.sheet.plate.lagged import first_lagged
from rollnip.sheet.plate.sides import SIGNS, side_mesh
from rollnip.sheet.plate.system import LaggedPlate, PlateProblem, PlateState
from rollnip.sheet.plate.zones import PlateZones

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Both = tuple[States, States]

_ELEMENTS = 64
_REACH = 1.6  # half of the first mesh over the half-width of a sheet that bends freely
_WIDER = 1.5  # times the reach, where the contact does not fit in
_MOST_REACHES = 4
_MARGIN = 0.15  # of the width, beyond edges that are about known
_PASSES = 2
_MOST_TURNS = 15  # of contact and of stick and slip
_MOST_SLIPS = 25
_BLOCKS = 3  # of nodes that are tried before one node at a time
_PIVOTS = 6  # per node, at most
_SLACK = 1e-9  # of the largest gap or pressure, that counts as rounding


@dataclass(frozen=True)
class Nodewise:
    """The search node by node for one nip.

    Attributes
    ----------
    nip, kernels : the problem; second-order displacements as the kernels hold them.
    """

    nip: Nip
    kernels: PairKernels

    def first(self, half_width: float) -> PlateZones:
        """Return zones on both interfaces; ``half_width``: of a sheet that bends freely [mm].

        Raises
        ------
        numpy.linalg.LinAlgError
            where no contact is found.
        """
        reach = _REACH * half_width
        for _ in range(_MOST_REACHES):
            zones, fits = self._without_friction(None, reach)
            if fits:
                break
            reach *= _WIDER
        for _ in range(_PASSES):
            zones, _ = self._without_friction(zones, inf)
        return zones

    def _without_friction(self, zones: PlateZones | None, reach: float) -> tuple[PlateZones, bool]:
        """Return zones of stick between the edges without friction, and whether the mesh holds it.

        The mesh is that between ``zones`` and a margin, or where there are none out to ``reach``.
        """
        problem = self._problem(zones, reach)
        masks = contact_without_friction(problem)
        upper, lower = (
            _edges(mesh.inner, mask) for mesh, mask in zip(problem.meshes, masks, strict=True)
        )
        fits = not any(mask[0] or mask[-1] for mask in masks)
        return PlateZones.sticking(upper, lower), fits

    def again(self, zones: PlateZones, lagged: LaggedPlate | None) -> PlateZones:
        """Return zones found from some that are about right.

        Parameters
        ----------
        zones : whose ends are nodes of the meshes.
        lagged : whose traction and load are taken; None: without terms that depend on a solution.
        """
        problem = self._problem(zones, inf)
        states = zones.states_on((problem.meshes[0].inner, problem.meshes[1].inner))
        given = first_lagged(problem)
        if lagged is not None:
            given = replace(given, traction=lagged.traction, lean=lagged.lean)
        return _zones_of(problem, _settled(problem, states, given))

    def _problem(self, zones: PlateZones | None, reach: float) -> PlateProblem:
        meshes = []
        for number in (0, 1):
            breaks = np.array([-reach, reach])
            if zones is not None:
                side = zones.sides[number]
                margin, (trailing, leading) = _MARGIN * side.width, side.edges
                outer = [trailing - margin], side.breaks, [leading + margin]
                breaks = np.concatenate(outer)
            even = (1.0,) * (breaks.size - 1)
            elements = elements_of_zones(breaks, _ELEMENTS, even)
            nodes = cosine_nodes(breaks, elements, even)
            fine = subdivided(nodes, elements, even)
            meshes.append(side_mesh(nodes, fine, self.kernels, number))
        return PlateProblem.on(self.nip, (meshes[0], meshes[1]))


def contact_without_friction(problem: PlateProblem) -> tuple[Mask, Mask]:
    """Return which nodes of both interfaces touch without shears, (n,) each.

    Raises
    ------
    numpy.linalg.LinAlgError
        where no contact without tension and overlap is found.
    """
    a, b, c, d, _ = problem.starts
    places, n = np.r_[a:b, c:d], b - a
    matrix, gap, rows, columns, corner, wanted = _normal(problem)
    size = places.size
    x = np.abs(np.concatenate([mesh.inner for mesh in problem.meshes]))
    touches, pivots = x < 0.5 * x.max(), _Pivots()
    for _ in range(_PIVOTS * size):
        where = touches.nonzero()[0]
        system = np.block(
            [[matrix[np.ix_(where, where)], columns[where]], [rows[:, where], corner]]
        )
        found = np.linalg.solve(system, np.concatenate([-gap[where], wanted]))
        pressure = np.zeros(size)
        pressure[where] = found[:-3]
        opened = matrix @ pressure + gap + columns @ found[-3:]
        change = pivots.of(touches, pressure, opened)
        if not change.any():
            return touches[:n], touches[n:]
        touches = touches ^ change
        for part in (slice(0, n), slice(n, size)):
            if not touches[part].any():  # a stiff plate touches a bare roller at one place
                touches[part] = x[part] <= x[part].min() * (1.0 + 1e-9)
    raise np.linalg.LinAlgError("no contact found")


@dataclass(slots=True)
class _Pivots:
    """Which nodes come into contact or leave it next: all that should, or the worst of them."""

    fewest: float = inf
    left: int = _BLOCKS

    def of(self, touches: Mask, pressure: Array, opened: Array) -> Mask:
        """Return the nodes to change, by pressures where nodes touch and gaps where not."""
        pulled, overlapping = -pressure / np.abs(pressure).max(), -opened / np.abs(opened).max()
        wrong = np.where(touches, pulled, overlapping)
        out = wrong > _SLACK
        count = int(out.sum())
        if count < self.fewest:
            self.fewest, self.left = count, _BLOCKS
        elif self.left:
            self.left -= 1
        else:
            out = np.arange(out.size) == int(np.argmax(wrong))
        return np.asarray(out)


def _normal(problem: PlateProblem) -> tuple[Array, Array, Array, Array, Array, Array]:
    """Return gaps per pressure, gaps, and the conditions for approach, height and rotation."""
    a, b, c, d, _ = problem.starts
    places = np.r_[a:b, c:d]
    matrix = problem.matrix[np.ix_(places, places)]
    gap = problem.right(first_lagged(problem))[places]
    n, size = b - a, places.size
    rows, columns, corner = np.zeros((3, size)), np.zeros((size, 3)), np.zeros((3, 3))
    columns[:n, 0] = -1.0
    for side, part in enumerate((slice(0, n), slice(n, size))):
        mesh, spread = problem.meshes[side], problem.spreads[side]
        rows[1, part], rows[2, part] = -SIGNS[side] * mesh.weights, -SIGNS[side] * spread.moment
        columns[part, 1], columns[part, 2] = -SIGNS[side], -SIGNS[side] * mesh.inner
    corner[2, 2] = -problem.plate.righting
    normal = problem.nip.normal
    if isinstance(normal, LineLoad):
        rows[0, :n], first = problem.meshes[0].weights, normal.load
    else:
        corner[0, 0], first = 1.0, normal.approach
    return matrix, gap, rows, columns, corner, np.array([first, 0.0, 0.0])


def _settled(problem: PlateProblem, states: Both, lagged: LaggedPlate) -> PlateState:
    """Return a solution with contact, stick and slip that suit it, or the last one."""
    pivots, n = _Pivots(), problem.meshes[0].inner.size
    for _ in range(_MOST_TURNS):
        state, _ = slipping(problem, states, lagged, _SLACK)
        touches = np.concatenate(state.states) != State.FREE
        (above, _), (below, _) = problem.gaps_and_creeps(state, lagged)
        opened = np.concatenate([above, below])
        change = pivots.of(touches, np.concatenate(state.pressure), opened)
        if not change.any():
            break
        masks = (touches ^ change)[:n], (touches ^ change)[n:]
        if not all(mask.any() for mask in masks):
            break
        states = _carried(state.states, masks)
    return state


def slipping(
    problem: PlateProblem, states: Both, lagged: LaggedPlate, slack: float
) -> tuple[PlateState, int]:
    """Return a solution on a given contact whose stick and slip suit it, or the last one.

    ``slack``: see `next_slip`. Return also how many systems were solved.
    """
    seen: set[bytes] = set()
    for turn in range(1, _MOST_SLIPS + 1):
        state = FactorisedPlate.of(problem, _with_stick(states)).solved(lagged)
        wished = next_slip(problem, state, lagged, slack)
        if all(np.array_equal(one, two) for one, two in zip(wished, states, strict=True)):
            break
        if b"".join(one.tobytes() for one in wished) in seen:
            wished = _one_changed(states, wished, last=turn % 2 == 0)
        seen.add(b"".join(one.tobytes() for one in states))
        states = wished
    return state, turn


def _carried(states: Both, masks: tuple[Mask, Mask]) -> Both:
    """Return states on another contact: nodes that come in take those of the nearest ones."""
    upper, lower = (
        np.where(mask, np.where(one == State.FREE, _beside(one), one), State.FREE).astype(np.int8)
        for one, mask in zip(states, masks, strict=True)
    )
    return upper, lower


def _beside(states: States) -> States:
    """Return the state of the nearest node in contact, by number."""
    touching = (states != State.FREE).nonzero()[0]
    nearest = np.abs(np.arange(states.size)[:, None] - touching).argmin(axis=1)
    return np.asarray(states[touching[nearest]], dtype=np.int8)


def _with_stick(states: Both) -> Both:
    """Keep one node of each interface in stick: material sticks first where it comes in."""
    out = []
    for one in states:
        new = one.copy()
        if not (new == State.STICK).any():
            new[(new != State.FREE).nonzero()[0][-1]] = State.STICK
        out.append(new)
    return out[0], out[1]


def _one_changed(states: Both, wished: Both, *, last: bool) -> Both:
    """Return the states with one of the wished changes only, the first or the last."""
    joined, new = np.concatenate(states), np.concatenate(wished)
    places = (joined != new).nonzero()[0]
    joined[places[-1 if last else 0]] = new[places[-1 if last else 0]]
    return joined[: states[0].size], joined[states[0].size :]


def _zones_of(problem: PlateProblem, state: PlateState) -> PlateZones:
    """Return the zones of nodal states, between the outermost nodes that touch."""
    sides = []
    for number, mesh in enumerate(problem.meshes):
        one = state.side(number)
        edges = _edges(mesh.inner, one.states != State.FREE)
        states = np.where(one.states == State.FREE, _beside(one.states), one.states)
        filled = replace(one, states=states.astype(np.int8))
        layout = Layout.found(mesh.inner, filled, problem.frictions[number], edges)
        stick = Layout.sticking(1.0).states
        sides.append(Layout(np.array(edges), stick) if layout is None else layout)
    return PlateZones(sides[0], sides[1])


def _edges(x: Array, touches: Mask) -> tuple[float, float]:
    """Return the edges half way beyond the outermost nodes that touch [mm]."""
    where = touches.nonzero()[0]
    return _beyond(x, int(where[0]), -1), _beyond(x, int(where[-1]), 1)


def _beyond(x: Array, node: int, step: int) -> float:
    """Return the place half way from a node to the next one outside [mm]."""
    other = node + step
    if not 0 <= other < x.size:
        return float(x[node] + 0.5 * (x[node] - x[node - step]))
    return float(0.5 * (x[node] + x[other]))
