"""The formulation of a sheet without bending stiffness: a membrane."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf

import numpy as np
from numpy.typing import NDArray

from rollnip.model import Geometry
from rollnip.rolling import RollingContact
from rollnip.rolling.mesh_solution import peak_pressure
from rollnip.sheet.figures import SheetFigures
from rollnip.sheet.lagged_terms import sheet_rate
from rollnip.sheet.membrane.lagged_terms import (
    change_of_terms,
    face_levers,
    lagged_terms,
    pulls_of,
    residual_with_terms,
)
from rollnip.sheet.membrane.search import MembraneIterate, MembraneSearch, overlap
from rollnip.sheet.membrane.system import MembraneMesh
from rollnip.sheet.powers import Pulls, sheet_powers

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class MembraneFormulation:
    """A nip with a membrane: both interfaces share one contact and one pressure."""

    contact: RollingContact

    def of(self, contact: RollingContact) -> MembraneFormulation:
        """Return the same formulation of another contact."""
        return MembraneFormulation(contact)

    def search(self) -> MembraneSearch:
        """Return the search for its zones."""
        return MembraneSearch(self.contact)

    @property
    def bending_length(self) -> float:
        """Length over which bending stiffness acts: infinite, for there is none."""
        return inf

    @property
    def peak_tolerances(self) -> tuple[float]:
        """Return the allowed relative error of the peak pressure."""
        return (self.contact.tolerance,)

    def figures(self, iterate: MembraneIterate) -> tuple[SheetFigures]:
        """Return the figures of a solution."""
        problem, state, mesh = iterate.problem, iterate.state, iterate.problem.mesh
        geometry = self.contact.geometry
        peak = peak_pressure(mesh.fine.nodes[1:-1], mesh.between(state.pressure))
        tension, strain = problem.tension_at(state, iterate.lagged.known), strain_at(iterate)
        widest = 1.0 if strain.max() > -strain.min() else -1.0
        into_sheet = _into_sheet(iterate, geometry)
        return (
            SheetFigures.of(
                iterate,
                sheet_powers(iterate, geometry, self.pulls(iterate), into_sheet),
                peak,
                (_largest_of(mesh, tension), -_largest_of(mesh, -tension)),
                widest * _largest_of(mesh, widest * strain),
            ),
        )

    def pulls(self, iterate: MembraneIterate) -> Pulls:
        """Return int q lambda ds of both rollers [N/mm]."""
        problem, state, mesh = iterate.problem, iterate.state, iterate.problem.mesh
        geometry, u = self.contact.geometry, mesh.displacements(state)
        whole = smooth = pulls_of(problem, geometry, state, mesh.uncut(u))
        if mesh.held is not None:
            smooth = pulls_of(problem, geometry, state, u)
        return tuple(zip(whole, smooth, strict=True))

    def overlap(self, iterate: MembraneIterate) -> float:
        """Return the relative overlap outside the contact, or the relative tension in it."""
        return overlap(iterate, self.contact.geometry)

    def with_corrections(self, iterate: MembraneIterate) -> MembraneIterate:
        """Return a solution with lagged terms from the corrections of the contact."""
        problem = replace(iterate.problem, mesh=iterate.problem.mesh.holding(self.contact.kernels))
        lagged = lagged_terms(problem, "finite", iterate.state)
        change = change_of_terms(lagged, iterate.lagged, problem, iterate.state)
        return replace(iterate, problem=problem, lagged=lagged, change=change)

    def residual_with_terms_of(self, iterate: MembraneIterate, other: MembraneIterate) -> float:
        """Return the residual of a solution with the lagged terms of ``other``."""
        return residual_with_terms(other.lagged, iterate.lagged, iterate.problem, iterate.state)


def strain_at(iterate: MembraneIterate) -> Array:
    """Return the strain of the sheet at the nodes, (n,)."""
    problem, state, sheet = iterate.problem, iterate.state, iterate.problem.sheet
    tension = sheet.stretch_by_tension * problem.tension_at(state, iterate.lagged.known)
    return np.asarray(tension + sheet.stretch_by_pressure * state.pressure)


def _largest_of(mesh: MembraneMesh, values: Array) -> float:
    """Return the maximum over x of values at ``mesh.inner``, also between nodes.

    Near an edge strains, as tractions, vary as the square root of the distance. They are smooth
    functions of the node number but not of x.
    """
    return peak_pressure(mesh.fine.nodes[1:-1], mesh.between(values))[0]


def _into_sheet(iterate: MembraneIterate, geometry: Geometry) -> float:
    """Return the power of the shears on the faces of the sheet, over V [N/mm].

    The faces run at V_s (1 + e -+ h kappa/2). "linear" neglects products of creepage and strain.
    """
    problem, state, mesh = iterate.problem, iterate.state, iterate.problem.mesh
    faces = face_levers(problem, state, mesh.displacements(state))
    pushed = faces[0].forces - faces[1].forces
    strain = (problem.strain_over(state, iterate.lagged.known) / mesh.dx)[:-1]
    rate = sheet_rate(*state.creepages)
    taken = rate * float(pushed.sum())
    if geometry == "linear":
        return taken + float(pushed @ strain)
    return taken + rate * (float(pushed @ strain) - sum(one.lever_force for one in faces))
