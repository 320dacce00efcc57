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
the function `_kernel_integral` of t = |x|/h, which is a sum over the roots of sinh y = -y in the
first quadrant. Near t = 0 all roots would be needed. There f is 4/y, except for terms that fall as
exp(-y), so that `_kernel_integral` is

    (3 t^2 - 2 t^2 log t)/pi - t/2

plus a power series in t^2.

Pressures that differ between the two faces also bend the layer: half of their difference moves both
faces in the same direction, with the compliance (4/y) (cosh y + 1)/(sinh y - y) times c. Its first
two terms, 48/y^4 + 9.6/y^2, are those of a plate. The rest is local as well: 81/175 for long waves,
4/y for short ones. Its `_kernel_integral` is a sum over the roots of sinh y = y. Near t = 0 its
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

from rollnip.sheets import Sheet

Array = NDArray[np.float64]

FAR = 9.0  # over the thickness: there `_kernel_integral` is 1e-17; it falls as exp(-4.2 distance)
PLACES = 400  # number of places in the table, denser near 0
_ROOTS = 1000
_SUMMED = 0.01, 0.2  # over the thickness: roots suffice above the first, a series below the second
_OF_SERIES = 6  # number of its terms
_AT_ONCE = 64  # nodes per block, whose arrays stay in the processor's cache
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
    made = _local_response(sheet.thickness, x, nodes, tractions, (_PRESSED, shares), opposite)
    return np.asarray(sheet.squeeze * made)


def face_shift(
    sheet: Sheet, x: Array, nodes: Array, tractions: Array, opposite: NDArray[np.bool_]
) -> Array:
    """Return the tangential displacement of the sheet's faces due to shears, (m, s) [mm].

    It excludes the displacement due to the sheet's tension and bending, and has the sign of the
    shear on the roller at that face.

    Parameters
    ----------
    sheet, x, nodes, tractions : see `thickness_loss`; shears on the roller at one face.
    opposite : (m,) whether a place is on the other face.
    """
    made = _local_response(sheet.thickness, x, nodes, tractions, (_SHEARED, (0.5, 0.5)), opposite)
    signs = np.where(opposite, -1.0, 1.0)[:, None]
    return np.asarray(sheet.sheared * signs * made)


def _local_response(
    thickness: float,
    x: Array,
    nodes: Array,
    tractions: Array,
    kind: tuple[_Shares, _Shares],
    opposite: NDArray[np.bool_] | None,
) -> Array:
    """Return the displacement over c; ``kind``: long-wave limits, and weights of both parts."""
    long, shares = kind
    padded = np.zeros((nodes.size, tractions.shape[1]))
    padded[1:-1] = tractions
    made = _piecewise_linear(x, nodes, padded)
    signs = np.ones(x.size) if opposite is None else np.where(opposite, -1.0, 1.0)
    made *= (shares[0] * long[0] + long[1] * shares[1] * signs)[:, None]
    cubic = _table(shares, long)
    if opposite is not None:
        cubic = np.concatenate([cubic, _table((shares[0], -shares[1]), long)], axis=1)
    starts = np.where(signs > 0.0, 0, PLACES - 1)
    # Each change of slope at a node acts by the double integral of the kernel.
    slopes = np.zeros((nodes.size + 1, tractions.shape[1]))
    np.subtract(padded[1:], padded[:-1], out=slopes[1:-1])
    slopes[1:-1] *= (thickness / np.diff(nodes))[:, None]
    add_local_response(made, thickness, (x, nodes), slopes[1:] - slopes[:-1], (cubic, starts))
    return made


def add_local_response(
    made: Array,
    thickness: float,
    places: tuple[Array, Array],
    turns: Array,
    table: tuple[Array, NDArray[np.intp]],
    *,
    is_odd: bool = False,
) -> None:
    """Add the local part of the response to piecewise-linear tractions, in place.

    A piecewise-linear traction is a sum of changes of slope at its nodes; each contributes the
    double integral of the kernel, which is negligible beyond `FAR` times the thickness.

    Parameters
    ----------
    made : (m, s) to which the response is added.
    thickness : of the sheet [mm].
    places : (m,) places and (N + 1,) nodes [mm].
    turns : (N + 1, s) changes of slope at the nodes.
    table : cubic pieces, and the first piece for each place; see `_kernel_integral`.
    is_odd : whether the kernel is odd: negative ahead of its node, positive behind it.
    """
    (x, nodes), (cubic, starts), far = places, table, FAR * thickness
    for start in range(0, nodes.size, _AT_ONCE):
        some = slice(start, start + _AT_ONCE)
        ends = nodes[some]
        near = np.flatnonzero((x > ends[0] - far) & (x < ends[-1] + far))
        sets = np.flatnonzero(turns[some].any(axis=0))  # usually only a few sets per block
        if near.size and sets.size:
            columns = slice(int(sets[0]), int(sets[-1]) + 1)
            away = (x[near, None] - ends) / thickness
            spread = _kernel_integral(np.abs(away), cubic, starts[near, None])
            if is_odd:
                spread *= -np.sign(away)
            made[near, columns] += spread @ turns[some, columns]


def _piecewise_linear(x: Array, nodes: Array, values: Array) -> Array:
    """Return the values at ``x`` of a piecewise-linear function of the nodes, 0 outside."""
    at = np.clip(np.searchsorted(nodes, x, side="right") - 1, 0, nodes.size - 2)
    share = (x - nodes[at]) / (nodes[at + 1] - nodes[at])
    share[(share < 0.0) | (share > 1.0)] = 0.0  # values are 0 at both ends
    inside = ((x >= nodes[0]) & (x <= nodes[-1])).astype(float)
    weights = (inside * (1.0 - share))[:, None], (inside * share)[:, None]
    return np.asarray(weights[0] * values[at] + weights[1] * values[at + 1])


def _kernel_integral(away: Array, cubic: Array, starts: NDArray[np.intp]) -> Array:
    """Return the double integral of the kernel less half of the distance, over h.

    Parameters
    ----------
    away : distances over h; beyond `FAR` the result is 0.
    cubic : cubic pieces, see `_table`; several tables may be concatenated.
    starts : index of the first piece of the table for each place.
    """
    place = np.cbrt(np.minimum(away, FAR) / FAR)
    place *= PLACES - 1
    piece = np.minimum(place.astype(np.intp), PLACES - 2)
    place -= piece
    piece += starts
    out = cubic[0].take(piece)
    for row in cubic[1:]:
        out *= place
        out += row.take(piece)
    return np.asarray(out)


@lru_cache(maxsize=5)
def _table(shares: _Shares, long: _Shares) -> Array:
    """Return the cubics between the places of the table, highest power first, (4, places - 1)."""
    # loads more than 200 modules, which a nip without a sheet does not need
    from scipy.interpolate import CubicSpline

    place = np.linspace(0.0, 1.0, PLACES)
    values = sum(
        share * _mode_integral(sign, long, FAR * place**3)
        for share, sign in zip(shares, (1.0, -1.0), strict=True)
        if share
    )
    return np.asarray(CubicSpline(np.arange(PLACES), values).c)


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


def roots(sign: float) -> NDArray[np.complex128]:
    """Return the first roots of sinh y + sign y = 0 in the first quadrant."""
    about = pi * (2.0 * np.arange(1, _ROOTS + 1) - 0.5 * sign)
    root = np.log(2.0 * about) + 1j * about
    for _ in range(20):  # Newton's method
        root = root - (np.sinh(root) + sign * root) / (np.cosh(root) + sign)
    return np.asarray(root)
