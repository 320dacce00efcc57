"""Local deformation of a sheet across its thickness, under pressures and shears on its faces.

Under equal pressures on both faces, an elastic layer of modulus E_z becomes thinner by
c = h (1 - nu^2)/E_z times the pressure where the pressure varies slowly, as a layer of springs
does. Where it varies over lengths of about h the change is smaller, because neighbouring material
helps to carry the load. At wave number k, with y = kh, the compliance over that of the springs is

    f(y) = (4/y) (cosh y - 1)/(sinh y + y),

which is 1 for long waves and 4/y, that of two half-spaces, for short ones (Sneddon, Fourier
Transforms, 1951, section 45, for a layer of half the thickness on a smooth rigid base). Springs
alone would make the pressure rise in proportion to the distance from the edge of the contact, over
a length h E_rubber/E_z far below the thickness, where they no longer apply.

In space, f is 1/h times a function of x/h. The double integral of that kernel is |x|/2 plus h times
the function `_mode_integral` of t = |x|/h, which is a sum over the roots of sinh y = -y in the
first quadrant. Near t = 0 all roots would be needed. There f is 4/y, except for terms that fall as
exp(-y), so that `_mode_integral` is

    (3 t^2 - 2 t^2 log t)/pi - t/2

plus a power series in t^2.

Pressures that differ between the two faces also bend the layer: half of their difference moves both
faces in the same direction, with the compliance (4/y) (cosh y + 1)/(sinh y - y) times c. Its first
two terms, 48/y^4 + 9.6/y^2, are those of a plate. The rest is local as well: 81/175 for long waves,
4/y for short ones. Its `_mode_integral` is a sum over the roots of sinh y = y. Near t = 0 its
linear term has the slope 81/350, and removing the two plate terms adds 0.8 t^3 - 0.2 t^5.

Shears displace a face tangentially by h (1 - nu^2)/E times

    (2/y) (cosh y + 1)/(sinh y + y) - 2/y^2,     (2/y) (cosh y - 1)/(sinh y - y) - 6/y^2,

per half of the difference and per half of the sum of the shears on both rollers. The terms 2/y^2
and 6/y^2, which are the stretch by the resulting tension and the bending by the couples of the
shears, are subtracted here. The rest is 1/3 and 1/5 for long waves, 2/y for short ones. The
corresponding functions are sums over the same roots. Near t = 0 they are half of the expression
above, with linear terms of half these slopes, plus t^3/6 and t^3/2.
"""

from __future__ import annotations

from functools import lru_cache
from math import pi

import numpy as np
from numpy.typing import NDArray

from rollnip.sheet.layer_response import DISTANCES, FaceResponse, displacements, roots, tabulated
from rollnip.sheets import Sheet

Array = NDArray[np.float64]

_SUMMED = 0.01, 0.2  # over the thickness: roots suffice above the first, a series below the second
_OF_SERIES = 6  # number of its terms
# Long-wave limits over c: of loads that do not bend the layer, and of the others beyond a plate.
_PRESSED, _SHEARED = (1.0, 81.0 / 175.0), (1.0 / 3.0, 1.0 / 5.0)
_Shares = tuple[float, float]


def thickness_loss(
    sheet: Sheet,
    x: Array,
    nodes: Array,
    tractions: Array,
    shares: _Shares = (1.0, 0.0),
    opposite: NDArray[np.bool_] | None = None,
) -> Array:
    """Return the loss of thickness due to pressures, at given places, (m, s) [mm].

    Parameters
    ----------
    sheet : the sheet.
    x : (m,) places [mm].
    nodes : (N + 1,) between which the pressures are linear; they are 0 at both ends [mm].
    tractions : (N - 1, s) sets of pressures at nodes[1:-1] [MPa].
    shares :
        weights of the loss of thickness under equal pressures on both faces, and of the
        displacement of both faces under opposite pressures in excess of that of a plate.
    opposite : (m,) whether the latter counts with the opposite sign at a place; None: nowhere.
    """
    lines = np.zeros((nodes.size, tractions.shape[1]))
    lines[1:-1] = tractions
    is_far = np.zeros(x.size, dtype=bool) if opposite is None else opposite
    response = pressed_response(shares)
    (made,) = displacements((response,), sheet.thickness, x, nodes, lines, is_far)
    return np.asarray(sheet.squeeze * made)


def pressed_response(shares: _Shares) -> FaceResponse:
    """Return the response of a face to pressures, over c; ``shares``: see `thickness_loss`."""
    return _response(_PRESSED, shares)


def sheared_response() -> FaceResponse:
    """Return the tangential response of a face to shears, without tension and bending, over c.

    It has the sign of the shear on the roller at that face, so that it changes sign from the face
    under the shears to the other one.
    """
    return _response(_SHEARED, (0.5, 0.5), far_sign=-1.0)


@lru_cache(maxsize=4)
def _response(long: _Shares, shares: _Shares, far_sign: float = 1.0) -> FaceResponse:
    alike = (
        shares[0] * _mode_integral(1.0, long, DISTANCES) if shares[0] else np.zeros(DISTANCES.size)
    )
    unlike = (
        shares[1] * _mode_integral(-1.0, long, DISTANCES) if shares[1] else np.zeros(DISTANCES.size)
    )
    near, far = (shares[0] * long[0] + sign * shares[1] * long[1] for sign in (1.0, -1.0))
    cubics = tabulated(alike + unlike, far_sign * (alike - unlike))
    return FaceResponse((near, far_sign * far), (0.0, 0.0), cubics)


def _mode_integral(sign: float, long: _Shares, away: Array) -> Array:
    """Return the kernel integral of one mode; ``sign``: 1 for equal, -1 for opposite loads."""
    first, last = _SUMMED
    places = np.sqrt(np.linspace(first**2, last**2, _OF_SERIES))
    smooth = _root_sum(sign, long, places) - _near_part(sign, long, places)
    series = np.polynomial.Polynomial.fit(places**2, smooth, _OF_SERIES - 1)
    return np.where(
        away < first,
        _near_part(sign, long, away) + series(np.minimum(away, first) ** 2),
        _root_sum(sign, long, np.maximum(away, first)),
    )


def _near_part(sign: float, long: _Shares, away: Array) -> Array:
    """Return the part of the kernel integral that is no power series in the squared distance."""
    logs = np.log(np.maximum(away, np.finfo(float).tiny))
    root, line = (3.0 - 2.0 * logs) * away**2 / pi, 0.5 * long[sign < 0.0] * away
    if long == _SHEARED:
        return np.asarray(0.5 * root - line + away**3 / (6.0 if sign > 0.0 else 2.0))
    if sign > 0.0:
        return np.asarray(root - line)
    return np.asarray(root - line + 0.8 * away**3 - 0.2 * away**5)


def _root_sum(sign: float, long: _Shares, away: Array) -> Array:
    """Return the sum over the roots of sinh y + sign y = 0 at distances over h."""
    root = roots(sign)
    cosh = np.cosh(root)
    parts = -2j / root**3
    if long != _SHEARED:
        parts = 2.0 * parts * (cosh - sign) / (cosh + sign)
    return np.array([2.0 * float(np.sum(parts * np.exp(1j * root * one)).real) for one in away])
