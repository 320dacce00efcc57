"""Two interfaces, two pressures: the linear system that given states of both interfaces make.

Unknowns on either interface are its pressure and shear, on a mesh of its own between its own edges;
then the approach, both creepages, and the height y_0 and the rotation theta of the sheet. With y
the height of the sheet's middle (`rollnip.sheet.plate.bending`), s_u and s_l what its faces give
way towards the middle, N its tension and e its strain,

    gap, upper   = x^2/(2 R_u) - delta + u_z,u - y + s_u + b N/2                = 0 in contact
    gap, lower   = x^2/(2 R_l)         + u_z,l + y + s_l + b N/2                = 0 in contact
    creep, upper = xi_u dx + int (stretch_u - 1 - e + h y''/2) dx               = 0 in stick
    creep, lower = xi_l dx + int (e + h y''/2 - stretch_l + 1) dx               = 0 in stick

e = a N + b (p_u + p_l)/2; the faces of a bent sheet are stretched by -+ h y''/2. All forces on the
sheet add up to nothing across it, and the moment of the nip on it is what its tension rights.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import CREEP_TO_EDGE, ContactState, States
from rollnip.nip import Nip
from rollnip.rolling import Displacements
from rollnip.rolling.surfaces import Mesh
from rollnip.sheet.plate.bending import Plate
from rollnip.sheet.plate.curved import CurvedLoad
from rollnip.sheet.plate.sides import (
    SIGNS,
    Spread,
    curvatures,
    stretch_by,
    values_at,
)
from rollnip.sheet.system import frictions_of
from rollnip.sheets import Sheet

Array = NDArray[np.float64]
Pair = tuple[Array, Array]
"""Values of the upper and of the lower interface."""
_STEEP = 4.0  # how fast the integral of the tension changes its kind


@dataclass(frozen=True, slots=True)
class PlateState:
    """A solution: tractions of both interfaces on their own meshes, and what else is unknown.

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

    def side(self, number: int, *, creepage: float | None = None) -> ContactState:
        """Return one interface as if it were all of the contact."""
        return ContactState(
            states=self.states[number],
            pressure=self.pressure[number],
            shear=self.shear[number],
            approach=self.approach,
            creepage=self.creepages[number] if creepage is None else creepage,
            steps=1,
            settled=True,
        )


@dataclass(frozen=True, slots=True)
class LaggedPlate:
    """Terms that depend on the solution itself, taken from the last solution.

    Attributes
    ----------
    clearance : added to the gaps of either interface, each (n,) [mm].
    offsets : added to the creeps, each (n,) [mm].
    traction : T_l that gives the wanted torque [N/mm]; None where none is wanted.
    lean : line load that the shears take from the pressure [N/mm].
    curved : what acts on the sheet because its path is curved; None where that is left out.
    """

    clearance: Pair
    offsets: Pair
    traction: float | None
    lean: float = 0.0
    curved: CurvedLoad | None = None


@dataclass(frozen=True)
class PlateProblem:
    """The discrete problem on two meshes: everything that does not depend on the states.

    Attributes
    ----------
    nip, sheet, plate : the problem.
    meshes, spreads : of the upper and the lower interface.
    pulls : spreads of shears along the sheet's path, whose tails are int q ds and so on.
    frictions : coefficients of both.
    own : creep of each interval by the shear of its own node, without the tension and the bending
        that this shear makes; negative, each (n,) [mm/MPa].
    matrix : (r, r) of gap and creep of the upper, then of the lower interface per p_u, q_u, p_l and
        q_l [mm/MPa].
    """

    nip: Nip
    sheet: Sheet
    plate: Plate
    meshes: tuple[Mesh, Mesh]
    spreads: tuple[Spread, Spread]
    pulls: tuple[Spread, Spread]
    frictions: tuple[float, float]
    own: Pair
    matrix: Array

    @classmethod
    def on(
        cls, nip: Nip, meshes: tuple[Mesh, Mesh], arcs: tuple[Array, Array] | None = None
    ) -> PlateProblem:
        """Assemble the problem of a nip with a plate on meshes of both interfaces.

        ``arcs``: ds/dx of the sheet's path at the finer nodes of either mesh; None: all 1.
        """
        sheet = nip.sheet
        assert sheet is not None
        plate = Plate.of(sheet)
        spreads = Spread.on(meshes[0], sheet, plate), Spread.on(meshes[1], sheet, plate)
        pulls = spreads
        if arcs is not None:
            upper, lower = (
                Spread.on(mesh, sheet, plate, along)
                for mesh, along in zip(meshes, arcs, strict=True)
            )
            pulls = upper, lower
        by_rollers = [_by_roller(mesh, at) for at, mesh in enumerate(meshes)]
        above, below = (
            np.diagonal(first)[first.shape[0] // 2 :] - sheet.shear_by_thickness / 3.0
            for first in by_rollers
        )
        both = above, below
        by_sheet = [_by_sheet(meshes, (spreads, pulls), by, both) for by in (0, 1)]
        for at, first in enumerate(by_rollers):
            rows = by_sheet[at][at]
            rows += first
            rows[-2, -2] *= 1.0 - CREEP_TO_EDGE
        matrix = np.block([[by_sheet[by][at] for by in (0, 1)] for at in (0, 1)])
        return cls(nip, sheet, plate, meshes, spreads, pulls, frictions_of(nip), both, matrix)

    @property
    def starts(self) -> tuple[int, int, int, int, int]:
        """Return where p_u, q_u, p_l and q_l begin among the tractions, and where they end."""
        n, m = (mesh.inner.size for mesh in self.meshes)
        return 0, n, 2 * n, 2 * n + m, 2 * (n + m)

    def right(self, lagged: LaggedPlate) -> Array:
        """Return gaps and creeps without unknowns, in the order of the rows of ``matrix``."""
        sheet, pulled = self.sheet, self.sheet.tension_in
        out, half = [], 0.5 * sheet.thickness
        for side, (mesh, curvature) in enumerate(
            zip(self.meshes, curvatures(self.nip), strict=True)
        ):
            gap = 0.5 * curvature * mesh.inner**2 + lagged.clearance[side]
            creep = lagged.offsets[side]
            if lagged.curved is not None:
                height, turned = lagged.curved.bent_at(mesh.nodes[1:])
                gap = gap - SIGNS[side] * height[:-1]
                creep = creep + half * np.diff(turned)
            out.append(gap + 0.5 * sheet.stretch_by_pressure * pulled)
            stretch = SIGNS[side] * sheet.stretch_by_tension * pulled * mesh.dx
            out.append(creep - stretch)
        return np.concatenate(out)

    def gaps_and_creeps(
        self, state: PlateState, lagged: LaggedPlate
    ) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
        """Return the gap at the nodes and the creep of the intervals, of either interface [mm]."""
        tractions = np.concatenate(
            [state.pressure[0], state.shear[0], state.pressure[1], state.shear[1]]
        )
        made = np.split(self.matrix @ tractions + self.right(lagged), self.starts[1:-1])
        for side, mesh in enumerate(self.meshes):
            moved = state.height + state.rotation * mesh.inner
            made[2 * side] -= SIGNS[side] * moved
            made[2 * side + 1] += state.creepages[side] * mesh.dx
        made[0] -= state.approach
        return (made[0], made[1]), (made[2], made[3])

    def tension_at(self, state: PlateState, x: Array) -> Array:
        """Return the tension of the sheet at some places, (m,) [N/mm]."""
        upper, lower = (
            one.of(shear).beyond(x)[0, :, 0]
            for one, shear in zip(self.pulls, state.shear, strict=True)
        )
        return np.asarray(self.sheet.tension_in - upper + lower)

    def height_at(self, state: PlateState, x: Array, curved: CurvedLoad | None = None) -> Array:
        """Return the height of the sheet's middle at some places, (m,) [mm]."""
        out = state.height + state.rotation * x
        if curved is not None:
            out += curved.bent_at(x)[0]
        half = 0.5 * self.sheet.thickness
        for side, (pressed, sheared) in enumerate(self._bent_at(state, x)):
            out -= SIGNS[side] * pressed[0] + half * sheared[1]
        return np.asarray(out)

    def rotation_at(self, state: PlateState, x: Array, curved: CurvedLoad | None = None) -> Array:
        """Return the rotation of the sheet's sections at some places, (m,)."""
        out = np.full(x.size, state.rotation)
        if curved is not None:
            out += curved.bent_at(x)[1]
        half = 0.5 * self.sheet.thickness
        for side, (pressed, sheared) in enumerate(self._bent_at(state, x)):
            out -= SIGNS[side] * pressed[1] + half * sheared[2]
        return out

    def direction_at(self, state: PlateState, x: Array, curved: CurvedLoad | None = None) -> Array:
        """Return what stretches the faces as it changes: the sine of the path's direction, (m,).

        Where the path counts as straight, ``curved`` None, that is its rotation.
        """
        turned = self.rotation_at(state, x, curved)
        return turned if curved is None else np.asarray(turned / np.sqrt(1.0 + turned**2))

    def _bent_at(self, state: PlateState, x: Array) -> list[tuple[list[Array], list[Array]]]:
        """Return what pressure and shear of either interface do as loads, see `Spread.bent`."""
        out = []
        for one, *tractions in zip(self.spreads, state.pressure, state.shear, strict=True):
            both = one.of(np.stack(tractions, axis=1))
            made = both.bent(x, both.beyond(x))
            out.append(([part[:, 0] for part in made], [part[:, 1] for part in made]))
        return out

    def thinned_at(self, state: PlateState, x: Array) -> Array:
        """Return how far both faces give way towards the middle at some places, (2, m) [mm]."""
        out = np.zeros((2, x.size))
        out += 0.5 * self.sheet.stretch_by_pressure * self.tension_at(state, x)
        for side, one in enumerate(self.spreads):
            alone = one.of(state.pressure[side])
            out[side] += alone.squeezed(x, far=False)[:, 0]
            out[1 - side] += alone.squeezed(x, far=True)[:, 0]
        return out

    def strain_at(self, state: PlateState, x: Array) -> Array:
        """Return the strain of the sheet's middle at some places, (m,)."""
        pressed = sum(
            values_at(mesh, x) @ p for mesh, p in zip(self.meshes, state.pressure, strict=True)
        )
        strain = self.sheet.stretch_by_tension * self.tension_at(state, x)
        return np.asarray(strain + 0.5 * self.sheet.stretch_by_pressure * pressed)

    def creep_by_sheet(self, state: PlateState, side: int, flat: Displacements) -> Array:
        """Return what the strain of the sheet's face adds to the creep of one interface, (n,) [mm].

        ``flat``: the linear displacements of its roller at nodes[1:].
        """
        mesh, sheet = self.meshes[side], self.sheet
        tractions = np.concatenate(
            [state.pressure[0], state.shear[0], state.pressure[1], state.shear[1]]
        )
        rows = slice(self.starts[2 * side + 1], self.starts[2 * side + 2])
        roller = stretch_by(mesh, side, flat.four[2 * side], flat.four[2 * side + 1])
        pulled = sheet.stretch_by_tension * sheet.tension_in * mesh.dx
        return np.asarray(self.matrix[rows] @ tractions - SIGNS[side] * (roller + pulled))

    def strain_over(self, state: PlateState, side: int) -> Array:
        """Return int e dx of the sheet's middle over the intervals of one interface, (n,) [mm]."""
        mesh, sheet = self.meshes[side], self.sheet
        tension = sheet.tension_in * mesh.dx
        pressed = np.zeros(mesh.dx.size)
        for number, one in enumerate(self.spreads):
            second = self.pulls[number].of(state.shear[number]).beyond(mesh.nodes[1:])[1, :, 0]
            first = one.of(state.pressure[number]).beyond(mesh.nodes[1:])[0, :, 0]
            tension += SIGNS[number] * np.diff(second)
            pressed -= np.diff(first)
        strain = sheet.stretch_by_tension * tension
        return np.asarray(strain + 0.5 * sheet.stretch_by_pressure * pressed)


def _by_roller(mesh: Mesh, side: int) -> Array:
    """Return gap and creep of one interface by its own roller, (2 n, 2 n) [mm/MPa]."""
    n, sign = mesh.inner.size, SIGNS[side]
    xx, zz, xz = mesh.per_traction[3 * side : 3 * side + 3]
    out = np.zeros((2 * n, 2 * n))
    out[:n, :n] = zz[:-1]
    out[:n, n:] = -sign * xz[:-1]
    out[n:, :n] = sign * stretch_by(mesh, side, xz, zz)
    out[n:, n:] = stretch_by(mesh, side, xx, -xz)
    return out


def _by_sheet(
    meshes: tuple[Mesh, Mesh],
    spreads: tuple[tuple[Spread, Spread], tuple[Spread, Spread]],
    by: int,
    owns: Pair,
) -> tuple[Array, Array]:
    """Return gap and creep of either interface by what tractions on one do to the sheet.

    ``spreads``: of loads, and of pulls; ``by``: the interface that the tractions act on.
    """
    one, pull = spreads[0][by], spreads[1][by]
    x = np.concatenate([mesh.nodes[1:] for mesh in meshes])
    beyond = one.beyond(x)
    pulled = beyond if pull is one else pull.beyond(x)
    bent, end = one.bent(x, beyond), meshes[0].nodes.size - 1
    upper, lower = (
        _by_sheet_at(meshes, (one, pull), (at, by), owns[at], made)
        for at, made in enumerate(
            zip(*(np.split(part, [end]) for part in (*beyond[:1], *pulled[:2], *bent)), strict=True)
        )
    )
    return upper, lower


def _by_sheet_at(
    meshes: tuple[Mesh, Mesh],
    spreads: tuple[Spread, Spread],
    sides: tuple[int, int],
    own: Array,
    made: tuple[Array, ...],
) -> Array:
    """Return gap and creep of one interface by what tractions on one of them do to the sheet.

    ``sides``: the interface that they are of, and the one that the tractions act on; ``made``: int
    t ds beyond nodes[1:] of loads, that of pulls and its integral, and what `Spread.bent` says.
    """
    (at, by), mesh, (one, pull) = sides, meshes[sides[0]], spreads
    n, m = mesh.inner.size, one.lines.shape[1]
    sheet, half = one.sheet, 0.5 * one.sheet.thickness
    here, there = SIGNS[at], SIGNS[by]
    loads, first, second, height, slope, bend = made
    by_pressure = sheet.stretch_by_pressure
    out = np.zeros((2, n, 2, m))
    # y goes with -p_u and +p_l, the gap above with -y and below with +y
    out[0, :, 0] = here * there * height[:-1] + one.squeezed(mesh.inner, far=at != by)
    out[0, :, 1] = here * half * slope[:-1] - 0.5 * there * by_pressure * first[:-1]
    pressed = loads[:-1] - loads[1:]
    out[1, :, 0] = -there * half * np.diff(slope, axis=0) - 0.5 * here * by_pressure * pressed
    share = _lumped_share(one, mesh, own)
    exact = _stretched(one, here * there, np.diff(second, axis=0), np.diff(bend, axis=0))
    out[1, :, 1] = (1.0 - share) * exact
    if share.any():
        out[1, :, 1] += share * _point_stretched(meshes, pull, sides)
    through = (1.0 / 3.0 if at == by else 1.0 / 6.0) * sheet.shear_by_thickness
    if at == by:
        out[1, :, 1] += through * (np.eye(n, k=1) - np.eye(n))
    else:
        out[1, :, 1] += through * np.diff(values_at(meshes[by], mesh.nodes[1:]), axis=0)
    return out.reshape(2 * n, 2 * m)


def _stretched(one: Spread, sign: float, tails: Array, bends: Array) -> Array:
    """Return the creep by the strain of a face under shears: tension, and bending by couples."""
    sheet = one.sheet
    stretched = -sign * sheet.stretch_by_tension * tails
    return np.asarray(stretched - 0.25 * sheet.thickness**2 * bends)


def _lumped_share(one: Spread, mesh: Mesh, own: Array) -> Array:
    """Return the share of each interval that takes shears as forces at their nodes, (n, 1).

    Where an interval stretches more by the tension and the bending that its own node makes than by
    that node's shear on the roller, exact integrals let neighbouring shears alternate and grow.
    """
    strain = 4.0 * one.sheet.stretch_by_tension
    ratio = strain * mesh.dx**2 / (6.0 * np.abs(own))
    share = 1.0 / (1.0 + np.clip(ratio, 1e-9, 1e6) ** -_STEEP)
    return np.asarray(np.where(share > 1e-12, share, 0.0)[:, None])


def _point_stretched(meshes: tuple[Mesh, Mesh], one: Spread, sides: tuple[int, int]) -> Array:
    """Return what `_stretched` says of forces at the nodes instead of tractions."""
    at, by = sides
    x, places = meshes[at].nodes[1:], meshes[by].inner
    ahead = np.maximum(places - x[:, None], 0.0)
    bends = one.plate.curvature(x[:, None] - places)
    found = _stretched(one, SIGNS[at] * SIGNS[by], np.diff(ahead, axis=0), np.diff(bends, axis=0))
    return np.asarray(one.whole * found)
