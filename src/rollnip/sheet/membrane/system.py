"""Discrete equations of a membrane in the nip: two interfaces that share one pressure.

Unknowns are the pressure p, the shears q_u and q_l on the upper and the lower roller's side of the
sheet, the approach, and the creepages of both rollers against the sheet. The sheet's tension
follows from the shears, dN/ds = q_u - q_l and what the curvature of its path adds
(`rollnip.sheet.tension`), and its strain is e = a N + b p with a = (1 - nu^2)/(E h) and
b = nu (1 + nu)/E. The equations, at each node or per interval towards the
leading edge, are

    gap          = clearance - delta + u_z,u + u_z,l + squeeze p + b N          = 0 in contact
    creep, upper = xi_u dx + int (stretch_u - 1 - e_u) dx                       = 0 in stick
    creep, lower = xi_l dx + int (e_l - (stretch_l - 1)) dx                     = 0 in stick

e_u and e_l are the strains of the sheet's faces, which differ from e by the shear through the
thickness: e_u = e - (h/G) d(q_u/3 + q_l/6)/dx, e_l = e + (h/G) d(q_u/6 + q_l/3)/dx. Beside a rubber
covering this is negligible; on a bare rigid roller it keeps the shear continuous where stick ends,
over a length of about h.

In slip, q = mu p sign(creep) on each interface, with its own coefficient mu.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import ContactState, States
from rollnip.nip import Nip
from rollnip.rolling import Displacements
from rollnip.rolling.displacements import SecondFields
from rollnip.rolling.surfaces import Mesh, pair_displacements
from rollnip.sheet.friction import frictions_of
from rollnip.sheet.membrane.matrices import (
    Integrals,
    SheetPath,
    influence_matrix,
    stabilised_tension,
)
from rollnip.sheet.tension import KnownTension
from rollnip.sheets import Sheet

Array = NDArray[np.float64]

_TINY = 1e-12  # mm/MPa


@dataclass(frozen=True, slots=True)
class MembraneState(ContactState):
    """A solution of the membrane problem on a mesh.

    The inherited ``states``, ``shear`` and ``creepage`` are those of the upper interface.

    Attributes
    ----------
    states_lower : (n,) states of the nodes on the lower interface.
    shear_lower : (n,) q_l [MPa].
    creepage_lower : (V_s - V_l)/V. ``creepage`` is (V_u - V_s)/V.
    """

    states_lower: States
    shear_lower: Array
    creepage_lower: float

    @property
    def creepages(self) -> tuple[float, float]:
        """Return (V_u - V_s)/V and (V_s - V_l)/V."""
        return self.creepage, self.creepage_lower

    @property
    def shears(self) -> Array:
        """Return q_u and q_l, (2, n) [MPa]."""
        return np.array((self.shear, self.shear_lower))

    @property
    def both_states(self) -> States:
        """Return the states of both interfaces, (2, n)."""
        return np.array((self.states, self.states_lower))

    def side(self, number: int) -> MembraneState:
        """Return one interface, 0 the upper and 1 the lower, as a contact state of its own."""
        if number == 0:
            return self
        return replace(self, states=self.states_lower, shear=self.shear_lower)


class MembraneMesh(Mesh):
    """A mesh on which the lower roller has a shear of its own.

    ``influence`` is empty: the influence matrix is `MembraneProblem.matrix`.
    """

    __slots__ = ()
    is_bare: ClassVar[bool] = False

    def linear_displacements(self, state: ContactState) -> Displacements:
        """Return the displacements at nodes[1:] that are linear in the tractions."""
        assert isinstance(state, MembraneState)
        return Displacements.under(self.per_traction @ _tractions(state))

    def linear_displacements_at(self, x: Array, state: ContactState) -> Displacements:
        """Return the displacements at ``x`` that are linear in the tractions."""
        assert isinstance(state, MembraneState)
        acting = self.acting(_tractions(state))
        return Displacements.under(pair_displacements(self.kernels, x, self.fine.nodes, acting))

    def second_fields(self, state: ContactState) -> SecondFields:
        """Return the second-order displacements under a solution's tractions as functions."""
        assert isinstance(state, MembraneState)
        nodes, p = self.fine.nodes, self.acting(state.pressure)
        upper = replace(self.kernels, second_lower=None)
        lower = replace(self.kernels, second_upper=None)
        above = upper.second_fields(nodes, p, self.acting(state.shear))
        below = lower.second_fields(nodes, p, self.acting(state.shear_lower))
        functions = above.functions[:2] + below.functions[2:]
        return SecondFields(functions, above.ends[:2] + below.ends[2:])


def _tractions(state: MembraneState) -> Array:
    """Return p, q_u and q_l at the nodes, (n, 3) [MPa]."""
    return np.stack([state.pressure, state.shear, state.shear_lower], axis=1)


@dataclass(frozen=True, slots=True)
class MembraneTerms:
    """Terms that depend on the solution, evaluated from the previous iterate.

    Attributes
    ----------
    clearance : (n,) added to the gap [mm].
    offsets : (2, n) added to the creep of the upper and the lower interface [mm].
    traction : prescribed T_l, or T_l that gives the prescribed torque [N/mm]; None for prescribed
        creepage.
    known : the tension of the sheet without int (q_u - q_l) ds.
    lean : part of the line load that is carried by the shears instead of the pressure [N/mm].
    """

    clearance: Array
    offsets: Array
    traction: float | None
    known: KnownTension
    lean: float = 0.0

    def of_side(self, number: int) -> tuple[Array, Array]:
        """Return the terms of the common gap and of the creep of one interface, each (n,) [mm]."""
        return self.clearance, self.offsets[number]


@dataclass(frozen=True)
class MembraneProblem:
    """The discrete problem on a mesh, without the states of the nodes.

    Attributes
    ----------
    nip, sheet, mesh : the physical problem and the mesh.
    frictions : coefficients of the upper and the lower interface.
    arcs : ds/dx of the sheet's path on the intervals of the fine nodes.
    tension : (n, n) int_x^inf q ds at ``mesh.inner`` per nodal shear [mm].
    tension_over : (n, n) integral of ``tension`` dx over each interval [mm^2].
    force_weights : (n,) int q ds per nodal shear [mm].
    pressure_over : (n, n) int p dx over each interval per nodal pressure [mm].
    own_creep : (2, n) creep of each interval due to the shear of its own node, without the tension
        that this shear causes; negative [mm/MPa].
    matrix : (3 n, 3 n) of gap, upper and lower creep per p, q_u and q_l [mm/MPa].
    has_path : whether the matrix includes the effect of the sheet's curved path on the creeps.
    """

    nip: Nip
    sheet: Sheet
    mesh: MembraneMesh
    frictions: tuple[float, float]
    arcs: Array
    tension: Array
    tension_over: Array
    force_weights: Array
    pressure_over: Array
    own_creep: Array
    matrix: Array
    has_path: bool = False

    @classmethod
    def on(
        cls, nip: Nip, mesh: MembraneMesh, arcs: Array | None = None, *, has_path: bool = False
    ) -> MembraneProblem:
        """Assemble the problem of a nip with a sheet on a mesh.

        ``arcs`` None: all 1. ``has_path``: whether the faces' speeds follow from the curvature of
        the sheet's path, which lies halfway between the surfaces; only on a mesh that ends at the
        edges of the contact.
        """
        sheet = nip.sheet
        assert sheet is not None
        arcs = np.ones(mesh.fine.nodes.size - 1) if arcs is None else arcs
        integrals = Integrals.on(mesh, arcs)
        matrix = influence_matrix(mesh, sheet, integrals)
        n = mesh.inner.size
        own = np.minimum(np.diagonal(matrix)[n:].reshape(2, n), -_TINY)
        over = stabilised_tension(mesh, sheet, integrals, own)
        made = sheet.stretch_by_tension * over
        _, upper, lower = matrix.reshape(3, n, 3, n)
        for block in (upper[:, 1], lower[:, 2]):
            block += made
        for block in (upper[:, 2], lower[:, 1]):
            block -= made
        problem = cls(
            nip=nip,
            sheet=sheet,
            mesh=mesh,
            frictions=frictions_of(nip),
            arcs=arcs,
            tension=integrals.tails,
            tension_over=over,
            force_weights=integrals.totals,
            pressure_over=integrals.interval_integrals,
            own_creep=own,
            matrix=matrix,
            has_path=has_path and not (nip.upper.is_rigid or nip.lower.is_rigid),
        )
        if problem.has_path:
            bent = problem.path.creep_matrix(mesh, sheet.thickness)
            upper += bent
            lower += bent
        return problem

    @property
    def dx(self) -> Array:
        """Return the lengths of the intervals [mm], (n,)."""
        return self.mesh.dx

    @property
    def meshes(self) -> tuple[MembraneMesh, MembraneMesh]:
        """Return the mesh of each interface; both are the same."""
        return self.mesh, self.mesh

    @property
    def curvatures(self) -> tuple[float, float]:
        """Return the curvature of the common gap for each interface [1/mm]."""
        return self.nip.curvature, self.nip.curvature

    @property
    def knows_path(self) -> bool:
        """Whether the curvature of the sheet's path is known: as above, or of a rigid roller."""
        return self.has_path or self.nip.upper.is_rigid or self.nip.lower.is_rigid

    @cached_property
    def path(self) -> SheetPath:
        """Operator for the path of the sheet on this mesh."""
        return SheetPath.on(self.mesh)

    def constant_terms(self, lagged: MembraneTerms) -> Array:
        """Return the parts of gaps and creeps that do not depend on the unknowns, (3, n) [mm]."""
        sheet, mesh, known = self.sheet, self.mesh, lagged.known
        stretch = sheet.stretch_by_tension * known.over(mesh.nodes[1:])
        gap = 0.5 * self.nip.curvature * mesh.inner**2 + lagged.clearance
        gap += sheet.stretch_by_pressure * known.at(mesh.inner)
        return np.stack([gap, lagged.offsets[0] - stretch, lagged.offsets[1] + stretch])

    def tension_at(self, state: MembraneState, known: KnownTension) -> Array:
        """Return the tension of the sheet at ``mesh.inner``, (n,) [N/mm]."""
        pulled = self.tension @ (state.shear - state.shear_lower)
        return np.asarray(known.at(self.mesh.inner) - pulled)

    def strain_over(self, state: MembraneState, known: KnownTension) -> Array:
        """Return int e dx over each interval, (n,) [mm]."""
        tension = known.over(self.mesh.nodes[1:])
        tension -= self.tension_over @ (state.shear - state.shear_lower)
        pressed = self.sheet.stretch_by_pressure * (self.pressure_over @ state.pressure)
        return np.asarray(self.sheet.stretch_by_tension * tension + pressed)

    def gap_and_creeps(self, state: MembraneState, lagged: MembraneTerms) -> Array:
        """Return the gap at the nodes and both creeps over the intervals, (3, n) [mm]."""
        tractions = np.concatenate([state.pressure, state.shear, state.shear_lower])
        made = (self.matrix @ tractions).reshape(3, -1) + self.constant_terms(lagged)
        made[0] -= state.approach
        made[1] += state.creepage * self.dx
        made[2] += state.creepage_lower * self.dx
        return np.asarray(made)

    def creeps(self, state: MembraneState, lagged: MembraneTerms) -> tuple[Array, Array]:
        """Return the creep of each interface over each interval, each (n,) [mm]."""
        _, upper, lower = self.gap_and_creeps(state, lagged)
        return upper, lower

    def shear_forces(self, state: MembraneState, side: int) -> Array:
        """Return int q ds over all intervals but the last of one interface, (n - 1,) [N/mm]."""
        return self.forces(state.shears[side])

    def forces(self, traction: Array) -> Array:
        """Return int t ds over all intervals but the last, (n - 1,) [N/mm]."""
        return np.asarray(-np.diff(self.tension @ traction))

    def displacements(self, state: MembraneState, _: int = 0) -> Displacements:
        """Return the displacements of both rollers at nodes[1:]."""
        return self.mesh.displacements(state)
