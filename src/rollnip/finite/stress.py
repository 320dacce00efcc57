"""Stresses and strains inside a covering at finite strain, from a state of its mesh.

The Cauchy stress s is  J s = P F^T,  with the nominal stress P of `rollnip.finite.equilibrium`.
Along the axis, where nothing is stretched,  s_yy = G w_3/J + c,  w_3 = dw/dl3 at l3 = 1.

Components refer to the deformed lines of constant depth: x along such a line, z normal to it, into
the roller. So s_zz = -p and s_xz = -q at the surface at any strain, at a bond s_zz and s_xz are the
tractions that it carries, and at small strains all are the polar components of linear theory.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rollnip.finite.equilibrium import Body
from rollnip.finite.relaxing_stress import RelaxingStress
from rollnip.finite.state import MeshState
from rollnip.finite.strip import LINEAR, Array, Strip, below_radius, on_circle, quadratics
from rollnip.materials import Energy, NeoHookean

PARTS = ("u_x", "u_z", "s_xx", "s_zz", "s_xz", "s_yy", "e_xx", "e_zz", "e_xz", "energy")
"""The fields that `element_fields` returns, in this order."""
Masked = tuple[Energy, NDArray[np.bool_]]


@dataclass(frozen=True)
class _ElementMaterials:
    """Material of every element.

    Attributes
    ----------
    shear, lame, rest : (elements, 1) G, lambda and r.
    rigid : (elements, 1) whether incompressible.
    energies : the different strain energies, each with the mask of the elements that have it.
    """

    shear: Array
    lame: Array
    rigid: NDArray[np.bool_]
    rest: Array
    energies: list[Masked]

    @classmethod
    def of(cls, strip: Strip) -> _ElementMaterials:
        materials = [layer.material for layer in strip.depths.roller.layers]
        given = [material.energy or NeoHookean() for material in materials]
        different = list(dict.fromkeys(given))
        which = np.array([different.index(one) for one in given])[strip.layer]
        young = np.array([material.relaxed_modulus for material in materials])[strip.layer, None]
        nu = np.array([material.poisson for material in materials])[strip.layer, None]
        shear, rigid = 0.5 * young / (1.0 + nu), nu == 0.5
        lame = 2.0 * shear * nu / np.where(rigid, 1.0, 1.0 - 2.0 * nu)
        return cls(
            shear,
            lame,
            rigid,
            np.array([energy.rest for energy in given])[strip.layer, None],
            [(energy, which == place) for place, energy in enumerate(different)],
        )


def element_fields(
    body: Body, state: MeshState, along: Array, down: Array, near: float | None = None
) -> tuple[Array, Array]:
    """Return the fields of a state at the same points of every element.

    Parameters
    ----------
    body, state :
        a mesh and its equilibrium.
    along, down :
        (points,) coordinates in each element along the arc and over the depth, from -1 to 1.
    near :
        abscissa beyond which places grow with the angle [mm]. None: the state is that of linear
        theory; places are then undeformed arcs, and displacements the polar ones.

    Returns
    -------
    Present places (columns, rows, points) [mm]: x/(1 - z/R) with the undeformed depth z, at the
    surface x itself; beyond ``near`` they grow with the angle. ``rows`` are those of elements.

    Fields (parts, columns, rows, points), the parts named by `PARTS`: displacements along and into
    the roller [mm], u_x the turn about the axis times the undeformed radius; stresses [MPa];
    stretches along and across the deformed line of constant depth, less 1, and half the shear
    angle; strain energy per undeformed volume, with half the product of relaxing stress and strain
    [MPa].
    """
    strip, relaxing = body.strip, body.relaxing_stress(state)
    law = _ElementMaterials.of(strip)
    local = strip.local(state.displacement).reshape(-1, 2, 9).transpose(0, 2, 1)
    arc, depth, moved, hoop, inward = _deformed(strip, local, along, down)
    at = np.stack([along, down], axis=-1)
    c, stored = _volume_law(strip, law, state, at)
    held = None
    if relaxing is not None:
        held = _projected(strip, _relaxing_at_points(law, relaxing), at)
        c, stored = c + held[..., 3], stored + held[..., 5]
    stretch = np.hypot(hoop[..., 0], hoop[..., 1])
    tangent = hoop / stretch[..., None]
    normal = np.stack([-tangent[..., 1], tangent[..., 0]], axis=-1)
    ratio = hoop[..., 0] * inward[..., 1] - hoop[..., 1] * inward[..., 0]
    thinning = ratio / stretch
    stress, axial, energy = _stresses(law, (hoop, inward, ratio), c)
    if held is not None:
        stress += _push_forward(held, hoop, inward) / ratio[..., None]
        axial += held[..., 4] / ratio
    curvature = strip.depths.roller.curvature
    if near is None:
        place, u_x, u_z = arc, *_polar(curvature * arc, moved)
    else:
        place, u_x, u_z = _places(curvature, arc, depth, moved, near)
    parts = [
        u_x,
        u_z,
        _component(stress, tangent, tangent),
        _component(stress, normal, normal),
        _component(stress, tangent, normal),
        axial,
        stretch - 1.0,
        thinning - 1.0,
        0.5 * np.arctan2((inward * tangent).sum(axis=-1), thinning),
        energy + stored,
    ]
    shape = (strip.columns, strip.depths.row_layers.size, along.size)
    return place.reshape(shape), np.stack(parts).reshape(-1, *shape)


def _deformed(strip: Strip, local: Array, along: Array, down: Array) -> tuple[Array, ...]:
    """Return arcs, depths, displacements, and F on the unit vectors along and into the roller.

    The former two (elements, points) [mm], the others (elements, points, 2) with x and y.
    """
    (n_s, d_s), (n_z, d_z) = quadratics(along), quadratics(down)
    z, rows = strip.depths.ends, strip.depths.row_layers.size
    half_s = np.repeat(0.5 * np.diff(strip.ends), rows)[:, None]
    half_z = np.tile(0.5 * np.diff(z), strip.columns)[:, None]
    arc = np.repeat(strip.arcs[1::2], rows)[:, None] + half_s * along
    depth = np.tile(0.5 * (z[1:] + z[:-1]), strip.columns)[:, None] + half_z * down
    curvature = strip.depths.roller.curvature
    angle = curvature * arc
    way = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    moved, by_arc, by_depth = (
        (one[:, :, None] * other[:, None, :]).reshape(-1, 9) @ local
        for one, other in ((n_s, n_z), (d_s, n_z), (n_s, d_z))
    )
    hoop = way + by_arc / (half_s * (1.0 - curvature * depth))[..., None]
    inward = np.stack([-way[..., 1], way[..., 0]], axis=-1) + by_depth / half_z[..., None]
    return arc, depth, moved, hoop, inward


def _places(
    curvature: float, arc: Array, depth: Array, moved: Array, near: float
) -> tuple[Array, ...]:
    """Return present places, and displacements along and into the roller, zero at a rigid core."""
    shrink = 1.0 - curvature * depth
    x, y = on_circle(arc, curvature)
    x, y = x * shrink + moved[..., 0], depth + y * shrink + moved[..., 1]
    place = present_place(x, y, depth, (curvature, near))
    now = x if curvature == 0.0 else np.arctan2(curvature * x, 1.0 - curvature * y) / curvature
    return place, (now - arc) * shrink, below_radius(x, y, curvature) - depth


def present_place(x: Array, y: Array, depth: Array, circle: tuple[float, float]) -> Array:
    """Return the place x/(1 - z/R) of points (x, y) of undeformed depth z [mm].

    ``circle``: 1/R, and the abscissa beyond which the place grows with the angle instead.
    """
    curvature, near = circle
    if curvature == 0.0:
        return x
    angle, front = np.arctan2(curvature * x, 1.0 - curvature * y), min(curvature * near, 1.0)
    beyond = np.sign(angle) * (np.sin(front) + np.abs(angle) - front)
    turned = np.where(np.abs(angle) <= front, np.sin(angle), beyond)
    radius = np.hypot(x, 1.0 / curvature - y)
    return np.asarray(turned * radius / (1.0 - curvature * depth))


def _polar(angle: Array, moved: Array) -> tuple[Array, Array]:
    """Return the displacements along and into the undeformed roller."""
    cos, sin, x, y = np.cos(angle), np.sin(angle), moved[..., 0], moved[..., 1]
    return x * cos + y * sin, y * cos - x * sin


def _volume_law(
    strip: Strip, law: _ElementMaterials, state: MeshState, at: Array
) -> tuple[Array, Array]:
    """Return c of P = 2 G w_I F + (G w_J + c) cof F, and U, at points ``at`` (points, 2)."""
    basis = np.concatenate([np.ones((1, at.shape[0])), at.T])
    c = state.pressure @ basis - law.rest * law.shear
    if law.rigid.all():
        return c, np.zeros(c.shape)
    x_s, x_z, y_s, y_z = strip.deformation(state.displacement)
    ratio = x_s * y_z - x_z * y_s
    mean = strip.projected(ratio) @ LINEAR.T
    slope, stored = np.empty(mean.shape), np.empty(mean.shape)
    for energy, where in law.energies:
        slope[where] = energy.volume_slopes(mean[where], law.lame[where])[0]
        stored[where] = energy.volume_energy(mean[where], law.lame[where])
    soft = strip.projected(slope - law.rest * law.shear / mean) @ basis
    return np.where(law.rigid, c, soft), np.where(law.rigid, 0.0, strip.projected(stored) @ basis)


def _stresses(
    law: _ElementMaterials, deformed: tuple[Array, ...], c: Array
) -> tuple[Array, Array, Array]:
    """Return the Cauchy stress as xx, yy, xy, that along the axis, and psi less U."""
    hoop, inward, ratio = deformed
    left = np.stack(
        [
            hoop[..., 0] ** 2 + inward[..., 0] ** 2,
            hoop[..., 1] ** 2 + inward[..., 1] ** 2,
            hoop[..., 0] * hoop[..., 1] + inward[..., 0] * inward[..., 1],
        ],
        axis=-1,
    )
    spread = (hoop[..., 0] - inward[..., 1]) ** 2 + (hoop[..., 1] + inward[..., 0]) ** 2
    stress, axial, psi = np.empty(left.shape), np.empty(ratio.shape), np.empty(ratio.shape)
    for energy, where in law.energies:
        shear, volume, apart = law.shear[where], ratio[where], spread[where]
        slopes = energy.slopes(volume, apart)
        stress[where] = (2.0 * shear * slopes.i / volume)[..., None] * left[where]
        stress[where, :, :2] += (shear * slopes.j + c[where])[..., None]
        total, apart = np.sqrt(apart + 4.0 * volume), np.sqrt(apart)
        principal = np.stack([0.5 * (total + apart), 0.5 * (total - apart), np.ones_like(total)])
        axial[where] = shear * energy.principal(principal)[2] / volume + c[where]
        stored = energy.value(volume, spread[where]) - energy.rest * np.log1p(volume - 1.0)
        psi[where] = shear * stored
    return stress, axial, psi


def _relaxing_at_points(law: _ElementMaterials, relaxing: RelaxingStress) -> Array:
    """Return what relaxing stresses amount to at the Gauss points, (elements, 9, 6).

    The relaxing parts of T_ss, T_zz and T_sz, what is added to c, that of T_yy along the axis, and
    the energy.
    """
    x_s, x_z, y_s, y_z = relaxing.deformation
    volume, spread = x_s * y_z - x_z * y_s, (x_s - y_z) ** 2 + (x_z + y_s) ** 2
    total, apart = np.sqrt(spread + 4.0 * volume), np.sqrt(spread)
    principal = np.stack([0.5 * (total + apart), 0.5 * (total - apart), np.ones_like(total)])
    axial = np.empty(volume.shape)
    for energy, where in law.energies:
        third = energy.principal(principal[:, where])[2] - energy.rest
        axial[where] = law.shear[where] * third
    held = relaxing.stress
    along, across = 0.5 * (x_s**2 + y_s**2 - 1.0), 0.5 * (x_z**2 + y_z**2 - 1.0)
    work = held[..., 0] * along + held[..., 1] * across + held[..., 2] * (x_s * x_z + y_s * y_z)
    if relaxing.volume is not None:
        work = work + held[..., 3] * relaxing.volume[1]
    pressed = np.broadcast_to(relaxing.volume_law[0], volume.shape)
    axial = relaxing.memory.history_integral(axial[..., None])[..., 0]
    return np.stack([*np.moveaxis(held[..., :3], -1, 0), pressed, axial, 0.5 * work], axis=-1)


def _projected(strip: Strip, values: Array, at: Array) -> Array:
    """Return values at Gauss points, projected on linear functions, at points (points, 2)."""
    weighted, inverse = strip.projection
    basis = np.concatenate([np.ones((1, at.shape[0])), at.T])
    return np.asarray(basis.T @ (inverse @ (weighted @ values)))


def _push_forward(held: Array, hoop: Array, inward: Array) -> Array:
    """Return F T F^T as xx, yy, xy, of the relaxing parts of T."""
    ss, zz, sz = (held[..., part] for part in range(3))
    out = np.empty((*ss.shape, 3))
    for place, (i, j) in enumerate(((0, 0), (1, 1), (0, 1))):
        out[..., place] = ss * hoop[..., i] * hoop[..., j] + zz * inward[..., i] * inward[..., j]
        out[..., place] += sz * (hoop[..., i] * inward[..., j] + inward[..., i] * hoop[..., j])
    return out


def _component(stress: Array, one: Array, other: Array) -> Array:
    """Return one . s . other, with s given as xx, yy, xy."""
    mixed = one[..., 0] * other[..., 1] + one[..., 1] * other[..., 0]
    return np.asarray(
        stress[..., 0] * one[..., 0] * other[..., 0]
        + stress[..., 1] * one[..., 1] * other[..., 1]
        + stress[..., 2] * mixed
    )
