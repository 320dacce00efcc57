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

from rollnip.sheets import Sheet

Array = NDArray[np.float64]

FAR = 9.0  # over the thickness: there `_spread` is 1e-17, it falls as exp(-4.2 distance)
PLACES = 400  # of the table, crowded at 0
_ROOTS = 1000
_SUMMED = 0.01, 0.2  # over the thickness: so many roots are enough there, and a series still is
_OF_SERIES = 6  # its terms
_AT_ONCE = 64  # nodes: what these need stays in a fast memory
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
    made = _moved(sheet.thickness, x, nodes, tractions, (_PRESSED, shares), opposite)
    return np.asarray(sheet.squeeze * made)


def sheared(
    sheet: Sheet, x: Array, nodes: Array, tractions: Array, opposite: NDArray[np.bool_]
) -> Array:
    """Return by how much shears move the faces of the sheet at some places, (m, s) [mm].

    It is what the sheet's tension and bending leave out, and counts as shears on that roller count
    that lies on the face.

    Parameters
    ----------
    sheet, x, nodes, tractions : see `squeezed`; shears on the roller at one face.
    opposite : (m,) whether a place is on the other face.
    """
    made = _moved(sheet.thickness, x, nodes, tractions, (_SHEARED, (0.5, 0.5)), opposite)
    signs = np.where(opposite, -1.0, 1.0)[:, None]
    return np.asarray(sheet.sheared * signs * made)


def _moved(
    thickness: float,
    x: Array,
    nodes: Array,
    tractions: Array,
    kind: tuple[_Shares, _Shares],
    opposite: NDArray[np.bool_] | None,
) -> Array:
    """Return the same over c; ``kind``: what long waves have, and the shares."""
    long, shares = kind
    padded = np.zeros((nodes.size, tractions.shape[1]))
    padded[1:-1] = tractions
    made = _straight(x, nodes, padded)
    signs = np.ones(x.size) if opposite is None else np.where(opposite, -1.0, 1.0)
    made *= (shares[0] * long[0] + long[1] * shares[1] * signs)[:, None]
    cubic = _table(shares, long)
    if opposite is not None:
        cubic = np.concatenate([cubic, _table((shares[0], -shares[1]), long)], axis=1)
    starts = np.where(signs > 0.0, 0, PLACES - 1)
    # A straight line turns at its nodes: each turn acts by the double integral, as far as that is.
    slopes = np.zeros((nodes.size + 1, tractions.shape[1]))
    np.subtract(padded[1:], padded[:-1], out=slopes[1:-1])
    slopes[1:-1] *= (thickness / np.diff(nodes))[:, None]
    add_spread(made, thickness, (x, nodes), slopes[1:] - slopes[:-1], (cubic, starts))
    return made


def add_spread(
    made: Array,
    thickness: float,
    places: tuple[Array, Array],
    turns: Array,
    table: tuple[Array, NDArray[np.intp]],
    *,
    is_odd: bool = False,
) -> None:
    """Add what the turns of straight lines at their nodes make near by, in place.

    Parameters
    ----------
    made : (m, s) to add to.
    thickness : of the sheet [mm].
    places : (m,) places and (N + 1,) nodes [mm].
    turns : (N + 1, s) changes of slope at the nodes.
    table : cubics, and where that of each place starts; see `_spread`.
    is_odd : whether a spread has the other sign ahead of its node than behind it, where it adds.
    """
    (x, nodes), (cubic, starts), far = places, table, FAR * thickness
    for start in range(0, nodes.size, _AT_ONCE):
        some = slice(start, start + _AT_ONCE)
        ends = nodes[some]
        near = np.flatnonzero((x > ends[0] - far) & (x < ends[-1] + far))
        sets = np.flatnonzero(turns[some].any(axis=0))  # of a few neighbours each, as a rule
        if near.size and sets.size:
            columns = slice(int(sets[0]), int(sets[-1]) + 1)
            away = (x[near, None] - ends) / thickness
            spread = _spread(np.abs(away), cubic, starts[near, None])
            if is_odd:
                spread *= -np.sign(away)
            made[near, columns] += spread @ turns[some, columns]


def _straight(x: Array, nodes: Array, values: Array) -> Array:
    """Return the values at ``x`` of straight lines between nodes, 0 beyond them."""
    at = np.clip(np.searchsorted(nodes, x, side="right") - 1, 0, nodes.size - 2)
    share = (x - nodes[at]) / (nodes[at + 1] - nodes[at])
    share[(share < 0.0) | (share > 1.0)] = 0.0  # values are 0 at both ends
    inside = ((x >= nodes[0]) & (x <= nodes[-1])).astype(float)
    weights = (inside * (1.0 - share))[:, None], (inside * share)[:, None]
    return np.asarray(weights[0] * values[at] + weights[1] * values[at + 1])


def _spread(away: Array, cubic: Array, starts: NDArray[np.intp]) -> Array:
    """Return the double integral of the shares in space, less half of the distance, over h.

    ``away``: distances over h; beyond `FAR` it is 0. ``cubic``, ``starts``: see `_table`, one
    after the other, and where that of each place starts.
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
        share * _alone(sign, long, FAR * place**3)
        for share, sign in zip(shares, (1.0, -1.0), strict=True)
        if share
    )
    return np.asarray(CubicSpline(np.arange(PLACES), values).c)


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


def roots(sign: float) -> NDArray[np.complex128]:
    """Return the first roots of sinh y + sign y = 0 in the first quadrant."""
    about = pi * (2.0 * np.arange(1, _ROOTS + 1) - 0.5 * sign)
    root = np.log(2.0 * about) + 1j * about
    for _ in range(20):  # Newton's method
        root = root - (np.sinh(root) + sign * root) / (np.cosh(root) + sign)
    return np.asarray(root)
