"""Matrices of a sheet's contact on a mesh: gap and creeps per nodal traction, tension per shear."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from rollnip.contact import CREEP_TO_EDGE
from rollnip.rolling.surfaces import Mesh
from rollnip.sheet.squeeze import squeezed
from rollnip.sheets import Sheet

Array = NDArray[np.float64]

_STEEP = 4.0  # how fast the integral of the tension changes its kind
_DEGREE = 8  # of the polynomial along the path of the sheet


@dataclass(frozen=True, slots=True)
class Integrals:
    """Integrals of nodal tractions along the sheet, per value at ``mesh.inner``.

    Exact for the straight lines along which tractions act. ds is along the sheet's path.

    Attributes
    ----------
    beyond : (n, n) int_x^inf t ds at these nodes [mm].
    over : (n, n) its integral dx over the intervals [mm^2].
    pressed : (n, n) int t dx over the intervals [mm].
    whole : (n,) int t ds [mm].
    """

    beyond: Array
    over: Array
    pressed: Array
    whole: Array

    @classmethod
    def on(cls, mesh: Mesh, arcs: Array) -> Integrals:
        """Integrate on a mesh; ``arcs``: ds/dx on the intervals of its finer nodes."""
        fine, n = mesh.fine, mesh.inner.size
        assert fine.acting is not None
        dx, along = np.diff(fine.nodes)[:, None], arcs[:, None]
        values = np.zeros((fine.nodes.size, n))
        values[1:-1] = fine.acting[1:-1, 1:-1]
        pieces = 0.5 * dx * (values[1:] + values[:-1])
        beyond = np.zeros(values.shape)
        beyond[:-1] = np.cumsum((along * pieces)[::-1], axis=0)[::-1]
        rise = along * dx**2 / 12.0 * (values[1:] - values[:-1])
        over = 0.5 * dx * (beyond[1:] + beyond[:-1]) + rise
        parts = (fine.nodes.size - 3) // (n - 1)
        return cls(
            beyond=beyond[1 : parts * (n - 1) + 2 : parts],
            over=mesh.sums(over[1:]),
            pressed=mesh.sums(pieces[1:]),
            whole=beyond[0],
        )


def stable(mesh: Mesh, sheet: Sheet, found: Integrals, own: Array) -> Array:
    """Return the integral of the tension over each interval, kept stable where tension rules.

    Where an interval stretches more by the tension that its own node makes than by that node's
    shear on the rollers, exact integrals of the tension let neighbouring shears alternate and
    grow. There the force of each node acts at the node: second order, and stable for any sheet.
    """
    dx, n = mesh.dx, mesh.inner.size
    lumped = dx[:, None] * np.triu(np.broadcast_to(found.whole, (n, n)), k=1)
    ratio = sheet.stretch_by_tension * dx**2 / (6.0 * np.abs(own).min(axis=0))
    share = (1.0 / (1.0 + np.minimum(ratio, 1e6) ** -_STEEP))[:, None]
    return np.asarray((1.0 - share) * found.over + share * lumped)


def influence(mesh: Mesh, sheet: Sheet, found: Integrals) -> Array:
    """Return gap, upper and lower creep per nodal p, q_u and q_l, (3 n, 3 n) [mm/MPa].

    The strain of the sheet by tension is left out.
    """
    n, at_nodes, pressed = mesh.inner.size, found.beyond, found.pressed
    xx_u, zz_u, xz_u, xx_l, zz_l, xz_l = mesh.per_traction
    by_pressure, sheared = sheet.stretch_by_pressure, sheet.shear_by_thickness
    hoop_u, hoop_l = mesh.kernels.hoops
    out = np.zeros((3, n, 3, n))
    fine = mesh.fine
    assert fine.acting is not None
    thinner = squeezed(sheet, mesh.inner, fine.nodes, fine.acting[1:-1, 1:-1])
    out[0, :, 0] = zz_u[:-1] + zz_l[:-1] + thinner
    out[0, :, 1] = -xz_u[:-1] - by_pressure * at_nodes
    out[0, :, 2] = xz_l[:-1] + by_pressure * at_nodes
    stretch, rise = by_pressure * pressed, sheared * (np.eye(n, k=1) - np.eye(n))
    out[1, :, 0] = _stretch(mesh, xz_u, zz_u, hoop_u) - stretch
    out[1, :, 1] = _stretch(mesh, xx_u, -xz_u, hoop_u) + rise / 3.0
    out[1, :, 2] = rise / 6.0
    out[2, :, 0] = stretch - _stretch(mesh, xz_l, zz_l, hoop_l)
    out[2, :, 1] = rise / 6.0
    out[2, :, 2] = _stretch(mesh, xx_l, -xz_l, hoop_l) + rise / 3.0
    last = n - 2  # surfaces stick up to a leading edge at the last node
    for side in (1, 2):
        out[side, last, side, last] *= 1.0 - CREEP_TO_EDGE
    return out.reshape(3 * n, 3 * n)


def _stretch(mesh: Mesh, u_x: Array, u_z: Array, hoop: float) -> Array:
    """Return int (du_x/dx - u_z/R) dx over the intervals, of displacements at nodes[1:]."""
    out = u_x[1:] - u_x[:-1]
    if hoop:
        means = mesh.fine.means
        assert means is not None
        dx = np.diff(mesh.fine.nodes[1:])[:, None]
        out = out - hoop * (mesh.sums(dx * means) @ u_z)
    return np.asarray(out)


def path_turns(mesh: Mesh) -> Array:
    """Return the change of a path's slope over each interval of nodes[1:] per height there, (n, N).

    The slope is that of a polynomial through the heights at the finer nodes: the path is as smooth
    as the sheet's bending stiffness makes it, and its curvature matters on the scale of the nip.
    """
    x, n = mesh.fine.nodes[1:-1], mesh.inner.size
    middle, half = 0.5 * (x[0] + x[-1]), 0.5 * (x[-1] - x[0])
    basis = legendre.legvander((x - middle) / half, _DEGREE)
    weighted = basis * np.gradient(x)[:, None]
    path = np.linalg.solve(weighted.T @ basis, weighted.T)  # least squares
    if mesh.fine.values is not None:
        path = path @ mesh.fine.values[1:-1, 1:]
    else:
        path = np.pad(path, ((0, 0), (0, 1)))
    of_slopes = legendre.legder(np.eye(_DEGREE + 1)) / half
    slopes = legendre.legvander((mesh.inner - middle) / half, _DEGREE - 1) @ of_slopes
    out = np.zeros((n, n + 1))  # the last interval lies outside
    out[:-1] = np.diff(slopes, axis=0) @ path
    return out
