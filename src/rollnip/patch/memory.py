"""Kernels of viscoelastic rollers: each is an elastic-like kernel, instantaneous and delayed.

The material moves along -x with the speed V, so that it sees a wave e^{i kx x} at s = -i kx V, and
the compliance depends on kx besides k. With lengths l_n in a geometric series it is

    C(k, kx) = A_0(k) + sum_n A_n(k)/(1 - i kx l_n),

A_n real, by least squares over the wave numbers kx that a grid can hold. In space each A_n is a
kernel like that of an elastic body, a function of the distance, and 1/(1 - i kx l) is a weighted
mean over what lies upstream:

    v(x) = int_0^inf u(x + s) e^{-s/l} ds/l.

The displacement is therefore free of images, as that of elastic bodies is. As a matrix over n, the
A_n are products of a few kernels with their shares (one kernel where all layers are of one
material).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rollnip.compliance import flat_compliance, half_space_limit, shear_compliance
from rollnip.materials import Material
from rollnip.patch.coefficients import (
    Array,
    Coefficients,
    Grid,
    both_sides,
    gauss,
    half_space_at,
    layered_at,
    quadrant,
)
from rollnip.patch.convolution import ComplexArray
from rollnip.patch.kernels import (
    FADED,
    HalfSpace,
    PairKernel,
    RadialTable,
    tabulated,
    wave_numbers,
)
from rollnip.rollers import Roller

Stack = tuple[Array, ComplexArray, Array, ComplexArray | None, float]

_RATIO = 1.6
"""Ratio of successive delays: a delay between two of them is approximated to e^(-pi^2/(2 ln 1.6)) =
3e-5.
"""
_COARSE, _FINE = 0.02, 10.0
"""Range of wave numbers: over 1/length of the grid, and over 1/side of a rectangle."""
_BEYOND = 2
"""Number of delays beyond the range of these wave numbers, at each end."""
_PER_DELAY = 2
"""Number of sampled wave numbers per delay."""
_ALIKE = 1e-7
"""Share of the compliance below which a kernel is left out."""
_FAR = 8.0
"""Thicknesses beyond the grid up to which the effect of layers on a rigid core is tabulated."""
_SEEN = 40.0
"""Delay lengths after which nothing is left, e^-40."""
_POINTS = 6
"""Number of Gauss points between one distance upstream of the grid and twice that distance."""
_LONG = 1e-4
"""Smallest wave number times the total thickness."""
_PER_E_FOLD = 25.0
"""Number of wave numbers in a factor e at which layers are computed, with a cubic spline in
between.
"""
_AT_ONCE = 200_000
"""Number of wave vectors whose compliance is computed at once."""


@dataclass(frozen=True, slots=True)
class Upstream:
    """Places upstream of a grid from which delayed displacements arrive.

    Attributes
    ----------
    places : distances beyond the last place of the grid, (m,) [mm].
    weights : of Gauss points on panels that double in length, (m,) [mm].
    """

    places: Array
    weights: Array

    @classmethod
    def of(cls, grid: Grid, longest: float) -> Upstream:
        """Return the places for delay lengths up to the longest [mm]."""
        panels = int(np.ceil(np.log2(_SEEN * longest / grid.hx))) + 1
        edges = grid.hx * np.concatenate([[0.0], 2.0 ** np.arange(panels)])
        points, weights = np.polynomial.legendre.leggauss(_POINTS)
        half = 0.5 * np.diff(edges)[:, None]
        return cls((edges[:-1, None] + half * (1.0 + points)).ravel(), (half * weights).ravel())

    def means(self, length: float) -> Array:
        """Return the weights of a mean with the weight e^{-s/l}, (m,)."""
        return np.asarray(self.weights * np.exp(-self.places / length) / length)


@dataclass(frozen=True)
class Delays:
    """The share of a kernel that acts at once, and the shares that act with delays.

    Attributes
    ----------
    at_once : the share in A_0.
    shares, lengths : (n,) shares in A_n, and l_n [mm].
    """

    at_once: float
    shares: Array
    lengths: Array

    def applied(self, values: Array, side: float, upstream: Upstream, beyond: Array) -> Array:
        """Return values on a grid with the shares at once and delayed, (..., n).

        Parameters
        ----------
        values : (..., n) over x in steps of ``side`` [mm], linear in between.
        upstream : distances beyond the last place, (m,) [mm].
        beyond : the values there, (..., m).
        """
        # imported here because it loads some eighty modules, which only viscoelastic patches need
        from scipy.signal import lfilter

        out = self.at_once * values
        flow = values[..., ::-1]
        for share, length in zip(self.shares, self.lengths, strict=True):
            kept = np.exp(-side / length)
            later = -length / side * np.expm1(-side / length)  # the mean of e^{-s/l} over a side
            first, second = 1.0 - later, later - kept
            start = beyond @ upstream.means(length)
            state = second * flow[..., 0] + kept * start
            rest, _ = lfilter(
                [first, second], [1.0, -kept], flow[..., 1:], zi=state[..., None], axis=-1
            )
            out[..., -1] += share * start
            out[..., :-1] += share * rest[..., ::-1]
        return out


@dataclass(frozen=True)
class DelayedKernel:
    """One elastic-like kernel of a roller, and its delays.

    Attributes
    ----------
    kernel : of the surface.
    far : the half-space that it equals beyond the reach of its table; 0 over a rigid core.
    delays : its shares.
    """

    kernel: PairKernel
    far: HalfSpace
    delays: Delays

    def values(self, grid: Grid) -> Array:
        """Return the coefficients xx, xy, yy, zz, xz, yz on a grid, (6, ny + 1, 2 nx + 1)."""
        here = both_sides(quadrant(self.kernel, grid))
        upstream = Upstream.of(grid, float(self.delays.lengths[-1]))
        x = grid.nx * grid.hx + upstream.places[None, :]
        y = np.arange(grid.ny + 1)[:, None] * grid.hy
        beyond = np.zeros((6, grid.ny + 1, upstream.places.size))
        for dy, weight in zip(*gauss(grid.hy, self._smooth(grid)), strict=True):
            beyond += grid.hx * weight * self._at(x, y + dy)
        return self.delays.applied(here, grid.hx, upstream, beyond)

    def _smooth(self, grid: Grid) -> float:
        """Return a length over which the kernel is smooth beyond the grid [mm]."""
        beside = grid.nx * grid.hx
        return min([beside, *(table.finest for table, _ in self.kernel.tables)])

    def _at(self, x: Array, y: Array) -> Array:
        """Return the displacements under point forces far away, (6, ...) [1/N]."""
        x, y = np.broadcast_arrays(x, y)
        if not self.kernel.tables:
            return half_space_at(self.kernel.half_space, x, y)
        out = half_space_at(self.far, x, y)
        ((table, sign),) = self.kernel.tables
        near = np.hypot(x, y) <= table.reach
        out[:, near] = half_space_at(self.kernel.half_space, x[near], y[near])
        out[:, near] += layered_at(table, x[near], y[near], sign)
        return out


@dataclass(frozen=True)
class Scales:
    """Lengths that kernels must resolve, rounded so that similar grids share them.

    Attributes
    ----------
    reach : largest distance [mm].
    low, high : smallest and largest wave number kx [1/mm].
    """

    reach: float
    low: float
    high: float

    @classmethod
    def of(cls, grid: Grid, thickness: float) -> Scales:
        """Return the scales of a grid, for layers of a given total thickness [mm]."""
        return cls(
            reach=_rounded(grid.reach + _FAR * thickness, 2.0),
            low=1.0 / _rounded(grid.nx * grid.hx / _COARSE, 4.0),
            high=_rounded(_FINE / grid.hx, 4.0),
        )


def _rounded(value: float, base: float) -> float:
    """Return the next power of a base at or above a value."""
    return float(base ** np.ceil(np.log(value) / np.log(base)))


def moving_coefficients(kernels: Sequence[DelayedKernel], grid: Grid, alike: bool) -> Coefficients:
    """Return the influence coefficients of two rolling bodies together on a grid.

    Parameters
    ----------
    kernels : of both bodies.
    grid : rectangles.
    alike : whether both have the same layers and core; pressure then does not shear them.
    """
    values = np.zeros((6, grid.ny + 1, 2 * grid.nx + 1))
    for one in kernels:
        values += one.values(grid)
    if alike:
        values[4:] = 0.0
    xx, xy, yy, zz, xz, yz = values
    return Coefficients(xx, xy, yy, zz, xz, yz, is_symmetric=False)


def delayed_kernels(
    roller: Roller, scales: Scales, speed: float, sign: float
) -> list[DelayedKernel]:
    """Return the kernels of a roller that deforms.

    Parameters
    ----------
    roller : with layers or a half-space core.
    scales : what they must resolve.
    speed : V [mm/s].
    sign : sign of the displacement along the surface under pressure: 1 for the upper roller, -1 for
        the lower one.
    """
    lengths, kx = _delays(scales)
    k = _sampled_waves(roller)
    ends = [_limits(m, kx, speed) for m in (roller.materials[0], roller.materials[-1])]
    sampled = _sampled(roller, k, kx, speed)
    sampled = np.concatenate([sampled, np.stack(ends).transpose(2, 1, 0)], axis=-1)
    shares, parts = _parted(sampled.reshape(kx.size, -1), kx, lengths)
    parts = parts.reshape(-1, 4, k.size + 2)
    top, far = parts[..., -2], parts[..., -1]
    if roller.core is None:
        far = np.zeros_like(far)
    tables = _tables(roller, k, parts[..., :-2] - top[..., None], scales.reach)
    kernels = []
    for i, share in enumerate(shares.T):
        bodies = [HalfSpace(*(float(v) for v in one[i])) for one in (top, far)]
        if sign < 0.0:
            bodies = [one.mirrored() for one in bodies]
        table = () if not tables else ((tables[i], sign),)
        delays = Delays(float(share[0]), share[1:], lengths)
        kernels.append(DelayedKernel(PairKernel(bodies[0], table), bodies[1], delays))
    return kernels


def _tables(roller: Roller, k: Array, rests: Array, reach: float) -> list[RadialTable]:
    """Return what layers add to each kernel, over the distance; an empty list without layers."""
    if not roller.layers:
        return []
    thinnest = min(layer.thickness for layer in roller.layers)
    waves, weights = wave_numbers(thinnest, reach)
    from scipy.interpolate import CubicSpline

    spline = CubicSpline(np.log(k), rests, axis=-1)
    fine = spline(np.log(np.clip(waves, k[0], k[-1])))
    return tabulated((waves, weights), fine, thinnest, reach)


def waves_at(roller: Roller, k: Array, kx: Array, speed: float) -> ComplexArray:
    """Return S, T, Z and X of a rolling body for given wave vectors, (4, n) [mm/MPa].

    Parameters
    ----------
    roller : with layers or a half-space core.
    k, kx : (n,) length of the wave vector, and its component along x [1/mm].
    speed : V [mm/s].
    """
    out = np.empty((4, k.size), dtype=complex)
    for first in range(0, k.size, _AT_ONCE):
        part = slice(first, first + _AT_ONCE)
        stack = roller_stack(roller, kx[part], speed)
        plane = flat_compliance(k[part], *stack)
        across = shear_compliance(k[part], *stack)
        out[:, part] = across, plane.xx - across, plane.zz, plane.xz / 1j
    return out


def roller_stack(roller: Roller, kx: Array, speed: float) -> Stack:
    """Return a rolling body as the arguments of `rollnip.compliance`, at wave numbers kx, (n,).

    Thicknesses, moduli (layers, n), Poisson ratios, and the core's modulus (n,) and Poisson ratio.
    """
    s = -1j * kx * speed
    thickness = np.array([layer.thickness for layer in roller.layers])
    young = np.array([layer.material.modulus_at(s) for layer in roller.layers])
    poisson = np.array([layer.material.poisson for layer in roller.layers])
    young = young.reshape(thickness.size, kx.size)
    if roller.core is None:
        return thickness, young, poisson, None, 0.5
    return thickness, young, poisson, roller.core.modulus_at(s), roller.core.poisson


def _delays(scales: Scales) -> tuple[Array, Array]:
    """Return delays in a geometric series [mm] and the wave numbers kx to fit [1/mm]."""
    low, high = scales.low, scales.high
    count = int(np.ceil(np.log(high / low) / np.log(_RATIO))) + 2 * _BEYOND + 1
    lengths = _RATIO ** (np.arange(count) - _BEYOND) / high
    return np.asarray(lengths), np.geomspace(low, high, _PER_DELAY * count)


def _sampled_waves(roller: Roller) -> Array:
    """Return the wave numbers at which layers are computed, (n,) [1/mm]; empty without layers."""
    if not roller.layers:
        return np.zeros(0)
    first = _LONG / roller.coating_thickness
    last = FADED / min(layer.thickness for layer in roller.layers)
    return np.geomspace(first, last, int(_PER_E_FOLD * np.log(last / first)) + 1)


def _limits(material: Material, kx: Array, speed: float) -> ComplexArray:
    """Return k times S, T, Z and X of a half-space, (4, n) [1/MPa]."""
    young = material.modulus_at(-1j * kx * speed)
    even, odd = half_space_limit(young, material.poisson)
    across = 2.0 * (1.0 + material.poisson) / young
    return np.stack([across, even - across, even, odd])


def _sampled(roller: Roller, k: Array, kx: Array, speed: float) -> ComplexArray:
    """Return k times S, T, Z and X, (m, 4, n) for m wave numbers kx and n lengths k [1/MPa]."""
    if not k.size:
        return np.zeros((kx.size, 4, 0), dtype=complex)
    wide_k, wide_x = (
        np.broadcast_to(k, (kx.size, k.size)),
        np.broadcast_to(kx[:, None], (kx.size, k.size)),
    )
    waves = waves_at(roller, wide_k.ravel(), wide_x.ravel(), speed) * wide_k.ravel()
    return np.asarray(waves.reshape(4, kx.size, k.size).transpose(1, 0, 2))


def _parted(sampled: ComplexArray, kx: Array, lengths: Array) -> tuple[Array, Array]:
    """Return shares, (1 + n, m), and m functions, whose products are A_0 ... A_n at every place.

    Parameters
    ----------
    sampled : (len(kx), places) values of C.
    kx : wave numbers [1/mm].
    lengths : l_n [mm].
    """
    terms = 1.0 / (1.0 - 1j * kx[:, None] * lengths[None, :])
    matrix = np.concatenate([np.ones((kx.size, 1)), terms], axis=1)
    both = np.concatenate([matrix.real, matrix.imag])
    found = np.linalg.lstsq(both, np.concatenate([sampled.real, sampled.imag]), rcond=1e-10)[0]
    left, sizes, right = np.linalg.svd(found, full_matrices=False)
    count = int(np.sum(sizes > _ALIKE * sizes[0]))
    return left[:, :count], sizes[:count, None] * right[:count]
