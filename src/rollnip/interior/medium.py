"""A roller in the Fourier domain: moduli at every wave number, and the layer at every depth."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from rollnip.compliance import LayerFields, flat_fields, ring_fields
from rollnip.influence import is_ring
from rollnip.interior.tractions import Array, ComplexArray
from rollnip.materials import FractionalZener, Material
from rollnip.rollers import Roller

IntArray = NDArray[np.intp]
Side = Literal["above", "below"]

_FRACTIONAL = 256.0
"""Factor by which panels end lower for a material whose modulus has a branch point, not a pole, at
w = 0.
"""
_SAME_DEPTH = 1e-12


@dataclass(frozen=True)
class Medium:
    """The deformable part of a roller in steady rolling.

    Attributes
    ----------
    roller : with layers or a half-space core.
    speed : V [mm/s]; None where all materials are elastic.
    geometry : in "curved", "second" and "finite" the layers on a rigid core are rings.
    side : "above" or "below": the layer to which a depth on an interface belongs.
    """

    roller: Roller
    speed: float | None
    geometry: str
    side: Side

    @cached_property
    def is_ring(self) -> bool:
        """Whether the layers are treated as rings."""
        return is_ring(self.roller, self.geometry)

    @property
    def curvature(self) -> float:
        """1/R of the layers [1/mm]; 0 where flat."""
        return self.roller.curvature if self.is_ring else 0.0

    @property
    def is_viscoelastic(self) -> bool:
        """Whether any material of the roller is viscoelastic."""
        return self.roller.is_viscoelastic

    @cached_property
    def memory(self) -> float:
        """Longest length over which a material recovers, V tau E_glassy/E_relaxed [mm]."""
        lengths = [0.0]
        for material in self.roller.materials:
            ratio = material.glassy_modulus / material.relaxed_modulus
            if isinstance(material, FractionalZener):
                ratio *= _FRACTIONAL
            lengths += [tau * ratio * (self.speed or 0.0) for tau in material.relaxation_times]
        return max(lengths)

    @cached_property
    def slowest(self) -> float:
        """Longest length in the compliance, other than a wavelength [mm].

        A stiff layer on a soft one bends over its thickness times the cube root of the ratio of
        moduli.
        """
        moduli = [m.relaxed_modulus for m in self.roller.materials]
        contrast = max(moduli) / min(moduli)
        return max(self.roller.coating_thickness * float(np.cbrt(contrast)), self.memory)

    def layers_of(self, z: Array) -> IntArray:
        """Return the index of the layer at each depth, (nz,); the core is the last."""
        bounds = np.array(self.roller.interfaces)
        slack = _SAME_DEPTH * bounds * (1.0 if self.side == "above" else -1.0)
        owner = np.searchsorted(bounds + slack, z, side="left" if self.side == "above" else "right")
        return np.asarray(np.minimum(owner, len(self.roller.materials) - 1))

    def poisson_of(self, layers: IntArray) -> Array:
        """Return the Poisson ratio of each layer index."""
        return np.asarray(np.array([m.poisson for m in self.roller.materials])[layers])

    def moduli(self, k: Array) -> list[Array | ComplexArray]:
        """Return Young's modulus of each material at the wave numbers ``k`` [MPa]."""
        return [_modulus(material, k, self.speed) for material in self.roller.materials]

    def fields(self, k: Array, z: Array, transforms: ComplexArray) -> LayerFields:
        """Return the fields at the depths ``z`` under the transformed tractions (2, n)."""
        roller, moduli = self.roller, self.moduli(k)
        thickness = np.array([layer.thickness for layer in roller.layers])
        poisson = np.array([layer.material.poisson for layer in roller.layers])
        modulus = np.array(moduli[: thickness.size]).reshape(thickness.size, k.size)
        t_x, t_z = transforms
        side = self.side
        if self.is_ring:
            return ring_fields(
                k, z, t_x, t_z, roller.radius, thickness, modulus, poisson, side=side
            )
        core, core_poisson = None, 0.5
        if roller.core is not None:
            core, core_poisson = moduli[-1], roller.core.poisson
        return flat_fields(
            k, z, t_x, t_z, thickness, modulus, poisson, core, core_poisson, side=side
        )

    def low_limit(self, k: float) -> complex:
        """Return 1/(2G) of a half-space core at a low wave number k [1/MPa]; 0 on a rigid core."""
        core = self.roller.core
        if core is None:
            return 0.0
        modulus = _modulus(core, np.array([k]), self.speed)
        return complex((1.0 + core.poisson) / modulus[0])


def _modulus(material: Material, k: Array, speed: float | None) -> Array | ComplexArray:
    """Return the modulus at each wave number in steady rolling, s = -i k V."""
    if material.is_elastic or speed is None:
        return np.full(k.shape, material.relaxed_modulus)
    return material.modulus_at(-1j * k * speed)
