"""Matrices of a membrane's contact on a mesh: gap and creeps per traction, tension per shear."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from rollnip.contact import left_out_of_creep
from rollnip.rolling.surfaces import Mesh
from rollnip.sheet.local_deformation import thickness_loss
from rollnip.sheets import Sheet

Array = NDArray[np.float64]

_STEEP = 4.0  # exponent of the blend between exact and lumped integrals of the tension
_NONE = 1e-12  # share of lumped forces below rounding
_DEGREE = 8  # of the polynomial along the path of the sheet
# Derivatives of Legendre polynomials, expressed by those of lower degree.
_SLOPES = legendre.legder(np.eye(_DEGREE + 1))


@dataclass(frozen=True, slots=True)
class Integrals:
    """Integrals of nodal tractions along the sheet, per value at ``mesh.inner``.

    They are exact for piecewise-linear tractions; ds is along the sheet's path.

    Attributes
    ----------
    tails : (n, n) int_x^inf t ds at these nodes [mm].
    tail_integrals : (n, n) integral of ``tails`` dx over the intervals [mm^2].
    interval_integrals : (n, n) int t dx over the intervals [mm].
    totals : (n,) int t ds [mm].
    """

    tails: Array
    tail_integrals: Array
    interval_integrals: Array
    totals: Array

    @classmethod
    def on(cls, mesh: Mesh, arcs: Array) -> Integrals:
        """Integrate on a mesh; ``arcs``: ds/dx on the intervals of its fine nodes."""
        fine, n = mesh.fine, mesh.inner.size
        assert fine.acting is not None
        dx, along = np.diff(fine.nodes)[:, None], arcs[:, None]
        values = np.zeros((fine.nodes.size, n))
        values[1:-1] = fine.acting[1:-1, 1:-1]
        pieces = values[1:] + values[:-1]
        pieces *= 0.5 * dx
        tails = np.zeros(values.shape)
        np.cumsum((along * pieces)[::-1], axis=0, out=tails[-2::-1])
        over = tails[1:] + tails[:-1]
        over *= 0.5 * dx
        rise = np.subtract(values[1:], values[:-1])
        rise *= along * dx**2 / 12.0
        over += rise
        parts = (fine.nodes.size - 3) // (n - 1)
        return cls(
            tails=tails[1 : parts * (n - 1) + 2 : parts],
            tail_integrals=mesh.sums(over[1:]),
            interval_integrals=mesh.sums(pieces[1:]),
            totals=tails[0],
        )


@dataclass(frozen=True, slots=True)
class SheetPath:
    """The path of a sheet as a least-squares polynomial through heights over the contact.

    The sheet's bending stiffness makes its path smooth, and its curvature matters on the scale of
    the nip. The fit uses nodal heights, because the cubics between a few nodes do not follow the
    highest degrees of the polynomial. It weights them with the integration weights of a pressure,
    which are exact to fourth order.

    Attributes
    ----------
    slopes : (n, 9) change of slope over each interval of nodes[1:] per coefficient [1/mm].
    nearest : (9, n) coefficients of the polynomial per height at ``mesh.inner``.
    """

    slopes: Array
    nearest: Array

    @classmethod
    def on(cls, mesh: Mesh) -> SheetPath:
        """Return the least-squares fit on a mesh."""
        x = mesh.inner
        middle, half = 0.5 * (x[0] + x[-1]), 0.5 * (x[-1] - x[0])
        basis = legendre.legvander((x - middle) / half, _DEGREE)
        weighted = basis * mesh.weights[:, None]
        slopes = np.zeros(basis.shape)  # the last interval lies outside the contact
        slopes[:-1] = np.diff(basis[:, :-1] @ _SLOPES, axis=0) / half
        return cls(slopes, np.asarray(np.linalg.solve(weighted.T @ basis, weighted.T), float))

    def slope_changes(self, heights: Array) -> Array:
        """Return the change of slope over the intervals, for heights at nodes[1:], (n, ...)."""
        return np.asarray(self.slopes @ (self.nearest @ heights[:-1]))

    def creep_matrix(self, mesh: Mesh, thickness: float) -> Array:
        """Return the path's part of either creep per nodal p, q_u and q_l, (n, 3, n) [mm/MPa].

        The faces run at 1 + e -+ h kappa/2: both creeps gain h/2 times the change of slope of the
        middle, which lies halfway between both surfaces, (u_z,u - u_z,l)/2.
        """
        _, zz_u, xz_u, _, zz_l, xz_l = mesh.per_traction
        parts = [self.slope_changes(heights) for heights in (zz_u - zz_l, -xz_u, -xz_l)]
        return 0.25 * thickness * np.stack(parts, axis=1)


def stabilised_tension(mesh: Mesh, sheet: Sheet, integrals: Integrals, own: Array) -> Array:
    """Return the integral of the tension over each interval, stabilised where tension dominates.

    Where a node's shear stretches its interval more through the sheet's tension than through the
    rollers, exact integration lets the shears of neighbouring nodes alternate and grow. There the
    force of each node is lumped at the node, which is second-order accurate and stable for any
    sheet.
    """
    dx, n = mesh.dx, mesh.inner.size
    ratio = sheet.stretch_by_tension * dx**2 / (6.0 * np.abs(own).min(axis=0))
    share = (1.0 / (1.0 + np.minimum(ratio, 1e6) ** -_STEEP))[:, None]
    if float(share.max()) < _NONE:
        return integrals.tail_integrals
    lumped = dx[:, None] * np.triu(np.broadcast_to(integrals.totals, (n, n)), k=1)
    return np.asarray((1.0 - share) * integrals.tail_integrals + share * lumped)


def influence_matrix(mesh: Mesh, sheet: Sheet, integrals: Integrals) -> Array:
    """Return gap, upper and lower creep per nodal p, q_u and q_l, (3 n, 3 n) [mm/MPa].

    The strain of the sheet due to tension is not included.
    """
    n, at_nodes = mesh.inner.size, integrals.tails
    xx_u, zz_u, xz_u, xx_l, zz_l, xz_l = mesh.per_traction
    by_pressure, sheared = sheet.stretch_by_pressure, sheet.shear_by_thickness
    fine, out = mesh.fine, np.zeros((3, n, 3, n))
    assert fine.acting is not None
    gap, upper, lower = out
    np.add(zz_u[:-1], zz_l[:-1], out=gap[:, 0])
    gap[:, 0] += thickness_loss(sheet, mesh.inner, fine.nodes, fine.acting[1:-1, 1:-1])
    np.multiply(by_pressure, at_nodes, out=gap[:, 2])
    np.negative(gap[:, 2], out=gap[:, 1])
    gap[:, 1] -= xz_u[:-1]
    gap[:, 2] += xz_l[:-1]
    np.subtract(xz_u[1:], xz_u[:-1], out=upper[:, 0])
    np.subtract(xx_u[1:], xx_u[:-1], out=upper[:, 1])
    np.subtract(xz_l[:-1], xz_l[1:], out=lower[:, 0])
    np.subtract(xx_l[1:], xx_l[:-1], out=lower[:, 2])
    if any(mesh.kernels.hoops):
        _add_hoops(mesh, out)
    pressed = by_pressure * integrals.interval_integrals
    upper[:, 0] -= pressed
    lower[:, 0] += pressed
    _add_bands(upper[:, 1], lower[:, 2], sheared / 3.0)
    _add_bands(upper[:, 2], lower[:, 1], sheared / 6.0)
    last = n - 2  # in case the surfaces stick up to a leading edge at the last node
    for side in (1, 2):
        out[side, last, side, last] *= 1.0 - left_out_of_creep(0j).real
    return out.reshape(3 * n, 3 * n)


def _add_bands(upper: Array, lower: Array, value: float) -> None:
    """Add ``value`` times the difference of neighbouring tractions to two matrices."""
    for matrix in (upper, lower):
        n = matrix.shape[0]
        places = np.arange(n)
        matrix[places, places] -= value
        matrix[places[:-1], places[1:]] += value


def _add_hoops(mesh: Mesh, out: Array) -> None:
    """Add the hoop stretch -int u_z/R dx of both surfaces to the creeps in ``out``."""
    integrated = mesh.fine.integrated
    _, zz_u, xz_u, _, zz_l, xz_l = mesh.per_traction
    hoop_u, hoop_l = mesh.kernels.hoops
    if hoop_u:
        out[1, :, 0] -= hoop_u * integrated(zz_u)
        out[1, :, 1] += hoop_u * integrated(xz_u)
    if hoop_l:
        out[2, :, 0] += hoop_l * integrated(zz_l)
        out[2, :, 2] += hoop_l * integrated(xz_l)
