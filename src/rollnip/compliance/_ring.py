"""Compliance of curved layers: the minors of a ring, climbed from the core to the surface.

Harmonics exp(i n theta), n = k R >= 0; u_t = i U, u_r = -W, r s_rt = -i s, r s_rr = q, stresses in
units of 2 G.  With b = nu/(1-nu), m = 1 + b and ' = r d/dr the polar equations of a ring are

    U' = U + nW - 2s                    s' = -s + n (bq - mW - mnU)
    W' = -b (W + nU) - (1-b) q          q' = bq - ns - m (W + nU)

Their minors (theory of ``SurfaceState``), scaled by powers of h = max(n, 1) as

    det = h^2 (UW),  xz = h (Us) = -h (Wq),  xx = -h (Uq),  zz = h (Ws),  one = (sq),

obey a constant 5x5 system in t = h log r, written in ``_slope``: eigenvalues 0, +-2/h, +-2n/h.
With 1/h = 0 and n/h = 1 it is that of the flat layer.
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
"""Beyond this t the layer below is invisible in double precision: exp(-2 * 400) = 0."""
LARGEST_STEP = 0.5
"""Largest log ratio of radii climbed at once; keeps the eigenvalues +-2 apart from large ones."""


def ring_compliance(
    k: ArrayLike,
    radius: float,
    thickness: ArrayLike,
    modulus: ArrayLike,
    poisson: ArrayLike,
) -> SurfaceCompliance:
    """Surface compliance of bonded ring layers on a rigid core in plane strain.

    The exact polar counterpart of ``flat_compliance``, which it approaches as thickness/radius -> 0
    (difference of first order in thickness/radius).  u_x = u_t, u_z = -u_r, t_x = s_rt and
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
    """Numbers that depend on the harmonic alone.

    Attributes
    ----------
    n : harmonic, >= 0
    h : max(n, 1), the scale of wave number
    c : n/h
    e : 1/h
    """

    n: FloatArray
    h: FloatArray
    c: FloatArray
    e: FloatArray

    @classmethod
    def of(cls, n: FloatArray) -> RingWave:
        """Scales of the harmonics ``n``."""
        h = np.maximum(n, 1.0)
        return cls(n, h, n / h, 1.0 / h)


def checked_ring(
    k: ArrayLike, radius: float, thickness: ArrayLike, modulus: ArrayLike, poisson: ArrayLike
) -> Stack:
    """Convert and check the arguments of ring layers."""
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
    """Minors at the top of every layer (then of the core), each in units of the medium there."""
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
    """Outer radius of each layer [mm]."""
    above = np.concatenate(([0.0], np.cumsum(thickness)[:-1]))
    return [float(radius - depth) for depth in above]


def climb_ring_layer(
    state: SurfaceState, log_ratio: float, poisson: float, wave: RingWave
) -> SurfaceState:
    """Minors at ``log_ratio`` = log(r/r_0) above ``state`` within one medium, up to a factor."""
    steps = max(1, ceil(log_ratio / LARGEST_STEP))
    weights = _power_weights(np.minimum(wave.h * (log_ratio / steps), _DEEPEST), wave)
    state = _climb_step(state, weights, poisson, wave)
    for _ in range(steps - 1):
        state = _climb_step(rescaled(state, 1.0), weights, poisson, wave)
    return state


def _climb_step(
    state: SurfaceState, weights: tuple[FloatArray, ...], poisson: float, wave: RingWave
) -> SurfaceState:
    """exp(t L) state = sum of weights * L^j state, j = 0..4."""
    power = state
    total = [weights[0] * part for part in state]
    for weight in weights[1:]:
        power = _slope(power, poisson, wave)
        total = [old + weight * new for old, new in zip(total, power, strict=True)]
    return SurfaceState(*total)


def _slope(state: SurfaceState, poisson: float, wave: RingWave) -> SurfaceState:
    """Return L state: the derivative of the scaled minors with respect to t = h log r."""
    det, xz, xx, zz, one = state
    b = poisson / (1.0 - poisson)
    m = 1.0 / (1.0 - poisson)
    a = (1.0 - 2.0 * poisson) / (1.0 - poisson)  # 1 - b, exactly 0 at nu = 0.5
    c, e = wave.c, wave.e
    hoop = e * det
    twice = 2.0 * c * xz
    return SurfaceState(
        det=a * (hoop + xx) + 2.0 * zz,
        xz=c * (zz - b * xx - m * hoop),
        xx=m * e * (hoop + xx) + twice + 2.0 * one,
        zz=m * (c * c * det - e * zz) - b * twice + a * one,
        one=m * (c * c * xx + e * (twice + e * zz)) - a * e * one,
    )


def _power_weights(t: FloatArray, wave: RingWave) -> tuple[FloatArray, ...]:
    """Weights of L^0..L^4 in exp(t L) exp(-2t), L having the eigenvalues 0, +-2 and +-2 low.

    Newton's interpolation of cosh and sinh in L^2: with x = 2 t low <= y = 2 t the divided
    differences [0, x^2], [0, x^2, y^2] of cosh sqrt and of sinh sqrt / sqrt, and
    L^5 = 4(1 + low^2) L^3 - 16 low^2 L.
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


def _first_differences(x2: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(cosh x - 1)/x^2 and (sinh x - x)/x^3 for x <= 1, from their series."""
    even = np.ones_like(x2)
    odd = np.ones_like(x2)
    for j in range(18, 2, -2):
        even = 1.0 + even * x2 * (1.0 / (j * (j - 1)))
        odd = 1.0 + odd * x2 * (1.0 / (j * (j + 1)))
    return 0.5 * even, odd / 6.0


def _second_differences(
    y: FloatArray, x2: FloatArray, decay: FloatArray, even1: FloatArray, odd1: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """[0, x^2, y^2] of cosh sqrt and sinh sqrt / sqrt, times exp(-y), for x <= 1 and x <= y."""
    thick = np.maximum(y, 2.0)
    span = 1.0 / (thick * thick - x2)
    even = (0.5 * (np.expm1(-y) / thick) ** 2 - decay * even1) * span
    odd = ((0.5 * (1.0 - decay * decay) - y * decay) / thick**3 - decay * odd1) * span
    thin = y < 2.0
    if np.any(thin):
        series = symmetric_series(x2[thin], y[thin] ** 2, (4, 5))
        even[thin], odd[thin] = (decay[thin] * part for part in series)
    return even, odd


def symmetric_series(
    x2: FloatArray, y2: FloatArray, firsts: tuple[int, ...]
) -> tuple[FloatArray, ...]:
    """Sum of H_j/(2j + f)! for each f of ``firsts``, H_j = sum of x^(2i) y^(2j-2i), i = 0..j.

    The divided difference between x^2 and y^2 of the tail of cosh sqrt (f even) or
    sinh sqrt / sqrt (f odd); complete to double precision for x <= y <= 2.
    """
    symmetric = np.ones_like(x2)
    power = np.ones_like(x2)
    totals = [np.full_like(x2, 1.0 / factorial(first)) for first in firsts]
    for j in range(1, 12):
        power = power * x2
        symmetric = symmetric * y2 + power
        totals = [
            total + symmetric * (1.0 / factorial(2 * j + first))
            for total, first in zip(totals, firsts, strict=True)
        ]
    return tuple(totals)
