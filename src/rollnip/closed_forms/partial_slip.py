"""Partial slip of elastically similar half-spaces: Carter (rolling) and Cattaneo (at rest).

Bodies are similar if they are identical, both incompressible, or any pair with equal (1 - 2 nu)/G.
Pressure then causes no slip and stays Hertzian, whatever the shear.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import copysign, sqrt

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rollnip._errors import require_finite, require_positive
from rollnip.closed_forms._common import half_ellipse, require_below_bound
from rollnip.closed_forms.hertz import HertzLine, hertz_line


@dataclass(frozen=True, slots=True)
class Carter:
    """Steady rolling with partial slip: stick at the leading edge x = a, slip at the trailing one.

    Attributes
    ----------
    hertz :
        the pressure.
    friction :
        mu.
    traction :
        T = int q dx [N/mm].
    creepage :
        xi, of the sign of T.
    stick_half_width :
        c [mm]; the stick zone is [a - 2c, a], empty where c = 0 (sliding).
    """

    hertz: HertzLine
    friction: float
    traction: float
    creepage: float
    stick_half_width: float

    @property
    def stick(self) -> tuple[float, float]:
        """Stick zone [mm], trailing end first."""
        edge = self.hertz.half_width
        return (edge - 2.0 * self.stick_half_width, edge)

    def shear(self, x: ArrayLike) -> NDArray[np.float64]:
        """Return the shear q(x) [MPa] on the upper roller along +x, x [mm] of any shape."""
        centre = self.hertz.half_width - self.stick_half_width
        size = _shear_size(x, self.hertz, self.friction, self.stick_half_width, centre)
        return np.asarray(np.sign(self.traction) * size)


@dataclass(frozen=True, slots=True)
class Cattaneo:
    """Partial slip at rest: pressed together first, then sheared; stick in the middle, |x| <= c.

    Attributes
    ----------
    hertz :
        the pressure.
    friction :
        mu.
    traction :
        T = int q dx [N/mm].
    stick_half_width :
        c [mm].
    """

    hertz: HertzLine
    friction: float
    traction: float
    stick_half_width: float

    def shear(self, x: ArrayLike) -> NDArray[np.float64]:
        """Return the shear q(x) [MPa] on the upper body along +x, x [mm] of any shape."""
        size = _shear_size(x, self.hertz, self.friction, self.stick_half_width, 0.0)
        return np.asarray(np.sign(self.traction) * size)


def carter(
    *, load: float, radius: float, contact_modulus: float, friction: float, traction: float
) -> Carter:
    """Return the rolling of similar cylinders under a given traction.

    q = mu p0 [sqrt(1 - x^2/a^2) - (c/a) sqrt(1 - (x - d)^2/c^2)], d = a - c, the second term where
    |x - d| <= c;  c = a sqrt(1 - |T|/(mu F));  xi = sign(T) mu (a - c)/R.

    Derivation: shear q causes du_t/dx = (2/E*) (1/pi) pv int q(t)/(t - x) dt, which for a half
    ellipse of height q0 and half-width a is -(2/E*) q0 x/a inside it. The two ellipses of q leave
    the constant -(2/E*) mu p0 d/a = -mu d/R in the stick zone, and stick is xi + du_t/dx = 0.

    Parameters
    ----------
    load :
        line load F [N/mm], positive.
    radius :
        effective radius R [mm].
    contact_modulus :
        E* [MPa].
    friction :
        mu, positive.
    traction :
        T [N/mm], |T| < mu F; positive where the upper roller drives.

    Returns
    -------
    Carter.

    Raises
    ------
    InvalidInputError
        where a parameter lies outside its range.

    References
    ----------
    Carter (1926), Proc. R. Soc. A 112, 151-157; Johnson (1985), Contact Mechanics, section 8.3.
    """
    hertz = hertz_line(load=load, radius=radius, contact_modulus=contact_modulus)
    require_positive("friction", friction)
    require_below_bound(traction, friction * load)
    share = abs(traction) / (friction * load)
    root = sqrt(1.0 - share)
    shortfall = hertz.half_width * share / (1.0 + root)  # a - c, without cancellation
    return Carter(
        hertz=hertz,
        friction=friction,
        traction=traction,
        creepage=copysign(friction * shortfall / radius, traction),
        stick_half_width=hertz.half_width * root,
    )


def carter_at_creepage(
    *, load: float, radius: float, contact_modulus: float, friction: float, creepage: float
) -> Carter:
    """Return the rolling of similar cylinders at a given creepage; see `carter`.

    c = a - R |xi|/mu; from |xi| = mu a/R on the nip slides: c = 0 and |T| = mu F.
    """
    hertz = hertz_line(load=load, radius=radius, contact_modulus=contact_modulus)
    require_positive("friction", friction)
    require_finite("creepage", creepage)
    share = min(radius * abs(creepage) / (friction * hertz.half_width), 1.0)
    return Carter(
        hertz=hertz,
        friction=friction,
        traction=copysign(friction * load * share * (2.0 - share), creepage),
        creepage=creepage,
        stick_half_width=hertz.half_width * (1.0 - share),
    )


def cattaneo(
    *, load: float, radius: float, contact_modulus: float, friction: float, traction: float
) -> Cattaneo:
    """Return the contact of similar cylinders pressed together, then sheared without rolling.

    q = mu p0 [sqrt(1 - x^2/a^2) - (c/a) sqrt(1 - x^2/c^2)], c = a sqrt(1 - |T|/(mu F)). Parameters
    and errors as in `carter`. The shift of the bodies is not defined in plane strain.

    References
    ----------
    Cattaneo (1938), Rend. Accad. Naz. Lincei 27; Mindlin (1949), J. Appl. Mech. 16; Johnson (1985),
    Contact Mechanics, section 7.2.
    """
    hertz = hertz_line(load=load, radius=radius, contact_modulus=contact_modulus)
    require_positive("friction", friction)
    require_below_bound(traction, friction * load)
    root = sqrt(1.0 - abs(traction) / (friction * load))
    return Cattaneo(
        hertz=hertz,
        friction=friction,
        traction=traction,
        stick_half_width=hertz.half_width * root,
    )


def _shear_size(
    x: ArrayLike, hertz: HertzLine, friction: float, stick: float, centre: float
) -> NDArray[np.float64]:
    """Return the half ellipse of full slip minus the similar one over the stick zone."""
    inner = half_ellipse(np.asarray(x, dtype=np.float64) - centre, stick)
    outer = half_ellipse(x, hertz.half_width)
    return friction * hertz.peak_pressure * (outer - stick / hertz.half_width * inner)
