"""Free convolutions on a grid: displacements under tractions, by transforms padded with zeros.

On twice the grid nothing wraps around: a product is exact to rounding, O(n log n) in time and O(n)
in memory.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft2, next_fast_len, rfft2

from rollnip.patch.coefficients import Array, Coefficients, Grid

ComplexArray = NDArray[np.complex128]


@dataclass(frozen=True)
class Convolutions:
    """Products of influence coefficients with tractions on a grid.

    Attributes
    ----------
    grid : nx by ny rectangles.
    coefficients : for the distances on this grid.
    """

    grid: Grid
    coefficients: Coefficients

    @cached_property
    def shape(self) -> tuple[int, int]:
        """Padded numbers of rectangles along y and x."""
        sizes = (2 * self.grid.ny + 1, 2 * self.grid.nx + 1)
        return int(next_fast_len(sizes[0])), int(next_fast_len(sizes[1], real=True))

    @cached_property
    def zz(self) -> Array:
        """Transform of the coefficients zz: real, for they are even."""
        return self._transformed(self.coefficients.zz, 1.0, 1.0).real.copy()

    @cached_property
    def shear(self) -> tuple[Array, Array, Array]:
        """Transforms of the coefficients xx, xy and yy: real."""
        c = self.coefficients
        return (
            self._transformed(c.xx, 1.0, 1.0).real.copy(),
            self._transformed(c.xy, -1.0, -1.0).real.copy(),
            self._transformed(c.yy, 1.0, 1.0).real.copy(),
        )

    @cached_property
    def coupling(self) -> tuple[Array, Array]:
        """Transforms of the coefficients xz and yz: imaginary parts, the real ones are 0."""
        c = self.coefficients
        return (
            self._transformed(c.xz, -1.0, 1.0).imag.copy(),
            self._transformed(c.yz, 1.0, -1.0).imag.copy(),
        )

    @cached_property
    def downstream(self) -> ComplexArray:
        """Factor that turns displacements into (u_i - u_(i+1))/hx, i counted along x."""
        size = self.shape[1]
        turn = np.exp(2j * np.pi * np.arange(size // 2 + 1) / size)
        return np.asarray((1.0 - turn) / self.grid.hx)

    def normal(self, pressure: Array) -> Array:
        """Return u_z of both surfaces together under a pressure, (ny, nx) [mm]."""
        return self.back(self.forward(pressure) * self.zz)

    def forward(self, values: Array) -> ComplexArray:
        """Return the transform of values on the grid, padded with zeros."""
        return np.asarray(rfft2(values, self.shape, workers=1))

    def back(self, spectrum: ComplexArray) -> Array:
        """Return the values on the grid of a transform."""
        values = irfft2(spectrum, self.shape, workers=1, overwrite_x=True)
        return np.asarray(values[: self.grid.ny, : self.grid.nx])

    def _transformed(self, quadrant: Array, parity_x: float, parity_y: float) -> ComplexArray:
        ny, nx = self.grid.ny, self.grid.nx
        circle = np.zeros(self.shape)
        circle[: ny + 1, : nx + 1] = quadrant
        circle[: ny + 1, -nx:] = parity_x * quadrant[:, :0:-1]
        circle[-ny:, : nx + 1] = parity_y * quadrant[:0:-1]
        circle[-ny:, -nx:] = parity_x * parity_y * quadrant[:0:-1, :0:-1]
        return np.asarray(rfft2(circle, workers=1))
