"""Influence coefficients of uniformly loaded rectangles on a uniform grid.

A coefficient is the displacement at the middle of one rectangle under a unit traction on another.
The half-space part is the integral of the point solutions of Boussinesq and Cerruti over a
rectangle, in closed form (Love 1929, Phil. Trans. R. Soc. A 228, 377-420; Johnson 1985, 3.4):

    int 1/r = x asinh(y/|x|) + y asinh(x/|y|),  int x^2/r^3 = y asinh(x/|y|),  int xy/r^3 = -r,
    int x/r^2 = y ln r - y + x atan(y/x),

each taken between the corners. The contribution of layers is smooth and is integrated by Gauss
points.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import NDArray

from rollnip.patch.kernels import HalfSpace, PairKernel, RadialTable

Array = NDArray[np.float64]

_MOST_POINTS = 64


@dataclass(frozen=True, slots=True)
class Grid:
    """A grid of equal rectangles.

    Attributes
    ----------
    x0, y0 : middle of the first rectangle [mm].
    hx, hy : sides of a rectangle along x and y [mm].
    nx, ny : number of rectangles along x and y.
    """

    x0: float
    y0: float
    hx: float
    hy: float
    nx: int
    ny: int

    @classmethod
    def over(cls, x: tuple[float, float], y: tuple[float, float], nx: int, ny: int) -> Grid:
        """Return the grid that divides a rectangle; x and y are its extents along both axes."""
        hx, hy = (x[1] - x[0]) / nx, (y[1] - y[0]) / ny
        return cls(x[0] + 0.5 * hx, y[0] + 0.5 * hy, hx, hy, nx, ny)

    @property
    def x(self) -> Array:
        """Middles along x, (nx,) [mm]."""
        return np.asarray(self.x0 + self.hx * np.arange(self.nx), dtype=float)

    @property
    def y(self) -> Array:
        """Middles along y, (ny,) [mm]."""
        return np.asarray(self.y0 + self.hy * np.arange(self.ny), dtype=float)

    @property
    def element(self) -> float:
        """Area of one rectangle [mm2]."""
        return self.hx * self.hy

    @property
    def reach(self) -> float:
        """Largest distance between points of the grid plus one rectangle at each end [mm]."""
        return float(np.hypot((self.nx + 2) * self.hx, (self.ny + 2) * self.hy))


@dataclass(frozen=True, slots=True)
class Coefficients:
    """Influence coefficients for distances -nx ... nx along x and 0 ... ny along y.

    xx, yy, zz and xz are even in y, xy and yz are odd.

    Attributes
    ----------
    xx, xy, yy, zz, xz, yz : (ny + 1, 2 nx + 1) [mm/MPa]; xz is u_x per unit pressure.
    is_symmetric : whether the bodies are elastic: xx, yy, zz and yz are then even in x as well, xy
        and xz odd.
    """

    xx: Array
    xy: Array
    yy: Array
    zz: Array
    xz: Array
    yz: Array
    is_symmetric: bool


_ODD = np.array([1.0, -1.0, 1.0, 1.0, -1.0, 1.0])[:, None, None]
"""Signs of xx, xy, yy, zz, xz and yz of elastic bodies at the mirrored x."""


def coefficients(kernel: PairKernel, grid: Grid) -> Coefficients:
    """Return the influence coefficients of both elastic surfaces together on a grid."""
    xx, xy, yy, zz, xz, yz = both_sides(quadrant(kernel, grid))
    return Coefficients(xx, xy, yy, zz, xz, yz, is_symmetric=True)


def quadrant(kernel: PairKernel, grid: Grid) -> Array:
    """Return xx, xy, yy, zz, xz, yz for non-negative distances, (6, ny + 1, nx + 1) [mm/MPa]."""
    values = half_space_coefficients(kernel.half_space, grid)
    for table, sign in kernel.tables:
        values += _layered(table, grid, sign)
    return values


def both_sides(values: Array) -> Array:
    """Return the coefficients for distances of both signs along x, (6, ny + 1, 2 nx + 1).

    The bodies must be elastic.
    """
    return np.concatenate([_ODD * values[:, :, :0:-1], values], axis=2)


def half_space_coefficients(body: HalfSpace, grid: Grid) -> Array:
    """Return the coefficients xx, xy, yy, zz, xz, yz of a half-space, (6, ny + 1, nx + 1)."""
    right = (np.arange(grid.nx + 2) - 0.5)[None, :] * grid.hx
    upper = (np.arange(grid.ny + 2) - 0.5)[:, None] * grid.hy
    r = np.hypot(right, upper)
    across = upper * np.arcsinh(right / np.abs(upper))
    along = right * np.arcsinh(upper / np.abs(right))
    log, angle = np.log(r), np.arctan(upper / right)
    s, t = body.s / (2.0 * pi), body.t / (2.0 * pi)
    z, x = body.z / (2.0 * pi), body.x / (2.0 * pi)
    both = along + across
    corners = np.stack(
        [
            s * both + t * along,  # cos^2 f/k is y^2/r^3
            t * r,  # cos f sin f/k is -x y/r^3
            s * both + t * across,
            z * both,
            -x * (upper * log + right * angle),
            -x * (right * log + upper * np.arctan(right / upper)),
        ]
    )
    return np.asarray(np.diff(np.diff(corners, axis=1), axis=2))


def _layered(table: RadialTable, grid: Grid, sign: float) -> Array:
    """Return the contribution of one roller's layers, (6, ny + 1, nx + 1)."""
    gauss_x, gauss_y = (gauss(h, table.finest) for h in (grid.hx, grid.hy))
    x = np.arange(grid.nx + 1)[None, :] * grid.hx
    y = np.arange(grid.ny + 1)[:, None] * grid.hy
    out = np.zeros((6, grid.ny + 1, grid.nx + 1))
    for dx, wx in zip(*gauss_x, strict=True):
        for dy, wy in zip(*gauss_y, strict=True):
            out += (wx * wy) * layered_at(table, x + dx, y + dy, sign)
    return out


def layered_at(table: RadialTable, x: Array, y: Array, sign: float) -> Array:
    """Return the contribution of one roller's layers under a point force, (6, ...) [1/N].

    ``x`` and ``y`` are the distances from the force.
    """
    r = np.hypot(x, y)
    s, t0, t2, z, x1 = np.moveaxis(table.spline(r), -1, 0)
    safe = np.maximum(r, 1e-300)
    c, d = x / safe, y / safe
    turned = 0.5 * t2 * (c * c - d * d)
    even, odd = s + 0.5 * t0, sign * x1
    return np.stack([even - turned, -t2 * c * d, even + turned, z, -odd * c, -odd * d])


def half_space_at(body: HalfSpace, x: Array, y: Array) -> Array:
    """Return xx, xy, yy, zz, xz, yz of a half-space under a point force, (6, ...) [1/N]."""
    r = np.hypot(x, y)
    c, d = x / r, y / r
    along, across = body.s + body.t * d * d, body.s + body.t * c * c
    rows = [along, -body.t * c * d, across, body.z + 0.0 * r, -body.x * c, -body.x * d]
    return np.stack(rows) / (2.0 * pi * r)


def gauss(side: float, finest: float) -> tuple[Array, Array]:
    """Return positions and weights of Gauss points over the side of a rectangle."""
    count = min(2 + int(2.0 * side / finest), _MOST_POINTS)
    points, weights = np.polynomial.legendre.leggauss(count)
    return 0.5 * side * points, 0.5 * side * weights
