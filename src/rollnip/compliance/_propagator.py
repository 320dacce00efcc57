"""The layer equations of flat and ring layers as one constant matrix M, and its exponential.

State y = (U, W, s, q): u_x = i U, u_z = W, s_xz = i s, s_zz = q, stresses in units of 2 G h/r on a
ring, of 2 G h where flat.  With t, measured upwards, equal to h log r on a ring and to h times the
distance where flat,

    U' = e U + c W - 2s                        s' = -e s + c b q - c m (e W + c U)
    W' = -b (e W + c U) - (1-b) q              q' = e b q - c s - e m (e W + c U)

b = nu/(1-nu), m = 1/(1-nu).  Ring: h = max(n, 1), c = n/h, e = 1/h.  Flat: h = k, c = 1, e = 0. The
eigenvalues are +-(c + e) and +-(c - e); on the pair that grows upwards (M - c)^2 = e^2.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rollnip.compliance._ring import RingWave, symmetric_series
from rollnip.compliance._types import Array, FloatArray

_SMALL = 1e-8
"""sinh(e t)/e equals t to double precision for e below this and t <= 1."""


def generator(poisson: float, wave: RingWave) -> FloatArray:
    """Return M, (4, 4, n)."""
    b = poisson / (1.0 - poisson)
    m = 1.0 / (1.0 - poisson)
    a = (1.0 - 2.0 * poisson) / (1.0 - poisson)  # 1 - b, exactly 0 at nu = 0.5
    c, e = wave.c, wave.e
    out = np.zeros((4, 4, c.size))
    along, inward, shear, normal = range(4)
    out[along, along], out[along, inward], out[along, shear] = e, c, -2.0
    out[inward, along], out[inward, inward], out[inward, normal] = -b * c, -b * e, -a
    out[shear, along], out[shear, shear], out[shear, normal] = -m * c * c, -e, b * c
    out[shear, inward] = out[normal, along] = -m * c * e
    out[normal, inward], out[normal, shear], out[normal, normal] = -m * e * e, -c, b * e
    return out


def slope(y: Array, matrix: FloatArray) -> Array:
    """Return M y, for y of shape (4, ..., n)."""
    return np.asarray(np.einsum("ijn,j...n->i...n", matrix, y))


def hoop_stress(y: Array, poisson: float, wave: RingWave) -> Array:
    """Return s_xx in the units of the state, b q - m (e W + c U), by the constitutive law."""
    b = poisson / (1.0 - poisson)
    m = 1.0 / (1.0 - poisson)
    return np.asarray(b * y[3] - m * (wave.e * y[1] + wave.c * y[0]))


class Weights(NamedTuple):
    """exp(+-t M) = even + even_z Z +- (odd + odd_z Z) M, with Z = M^2 - (c + e)^2."""

    even: FloatArray
    even_z: FloatArray
    odd: FloatArray
    odd_z: FloatArray


def thin_weights(t: FloatArray, wave: RingWave) -> Weights:
    """Return the weights for t <= 1, by Newton interpolation between (c + e)^2 and (c - e)^2."""
    c, e = np.maximum(wave.c, _SMALL), np.maximum(wave.e, _SMALL)
    sum_, difference = wave.c + wave.e, wave.c - wave.e
    y, x = sum_ * t, difference * t
    (tail,) = symmetric_series(x * x, y * y, (3,))
    return Weights(
        even=np.cosh(y),
        even_z=0.5 * (np.sinh(c * t) / c) * (np.sinh(e * t) / e),
        odd=np.sinh(y) / sum_,
        odd_z=t * t * t * tail,
    )


def thick_weights(t: FloatArray, wave: RingWave) -> Weights:
    """Return the weights times exp(-t) for t > 1, where c = 1 and e < 1/2."""
    e = np.maximum(wave.e, _SMALL)
    decay = np.exp(-2.0 * t)
    cosh, sinh = 0.5 * (1.0 + decay), 0.5 * (1.0 - decay)
    cosh_e, sinh_e = np.cosh(wave.e * t), np.sinh(wave.e * t)
    lever = np.where(wave.e < _SMALL, t, sinh_e / e)
    return Weights(
        even=cosh * cosh_e + sinh * sinh_e,
        even_z=0.5 * sinh * lever,
        odd=(sinh * cosh_e + cosh * sinh_e) / (1.0 + wave.e),
        odd_z=0.5 * (cosh * lever - cosh_e * sinh) / (1.0 - wave.e**2),
    )


def basis_of(y: Array, poisson: float, wave: RingWave) -> tuple[Array, Array, Array, Array]:
    """Return y, Z y, M y and Z M y, in the order of ``Weights``."""
    square, matrix = (wave.c + wave.e) ** 2, generator(poisson, wave)
    once = slope(y, matrix)
    twice = slope(once, matrix)
    thrice = slope(twice, matrix)
    return y, twice - square * y, once, thrice - square * once


def parts_of(y: Array, matrix: FloatArray, wave: RingWave) -> tuple[Array, Array, Array]:
    """Return sgn(M) y, M y and |M| y for n > 2.

    The first is +y where y grows upwards and -y where it decays. sgn(M) = M/|M| and |M| =
    (M^2)^(1/2) are computed as polynomials in M.
    """
    c2, e2 = wave.c**2, wave.e**2
    once = slope(y, matrix)
    twice = slope(once, matrix)
    thrice = slope(twice, matrix)
    sign = ((3.0 * c2 + e2) * once - thrice) / (2.0 * wave.c * (c2 - e2))
    return sign, once, (twice + (c2 - e2) * y) / (2.0 * wave.c)
