"""Displacement of elastic surfaces under point forces: half-space in closed form, layers by table.

For the wave vector k (cos f, sin f), tractions along it and inwards are resisted by the
plane-strain compliances P = C_xx, Z = C_zz and i X = C_xz of `rollnip.compliance`, tractions across
it by S. Rotated back to x and y, with T = P - S,

    C_xx = S + T cos^2 f,  C_xy = T cos f sin f,  C_yy = S + T sin^2 f,  C_zz = Z,
    C_xz = i X cos f = -C_zx,  C_yz = i X sin f = -C_zy.

Each of S, T, Z, X tends to a/k for large k, the half-space of the top layer. The remainder decays
as exp(-2 k d) and is a function of k alone: at the distance r from the force it is the Hankel
integral (1/2 pi) int f(k) J_n(k r) k dk, n = 0 for S and Z, 0 and 2 for T, 1 for X. It is tabulated
over r. Nothing here is periodic, so that no image of a contact acts on it.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from math import pi
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.special import j0, j1

from rollnip.compliance import flat_compliance, half_space_limit, shear_compliance
from rollnip.rollers import Roller

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

Array = NDArray[np.float64]

FADED = 16.0
"""k d at which exp(-2 k d) (k d)^2 is 3e-12 of the half-space."""
_NODES = 16
"""Number of Gauss points on a panel of wave numbers."""
_PANEL = 6.0
"""Largest k r over a panel, over which the Bessel functions oscillate once."""
_FINEST = 24.0
"""Number of places of the table within the thinnest layer."""
_GROWTH = 30.0
"""Number of places of the table in a factor e of distance, beyond the thinnest layer."""
_CHUNK = 2_000_000
"""Number of values of a Bessel function that are held at once."""


class WaveCompliance(NamedTuple):
    """S, T, Z and X at given wave numbers, (n,) each [mm/MPa]."""

    s: Array
    t: Array
    z: Array
    x: Array


@dataclass(frozen=True, slots=True)
class HalfSpace:
    """Coefficients of 1/k in S, T, Z and X for large k [1/MPa]."""

    s: float = 0.0
    t: float = 0.0
    z: float = 0.0
    x: float = 0.0

    def __add__(self, other: HalfSpace) -> HalfSpace:
        return HalfSpace(*(getattr(self, f.name) + getattr(other, f.name) for f in fields(self)))

    @classmethod
    def of(cls, young: float, poisson: float) -> HalfSpace:
        """Return the coefficients of a half-space, its modulus in MPa."""
        even, odd = (float(v) for v in half_space_limit(young, poisson))
        across = 2.0 * (1.0 + poisson) / young
        return cls(s=across, t=even - across, z=even, x=odd)

    def mirrored(self) -> HalfSpace:
        """Return the coefficients for a body on the other side, whose shear is reversed."""
        return HalfSpace(self.s, self.t, self.z, -self.x)


@dataclass(frozen=True)
class RadialTable:
    """Response of layers beyond the half-space of the top one, by distance from a point force.

    Attributes
    ----------
    reach : largest distance of the table [mm].
    finest : distance over which it is smooth near the force [mm].
    spline : (5,) values over r: S, T (orders 0 and 2), Z and X [1/N].
    """

    reach: float
    finest: float
    spline: CubicSpline


@dataclass(frozen=True)
class PairKernel:
    """Displacement of both surfaces together under the tractions between them.

    Shear acts on the upper surface along +x and +y, and on the lower one in the opposite direction;
    u_x and u_y are upper minus lower, u_z the sum of both inwards.

    Attributes
    ----------
    half_space : closed-form part.
    tables : one for each roller with layers, with the sign of its X. Identical rollers share one
        table; their X cancel, and the sign is 0.
    """

    half_space: HalfSpace
    tables: tuple[tuple[RadialTable, float], ...]


def pair_kernel(upper: Roller, lower: Roller, reach: float) -> PairKernel:
    """Return the kernel of two elastic rollers for distances up to ``reach`` [mm]."""
    half_space, tables = HalfSpace(), []
    alike = upper.layers == lower.layers and upper.core == lower.core
    for roller, sign in ((upper, 1.0), (lower, -1.0)):
        if roller.is_rigid:
            continue
        own = _half_space(roller)
        half_space += own if sign > 0.0 else own.mirrored()
        if roller.layers:
            tables.append((radial_table(roller, reach), sign))
    if alike and len(tables) == 2:
        from scipy.interpolate import CubicSpline

        table = tables[0][0]
        twice = CubicSpline(table.spline.x, 2.0 * table.spline(table.spline.x) * _EVEN)
        tables = [(RadialTable(table.reach, table.finest, twice), 0.0)]
    return PairKernel(half_space, tuple(tables))


_EVEN = np.array([1.0, 1.0, 1.0, 1.0, 0.0])
"""Two identical surfaces are not sheared against each other by pressure."""


def _half_space(roller: Roller) -> HalfSpace:
    top = roller.materials[0]
    return HalfSpace.of(top.relaxed_modulus, top.poisson)


def waves_of(roller: Roller, k: Array) -> WaveCompliance:
    """Return S, T, Z and X of an elastic roller at positive wave numbers."""
    thickness = np.array([layer.thickness for layer in roller.layers])
    young = np.array([layer.material.relaxed_modulus for layer in roller.layers])
    poisson = np.array([layer.material.poisson for layer in roller.layers])
    core, core_poisson = None, 0.5
    if roller.core is not None:
        core, core_poisson = np.asarray(roller.core.relaxed_modulus), roller.core.poisson
    plane = flat_compliance(k, thickness, young, poisson, core, core_poisson)
    across = np.asarray(shear_compliance(k, thickness, young, poisson, core, core_poisson).real)
    return WaveCompliance(across, plane.xx.real - across, plane.zz.real, plane.xz.imag)


def radial_table(roller: Roller, reach: float) -> RadialTable:
    """Return what the layers of an elastic roller add to its half-space, up to ``reach`` [mm]."""
    thinnest = min(layer.thickness for layer in roller.layers)
    k, weights = wave_numbers(thinnest, reach)
    waves, limit = waves_of(roller, k), _half_space(roller)
    rests = [getattr(waves, name) * k - getattr(limit, name) for name in ("s", "t", "z", "x")]
    return tabulated((k, weights), np.array(rests)[None], thinnest, reach)[0]


def tabulated(
    waves: tuple[Array, Array], rests: Array, thinnest: float, reach: float
) -> list[RadialTable]:
    """Return tables over the distance, of functions of the wave number.

    Parameters
    ----------
    waves : (n,) wave numbers and weights of `wave_numbers`.
    rests : (m, 4, n) k times S, T, Z and X, less the half-space [1/MPa].
    thinnest : length over which they decay, the thinnest layer [mm].
    reach : largest distance [mm].
    """
    k, weights = waves
    s, t, z, x = np.moveaxis(rests * weights / (2.0 * pi), (1, 2), (0, 1))
    r = _places(thinnest, reach)
    values = np.empty((r.size, 5, rests.shape[0]))
    step = max(1, _CHUNK // k.size)
    for first in range(0, r.size, step):
        part = slice(first, first + step)
        kr = np.outer(r[part], k)
        zero, one = j0(kr), j1(kr)
        two = np.where(kr > 1e-4, 2.0 * one / np.maximum(kr, 1e-4) - zero, kr * kr / 8.0)
        values[part] = np.stack([zero @ s, zero @ t, two @ t, zero @ z, one @ x], axis=1)
    from scipy.interpolate import CubicSpline

    return [
        RadialTable(reach, thinnest, CubicSpline(r, values[..., i])) for i in range(rests.shape[0])
    ]


def wave_numbers(thinnest: float, reach: float) -> tuple[Array, Array]:
    """Return wave numbers and weights of panels that resolve J(k r) up to r = ``reach``."""
    last = FADED / thinnest
    count = int(np.ceil(last * reach / _PANEL)) + 4
    points, weights = np.polynomial.legendre.leggauss(_NODES)
    edges = np.linspace(0.0, last, count + 1)
    half = 0.5 * np.diff(edges)[:, None]
    k = edges[:-1, None] + half * (1.0 + points)
    return k.ravel(), (half * weights).ravel()


def _places(thinnest: float, reach: float) -> Array:
    """Return distances: evenly spaced within the thinnest layer, then in a geometric series."""
    near = np.linspace(0.0, thinnest, int(_FINEST) + 1)
    if reach <= thinnest:
        return np.linspace(0.0, reach, int(_FINEST) + 1)
    far = int(np.ceil(_GROWTH * np.log(reach / thinnest))) + 2
    return np.concatenate([near[:-1], np.geomspace(thinnest, reach, far)])
