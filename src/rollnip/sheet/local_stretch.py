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

from rollnip.sheet.layer_response import DISTANCES, FaceResponse, roots, tabulated

Array = NDArray[np.float64]

LONG_WAVES = (0.0, 0.4)  # long-wave limits for equal and for opposite pressures
_STEPS = (1.0 / 12.0, 11.0 / 700.0)  # coefficients of y^2 in their series


@lru_cache(maxsize=1)
def stretch_integral_response() -> FaceResponse:
    """Return the integral of the local stretch of a face from each place on, over (1 - nu^2)/E.

    It excludes the long-wave part, which is `LONG_WAVES` times the integral of the pressure.
    """
    alike, unlike = 0.5 * _root_sum(1.0, DISTANCES), 0.5 * _root_sum(-1.0, DISTANCES)
    near, far = (0.5 * (_STEPS[0] + sign * _STEPS[1]) for sign in (1.0, -1.0))
    cubics = tabulated(alike + unlike, alike - unlike)
    return FaceResponse((0.0, 0.0), (near, far), cubics, is_odd=True)


def _root_sum(sign: float, away: Array) -> Array:
    """Return the sum over the roots of sinh y + sign y = 0, at distances over h."""
    root = roots(sign)
    parts = sign * 2.0 / (root**2 * (np.cosh(root) + sign))
    return np.array([2.0 * float(np.sum(parts * np.exp(1j * root * one)).real) for one in away])
