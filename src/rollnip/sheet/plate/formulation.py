"""The formulation of a sheet with bending stiffness: a plate."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rollnip.rolling import RollingContact
from rollnip.rolling.claimed_errors import SHARE_OF_EDGE_PEAK
from rollnip.sheet.bending import bending_length
from rollnip.sheet.figures import NAMES, SheetFigures
from rollnip.sheet.friction import SIDE_SIGNS
from rollnip.sheet.lagged_terms import sheet_rate
from rollnip.sheet.plate.interface import fields_of_side, interface_peak
from rollnip.sheet.plate.iterate import PlateIterate, overlap
from rollnip.sheet.plate.lagged_terms import (
    change_of_terms,
    face_levers,
    lagged_terms,
    pull_of,
    residual_with_terms,
)
from rollnip.sheet.plate.search import PlateSearch
from rollnip.sheet.plate.system import PlateProblem, PlateState
from rollnip.sheet.powers import Pulls, sheet_powers

Array = NDArray[np.float64]

_ON_LOWER = [NAMES.index(name) for name in ("nip_width", "peak_pressure", "peak_pressure_x")]


@dataclass(frozen=True, slots=True)
class PlateFormulation:
    """A nip with a plate: each interface has a contact of its own."""

    contact: RollingContact

    def of(self, contact: RollingContact) -> PlateFormulation:
        """Return the same formulation of another contact."""
        return PlateFormulation(contact)

    def search(self) -> PlateSearch:
        """Return the search for its zones."""
        return PlateSearch(self.contact)

    @property
    def bending_length(self) -> float:
        """Length over which bending stiffness acts [mm]."""
        return bending_length(self.contact.nip)

    @property
    def peak_tolerances(self) -> tuple[float, float]:
        """Return the allowed relative error of the peak pressure on each side.

        On a bare roller finite strain leaves the peak more uncertain than the tolerance.
        """
        contact, tolerance = self.contact, self.contact.tolerance
        left = SHARE_OF_EDGE_PEAK["finite"] if contact.has_finite_strain else 0.0
        rigid = max(tolerance, left)
        upper, lower = (
            rigid if one.is_rigid else tolerance for one in (contact.nip.upper, contact.nip.lower)
        )
        return upper, lower

    def figures(self, iterate: PlateIterate) -> tuple[SheetFigures, SheetFigures]:
        """Return figures with width and pressure of the upper interface, and of the lower one."""
        problem, state = iterate.problem, iterate.state
        x = _turning_places(problem, state)
        known = iterate.lagged.known
        tension, strain = problem.tension_at(state, known, x), problem.strain_at(state, known, x)
        pulls = self.pulls(iterate)
        upper = SheetFigures.of(
            iterate,
            sheet_powers(iterate, self.contact.geometry, pulls, _into_sheet(iterate)),
            interface_peak(problem.meshes[0], state.pressure[0]),
            (float(tension.max()), float(tension.min())),
            float(strain[np.argmax(np.abs(strain))]),
        )
        lower = upper.values.copy()
        lower[_ON_LOWER] = (
            iterate.zones.lower.width,
            *interface_peak(problem.meshes[1], state.pressure[1]),
        )
        return upper, SheetFigures(lower)

    def pulls(self, iterate: PlateIterate) -> Pulls:
        """Return int q lambda ds of both rollers [N/mm]."""
        geometry, out = self.contact.geometry, []
        problem, state = iterate.problem, iterate.state
        for side, mesh in enumerate(problem.meshes):
            u = problem.displacements(state, side)
            whole = smooth = pull_of(problem, geometry, state, side, mesh.uncut(u))
            if mesh.kernels.held is not None:
                smooth = pull_of(problem, geometry, state, side, u)
            out.append((whole, smooth))
        return out

    def overlap(self, iterate: PlateIterate) -> float:
        """Return the relative overlap outside the contacts, or the relative tension in them."""
        return overlap(iterate, self.contact.geometry)

    def with_corrections(self, iterate: PlateIterate) -> PlateIterate:
        """Return a solution with lagged terms from the corrections of the contact."""
        nip, held, meshes = self.contact.nip, self.contact.kernels.held, [*iterate.problem.meshes]
        for side, roller in enumerate((nip.upper, nip.lower)):
            if not roller.is_rigid and held is not None:
                own = replace(meshes[side].kernels, held=fields_of_side(held, side))
                meshes[side] = meshes[side].holding(own)
        problem = replace(iterate.problem, meshes=(meshes[0], meshes[1]))
        lagged = lagged_terms(problem, "finite", iterate.state, iterate.lagged)
        change = change_of_terms(lagged, iterate.lagged, problem, iterate.state)
        return replace(iterate, problem=problem, lagged=lagged, change=change)

    def residual_with_terms_of(self, iterate: PlateIterate, other: PlateIterate) -> float:
        """Return the residual of a solution with the lagged terms of ``other``."""
        return residual_with_terms(other.lagged, iterate.lagged, iterate.problem, iterate.state)


def _turning_places(problem: PlateProblem, state: PlateState) -> Array:
    """Return the fine nodes of both meshes and the extrema of the tension between them, (m,) [mm].

    Between these nodes the slope of the tension, q_u - q_l, is linear but for what the curvature of
    the path adds.
    """
    x = np.unique(np.concatenate([one.nodes for one in problem.loads]))
    upper, lower = (
        np.interp(x, one.nodes, one.lines @ (arcs * shear))
        for one, arcs, shear in zip(problem.loads, problem.arcs, state.shear, strict=True)
    )
    slope = upper - lower
    turns = np.flatnonzero(slope[:-1] * slope[1:] < 0.0)
    share = slope[turns] / (slope[turns] - slope[turns + 1])
    return np.unique(np.append(x, x[turns] + share * np.diff(x)[turns]))


def _into_sheet(iterate: PlateIterate) -> float:
    """Return the power of the shears on the faces of the sheet, over V [N/mm].

    The faces run at V_s (1 + e -+ h y''/2). "linear" keeps the products with the strains, which are
    of second order.
    """
    problem, state = iterate.problem, iterate.state
    taken, lagged = 0.0, iterate.lagged
    for side, face in enumerate(face_levers(problem, state, lagged.curved)):
        strain = (problem.strain_over(state, lagged.known, side) / problem.meshes[side].dx)[:-1]
        taken += SIDE_SIGNS[side] * float(face.forces @ (1.0 + strain)) - face.lever_force
    return sheet_rate(*state.creepages) * taken
