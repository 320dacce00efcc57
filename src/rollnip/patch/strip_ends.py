"""Compliance of a covering that ends: waves along the nip, finite elements in the cross-section.

Under a pressure p(y) cos(k x) an elastic covering that is uniform along x moves as

    u_x = U(y, z) sin(k x),   u_y = V(y, z) cos(k x),   u_z = W(y, z) cos(k x),

so that each wave number k is a problem in the plane of y and z. Its energy per length is

    1/2 int [2 mu (e_xx^2 + e_yy^2 + e_zz^2) + mu (g_yz^2 + g_xy^2 + g_xz^2) + lambda div^2] dy dz,
    e_xx = k U,  g_xy = U_y - k V,  g_xz = U_z - k W,  div = k U + V_y + W_z.

Elements have nine nodes. Only the linear part of the volume strain in each element enters the
energy, which avoids locking at Poisson's ratio 1/2 (Fortin & Brezzi 1991, Mixed and Hybrid Finite
Element Methods, VI.3). The end at y = 0 is stress-free; the covering is bonded to a rigid core.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_solve_banded, cholesky_banded

from rollnip.patch.kernels import waves_of
from rollnip.rollers import Roller

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

_STIFFEST = 1e8
"""Largest lambda over mu, at Poisson's ratio 1/2."""
_GROWTH = 1.6
"""Ratio of the heights of an element and the one above it."""
_LEAST = 1e-4
"""Smallest wave number times thickness, which stands for 0 in the plane compliance."""
_FIRST = 0.02
"""Smallest wave number times thickness that is solved for, in place of 0."""
_STEP = 0.3
"""Largest step of asinh(k d) between wave numbers that are solved for."""


def _quadratics(at: Array) -> tuple[Array, Array]:
    """Return values and derivatives of the quadratic shape functions on [-1, 1], (n, 3) each."""
    values = np.stack((0.5 * at * (at - 1.0), 1.0 - at * at, 0.5 * at * (at + 1.0)), axis=-1)
    slopes = np.stack((at - 0.5, -2.0 * at, at + 0.5), axis=-1)
    return values, slopes


_GAUSS = np.polynomial.legendre.leggauss(3)
_ACROSS, _DOWN = (grid.ravel() for grid in np.meshgrid(_GAUSS[0], _GAUSS[0], indexing="ij"))
_AREA = np.multiply.outer(_GAUSS[1], _GAUSS[1]).ravel()
_LINEAR = np.stack((np.ones(9), _ACROSS, _DOWN), axis=-1)
(_N_Y, _D_Y), (_N_Z, _D_Z) = _quadratics(_ACROSS), _quadratics(_DOWN)
_VALUE = (_N_Y[:, :, None] * _N_Z[:, None, :]).reshape(9, 9)
_BY_Y = (_D_Y[:, :, None] * _N_Z[:, None, :]).reshape(9, 9)
_BY_Z = (_N_Y[:, :, None] * _D_Z[:, None, :]).reshape(9, 9)


@dataclass(frozen=True)
class EndedCovering:
    """Compliance of a covering under pressures linear between places y, at any wave number.

    Attributes
    ----------
    roller : with elastic layers on a rigid core.
    y : (m,) places from 0, the end [mm].
    spline : over asinh(k d), up to k = top: its cosh times (the compliance, less the plane one
        times `hat_products`).
    top : largest wave number that was solved for [1/mm].
    """

    roller: Roller
    y: Array
    spline: CubicSpline
    top: float

    @classmethod
    def of(
        cls, roller: Roller, y: Array, least: float, ends: bool, fine: float = 1.0
    ) -> EndedCovering:
        """Return a covering solved at wave numbers up to 1/least.

        Parameters
        ----------
        roller : with elastic layers on a rigid core.
        y : (m,) places from 0, with one element between two of them; the last is a plane of
            symmetry [mm].
        least : height of the element at the surface [mm].
        ends : whether the covering ends at y = 0; otherwise it continues there.
        fine : a factor by which the elements below the surface are more numerous.
        """
        thickness = roller.coating_thickness
        depths, owner = _depths(roller, least, fine)
        before = np.empty(0) if ends else -y[:0:-1]
        strip = _CrossSection(roller, np.concatenate([before, y]), depths, owner, not ends)
        column = _CrossSection(roller, np.array([0.0, thickness]), depths, owner, True)
        top = 1.0 / least
        count = int(np.ceil(np.arcsinh(top * thickness) / _STEP))
        places = np.linspace(0.0, np.arcsinh(top * thickness), count + 1)
        first = before.size
        mass, values = hat_products(y), []
        for place in places:
            k = max(np.sinh(place), _FIRST) / thickness
            plane = float(plane_compliance(roller, np.array([k]))[0])
            exact = plane * thickness / float(np.sum(column.compliance(k, 0)))
            rest = exact * strip.compliance(k, first) - plane * mass
            values.append(np.cosh(place) * rest)
        from scipy.interpolate import CubicSpline

        still = np.zeros_like(values[0])
        spline = CubicSpline(places, np.array(values), bc_type=((1, still), "not-a-knot"))
        return cls(roller, y, spline, top)

    def compliance(self, k: Array) -> Array:
        """Return u_z under the pressure hat j, integrated with the hat i, (n, m, m) [mm2/MPa].

        It holds for wave numbers up to ``top``.
        """
        place = np.arcsinh(k * self.roller.coating_thickness)
        rest = self.spline(place) / np.cosh(place)[:, None, None]
        plane = plane_compliance(self.roller, k)
        return np.asarray(rest + plane[:, None, None] * hat_products(self.y))

    def beyond(self, k: Array) -> Array:
        """Return factors (n,) on the compliance at ``top`` that give it at larger wave numbers.

        Such short waves are felt near the surface only, at an end as anywhere else.
        """
        at_top = plane_compliance(self.roller, np.array([self.top]))
        return np.asarray(plane_compliance(self.roller, k) / at_top)


def hat_products(y: Array) -> Array:
    """Return the integrals of products of two hats on places y, (m, m) [mm]."""
    sizes = np.diff(y)
    whole = np.concatenate([[0.0], sizes]) + np.concatenate([sizes, [0.0]])
    return np.diag(whole / 3.0) + np.diag(sizes / 6.0, 1) + np.diag(sizes / 6.0, -1)


def plane_compliance(roller: Roller, k: Array) -> Array:
    """Return the normal compliance of a covering without ends, (n,) [mm/MPa]; k may be 0."""
    least = _LEAST / roller.coating_thickness
    return np.asarray(waves_of(roller, np.maximum(k, least)).z)


def _depths(roller: Roller, least: float, fine: float) -> tuple[Array, Indices]:
    """Return depths of the boundaries of elements (rows + 1,), and the layer of each element."""
    growth = _GROWTH ** (1.0 / fine)
    ends, owner, size = [0.0], [], least
    for layer, (top, bottom) in enumerate(pairwise((0.0, *roller.interfaces))):
        count = int(np.ceil(np.log1p((bottom - top) * (growth - 1.0) / size) / np.log(growth)))
        parts = growth ** np.arange(max(count, 2))
        parts *= (bottom - top) / parts.sum()
        ends += (top + np.cumsum(parts)).tolist()
        owner += [layer] * parts.size
        size = float(parts[-1])
    return np.array(ends), np.array(owner)


def _lame(roller: Roller) -> tuple[Array, Array]:
    """Return mu and lambda of the layers [MPa]."""
    young, poisson = (
        np.array([getattr(layer.material, name) for layer in roller.layers])
        for name in ("relaxed_modulus", "poisson")
    )
    mu = young / (2.0 * (1.0 + poisson))
    ratio = 2.0 * poisson / np.maximum(1.0 - 2.0 * poisson, 1.0 / _STIFFEST)
    return mu, mu * ratio


def _strains(half_y: Array, half_z: Array) -> tuple[Array, Array]:
    """Return the strains per nodal displacement, without k and times k, (elements, 57, 27) each.

    Rows: e_xx, e_yy, e_zz, g_yz, g_xy and g_xz at the nine Gauss points, then three coefficients of
    the linear part of the volume strain, whose squares add up to its integral over the area.
    """
    by_y, by_z = _BY_Y / half_y[:, None, None], _BY_Z / half_z[:, None, None]
    value, none = np.broadcast_to(_VALUE, by_y.shape), np.zeros_like(by_y)
    norms = (_LINEAR.T * _AREA) @ _LINEAR
    basis = (_LINEAR.T * _AREA) / np.sqrt(np.diagonal(norms))[:, None]

    def rows(*parts: tuple[Array, Array, Array]) -> list[Array]:
        return [np.concatenate(one, axis=2) for one in parts]

    plain = rows(
        (none, none, none),
        (none, by_y, none),
        (none, none, by_z),
        (none, by_z, by_y),
        (by_y, none, none),
        (by_z, none, none),
    )
    along, zero, turned, lifted = rows(
        (value, none, none), (none, none, none), (none, -value, none), (none, none, -value)
    )
    plain.append(basis @ (plain[1] + plain[2]))
    waved = [along, zero, zero, zero, turned, lifted, basis @ along]
    return np.concatenate(plain, axis=1), np.concatenate(waved, axis=1)


class _CrossSection:
    """Finite elements over y and z; the last side over y is a plane of symmetry.

    Parameters
    ----------
    roller : its layers.
    y : boundaries of the elements over y [mm].
    depths, owner : boundaries of the elements over z [mm], and the layer of each.
    is_symmetric : whether the first side over y is a plane of symmetry too; otherwise it is free.
    """

    def __init__(
        self, roller: Roller, y: Array, depths: Array, owner: Indices, is_symmetric: bool
    ) -> None:
        self.sizes = np.diff(y)
        across, down = self.sizes.size, owner.size
        self.rows = 2 * down
        self.count = 3 * self.rows * (2 * across + 1)
        self.band = 3 * (2 * self.rows + 2) + 2
        column = 2 * np.arange(across)[:, None, None, None] + np.arange(3)[:, None]
        row = 2 * np.arange(down)[:, None, None] + np.arange(3)
        node = np.where(row < self.rows, column * self.rows + row, -1).reshape(-1, 9)
        places = np.stack([3 * node, 3 * node + 1, 3 * node + 2], axis=1)
        places[np.broadcast_to(node[:, None, :] < 0, places.shape)] = -1
        held = [3 * (2 * across * self.rows + np.arange(self.rows)) + 1]
        if is_symmetric:
            held.append(3 * np.arange(self.rows) + 1)
        self.held = np.concatenate(held)
        places[np.isin(places, self.held)] = -1
        self.terms = self._assembled(places.reshape(-1, 27), self._elements(roller, depths, owner))

    def _elements(self, roller: Roller, depths: Array, owner: Indices) -> list[Array]:
        """Return the matrices of the elements in k^0, k^1 and k^2, (elements, 27, 27) each."""
        half_y, half_z = (
            one.ravel()
            for one in np.meshgrid(0.5 * self.sizes, 0.5 * np.diff(depths), indexing="ij")
        )
        mu, lam = (np.tile(one[owner], self.sizes.size) for one in _lame(roller))
        plain, waved = _strains(half_y, half_z)
        volume = (half_y * half_z)[:, None]
        doubled = np.repeat([2.0, 2.0, 2.0, 1.0, 1.0, 1.0], 9) * np.tile(_AREA, 6)
        weights = np.concatenate(
            [mu[:, None] * volume * doubled, np.repeat(lam[:, None] * volume, 3, axis=1)], axis=1
        )
        left = plain.transpose(0, 2, 1) * weights[:, None, :]
        mixed = left @ waved
        return [
            left @ plain,
            mixed + mixed.transpose(0, 2, 1),
            (waved.transpose(0, 2, 1) * weights[:, None, :]) @ waved,
        ]

    def _assembled(self, places: Indices, terms: list[Array]) -> Array:
        """Return the lower bands of the global matrices, (3, band + 1, unknowns)."""
        row = np.repeat(places[:, :, None], 27, axis=2)
        column = np.repeat(places[:, None, :], 27, axis=1)
        counts = (row >= column) & (column >= 0)
        where = (row - column)[counts] * self.count + column[counts]
        size = (self.band + 1) * self.count
        out = np.array([np.bincount(where, one[counts], size) for one in terms])
        out = out.reshape(3, self.band + 1, self.count)
        out[0, 0, self.held] = 1.0
        return out

    def compliance(self, k: float, first: int) -> Array:
        """Return u_z under pressure hats times hats at a wave number, from place ``first`` on."""
        matrix = self.terms[0] + k * self.terms[1] + k * k * self.terms[2]
        factor = cholesky_banded(matrix, overwrite_ab=True, lower=True, check_finite=False)
        chosen = np.arange(first, self.sizes.size)
        forces = np.zeros((self.count, chosen.size + 1))
        for side in (0, 1):
            for node, share in ((2 * side, 1.0 / 6.0), (1, 1.0 / 3.0)):
                rows = 3 * (2 * chosen + node) * self.rows + 2
                forces[rows, np.arange(chosen.size) + side] += share * self.sizes[chosen]
        moved = cho_solve_banded((factor, True), forces, check_finite=False)
        return np.asarray(forces.T @ moved)
