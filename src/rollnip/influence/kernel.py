"""Tabulated influence functions and their integrals in space, from compliances C(k)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from math import cbrt, ceil, floor, inf, log, log2, sqrt

import numpy as np
from numpy.typing import NDArray

from rollnip.influence._weights import (
    ComplexArray,
    gauss_legendre,
    inverse_transform,
    sample_points,
)

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

# Points of a table in an octave of lengths; an octave of wave numbers has at most as many panels.
_POINTS_PER_OCTAVE = 8


def _resolving_an_octave() -> int:
    """Return the number of nodes that resolves a compliance over one octave to rounding.

    On a panel from w to 2 w the interpolation error of a polynomial through n nodes is rho^-n. Here
    rho is the sum of the half-axes of the largest ellipse in which the function is analytic, with
    its foci at the ends of the panel and half the panel as the unit of length. Compliances are not
    analytic at w = 0, three half-lengths from the middle, so that rho = 3 + sqrt(3^2 - 1) at most.
    """
    return ceil(-log(np.finfo(float).eps) / log(3.0 + sqrt(8.0)))


_NODES = _resolving_an_octave()


def _left_between_points(per_octave: int) -> float:
    """Return the error of a table of quintics in a second derivative, from which G comes.

    Between points at steps h of ln|x|, polynomials through values, slopes and second derivatives
    leave h^4/1920 times the sixth derivative.
    """
    return float((log(2.0) / per_octave) ** 4 / 1920.0)


TOLERANCE = _left_between_points(_POINTS_PER_OCTAVE)
"""Unresolved part of a compliance, relative to the largest one, below which a table cannot go."""
MOST_OCTAVES = int(np.finfo(float).nmant)
"""Largest number of octaves of length, and of octaves of wave numbers below them, in a table.

Shorter lengths are lost in the rounding of the longest.
"""


@dataclass(frozen=True, slots=True)
class Window:
    """The range of lengths and wave numbers that a table covers, in powers of two.

    x runs over 2^points[0] ... 2^points[1] mm; wave numbers over 2^octaves[0] ... 2^octaves[1] per
    mm. A single panel covers wave numbers from 0 to the lowest, and a closed form those above the
    highest. A table has ``per_octave`` points in an octave of lengths.
    """

    points: tuple[int, int]
    octaves: tuple[int, int]
    per_octave: int = _POINTS_PER_OCTAVE

    @classmethod
    def covering(
        cls, shortest: float, longest: float, slowest: float = 0.0, *, densely: bool = False
    ) -> Window:
        """Return the window that resolves lengths from ``shortest`` to ``longest`` [mm].

        ``slowest`` is the longest relaxation length V tau [mm]; the panel at zero ends well below
        its inverse. ``densely``: with twice as many points.
        """
        high = ceil(log2(longest))
        low = max(floor(log2(shortest)), high - MOST_OCTAVES)
        bottom = -high - 2
        if slowest > 0.0:
            bottom = max(min(bottom, floor(-log2(slowest)) - 5), bottom - MOST_OCTAVES)
        per_octave = (2 if densely else 1) * _POINTS_PER_OCTAVE
        return cls(points=(low, high), octaves=(bottom, -low + 2), per_octave=per_octave)


@dataclass(frozen=True)
class Kernel:
    """Influence function G(x) of a line traction, with its first and second integrals from 0.

    G is a displacement per unit of line load [mm/(N/mm)]. The table is a quintic Hermite
    interpolation of F_2(x) = (2/x^2) int_0^x int_0^t G, on either side of 0, in ln|x|. F_2 is
    analytic in ln|x| although G is singular at 0, so that no singular part has to be split off.

    A kernel may have several channels (the influence functions of one surface), which are evaluated
    together: results have an axis of channels, then the shape of x.

    Attributes
    ----------
    points_per_octave, first :
        the grid is |x| = 2^((first + j)/points_per_octave).
    coefficients :
        (6, 2 cells) or (6, channels, 2 cells), with 2 in place of 6 in tables of half-spaces:
        coefficients of polynomials in the fraction of a cell, counted from its end nearer to 0.
        Cells are in the order of x, so that those of x < 0 precede those of x > 0. On either side
        the first and the last cell extrapolate linearly in ln|x|, below and beyond the grid.
    """

    points_per_octave: int
    first: int
    coefficients: Array

    @classmethod
    def stacked(cls, kernels: tuple[Kernel, ...]) -> Kernel:
        """Return one kernel with the channels of several kernels on the same grid, in order."""
        first, cells = kernels[0], kernels[0].coefficients.shape[-1]
        terms = max(len(kernel.coefficients) for kernel in kernels)
        out = np.zeros((terms, sum(kernel.count for kernel in kernels), cells))
        start = 0
        for kernel in kernels:
            part = kernel.coefficients.reshape(-1, kernel.count, cells)
            out[: len(part), start : start + kernel.count] = part
            start += kernel.count
        return cls(first.points_per_octave, first.first, out)

    def channel(self, number: int) -> Kernel:
        """Return one channel as a kernel of its own."""
        if self.coefficients.ndim == 2:
            return self
        return Kernel(self.points_per_octave, self.first, self.coefficients[:, number])

    @property
    def count(self) -> int:
        """Number of channels."""
        return self.coefficients[0, ..., 0].size

    @property
    def reach(self) -> float:
        """Largest |x| of the table [mm]."""
        cells = self.coefficients.shape[-1] // 2 - 2
        return float(2.0 ** ((self.first + cells) / self.points_per_octave))

    @cached_property
    def reach_of_differences(self) -> float:
        """Distance up to which differences are taken, over the length h of an element.

        At a distance x, a difference of double integrals keeps the rounding error eps G x^2/2. The
        element itself responds by the fall A of G with ln|x| at its own place, that is by A h^2.
        Relative to this, the rounding error is noise in the tractions; under a stiff skin it was
        1e-3 of the pressure where a tenth of the elements lay within 1e-3 of the contact. A third
        of all digits, 6e-6 of the tractions, is small beside any tolerance, and sets the distance.
        Two Gauss points miss h^5/2160 A/x^3 of a logarithm. Nearer than where this equals eps A
        x^2/2, the smallest error of a difference, they gain nothing.
        """
        largest = float(np.abs(self.coefficients[0]).max())
        if largest == 0.0:
            return inf
        eps, per_log = float(np.finfo(float).eps), self.points_per_octave / log(2.0)
        nearest = float(np.abs(self.coefficients[1, ..., self.coefficients.shape[-1] // 2]).max())
        noise = cbrt(eps) * per_log * nearest / largest
        return max(sqrt(2.0 * noise / eps), float((1080.0 * eps) ** -0.2))

    def double_integral(self, x: Array) -> Array:
        """Return int_0^x int_0^t G(s) ds dt, ([channels,] shape of ``x``) [mm]."""
        (value,) = self._jet(x, 0)
        value *= 0.5 * x * x
        return value

    def integral(self, x: Array) -> Array:
        """Return int_0^x G(t) dt (H of theory section 4), ([channels,] shape of ``x``) [mm]."""
        value, slope = self._jet(x, 1)
        return np.asarray(x * (value + 0.5 * slope))

    def value(self, x: Array) -> Array:
        """Return G(x) [mm/(N/mm)], ([channels,] shape of ``x`` [mm]); may be singular at 0."""
        value, slope, bend = self._jet(x, 2)
        return value + 1.5 * slope + 0.5 * bend

    def __add__(self, other: Kernel) -> Kernel:
        fewer, more = sorted((self.coefficients, other.coefficients), key=len)
        total = more.copy()
        total[: len(fewer)] += fewer
        return replace(self, coefficients=total)

    def __sub__(self, other: Kernel) -> Kernel:
        return self + -1.0 * other

    def __mul__(self, factor: float) -> Kernel:
        return replace(self, coefficients=factor * self.coefficients)

    __rmul__ = __mul__

    def _jet(self, x: Array, order: int) -> list[Array]:
        """Return F_2 and its derivatives with respect to ln|x|, up to ``order``."""
        jet = _horner(self.coefficients, *self._cells(x), order)
        per_log = self.points_per_octave / log(2.0)
        for scale, part in zip((per_log, 2.0 * per_log**2), jet[1:], strict=False):
            part *= scale
        return jet

    def _cells(self, x: Array) -> tuple[Indices, Array]:
        """Return the cell of each place, and the fraction of it between the place and 0."""
        cells = self.coefficients.shape[-1] // 2
        position = np.log2(x * x + np.finfo(float).tiny)
        position *= 0.5 * self.points_per_octave
        position -= self.first
        # Cell -1 extends from the grid down to 0.
        cell = np.floor(position)
        np.maximum(cell, -1.0, out=cell)
        np.minimum(cell, cells - 2.0, out=cell)
        position -= cell
        # First the middle of the cell, counted from 0 to either side; then the index from lowest x.
        cell += 1.5
        middle = np.copysign(cell, x, out=cell)
        middle += cells
        return middle.astype(np.intp), position


def _horner(coefficients: Array, cell: Indices, fraction: Array, order: int) -> list[Array]:
    """Return polynomials of given cells, with derivatives up to ``order`` (the second halved)."""
    *lower, highest = coefficients
    top = highest.take(cell, axis=-1)
    jet = [top] + [np.zeros(top.shape) for _ in range(order)]
    value = np.empty(top.shape)
    for coefficient in reversed(lower):
        for m in range(order, 0, -1):
            jet[m] *= fraction
            jet[m] += jet[m - 1]
        jet[0] *= fraction
        jet[0] += coefficient.take(cell, axis=-1, out=value, mode="clip")
    return jet


Compliance = Callable[[Array], tuple[ComplexArray, ...]]


def tabulate(
    compliance: Compliance,
    window: Window,
    *,
    low_limit: tuple[complex, ...],
    tolerance: float = TOLERANCE,
    nodes: int = _NODES,
) -> Kernel:
    """Return the influence functions of compliances, by non-equidistant inverse Fourier transform.

    G(x) = (1/2 pi) int C(w) e^{iwx} dw = (1/pi) int_0^inf Re[C(w) e^{iwx}] dw. Wave numbers are
    divided into panels that grow in a geometric series. On each panel C is a polynomial through
    ``nodes`` points, integrated exactly against the oscillation (Filon). Above the last panel C =
    A/w, in closed form. The number of panels per octave is doubled until the polynomials resolve C
    to ``tolerance``.

    Parameters
    ----------
    compliance :
        function of wave numbers (n,) [1/mm] that returns a tuple of (n,) complex arrays.
    window :
        lengths and wave numbers to cover.
    low_limit :
        for each compliance the A of C -> A/w as w -> 0. It is 0 on a rigid core. On a half-space it
        is not, and the infinite constant displacement is left out: the table is then that of the
        wave numbers above 1/mm plus the part of those below that varies with x.
    tolerance :
        largest unresolved part of w C(w), relative to the largest w C(w).
    nodes :
        points per panel; the paper's quadratic has 3.

    Returns
    -------
    Kernel with a channel for each compliance.
    """
    per_octave = 1
    limit = np.array(low_limit, dtype=complex)
    samples, roughness = _sample(compliance, window, per_octave, nodes)
    while roughness > tolerance and per_octave < _POINTS_PER_OCTAVE:
        per_octave *= 2
        samples, roughness = _sample(compliance, window, per_octave, nodes)
    means = _transform(samples, limit, window, per_octave, nodes)
    first = window.points[0] * window.per_octave
    return Kernel(window.per_octave, first, _hermite(means, window.per_octave))


def half_space_kernel(window: Window, even: Array, odd: Array) -> Kernel:
    """Return the table of elastic half-spaces, whose influence functions are known in closed form.

    Parameters
    ----------
    window :
        lengths to cover.
    even, odd :
        for each channel the A and the B of C = (A + i B)/w at w > 0. Then G = -A/pi (ln|x| +
        Euler's constant) - B/2 sign(x), with the constant of `tabulate`.

    Returns
    -------
    Kernel with a channel for each.
    """
    n = window.per_octave
    points = np.arange(window.points[0] * n, window.points[1] * n + 1)
    step = log(2.0) / n
    cells = points.size + 1
    out = np.empty((2, even.size, 2 * cells))
    # F_2 of ln|x| is ln|x| - 3/2, that of sign(x) is sign(x); outer cells extend beyond the grid.
    start = step * (points[0] - 1 + np.arange(cells)) + np.euler_gamma - 1.5
    level = np.multiply.outer(-even / np.pi, start)
    out[0, :, :cells] = level[:, ::-1] + 0.5 * odd[:, None]
    out[0, :, cells:] = level - 0.5 * odd[:, None]
    out[1] = (-step * even / np.pi)[:, None]
    return Kernel(n, int(points[0]), out)


def _sample(
    compliance: Compliance, window: Window, per_octave: int, nodes: int
) -> tuple[ComplexArray, float]:
    """Return C at all sample points, (compliances, n), and what the polynomials leave out."""
    w = sample_points(window.octaves, per_octave, nodes)
    values = np.stack(compliance(w))
    _, _, to_coefficients = gauss_legendre(nodes)
    scaled = (values * w)[:, :-1].reshape(-1, nodes)
    coefficients = np.abs(scaled @ to_coefficients[-2:].T).reshape(len(values), -1)
    largest = np.abs(scaled).reshape(len(values), -1).max(axis=1)
    # A compliance that is small beside the others need not be resolved relative to its own size.
    largest = np.maximum(largest, max(1e-3 * largest.max(), np.finfo(float).tiny))
    return values, float((coefficients.max(axis=1) / largest).max())


def _transform(
    samples: ComplexArray, low_limit: ComplexArray, window: Window, per_octave: int, nodes: int
) -> Array:
    """Return F_r(+-x_j), (3, compliances, 2 sides, points)."""
    w = sample_points(window.octaves, per_octave, nodes)
    rows = np.empty((low_limit.size, w.size + 1), dtype=complex)
    rows[:, :-2] = samples[:, :-1]
    rows[:, :nodes] -= low_limit[:, None] / w[:nodes]
    rows[:, -2], rows[:, -1] = low_limit, w[-1] * samples[:, -1]
    octaves, points = window.octaves, window.points
    return inverse_transform(rows, octaves, points, (window.per_octave, per_octave), nodes)


def _hermite(means: Array, per_octave: int) -> Array:
    """Return coefficients (6, channels, 2 cells) from F_0, F_1, F_2 (3, channels, 2, points)."""
    step = log(2.0) / per_octave
    f_0, f_1, f_2 = means
    slope = (2.0 * step) * (f_1 - f_2)
    half = step**2 * (f_0 - f_1) - step * slope  # of the second derivative
    near, bend = slope[..., :-1], half[..., :-1]
    curl = half[..., 1:] - bend
    turn = slope[..., 1:] - near - 2.0 * bend
    rise = f_2[..., 1:] - f_2[..., :-1] - near - bend
    out = np.zeros((6, *f_2.shape[:-1], f_2.shape[-1] + 1))
    inner = out[..., 1:-1]
    out[0, ..., 1:], out[1, ..., 1:], inner[2] = f_2, slope, bend
    inner[3] = 10.0 * rise - 4.0 * turn + curl
    inner[4] = -15.0 * rise + 7.0 * turn - 2.0 * curl
    inner[5] = 6.0 * rise - 3.0 * turn + curl
    # Below the grid the fraction of the cell is 1 at the first point.
    out[0, ..., 0], out[1, ..., 0] = f_2[..., 0] - slope[..., 0], slope[..., 0]
    return np.concatenate([out[:, :, 1, ::-1], out[:, :, 0]], axis=-1)
