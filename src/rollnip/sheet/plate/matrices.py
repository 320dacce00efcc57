"""Influence matrix of a plate: gaps and creeps of both interfaces per unit traction on each."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import left_out_of_creep
from rollnip.rolling.surfaces import Mesh
from rollnip.sheet.friction import SIDE_SIGNS
from rollnip.sheet.plate.interface import stretch_by
from rollnip.sheet.plate.loads import PiecewiseLoads, moments_about
from rollnip.sheets import Sheet

Array = NDArray[np.float64]
Pair = tuple[Array, Array]
"""Values of the upper and of the lower interface."""
_STEEP = 4.0  # exponent of the blend between exact and lumped integrals of the tension


def influence_matrices(
    meshes: tuple[Mesh, Mesh],
    loads: tuple[PiecewiseLoads, PiecewiseLoads],
    arcs: tuple[Array, Array],
) -> tuple[Array, Array]:
    """Return gaps and creeps, and rotations of the sheet, per unit traction.

    ``loads``, ``arcs``: see `PlateProblem`.

    Returns
    -------
    (r, r) gap and creep of the upper, then of the lower interface; and (m, r) rotation of the
    sections at nodes[1:] of both meshes; both per p_u, q_u, p_l and q_l.
    """
    by_rollers = [_by_roller(mesh, at) for at, mesh in enumerate(meshes)]
    n, m = (mesh.inner.size for mesh in meshes)
    x = np.concatenate([mesh.nodes[1:] for mesh in meshes])
    is_upper = np.arange(x.size) <= n
    tails = [one.tail_moments_at(x) for one in loads]
    faces = [
        one.face_displacements(x, is_upper == by, tail)
        for by, (one, tail) in enumerate(zip(loads, tails, strict=True))
    ]
    by_shears = [_changes(shifted) for _, shifted, _ in faces]
    above = np.diagonal(by_rollers[0][n:, n:]) + np.diagonal(by_shears[0][:n])
    below = np.diagonal(by_rollers[1][m:, m:]) + np.diagonal(by_shears[1][n + 1 :])
    own = np.concatenate([above, [-1.0], below])
    rows, places = (slice(n), slice(n + 1, None)), (slice(2 * n), slice(2 * n, None))
    matrix = np.empty((2 * (n + m), 2 * (n + m)))
    turned = np.empty((x.size, 2 * (n + m)))
    for by, columns in enumerate(places):
        made, turned[:, columns] = _by_sheet(
            meshes, (loads[by], arcs[by]), by, own, (tails[by], faces[by][0], faces[by][2])
        )
        made[1, :, 1] += by_shears[by]
        for at, block in enumerate((matrix[: 2 * n, columns], matrix[2 * n :, columns])):
            block[:] = made[:, rows[at]].reshape(block.shape)
            if at == by:
                block += by_rollers[at]
                block[-2, -2] *= 1.0 - left_out_of_creep(0j).real
    return matrix, turned


def _by_roller(mesh: Mesh, side: int) -> Array:
    """Return gap and creep of one interface due to its own roller, (2 n, 2 n) [mm/MPa]."""
    n, sign = mesh.inner.size, SIDE_SIGNS[side]
    xx, zz, xz = mesh.per_traction[3 * side : 3 * side + 3]
    out = np.zeros((2 * n, 2 * n))
    out[:n, :n] = zz[:-1]
    out[:n, n:] = -sign * xz[:-1]
    out[n:, :n] = sign * stretch_by(mesh, side, xz, zz)
    out[n:, n:] = stretch_by(mesh, side, xx, -xz)
    return out


def _by_sheet(
    meshes: tuple[Mesh, Mesh],
    tractions: tuple[PiecewiseLoads, Array],
    by: int,
    own: Array,
    known: tuple[Array, Array, Array],
) -> tuple[Array, Array]:
    """Return gaps and creeps due to the sheet, loaded on one interface.

    Without the tangential displacements of its faces by shears, see
    `PiecewiseLoads.face_displacements`.

    Parameters
    ----------
    tractions : ``loads`` and ``arcs`` of the interface ``by``, see `PlateProblem`.
    by : the loaded interface, 0 the upper and 1 the lower.
    own : (m - 1,) see `_lumped_share`.
    known : tail moments of the loads at the places, and the displacements of the faces by pressures
        towards the middle and tangentially.

    Returns
    -------
    (2, m - 1, 2, n) gaps at nodes[1:] of both meshes, m places in all, except the last, and creeps
    up to the next place, per pressure and shear; the entry between the two meshes is meaningless.
    And (m, 2 n) rotations of the sections at the places.
    """
    loads, arcs = tractions
    sheet, half, there = loads.sheet, 0.5 * loads.sheet.thickness, SIDE_SIGNS[by]
    x = np.concatenate([mesh.nodes[1:] for mesh in meshes])
    is_far = (np.arange(x.size) < meshes[0].nodes.size - 1) == by
    here = np.where(is_far[:-1], -there, there)[:, None]
    signs = here * there
    tails, indented, warped = known
    height, slope, bend = loads.deflection(x, tails)
    out = np.empty((2, x.size - 1, 2, loads.lines.shape[1]))
    # y is driven by -p_u and +p_l; the upper gap contains -y, the lower one +y
    out[0, :, 0] = signs * height[:-1] + indented[:-1]
    out[0, :, 1] = half * here * slope[:-1] - there * arcs * warped[:-1]
    out[1, :, 0] = here * _changes(warped)
    out[1, :, 0] -= there * half * _changes(slope)
    pulled = arcs * _changes(moments_about(x, tails, 1))
    exact = _stretched(sheet, signs, pulled, _changes(bend))
    share = _lumped_share(sheet, np.diff(x), own)
    if share.any():
        ahead = meshes[by].inner - x[:, None]
        bends = loads.plate.curvature(ahead)
        lumped = _stretched(sheet, signs, _changes(np.maximum(ahead, 0.0)), _changes(bends))
        exact += share * (arcs * loads.total * lumped - exact)
    out[1, :, 1] = exact
    return out, np.concatenate([-there * slope, -half * bend], axis=1)


def _changes(values: Array) -> Array:
    return np.asarray(values[1:] - values[:-1])


def _stretched(sheet: Sheet, signs: Array, tails: Array, bends: Array) -> Array:
    """Return the creep by the strain of a face under shears: tension, and bending by couples."""
    stretched = -signs * sheet.stretch_by_tension * tails
    return np.asarray(stretched - 0.25 * sheet.thickness**2 * bends)


def _lumped_share(sheet: Sheet, dx: Array, own: Array) -> Array:
    """Return the share of each interval that takes shears as forces at their nodes, (k, 1).

    Where a node's shear stretches its interval more through the sheet's tension and bending than
    through the roller, ``own``, exact integration lets the shears of neighbouring nodes alternate
    and grow.
    """
    strain = 4.0 * sheet.stretch_by_tension
    ratio = strain * dx**2 / (6.0 * np.abs(own))
    share = 1.0 / (1.0 + np.clip(ratio, 1e-9, 1e6) ** -_STEEP)
    return np.asarray(np.where(share > 1e-12, share, 0.0)[:, None])
