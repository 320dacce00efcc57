"""States of a mesh, the fields that follow from them, and the factorised tangent stiffness."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy.linalg import lapack

from rollnip.finite.conjugate_residuals import Directions
from rollnip.finite.relaxing_stress import RelaxingStress, RelaxingTangent
from rollnip.finite.strip import Array, Indices, Strip, quadratics
from rollnip.materials import Slopes


class NoEquilibriumError(ArithmeticError):
    """No equilibrium was found: an element is inverted, or Newton's method does not converge."""


@dataclass(frozen=True)
class PointFields:
    """Deformation and stresses of a state, from which forces and tangent are assembled.

    Attributes
    ----------
    deformation : (4, elements, 9) F at the Gauss points, see `Strip.deformation`.
    c : (elements, 9) G w_J + c, the factor of cof F.
    isotropic : (elements, 9), or (elements, 1) if constant: 2 G w_I, the factor of F.
    pressure_step : (elements, 3) change of the pressures by a Newton step without displacements.
    pressure_rate : (elements, 3, 3) derivatives of the pressures by the volumes.
    energy_slopes : G times the derivatives of w; None where those of second order are zero.
    relaxing : stresses that relax; None where all layers are elastic.
    """

    deformation: Array
    c: Array
    isotropic: Array
    pressure_step: Array
    pressure_rate: Array
    energy_slopes: Slopes | None
    relaxing: RelaxingStress | None


@dataclass(frozen=True)
class Tangent:
    """Factorised tangent stiffness of a state, with the pressures eliminated.

    With viscoelastic layers the stress in a column depends on all columns upstream. The factors
    hold the contributions of each element and of the next one in its row; the rest is applied
    without being stored, in an iterative solution with the factors as preconditioner.

    Attributes
    ----------
    bands : number of diagonals below the main one and above it.
    factors, pivots : from LAPACK's dgbtrf; where ``pivots`` is None, from dpbtrf.
    volume_derivatives : (elements, 3, 18) derivatives of int J N dV by the displacements of an
        element, N the functions of the basis `LINEAR`.
    pressure_derivatives : (elements, 3, 18) derivatives of the pressures likewise.
    relaxing : derivative of the relaxing forces, for what the factors leave out; None where all
        layers are elastic.
    order : (unknowns,) the row of the matrix of each unknown; None: in order.
    """

    bands: tuple[int, int]
    factors: Array
    pivots: Indices | None
    volume_derivatives: Array
    pressure_derivatives: Array
    relaxing: RelaxingTangent | None = None
    order: Indices | None = None

    def solve(self, forces: Array, tolerance: float) -> Array:
        """Return the displacements under some nodal forces, (unknowns,).

        ``tolerance``: relative residual of the iterative solution, if there is one.
        """
        first = self._by_factors(forces)
        if self.relaxing is None:
            return first
        # Volumes are right in the solution by the factors, and what these leave out does not change
        # them. A start from zero would leave a share of that solution, and pressures to answer it.
        goal = tolerance * float(np.linalg.norm(first))
        out = self._directions.solve(self._whole, first, -self._left_out(first), goal)
        if out is None:
            raise NoEquilibriumError
        return out

    @cached_property
    def _directions(self) -> Directions:
        """Directions of the iterative solutions so far."""
        return Directions(self.factors.shape[1])

    def _whole(self, displacement: Array) -> Array:
        """Return the preconditioned matrix times displacements."""
        return displacement + self._left_out(displacement)

    def _left_out(self, displacement: Array) -> Array:
        """Return the displacements by the forces that the factors leave out."""
        assert self.relaxing is not None
        return self._by_factors(self.relaxing.far_forces(displacement))

    def pressure_changes(self, local: Array) -> Array:
        """Return the changes of the pressures (elements, 3) by displacements (elements, 18)."""
        made = np.einsum("eij,ej->ei", self.pressure_derivatives, local)
        if self.relaxing is not None:
            made += self.relaxing.pressure_changes(local)
        return np.asarray(made)

    def _by_factors(self, forces: Array) -> Array:
        """Return the displacements by the factors alone, without what they leave out."""
        if self.order is not None:
            by_place = np.empty_like(forces)
            by_place[self.order] = forces
            forces = by_place
        if self.pivots is None:
            out, info = lapack.dpbtrs(self.factors, forces, lower=1)
        else:
            out, info = lapack.dgbtrs(self.factors, *self.bands, forces, self.pivots)
        if info != 0 or not np.all(np.isfinite(out)):
            raise NoEquilibriumError
        return np.asarray(out if self.order is None else out[self.order])


@dataclass(frozen=True)
class MeshState:
    """Displacements and pressures of a mesh.

    Attributes
    ----------
    displacement : (unknowns,) [mm].
    pressure : (elements, 3) coefficients in the basis `LINEAR` of c + r G, with c of
        P = 2 G w_I F + (G w_J + c) cof F [MPa].
    tangent : tangent stiffness of a state near this one, if there is one.
    """

    displacement: Array
    pressure: Array
    tangent: Tangent | None = field(default=None, repr=False, compare=False)

    def on_columns(self, strip: Strip, other: Strip) -> MeshState:
        """Return this state of the mesh ``strip`` on a mesh ``other`` with other columns.

        Displacements are interpolated by the shape functions of the elements, pressures by their
        linear ones. Beyond the ends of ``strip`` both have their values at the end.
        """
        at, place, _ = _elements_at(strip, other.arcs)
        nodes = self.displacement.reshape(strip.arcs.size, -1)[2 * at[:, None] + np.arange(3)]
        moved = (quadratics(place)[0][..., None] * nodes).sum(axis=1)
        at, place, half = _elements_at(strip, other.arcs[1::2])
        mean, along, down = np.moveaxis(self.pressure.reshape(strip.columns, -1, 3)[at], -1, 0)
        share = (0.5 * np.diff(other.ends) / half)[:, None]
        pressed = np.stack((mean + place[:, None] * along, share * along, down), axis=-1)
        return MeshState(moved.ravel(), pressed.reshape(-1, 3))


def _elements_at(strip: Strip, arcs: Array) -> tuple[Indices, Array, Array]:
    """Return the columns that hold some arcs, the places there on [-1, 1] and half lengths [mm]."""
    at = np.clip(np.searchsorted(strip.ends, arcs) - 1, 0, strip.columns - 1)
    half = 0.5 * np.diff(strip.ends)[at]
    return at, np.clip((arcs - strip.arcs[2 * at + 1]) / half, -1.0, 1.0), half
