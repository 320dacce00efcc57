"""Winkler foundation and Kalker's simplified theory: each point of a surface is a spring."""

from __future__ import annotations

from dataclasses import dataclass
from math import cbrt, copysign

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rollnip._errors import require_finite
from rollnip.closed_forms._common import parabola, require_all_positive, require_below_bound


@dataclass(frozen=True, slots=True)
class WinklerContact:
    """Contact on a bed of springs, |x| <= half_width.

    Attributes
    ----------
    half_width :
        a [mm].
    peak_pressure :
        p0 [MPa], at x = 0.
    approach :
        delta [mm].
    """

    half_width: float
    peak_pressure: float
    approach: float

    def pressure(self, x: ArrayLike) -> NDArray[np.float64]:
        """Return p(x) = p0 (1 - x^2/a^2) [MPa], 0 outside; x [mm] of any shape."""
        return self.peak_pressure * parabola(x, self.half_width)


@dataclass(frozen=True, slots=True)
class SimplifiedRolling:
    """Steady rolling on springs: stick from the leading edge x = a on, slip behind.

    Attributes
    ----------
    contact :
        the pressure.
    friction :
        mu.
    flexibility :
        L [mm/MPa].
    traction :
        T = int q dx [N/mm].
    creepage :
        xi, of the sign of T.
    stick_from :
        trailing end of the stick zone [mm]; the leading edge where the whole nip slips.
    """

    contact: WinklerContact
    friction: float
    flexibility: float
    traction: float
    creepage: float
    stick_from: float

    def shear(self, x: ArrayLike) -> NDArray[np.float64]:
        """Return the shear q(x) [MPa] on the upper roller along +x, x [mm] of any shape."""
        place = np.asarray(x, dtype=np.float64)
        bound = self.friction * self.contact.pressure(place)
        travelled = np.maximum(self.contact.half_width - place, 0.0)
        stuck = abs(self.creepage) * travelled / self.flexibility
        size = np.where(place > self.stick_from, stuck, bound)
        return np.asarray(np.sign(self.creepage) * size)


def winkler_contact(*, load: float, radius: float, foundation: float) -> WinklerContact:
    """Return the contact of a cylinder with a Winkler foundation, p = k (delta - x^2/(2 R)).

    a^3 = 3 F R/(2 k), p0 = k a^2/(2 R), delta = a^2/(2 R). Valid for a compressible coating much
    thinner than the nip is wide (see `thin_compressible_layer`); not for rubber of nu = 0.5.

    Parameters
    ----------
    load :
        line load F [N/mm], positive.
    radius :
        effective radius R [mm].
    foundation :
        k [MPa/mm], pressure per displacement, of both rollers in series.

    Returns
    -------
    WinklerContact.

    Raises
    ------
    InvalidInputError
        where a parameter is not positive and finite.

    References
    ----------
    Johnson (1985), Contact Mechanics, section 4.3.
    """
    require_all_positive({"load": load, "radius": radius, "foundation": foundation})
    half_width = cbrt(1.5 * load * radius / foundation)
    approach = half_width * half_width / (2.0 * radius)
    return WinklerContact(
        half_width=half_width, peak_pressure=foundation * approach, approach=approach
    )


def simplified_rolling(
    *,
    load: float,
    radius: float,
    foundation: float,
    flexibility: float,
    friction: float,
    traction: float,
) -> SimplifiedRolling:
    """Return the rolling on springs in both directions under a given traction.

    u_t = L q. In stick du_t/dx = -xi from q = 0 at the leading edge, so that q = xi (a - x)/L until
    it meets mu p = mu k (a - x)(a + x)/(2 R), at x = a (2 zeta - 1), zeta = |xi| R/(L mu k a). T =
    mu F [1 - (1 - zeta)^3] sign(xi); from zeta = 1 on the nip slides.

    Parameters
    ----------
    load :
        line load F [N/mm], positive.
    radius :
        effective radius R [mm].
    foundation :
        k [MPa/mm].
    flexibility :
        L [mm/MPa], tangential displacement of both rollers per shear; h/G for a thin layer.
    friction :
        mu, positive.
    traction :
        T [N/mm], |T| < mu F.

    Returns
    -------
    SimplifiedRolling.

    Raises
    ------
    InvalidInputError
        where a parameter lies outside its range.

    References
    ----------
    Kalker (1973), The simplified theory of rolling contact, Delft Progr. Rep. 1, 1-10, here with
    the parabolic pressure of normal springs.
    """
    contact = winkler_contact(load=load, radius=radius, foundation=foundation)
    require_all_positive({"flexibility": flexibility, "friction": friction})
    require_below_bound(traction, friction * load)
    zeta = 1.0 - cbrt(1.0 - abs(traction) / (friction * load))
    largest = flexibility * friction * foundation * contact.half_width / radius
    return SimplifiedRolling(
        contact=contact,
        friction=friction,
        flexibility=flexibility,
        traction=traction,
        creepage=copysign(zeta * largest, traction),
        stick_from=contact.half_width * (2.0 * zeta - 1.0),
    )


def simplified_rolling_at_creepage(
    *,
    load: float,
    radius: float,
    foundation: float,
    flexibility: float,
    friction: float,
    creepage: float,
) -> SimplifiedRolling:
    """Return the rolling on springs at a given creepage; see `simplified_rolling`."""
    contact = winkler_contact(load=load, radius=radius, foundation=foundation)
    require_all_positive({"flexibility": flexibility, "friction": friction})
    require_finite("creepage", creepage)
    largest = flexibility * friction * foundation * contact.half_width / radius
    zeta = min(abs(creepage) / largest, 1.0)
    return SimplifiedRolling(
        contact=contact,
        friction=friction,
        flexibility=flexibility,
        traction=copysign(friction * load * (1.0 - (1.0 - zeta) ** 3), creepage),
        creepage=creepage,
        stick_from=contact.half_width * (2.0 * zeta - 1.0),
    )
