"""From a compliance C(k) to a tabulated influence function and its integrals in space."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import ceil, floor, log, log2

import numpy as np
from numpy.typing import NDArray

from rollnip.influence._weights import (
    ComplexArray,
    gauss_legendre,
    sample_points,
    transform_matrix,
)

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

_POINTS_PER_OCTAVE = 8
_NODES = 14
_MOST_PANELS_PER_OCTAVE = 8


@dataclass(frozen=True, slots=True)
class Window:
    """The part of space and of the spectrum that a table covers, in powers of two.

    x runs over 2^points[0] ... 2^points[1] mm; wave numbers over 2^octaves[0] ... 2^octaves[1]
    per mm, with a single panel from 0 below and a closed form from there to infinity above.
    """

    points: tuple[int, int]
    octaves: tuple[int, int]

    @classmethod
    def covering(cls, shortest: float, longest: float, slowest: float = 0.0) -> Window:
        """Window that resolves lengths from ``shortest`` to ``longest`` [mm].

        ``slowest`` is the longest relaxation length V tau [mm]; the panel at zero ends well below
        its inverse.
        """
        high = ceil(log2(longest))
        low = max(floor(log2(shortest)), high - 40)
        bottom = -high - 2
        if slowest > 0.0:
            bottom = max(min(bottom, floor(-log2(slowest)) - 5), bottom - 40)
        return cls(points=(low, high), octaves=(bottom, -low + 2))


@dataclass(frozen=True, slots=True)
class Kernel:
    """Influence function G(x) of a line traction, with its first and second integrals from 0.

    A quintic Hermite interpolation of F_2(x) = (2/x^2) int_0^x int_0^t G in the logarithm of
    |x|, on either side: F_2 is analytic in ln|x| although G is singular at 0, so no singular
    part has to be split off. G is a displacement per unit of line load [mm/(N/mm)].

    A kernel may carry several channels (the influence functions of one surface), which are then
    evaluated together: results have a first axis of channels, then the shape of x.

    Attributes
    ----------
    points_per_octave, first :
        the grid is |x| = 2^((first + j)/points_per_octave).
    coefficients :
        (6, 2 cells) or (6, channels, 2 cells): polynomials in the fraction of a cell, those of
        x > 0 before those of x < 0. On either side the first and the last cell go on linearly in
        ln|x|, below and beyond the grid.
    """

    points_per_octave: int
    first: int
    coefficients: Array

    @classmethod
    def stacked(cls, kernels: tuple[Kernel, ...]) -> Kernel:
        """One kernel with a channel for each of some kernels on the same grid."""
        coefficients = np.stack([kernel.coefficients for kernel in kernels], axis=1)
        return cls(kernels[0].points_per_octave, kernels[0].first, coefficients)

    @property
    def reach(self) -> float:
        """Largest |x| of the table [mm]."""
        cells = self.coefficients.shape[-1] // 2 - 2
        return float(2.0 ** ((self.first + cells) / self.points_per_octave))

    def double_integral(self, x: Array) -> Array:
        """int_0^x int_0^t G(s) ds dt, shape of ``x`` [mm] (after channels)."""
        return 0.5 * x * x * self._jet(x, 0)[0]

    def integral(self, x: Array) -> Array:
        """int_0^x G(t) dt, shape of ``x`` [mm] (after channels): H of theory section 4."""
        value, slope = self._jet(x, 1)
        return x * (value + 0.5 * slope)

    def value(self, x: Array) -> Array:
        """G(x) [mm/(N/mm)], shape of ``x`` [mm] (after channels); large where singular at 0."""
        value, slope, bend = self._jet(x, 2)
        return value + 1.5 * slope + 0.5 * bend

    def __add__(self, other: Kernel) -> Kernel:
        return Kernel(self.points_per_octave, self.first, self.coefficients + other.coefficients)

    def __sub__(self, other: Kernel) -> Kernel:
        return Kernel(self.points_per_octave, self.first, self.coefficients - other.coefficients)

    def __mul__(self, factor: float) -> Kernel:
        return Kernel(self.points_per_octave, self.first, factor * self.coefficients)

    def _jet(self, x: Array, order: int) -> list[Array]:
        """F_2 and its derivatives to ln|x| up to ``order``."""
        cells = self.coefficients.shape[-1] // 2
        position = np.log2(np.maximum(np.abs(x), 1e-300)) * self.points_per_octave - self.first
        # Row 0 is what lies below the grid: a cell that ends at its first point.
        cell = np.minimum(np.maximum(np.floor(position), -1.0), cells - 2.0).astype(np.intp)
        fraction = position - np.maximum(cell, 0)
        row = cell + 1 + cells * (x < 0.0)
        per_log = self.points_per_octave / log(2.0)
        scales = (1.0, per_log, 2.0 * per_log**2)
        jet = _horner(self.coefficients, row, fraction, order)
        return [scale * part for scale, part in zip(scales, jet, strict=False)]


def _horner(coefficients: Array, row: Indices, fraction: Array, order: int) -> list[Array]:
    """Polynomials of some rows with their first two derivatives (the second halved)."""
    top = coefficients[5].take(row, axis=-1)
    jet = [top] + [np.zeros(top.shape) for _ in range(order)]
    for n in range(4, -1, -1):
        for m in range(order, 0, -1):
            jet[m] *= fraction
            jet[m] += jet[m - 1]
        jet[0] *= fraction
        jet[0] += coefficients[n].take(row, axis=-1)
    return jet


Compliance = Callable[[Array], tuple[ComplexArray, ...]]


def tabulate(
    compliance: Compliance,
    window: Window,
    *,
    low_limit: tuple[complex, ...],
    tolerance: float = 1e-7,
    nodes: int = _NODES,
) -> tuple[Kernel, ...]:
    """Influence functions of compliances, by the non-equidistant inverse Fourier transform.

    G(x) = (1/2 pi) int C(w) e^{iwx} dw = (1/pi) int_0^inf Re[C(w) e^{iwx}] dw. Wave numbers are
    cut in panels that grow in a geometric series; on each C is a polynomial through ``nodes``
    points, integrated exactly against the oscillation (Filon); above the last panel C = A/w in
    closed form. Panels are halved in ratio until the polynomials resolve C to ``tolerance``.

    Parameters
    ----------
    compliance :
        function of wave numbers (n,) [1/mm] returning a tuple of (n,) complex arrays.
    window :
        lengths and wave numbers to cover.
    low_limit :
        for each compliance the A of C -> A/w as w -> 0: 0 on a rigid core, not 0 on a
        half-space, whose infinite constant displacement is left out (the table is then that of
        the wave numbers above 1/mm plus the changing part of those below).
    tolerance :
        largest unresolved part of w C(w), relative to the largest w C(w).
    nodes :
        points per panel; 3 is the paper's quadratic.

    Returns
    -------
    tuple of Kernel, one for each compliance.
    """
    per_octave = 1
    limit = np.array(low_limit, dtype=complex)
    samples, roughness = _sample(compliance, window, per_octave, nodes)
    while roughness > tolerance and per_octave < _MOST_PANELS_PER_OCTAVE:
        per_octave *= 2
        samples, roughness = _sample(compliance, window, per_octave, nodes)
    means = _transform(samples, limit, window, per_octave, nodes)
    first = window.points[0] * _POINTS_PER_OCTAVE
    return tuple(
        Kernel(_POINTS_PER_OCTAVE, first, _hermite(means[:, :, c])) for c in range(limit.size)
    )


def _sample(
    compliance: Compliance, window: Window, per_octave: int, nodes: int
) -> tuple[ComplexArray, float]:
    """C at all sample points, shape (n, compliances), and what its polynomials leave out."""
    w = sample_points(window.octaves, per_octave, nodes)
    values = np.stack(compliance(w), axis=-1)
    _, _, to_coefficients = gauss_legendre(nodes)
    scaled = (values * w[:, None])[:-1].reshape(-1, nodes, values.shape[1])
    coefficients = np.abs(np.einsum("mn,pnc->pmc", to_coefficients[-2:], scaled))
    largest = np.maximum(np.abs(scaled).max(axis=(0, 1)), np.finfo(float).tiny)
    # A kernel that is small beside the others need not be resolved to its own size.
    largest = np.maximum(largest, 1e-3 * largest.max())
    return values, float((coefficients.max(axis=(0, 1)) / largest).max())


def _transform(
    samples: ComplexArray, low_limit: ComplexArray, window: Window, per_octave: int, nodes: int
) -> Array:
    """F_r(+-x_j); shape (3, points, compliances, 2 sides)."""
    n = _POINTS_PER_OCTAVE
    even, odd = transform_matrix(window.octaves, window.points, (n, per_octave), nodes)
    w = sample_points(window.octaves, per_octave, nodes)
    columns = np.vstack([samples[:-1], low_limit, w[-1] * samples[-1]])
    columns[:nodes] -= low_limit / w[:nodes, None]
    sums = _product(even, columns.real), _product(odd, columns.imag)
    both = np.stack([sums[0] + sums[1], sums[0] - sums[1]], axis=-1)
    return both.reshape(3, -1, low_limit.size, 2)


def _product(matrix: Array, columns: Array) -> Array:
    """Matrix @ columns, leaving out columns that are zero throughout."""
    out = np.zeros((matrix.shape[0], columns.shape[1]))
    used = np.any(columns != 0.0, axis=0)
    if np.any(used):
        out[:, used] = matrix @ np.ascontiguousarray(columns[:, used])
    return out


def _hermite(means: Array) -> Array:
    """Coefficients (6, 2 cells) from F_0, F_1, F_2 of shape (3, points, 2)."""
    step = log(2.0) / _POINTS_PER_OCTAVE
    f_0, f_1, f_2 = np.moveaxis(means, -1, 1)
    slope = 2.0 * (f_1 - f_2)
    bend = 2.0 * (f_0 - f_1) - 2.0 * slope
    v0, v1 = f_2[:, :-1], f_2[:, 1:]
    s0, s1 = slope[:, :-1] * step, slope[:, 1:] * step
    b0, b1 = bend[:, :-1] * step**2, bend[:, 1:] * step**2
    rise = v1 - v0 - s0 - 0.5 * b0
    turn = s1 - s0 - b0
    curl = b1 - b0
    inner = np.stack(
        [
            v0,
            s0,
            0.5 * b0,
            10.0 * rise - 4.0 * turn + 0.5 * curl,
            -15.0 * rise + 7.0 * turn - curl,
            6.0 * rise - 3.0 * turn + 0.5 * curl,
        ]
    )
    below, above = np.zeros((2, 6, 2, 1))
    below[0, :, 0], below[1, :, 0] = v0[:, 0], s0[:, 0]
    above[0, :, 0], above[1, :, 0] = v1[:, -1], s1[:, -1]
    return np.concatenate([below, inner, above], axis=2).reshape(6, -1)
