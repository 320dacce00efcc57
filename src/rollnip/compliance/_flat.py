"""Compliance of flat layers: the minors of two solutions, propagated from the core to the surface.

With t = k (distance upwards), b = nu/(1-nu) and m = 1 + b = 1/(1-nu), the layer equations

    U' = W - 2s,  W' = -bU - (1-b)q,  s' = bq - mU,  q' = -s      (d/dt upwards)

(u_x = i U, u_z = W, and s_xz = i s, s_zz = q in units of 2 G k)
give for the minors (det, xz, xx, zz, one) of ``SurfaceState``

    det' = (1-b) xx + 2 zz          xx' = 2 xz + 2 one
    xz'  = zz - b xx                zz' = m det - 2b xz + (1-b) one
    one' = m xx

so that (xx + zz)'' = 4 (xx + zz) and (xx - zz)'' = 0: three positive functions of t solve it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from rollnip._errors import InvalidInputError
from rollnip.compliance._stack import Core, Stack, checked_core, checked_stack
from rollnip.compliance._types import (
    RIGID,
    Array,
    FloatArray,
    SurfaceCompliance,
    SurfaceState,
    half_space_state,
    rescaled,
)

_DEEPEST = 400.0
"""Above this k d the layer below has no effect in double precision: exp(-2 * 400) = 0."""
_SHALLOWEST = 1e-200
"""At this k d all powers that vanish as k -> 0 underflow to zero, which gives the exact limit."""


def flat_compliance(
    k: ArrayLike,
    thickness: ArrayLike,
    modulus: ArrayLike,
    poisson: ArrayLike,
    core_modulus: ArrayLike | None = None,
    core_poisson: float = 0.5,
) -> SurfaceCompliance:
    """Return the surface compliance of bonded flat layers in plane strain.

    One layer on a rigid core: C_zz = 2(1-nu^2)/(E k) (2K sinh 2kd - 4kd)/(2K cosh 2kd + 1 + K^2 +
    4k^2d^2), K = 3 - 4nu.  Stable for every k d, Poisson ratio and modulus contrast.

    Parameters
    ----------
    k :
        (n,) wave numbers [1/mm], positive.  k = 0 gives the limit k -> 0 on a rigid core.
    thickness :
        (m,) layer thicknesses [mm], from the surface to the core.  m = 0 with a half-space core.
    modulus :
        (m,) or (m, n) Young's moduli [MPa], real or complex.
    poisson :
        (m,) Poisson ratios in (-1, 0.5].
    core_modulus :
        None for a rigid core; scalar or (n,) Young's modulus [MPa] of a half-space core.
    core_poisson :
        Poisson ratio of the half-space core.

    Returns
    -------
    SurfaceCompliance
        (n,) complex arrays xx, zz, xz [mm/MPa]; (u_x, u_z) = C (t_x, t_z), z and t_z inwards.

    Raises
    ------
    InvalidInputError
        A wrong shape, a value out of range, no layer on a rigid core, k = 0 on a half-space.

    References
    ----------
    Layer equations: Johnson 1985, *Contact Mechanics*, 5.8.  Minors: Dunkin 1965, Bull. Seism. Soc.
    Am. 55, 335-358.
    """
    stack = checked_stack(k, thickness, modulus, poisson)
    core = checked_core(core_modulus, core_poisson, stack.k.size)
    require_finite_answer(stack, core)
    stack = stack._replace(k=floored(stack.k, stack.thickness, core))
    states = climb_flat(stack, core)
    surface_shear = stack.twice_shear[0] if stack.twice_shear else states.core_shear
    return compliance_of(states.tops[0], surface_shear * stack.k)


class FlatStates(NamedTuple):
    """Minors at the top of each layer (then of the core), each in units of the medium there."""

    tops: list[SurfaceState]
    core_shear: Array


def climb_flat(stack: Stack, core: Core | None) -> FlatStates:
    """Return the minors at the top of every layer, propagated from the core upwards."""
    state = RIGID if core is None else half_space_state(core.poisson)
    shear = np.asarray(1.0) if core is None else core.twice_shear
    below = shear
    tops = [state]
    for i in reversed(range(stack.thickness.size)):
        bottom = rescaled(state, stack.twice_shear[i] / below)
        state = climb_layer(bottom, stack.k * stack.thickness[i], float(stack.poisson[i]))
        below = stack.twice_shear[i]
        tops.append(state)
    return FlatStates(tops[::-1], shear)


def climb_layer(state: SurfaceState, t: FloatArray, poisson: float) -> SurfaceState:
    """Return the minors a distance t/k above ``state`` within one medium, times exp(-2t)."""
    b = poisson / (1.0 - poisson)
    m = 1.0 / (1.0 - poisson)
    a = (1.0 - 2.0 * poisson) / (1.0 - poisson)  # 1 - b, exactly 0 at nu = 0.5
    f = climbing_functions(t)
    slope_xx = 2.0 * (state.xz + state.one)
    slope_zz = m * state.det - 2.0 * b * state.xz + a * state.one
    level, slope = state.xx + state.zz, slope_xx + slope_zz
    common = level * f.sinh2 + slope * f.first
    area = level * f.first + slope * f.second
    # exp(-2t) times the value and the integral of the part linear in t
    t = f.t
    linear_xx = f.decay * (state.xx + t * slope_xx)
    linear_zz = f.decay * (state.zz + t * slope_zz)
    area_xx = 0.5 * t * (linear_xx + f.decay * state.xx)
    area_zz = 0.5 * t * (linear_zz + f.decay * state.zz)
    return SurfaceState(
        det=f.decay * state.det + a * area_xx + 2.0 * area_zz + (3.0 - b) * area,
        xz=f.decay * state.xz + area_zz - b * area_xx + a * area,
        xx=linear_xx + common,
        zz=linear_zz + common,
        one=f.decay * state.one + m * (area_xx + area),
    )


class ClimbingFunctions(NamedTuple):
    """t (bounded), exp(-2t) and, times exp(-2t), sinh^2 t and its first and second integrals."""

    t: FloatArray
    decay: FloatArray
    sinh2: FloatArray
    first: FloatArray
    second: FloatArray


def climbing_functions(t: FloatArray) -> ClimbingFunctions:
    """Return sinh^2 t, (sinh 2t - 2t)/4 and (sinh^2 t - t^2)/4, all times exp(-2t), for t >= 0."""
    t = np.minimum(t, _DEEPEST)
    decay = np.exp(-2.0 * t)
    sinh2 = 0.25 * np.expm1(-2.0 * t) ** 2
    first = 0.125 * (1.0 - decay * decay) - 0.5 * t * decay
    second = 0.25 * (sinh2 - t * t * decay)
    thin = t < 0.5
    if np.any(thin):
        y = t[thin]
        x2 = 4.0 * y * y
        first[thin] = decay[thin] * y * y * y / 3.0 * _nested(x2, first_factor=4)
        second[thin] = decay[thin] * (y * y) ** 2 / 12.0 * _nested(x2, first_factor=5)
    return ClimbingFunctions(t, decay, sinh2, first, second)


def _nested(x2: FloatArray, first_factor: int) -> FloatArray:
    """Return 1 + x2/(j(j+1)) (1 + x2/((j+2)(j+3)) (1 + ...)), j the first factor; x2 <= 1."""
    total = np.ones_like(x2)
    for j in range(first_factor + 14, first_factor - 1, -2):
        total = 1.0 + total * x2 * (1.0 / (j * (j + 1)))
    return total


def compliance_of(state: SurfaceState, stress_unit: Array) -> SurfaceCompliance:
    """Return the compliance from the minors; ``stress_unit`` = 2 G k [MPa/mm].

    C_xz = i D_xz for k > 0.
    """
    scale = 1.0 / (stress_unit * state.one)
    return SurfaceCompliance(
        xx=np.asarray(state.xx * scale, dtype=complex),
        zz=np.asarray(state.zz * scale, dtype=complex),
        xz=np.asarray(1j * (state.xz * scale), dtype=complex),
    )


def half_space_limit(modulus: ArrayLike, poisson: float) -> tuple[Array, Array]:
    """Return the coefficients A, B of a half-space: C_xx = C_zz = A/k, C_xz = i B/k for k > 0.

    A = 2(1-nu^2)/E, B = (1+nu)(1-2nu)/E (Johnson 1985, 2.7).

    Parameters
    ----------
    modulus :
        Young's modulus [MPa], real or complex, scalar or array.
    poisson :
        Poisson ratio in (-1, 0.5].

    Returns
    -------
    tuple
        (A, B) [1/MPa], of the shape of ``modulus``.

    Raises
    ------
    InvalidInputError
        A modulus that is zero or not finite, a Poisson ratio out of range.
    """
    young = np.asarray(modulus)
    core = checked_core(young.ravel(), poisson, young.size)
    assert core is not None
    shear = core.twice_shear.reshape(young.shape)
    return 2.0 * (1.0 - poisson) / shear, (1.0 - 2.0 * poisson) / shear


def floored(k: FloatArray, thickness: FloatArray, core: Core | None) -> FloatArray:
    """Return wave numbers kept so far from 0 that 0/0 never occurs; the limit is still exact."""
    if core is not None or k.size == 0:
        return k
    return np.maximum(k, _SHALLOWEST / np.sum(thickness))


def require_finite_answer(stack: Stack, core: Core | None) -> None:
    """Refuse a bare rigid core, and k = 0 on a half-space, whose displacement is infinite."""
    if core is None and stack.thickness.size == 0:
        raise InvalidInputError("`thickness` must have a layer when the core is rigid.")
    if core is not None and np.any(stack.k == 0.0):
        raise InvalidInputError("`k` must be positive when the core is a half-space, got 0.")
