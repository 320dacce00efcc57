"""The half-space part of the field near the surface, in closed form.

For wave numbers whose wave does not reach the bottom of the top layer, the layer is a half-space
(flat) or a disc (ring). With zeta = x + i z' (z' = z, ring: z' = -R ln rho, rho = 1 - z/R),
delta = z (1 - z/(2R)), S = -t_z, T = -i t_x, each field times e^{ik zeta}, k > 0:

    s_zz = rho^-2 [S (rho^2 + k delta) + T (2 delta/R - k delta)]
    s_xz = -i rho^-2 [T + k delta (S - T)]
    s_xx = rho^-2 [-T + (S - T) (rho^2 - k delta)]
    u_x = (A t_x + i B t_z)/k - delta J (t_x + i t_z)
    u_z = (A t_z - i B t_x)/k + delta J (t_z - i t_x)

(Airy's function (a r^n + b r^(n+2)) e^{in theta}, n = k R; J = 1/(2G), A = 2(1-nu) J,
B = (1-2nu) J; on a ring the displacements hold to a relative 1/n.) In space, with the kinks kappa_j
of a traction and y_j = zeta - x_j, Phi_n = (1/pi) int_0^inf k^n t^(k) e^{ik zeta} dk is

    Phi_0 = (i/pi) sum kappa y ln y,   Phi_1 = (1/pi) sum kappa ln y,
    Phi_2 = -(i/pi) sum kappa/y,
    Phi_-1 = -(1/pi) [sum kappa (y^2/2) ln y - (3/2) F] + (F/pi) (i pi/2 - gamma),

the last as its finite part: as if only wave numbers above 1/mm counted in int dk/k.

Source: the potentials of plane elasticity, Muskhelishvili 1953, *Some Basic Problems of the
Mathematical Theory of Elasticity*, chapters 18 and 21; Johnson 1985, *Contact Mechanics*, 2.5.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np

from rollnip.interior.tractions import Array, ComplexArray, SurfaceTractions

_NEAREST = 1e-12
"""Smallest depth in ln y, over the half-width; it keeps k t finite at the nodes on the surface."""


@dataclass(frozen=True, slots=True)
class WaveNumberPowers:
    """Tractions times powers of the wave number: k^-1 t, t, k t and k^2 t, for t_x and t_z.

    Each is a pair of arrays of one shape, functions of k (transforms) or of x (their Phi).
    """

    minus: ComplexArray
    zero: ComplexArray
    one: ComplexArray
    two: ComplexArray

    def raised(self) -> WaveNumberPowers:
        """Return the powers times ik, for the derivative along x; do not use their ``two``."""
        return WaveNumberPowers(1j * self.zero, 1j * self.one, 1j * self.two, self.two)


@dataclass(frozen=True, slots=True)
class Depth:
    """Depths z, (nz, 1) [mm], under the surface of a roller of curvature 1/R; 0 where flat."""

    z: Array
    curvature: float

    @classmethod
    def of(cls, z: Array, curvature: float) -> Depth:
        """Return depths (nz,) as a column."""
        return cls(np.asarray(z)[:, None], curvature)

    @property
    def rho(self) -> Array:
        """r/R; 1 where flat."""
        return 1.0 - self.z * self.curvature

    @property
    def delta(self) -> Array:
        """The length z (1 - z/(2R)) [mm]."""
        return self.z * (1.0 - 0.5 * self.z * self.curvature)

    @property
    def logarithmic(self) -> Array:
        """-R ln(1 - z/R) [mm]; z where flat."""
        if self.curvature == 0.0:
            return self.z
        return -np.log1p(-self.z * self.curvature) / self.curvature

    def decay(self, k: Array) -> Array:
        """Return e^{-k z'}, (nz, n)."""
        return np.exp(-k * self.logarithmic)


def half_space_stress(t: WaveNumberPowers, depth: Depth) -> ComplexArray:
    """Return s_xx, s_zz, s_xz of a half-space or disc, (3, nz, n), without the decay."""
    s0, s1 = -t.zero[1], -t.one[1]
    t0, t1 = -1j * t.zero[0], -1j * t.one[0]
    d, square = depth.delta, depth.rho**2
    s_zz = s0 * square + s1 * d + 2.0 * d * depth.curvature * t0 - d * t1
    s_xz = -1j * (t0 + d * (s1 - t1))
    s_xx = -t0 + (s0 - t0) * square - d * (s1 - t1)
    return np.asarray(np.stack([s_xx, s_zz, s_xz]) / square, dtype=complex)


def half_space_displacement(
    t: WaveNumberPowers, depth: Depth, compliance: complex, poisson: float
) -> ComplexArray:
    """Return u_x, u_z of a half-space with 1/(2G) = ``compliance``, (2, nz, n), undecayed."""
    a, b = 2.0 * (1.0 - poisson), 1.0 - 2.0 * poisson
    d = depth.delta
    u_x = a * t.minus[0] + 1j * b * t.minus[1] - d * (t.zero[0] + 1j * t.zero[1])
    u_z = a * t.minus[1] - 1j * b * t.minus[0] + d * (t.zero[1] - 1j * t.zero[0])
    return compliance * np.stack([u_x, u_z])


def half_space_sinking(loads: Array, compliance: complex, poisson: float) -> Array:
    """Return the real part of k u_x, k u_z of a half-space as k -> 0 under line loads (2,) [mm]."""
    a, b = 2.0 * (1.0 - poisson), 1.0 - 2.0 * poisson
    along, inward = loads
    sinking = compliance * np.array([a * along + 1j * b * inward, a * inward - 1j * b * along])
    return np.asarray(sinking.real)


def spectral_powers(transforms: ComplexArray, k: Array) -> WaveNumberPowers:
    """Return the powers of the transforms (2, n) at the surface."""
    once = transforms * k
    return WaveNumberPowers(transforms / k, transforms, once, once * k)


def potentials(
    tractions: SurfaceTractions, depth: Depth, x: Array, *, two: bool
) -> WaveNumberPowers:
    """Return Phi_-1, Phi_0, Phi_1 and, with ``two``, Phi_2 of t_x and t_z at one depth, (2, x).

    ``x`` are places from the centre of the tractions.
    """
    places, kinks = tractions.places, tractions.kinks
    down = float(depth.logarithmic[0, 0])
    height = max(down, _NEAREST * tractions.half_width)
    across = x[:, None] - places[None, :]
    square = across * across + height * height
    weights = np.concatenate([kinks, kinks * places, kinks * places**2]).T
    # The angle of y; arctan is twice as fast as arctan2.
    angle = (0.5 * pi - np.arctan(across / height)) @ weights
    level = np.log(square) @ weights
    sums = (0.5 * level + 1j * angle).T.reshape(3, 2, -1)
    zeta = x + 1j * down
    first = zeta * sums[0] - sums[1]
    second = 0.5 * (zeta * (first - sums[1]) + sums[2])
    constant = tractions.resultants[:, None] * (1.5 + 0.5j * pi - np.euler_gamma)
    inverse = np.zeros_like(first)
    if two:
        inverse = ((across / square) @ kinks.T - 1j * ((height / square) @ kinks.T)).T
    return WaveNumberPowers(
        minus=(constant - second) / pi,
        zero=1j * first / pi,
        one=sums[0] / pi,
        two=-1j / pi * inverse,
    )
