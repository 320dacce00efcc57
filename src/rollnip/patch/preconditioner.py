"""The preconditioner of rolling: the compliance to shear, inverted wave vector by wave vector.

-du/dx multiplies a wave by (1 - e^(i kx hx))/hx times the 2x2 compliance. The preconditioner
divides by the size of the first, kept from zero by the length of the contact, and by the second.
What is left of the product is a number on the half circle from -i through 1 to i: GMRES takes the
same number of steps on every grid, but for what the edge of the contact adds.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.fft import next_fast_len

from rollnip.patch.coefficients import Array, Grid
from rollnip.patch.kernels import waves_of
from rollnip.rollers import Roller

Mask = NDArray[np.bool_]


def symbols(rollers: tuple[Roller, Roller], grid: Grid, contact: Mask) -> Array:
    """Return the factors of the waves on a grid a quarter longer, (3, py, px//2 + 1).

    Parameters
    ----------
    rollers : upper and lower, elastic.
    grid : of the contact.
    contact : (ny, nx).
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
    s, t = np.zeros_like(k), np.zeros_like(k)
    for roller in rollers:
        if not roller.is_rigid:
            waves = waves_of(roller, k.ravel())
            s += waves.s.reshape(k.shape)
            t += waves.t.reshape(k.shape)
    xx, xy, yy = s + t * (kx / k) ** 2, t * kx * ky / k**2, s + t * (ky / k) ** 2
    size = (xx * yy - xy * xy) * np.hypot(2.0 * np.sin(0.5 * kx * grid.hx) / grid.hx, 1.0 / length)
    return np.stack([yy / size, -xy / size, xx / size])
