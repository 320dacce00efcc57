"""Zones to begin with: contact, stick and slip of all nodes at once, on meshes around the contacts.

A first mesh reaches far beyond the contacts. Each further one ends nearer to the edges that the one
before found, and its nodes crowd at them; the last ends about a thickness of the sheet away, for on
a rigid roller the pressure ends in a peak as short as that. An edge that is wrong by more than the
peak is long moves the wrong way when zones follow their solution.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import State, cosine_nodes, elements_of_zones, subdivided
from rollnip.nip import Nip, Torque
from rollnip.rolling import PairKernels
from rollnip.rolling.displacements import NO_SECOND_ORDER
from rollnip.sheet.plate.lagged import first_lagged, lagged_terms
from rollnip.sheet.plate.node_by_node import Edges, solve_node_by_node
from rollnip.sheet.plate.sides import side_mesh
from rollnip.sheet.plate.system import LaggedPlate, PlateProblem, PlateState
from rollnip.sheet.plate.zones import PlateZones

_ELEMENTS = 30  # of a mesh that reaches beyond the contacts
_MOST_ELEMENTS = 100
_REACH = 1.6  # half of the first mesh over the half-width of a sheet that bends freely
_WIDER = 1.5  # times the reach, where the contact does not fit in
_MOST_REACHES = 4
_MARGIN = 0.15  # of the width, beyond edges that are about known
_NEARER = 0.25  # times the margin before, where that held the edges
_INSIDE = 0.9  # of the margin, where an edge is away from the end of the mesh
_BESIDE = 8  # elements beyond each edge that is nearly known


@dataclass(frozen=True, slots=True)
class FirstZones:
    """The search for zones to begin with, for one nip."""

    nip: Nip
    kernels: PairKernels

    def around(self, half_width: float, count: int) -> PlateZones:
        """Return zones of a contact of which little is known.

        ``half_width``: about that of a sheet that bends freely [mm]; ``count``: elements of the
        mesh that they begin.
        """
        reach = _REACH * half_width
        for _ in range(_MOST_REACHES):
            problem = self._problem(PlateZones.sticking(reach), 0.0, _ELEMENTS)
            around = (-half_width, half_width)
            state = self._solved_node_by_node(problem, first_lagged(problem), (around, around))
            if all(one[0] == one[-1] == State.FREE for one in state.states):
                break
            reach *= _WIDER
        return self.closer(PlateZones.around(problem, state), None, count)

    def closer(self, zones: PlateZones, lagged: LaggedPlate | None, count: int) -> PlateZones:
        """Return zones from some whose edges are about right, on meshes that crowd there.

        Each mesh ends nearer to the edges that the one before found; where edges moved to the end
        of a mesh, the next one has as much room. Where a mesh has no solution, those before are
        returned. ``lagged``: terms of a solution with about these
        zones, whose traction and load are taken; None: none is known.
        """
        assert self.nip.sheet is not None
        elements, margin = int(np.clip(count, _ELEMENTS, _MOST_ELEMENTS)), _MARGIN
        for _ in range(_MOST_REACHES):
            try:
                found = self._beyond(zones, lagged, elements, margin)
            except np.linalg.LinAlgError:
                break
            are_inside, zones = found.edges_off(zones) < _INSIDE * margin, found
            if are_inside:
                margin *= _NEARER
                if margin * zones.width < self.nip.sheet.thickness:
                    break
        return zones

    def _beyond(
        self, zones: PlateZones, lagged: LaggedPlate | None, elements: int, margin: float
    ) -> PlateZones:
        """Return zones on meshes that end a share of the width beyond the edges of others."""
        problem = self._problem(zones, margin, elements)
        first = first_lagged(problem)
        if lagged is not None:
            first = replace(first, traction=lagged.traction, lean=lagged.lean)
        return PlateZones.around(problem, self._solved_node_by_node(problem, first, zones.edges))

    def _solved_node_by_node(
        self, problem: PlateProblem, lagged: LaggedPlate, edges: Edges
    ) -> PlateState:
        """Return a solution with contact, stick and slip; with a wanted torque on the way too."""
        state, _ = solve_node_by_node(problem, lagged, edges)
        if isinstance(self.nip.tangential, Torque):
            wanted = lagged_terms(problem, "linear", state).traction
            state, _ = solve_node_by_node(problem, replace(lagged, traction=wanted), edges)
        return state

    def _problem(self, zones: PlateZones, margin: float, count: int) -> PlateProblem:
        """Assemble the problem on meshes that end a share of the width beyond the edges.

        Beyond edges that are nearly known nodes crowd at these.
        """
        kernels = self.kernels
        if not kernels.is_fixed:
            kernels = replace(kernels, held=NO_SECOND_ORDER)
        meshes = []
        for number in (0, 1):
            breaks, elements = _breaks(zones, number, margin, count)
            even = (1.0,) * elements.size
            nodes = cosine_nodes(breaks, elements, even)
            fine = subdivided(nodes, elements, even)
            meshes.append(side_mesh(nodes, fine, kernels, number))
        return PlateProblem.on(self.nip, (meshes[0], meshes[1]))


def _breaks(
    zones: PlateZones, number: int, margin: float, count: int
) -> tuple[NDArray[np.float64], NDArray[np.intp]]:
    """Return where nodes of one interface crowd, and how many elements lie between."""
    side, (trailing, leading) = zones.sides[number], zones.sides[number].edges
    beyond = margin * side.width
    if not margin > 0.0:
        return np.array([trailing - beyond, leading + beyond]), np.array([count])
    opposite = zones.sides[1 - number].edges
    within = [x for x in opposite if trailing + beyond < x < leading - beyond]
    inside = np.array(sorted([trailing, *within, leading]))
    elements = np.array([_BESIDE, *elements_of_zones(inside, count), _BESIDE])
    return np.array([trailing - beyond, *inside, leading + beyond]), elements
