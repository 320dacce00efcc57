"""The iterate of the search for a plate: checks of its edges and peaks, gaps, and overlap."""

from __future__ import annotations

from dataclasses import replace
from math import inf

import numpy as np
from numpy.typing import NDArray

from rollnip._largest import largest
from rollnip.contact import State
from rollnip.model import Geometry
from rollnip.rolling import surface_depths
from rollnip.sheet.conditions import OUTSIDE, violation_outside
from rollnip.sheet.friction import SIDE_SIGNS
from rollnip.sheet.iterate import SheetIterate
from rollnip.sheet.lagged_terms import interpolated
from rollnip.sheet.plate.curved_path import places_along
from rollnip.sheet.plate.system import PlateProblem, PlateState, PlateTerms
from rollnip.sheet.plate.zones import PlateZones

Array = NDArray[np.float64]


PlateIterate = SheetIterate[PlateZones, PlateProblem, PlateState, PlateTerms]


def shear_over(iterate: PlateIterate) -> float:
    """Return the largest excess of a sticking node's shear over its bound, over the largest bound.

    Infinite where one side has no pressure.
    """
    state, parts = iterate.state, [0.0]
    for side, friction in enumerate(iterate.problem.frictions):
        bound = friction * np.maximum(state.pressure[side], 0.0)
        if not np.any(state.pressure[side] > 0.0):
            return inf
        over = (np.abs(state.shear[side]) - bound)[state.states[side] == State.STICK]
        parts.append(float(np.max(over, initial=0.0)) / float(bound.max()))
    return largest(*parts)


def pulls_at_edges(iterate: PlateIterate) -> bool:
    """Return whether the pressure beside any edge is tensile; see `Mesh.has_tension_at_edge`."""
    sides = zip(iterate.problem.meshes, iterate.state.pressure, strict=True)
    return any(mesh.has_tension_at_edge(pressure) for mesh, pressure in sides)


def added_to_peaks(iterate: PlateIterate, proposed: PlateZones) -> float:
    """Return the relative amount by which misplaced edges raise the peak pressures beside them.

    An edge that lies too far inwards by delta gives p ~ sqrt(y) + delta/(2 sqrt(y)) at the distance
    y from it, which on short elements exceeds all other pressures.

    ``proposed``: zones with their edges where they should be.
    """
    parts = [0.0]
    for side, mesh in enumerate(iterate.problem.meshes):
        x, top = mesh.inner, int(np.argmax(iterate.state.pressure[side]))
        for node, edge, place in zip((1, x.size - 2), (0, -1), proposed.edges[side], strict=True):
            if top == node:
                off, away = abs(place - x[edge]), abs(x[node] - x[edge])
                parts.append(float(off / (2.0 * away + off)))
    return largest(*parts)


def overlap(iterate: PlateIterate, geometry: Geometry) -> float:
    """Return the relative overlap outside the contacts, or the relative tension in them."""
    problem, state, width = iterate.problem, iterate.state, iterate.zones.width
    places = []
    for mesh, side in zip(problem.meshes, iterate.zones.sides, strict=True):
        away = side.width * OUTSIDE
        places.append(np.concatenate([mesh.inner[0] - away, mesh.inner[-1] + away]))
    gaps = gaps_at(iterate, geometry, (places[0], places[1]))
    parts = (
        violation_outside(problem.nip, gap, pressure, width, state.approach)
        for gap, pressure in zip(gaps, state.pressure, strict=True)
    )
    return largest(*parts)


def gaps_at(iterate: PlateIterate, geometry: Geometry, places: tuple[Array, Array]) -> list[Array]:
    """Return the gaps between each roller and the sheet at places of their own, each (m,) [mm]."""
    problem, state, curved = iterate.problem, iterate.state, iterate.lagged.curved
    x, ends = np.concatenate(places), [places[0].size]
    heights, rotations = (np.split(part, ends) for part in problem.path_at(state, x, curved))
    indented = problem.face_indentations_at(state, iterate.lagged.known, places)
    out = []
    for side, here in enumerate(places):
        u = problem.displacements_at(state, side, here)
        gap = surface_depths(here, problem.nip, geometry, u)[side] + indented[side]
        gap -= SIDE_SIGNS[side] * heights[side]
        if curved is not None:
            gap -= 0.25 * problem.sheet.thickness * rotations[side] ** 2
        out.append(np.asarray(gap - (state.approach if side == 0 else 0.0)))
    return out


def interpolated_terms(iterate: PlateIterate, problem: PlateProblem) -> PlateTerms:
    """Return the lagged terms of a solution, interpolated to other meshes."""
    lagged = iterate.lagged
    upper, lower = (
        interpolated(old, new, lagged.clearance[side], lagged.offsets[side])
        for side, (old, new) in enumerate(zip(iterate.problem.meshes, problem.meshes, strict=True))
    )
    curved = lagged.curved
    return replace(
        lagged,
        clearance=(upper[0], lower[0]),
        offsets=(upper[1], lower[1]),
        curved=curved and curved.at(places_along(problem)),
    )
