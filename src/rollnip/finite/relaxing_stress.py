"""Relaxing stresses of viscoelastic layers in a state of a mesh, and their derivative.

The law is that of `rollnip.finite.memory`. "The relaxing part" of a stress f is g * df/dt.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rollnip.finite.memory import Memory
from rollnip.finite.strip import LINEAR, Array
from rollnip.materials import Energy


@dataclass(frozen=True)
class RelaxingStress:
    """Relaxing stresses in a state of a mesh.

    Attributes
    ----------
    memory : the history integrals of the mesh.
    deformation : (4, elements, 9) F, see `Strip.deformation`.
    shear : (elements, 1) G.
    rest : (elements, 1) r.
    slopes : w_I, w_J, w_II, w_IJ and w_JJ; each (elements, 9) or a number.
    volume : (4, elements, 9) lambda, and m, m' and m'' at the projected J; None where no
        viscoelastic layer is compressible.
    """

    memory: Memory
    deformation: Array
    shear: Array
    rest: Array
    slopes: tuple[Array | float, ...]
    volume: Array | None

    @classmethod
    def of(
        cls,
        memory: Memory,
        deformation: Array,
        constants: tuple[Array, Array, Array],
        energies: Sequence[tuple[Energy, Array | slice]],
        slopes: tuple[Array | float, ...],
    ) -> RelaxingStress:
        """Return the relaxing stresses at some deformation, (4, elements, 9).

        ``constants`` are G, lambda and r of every element, each (elements, 1); ``energies`` come
        with the masks of their elements.
        """
        shear, lame, rest = constants
        volume = None
        if memory.is_compressible:
            x_s, x_z, y_s, y_z = deformation
            mean = memory.strip.projected(x_s * y_z - x_z * y_s) @ LINEAR.T
            volume = np.empty((4, *mean.shape))
            volume[0] = lame
            for energy, where in energies:
                volume[1:, where] = energy.volume_measure(mean[where])
        return cls(memory, deformation, shear, rest, slopes, volume)

    @cached_property
    def _ratio(self) -> Array:
        x_s, x_z, y_s, y_z = self.deformation
        return np.asarray(x_s * y_z - x_z * y_s)

    @cached_property
    def _cauchy_green(self) -> tuple[Array, Array, Array]:
        """C_ss, C_zz and C_sz; s along the arc, z into the roller."""
        x_s, x_z, y_s, y_z = self.deformation
        return x_s**2 + y_s**2, x_z**2 + y_z**2, x_s * x_z + y_s * y_z

    @property
    def _adjugate_factor(self) -> Array:
        """Factor of the adjugate of C in T, G (w_J - r/J)/J."""
        return np.asarray(self.shear * (self.slopes[1] - self.rest / self._ratio) / self._ratio)

    @cached_property
    def stress(self) -> Array:
        """Relaxing parts of T_ss, T_zz, T_sz; of lambda m with ``volume``; (elements, 9, parts)."""
        along, across, mixed = self._cauchy_green
        straight, turned = 2.0 * self.shear * self.slopes[0], self._adjugate_factor
        parts = [straight + turned * across, straight + turned * along, -turned * mixed]
        if self.volume is not None:
            parts.append(self.volume[0] * self.volume[1])
        return self.memory.history_integral(np.stack(parts, axis=-1))

    @cached_property
    def _volume_derivative(self) -> Array:
        """Derivative of J by the displacements of an element, (elements, 9, 2, 9)."""
        x_s, x_z, y_s, y_z = self.deformation[..., None]
        by_s, by_z = self.memory.strip.shape_derivatives
        return np.stack([y_z * by_s - y_s * by_z, x_s * by_z - x_z * by_s], axis=-2)

    def _projected_volume_derivative(self) -> Array:
        """Derivative of the projected J, (elements, 9, 18)."""
        weighted, inverse = self.memory.strip.projection
        swell = self._volume_derivative.reshape(*self._ratio.shape, 18)
        return np.asarray(LINEAR @ (inverse @ (weighted @ swell)))

    @cached_property
    def strain_derivative(self) -> Array:
        """Derivatives of the conjugate strains by the displacements, (elements, 9, parts, 18).

        Those of Green's strains E_ss and E_zz, of 2 E_sz and, with ``volume``, of m.
        """
        x_s, x_z, y_s, y_z = self.deformation[..., None]
        by_s, by_z = self.memory.strip.shape_derivatives
        parts = 3 if self.volume is None else 4
        out = np.empty((*self._ratio.shape, parts, 2, 9))
        for i, (f_s, f_z) in enumerate(((x_s, x_z), (y_s, y_z))):
            out[:, :, 0, i], out[:, :, 1, i] = f_s * by_s, f_z * by_z
            out[:, :, 2, i] = f_s * by_z + f_z * by_s
        out = out.reshape(*self._ratio.shape, parts, 18)
        if self.volume is not None:
            out[:, :, 3] = self.volume[2][..., None] * self._projected_volume_derivative()
        return out

    @property
    def stress_derivative(self) -> Array:
        """Derivatives of T_ss, T_zz, T_sz and lambda m likewise, (elements, 9, parts, 18)."""
        by, ratio = self.strain_derivative, self._ratio[..., None]
        swell = self._volume_derivative.reshape(*self._ratio.shape, 18)
        grown = 2.0 * (by[:, :, 0] + by[:, :, 1])
        _, _, ii, ij, jj = (_last(one) for one in self.slopes)
        shear, rest = self.shear[..., None], self.rest[..., None]
        turned = self._adjugate_factor[..., None]
        straight = 2.0 * shear * (ii * grown + ij * swell)
        bent = shear * (ij * grown + (jj + rest / ratio**2) * swell) / ratio
        bent -= turned * swell / ratio
        along, across, mixed = (one[..., None] for one in self._cauchy_green)
        out = np.empty(by.shape)
        out[:, :, 0] = straight + bent * across + 2.0 * turned * by[:, :, 1]
        out[:, :, 1] = straight + bent * along + 2.0 * turned * by[:, :, 0]
        out[:, :, 2] = -bent * mixed - turned * by[:, :, 2]
        if self.volume is not None:
            out[:, :, 3] = self.volume[0][..., None] * by[:, :, 3]
        return out

    @cached_property
    def volume_law(self) -> tuple[Array | float, Array | float]:
        """Terms that the relaxing part of lambda m adds to U' and U'' at the Gauss points."""
        if self.volume is None:
            return 0.0, 0.0
        lame, _, slope, bend = self.volume
        held = self.stress[..., 3]
        return held * slope, self.memory.own_weights * lame * slope**2 + held * bend

    @property
    def nominal(self) -> Array:
        """Nominal stress of the relaxing part of T, F T, (4, elements, 9)."""
        along, across, mixed = np.ascontiguousarray(np.moveaxis(self.stress[..., :3], -1, 0))
        out = np.empty(self.deformation.shape)
        for i in (0, 2):
            f_s, f_z = self.deformation[i : i + 2]
            out[i], out[i + 1] = f_s * along + f_z * mixed, f_s * mixed + f_z * across
        return out

    @property
    def geometric_stiffness(self) -> Array:
        """Geometric stiffness of the relaxing part of T, alike for x and y, (elements, 9, 9)."""
        by_s, by_z = self.memory.strip.shape_derivatives
        held = (self.stress * self.memory.strip.volumes[..., None])[:, :, None]
        pulled = held[..., 0] * by_s + held[..., 2] * by_z
        pushed = held[..., 1] * by_z + held[..., 2] * by_s
        return np.asarray(by_s.transpose(0, 2, 1) @ pulled + by_z.transpose(0, 2, 1) @ pushed)


def _last(value: Array | float) -> Array | float:
    return value[..., None] if isinstance(value, np.ndarray) else value


@dataclass(frozen=True)
class RelaxingTangent:
    """Derivative of the nodal forces of relaxing stresses by the displacements.

    The relaxing stress at a Gauss point depends on the displacements of its whole row. The
    contribution of its own element (`own_stiffness`) is part of the element's stiffness; that of
    the next one (`stiffness_to_next`) is stored in the banded matrix, too; the rest is applied
    without being stored (`far_forces`).

    Attributes
    ----------
    memory : the history integrals of the mesh.
    strain_derivative, stress_derivative : (elements, 9 parts, 18) those of `RelaxingStress`; the
        former times the volumes of the points.
    volume_slope : (elements, 9) m' at the projected J; None where no viscoelastic layer is
        compressible.
    """

    memory: Memory
    strain_derivative: Array
    stress_derivative: Array
    volume_slope: Array | None

    @classmethod
    def of(cls, stress: RelaxingStress) -> RelaxingTangent:
        """Return the derivative in a state."""
        by = stress.strain_derivative * stress.memory.strip.volumes[..., None, None]
        flat = (by.shape[0], -1, 18)
        slope = None if stress.volume is None else stress.volume[2]
        return cls(stress.memory, by.reshape(flat), stress.stress_derivative.reshape(flat), slope)

    def own_stiffness(self) -> Array:
        """Return the stiffness by the Gauss points of the same element, (elements, 18, 18)."""
        count, own = self.strain_derivative.shape[0], self.memory.own_weights
        held = self.memory.near_weights[0] @ self.stress_derivative.reshape(count, 3, -1)
        by_part, rate = (
            one.reshape(count, 9, -1, 18)[:, :, :3] for one in (held, self.stress_derivative)
        )
        by_part += own[..., None, None] * rate  # of lambda m it is in the law of the volume
        return np.asarray(self.strain_derivative.transpose(0, 2, 1) @ held.reshape(count, -1, 18))

    def stiffness_to_next(self) -> Array:
        """Return the stiffness by the Gauss points of the next element in the row.

        Of each element that has one, (elements, 18, 18): its forces by displacements of the next.
        """
        rate = self.stress_derivative[self.memory.strip.depths.row_layers.size :]
        count = rate.shape[0]
        held = self.memory.near_weights[1][:count] @ rate.reshape(count, 3, -1)
        by = self.strain_derivative[:count].transpose(0, 2, 1)
        return np.asarray(by @ held.reshape(rate.shape))

    def _changes_by_others(self, local: Array) -> Array:
        """Return the changes of relaxing stresses that come from other Gauss points."""
        change = (self.stress_derivative @ local[..., None]).reshape(local.shape[0], 9, -1)
        return self.memory.history_integral(change) - self.memory.own_weights[..., None] * change

    def far_forces(self, displacement: Array) -> Array:
        """Return the changes of forces (unknowns,) that come from beyond the next element."""
        strip = self.memory.strip
        local = strip.local(displacement)
        change = (self.stress_derivative @ local[..., None]).reshape(local.shape[0], 9, -1)
        far = self.memory.far_integral(change).reshape(local.shape[0], 1, -1)
        return strip.assembled(far @ self.strain_derivative)

    def pressure_changes(self, local: Array) -> Array | float:
        """Return the changes of pressures (elements, 3) that come from other Gauss points."""
        if self.volume_slope is None:
            return 0.0
        held = self._changes_by_others(local)[..., 3] * self.volume_slope
        return self.memory.strip.projected(held)
