"""Equilibrium of a covering at finite strain under follower loads, by Newton's method.

The strain energy of a layer is  psi = G [w(I, J) - r ln J] + U(J),  I = F : F
(`rollnip.materials`), its nominal stress

    P = 2 G w_I F + (G w_J + c) cof F,     c = U'(J) - r G/J;

w = I/2 and r = 1 is neo-Hookean. An incompressible layer has J = 1 and c = pi - r G with an unknown
pi. The elements are mixed ones: volume and pressure are linear in each element and discontinuous
between elements. In c, J is replaced by its projection on such functions, and c by its own (Simo,
Taylor & Pister 1985, Comput. Methods Appl. Mech. Eng. 51, 177-208); so nothing locks as nu
approaches 0.5. Pressures are eliminated element by element.

The force on the surface per undeformed arc ds is  (q x' - p y', p x' + q y'), with the pressure p
and the shear q at the *present* place x(s). The tangent stiffness includes its full derivative.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import inf, sqrt

import numpy as np
from scipy.linalg import lapack

from rollnip.finite.follower_load import FollowerLoad, Tractions, summed
from rollnip.finite.memory import Memory
from rollnip.finite.relaxing_stress import RelaxingStress, RelaxingTangent
from rollnip.finite.state import (
    MeshState,
    NoEquilibriumError,
    PointFields,
    Tangent,
)
from rollnip.finite.strip import LINEAR, Array, Indices, Strip
from rollnip.materials import Energy, NeoHookean, Slopes

# Compliance of the volume to the pressure, over 1/G, with which an incompressible layer is regular
# within a step. The result does not depend on it: every step updates the pressures, as an augmented
# Lagrangian does, and reduces J - 1 by about this factor.
_VOLUME_COMPLIANCE = 1e-6
_NEO_HOOKEAN = NeoHookean()
# Tolerance: root of the energy of the error over that of the work of the tractions. Displacements
# alone would not do: a skin answers short waves, a millionth of the displacement, with pressures
# like those of the contact.
EQUILIBRIUM_TOLERANCE = 1e-5
# Equilibria that converge take five steps at most (485 of the examples and 100 random nips).
_MOST_STEPS = 15
_LEAST_VOLUME = 0.1  # smallest J that a step may lead to
_STEP_RESIDUAL = 1e-3  # relative residual of an iterative linear solution within a step
_LEAST_PART = 1e-2  # smallest part of a Newton step that is tried
_CONTRACTION = 0.3  # ratio of successive steps up to which a tangent is used again
# Ratio expected of the step after the first one, if both use the tangent at the start, over the
# first step relative to the displacement.
_EXPECTED_CONTRACTION = 3.0


@dataclass(frozen=True)
class Body:
    """A mesh of a covering with the strain energies of its elements.

    Attributes
    ----------
    strip : the mesh.
    speed : V at which the covering passes it [mm/s]; None: all layers act as elastic ones with the
        relaxed modulus.
    """

    strip: Strip
    speed: float | None = None

    @cached_property
    def memory(self) -> Memory | None:
        """Memory of the viscoelastic layers; None where all layers are elastic."""
        if self.speed is None or not self.strip.depths.roller.is_viscoelastic:
            return None
        return Memory(self.strip, self.speed)

    @cached_property
    def _constants(self) -> tuple[Array, Array, Array]:
        """G, lambda (0 if incompressible), and 1 if incompressible or else 0; (elements, 1)."""
        shear, lame, rigid = [], [], []
        for layer in self.strip.depths.roller.layers:
            young, nu = layer.material.relaxed_modulus, layer.material.poisson
            shear.append(0.5 * young / (1.0 + nu))
            rigid.append(float(nu == 0.5))
            lame.append(0.0 if nu == 0.5 else 2.0 * shear[-1] * nu / (1.0 - 2.0 * nu))
        pick = self.strip.layer
        constants = (np.array(values)[pick, None] for values in (shear, lame, rigid))
        return next(constants), next(constants), next(constants)

    @cached_property
    def _energies(self) -> list[tuple[Energy, Array | slice]]:
        """The different strain energies, each with the mask of the elements that have it."""
        given = [layer.material.energy or _NEO_HOOKEAN for layer in self.strip.depths.roller.layers]
        different = list(dict.fromkeys(given))
        if len(different) == 1:
            return [(different[0], slice(None))]
        which = np.array([different.index(one) for one in given])[self.strip.layer]
        return [(energy, which == place) for place, energy in enumerate(different)]

    @cached_property
    def _rest(self) -> Array:
        """The slope r of w at rest, of every element, (elements, 1)."""
        out = np.empty((self.strip.layer.size, 1))
        for energy, where in self._energies:
            out[where] = energy.rest
        return out

    def _slopes(self, volume: Array, spread: Array) -> Slopes:
        """Return the derivatives of w by I and J, each (elements, 9).

        ``volume`` is J and ``spread`` I - 2 J, see `Energy.slopes`. Raises `NoEquilibriumError`
        where an energy has no such stretch.
        """
        out = np.empty((len(Slopes._fields), *volume.shape))
        with np.errstate(all="ignore"):
            for energy, where in self._energies:
                out[:, where] = energy.slopes(volume[where], spread[where])
        if not np.all(np.isfinite(out)):
            raise NoEquilibriumError
        return Slopes(*out)

    def at_rest(self) -> MeshState:
        """Return the undeformed state."""
        return MeshState(np.zeros(self.strip.size), np.zeros((self.strip.layer.size, 3)))

    def _law(self, volume: Array) -> tuple[Array, Array]:
        """Return c and dc/dJ at J, for compressible elements (values of the others are unused)."""
        (shear, lame, _), law = self._constants, np.empty((2, *volume.shape))
        for energy, where in self._energies:
            law[:, where] = energy.volume_slopes(volume[where], lame[where])
        turned = self._rest * shear / volume
        return law[0] - turned, law[1] + turned / volume

    def _volume_terms(
        self, ratio: Array, pressure: Array, relaxing: RelaxingStress | None
    ) -> tuple[Array, ...]:
        """Return c, and the pressure step and the pressure rate of `PointFields`.

        ``ratio``, (elements, 9), is J at the Gauss points. Compressible elements have independent
        pressures, too, which a step sets to what their law says of the projected volume: with
        these, Newton's method converges as well where nu is nearly 0.5.
        """
        shear, _, rigid = self._constants
        weighted, inverse = self.strip.projection
        mean = self.strip.projected(ratio)
        pressure_step = rigid * (shear / _VOLUME_COMPLIANCE) * (mean - (1.0, 0.0, 0.0))
        pressure_rate = (rigid * shear / _VOLUME_COMPLIANCE)[..., None] * inverse
        c = pressure @ LINEAR.T - self._rest * shear
        if not rigid.all():
            projected = mean @ LINEAR.T
            if not np.all(projected > 0.0):
                raise NoEquilibriumError
            law, slope = self._law(projected)
            if relaxing is not None:
                law, slope = law + relaxing.volume_law[0], slope + relaxing.volume_law[1]
            wanted = self.strip.projected(law) - pressure
            wanted[:, :1] += self._rest * shear
            soft = inverse @ (weighted @ (slope[..., None] * LINEAR)) @ inverse
            pressure_step = np.where(rigid > 0.0, pressure_step, wanted)
            pressure_rate = np.where(rigid[..., None] > 0.0, pressure_rate, soft)
        return c, pressure_step, pressure_rate

    @cached_property
    def _is_neo_hookean(self) -> bool:
        """Return whether all layers are neo-Hookean."""
        return all(isinstance(energy, NeoHookean) for energy, _ in self._energies)

    def _fields(self, state: MeshState, deformation: Array | None = None) -> PointFields:
        """Return the fields of a state; ``deformation`` is its F, if known."""
        if deformation is None:
            deformation = self.strip.deformation(state.displacement)
        x_s, x_z, y_s, y_z = deformation
        ratio, shear = x_s * y_z - x_z * y_s, self._constants[0]
        isotropic, energy_slopes = shear, None
        slopes: tuple[Array | float, ...] = (0.5, 0.0, 0.0, 0.0, 0.0)
        if not self._is_neo_hookean:
            slopes = self._slopes(ratio, (x_s - y_z) ** 2 + (x_z + y_s) ** 2)
            energy_slopes = Slopes(*(shear * one for one in slopes))
            isotropic = 2.0 * energy_slopes.i
        relaxing = None
        if self.memory is not None:
            constants = (*self._constants[:2], self._rest)
            relaxing = RelaxingStress.of(
                self.memory, deformation, constants, self._energies, slopes
            )
        c, pressure_step, pressure_rate = self._volume_terms(ratio, state.pressure, relaxing)
        if energy_slopes is not None:
            c = c + energy_slopes.j
        return PointFields(
            deformation, c, isotropic, pressure_step, pressure_rate, energy_slopes, relaxing
        )

    def relaxing_stress(self, state: MeshState) -> RelaxingStress | None:
        """Return the relaxing stresses of a state; None where all layers are elastic."""
        return None if self.memory is None else self._fields(state).relaxing

    def _derivatives(self, fields: PointFields) -> tuple[Array, Array]:
        """Return `Tangent.volume_derivatives` and `Tangent.pressure_derivatives`."""
        x_s, x_z, y_s, y_z = fields.deformation
        of_volume = self.strip.forces_by_basis(np.stack([y_z, -y_s, -x_z, x_s]))
        return of_volume, fields.pressure_rate @ of_volume

    def _force(self, fields: PointFields, volume_derivatives: Array) -> Array:
        """Return the internal forces at the nodes, the step of the pressures included."""
        (x_s, x_z, y_s, y_z), c = fields.deformation, fields.c
        stress = fields.isotropic * fields.deformation
        stress[0] += c * y_z
        stress[1] -= c * y_s
        stress[2] -= c * x_z
        stress[3] += c * x_s
        if fields.relaxing is not None:
            stress += fields.relaxing.nominal
        force = self.strip.forces(stress)
        force += (fields.pressure_step[:, None] @ volume_derivatives)[:, 0]
        return self.strip.assembled(force)

    def _element_stiffness(
        self,
        fields: PointFields,
        derivatives: tuple[Array, Array],
        relaxing: RelaxingTangent | None,
    ) -> Array:
        """Return the derivative of the internal forces by the displacements, before assembly.

        Of every element, (elements, 18, 18). What relaxing stresses owe to other elements is left
        out.
        """
        stiff = self.strip.stiffness(fields.isotropic, fields.c)
        stiff += derivatives[0].transpose(0, 2, 1) @ derivatives[1]
        if fields.relaxing is not None and relaxing is not None:
            stiff += relaxing.own_stiffness()
            straight = fields.relaxing.geometric_stiffness
            stiff[:, :9, :9] += straight
            stiff[:, 9:, 9:] += straight
        if fields.energy_slopes is not None:
            stiff += self._stiffening(fields.deformation, fields.energy_slopes)
        return stiff

    def _stiffening(self, deformation: Array, second: Slopes) -> Array:
        """Return what the second derivatives of w add, with dI = 2 F : dF and dJ = cof F : dF."""
        x_s, x_z, y_s, y_z = deformation[..., None]
        by_s, by_z = self.strip.shape_derivatives
        along = 2.0 * np.concatenate([x_s * by_s + x_z * by_z, y_s * by_s + y_z * by_z], axis=-1)
        swell = np.concatenate([y_z * by_s - y_s * by_z, x_s * by_z - x_z * by_s], axis=-1)
        parts = (second.ii, second.ij, second.jj)
        ii, ij, jj = ((one * self.strip.volumes)[..., None] for one in parts)
        by_i, by_j = ii * along + ij * swell, ij * along + jj * swell
        return np.asarray(along.transpose(0, 2, 1) @ by_i + swell.transpose(0, 2, 1) @ by_j)

    def _tangent(
        self, fields: PointFields, load_stiffness: tuple[Indices, Array] | None
    ) -> Tangent:
        """Factorise the tangent stiffness, with the load stiffness in it if that is given."""
        derivatives = self._derivatives(fields)
        relaxing = None if fields.relaxing is None else RelaxingTangent.of(fields.relaxing)
        entries = self._element_stiffness(fields, derivatives, relaxing).ravel()
        if relaxing is not None:
            entries = np.append(entries, relaxing.stiffness_to_next())
        shape, bands = self.strip.storage, self.strip.bands
        stored = shape[0] * shape[1]
        stiffness = summed(self.strip.slots[: entries.size], entries, stored + 1)[:stored]
        if load_stiffness is not None:
            np.subtract.at(stiffness, *load_stiffness)
        factors, pivots, info = lapack.dgbtrf(stiffness.reshape(shape).T, *bands, overwrite_ab=1)
        if info != 0:
            raise NoEquilibriumError
        return Tangent(bands, factors, pivots, *derivatives, relaxing, self.strip.order)

    @cached_property
    def initial_tangent(self) -> Tangent:
        """Tangent of the undeformed state without loads, symmetric where all layers are elastic."""
        fields = self._fields(self.at_rest())
        if self.memory is not None:
            return self._tangent(fields, None)
        derivatives, band = self._derivatives(fields), self.strip.bands[0]
        entries, places = self.strip.lower_slots
        stiffness = self._element_stiffness(fields, derivatives, None).ravel()[entries]
        lower = summed(places, stiffness, (band + 1) * self.strip.size)
        matrix = lower.reshape(self.strip.size, band + 1).T
        factors, info = lapack.dpbtrf(matrix, lower=1, overwrite_ab=1)
        if info != 0:
            raise NoEquilibriumError
        return Tangent((band, 0), factors, None, *derivatives, order=self.strip.order)

    def linear_displacements(self, tractions: Tractions) -> Array:
        """Return the displacements of linear theory, (unknowns,) [mm].

        The tractions are given at undeformed arcs, per undeformed arc, along the tangent and the
        normal of the undeformed surface.
        """
        load = FollowerLoad.undeformed(self.strip, tractions)
        return self.initial_tangent.solve(load.nodal_forces, EQUILIBRIUM_TOLERANCE)

    def linear_state(self, tractions: Tractions) -> MeshState:
        """Return the displacements of linear theory, as above, with pressures and tangent."""
        displacement = self.linear_displacements(tractions)
        pressure = self.initial_tangent.pressure_changes(self.strip.local(displacement))
        return MeshState(displacement, pressure, self.initial_tangent)

    def equilibrium(
        self,
        tractions: Tractions,
        start: MeshState,
        tolerance: float = EQUILIBRIUM_TOLERANCE,
        step_tolerance: float = 0.0,
    ) -> MeshState:
        """Return the equilibrium under some tractions, by Newton's method.

        A step du against the residual force r is measured by sqrt(|du . r|) over the root of the
        work of the tractions. Steps end when the estimated error is at most ``tolerance``, or at
        most ``step_tolerance`` times the first step. A tangent is used again as long as each step
        is at most 0.3 of the one before, and for a second step if that is expected to be smaller
        than the first; the first one is that of ``start``, if it has one.

        Raises
        ------
        NoEquilibriumError
            where steps do not converge from ``start``, not even with a new tangent there.
        """
        if start.tangent is None:
            return self._newton(tractions, start, tolerance, step_tolerance)
        try:
            return self._newton(tractions, start, tolerance, step_tolerance)
        except NoEquilibriumError:
            unloaded = MeshState(start.displacement, start.pressure)
            return self._newton(tractions, unloaded, tolerance, step_tolerance)

    def _newton(
        self, tractions: Tractions, start: MeshState, tolerance: float, step_tolerance: float
    ) -> MeshState:
        """Take Newton steps from a state, the first ones with its tangent if it has one."""
        state, tangent, last_step, first = start, start.tangent, inf, 0.0
        deformation = self.strip.deformation(state.displacement)
        for _ in range(_MOST_STEPS):
            fields = self._fields(state, deformation)
            load = FollowerLoad.of(self.strip, state.displacement, tractions)
            is_new = tangent is None
            if tangent is None:
                tangent = self._tangent(fields, load.stiffness)
            residual = load.nodal_forces - self._force(fields, tangent.volume_derivatives)
            step = tangent.solve(residual, _STEP_RESIDUAL)
            local = self.strip.local(step)
            part, deformation = self._admissible_part(deformation, local)
            change = part * (fields.pressure_step + tangent.pressure_changes(local))
            moved, pressed = state.displacement + part * step, state.pressure + change
            state = MeshState(moved, pressed, tangent)
            relative_step = float(np.abs(step).max()) / float(np.abs(state.displacement).max())
            is_first = last_step == inf
            contraction = (
                _EXPECTED_CONTRACTION * relative_step if is_first else relative_step / last_step
            )
            load_work = max(
                float(load.nodal_forces @ state.displacement), float(np.finfo(float).tiny)
            )
            measure = sqrt(abs(float(residual @ step)) / load_work)
            first = max(first, measure)
            left = min(max(contraction, _STEP_RESIDUAL), 1.0)
            error = measure if is_first and not is_new else measure * left
            if part == 1.0 and error <= max(tolerance, step_tolerance * first):
                return state
            last_step = relative_step
            if part < 1.0 or not contraction <= (1.0 if is_first else _CONTRACTION):
                tangent, last_step = None, inf
        raise NoEquilibriumError

    def _admissible_part(self, deformation: Array, local: Array) -> tuple[float, Array]:
        """Return the part of a step that may be taken, and F after it.

        ``local``: displacements of the step, see `Strip.local`. It is halved until J > 0.1 at all
        Gauss points, so that no element is inverted.
        """
        change, part = self.strip.gradient(local), 1.0
        while part >= _LEAST_PART:
            moved = deformation + part * change
            x_s, x_z, y_s, y_z = moved
            if float((x_s * y_z - x_z * y_s).min()) > _LEAST_VOLUME:
                return part, moved
            part *= 0.5
        raise NoEquilibriumError
