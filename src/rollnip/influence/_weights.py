"""Filon weights on panels that grow in a geometric series.

The paper (Braat & Kalker 1993, figure 2) transforms a compliance C(w) back to space on a
non-equidistant mesh of wave numbers: a polynomial through each element, integrated exactly against
the oscillation e^{iwx}. Here the elements grow in a geometric series and the points x do too, so
that the weights depend on the product w x alone: they are computed once for every pair of sizes
and are then the same for all materials, thicknesses and speeds. The degree of the polynomial is
free; 2 is the paper's.

Three quantities are wanted at each x, F_r(x) = (1/pi) int_0^inf Re[C(w) m_r(w x)] dw with

    m_0(y) = e^{iy},   m_1(y) = (e^{iy} - 1)/(iy),   m_2(y) = 2 (e^{iy} - 1 - iy)/(iy)^2:

F_0 is the influence function G, F_1 its mean over [0, x] and F_2 = (2/x^2) int_0^x t F_1(t) dt:
F_1 x and F_2 x^2/2 are the first and the second integral of G.
"""

from __future__ import annotations

from functools import lru_cache
from math import factorial

import numpy as np
from numpy.typing import NDArray
from scipy.special import sici, spherical_jn

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


def multipliers(phase: Array) -> ComplexArray:
    """m_0, m_1 and m_2 at real phases y > 0; shape (3, ...)."""
    y = np.asarray(phase, dtype=float)
    out = np.empty((3, *y.shape), dtype=complex)
    out[0] = np.exp(1j * y)
    out[1] = np.exp(0.5j * y) * np.sinc(y / (2.0 * np.pi))
    small = y < 1.0
    large = np.where(small, 1.0, y)
    out[2] = 2.0 * (np.exp(1j * large) - 1.0 - 1j * large) / (1j * large) ** 2
    out[2][small] = _second_multiplier_series(y[small])
    return out


def _second_multiplier_series(y: Array) -> ComplexArray:
    """m_2 by its power series 2 sum (iy)^n/(n+2)!, y < 1."""
    total = np.ones(y.shape, dtype=complex)
    for n in range(17, 2, -1):  # Horner; the first term left out is y^16 * 2/18! < 1e-15
        total = 1.0 + total * (1j * y) / n
    return total


def tail(phase: Array) -> ComplexArray:
    """T_r(y) = int_1^inf m_r(y v)/v dv, r = 0, 1, 2; shape (3, ...).

    The part [w_c, inf) of the transform of C = A/w is A T_r(w_c x)/pi. T_0 = E_1(-iy), then by
    parts T_1 = T_0 + m_1 and T_2 = T_1 + m_2/2.
    """
    m = multipliers(phase)
    sine, cosine = sici(phase)
    first = -cosine + 1j * (0.5 * np.pi - sine)
    return np.stack([first, first + m[1], first + m[1] + 0.5 * m[2]])


def head(phase: Array) -> ComplexArray:
    """L_r(y) = int_0^1 (m_r(y v) - 1)/v dv, r = 0, 1, 2; shape (3, ...).

    The part [0, w_0] of the transform of C = A/w is A L_r(w_0 x)/pi once the infinite constant
    int_0^{w_0} A/w dw is left out (a half-space has no finite plane-strain displacement).
    L_0 = -Cin + i Si, then L_1 = L_0 - m_1 + 1 and L_2 = L_1 - m_2/2 + 1/2.
    """
    y = np.asarray(phase, dtype=float)
    m = multipliers(y)
    sine, cosine = sici(y)
    cin = np.where(y < 1e-3, y**2 / 4.0, np.euler_gamma + np.log(y) - cosine)
    first = -cin + 1j * sine
    second = first - m[1] + 1.0
    return np.stack([first, second, second - 0.5 * m[2] + 0.5])


@lru_cache(maxsize=8)
def gauss_legendre(nodes: int) -> tuple[Array, Array, Array]:
    """Nodes t, weights, and the matrix from nodal values to Legendre coefficients, on [-1, 1]."""
    t, weight = np.polynomial.legendre.leggauss(nodes)
    vandermonde = np.polynomial.legendre.legvander(t, nodes - 1)
    return np.asarray(t), np.asarray(weight), np.asarray(np.linalg.inv(vandermonde))


@lru_cache(maxsize=8)
def unit_panel_weights(
    first: int, last: int, points_per_octave: int, panels_per_octave: int, nodes: int
) -> ComplexArray:
    """Weights of the panel [1, 2^(1/panels_per_octave)] for x = 2^(s/points_per_octave).

    Returns
    -------
    (3, last - first + 1, nodes) complex array, s = first ... last: sum(weights * C(nodes)) is
    int C(w) m_r(w x) dw over the panel, exact where C (times w^-r) is a polynomial of degree
    nodes - 1.
    """
    x = 2.0 ** (np.arange(first, last + 1) / points_per_octave)
    t, gauss, to_coefficients = gauss_legendre(nodes)
    half = 0.5 * (2.0 ** (1.0 / panels_per_octave) - 1.0)
    w = 1.0 + half * (1.0 + t)
    out = np.empty((3, x.size, nodes), dtype=complex)
    low = x * half < _lowest_filon_phase(nodes)
    out[:, low] = half * gauss * multipliers(np.multiply.outer(x[low], w))
    # Filon: int_-1^1 P_m(t) e^{i y t} dt = 2 i^m j_m(y).
    y = x[~low] * half
    order = np.arange(nodes)
    moments = 2.0 * 1j**order * spherical_jn(order, y[:, None])
    filon = half * np.exp(1j * x[~low, None] * (1.0 + half)) * (moments @ to_coefficients)
    phase = 1j * np.multiply.outer(x[~low], w)
    out[0, ~low] = filon
    out[1, ~low] = (filon - half * gauss) / phase
    out[2, ~low] = 2.0 * (filon - half * gauss * (1.0 + phase)) / phase**2
    return out


def _lowest_filon_phase(nodes: int) -> float:
    """Phase y below which Gauss quadrature of the oscillation itself is exact to rounding.

    Its error is about y^(2m)/(2m)! for m nodes; Filon's formulas for m_1 and m_2 divide by y.
    """
    return float((np.finfo(float).eps * factorial(2 * nodes)) ** (0.5 / nodes))


@lru_cache(maxsize=8)
def transform_matrix(
    octaves: tuple[int, int], points: tuple[int, int], per_octave: tuple[int, int], nodes: int
) -> tuple[Array, Array]:
    """Matrices from samples of C to the even and odd parts of F_0, F_1 and F_2.

    Parameters
    ----------
    octaves :
        the panels cover w_0 = 2^octaves[0] ... w_c = 2^octaves[1] [1/mm].
    points :
        x runs over 2^points[0] ... 2^points[1] mm, in octaves too.
    per_octave :
        (n, s): points and panels per octave, n a multiple of s.
    nodes :
        samples per panel (Gauss-Legendre).

    Returns
    -------
    even, odd : (3 * points, samples) arrays, acting on Re C and on Im C:
    F_r(+-x) = even @ Re C +- odd @ Im C. The samples are C on the panel from 0 to w_0 less its
    limit A_c/w, C on all further panels, then A_c and A = w_c C(w_c).
    """
    n, s = per_octave
    panels = np.arange(octaves[0] * s, octaves[1] * s)
    log_x = np.arange(points[0] * n, points[1] * n + 1) / n
    # The weights of a panel are those of the panel at w = 1, for x further on in the series.
    first = points[0] * n + (n // s) * panels
    unit = unit_panel_weights(int(first[0]), int(first[-1]) + log_x.size - 1, n, s, nodes)
    even, odd = np.empty((2, 3, log_x.size, (1 + panels.size) * nodes + 2))

    def fill(columns: slice, weights: ComplexArray) -> None:
        even[:, :, columns], odd[:, :, columns] = weights.real / np.pi, -weights.imag / np.pi

    fill(slice(0, nodes), _lowest_panel(octaves[0], log_x, nodes))
    for number, (panel, start) in enumerate(zip(panels, first - first[0], strict=True), start=1):
        columns = slice(number * nodes, (number + 1) * nodes)
        fill(columns, unit[:, start : start + log_x.size] * 2.0 ** (panel / s))
    # The constant of a half-space counts wave numbers above 1/mm, whatever w_0 is.
    constant = head(2.0 ** (octaves[0] + log_x)) + octaves[0] * np.log(2.0)
    fill(slice(-2, -1), constant[:, :, None])
    fill(slice(-1, None), tail(2.0 ** (octaves[1] + log_x))[:, :, None])
    return even.reshape(3 * log_x.size, -1), odd.reshape(3 * log_x.size, -1)


def _lowest_panel(octave: int, log_x: Array, nodes: int) -> ComplexArray:
    """Weights (3, points, nodes) of the panel [0, w_0], on which w x stays below 1/4."""
    t, gauss, _ = gauss_legendre(nodes)
    half = 0.5 * 2.0**octave
    return half * gauss * multipliers(np.multiply.outer(2.0**log_x, half * (1.0 + t)))


@lru_cache(maxsize=8)
def sample_points(octaves: tuple[int, int], panels_per_octave: int, nodes: int) -> Array:
    """Wave numbers [1/mm] of the lowest panel, of all others, and w_c; in increasing order."""
    t, _, _ = gauss_legendre(nodes)
    i = np.arange(octaves[0] * panels_per_octave, octaves[1] * panels_per_octave)
    growth = 2.0 ** (1.0 / panels_per_octave) - 1.0
    panels = np.multiply.outer(2.0 ** (i / panels_per_octave), 1.0 + 0.5 * growth * (1.0 + t))
    lowest = 2.0 ** octaves[0] * 0.5 * (1.0 + t)
    return np.concatenate([lowest, panels.ravel(), [2.0 ** octaves[1]]])
