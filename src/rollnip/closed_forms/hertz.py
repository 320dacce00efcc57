"""Hertz contact: of two half-spaces along a line, with the stress inside, and over an ellipse."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, pi, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rollnip._errors import InvalidInputError, require_positive
from rollnip.closed_forms._common import half_ellipse, require_all_positive, require_poisson


class InteriorStress(NamedTuple):
    """Stress components [MPa] at points inside a body; tension is positive."""

    s_xx: NDArray[np.float64]
    s_zz: NDArray[np.float64]
    s_xz: NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class HertzLine:
    """A Hertzian line contact, |x| <= half_width, without friction.

    Attributes
    ----------
    half_width :
        a [mm].
    peak_pressure :
        p0 [MPa], at x = 0.
    """

    half_width: float
    peak_pressure: float

    def pressure(self, x: ArrayLike) -> NDArray[np.float64]:
        """Return p(x) = p0 sqrt(1 - x^2/a^2) [MPa], 0 outside; x [mm] of any shape."""
        return self.peak_pressure * half_ellipse(x, self.half_width)

    def interior(self, x: ArrayLike, z: ArrayLike) -> InteriorStress:
        """Return the stress inside either body under this pressure alone.

        Exact for a half-space; independent of its moduli.

        Parameters
        ----------
        x, z :
            places [mm], broadcast together; z >= 0 is the depth.

        Returns
        -------
        InteriorStress [MPa] of the broadcast shape; s_xz in the frame of the body, x along the nip
        and z into the body.

        Raises
        ------
        InvalidInputError
            where a depth is negative.

        Notes
        -----
        With P the harmonic function that equals p on z = 0: s_zz = -P + z P_z, s_xx = -P - z P_z,
        s_xz = z P_x. For zeta = (x + i z)/a, P = p0 Re g with g = 1/(sqrt(1 - zeta^2) - i zeta),
        which loses no digits far away.

        References
        ----------
        McEwen (1949), Phil. Mag. 40, 454-459; Johnson (1985), Contact Mechanics, eq. 4.49.
        """
        place, depth = np.broadcast_arrays(np.asarray(x, float), np.asarray(z, float))
        if np.any(depth < 0.0):
            raise InvalidInputError(f"`z` must be zero or positive, got {float(depth.min())!r}.")
        zeta = (place + 1j * depth) / self.half_width
        root = np.sqrt(1.0 - zeta * zeta)
        root = root.real - 1j * np.copysign(np.abs(root.imag), place)  # the branch from z > 0
        harmonic = 1.0 / (root - 1j * zeta)
        regular = (depth > 0.0) & (root != 0.0)
        slope = np.where(regular, 1j * harmonic / np.where(regular, root, 1.0), 0.0)
        level, turn = depth / self.half_width * slope.imag, depth / self.half_width * slope.real
        return InteriorStress(
            s_xx=-self.peak_pressure * (harmonic.real - level),
            s_zz=-self.peak_pressure * (harmonic.real + level),
            s_xz=self.peak_pressure * turn,
        )


def hertz_line(*, load: float, radius: float, contact_modulus: float) -> HertzLine:
    """Return the line contact of two cylinders: a^2 = 4 F R/(pi E*), p0 = 2 F/(pi a).

    For elastic half-spaces, with a much smaller than the radii and than the thickness of any
    coating. The approach of the axles is not defined (it grows with the logarithm of the size of
    the bodies).

    Parameters
    ----------
    load :
        line load F [N/mm], positive.
    radius :
        effective radius R [mm], see `effective_radius`.
    contact_modulus :
        E* [MPa], see `contact_modulus`.

    Returns
    -------
    HertzLine.

    Raises
    ------
    InvalidInputError
        where a parameter is not positive and finite.

    References
    ----------
    Johnson (1985), Contact Mechanics, eqs 4.43, 4.45.
    """
    require_all_positive({"load": load, "radius": radius, "contact_modulus": contact_modulus})
    half_width = sqrt(4.0 * load * radius / (pi * contact_modulus))
    return HertzLine(half_width=half_width, peak_pressure=2.0 * load / (pi * half_width))


def contact_modulus(
    modulus_upper: float,
    poisson_upper: float,
    modulus_lower: float = inf,
    poisson_lower: float = 0.0,
) -> float:
    """Return E* [MPa], 1/E* = (1 - nu_u^2)/E_u + (1 - nu_l^2)/E_l; modulus inf is a rigid body.

    Raises InvalidInputError unless moduli are positive, one of them finite, and Poisson ratios lie
    in (-1, 0.5]. Johnson (1985), Contact Mechanics, section 4.2.
    """
    require_poisson("poisson_upper", poisson_upper)
    require_poisson("poisson_lower", poisson_lower)
    upper = _inverse("modulus_upper", modulus_upper) * (1.0 - poisson_upper**2)
    lower = _inverse("modulus_lower", modulus_lower) * (1.0 - poisson_lower**2)
    if upper + lower == 0.0:
        raise InvalidInputError("`modulus_upper` and `modulus_lower` must not both be inf.")
    return 1.0 / (upper + lower)


def effective_radius(radius_upper: float, radius_lower: float = inf) -> float:
    """Return R [mm], 1/R = 1/R_upper + 1/R_lower; a radius inf is a plane.

    Raises InvalidInputError unless radii are positive and one of them finite.
    """
    curvature = _inverse("radius_upper", radius_upper) + _inverse("radius_lower", radius_lower)
    if curvature == 0.0:
        raise InvalidInputError("`radius_upper` and `radius_lower` must not both be inf.")
    return 1.0 / curvature


def _inverse(name: str, value: float) -> float:
    if value == inf:
        return 0.0
    require_positive(name, value)
    return 1.0 / value


@dataclass(frozen=True, slots=True)
class HertzEllipse:
    """A Hertzian contact over an ellipse, without friction.

    Attributes
    ----------
    half_length, half_width :
        semi-axes along x and y [mm].
    peak_pressure :
        p0 [MPa]; p = p0 sqrt(1 - x^2/half_length^2 - y^2/half_width^2).
    approach :
        of points far inside both bodies [mm].
    """

    half_length: float
    half_width: float
    peak_pressure: float
    approach: float


def hertz_ellipse(
    *, load: float, curvature_x: float, curvature_y: float, contact_modulus: float
) -> HertzEllipse:
    """Return the contact of two half-spaces with the gap curvature_x x^2/2 + curvature_y y^2/2.

    Parameters
    ----------
    load :
        force [N], positive.
    curvature_x, curvature_y :
        sums of the curvatures of both bodies along x and y [1/mm], positive.
    contact_modulus :
        E* [MPa], see `contact_modulus`.

    Returns
    -------
    HertzEllipse.

    Raises
    ------
    InvalidInputError
        where a parameter is not positive and finite, or one curvature is more than 1e12 times the
        other.

    References
    ----------
    Johnson (1985), Contact Mechanics, eqs 4.24-4.28: with a the longer and b the shorter semi-axis
    and m = 1 - b^2/a^2, the ratio of the curvatures along a and b is (K - E) : ((a/b)^2 E - K).
    """
    from scipy.optimize import brentq
    from scipy.special import ellipe, ellipk

    require_all_positive(
        {
            "load": load,
            "curvature_x": curvature_x,
            "curvature_y": curvature_y,
            "contact_modulus": contact_modulus,
        }
    )
    small, large = sorted((curvature_x, curvature_y))
    if large > 1e12 * small:
        raise InvalidInputError(
            f"`curvature_x` and `curvature_y` must not differ by a factor beyond 1e12, got "
            f"{curvature_x!r} and {curvature_y!r}; take `hertz_line`."
        )
    if large - small <= 1e-7 * large:
        radius = 1.0 / sqrt(small * large)
        half = (0.75 * load * radius / contact_modulus) ** (1.0 / 3.0)
        return HertzEllipse(half, half, 1.5 * load / (pi * half**2), half**2 / radius)

    def wrong(ratio: float) -> float:
        m = 1.0 - ratio**2
        first, second = float(ellipk(m)), float(ellipe(m))
        return small * (second / ratio**2 - first) - large * (first - second)

    ratio = float(brentq(wrong, 1e-8, 1.0 - 1e-8, xtol=1e-15))
    m = 1.0 - ratio**2
    first, second = float(ellipk(m)), float(ellipe(m))
    # 0.5 small = p0/E* (b/a^2) (K - E)/m and p0 = 3 F/(2 pi a b)
    long = (3.0 * load * (first - second) / (pi * contact_modulus * small * m)) ** (1.0 / 3.0)
    short = ratio * long
    peak = 1.5 * load / (pi * long * short)
    approach = peak / contact_modulus * short * first
    along, across = (long, short) if curvature_x <= curvature_y else (short, long)
    return HertzEllipse(along, across, peak, approach)
