"""Influence functions of a roller's surface, from its layers, its core and the rolling speed."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import pairwise
from math import inf, isinf

import numpy as np

from rollnip.compliance import flat_compliance, half_space_limit, ring_compliance
from rollnip.influence._weights import ComplexArray
from rollnip.influence.hats import displacement_under
from rollnip.influence.kernel import TOLERANCE, Array, Kernel, Window, half_space_kernel, tabulate
from rollnip.materials import Material
from rollnip.model import RINGS
from rollnip.rollers import Roller, shear_lags

# Ratio of the moduli of a layer and the one below it, above which tables have twice the points: the
# interpolation error, 1e-7 of the largest compliance, is larger than that by this ratio relative to
# the compliance at short waves.
_LARGE_RATIO = 100.0
_LONG_LAG = 40.0  # shear lag of a stiff skin, at least, over its thickness


@dataclass(frozen=True, slots=True)
class SurfaceKernels:
    """Displacements of one roller's surface under line tractions, in its own frame.

    u_x = xx * t_x + xz * t_z and u_z = -xz * t_x + zz * t_z (convolutions; C_zx = -C_xz).

    Attributes
    ----------
    together : xx, zz and xz as channels of one kernel, in this order.
    """

    together: Kernel

    @property
    def xx(self) -> Kernel:
        """Influence of t_x on u_x."""
        return self.together.channel(0)

    @property
    def zz(self) -> Kernel:
        """Influence of t_z on u_z."""
        return self.together.channel(1)

    @property
    def xz(self) -> Kernel:
        """Influence of t_z on u_x."""
        return self.together.channel(2)

    def displacement(self, x: Array, nodes: Array, t_z: Array, t_x: Array) -> tuple[Array, Array]:
        """Return u_x and u_z [mm] at places, under tractions at nodes[1:-1], linear in between."""
        xx, zz, xz = displacement_under(self.together, x, nodes, np.stack([t_z, t_x], axis=1))
        return xz[:, 0] + xx[:, 1], zz[:, 0] - xz[:, 1]

    def inward_at(self, x: float, nodes: Array, t_z: Array, t_x: Array) -> float:
        """Return u_z [mm] at one place, under tractions at nodes[1:-1], linear in between."""
        return float(self.displacement(np.array([x]), nodes, t_z, t_x)[1][0])


def is_ring(roller: Roller, geometry: str) -> bool:
    """Return whether the layers are rings: finite radius, rigid core, a geometry with rings."""
    curved = geometry in RINGS
    return curved and not isinf(roller.radius) and roller.core is None


def has_stiff_skin(rollers: Iterable[Roller]) -> bool:
    """Return whether a layer passes on its force over far more than its thickness as it stretches.

    So does a layer that is much stiffer than those below it, or thin and somewhat stiffer.
    """
    return any(
        lag > _LONG_LAG * layer.thickness
        for roller in rollers
        for lag, layer in zip(shear_lags(roller), roller.layers, strict=True)
    )


def _has_large_ratio(rollers: Iterable[Roller]) -> bool:
    """Return whether a layer is very much stiffer than the one below it."""
    return any(
        above.material.glassy_modulus > _LARGE_RATIO * below.material.relaxed_modulus
        for roller in rollers
        for above, below in pairwise(roller.layers)
    )


def covering_window(rollers: tuple[Roller, ...], speed: float | None) -> Window:
    """Return the window that resolves every length of the rollers: radii, thicknesses, V tau."""
    radii = [roller.radius for roller in rollers if roller.radius < inf]
    thicknesses = [layer.thickness for roller in rollers for layer in roller.layers]
    memories = [
        tau * (speed or 0.0)
        for roller in rollers
        for material in roller.materials
        for tau in material.relaxation_times
    ]
    memories = [length for length in memories if length > 0.0]
    longest = 8.0 * min(radii)
    # Below the shortest length the table is continued by its limit, linear in ln|x|; the error
    # there is of relative order (x/thickness)^2, x/radius and x/(V tau).
    shortest = min(
        [1e-6 * min(radii)] + [1e-3 * d for d in thicknesses] + [1e-5 * m for m in memories]
    )
    slowest = max([0.0, *thicknesses, *(r.coating_thickness for r in rollers), *memories])
    return Window.covering(shortest, longest, slowest, densely=_has_large_ratio(rollers))


def surface_kernels(
    roller: Roller,
    speed: float | None,
    geometry: str,
    window: Window,
    tolerance: float = TOLERANCE,
) -> SurfaceKernels:
    """Return the tabulated influence functions of a roller in steady rolling.

    Parameters
    ----------
    roller :
        one that deforms, not a bare rigid core.
    speed :
        rolling speed V [mm/s]; may be None where all materials are elastic.
    geometry :
        in "curved", "second" and "finite" the layers are rings; in the others they are flat.
    window :
        lengths and wave numbers to tabulate.
    tolerance :
        relative accuracy of the inverse transform.
    """
    core = roller.core
    low: tuple[complex, complex, complex] = (0.0, 0.0, 0.0)
    if core is not None:
        lowest = np.array([2.0 ** (window.octaves[0] - 60)])
        modulus = moduli(core, lowest, speed)
        a, b = half_space_limit(modulus, core.poisson)
        if core.is_elastic and not roller.layers:
            even, odd = np.array([a[0], a[0], 0.0]), np.array([0.0, 0.0, b[0]])
            return SurfaceKernels(half_space_kernel(window, even, odd))
        low = (complex(a[0]), complex(a[0]), 1j * complex(b[0]))
    together = tabulate(
        surface_compliance(roller, speed, geometry), window, low_limit=low, tolerance=tolerance
    )
    return SurfaceKernels(together)


def surface_compliance(
    roller: Roller, speed: float | None, geometry: str
) -> Callable[[Array], tuple[ComplexArray, ComplexArray, ComplexArray]]:
    """Return the compliances (C_xx, C_zz, C_xz) of a roller as a function of the wave number w > 0.

    In steady rolling the material sees a field e^{iwx} with the time factor s = -i w V.
    """
    thickness = np.array([layer.thickness for layer in roller.layers])
    poisson = np.array([layer.material.poisson for layer in roller.layers])

    def compliance(k: Array) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
        young = [moduli(layer.material, k, speed) for layer in roller.layers]
        modulus = np.array(young).reshape(len(young), k.size)
        if is_ring(roller, geometry):
            c = ring_compliance(k, roller.radius, thickness, modulus, poisson)
        elif roller.core is None:
            c = flat_compliance(k, thickness, modulus, poisson)
        else:
            core = moduli(roller.core, k, speed)
            c = flat_compliance(k, thickness, modulus, poisson, core, roller.core.poisson)
        return c.xx, c.zz, c.xz

    return compliance


def moduli(material: Material, k: Array, speed: float | None) -> Array | ComplexArray:
    """Return the modulus at each wave number; real where the material is elastic."""
    if material.is_elastic:
        return np.full(k.shape, material.relaxed_modulus)
    assert speed is not None  # a Nip with a viscoelastic material has a speed
    return material.modulus_at(-1j * k * speed)
