"""Preconditioners: the compliance, inverted separately for each wave vector.

-du/dx multiplies a wave by (1 - e^(i kx hx))/hx times the 2x2 compliance. The preconditioner of
rolling divides by the magnitude of the first factor, which the length of the contact keeps away
from zero, and by that of the second. Where surfaces slip, the creep over the traction bound is
first added to that magnitude (`rollnip.patch.rolling`). What is left of the product is a number on
the half circle from -i through 1 to i. GMRES therefore takes the same number of steps on every
grid, except for what the edge of the contact adds. The loss of viscoelastic bodies moves that
number towards 1. The preconditioner of pressure divides by the magnitude of C_zz.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.fft import next_fast_len

from rollnip.patch.coefficients import Array, Grid
from rollnip.patch.kernels import waves_of
from rollnip.patch.memory import waves_at
from rollnip.rollers import Roller

Mask = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Symbols:
    """Factors by which the preconditioners multiply waves, on a grid a quarter longer.

    Attributes
    ----------
    rolling : (3, py, px//2 + 1) magnitude of -du/dx per unit shear over the wave vector: xx, xy and
        yy [1/MPa].
    normal : (py, px//2 + 1) inverse magnitude of C_zz [MPa/mm].
    """

    rolling: Array
    normal: Array


def symbols(rollers: tuple[Roller, Roller], grid: Grid, contact: Mask, speed: float) -> Symbols:
    """Return the factors of the waves.

    Parameters
    ----------
    rollers : upper and lower.
    grid : of the contact.
    contact : (ny, nx).
    speed : V [mm/s]; used for viscoelastic bodies.
    """
    length = max(int(np.max(np.sum(contact, axis=1))), 1) * grid.hx
    width = max(int(np.max(np.sum(contact, axis=0))), 1) * grid.hy
    py = int(next_fast_len(grid.ny + grid.ny // 4))
    px = grid.nx + grid.nx // 4
    while px % 2 or px != next_fast_len(px, real=True):
        px += 1
    kx, ky = np.meshgrid(
        2.0 * np.pi * np.arange(px // 2 + 1) / (px * grid.hx),
        2.0 * np.pi * np.fft.fftfreq(py) / grid.hy,
    )
    k = np.hypot(np.hypot(kx, ky), 1.0 / max(length, width))
    s, t, z = np.zeros((3, *k.shape))
    for roller in rollers:
        if roller.is_rigid:
            continue
        across, rest, inwards = _sizes(roller, k.ravel(), kx.ravel(), speed)
        s += across.reshape(k.shape)
        t += rest.reshape(k.shape)
        z += inwards.reshape(k.shape)
    matrix = np.stack([s + t * (kx / k) ** 2, t * kx * ky / k**2, s + t * (ky / k) ** 2])
    slope = np.hypot(2.0 * np.sin(0.5 * kx * grid.hx) / grid.hx, 1.0 / length)
    return Symbols(matrix * slope, 1.0 / z)


def _sizes(roller: Roller, k: Array, kx: Array, speed: float) -> tuple[Array, Array, Array]:
    """Return |S|, |P| - |S| and |Z| of wave vectors, (n,) each [mm/MPa]."""
    if not roller.is_viscoelastic:
        waves = waves_of(roller, k)
        return waves.s, waves.t, waves.z
    s, t, z, _ = waves_at(roller, k, kx, speed)
    return np.abs(s), np.abs(s + t) - np.abs(s), np.abs(z)
