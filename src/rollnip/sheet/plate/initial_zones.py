"""Initial zones of a plate: contact, stick and slip at all nodes, on meshes around the contacts.

The first mesh extends far beyond the contacts. A second one ends closer to the edges that it found,
and its nodes crowd there. Beside a bare roller more of them follow, the last of which ends about
one sheet thickness away, because there the pressure ends in a peak as short as that: an edge whose
error exceeds the length of the peak would move the wrong way in the search that follows.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import State, cosine_nodes, elements_of_zones, subdivided
from rollnip.nip import Torque
from rollnip.rolling import RollingContact
from rollnip.sheet.iterate import kernels_after
from rollnip.sheet.lagged_terms import traction_within_friction
from rollnip.sheet.plate.complementarity import solve_complementarity
from rollnip.sheet.plate.interface import interface_mesh
from rollnip.sheet.plate.lagged_terms import initial_terms, lagged_terms
from rollnip.sheet.plate.system import PlateProblem, PlateState, PlateTerms
from rollnip.sheet.plate.zones import PlateZones

_ELEMENTS = 30  # least number for a mesh that extends beyond the contacts
_MOST_ELEMENTS = 100
_REACH = 1.6  # half-length of the first mesh over the half-width of a membrane
_WIDER = 1.5  # growth of the first mesh where the contact does not fit into it
_MOST_REACHES = 4
_MARGIN = 0.15  # over the width, beyond edges that are approximately known
_NEARER = 0.25  # reduction of the margin where the mesh contained the edges
_INSIDE = 0.9  # of the margin: an edge that moved less counts as inside the mesh
_MOST_TRACTIONS = 10  # on the way to a torque near what friction carries
_BESIDE = 8  # elements beyond each approximately known edge


@dataclass(frozen=True, slots=True)
class InitialZones:
    """The search for initial zones, for one nip."""

    contact: RollingContact

    def around(self, half_width: float, count: int) -> PlateZones:
        """Return zones of a contact of which only an approximate half-width is known.

        ``half_width``: about that of a membrane [mm]; ``count``: elements of the mesh for which the
        zones are meant.
        """
        reach = _REACH * half_width
        for _ in range(_MOST_REACHES):
            problem = self._problem(PlateZones.sticking(reach), 0.0, _ELEMENTS)
            around, first = (-half_width, half_width), initial_terms(problem)
            state, _ = solve_complementarity(problem, first, (around, around))
            if all(one[0] == one[-1] == State.FREE for one in state.states):
                break
            reach *= _WIDER
        if isinstance(self.contact.nip.tangential, Torque):  # pressures tell which traction it is
            state, first = _for_torque(problem, state, (around, around))
        return self.closer(PlateZones.around(problem, state), first, count)

    def closer(self, zones: PlateZones, lagged: PlateTerms, count: int) -> PlateZones:
        """Return more accurate zones from approximate ones, on meshes that crowd at their edges.

        Each mesh ends closer to the edges that the previous one found; where edges moved to the end
        of a mesh, the next one keeps the same margin. One mesh that contains the edges is enough
        where no roller is bare. Where a mesh has no solution, the last zones are returned.

        ``lagged``: terms of a solution with approximately these zones, of which the traction, the
        shear-borne load and the known tension are used.
        """
        assert self.contact.nip.sheet is not None
        elements, margin = int(np.clip(count, _ELEMENTS, _MOST_ELEMENTS)), _MARGIN
        has_peaks = not (self.contact.nip.upper.layers and self.contact.nip.lower.layers)
        for _ in range(_MOST_REACHES):
            try:
                found = self._beyond(zones, lagged, elements, margin)
            except np.linalg.LinAlgError:
                break
            are_inside, zones = found.edges_off(zones) < _INSIDE * margin, found
            if are_inside:
                margin *= _NEARER
                if not has_peaks or margin * zones.width < self.contact.nip.sheet.thickness:
                    break
        return zones

    def _beyond(
        self, zones: PlateZones, lagged: PlateTerms, elements: int, margin: float
    ) -> PlateZones:
        """Return the zones on meshes that end ``margin`` times the width beyond the edges."""
        problem = self._problem(zones, margin, elements)
        known = replace(
            initial_terms(problem),
            traction=lagged.traction,
            lean=lagged.lean,
            known=lagged.known,
        )
        state, _ = solve_complementarity(problem, known, zones.edges)
        return PlateZones.around(problem, state)

    def _problem(self, zones: PlateZones, margin: float, count: int) -> PlateProblem:
        """Assemble the problem on meshes that end ``margin`` times the width beyond the edges.

        Where the edges are approximately known, nodes crowd there.
        """
        kernels = kernels_after(None, self.contact.kernels)
        meshes = []
        for number in (0, 1):
            breaks, elements = _breaks(zones, number, margin, count)
            nodes = cosine_nodes(breaks, elements)
            fine = subdivided(nodes, elements)
            meshes.append(interface_mesh(nodes, fine, kernels, number))
        return PlateProblem.on(self.contact.nip, (meshes[0], meshes[1]))


def _for_torque(
    problem: PlateProblem, state: PlateState, edges: tuple[tuple[float, float], tuple[float, float]]
) -> tuple[PlateState, PlateTerms]:
    """Return a solution, and the terms with the traction that a torque asks for beside it.

    ``state``: the solution without that traction; ``edges``: approximate ones of both contacts.
    """
    for _ in range(_MOST_TRACTIONS):
        asked = lagged_terms(problem, "linear", state)
        lagged = replace(asked, traction=traction_within_friction(problem, state, asked.traction))
        if lagged.traction == asked.traction:
            break
        state, _ = solve_complementarity(problem, lagged, edges)
    return state, lagged


def _breaks(
    zones: PlateZones, number: int, margin: float, count: int
) -> tuple[NDArray[np.float64], NDArray[np.intp]]:
    """Return the places where nodes of one interface crowd, and the elements in between."""
    side, (trailing, leading) = zones.sides[number], zones.sides[number].edges
    beyond = margin * side.width
    if not margin > 0.0:
        return np.array([trailing - beyond, leading + beyond]), np.array([count])
    opposite = zones.sides[1 - number].edges
    within = [x for x in opposite if trailing + beyond < x < leading - beyond]
    inside = np.array(sorted([trailing, *within, leading]))
    elements = np.array([_BESIDE, *elements_of_zones(inside, count), _BESIDE])
    return np.array([trailing - beyond, *inside, leading + beyond]), elements
