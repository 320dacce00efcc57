"""Stresses under a patch: transformed tractions, carried to depth for each wave vector.

Along the wave vector and the depth the layers are in plane strain; across it they are in pure
shear. With c and s the cosine and sine of the wave vector's angle, n along it and t across:

    s_xx = c^2 s_nn + s^2 s_tt - 2 c s s_nt     s_xy = c s (s_nn - s_tt) + (c^2 - s^2) s_nt
    s_yy = s^2 s_nn + c^2 s_tt + 2 c s s_nt     s_xz = c s_nz - s s_tz,  s_yz = s s_nz + c s_tz

and s_tt = nu (s_nn + s_zz).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import inf
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft2, next_fast_len, rfft2

from rollnip._errors import InvalidInputError, require_positive
from rollnip._sealed import Sealed
from rollnip.compliance import flat_fields, shear_fields
from rollnip.patch.coefficients import Array, Grid
from rollnip.patch.memory import roller_stack
from rollnip.patches import Patch
from rollnip.rollers import Roller, Side

ComplexArray = NDArray[np.complex128]


class PatchResult(Protocol):
    """The attributes of a solved patch from which depths are chosen."""

    @property
    def patch(self) -> Patch:
        """The problem."""

    @property
    def grid(self) -> Grid:
        """Grid of rectangles over the patch."""

    @property
    def length(self) -> float:
        """Length of the patch [mm]."""

    @property
    def width(self) -> float:
        """Width of the patch [mm]."""


STRESSES = ("s_xx", "s_yy", "s_zz", "s_xy", "s_xz", "s_yz", "von_mises", "max_shear")
"""The stresses under a patch: keys of `rollnip.figures.FIELDS`."""

_ROOM = 4
"""Sides of the periodic window over those of the grid: images of the patch are at least three grids
away.
"""
_SHARES = (0.1, 0.25, 0.5, 0.75, 1.0, 1.5)
"""Usual depths, over half the smaller side of the patch."""
_CELL = 16
"""Number of wave vectors along each side of the cell around 0."""
_TABLE = 1500
"""Number of wave numbers at which elastic layers are computed."""
_AT_ONCE = 100_000
"""Number of wave vectors at which viscoelastic layers are computed at once."""


@dataclass(frozen=True, eq=False, repr=False)
class PatchStress(Sealed):
    """Stresses in one roller under a patch, in its own frame: z into the body, tension positive.

    Attributes
    ----------
    z, y, x : (nz,), (ny,), (nx,) places [mm].
    s_xx, s_yy, s_zz, s_xy, s_xz, s_yz : (nz, ny, nx) [MPa].
    """

    z: Array
    y: Array
    x: Array
    s_xx: Array
    s_yy: Array
    s_zz: Array
    s_xy: Array
    s_xz: Array
    s_yz: Array

    @cached_property
    def von_mises(self) -> Array:
        """Von Mises stress, (nz, ny, nx) [MPa]."""
        normal = (
            (self.s_xx - self.s_yy) ** 2
            + (self.s_yy - self.s_zz) ** 2
            + (self.s_zz - self.s_xx) ** 2
        )
        shear = self.s_xy**2 + self.s_xz**2 + self.s_yz**2
        return np.asarray(np.sqrt(0.5 * normal + 3.0 * shear))

    @cached_property
    def principal(self) -> Array:
        """Principal stresses, largest tension first, (3, nz, ny, nx) [MPa]."""
        rows = [
            [self.s_xx, self.s_xy, self.s_xz],
            [self.s_xy, self.s_yy, self.s_yz],
            [self.s_xz, self.s_yz, self.s_zz],
        ]
        tensor = np.moveaxis(np.array(rows), (0, 1), (-2, -1))
        return np.moveaxis(np.linalg.eigvalsh(tensor)[..., ::-1], -1, 0)

    @cached_property
    def max_shear(self) -> Array:
        """Largest shear stress, (nz, ny, nx) [MPa]."""
        return np.asarray(0.5 * (self.principal[0] - self.principal[2]))


def usual_depths(solution: PatchResult, side: Side) -> list[float]:
    """Return depths of interest [mm]: some within the size of the patch, and the interfaces."""
    roller = solution.patch.upper if side == "upper" else solution.patch.lower
    half, grid = 0.5 * min(solution.length, solution.width), solution.grid
    bottom = roller.coating_thickness if roller.core is None else inf
    depths = [share * half for share in _SHARES] + list(roller.interfaces)
    least = 0.5 * max(grid.hx, grid.hy)
    return sorted({z for z in depths if least <= z <= bottom})


def stress_at_depth(
    roller: Roller, grid: Grid, tractions: Array, depths: Sequence[float], speed: float
) -> PatchStress:
    """Return the stresses in a roller at the middles of the rectangles of a grid, at given depths.

    Parameters
    ----------
    roller : with layers or a half-space core.
    grid : of the tractions.
    tractions : (3, ny, nx) along x, along y and inwards [MPa], as they act on this roller.
    depths : [mm], at least half the longer side of a rectangle.
    speed : V [mm/s]; used for viscoelastic rollers.

    Raises
    ------
    InvalidInputError
        for a rigid roller, and for a depth too small for the grid or outside the layers.
    """
    if roller.is_rigid:
        raise InvalidInputError("`side` must be a roller that deforms, got a bare rigid one.")
    least = 0.5 * max(grid.hx, grid.hy)
    for z in map(float, depths):
        require_positive("z", z)
        if not z >= least:
            raise InvalidInputError(
                f"`z` must be at least half a rectangle of the grid, {least:.3g} mm, got {z:g} mm; "
                "solve on a finer grid to come closer to the surface."
            )
    window = _TransformedTractions(grid, tractions)
    parts = np.stack([window.stresses(roller, float(z), speed) for z in depths], axis=1)
    return PatchStress(np.array(depths, dtype=float), grid.y, grid.x, *parts)


@dataclass(frozen=True)
class _WaveVectors:
    """Wave vectors and the tractions of each, as arrays whose shapes broadcast together.

    Attributes
    ----------
    kx, ky : [1/mm], not both 0.
    tractions : along x, along y and inwards [MPa].
    """

    kx: Array
    ky: Array
    tractions: tuple[ComplexArray, ComplexArray, ComplexArray]

    def stresses(self, medium: _LayersAtDepth) -> tuple[ComplexArray, ...]:
        """Return s_xx, s_yy, s_zz, s_xy, s_xz and s_yz for every wave vector."""
        k = np.hypot(self.kx, self.ky)
        c, s = self.kx / k, self.ky / k
        x, y, inward = self.tractions
        along, across = c * x + s * y, -s * x + c * y
        nn_x, zz_x, nz_x, nn_z, zz_z, nz_z, moved, passed = medium.amplitudes(k, self.kx)
        poisson, shear = medium.elastic(self.kx)
        nn = 1j * nn_x * along + nn_z * inward
        zz = 1j * zz_x * along + zz_z * inward
        nz = nz_x * along + 1j * nz_z * inward
        tt = poisson * (nn + zz)
        nt, tz = 1j * shear * k * moved * across, -passed * across
        twice = 2.0 * c * s * nt
        return (
            c * c * nn + s * s * tt - twice,
            s * s * nn + c * c * tt + twice,
            zz,
            c * s * (nn - tt) + (c * c - s * s) * nt,
            c * nz - s * tz,
            s * nz + c * tz,
        )


class _TransformedTractions:
    """Transformed tractions on a window around the grid.

    The wave vector 0 stands for a cell of wave vectors around it. Over a half-space stresses vary
    as |k| there, and their mean over the cell is used. This replaces most of what images of the
    patch would contribute. Over a rigid core stresses are smooth near 0, and decay before the
    images.
    """

    def __init__(self, grid: Grid, tractions: Array) -> None:
        self.grid = grid
        self.shape = (
            int(next_fast_len(_ROOM * grid.ny)),
            int(next_fast_len(_ROOM * grid.nx, real=True)),
        )
        kx = 2.0 * np.pi * np.fft.rfftfreq(self.shape[1]) / grid.hx
        ky = 2.0 * np.pi * np.fft.fftfreq(self.shape[0]) / grid.hy
        steps = kx[1], ky[1]
        kx[0] = 1e-6 * kx[1]
        fine = (np.arange(_CELL) + 0.5) / _CELL - 0.5
        wide_x, wide_y = np.meshgrid(kx, ky)
        spread = np.sinc(wide_x * grid.hx / (2.0 * np.pi))
        spread = spread * np.sinc(wide_y * grid.hy / (2.0 * np.pi))
        x, y, inward = (rfft2(t, self.shape, workers=1) * spread for t in tractions)
        self.waves = _WaveVectors(wide_x, wide_y, (x, y, inward))
        cell_x, cell_y = np.meshgrid(fine * steps[0], fine * steps[1])
        self.cell = _WaveVectors(cell_x, cell_y, (x[:1, :1], y[:1, :1], inward[:1, :1]))

    def stresses(self, roller: Roller, z: float, speed: float) -> Array:
        """Return s_xx, s_yy, s_zz, s_xy, s_xz, s_yz at one depth, (6, ny, nx)."""
        medium = _LayersAtDepth(roller, z, speed)
        spectra = self.waves.stresses(medium)
        rows, columns = self.grid.ny, self.grid.nx
        fields = []
        for part, mean in zip(spectra, self.cell.stresses(medium), strict=True):
            if roller.core is not None:
                part[0, 0] = np.mean(mean)
            fields.append(irfft2(part, self.shape, workers=1)[:rows, :columns])
        return np.stack(fields)


@dataclass(frozen=True, slots=True)
class _LayersAtDepth:
    """The response of a roller's layers at one depth.

    Attributes
    ----------
    roller : with layers or a half-space core.
    z : depth [mm].
    speed : V [mm/s]; used for viscoelastic rollers.
    """

    roller: Roller
    z: float
    speed: float

    def elastic(self, kx: Array) -> tuple[float, ComplexArray]:
        """Return Poisson ratio and shear modulus; on an interface those of the layer above."""
        interfaces = np.array(self.roller.interfaces)
        materials = self.roller.materials
        layer = int(np.searchsorted(interfaces, self.z * (1.0 - 1e-12), side="left"))
        material = materials[min(layer, len(materials) - 1)]
        young = material.modulus_at(-1j * kx * self.speed)
        return material.poisson, young / (2.0 * (1.0 + material.poisson))

    def amplitudes(self, k: Array, kx: Array) -> ComplexArray:
        """Return the response to unit tractions for each wave vector, (8, ...).

        s_nn/i, s_zz/i and s_nz of the traction along the wave vector; s_nn, s_zz and s_nz/i of the
        traction inwards; the displacement across the wave vector, and the traction that is left of
        the one across.
        """
        if self.roller.is_viscoelastic:
            kx = np.broadcast_to(kx, k.shape).ravel()
            parts = [
                self._computed(k.ravel()[i : i + _AT_ONCE], kx[i : i + _AT_ONCE])
                for i in range(0, k.size, _AT_ONCE)
            ]
            return np.concatenate(parts, axis=1).reshape(8, *k.shape)
        from scipy.interpolate import CubicSpline

        places = np.geomspace(float(k.min()), float(k.max()) * 1.000001, _TABLE)
        table = CubicSpline(np.log(places), self._computed(places, 0.0 * places).real, axis=-1)
        return np.asarray(table(np.log(k)))

    def _computed(self, k: Array, kx: Array) -> ComplexArray:
        """Return `amplitudes` for a one-dimensional array of wave vectors, (8, n)."""
        below = roller_stack(self.roller, kx, self.speed)
        along = flat_fields(k, [self.z], 1.0, 0.0, *below)
        inward = flat_fields(k, [self.z], 0.0, 1.0, *below)
        moved, passed = shear_fields(k, self.z, *below)
        return np.stack(
            [
                along.s_xx[0] / 1j,
                along.s_zz[0] / 1j,
                along.s_xz[0],
                inward.s_xx[0],
                inward.s_zz[0],
                inward.s_xz[0] / 1j,
                moved,
                passed,
            ]
        )
