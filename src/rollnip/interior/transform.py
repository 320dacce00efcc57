"""Fields in space from the transforms of the tractions and the transfer functions of the layers.

f(x, z) = (1/pi) int_0^inf Re[f^(k, z) e^{ikx}] dk. At the depth z the transform decays as e^{-kz},
so that a row of points needs wave numbers up to about 16/z only. Rows in the top layer that are too
close to the surface for that have their half-space part subtracted in the transform and added in
closed form; the remainder decays as e^{-k(2d-z)}, where d is the thickness of the top layer.
Measured against an FFT at equal error this is two to five times as fast
(docs/decisions/0004-interior.md).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rollnip.interior.medium import IntArray, Medium
from rollnip.interior.near import (
    Depth,
    WaveNumberPowers,
    half_space_displacement,
    half_space_sinking,
    half_space_stress,
    potentials,
    spectral_powers,
)
from rollnip.interior.tractions import Array, ComplexArray, SurfaceTractions
from rollnip.interior.waves import Phases, Waves

_FADED = 16.0
"""k z at which a transform has decayed to e^-16; what is left out is 1e-8 of the peak."""
_MOST_PANELS = 32
"""Largest number of panel widths P used for rows near the surface; rows that need more get the
closed form.
"""
_THINNEST = 5e-4
"""Depth over the half-width, below which rows in thin layers get no more wave numbers. For
tractions that end as a square root, 4e-3 of the peak there is left out.
"""
AnyArray = NDArray[Any]

_STRESS, _STRAIN, _RATE = slice(2, 5), slice(5, 8), slice(8, 11)


@dataclass(frozen=True, slots=True)
class Rows:
    """Depths with their layers, and the wave numbers that each of them needs.

    Attributes
    ----------
    z : (nz,) depths [mm].
    layers, poisson : (nz,) layer and Poisson ratio at each depth.
    near : (nz,) True where the half-space part is added in closed form.
    last : (nz,) largest wave number needed [1/mm].
    """

    z: Array
    layers: IntArray
    poisson: Array
    near: Array
    last: Array

    @property
    def cut(self) -> float:
        """Largest wave number of all rows, at which the half-space part takes its modulus."""
        return float(self.last.max())

    @classmethod
    def of(cls, medium: Medium, z: Array, waves: Waves, half_width: float) -> Rows:
        """Return the rows, divided into near and far ones, under tractions of a half-width [mm]."""
        layers = medium.layers_of(z)
        most = _MOST_PANELS * waves.width
        near = (layers == 0) & (z * most < _FADED)
        top = medium.roller.layers[0].thickness if medium.roller.layers else np.inf
        # Layer and half-space differ by what the bottom of the top layer reflects.
        echo = np.maximum(most, _FADED / np.maximum(2.0 * top - z, top))
        direct = _FADED / np.maximum(z, _FADED / (most + _FADED / top))
        last = np.minimum(np.where(near, echo, direct), _FADED / (_THINNEST * half_width))
        return cls(z, layers, medium.poisson_of(layers), near, last)


@dataclass(frozen=True, slots=True)
class Transformed:
    """Fields in space.

    Attributes
    ----------
    values : (5 or 11, nz, nx): u_x, u_z, s_xx, s_zz, s_xz and, for a viscoelastic roller, the
        strains e_xx, e_zz, e_xz and their derivatives along x.
    loss : (nz,) -int s_ij d(e_ij)/dx dx over all x [MPa]; zero where elastic.
    """

    values: Array
    loss: Array


def fields_in_space(medium: Medium, tractions: SurfaceTractions, z: Array, x: Array) -> Transformed:
    """Return the fields at depths ``z`` and places ``x`` [mm]."""
    places = x - tractions.centre
    reach = float(np.max(np.abs(places))) + tractions.half_width
    deepest = float(np.max(Depth.of(z, medium.curvature).logarithmic))
    waves = Waves.resolving(reach, max(medium.slowest, deepest))
    rows = Rows.of(medium, z, waves, tractions.half_width)
    parts = 11 if medium.is_viscoelastic else 5
    values = np.zeros((parts, z.size, x.size))
    loss = np.zeros(z.size)
    half_space = HalfSpacePart(medium, rows.cut)
    sources, targets = Phases(tractions.places), Phases(places)
    for block in waves.blocks(float(rows.last.max())):
        active = np.flatnonzero(rows.last > block.start)
        if not active.size:  # all rows lie so deep that the first block holds all they feel
            break
        transforms = tractions.transform(block.k, sources.sums(block, tractions.kinks))
        spectrum = _spectrum(medium, rows, active, block.k, transforms)
        if medium.is_viscoelastic:
            loss[active] += _loss(spectrum, block.weights)
        _take_out(half_space, spectrum, rows, active, (block.k, transforms))
        spectrum *= block.weights
        values[:, _span(active)] += _product(spectrum, targets.on(block))
    sinking = _constants(half_space, medium, rows, tractions.resultants, 1e-9 * waves.lowest)
    values[:2] += waves.logarithm() * sinking
    for row in np.flatnonzero(rows.near):
        depth = Depth.of(z[[row]], medium.curvature)
        powers = potentials(tractions, depth, places, two=medium.is_viscoelastic)
        values[:, [row]] += half_space.fields(powers, depth).real
    return Transformed(values, loss)


def _span(rows: IntArray) -> IntArray | slice:
    """Return increasing rows as a slice where none is left out: numpy adds to slices in place."""
    is_whole = rows.size > 0 and rows[-1] - rows[0] == rows.size - 1
    return slice(int(rows[0]), int(rows[-1]) + 1) if is_whole else rows


def _spectrum(
    medium: Medium, rows: Rows, active: IntArray, k: Array, transforms: ComplexArray
) -> ComplexArray:
    """Return the transforms of all quantities, (parts, rows, k)."""
    fields = medium.fields(k, rows.z[active], transforms)
    if not medium.is_viscoelastic:
        return np.stack(fields)
    out = np.empty((11, active.size, k.size), dtype=complex)
    out[:5] = fields
    moduli = np.array(medium.moduli(k))[rows.layers[active]]
    out[_STRAIN] = strain_of(out[_STRESS], rows.poisson[active], moduli)
    np.multiply(out[_STRAIN], 1j * k, out=out[_RATE])
    return out


def strain_of(stress: AnyArray, poisson: Array, modulus: AnyArray) -> AnyArray:
    """Return e_xx, e_zz, e_xz of plane strain from stresses; poisson (nz,), modulus (nz, n)."""
    nu = poisson[:, None]
    s_xx, s_zz, s_xz = stress
    law = np.stack([(1.0 - nu) * s_xx - nu * s_zz, (1.0 - nu) * s_zz - nu * s_xx, s_xz])
    return np.asarray(law * ((1.0 + nu) / modulus))


def _loss(spectrum: ComplexArray, weights: Array) -> Array:
    """Return -int s_ij d(e_ij)/dx dx by Parseval's theorem, -(1/pi) int_0 Re[s conj(ik e)] dk."""
    shear = np.array([1.0, 1.0, 2.0])
    stress, rate = spectrum[_STRESS], spectrum[_RATE]
    work = np.einsum("c,czk,czk->zk", shear, stress.real, rate.real)
    work += np.einsum("c,czk,czk->zk", shear, stress.imag, rate.imag)
    return np.asarray(-work @ weights)


def _product(spectrum: ComplexArray, phases: ComplexArray) -> Array:
    """Return Re[spectrum e^{ikx}] summed over k, as one real product.

    ``phases`` are e^{-ikx}, (x, k).
    """
    parts, rows, size = spectrum.shape
    left = np.ascontiguousarray(spectrum).reshape(parts * rows, size).view(float)
    return np.asarray(left @ phases.view(float).T).reshape(parts, rows, -1)


class HalfSpacePart:
    """The half-space part of the fields, with the modulus of the top layer at one wave number.

    Attributes
    ----------
    compliance : 1/(2G) at that wave number [1/MPa].
    """

    def __init__(self, medium: Medium, cut: float) -> None:
        self.material = medium.roller.materials[0]
        self.viscoelastic = medium.is_viscoelastic
        self.modulus = np.asarray(medium.moduli(np.array([cut]))[0], dtype=complex)
        self.compliance = complex((1.0 + self.material.poisson) / self.modulus[0])
        self.curvature = medium.curvature

    def fields(self, powers: WaveNumberPowers, depth: Depth) -> ComplexArray:
        """Return all quantities, (parts, nz, n), in the Fourier domain without the decay."""
        nu = self.material.poisson
        stress = half_space_stress(powers, depth)
        parts = [half_space_displacement(powers, depth, self.compliance, nu), stress]
        if self.viscoelastic:
            for some in (stress, half_space_stress(powers.raised(), depth)):
                parts.append(strain_of(some, np.array([nu]), self.modulus[:, None]))
        return np.concatenate(parts)


def _take_out(
    half_space: HalfSpacePart,
    spectrum: ComplexArray,
    rows: Rows,
    active: IntArray,
    surface: tuple[Array, ComplexArray],
) -> None:
    """Subtract from the near rows the part that is added to them in closed form."""
    k, transforms = surface
    inside = np.flatnonzero(rows.near[active])
    if inside.size == 0:
        return
    depth = Depth.of(rows.z[active[inside]], half_space.curvature)
    part = half_space.fields(spectral_powers(transforms, k), depth)
    spectrum[:, inside] -= part * depth.decay(k)


def _constants(
    half_space: HalfSpacePart, medium: Medium, rows: Rows, loads: Array, k: float
) -> Array:
    """Return the factors of 1/k in the displacements as k -> 0, (2, nz, 1).

    They are those of the core, less those of the half-space part that was subtracted.
    """
    core = medium.roller.materials[-1].poisson
    kept = half_space_sinking(loads, medium.low_limit(k), core)
    taken = half_space_sinking(loads, half_space.compliance, half_space.material.poisson)
    return np.asarray(kept[:, None] - np.outer(taken, rows.near))[:, :, None]
