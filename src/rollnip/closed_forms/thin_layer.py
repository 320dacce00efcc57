"""Rigid cylinder on a layer much thinner than the nip is wide: compressible, or of nu = 0.5."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rollnip._errors import InvalidInputError
from rollnip.closed_forms._common import parabola, require_all_positive, require_poisson
from rollnip.closed_forms.simplified import winkler_contact


@dataclass(frozen=True, slots=True)
class ThinLayer:
    """Contact on a thin layer, |x| <= half_width, frictionless.

    Attributes
    ----------
    half_width :
        a [mm].
    peak_pressure :
        p0 [MPa], at x = 0.
    approach :
        delta [mm].
    exponent :
        n of p = p0 (1 - x^2/a^2)^n: 1 for a compressible layer, 2 for nu = 0.5.
    """

    half_width: float
    peak_pressure: float
    approach: float
    exponent: int

    def pressure(self, x: ArrayLike) -> NDArray[np.float64]:
        """Return p(x) = p0 (1 - x^2/a^2)^n [MPa], 0 outside; x [mm] of any shape."""
        return self.peak_pressure * parabola(x, self.half_width) ** self.exponent


def thin_compressible_layer(
    *, load: float, radius: float, modulus: float, poisson: float, thickness: float
) -> ThinLayer:
    """Return the contact with a thin compressible layer, whose columns cannot widen.

    p = k (delta - x^2/(2 R)), k = E (1 - nu)/((1 + nu)(1 - 2 nu) h);
    a^3 = 3 F R/(2 k), p0 = k a^2/(2 R), delta = a^2/(2 R).

    Leading term for a/h -> infinity, on a rigid base. Compared with the exact bonded layer under
    the same load, its half-width is too large by about .10 h (nu = -.5), .18 h (0 and .2), .12 h
    (.3), and too small by .11 h (.4), .55 h (.45), 1.5 h (.48), 2.7 h (.49): within 1 % from a/h =
    10, 18, 18, 12, 11, 55, 153, 268 on. The peak pressure is better: at a/h = 10 within .2 % up to
    nu = .3, .8 % at .4, 3 % at .45, 20 % at .49. (Own computation, error measured from a/h = 2 to
    40.)

    Parameters
    ----------
    load :
        line load F [N/mm], positive.
    radius :
        effective radius R [mm].
    modulus :
        E [MPa] of the layer.
    poisson :
        nu, in (-1, 0.5).
    thickness :
        h [mm].

    Returns
    -------
    ThinLayer.

    Raises
    ------
    InvalidInputError
        where a parameter lies outside its range; for nu = 0.5 use `thin_incompressible_layer`.

    References
    ----------
    Johnson (1985), Contact Mechanics, section 5.8.
    """
    require_all_positive({"modulus": modulus, "thickness": thickness})
    require_poisson("poisson", poisson)
    if poisson == 0.5:
        raise InvalidInputError(
            "`poisson` must be smaller than 0.5 (see `thin_incompressible_layer`), got 0.5."
        )
    confined = modulus * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson))
    bed = winkler_contact(load=load, radius=radius, foundation=confined / thickness)
    return ThinLayer(bed.half_width, bed.peak_pressure, bed.approach, exponent=1)


def thin_incompressible_layer(
    *, load: float, radius: float, modulus: float, thickness: float
) -> ThinLayer:
    """Return the contact with a thin layer of nu = 0.5, which can only flow sideways.

    u_z = -(h^3/E) p'': the displaced volume is carried by the parabolic shear flow under the
    pressure gradient, G = E/3; the layer is bonded to a rigid base. With p and p' zero at the edges
    p = E (a^2 - x^2)^2/(24 R h^3), F = 2 E a^5/(45 R h^3), p0 = E a^4/(24 R h^3),
    delta = a^2/(6 R).

    Leading term for a/h -> infinity, which is approached slowly. Compared with the exact bonded
    layer under the same load, its half-width is too large by 1.46 h (1.40 h at a/h = 5): 28 % at
    a/h = 5, 14 % at 10, 3.6 % at 40; the peak pressure is too small by 7.6 %, 2.6 %, .2 %. So a -
    1.46 h is the better half-width, to 1.2 % from a/h = 5 on. It holds for nu = 0.5 only: at nu =
    .499 and a/h = 40 it is 9 % too small (`thin_compressible_layer`: 27 %). (Own computation.)

    Parameters
    ----------
    load :
        line load F [N/mm], positive.
    radius :
        effective radius R [mm].
    modulus :
        E [MPa] of the layer.
    thickness :
        h [mm].

    Returns
    -------
    ThinLayer.

    Raises
    ------
    InvalidInputError
        where a parameter is not positive and finite.

    References
    ----------
    Johnson (1985), Contact Mechanics, section 5.8; Jaffar (1989), Int. J. Mech. Sci. 31, 229-235.
    """
    require_all_positive(
        {"load": load, "radius": radius, "modulus": modulus, "thickness": thickness}
    )
    half_width = (22.5 * load * radius * thickness**3 / modulus) ** 0.2
    curvature = half_width**2 / radius
    peak = modulus * half_width**2 * curvature / (24.0 * thickness**3)
    return ThinLayer(half_width, peak, curvature / 6.0, exponent=2)
