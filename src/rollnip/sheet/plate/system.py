"""Discrete equations of a plate in the nip: two interfaces, each with its own pressure.

Unknowns on each interface are its pressure and shear, on a mesh of its own between its own edges;
then the approach, both creepages, and the height y_0 and the rotation theta of the sheet. With the
height y of the sheet's middle (`rollnip.sheet.plate.bending`), the displacements s_u and s_l of its
faces towards the middle, its tension N and its strain e,

    gap, upper   = x^2/(2 R_u) - delta + u_z,u - y + s_u + b N/2                = 0 in contact
    gap, lower   = x^2/(2 R_l)         + u_z,l + y + s_l + b N/2                = 0 in contact
    creep, upper = xi_u dx + int (stretch_u - 1 - e + h y''/2) dx               = 0 in stick
    creep, lower = xi_l dx + int (e + h y''/2 - stretch_l + 1) dx               = 0 in stick

with e = a N + b (p_u + p_l)/2; bending stretches the faces by -+ h y''/2. The local deformation of
an elastic layer is added to all of these (`PiecewiseLoads.face_displacements`). The forces across
the sheet are in equilibrium, and its tension balances the moment of the nip on it.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import ContactState, States
from rollnip.nip import Nip
from rollnip.rolling import Displacements
from rollnip.rolling.surfaces import Mesh
from rollnip.sheet.friction import SIDE_SIGNS, frictions_of
from rollnip.sheet.plate.bending import Plate
from rollnip.sheet.plate.curved_path import CurvedLoad
from rollnip.sheet.plate.interface import (
    stretch_by,
    values_at,
)
from rollnip.sheet.plate.loads import PiecewiseLoads, moments_about
from rollnip.sheet.plate.matrices import Pair, influence_matrices
from rollnip.sheet.tension import KnownTension
from rollnip.sheets import Sheet

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class PlateState:
    """A solution of the plate problem: tractions on both meshes, and the other unknowns.

    Attributes
    ----------
    states, pressure, shear : of both interfaces, each (n,) [MPa].
    approach : delta [mm].
    creepages : (V_u - V_s)/V and (V_s - V_l)/V.
    height, rotation : y_0 [mm] and theta of the sheet.
    """

    states: tuple[States, States]
    pressure: Pair
    shear: Pair
    approach: float
    creepages: tuple[float, float]
    height: float
    rotation: float

    @property
    def creepage(self) -> float:
        """Return (V_u - V_l)/V."""
        return sum(self.creepages)

    @property
    def tractions(self) -> Array:
        """Return p_u, q_u, p_l and q_l one after the other."""
        parts = zip(self.pressure, self.shear, strict=True)
        return np.concatenate([traction for side in parts for traction in side])

    def side(self, number: int) -> ContactState:
        """Return one interface as a contact state of its own."""
        return ContactState(
            states=self.states[number],
            pressure=self.pressure[number],
            shear=self.shear[number],
            approach=self.approach,
            creepage=self.creepages[number],
            steps=1,
            settled=True,
        )


@dataclass(frozen=True, slots=True)
class PlateTerms:
    """Terms that depend on the solution, evaluated from the previous iterate.

    Attributes
    ----------
    clearance : added to the gaps of both interfaces, each (n,) [mm].
    offsets : added to the creeps, each (n,) [mm].
    traction : prescribed T_l, or T_l that gives the prescribed torque [N/mm]; None for prescribed
        creepage.
    known : the tension of the sheet without int (q_u - q_l) ds.
    lean : part of the line load that is carried by the shears instead of the pressure [N/mm].
    curved : load on the sheet due to its curved path; None where it is neglected.
    """

    clearance: Pair
    offsets: Pair
    traction: float | None
    known: KnownTension
    lean: float = 0.0
    curved: CurvedLoad | None = None

    def of_side(self, number: int) -> tuple[Array, Array]:
        """Return the terms of the gap and of the creep of one interface, each (n,) [mm]."""
        return self.clearance[number], self.offsets[number]


@dataclass(frozen=True)
class PlateProblem:
    """The discrete problem on two meshes, without the states of the nodes.

    Attributes
    ----------
    nip, sheet, plate : the physical problem.
    meshes, loads : of the upper and the lower interface.
    arcs : ds/dx of the sheet's path at the nodes of both meshes.
    frictions : coefficients of both interfaces.
    matrix : (r, r) of gap and creep of the upper, then of the lower interface per p_u, q_u, p_l and
        q_l [mm/MPa].
    rotation_influence : (m, r) rotation of the sections at nodes[1:] of both meshes, likewise
        [1/MPa].
    """

    nip: Nip
    sheet: Sheet
    plate: Plate
    meshes: tuple[Mesh, Mesh]
    loads: tuple[PiecewiseLoads, PiecewiseLoads]
    arcs: tuple[Array, Array]
    frictions: tuple[float, float]
    matrix: Array
    rotation_influence: Array

    @classmethod
    def on(
        cls, nip: Nip, meshes: tuple[Mesh, Mesh], arcs: tuple[Array, Array] | None = None
    ) -> PlateProblem:
        """Assemble the problem of a nip with a plate on meshes of both interfaces.

        ``arcs``: ds/dx of the sheet's path at the nodes of each mesh; None: all 1.
        """
        sheet = nip.sheet
        assert sheet is not None
        plate = Plate.of(sheet)
        loads = (
            PiecewiseLoads.on(meshes[0], sheet, plate),
            PiecewiseLoads.on(meshes[1], sheet, plate),
        )
        if arcs is None:
            arcs = np.ones(meshes[0].inner.size), np.ones(meshes[1].inner.size)
        made = influence_matrices(meshes, loads, arcs)
        return cls(nip, sheet, plate, meshes, loads, arcs, frictions_of(nip), *made)

    @property
    def curvatures(self) -> tuple[float, float]:
        """Return the curvatures of the upper and the lower roller [1/mm]."""
        return self.nip.upper.curvature, self.nip.lower.curvature

    @property
    def starts(self) -> tuple[int, int, int, int, int]:
        """Return the start indices of p_u, q_u, p_l, q_l among the tractions, and the end."""
        n, m = (mesh.inner.size for mesh in self.meshes)
        return 0, n, 2 * n, 2 * n + m, 2 * (n + m)

    def parts(self, values: Array) -> list[Array]:
        """Return the parts of values in the rows of ``matrix``, or of p_u, q_u, p_l and q_l."""
        return [values[first:last] for first, last in pairwise(self.starts)]

    @property
    def places(self) -> Array:
        """Return nodes[1:] of the upper, then of the lower mesh, (m,) [mm]."""
        return np.concatenate([mesh.nodes[1:] for mesh in self.meshes])

    def constant_terms(self, lagged: PlateTerms) -> Array:
        """Return the parts of gaps and creeps without unknowns, in the rows of ``matrix``."""
        sheet, known = self.sheet, lagged.known
        out, half = [], 0.5 * sheet.thickness
        for side, (mesh, curvature) in enumerate(zip(self.meshes, self.curvatures, strict=True)):
            gap = 0.5 * curvature * mesh.inner**2 + lagged.clearance[side]
            creep = lagged.offsets[side]
            if lagged.curved is not None:
                height, turned = lagged.curved.deflection_at(mesh.nodes[1:])
                gap = gap - SIDE_SIGNS[side] * height[:-1]
                creep = creep + half * np.diff(turned)
            out.append(gap + 0.5 * sheet.stretch_by_pressure * known.at(mesh.inner))
            stretch = SIDE_SIGNS[side] * sheet.stretch_by_tension * known.over(mesh.nodes[1:])
            out.append(creep - stretch)
        return np.concatenate(out)

    def gaps_and_creeps(
        self, state: PlateState, lagged: PlateTerms
    ) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
        """Return the gap at the nodes and the creep of the intervals, for each interface [mm]."""
        made = self.parts(self.matrix @ state.tractions + self.constant_terms(lagged))
        for side, mesh in enumerate(self.meshes):
            moved = state.height + state.rotation * mesh.inner
            made[2 * side] -= SIDE_SIGNS[side] * moved
            made[2 * side + 1] += state.creepages[side] * mesh.dx
        made[0] -= state.approach
        return (made[0], made[1]), (made[2], made[3])

    def creeps(self, state: PlateState, lagged: PlateTerms) -> tuple[Array, Array]:
        """Return the creep of each interface over each interval, each (n,) [mm]."""
        (_, upper), (_, lower) = self.gaps_and_creeps(state, lagged)
        return upper, lower

    def shear_forces(self, state: PlateState, side: int) -> Array:
        """Return int q ds over all intervals but the last of one interface, (n - 1,) [N/mm]."""
        return self.forces(state.shear[side], side)

    def forces(self, traction: Array, side: int) -> Array:
        """Return int t ds over all intervals but the last of one interface, (n - 1,) [N/mm].

        (s, n - 1) for s tractions, (n, s).
        """
        x, along = self.meshes[side].inner, (self.arcs[side] * traction.T).T
        beyond = self.loads[side].forces_beyond(x, along)
        return np.asarray(-np.diff(beyond))

    def displacements(self, state: PlateState, side: int) -> Displacements:
        """Return the displacements of one roller at nodes[1:] of its interface."""
        return self.meshes[side].displacements(state.side(side))

    def displacements_at(self, state: PlateState, side: int, x: Array) -> Displacements:
        """Return the displacements of one roller at given places."""
        mesh, own = self.meshes[side], state.side(side)
        if (self.nip.upper, self.nip.lower)[side].is_rigid:
            return Displacements(np.zeros((4, x.size)))
        flat = mesh.linear_displacements_at(x, own)
        return flat if mesh.kernels.is_linear else flat + mesh.second(own, x)

    def tension_at(self, state: PlateState, known: KnownTension, x: Array) -> Array:
        """Return the tension of the sheet at given places, (m,) [N/mm]."""
        upper, lower = (
            one.forces_beyond(x, arcs * shear)
            for one, arcs, shear in zip(self.loads, self.arcs, state.shear, strict=True)
        )
        return np.asarray(known.at(x) - upper + lower)

    def path_at(
        self, state: PlateState, x: Array, curved: CurvedLoad | None = None
    ) -> tuple[Array, Array]:
        """Return height [mm] and rotation of the sheet's middle at given places, each (m,)."""
        height, turned = state.height + state.rotation * x, np.full(x.size, state.rotation)
        half = 0.5 * self.sheet.thickness
        for side, one in enumerate(self.loads):
            both = one.of(np.stack([state.pressure[side], state.shear[side]], axis=1))
            made = both.deflection(x, both.tail_moments_at(x))
            height -= SIDE_SIGNS[side] * made[0][:, 0] + half * made[1][:, 1]
            turned -= SIDE_SIGNS[side] * made[1][:, 0] + half * made[2][:, 1]
        if curved is not None:
            lifted, bent = curved.deflection_at(x)
            height, turned = height + lifted, turned + bent
        return height, turned

    def rotations(self, state: PlateState, curved: CurvedLoad | None = None) -> tuple[Array, Array]:
        """Return the rotation of the sheet's sections at nodes[1:] of both meshes."""
        out = state.rotation + self.rotation_influence @ state.tractions
        if curved is not None:
            out += curved.deflection_at(self.places)[1]
        n = self.meshes[0].nodes.size - 1
        return out[:n], out[n:]

    def face_indentations_at(
        self, state: PlateState, known: KnownTension, places: tuple[Array, Array]
    ) -> list[Array]:
        """Return the displacements of both faces towards the middle, each (m,) [mm].

        ``places``: on the upper and on the lower face.
        """
        x, ends = np.concatenate(places), [places[0].size]
        is_lower = np.arange(x.size) >= ends[0]
        out = 0.5 * self.sheet.stretch_by_pressure * known.at(x)
        for side, one in enumerate(self.loads):
            far = is_lower if side == 0 else ~is_lower
            both = one.of(np.stack([state.pressure[side], self.arcs[side] * state.shear[side]], 1))
            indented, _, warped = both.face_displacements(x, far, both.tail_moments_at(x))
            out += indented[:, 0] - SIDE_SIGNS[side] * warped[:, 1]
        return np.split(out, ends)

    def strain_at(self, state: PlateState, known: KnownTension, x: Array) -> Array:
        """Return the strain of the sheet's middle at given places, (m,)."""
        pressed = sum(
            values_at(mesh, p, x) for mesh, p in zip(self.meshes, state.pressure, strict=True)
        )
        strain = self.sheet.stretch_by_tension * self.tension_at(state, known, x)
        return np.asarray(strain + 0.5 * self.sheet.stretch_by_pressure * pressed)

    def creep_by_sheet(
        self, state: PlateState, known: KnownTension, side: int, flat: Displacements
    ) -> Array:
        """Return the part of one interface's creep due to the sheet's strain, (n,) [mm].

        ``flat``: the linear displacements of its roller at nodes[1:].
        """
        mesh, sheet = self.meshes[side], self.sheet
        rows = slice(self.starts[2 * side + 1], self.starts[2 * side + 2])
        roller = stretch_by(mesh, side, flat.four[2 * side], flat.four[2 * side + 1])
        pulled = sheet.stretch_by_tension * known.over(mesh.nodes[1:])
        by_others = SIDE_SIGNS[side] * (roller + pulled)
        return np.asarray(self.matrix[rows] @ state.tractions - by_others)

    def strain_over(self, state: PlateState, known: KnownTension, side: int) -> Array:
        """Return int e dx of the sheet's middle over the intervals of one interface, (n,) [mm]."""
        mesh, sheet = self.meshes[side], self.sheet
        pressed = np.zeros(mesh.dx.size)
        x = mesh.nodes[1:]
        tension = known.over(x)
        for number, one in enumerate(self.loads):
            pulled = one.of(self.arcs[number] * state.shear[number]).tail_moments_at(x)
            tension += SIDE_SIGNS[number] * np.diff(moments_about(x, pulled, 1)[:, 0])
            pressed -= np.diff(one.forces_beyond(x, state.pressure[number]))
        strain = sheet.stretch_by_tension * tension
        return np.asarray(strain + 0.5 * sheet.stretch_by_pressure * pressed)
