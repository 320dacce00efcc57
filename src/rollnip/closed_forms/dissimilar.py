"""Free rolling of dissimilar half-spaces (Bentall & Johnson), in both limits of friction.

Pressure p stretches the surface of a half-space by du_x/dx = -(1 - 2 nu)/(2 G) p. Two bodies differ
by -B p, B = (1 - 2 nu_u)/(2 G_u) - (1 - 2 nu_l)/(2 G_l), and must creep even without traction.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import asin, atanh, cosh, pi, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

from rollnip._errors import require_positive
from rollnip.closed_forms._common import require_all_positive, require_poisson
from rollnip.closed_forms.hertz import HertzLine, hertz_line


@dataclass(frozen=True, slots=True)
class VanishingFriction:
    """Free rolling in the limit mu -> 0.

    Attributes
    ----------
    hertz :
        the pressure.
    creepage :
        xi; positive where the upper roller is the softer and more compressible one.
    reversal :
        |x| [mm] at which the direction of slip changes.
    """

    hertz: HertzLine
    creepage: float
    reversal: float


@dataclass(frozen=True, slots=True)
class FullStick:
    """Free rolling in the limit mu -> infinity: stick everywhere in |x| <= half_width.

    Attributes
    ----------
    half_width :
        a [mm], smaller than Hertz's.
    creepage :
        xi.
    index :
        eta of the oscillating edge, (1/2 pi) ln((1 + beta)/(1 - beta)).
    peak_pressure :
        p(0) [MPa].
    """

    half_width: float
    creepage: float
    index: float
    peak_pressure: float

    def pressure(self, x: ArrayLike) -> NDArray[np.float64]:
        """Return p(x) [MPa], x [mm] of any shape; it oscillates endlessly close to the edges."""
        return np.real(self._tractions(x))

    def shear(self, x: ArrayLike) -> NDArray[np.float64]:
        """Return q(x) [MPa] on the upper roller along +x, x [mm] of any shape; odd in x."""
        return np.imag(self._tractions(x))

    def _tractions(self, x: ArrayLike) -> NDArray[np.complex128]:
        """Return p + i q = p(0) sqrt(1 - y^2) ((1 + y)/(1 - y))^{i eta}, y = x/a."""
        y = np.asarray(x, dtype=np.float64) / self.half_width
        inside = np.abs(y) < 1.0
        y = np.where(inside, y, 0.0)
        value = np.sqrt((1.0 - y) * (1.0 + y)) * np.exp(2j * self.index * np.arctanh(y))
        return np.where(inside, self.peak_pressure * value, 0.0)


def free_rolling_vanishing_friction(
    *,
    load: float,
    radius: float,
    shear_modulus_upper: float,
    poisson_upper: float,
    shear_modulus_lower: float,
    poisson_lower: float,
) -> VanishingFriction:
    """Return the free rolling of dissimilar cylinders with vanishing friction.

    The whole nip slips with the velocity s = -V (xi - B p), p Hertzian. Zero total traction
    requires as much load in the middle, |x| < c, as outside it: asin(c/a) + (c/a) sqrt(1 - c^2/a^2)
    = pi/4, c = .40397 a, and xi = B p0 sqrt(1 - c^2/a^2) = .91477 B p0.

    Parameters
    ----------
    load :
        line load F [N/mm], positive.
    radius :
        effective radius R [mm].
    shear_modulus_upper, shear_modulus_lower :
        G [MPa], positive and finite.
    poisson_upper, poisson_lower :
        Poisson ratios, in (-1, 0.5].

    Returns
    -------
    VanishingFriction.

    Raises
    ------
    InvalidInputError
        where a parameter lies outside its range.

    References
    ----------
    Bentall & Johnson (1967), Int. J. Mech. Sci. 9, 389-404; Johnson (1985), Contact Mechanics,
    section 8.2.
    """
    pair = _pair(shear_modulus_upper, poisson_upper, shear_modulus_lower, poisson_lower)
    hertz = hertz_line(load=load, radius=radius, contact_modulus=2.0 / pair.normal)
    share = float(brentq(_half_load, 0.0, 1.0, xtol=1e-15))
    return VanishingFriction(
        hertz=hertz,
        creepage=pair.mismatch * hertz.peak_pressure * sqrt(1.0 - share**2),
        reversal=share * hertz.half_width,
    )


def free_rolling_full_stick(
    *,
    load: float,
    radius: float,
    shear_modulus_upper: float,
    poisson_upper: float,
    shear_modulus_lower: float,
    poisson_lower: float,
) -> FullStick:
    """Return the free rolling of dissimilar cylinders that stick everywhere in the nip.

    beta = B/A, A = (1 - nu_u)/G_u + (1 - nu_l)/G_l;  eta = (1/2 pi) ln((1 + beta)/(1 - beta));
    a^2 (1 + 4 eta^2) = 2 A F R/pi;  xi = 2 eta a/R;
    p + i q = cosh(pi eta)/(A R) sqrt(a^2 - x^2) ((a + x)/(a - x))^{i eta}.
    Parameters and errors as in `free_rolling_vanishing_friction`.

    Derivation: with H f = (1/pi) pv int f(t)/(t - x) dt, contact is A H p + B q = -x/R and stick is
    A H q - B p = -xi, so that f = p + i q obeys H f - i beta f = -(x/R + i xi)/A. Its Cauchy
    integral is the polynomial i (z/R + i xi)/(2 A) minus i X(z)/(2 A R), X = sqrt(z^2 - a^2) ((z +
    a)/(z - a))^{i eta}, bounded at both edges. It must vanish at infinity like 1/z, which gives xi;
    the coefficient of 1/z is the load. The imaginary part of the load, T, is 0.

    References
    ----------
    Bentall & Johnson (1967), Int. J. Mech. Sci. 9, 389-404 (the limit of large friction);
    Muskhelishvili (1953), Singular Integral Equations, for the method.
    """
    pair = _pair(shear_modulus_upper, poisson_upper, shear_modulus_lower, poisson_lower)
    require_all_positive({"load": load, "radius": radius})
    index = atanh(pair.mismatch / pair.normal) / pi
    half_width = sqrt(2.0 * pair.normal * load * radius / (pi * (1.0 + 4.0 * index**2)))
    return FullStick(
        half_width=half_width,
        creepage=2.0 * index * half_width / radius,
        index=index,
        peak_pressure=cosh(pi * index) * half_width / (pair.normal * radius),
    )


class _Pair(NamedTuple):
    normal: float  # A [1/MPa], 2/E*
    mismatch: float  # B [1/MPa]


def _pair(
    shear_upper: float, poisson_upper: float, shear_lower: float, poisson_lower: float
) -> _Pair:
    require_positive("shear_modulus_upper", shear_upper)
    require_positive("shear_modulus_lower", shear_lower)
    require_poisson("poisson_upper", poisson_upper)
    require_poisson("poisson_lower", poisson_lower)
    upper, lower = 0.5 / shear_upper, 0.5 / shear_lower
    return _Pair(
        normal=2.0 * (1.0 - poisson_upper) * upper + 2.0 * (1.0 - poisson_lower) * lower,
        mismatch=(1.0 - 2.0 * poisson_upper) * upper - (1.0 - 2.0 * poisson_lower) * lower,
    )


def _half_load(share: float) -> float:
    return asin(share) + share * sqrt(1.0 - share**2) - 0.25 * pi
