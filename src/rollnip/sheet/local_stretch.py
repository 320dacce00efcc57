"""Local stretch of a sheet's faces under pressure, in addition to its bending.

An elastic layer of modulus E with pressures p on both faces is stretched in its plane by
nu (1 + nu) p/E less (1 - nu^2)/E times

    (sinh y - y)/(sinh y + y),    (sinh y + y)/(sinh y - y) - 12/y^2,    y = kh,

for equal and for opposite pressures on the two faces, k being the wave number; 12/y^2 is the
bending of a plate. For long waves these functions are 0 and 2/5, for short waves both are 1,
which leaves (1 - 2 nu)(1 + nu) p/E, the value of the half-space.

The faces are displaced by the integral of that stretch. In space it consists of the triple
integral of these functions: x |x|/4 times their long-wave limits, a step -r/2 sgn x due to the
y^2 terms of their series (r = 1/12 and 11/700), and a sum over the roots of sinh y = -y and
sinh y = y.

By reciprocity, shears squeeze the faces by as much as pressures displace them tangentially.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from rollnip.sheet.local_deformation import FAR, PLACES, add_local_response, roots

Array = NDArray[np.float64]

LONG_WAVES = (0.0, 0.4)  # long-wave limits for equal and for opposite pressures
_STEPS = (1.0 / 12.0, 11.0 / 700.0)  # coefficients of y^2 in their series


def stretch_integral(
    thickness: float, x: Array, nodes: Array, lines: Array, far: NDArray[np.bool_]
) -> Array:
    """Return the integral of the local stretch from each place to infinity, (m, s) [mm MPa].

    It is divided by (1 - nu^2)/E and excludes the long-wave part, which is `LONG_WAVES` times the
    integral of the pressure.

    Parameters
    ----------
    thickness : of the sheet [mm].
    x : (m,) places [mm].
    nodes : (N + 1,) between which tractions are linear [mm].
    lines : (N + 1, s) nodal values of s sets of tractions, 0 at both ends [MPa].
    far : (m,) whether a place is on the face opposite to the tractions.
    """
    signs = np.where(far, -1.0, 1.0)
    slopes = np.zeros((nodes.size + 1, lines.shape[1]))
    slopes[1:-1] = np.diff(lines, axis=0) / np.diff(nodes)[:, None]
    here = 0.5 * (slopes[np.searchsorted(nodes, x)] + slopes[np.searchsorted(nodes, x, "right")])
    made = 0.5 * (_STEPS[0] + signs * _STEPS[1])[:, None] * here
    turns, cubic = np.diff(slopes, axis=0), np.concatenate([_table(1.0), _table(-1.0)], axis=1)
    starts = np.where(far, PLACES - 1, 0)
    add_local_response(made, thickness, (x, nodes), turns, (cubic, starts), is_odd=True)
    return np.asarray(thickness**2 * made)


@lru_cache(maxsize=2)
def _table(sign: float) -> Array:
    """Return cubic pieces of half of both kernels; ``sign``: sign for opposite pressures."""
    from scipy.interpolate import CubicSpline  # loads more than 200 modules

    away = FAR * np.linspace(0.0, 1.0, PLACES) ** 3
    values = 0.5 * (_root_sum(1.0, away) + sign * _root_sum(-1.0, away))
    return np.asarray(CubicSpline(np.arange(PLACES), values).c)


def _root_sum(sign: float, away: Array) -> Array:
    """Return the sum over the roots of sinh y + sign y = 0, at distances over h."""
    root = roots(sign)
    parts = sign * 2.0 / (root**2 * (np.cosh(root) + sign))
    return np.array([2.0 * float(np.sum(parts * np.exp(1j * root * one)).real) for one in away])
