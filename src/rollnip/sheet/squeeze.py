r"""How the thickness of a sheet gives way to the pressure on its faces.

The sheet is an elastic layer of modulus E_z between equal pressures on both faces. Its thickness
changes by h (1 - nu^2)/E_z times the pressure where that changes slowly, and by less where it
changes over lengths of about h, for then the neighbours carry with it. By wave number k the share
of the springs' compliance is, with y = kh,

    f(y) = (4/y) (cosh y - 1)/(sinh y + y),

1 for long waves and 4/y, that of two half-spaces, for short ones (Sneddon, Fourier Transforms,
1951, section 45, for a layer of half the thickness on a smooth rigid base). Springs alone would
make the pressure rise in proportion to the distance from the edge of the contact, over a length
h E_rubber/E_z far below the thickness, where they no longer apply.

In space the share is 1/h times a function of x/h, whose double integral is |x|/2 plus h times the
function `_spread` of t = |x|/h. It is a sum over the roots of sinh y = -y in the first quadrant.
Close to 0 this would take all roots. There f is 4/y, but for what falls as exp(-y), and so the
function is

    (3 t^2 - 2 t^2 log t)/pi - t/2

and a power series in t^2.

Pressures that differ on the two faces also bend the layer: half of the difference moves both faces
the same way, by the share (4/y) (cosh y + 1)/(sinh y - y) of c. All but its first two terms,
48/y^4 + 9.6/y^2, which are those of a plate, is local too: 81/175 for long waves, 4/y for short
ones. Its spread is a sum over the roots of sinh y = y; close to 0 the line has the slope 81/350,
and the two terms left to the plate take 0.2 t^5 - 0.8 t^3 off the rest.

Shears move a face along by h (1 - nu^2)/E times

    (2/y) (cosh y + 1)/(sinh y + y) - 2/y^2,     (2/y) (cosh y - 1)/(sinh y - y) - 6/y^2,

per half of the difference and half of the sum of the shears on both rollers, beside what the
tension that they make and the bending by their couples do (2/y^2 and 6/y^2): 1/3 and 1/5 for long
waves, 2/y for short ones. Their spreads are sums over the same roots; close to 0 they are half of
the one above, with lines of half these slopes, and t^3/6 and t^3/2.
"""

from __future__ import annotations

from functools import lru_cache
from math import pi

import numpy as np
from numpy.typing import NDArray

from rollnip.sheet.layer_response import DISTANCES, FaceResponse, displacements, roots, tabulated
from rollnip.sheets import Sheet

Array = NDArray[np.float64]

_SUMMED = 0.01, 0.2  # over the thickness: so many roots are enough there, and a series still is
_OF_SERIES = 6  # its terms
# Long waves, over c: of forces that do not bend the layer, and beside those of a plate of others.
_PRESSED, _SHEARED = (1.0, 81.0 / 175.0), (1.0 / 3.0, 1.0 / 5.0)
_Shares = tuple[float, float]


def squeezed(
    sheet: Sheet,
    x: Array,
    nodes: Array,
    tractions: Array,
    shares: _Shares = (1.0, 0.0),
    opposite: NDArray[np.bool_] | None = None,
) -> Array:
    """Return by how much pressures make the sheet thinner at some places, (m, s) [mm].

    Parameters
    ----------
    sheet : the sheet.
    x : (m,) places [mm].
    nodes : (N + 1,) between which pressures are straight lines, 0 at both ends [mm].
    tractions : (N - 1, s) sets of pressures at nodes[1:-1] [MPa].
    shares :
        of the loss of thickness under equal pressures on both faces, and of how far both faces move
        against opposite pressures beside what a plate moves.
    opposite : (m,) whether the latter counts with the other sign at a place; None: nowhere.
    """
    lines = np.zeros((nodes.size, tractions.shape[1]))
    lines[1:-1] = tractions
    is_far = np.zeros(x.size, dtype=bool) if opposite is None else opposite
    response = pressed_response(shares)
    (made,) = displacements((response,), sheet.thickness, x, nodes, lines, is_far)
    return np.asarray(sheet.squeeze * made)


def pressed_response(shares: _Shares) -> FaceResponse:
    """Return how a face gives way to pressures, over c; ``shares``: see `squeezed`."""
    return _response(_PRESSED, shares)


def sheared_response() -> FaceResponse:
    """Return how shears move a face along beside tension and bending, over c.

    They count as shears on that roller count that lies on the face: at the other face than that of
    the shears the sign is the other one.
    """
    return _response(_SHEARED, (0.5, 0.5), far_sign=-1.0)


@lru_cache(maxsize=4)
def _response(long: _Shares, shares: _Shares, far_sign: float = 1.0) -> FaceResponse:
    alike = shares[0] * _alone(1.0, long, DISTANCES) if shares[0] else np.zeros(DISTANCES.size)
    unlike = shares[1] * _alone(-1.0, long, DISTANCES) if shares[1] else np.zeros(DISTANCES.size)
    near, far = (shares[0] * long[0] + sign * shares[1] * long[1] for sign in (1.0, -1.0))
    cubics = tabulated(alike + unlike, far_sign * (alike - unlike))
    return FaceResponse((near, far_sign * far), (0.0, 0.0), cubics)


def _alone(sign: float, long: _Shares, away: Array) -> Array:
    """Return the spread of one share at distances over h; ``sign``: of the pressures' likeness."""
    first, last = _SUMMED
    places = np.sqrt(np.linspace(first**2, last**2, _OF_SERIES))
    smooth = _summed(sign, long, places) - _close(sign, long, places)
    series = np.polynomial.Polynomial.fit(places**2, smooth, _OF_SERIES - 1)
    return np.where(
        away < first,
        _close(sign, long, away) + series(np.minimum(away, first) ** 2),
        _summed(sign, long, np.maximum(away, first)),
    )


def _close(sign: float, long: _Shares, away: Array) -> Array:
    """Return the part of one spread that is no power series in the square of the distance."""
    logs = np.log(np.maximum(away, np.finfo(float).tiny))
    root, line = (3.0 - 2.0 * logs) * away**2 / pi, 0.5 * long[sign < 0.0] * away
    if long == _SHEARED:
        return np.asarray(0.5 * root - line + away**3 / (6.0 if sign > 0.0 else 2.0))
    if sign > 0.0:
        return np.asarray(root - line)
    return np.asarray(root - line + 0.8 * away**3 - 0.2 * away**5)


def _summed(sign: float, long: _Shares, away: Array) -> Array:
    """Return the sum over the roots of sinh y + sign y = 0 at distances over h."""
    root = roots(sign)
    cosh = np.cosh(root)
    parts = -2j / root**3
    if long != _SHEARED:
        parts = 2.0 * parts * (cosh - sign) / (cosh + sign)
    return np.array([2.0 * float(np.sum(parts * np.exp(1j * root * one)).real) for one in away])
