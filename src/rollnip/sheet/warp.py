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

from rollnip.sheet.layer_response import DISTANCES, FaceResponse, roots, tabulated

Array = NDArray[np.float64]

LONG_WAVES = (0.0, 0.4)  # shares of pressures that are alike and opposite
_STEPS = (1.0 / 12.0, 11.0 / 700.0)  # y^2 in their series


@lru_cache(maxsize=1)
def warped_response() -> FaceResponse:
    """Return the integral of the stretch of a face from a place on, over (1 - nu^2)/E.

    Without the long waves, which take `LONG_WAVES` of the integral of the pressure.
    """
    alike, unlike = 0.5 * _spread(1.0, DISTANCES), 0.5 * _spread(-1.0, DISTANCES)
    near, far = (0.5 * (_STEPS[0] + sign * _STEPS[1]) for sign in (1.0, -1.0))
    cubics = tabulated(alike + unlike, alike - unlike)
    return FaceResponse((0.0, 0.0), (near, far), cubics, is_odd=True)


def _spread(sign: float, away: Array) -> Array:
    """Return the sum over the roots of sinh y + sign y = 0 at distances over h."""
    root = roots(sign)
    parts = sign * 2.0 / (root**2 * (np.cosh(root) + sign))
    return np.array([2.0 * float(np.sum(parts * np.exp(1j * root * one)).real) for one in away])
