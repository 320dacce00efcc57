"""Filon weights on panels that grow in a geometric series.

The paper (Braat & Kalker 1993, figure 2) transforms a compliance C(w) back to space on a
non-equidistant mesh of wave numbers: a polynomial through each element, integrated exactly against
the oscillation e^{iwx}. Here both the elements (panels) and the points x grow in a geometric
series, so that the weights depend on the product w x alone. They are computed once and hold for all
sizes, materials, thicknesses and speeds. The weights of a panel are those of the panel before it,
for x one step further in the series. The degree of the polynomial is free; the paper's is 2.

Three quantities are wanted at each x, F_r(x) = (1/pi) int_0^inf Re[C(w) m_r(w x)] dw with

    m_0(y) = e^{iy},   m_1(y) = (e^{iy} - 1)/(iy),   m_2(y) = 2 (e^{iy} - 1 - iy)/(iy)^2.

F_0 is the influence function G, F_1 its mean over [0, x], and F_2 = (2/x^2) int_0^x t F_1(t) dt.
The first integral of G is therefore F_1 x, the second F_2 x^2/2.
"""

from __future__ import annotations

from functools import lru_cache
from math import factorial, log, pi
from typing import NamedTuple

import numpy as np
from numpy.lib.stride_tricks import as_strided
from numpy.typing import NDArray
from scipy.special import sici, spherical_jn

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


def multipliers(phase: Array) -> ComplexArray:
    """Return m_0, m_1 and m_2 at real phases y > 0, shape (3, ...)."""
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
    """Return m_2 by its power series 2 sum (iy)^n/(n+2)!, for y < 1."""
    total = np.ones(y.shape, dtype=complex)
    for n in range(17, 2, -1):  # Horner; the first term left out is y^16 * 2/18! < 1e-15
        total = 1.0 + total * (1j * y) / n
    return total


def tail(phase: Array) -> ComplexArray:
    """Return T_r(y) = int_1^inf m_r(y v)/v dv, r = 0, 1, 2; shape (3, ...).

    The part [w_c, inf) of the transform of C = A/w is A T_r(w_c x)/pi. T_0 is E_1(-iy); integration
    by parts gives T_1 = T_0 + m_1 and T_2 = T_1 + m_2/2.
    """
    m = multipliers(phase)
    sine, cosine = sici(phase)
    first = -cosine + 1j * (0.5 * np.pi - sine)
    return np.stack([first, first + m[1], first + m[1] + 0.5 * m[2]])


def head(phase: Array) -> ComplexArray:
    """Return L_r(y) = int_0^1 (m_r(y v) - 1)/v dv, r = 0, 1, 2; shape (3, ...).

    The part [0, w_0] of the transform of C = A/w is A L_r(w_0 x)/pi once the infinite constant
    int_0^{w_0} A/w dw is left out (a half-space has no finite plane-strain displacement). L_0 =
    -Cin + i Si; then L_1 = L_0 - m_1 + 1 and L_2 = L_1 - m_2/2 + 1/2.
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
    """Return nodes t in [-1, 1], weights, and the matrix from values to Legendre coefficients."""
    t, weight = np.polynomial.legendre.leggauss(nodes)
    vandermonde = np.polynomial.legendre.legvander(t, nodes - 1)
    return np.asarray(t), np.asarray(weight), np.asarray(np.linalg.inv(vandermonde))


def unit_panel_weights(
    first: int, last: int, points_per_octave: int, panels_per_octave: int, nodes: int
) -> ComplexArray:
    """Return the weights of the panel [1, 2^(1/panels_per_octave)] for x = 2^(s/points_per_octave).

    Returns
    -------
    (3, last - first + 1, nodes) complex array, s = first ... last: sum(weights * C(nodes)) is int
    C(w) m_r(w x) dw over the panel. It is exact where C (times w^-r) is a polynomial of degree
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
    """Return the phase y up to which Gauss quadrature of the oscillation is exact to rounding.

    Its error is about y^(2m)/(2m)! for m nodes; Filon's formulas for m_1 and m_2 divide by y.
    """
    return float((np.finfo(float).eps * factorial(2 * nodes)) ** (0.5 / nodes))


def inverse_transform(
    samples: ComplexArray,
    octaves: tuple[int, int],
    points: tuple[int, int],
    per_octave: tuple[int, int],
    nodes: int,
) -> Array:
    """Return F_0, F_1 and F_2 at x_j and at -x_j, (3, compliances, 2, points).

    Parameters
    ----------
    samples :
        (compliances, n): on the panel from 0 to w_0, C less its limit A_c/w; on all further panels,
        C; then A_c and A = w_c C(w_c).
    octaves :
        the panels cover w_0 = 2^octaves[0] ... w_c = 2^octaves[1] [1/mm].
    points :
        x runs over 2^points[0] ... 2^points[1] mm; these are octaves, too.
    per_octave :
        (n, s): points and panels per octave, n a multiple of s.
    nodes :
        samples per panel (Gauss-Legendre).
    """
    relative = points[0] + octaves[0], points[1] - points[0], octaves[1] - octaves[0]
    weights = _weights(*relative, *per_octave, nodes)
    growth = 2.0 ** octaves[0] / pi * samples  # 1/pi and the lengths of panels
    growth[:, nodes:-2].reshape(len(samples), -1, nodes)[...] *= weights.sizes[:, None]
    growth[:, -2:] = samples[:, -2:] / pi
    even, odd = weights.even.sums(growth.real), weights.odd.sums(growth.imag)
    # The constant of a half-space includes wave numbers above 1/mm, whatever w_0 is.
    even += (octaves[0] * log(2.0)) * growth[:, -2, None, None].real
    return np.stack([even - odd, even + odd], axis=2).swapaxes(0, 1)


class _PanelWeights(NamedTuple):
    """Weights of the real or the imaginary parts of samples, where w_0 is 1 (see `_weights`).

    Attributes
    ----------
    lowest : (nodes, 3 points) on the panel from 0 to w_0.
    panel : (nodes, 3, more points) on the panel at w_0, for the x of this panel and of all further
        ones.
    ends : (2, 3 points) of A_c and of A.
    step : number of points from one panel to the next.
    """

    lowest: Array
    panel: Array
    ends: Array
    step: int

    def sums(self, samples: Array) -> Array:
        """Return the weighted sums of the samples (compliances, n), (compliances, 3, points)."""
        nodes, _, more = self.panel.shape
        points = self.ends.shape[1] // 3
        out = np.zeros((len(samples), 3, points))
        used = np.flatnonzero(samples.any(axis=1))
        if not used.size:
            return out
        rows = samples[used]
        far = rows[:, nodes:-2].reshape(-1, nodes) @ self.panel.reshape(nodes, -1)
        far = far.reshape(used.size, -1, 3, more)
        first, panel, power, point = far.strides
        shape = (*far.shape[:3], points)
        shifted = as_strided(far, shape, (first, panel + self.step * point, power, point))
        near = rows[:, :nodes] @ self.lowest + rows[:, -2:] @ self.ends
        out[used] = shifted.sum(axis=1) + near.reshape(used.size, 3, points)
        return out


class _TransformWeights(NamedTuple):
    """Weights of real and of imaginary parts, and the lengths of the panels over w_0."""

    even: _PanelWeights
    odd: _PanelWeights
    sizes: Array


@lru_cache(maxsize=16)
def _weights(first: int, lengths: int, waves: int, n: int, s: int, nodes: int) -> _TransformWeights:
    """Return the weights for x = 2^(first + j/n) over ``lengths`` octaves, where w_0 = 1."""
    phases = 2.0 ** (first + np.arange(lengths * n + 1) / n)
    t, gauss, _ = gauss_legendre(nodes)
    lowest = 0.5 * gauss * multipliers(np.multiply.outer(phases, 0.5 * (1.0 + t)))
    panel = unit_panel_weights(first * n, (first + waves + lengths) * n - n // s, n, s, nodes)
    ends = np.stack([head(phases), tail(2.0**waves * phases)])
    parts = [
        _PanelWeights(
            lowest=_contiguous(lowest.transpose(2, 0, 1), part).reshape(nodes, -1),
            panel=_contiguous(panel.transpose(2, 0, 1), part),
            ends=_contiguous(ends, part).reshape(2, -1),
            step=n // s,
        )
        for part in ("real", "imag")
    ]
    return _TransformWeights(parts[0], parts[1], 2.0 ** (np.arange(waves * s) / s))


def _contiguous(values: ComplexArray, part: str) -> Array:
    """Return the real or the imaginary part of values, as a contiguous array."""
    return np.ascontiguousarray(getattr(values, part))


@lru_cache(maxsize=8)
def sample_points(octaves: tuple[int, int], panels_per_octave: int, nodes: int) -> Array:
    """Return the wave numbers [1/mm] of the lowest panel, all others, and w_c, in rising order."""
    t, _, _ = gauss_legendre(nodes)
    i = np.arange(octaves[0] * panels_per_octave, octaves[1] * panels_per_octave)
    growth = 2.0 ** (1.0 / panels_per_octave) - 1.0
    panels = np.multiply.outer(2.0 ** (i / panels_per_octave), 1.0 + 0.5 * growth * (1.0 + t))
    lowest = 2.0 ** octaves[0] * 0.5 * (1.0 + t)
    return np.concatenate([lowest, panels.ravel(), [2.0 ** octaves[1]]])
