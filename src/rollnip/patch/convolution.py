"""Aperiodic convolutions on a grid: displacements under tractions, by zero-padded transforms.

On a grid of twice the size nothing wraps around. A product is exact to rounding, and costs O(n log
n) in time and O(n) in memory.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft2, next_fast_len, rfft2

from rollnip.patch.coefficients import Array, Coefficients, Grid

ComplexArray = NDArray[np.complex128]
Spectrum = NDArray[np.float64] | NDArray[np.complex128]


@dataclass(frozen=True)
class Convolutions:
    """Products of influence coefficients with tractions on a grid.

    Attributes
    ----------
    grid : nx by ny rectangles.
    coefficients : influence coefficients for the distances on this grid.
    """

    grid: Grid
    coefficients: Coefficients

    @property
    def element(self) -> float:
        """Area of one rectangle [mm2]."""
        return self.grid.element

    @property
    def largest(self) -> float:
        """Largest u_z of a rectangle under a unit pressure on it [mm/MPa]."""
        return float(np.max(self.coefficients.zz))

    @cached_property
    def shape(self) -> tuple[int, int]:
        """Padded numbers of rectangles along y and x."""
        sizes = (2 * self.grid.ny + 1, 2 * self.grid.nx + 1)
        return int(next_fast_len(sizes[0])), int(next_fast_len(sizes[1], real=True))

    @cached_property
    def zz(self) -> Spectrum:
        """Transform of the coefficients zz; real where they are symmetric."""
        return self._transformed(self.coefficients.zz, 1.0)

    @cached_property
    def shear(self) -> tuple[Spectrum, Spectrum, Spectrum]:
        """Transforms of the coefficients xx, xy and yy; real where they are symmetric."""
        c = self.coefficients
        return (
            self._transformed(c.xx, 1.0),
            self._transformed(c.xy, -1.0),
            self._transformed(c.yy, 1.0),
        )

    @cached_property
    def coupling(self) -> tuple[Spectrum, Spectrum]:
        """Transforms of the coefficients xz and yz, divided by i; real where they are symmetric."""
        c = self.coefficients
        return self._transformed(c.xz, 1.0, -1j), self._transformed(c.yz, -1.0, -1j)

    @cached_property
    def couples(self) -> bool:
        """Whether pressure displaces the surfaces tangentially against each other."""
        c = self.coefficients
        return bool(np.any(c.xz) or np.any(c.yz))

    @cached_property
    def downstream(self) -> ComplexArray:
        """Factor in the transform that turns displacements into (u_i - u_(i+1))/hx, i along x."""
        size = self.shape[1]
        turn = np.exp(2j * np.pi * np.arange(size // 2 + 1) / size)
        return np.asarray((1.0 - turn) / self.grid.hx)

    def symmetric(self) -> Convolutions:
        """Return the convolutions with the symmetric part of the coefficients zz."""
        c = self.coefficients
        even = replace(c, zz=0.5 * (c.zz + c.zz[:, ::-1]), is_symmetric=True)
        return Convolutions(self.grid, even)

    def normal(self, pressure: Array) -> Array:
        """Return u_z of both surfaces together under a pressure, (ny, nx) [mm]."""
        return self.back(self.forward(pressure) * self.zz)

    def displacement(self, pressure: Array, shear: Array) -> Array:
        """Return u_x and u_y of the upper surface relative to the lower, and u_z of both together.

        Parameters
        ----------
        pressure : (ny, nx) [MPa].
        shear : (2, ny, nx) on the upper surface [MPa].

        Returns
        -------
        (3, ny, nx) [mm].
        """
        p, x, y = (self.forward(part) for part in (pressure, *shear))
        xx, xy, yy = self.shear
        xz, yz = self.coupling
        return np.stack(
            [
                self.back(np.asarray(xx * x + xy * y + 1j * xz * p)),
                self.back(np.asarray(xy * x + yy * y + 1j * yz * p)),
                self.back(np.asarray(self.zz * p - 1j * (xz * x + yz * y))),
            ]
        )

    def forward(self, values: Array) -> ComplexArray:
        """Return the transform of values on the grid, padded with zeros."""
        return np.asarray(rfft2(values, self.shape, workers=1))

    def back(self, spectrum: ComplexArray) -> Array:
        """Return the values on the grid from their transform."""
        values = irfft2(spectrum, self.shape, workers=1, overwrite_x=True)
        return np.asarray(values[: self.grid.ny, : self.grid.nx])

    def _transformed(self, half: Array, parity_y: float, factor: complex = 1.0) -> Spectrum:
        """Return the transform of coefficients, with a factor that makes symmetric ones real."""
        ny, nx = self.grid.ny, self.grid.nx
        circle = np.zeros(self.shape)
        circle[: ny + 1, : nx + 1] = half[:, nx:]
        circle[: ny + 1, -nx:] = half[:, :nx]
        circle[-ny:] = parity_y * circle[ny:0:-1]
        spectrum = np.asarray(factor * rfft2(circle, workers=1))
        return spectrum.real.copy() if self.coefficients.is_symmetric else spectrum
