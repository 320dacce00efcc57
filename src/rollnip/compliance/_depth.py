"""Fields inside the layers under given surface tractions, in the Fourier domain.

From the surface down, the tractions at the bottom of a ply follow from those at its top by the
inverse of a 2x2 matrix, whose determinant is known exactly from the minors.  Inside a ply that is
thick compared with the wavelength, the part that decays from the top and the part that decays from
the bottom are kept apart; no growing exponential is formed.
"""

from __future__ import annotations

from math import ceil, inf, isinf, log1p
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from rollnip._errors import InvalidInputError
from rollnip.compliance._flat import climb_flat, floored
from rollnip.compliance._propagator import (
    Weights,
    basis_of,
    generator,
    hoop_stress,
    parts_of,
    thick_weights,
    thin_weights,
)
from rollnip.compliance._ring import LARGEST_STEP, RingWave, climb_ring, outer_radii
from rollnip.compliance._stack import Core, Stack
from rollnip.compliance._types import (
    Array,
    ComplexArray,
    FloatArray,
    SurfaceState,
    rescaled,
)

Side = Literal["above", "below"]
_THIN = 1.0
"""Up to this t a ply is integrated from its top; above it, decaying parts are kept apart."""
_DEEPEST = 400.0
_SAME_DEPTH = 1e-12
"""Relative distance below which a depth is taken as that of the interface."""


class Ply(NamedTuple):
    """One medium between two depths; a half-space core is a ply of infinite length.

    Attributes
    ----------
    top, bottom : depths [mm]
    outer, inner : radii [mm], inf where flat
    length : log(outer/inner), or bottom - top [mm] where flat
    twice_shear : 2 G [MPa]
    poisson : Poisson ratio
    """

    top: float
    bottom: float
    outer: float
    inner: float
    length: float
    twice_shear: Array
    poisson: float


class LayeredBody(NamedTuple):
    """The plies, the minors at the top of each (then of the core), and the wave numbers."""

    plies: list[Ply]
    tops: list[SurfaceState]
    wave: RingWave
    bottom: float


def flat_body(stack: Stack, core: Core | None) -> LayeredBody:
    """Return the body of flat layers, on a half-space if ``core`` is given."""
    k = floored(stack.k, stack.thickness, core)
    bounds = np.concatenate(([0.0], np.cumsum(stack.thickness)))
    plies = [
        Ply(bounds[i], bounds[i + 1], inf, inf, float(d), stack.twice_shear[i], stack.poisson[i])
        for i, d in enumerate(stack.thickness)
    ]
    if core is not None:
        plies.append(Ply(bounds[-1], inf, inf, inf, inf, core.twice_shear, core.poisson))
    tops = climb_flat(stack._replace(k=k), core).tops
    wave = RingWave(n=k, h=k, c=np.ones_like(k), e=np.zeros_like(k))
    return LayeredBody(plies, tops, wave, inf if core is not None else float(bounds[-1]))


def ring_body(stack: Stack, radius: float) -> LayeredBody:
    """Return the body of ring layers, with thick layers divided into plies."""
    stack = _cut(stack, radius)
    wave = RingWave.of(stack.k * radius)
    bounds = np.concatenate(([0.0], np.cumsum(stack.thickness)))
    outer = [*outer_radii(stack.thickness, radius), radius - float(bounds[-1])]
    plies = [
        Ply(
            bounds[i],
            bounds[i + 1],
            outer[i],
            outer[i + 1],
            -log1p(-float(d) / outer[i]),
            stack.twice_shear[i],
            stack.poisson[i],
        )
        for i, d in enumerate(stack.thickness)
    ]
    return LayeredBody(plies, climb_ring(stack, radius, wave), wave, float(bounds[-1]))


def _cut(stack: Stack, radius: float) -> Stack:
    """Return layers divided into plies of equal log ratio, at most the step of ring recursion."""
    thickness: list[float] = []
    source: list[int] = []
    for i, (outer, d) in enumerate(
        zip(outer_radii(stack.thickness, radius), stack.thickness, strict=True)
    ):
        log_ratio = -log1p(-float(d) / outer)
        pieces = max(1, ceil(log_ratio / LARGEST_STEP))
        radii = outer * np.exp(-log_ratio / pieces * np.arange(pieces + 1))
        cut = [float(d)] if pieces == 1 else [float(r) for r in -np.diff(radii)]
        thickness.extend(cut)
        source.extend([i] * pieces)
    shear = [stack.twice_shear[i] for i in source]
    return Stack(stack.k, np.array(thickness), shear, stack.poisson[source])


def checked_depths(z: ArrayLike, bottom: float) -> FloatArray:
    """Return depths (nz,) [mm] within the body; put those below it by rounding on its bottom."""
    depth = np.asarray(z, dtype=float)
    if depth.ndim != 1 or not np.all((depth >= 0.0) & (depth < inf)):
        raise InvalidInputError("`z` must be one-dimensional, zero or positive and finite.")
    if np.any(depth > bottom * (1.0 + _SAME_DEPTH)):
        deepest = float(depth.max())
        raise InvalidInputError(f"`z` must not exceed the bottom {bottom!r}, got {deepest!r}.")
    return np.asarray(np.minimum(depth, bottom))


def fields_at_depth(
    body: LayeredBody, z: FloatArray, t_x: ComplexArray, t_z: ComplexArray, side: Side
) -> ComplexArray:
    """Return u_x, u_z, s_xx, s_zz, s_xz at depths ``z`` under tractions (q, n), (5, q, nz, n)."""
    amplitudes = amplitudes_at_depth(body, z, np.stack((1j * t_x, t_z)), side)
    out = np.ascontiguousarray(amplitudes.transpose(2, 3, 1, 0))
    out[0] *= 1j
    out[4] *= 1j
    return out


def amplitudes_at_depth(body: LayeredBody, z: FloatArray, traction: Array, side: Side) -> Array:
    """Return U, u_z, s_xx, s_zz, S at depths ``z``, (n, nz, 5, q), where u_x = i U, s_xz = i S.

    They are per the tractions (i t_x, t_z) of shape (2, q, n), and real where these and all moduli
    are real.
    """
    owner = _owners(body, z, side)
    dtype = np.result_type(traction, *(ply.twice_shear for ply in body.plies))
    out = np.zeros((traction.shape[2], z.size, 5, traction.shape[1]), dtype=dtype)
    radius = body.plies[0].outer
    unit = body.plies[0].twice_shear * body.wave.h / (1.0 if isinf(radius) else radius)
    traction = np.stack((traction[0] / unit, -traction[1] / unit))
    for i, ply in enumerate(body.plies[: 1 + int(owner.max(initial=0))]):
        top = _state_vector(body.tops[i], traction)
        bottom = None
        if not isinf(ply.length):
            below = body.plies[i + 1].twice_shear if i + 1 < len(body.plies) else ply.twice_shear
            ratio = ply.twice_shear / below
            foot = rescaled(body.tops[i + 1], ratio)
            traction = _traction_below(foot, body.tops[i], traction, ply, body.wave)
            bottom = _state_vector(foot, traction)
            traction = traction * ratio
        rows = np.flatnonzero(owner == i)
        if rows.size:
            _fill(out, rows, z[rows], ply, body.wave, (top, bottom))
    return out


def _owners(body: LayeredBody, z: FloatArray, side: Side) -> Array:
    """Return the index of the ply at each depth; on an interface, the one on the given side."""
    if side not in ("above", "below"):
        raise InvalidInputError(f"`side` must be 'above' or 'below', got {side!r}.")
    bounds = np.array([ply.bottom for ply in body.plies])
    slack = _SAME_DEPTH * np.where(np.isinf(bounds), 0.0, bounds)
    if side == "above":
        owner = np.searchsorted(bounds + slack, z, side="left")
    else:
        owner = np.searchsorted(bounds - slack, z, side="right")
    return np.minimum(owner, len(body.plies) - 1)


def _state_vector(state: SurfaceState, traction: Array) -> Array:
    """Return y = (U, W, s, q) with (U, W) = -D (s, q): shape (4, q, n)."""
    shear, normal = traction
    along = -(state.xx * shear + state.xz * normal) / state.one
    inward = -(state.xz * shear + state.zz * normal) / state.one
    return np.stack((along, inward, shear, normal))


def _traction_below(
    foot: SurfaceState, head: SurfaceState, traction: Array, ply: Ply, wave: RingWave
) -> Array:
    """Return (s, q) at the bottom of a ply from those at its top.

    (s, q)_top = Q (s, q)_bottom, det Q exp(-2t) = ``head.one`` / ``foot.one``, the latter 1.
    """
    t = np.minimum(wave.h * ply.length, _DEEPEST)
    units = np.zeros((2, 2, t.size))
    units[0, 0] = units[1, 1] = 1.0
    parts = basis_of(_state_vector(foot, units), ply.poisson, wave)
    weights = _scaled_weights(t, wave)
    stresses = [weight * part[2:] for weight, part in zip(weights, parts, strict=True)]
    (ss, sq), (qs, qq) = stresses[0] + stresses[1] + stresses[2] + stresses[3]
    factor = np.exp(-t) / head.one
    shear, normal = traction
    return np.stack((factor * (qq * shear - sq * normal), factor * (ss * normal - qs * shear)))


def _scaled_weights(t: FloatArray, wave: RingWave) -> list[FloatArray]:
    """Return the weights of exp(t M) exp(-t), for any t."""
    thin = t <= _THIN
    small = thin_weights(np.minimum(t, _THIN), wave)
    decay = np.exp(-t)
    if np.all(thin):
        return [decay * part for part in small]
    deep = wave._replace(e=np.minimum(wave.e, 0.5))
    large = thick_weights(np.maximum(t, _THIN), deep)
    return [np.where(thin, decay * s, g) for s, g in zip(small, large, strict=True)]


def _fill(
    out: Array,
    rows: Array,
    z: FloatArray,
    ply: Ply,
    wave: RingWave,
    ends: tuple[Array, Array | None],
) -> None:
    """Write the fields at depths ``z`` of one ply into the rows of ``out``."""
    top, bottom = ends
    thin = wave.h * ply.length <= _THIN
    scale = ply.twice_shear * wave.h
    for columns in (np.flatnonzero(thin), np.flatnonzero(~thin)):
        if columns.size == 0:
            continue
        part = RingWave(*(value[columns] for value in wave))
        head = top.take(columns, axis=-1)  # top[..., columns] would be stored column by column
        if thin[columns[0]]:
            terms = _thin_terms(z, ply, part, head)
        else:
            foot = None if bottom is None else bottom.take(columns, axis=-1)
            terms = _thick_terms(z, ply, part, head, foot)
        unit = scale[columns]
        out[columns[:, None], rows] = _combined(terms, ply, part, unit, z)


Terms = list[tuple[FloatArray, Array]]
"""Pairs of a function (nz, n) of depth and wave number and its coefficients y (4, q, n)."""


def _thin_terms(z: FloatArray, ply: Ply, wave: RingWave, top: Array) -> Terms:
    """Return the terms of y(z) = exp(-t M) y(top)."""
    t = wave.h * _distance(z - ply.top, ply.outer)[:, None]
    weights: Weights = thin_weights(t, wave)
    y, zy, my, zmy = basis_of(top, ply.poisson, wave)
    return [(weights.even, y), (weights.even_z, zy), (weights.odd, -my), (weights.odd_z, -zmy)]


def _thick_terms(
    z: FloatArray, ply: Ply, wave: RingWave, top: Array, bottom: Array | None
) -> Terms:
    """Return the terms of y(z) for a ply so thick that top and bottom hardly affect each other.

    exp(-ct) [cosh et + sinh(et)/e (c - M)] times the part of y(top) that decays with depth, and the
    mirror image times the part of y(bottom) that decays upwards.
    """
    terms: Terms = []
    matrix = generator(ply.poisson, wave)
    for end, inwards in ((top, 1.0), (bottom, -1.0)):
        if end is None:
            continue
        sign, once, size = parts_of(end, matrix, wave)
        if bottom is None:  # a half-space: nothing comes from below
            part, moved = end, once
        else:
            part, moved = 0.5 * (end + inwards * sign), 0.5 * (once + inwards * size)
        below = z - ply.top if inwards > 0.0 else z - ply.bottom
        distance = inwards * _distance(below, ply.outer if inwards > 0.0 else ply.inner)
        level, lever = _decay_functions(distance, ply, wave)
        terms += [(level, part), (lever, wave.c * part - inwards * moved)]
    return terms


def _distance(below: FloatArray, radius: float) -> FloatArray:
    """Return the ply's coordinate distance from its edge at ``radius`` to points ``below`` it."""
    return below if isinf(radius) else -np.log1p(-below / radius)


def _decay_functions(
    distance: FloatArray, ply: Ply, wave: RingWave
) -> tuple[FloatArray, FloatArray]:
    """Return exp(-ct) cosh(et) and exp(-ct) sinh(et)/e at t = h distance, (nz, n)."""
    column = distance[:, None]
    decay = np.exp(-(wave.c * wave.h) * column)
    if isinf(ply.outer):
        return decay, decay * (wave.h * column)
    return decay * np.cosh(column), decay * (wave.h * np.sinh(column))


def _combined(terms: Terms, ply: Ply, wave: RingWave, unit: Array, z: FloatArray) -> Array:
    """Return the sum of the terms for U, u_z, s_xx, s_zz, S, (n, nz, 5, q)."""
    functions = np.stack([function for function, _ in terms], axis=-1).transpose(1, 0, 2)
    parts = [
        (y[0], y[1], hoop_stress(y, ply.poisson, wave) * unit, y[3] * unit, y[2] * unit)
        for _, y in terms
    ]
    coefficients = np.ascontiguousarray(np.array(parts).transpose(3, 0, 1, 2))
    n, _, _, q = coefficients.shape
    # The functions are real, so that complex coefficients count as twice as many real ones.
    columns = coefficients.reshape(n, len(terms), -1).view(float)
    fields: Array = (functions @ columns).view(coefficients.dtype).reshape(n, z.size, 5, q)
    if not isinf(ply.outer):  # the stresses were multiplied by the radius
        radii = np.ones((z.size, 5, q))
        radii[:, 2:] = (ply.outer - (z - ply.top))[:, None, None]
        fields /= radii
    return fields
