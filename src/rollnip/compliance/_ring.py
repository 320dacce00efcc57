"""Compliance of ring layers: the minors of two solutions, propagated from the core to the surface.

Harmonics exp(i n theta), n = k R >= 0; u_t = i U, u_r = -W, r s_rt = -i s, r s_rr = q, stresses in
units of 2 G.  With b = nu/(1-nu), m = 1 + b and ' = r d/dr the polar equations of a ring are

    U' = U + nW - 2s                    s' = -s + n (bq - mW - mnU)
    W' = -b (W + nU) - (1-b) q          q' = bq - ns - m (W + nU)

Their minors (see ``SurfaceState``), scaled by powers of h = max(n, 1) as

    det = h^2 (UW),  xz = h (Us) = -h (Wq),  xx = -h (Uq),  zz = h (Ws),  one = (sq),

obey a constant 5x5 system in t = h log r, given in ``_generator``, with the eigenvalues 0, +-2/h
and +-2n/h. With 1/h = 0 and n/h = 1 it is the system of the flat layer.
"""

from __future__ import annotations

from math import ceil, factorial, log1p
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from rollnip._errors import InvalidInputError, require_positive
from rollnip.compliance._flat import compliance_of
from rollnip.compliance._stack import Stack, checked_stack
from rollnip.compliance._types import (
    RIGID,
    FloatArray,
    SurfaceCompliance,
    SurfaceState,
    rescaled,
)

_DEEPEST = 400.0
"""Above this t the layer below has no effect in double precision: exp(-2 * 400) = 0."""
LARGEST_STEP = 0.5
"""Largest log ratio of radii in one step; it keeps the eigenvalues +-2 apart from large ones."""
_INVERSE_FACTORIALS = np.array([1.0 / factorial(n) for n in range(32)])
_FIRST_SERIES = np.stack([_INVERSE_FACTORIALS[f::2][:9] for f in (2, 3)])
"""Coefficients of x^(2j) in (cosh x - 1)/x^2 and (sinh x - x)/x^3, enough for x <= 1."""
_TERMS = 12
"""Number of terms of the series in ``symmetric_series``."""


def ring_compliance(
    k: ArrayLike,
    radius: float,
    thickness: ArrayLike,
    modulus: ArrayLike,
    poisson: ArrayLike,
) -> SurfaceCompliance:
    """Return the surface compliance of bonded ring layers on a rigid core in plane strain.

    The exact polar counterpart of ``flat_compliance``, to which it tends as thickness/radius -> 0
    (the difference is of first order in thickness/radius).  u_x = u_t, u_z = -u_r, t_x = s_rt and
    t_z = -s_rr at the outer radius; fields ~ exp(i n theta) = exp(i k x).

    Parameters
    ----------
    k :
        (n,) wave numbers n/radius [1/mm] along the outer surface, zero or positive, continuous.
    radius :
        outer radius [mm].
    thickness :
        (m,) layer thicknesses [mm], from the surface to the core, m >= 1, in sum below ``radius``.
    modulus :
        (m,) or (m, n) Young's moduli [MPa], real or complex.
    poisson :
        (m,) Poisson ratios in (-1, 0.5].

    Returns
    -------
    SurfaceCompliance
        (n,) complex arrays xx, zz, xz [mm/MPa].

    Raises
    ------
    InvalidInputError
        A wrong shape, a value out of range, layers not thinner than the radius.

    References
    ----------
    Polar equations of plane strain: Timoshenko & Goodier 1970, *Theory of Elasticity*, ch. 4.
    """
    stack = checked_ring(k, radius, thickness, modulus, poisson)
    wave = RingWave.of(stack.k * radius)
    state = climb_ring(stack, radius, wave)[0]
    return compliance_of(state, stack.twice_shear[0] * (wave.h / radius))


class RingWave(NamedTuple):
    """Quantities that depend on the harmonic alone.

    Attributes
    ----------
    n : harmonic, >= 0
    h : max(n, 1), the scale of wave numbers
    c : n/h
    e : 1/h
    """

    n: FloatArray
    h: FloatArray
    c: FloatArray
    e: FloatArray

    @classmethod
    def of(cls, n: FloatArray) -> RingWave:
        """Return the scales of the harmonics ``n``."""
        h = np.maximum(n, 1.0)
        return cls(n, h, n / h, 1.0 / h)


def checked_ring(
    k: ArrayLike, radius: float, thickness: ArrayLike, modulus: ArrayLike, poisson: ArrayLike
) -> Stack:
    """Return the checked and converted arguments of ring layers."""
    stack = checked_stack(k, thickness, modulus, poisson)
    require_positive("radius", radius)
    if stack.thickness.size == 0:
        raise InvalidInputError("`thickness` must have a layer when the core is rigid.")
    total = float(np.sum(stack.thickness))
    if total >= radius:
        raise InvalidInputError(
            f"`thickness` must be less in sum than the radius {radius!r}, got {total!r}."
        )
    return stack


def climb_ring(stack: Stack, radius: float, wave: RingWave) -> list[SurfaceState]:
    """Return the minors at the top of every layer (then the core), in units of the medium there."""
    outer = outer_radii(stack.thickness, radius)
    state = RIGID
    below = stack.twice_shear[-1]
    tops = [state]
    for i in reversed(range(stack.thickness.size)):
        state = rescaled(state, stack.twice_shear[i] / below)
        log_ratio = -log1p(-float(stack.thickness[i]) / outer[i])
        state = climb_ring_layer(state, log_ratio, float(stack.poisson[i]), wave)
        below = stack.twice_shear[i]
        tops.append(state)
    return tops[::-1]


def outer_radii(thickness: FloatArray, radius: float) -> list[float]:
    """Return the outer radius of each layer [mm]."""
    above = np.concatenate(([0.0], np.cumsum(thickness)[:-1]))
    return [float(radius - depth) for depth in above]


def climb_ring_layer(
    state: SurfaceState, log_ratio: float, poisson: float, wave: RingWave
) -> SurfaceState:
    """Return the minors at log(r/r_0) = ``log_ratio`` above ``state``, up to a factor.

    The medium in between is one layer.
    """
    steps = max(1, ceil(log_ratio / LARGEST_STEP))
    weights = _power_weights(np.minimum(wave.h * (log_ratio / steps), _DEEPEST), wave)
    generator = _generator(poisson, wave)
    for step in range(steps):
        state = _climb_step(rescaled(state, 1.0) if step else state, weights, generator)
    return state


def _climb_step(
    state: SurfaceState, weights: tuple[FloatArray, ...], generator: FloatArray
) -> SurfaceState:
    """Return exp(t L) state, as the sum of weights * L^j state, j = 0..4."""
    parts = [np.asarray(part) for part in state]
    is_complex = any(np.iscomplexobj(part) for part in parts)
    # Weights and L are real, so that real and imaginary parts of a state are propagated apart.
    power = np.empty((5, 2 if is_complex else 1, weights[0].size))
    for row, part in zip(power, parts, strict=True):
        row[0] = part.real
        if is_complex:
            row[1] = part.imag
    total = weights[0] * power
    for weight in weights[1:]:
        power = np.einsum("ijn,jqn->iqn", generator, power)
        total += weight * power
    climbed = total[:, 0] + 1j * total[:, 1] if is_complex else total[:, 0]
    return SurfaceState(*climbed)


def _generator(poisson: float, wave: RingWave) -> FloatArray:
    """Return L (5, 5, n), where d(state)/dt = L state for the scaled minors and t = h log r."""
    b = poisson / (1.0 - poisson)
    m = 1.0 / (1.0 - poisson)
    a = (1.0 - 2.0 * poisson) / (1.0 - poisson)  # 1 - b, exactly 0 at nu = 0.5
    c, e = wave.c, wave.e
    me, mee, mcc, mce = m * e, m * e * e, m * c * c, m * c * e
    out = np.zeros((5, 5, wave.n.size))
    det, xz, xx, zz, one = range(5)
    out[det, det], out[det, xx], out[det, zz] = a * e, a, 2.0
    out[xz, det], out[xz, xx], out[xz, zz] = -mce, -b * c, c
    out[xx, det], out[xx, xz], out[xx, xx], out[xx, one] = mee, 2.0 * c, me, 2.0
    out[zz, det], out[zz, xz], out[zz, zz], out[zz, one] = mcc, -2.0 * b * c, -me, a
    out[one, xz], out[one, xx], out[one, zz], out[one, one] = 2.0 * mce, mcc, mee, -a * e
    return out


def _power_weights(t: FloatArray, wave: RingWave) -> tuple[FloatArray, ...]:
    """Return the weights of L^0..L^4 in exp(t L) exp(-2t), L with eigenvalues 0, +-2, +-2 low.

    Newton interpolation of cosh and sinh in L^2: with x = 2 t low <= y = 2 t these are the divided
    differences [0, x^2], [0, x^2, y^2] of cosh sqrt and of sinh sqrt / sqrt, and L^5 = 4(1 + low^2)
    L^3 - 16 low^2 L.
    """
    low2 = (np.minimum(wave.n, 1.0) * wave.e) ** 2
    t2 = t * t
    decay = np.exp(-2.0 * t)
    x2 = 4.0 * t2 * low2
    even1, odd1 = _first_differences(x2)
    even2, odd2 = _second_differences(2.0 * t, x2, decay, even1, odd1)
    return (
        decay,
        t * (decay - 4.0 * t2 * x2 * odd2),
        t2 * (decay * even1 - x2 * even2),
        t * t2 * (decay * odd1 + 4.0 * t2 * odd2),
        t2 * t2 * even2,
    )


def _first_differences(x2: FloatArray) -> FloatArray:
    """Return (cosh x - 1)/x^2 and (sinh x - x)/x^3 for x <= 1, from their series, (2, n)."""
    powers = np.ones((_FIRST_SERIES.shape[1], x2.size))
    for j in range(1, len(powers)):
        np.multiply(powers[j - 1], x2, out=powers[j])
    return np.asarray(_FIRST_SERIES @ powers)


def _second_differences(
    y: FloatArray, x2: FloatArray, decay: FloatArray, even1: FloatArray, odd1: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return [0, x^2, y^2] of cosh sqrt and sinh sqrt / sqrt, times exp(-y).

    They hold for x <= 1 and x <= y.
    """
    thick = np.maximum(y, 2.0)
    span = 1.0 / (thick * thick - x2)
    even = (0.5 * (np.expm1(-y) / thick) ** 2 - decay * even1) * span
    odd = ((0.5 * (1.0 - decay * decay) - y * decay) / thick**3 - decay * odd1) * span
    thin = np.flatnonzero(y < 2.0)
    if thin.size:
        series = symmetric_series(x2[thin], y[thin] ** 2, (4, 5))
        even[thin], odd[thin] = (decay[thin] * part for part in series)
    return even, odd


def symmetric_series(
    x2: FloatArray, y2: FloatArray, firsts: tuple[int, ...]
) -> tuple[FloatArray, ...]:
    """Return sum H_j/(2j + f)! for each f of ``firsts``, H_j = sum of x^(2i) y^(2j-2i), i = 0..j.

    It is the divided difference between x^2 and y^2 of the tail of cosh sqrt (f even) or sinh sqrt
    / sqrt (f odd), complete to double precision for x <= y <= 2.
    """
    symmetric = np.ones((_TERMS, *x2.shape))
    power = np.ones_like(x2)
    for j in range(1, _TERMS):
        power *= x2
        np.multiply(symmetric[j - 1], y2, out=symmetric[j])
        symmetric[j] += power
    series = np.stack([_INVERSE_FACTORIALS[f::2][:_TERMS] for f in firsts])
    return tuple((series @ symmetric.reshape(_TERMS, -1)).reshape(-1, *x2.shape))
