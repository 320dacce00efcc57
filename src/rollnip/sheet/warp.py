r"""How the pressure on the faces of a sheet stretches these, beside its bending.

An elastic layer of modulus E between pressures p on both faces is stretched along by
nu (1 + nu) p/E less (1 - nu^2)/E times

    (sinh y - y)/(sinh y + y),    (sinh y + y)/(sinh y - y) - 12/y^2,    y = kh,

of pressures that are alike and that are opposite; what the plate's bending does is 12/y^2. Long
waves have 0 and 2/5 of it, short ones all of it: (1 - 2 nu)(1 + nu) p/E is the half-space's.

The faces move by the integral of that stretch. In space it is made of the triple integral of the
share, x |x|/4 of its long waves, a step -r/2 sgn x that y^2 in its series leaves (1/12, 11/700),
and a sum over the roots of sinh y = -y and sinh y = y.

As work is mutual, shears give the faces way by as much as pressures move them along.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from rollnip.sheet.squeeze import FAR, PLACES, add_spread, roots

Array = NDArray[np.float64]

LONG_WAVES = (0.0, 0.4)  # shares of pressures that are alike and opposite
_STEPS = (1.0 / 12.0, 11.0 / 700.0)  # y^2 in their series


def warped(thickness: float, x: Array, nodes: Array, lines: Array, far: NDArray[np.bool_]) -> Array:
    """Return the integral of the stretch from some places on over (1 - nu^2)/E, (m, s) [mm MPa].

    Without the long waves, which take `LONG_WAVES` of the integral of the pressure.

    Parameters
    ----------
    thickness : of the sheet [mm].
    x : (m,) places [mm].
    nodes : (N + 1,) between which tractions are straight lines [mm].
    lines : (N + 1, s) their values, 0 at both ends [MPa].
    far : (m,) whether a place is on the other face than the tractions.
    """
    signs = np.where(far, -1.0, 1.0)
    slopes = np.zeros((nodes.size + 1, lines.shape[1]))
    slopes[1:-1] = np.diff(lines, axis=0) / np.diff(nodes)[:, None]
    here = 0.5 * (slopes[np.searchsorted(nodes, x)] + slopes[np.searchsorted(nodes, x, "right")])
    made = 0.5 * (_STEPS[0] + signs * _STEPS[1])[:, None] * here
    turns, cubic = np.diff(slopes, axis=0), np.concatenate([_table(1.0), _table(-1.0)], axis=1)
    starts = np.where(far, PLACES - 1, 0)
    add_spread(made, thickness, (x, nodes), turns, (cubic, starts), is_odd=True)
    return np.asarray(thickness**2 * made)


@lru_cache(maxsize=2)
def _table(sign: float) -> Array:
    """Return the cubics of half of both spreads; ``sign``: that of opposite pressures."""
    from scipy.interpolate import CubicSpline  # loads more than 200 modules

    away = FAR * np.linspace(0.0, 1.0, PLACES) ** 3
    values = 0.5 * (_spread(1.0, away) + sign * _spread(-1.0, away))
    return np.asarray(CubicSpline(np.arange(PLACES), values).c)


def _spread(sign: float, away: Array) -> Array:
    """Return the sum over the roots of sinh y + sign y = 0 at distances over h."""
    root = roots(sign)
    parts = sign * 2.0 / (root**2 * (np.cosh(root) + sign))
    return np.array([2.0 * float(np.sum(parts * np.exp(1j * root * one)).real) for one in away])
