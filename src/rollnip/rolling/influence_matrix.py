"""The influence matrix of a contact problem, from the displacements of both surfaces."""

from __future__ import annotations

import numpy as np

from rollnip.contact import Subdivision, left_out_of_creep, left_out_of_tractions
from rollnip.contact.problem import Array


def unit_tractions(fine: Subdivision) -> Array | None:
    """Return what acts at the finer nodes[1:-1] per traction at nodes[1:-1] of the mesh.

    Behind the columns of nodal tractions stand those that they leave out beside the edges and
    transitions of unlike surfaces, the real parts and then the imaginary parts of
    `left_out_of_tractions`. None where nothing is subdivided: each traction acts at its node.
    """
    if fine.acting is None:
        return None
    unit = fine.acting[1:-1, 1:-1]
    ends = fine.unlike_ends
    if not ends:
        return unit
    left_out = np.zeros((unit.shape[0], len(ends)), dtype=complex)
    for column, (node, kappa, inwards) in zip(left_out.T, ends, strict=True):
        beside = left_out_of_tractions(kappa, fine.pieces)
        column[fine.pieces * node + inwards * np.arange(beside.size)] = beside
    return np.concatenate([unit, left_out.real, left_out.imag], axis=1)


def influence_matrix(fine: Subdivision, per_traction: Array, shortening: Array | None) -> Array:
    """Return `ContactProblem.influence`: gap and creep per nodal traction (theory section 5).

    The creep of an interval is int (du_x/dx - u_z/R) dx of the upper minus that of the lower
    surface. The pressure is the same on both surfaces, the shear opposite.

    Parameters
    ----------
    per_traction : (3, N, columns) displacements zz, xz, xx of both surfaces together at nodes[1:],
        per `unit_tractions`.
    shortening : (N, 2 (N-1)) see `hoop_shortening`; None: 0.
    """
    n = per_traction.shape[1] - 1
    out = np.zeros((2 * n, 2 * n))
    out[:n, :n] = per_traction[0, :-1, :n]
    _, xz, xx = per_traction[:, :, :n]
    np.negative(xz[:-1], out=out[:n, n:])
    np.subtract(xz[1:], xz[:-1], out=out[n:, :n])
    np.subtract(xx[1:], xx[:-1], out=out[n:, n:])
    if shortening is not None:
        out[n:] -= fine.integrated(shortening)
    _correct_creep_to_edges(fine, out)
    _add_left_out(fine, per_traction, out)
    return out


def _correct_creep_to_edges(fine: Subdivision, out: Array) -> None:
    """Take from the creep in the elements at leading edges what `left_out_of_creep` says."""
    n = len(out) // 2
    for edge in fine.edges[1::2]:
        node = edge - 1
        creep = out[n + node]
        rho = left_out_of_creep(fine.exponent_at(edge), fine.pieces) * creep[n + node]
        creep[node] -= rho.imag
        creep[n + node] -= rho.real


def _add_left_out(fine: Subdivision, per_traction: Array, out: Array) -> None:
    """Add what the nodal tractions beside the edges and transitions of unlike surfaces leave out.

    If D z acts, with z = p + i q at one node and D complex, the gap that it makes is the real part
    of (zz + i xz) D z, and its creep the real part of the change of (xz - i xx) D z. What is left
    out is in proportion to the difference of z from the end of a zone to the first node inside.
    """
    n, ends = len(out) // 2, fine.unlike_ends
    if not ends:
        return
    zz, xz, xx = per_traction[:, :, n : n + len(ends)] + 1j * per_traction[:, :, n + len(ends) :]
    gap, shift = zz + 1j * xz, xz - 1j * xx
    by_traction = np.concatenate([gap[:-1], shift[1:] - shift[:-1]])
    for (node, _, inwards), column in zip(ends, by_traction.T, strict=True):
        for one, sign in ((node + inwards, 1.0), (node, -1.0)):
            out[:, one] += sign * column.real
            out[:, n + one] -= sign * column.imag


def hoop_shortening(per_traction: Array, hoops: tuple[float, float]) -> Array | None:
    """Return u_z/R of the upper minus the lower surface, per pressure and per shear; None: 0.

    Parameters
    ----------
    per_traction : (6, N, N-1) as in `Mesh`.
    hoops : 1/R of both surfaces where their layers are rings [1/mm].
    """
    if not any(hoops):
        return None
    _, zz_u, xz_u, _, zz_l, xz_l = per_traction
    by_pressure = hoops[0] * zz_u - hoops[1] * zz_l
    return np.concatenate([by_pressure, -hoops[0] * xz_u - hoops[1] * xz_l], axis=1)
