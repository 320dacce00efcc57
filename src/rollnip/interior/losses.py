"""The heat generated in a viscoelastic covering, from the loss part of its compliance."""

from __future__ import annotations

from functools import lru_cache
from math import ceil, log2

import numpy as np
from numpy.typing import NDArray

from rollnip.influence import surface_compliance
from rollnip.interior.medium import Medium
from rollnip.interior.tractions import SurfaceTractions
from rollnip.interior.waves import Block, Phases, Waves
from rollnip.rollers import Roller

Array = NDArray[np.float64]

_SHORTEST = 1e3
"""Largest wave number times half the nip width.

The integrand is k Im C |t|^2 with t ~ k^-3/2, as for tractions that end as a square root. What is
left out is 1e-3 of the loss where a memory is shorter than that wavelength, and 1e-9 where it is as
long as the contact.
"""
_SIZES_PER_OCTAVE = 4
"""Number of half-widths in an octave for which wave numbers are kept."""
_FADED = 16.0
"""Largest depth times wave number that counts: the work decays as e^(-2 k z), to 1e-14 there."""


def loss_per_distance(
    roller: Roller, tractions: SurfaceTractions, geometry: str, speed: float | None
) -> float:
    """Return the heat that steady rolling generates in a roller, per distance and axial length.

    The work of the tractions on the moving surface is -int t . du = (1/pi) int_0^inf k t^H L t dk
    with L = (C - C^H)/(2 i), the loss part of the compliance C(k); elastic parts do not contribute.
    L is positive semi-definite for every passive material, and the weights of the quadrature are
    positive. The sum is therefore never negative, whatever the mesh, and exactly 0 for an elastic
    roller.

    Parameters
    ----------
    roller :
        any; a bare rigid core loses nothing.
    tractions :
        on its surface, in its own frame.
    geometry :
        in "curved", "second" and "finite" the layers on a rigid core are rings; in the others they
        are flat.
    speed :
        V [mm/s]; needed where a material is viscoelastic.

    Returns
    -------
    Loss [N/mm]; multiplied by the speed of the roller [mm/s] it is the power in mW per mm of the
    face.

    References
    ----------
    Christensen (1971), Theory of Viscoelasticity, section 1.6 (energy lost in a cycle); by
    Parseval's theorem steady rolling is a sum of cycles.
    """
    if not roller.is_viscoelastic:
        return 0.0
    blocks, k, xx, zz, xz = _loss_parts(roller, speed, geometry, _shared_size(tractions))
    phases, kinks = Phases(tractions.places), tractions.kinks
    # In the first block, moments take the place of these sums (see `SMALL_PHASE`).
    sums = [np.zeros((2, blocks[0].k.size)), *(phases.sums(block, kinks) for block in blocks[1:])]
    t_x, t_z = tractions.transform(k, np.concatenate(sums, axis=1))
    turning = t_x.real * t_z.imag - t_x.imag * t_z.real  # Im(conj(t_x) t_z)
    return float(xx @ _square(t_x) + zz @ _square(t_z) + xz @ turning)


@lru_cache(maxsize=8)
def _loss_parts(
    roller: Roller, speed: float | None, geometry: str, half_width: float
) -> tuple[list[Block], Array, Array, Array, Array]:
    """Return all waves, and the weights of |t_x|^2, |t_z|^2 and Im(conj(t_x) t_z) at each."""
    waves = Waves.resolving(2.0 * half_width, Medium(roller, speed, geometry, side="above").slowest)
    blocks = waves.blocks(_SHORTEST / half_width)
    k = np.concatenate([block.k for block in blocks])
    weight = k * np.concatenate([block.weights for block in blocks])
    xx, zz, xz = surface_compliance(roller, speed, geometry)(k)
    return blocks, k, weight * xx.imag, weight * zz.imag, weight * (2.0 * xz.real)


def loss_below(
    roller: Roller,
    tractions: SurfaceTractions,
    z: Array,
    geometry: str,
    speed: float | None,
) -> Array:
    """Return the heat that rolling generates below given depths, per distance and axial length.

    What lies below the depth z receives the work of the stresses on its upper face. As on the
    surface, w(z) = (1 - z/R) (1/pi) int_0^inf k Im(conj(t) . u) dk, where t = (-s_xz, -s_zz) and u
    are the transforms at that depth (flat layers: without the factor 1 - z/R). So w(0) is
    `loss_per_distance`, and w(z1) - w(z2) is generated between the depths z1 and z2.

    Parameters
    ----------
    roller :
        with a coating or a half-space core.
    tractions :
        on its surface, in its own frame.
    z :
        (nz,) depths [mm], from 0 to the bottom of the coating; on a half-space core, any depth.
    geometry, speed :
        as for `loss_per_distance`.

    Returns
    -------
    (nz,) losses [N/mm], 0 for an elastic roller.
    """
    below = np.zeros(z.size)
    if not roller.is_viscoelastic:
        return below
    half_width = _shared_size(tractions)
    medium = Medium(roller, speed, geometry, side="above")
    slowest = max(medium.slowest, float(z.max(initial=0.0)))
    waves = Waves.resolving(2.0 * half_width, slowest)
    phases = Phases(tractions.places)
    for block in waves.blocks(_SHORTEST / half_width):
        k = block.k
        active = np.flatnonzero(z * block.start < _FADED)
        if active.size == 0:
            continue
        t = tractions.transform(k, phases.sums(block, tractions.kinks))
        at = medium.fields(k, z[active], t)
        work = np.conj(at.s_xz) * at.u_x + np.conj(at.s_zz) * at.u_z
        below[active] -= work.imag @ (block.weights * k)
    return np.asarray(below * (1.0 - medium.curvature * z))


def _shared_size(tractions: SurfaceTractions) -> float:
    """Return a half-width just above that of the tractions, the same for all meshes of a nip.

    Meshes of one nip differ little in width, so that they share their wave numbers.
    """
    octaves = ceil(_SIZES_PER_OCTAVE * log2(tractions.half_width)) / _SIZES_PER_OCTAVE
    return float(2.0**octaves)


def _square(values: NDArray[np.complex128]) -> Array:
    return np.asarray(values.real**2 + values.imag**2)
