"""Two rollers pressed together at their ends, each on the other as on an elastic foundation."""

from __future__ import annotations

from math import sin, sinh

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import require_positive

Array = NDArray[np.float64]


def end_loaded_rollers(y: Array, length: float, foundation: float, bending: float) -> Array:
    """Return the line load between two end-loaded rollers, over its mean.

    Both bend as slender beams, pressed together at the ends of the face; the nip yields by load
    over ``foundation``. With lambda^4 = k/(4 E I_r), 1/EI_r = 1/EI_1 + 1/EI_2, x from one end:

        w/mean = lambda L (cosh lx cos l(L-x) + cosh l(L-x) cos lx)/(sinh lL + sin lL).

    Parameters
    ----------
    y : (n,) places from the middle of the face [mm].
    length : L of the face [mm].
    foundation : k, line load over approach [N/mm2].
    bending : E I_r of both rollers together [N mm2].

    Returns
    -------
    (n,) ratios.

    References
    ----------
    M. Hetenyi (1946), Beams on Elastic Foundation, University of Michigan Press: a finite beam with
    a concentrated load at each end.
    """
    for name, value in (("length", length), ("foundation", foundation), ("bending", bending)):
        require_positive(name, value)
    wave = (foundation / (4.0 * bending)) ** 0.25
    whole = wave * length
    near = wave * (np.asarray(y) + 0.5 * length)
    far = whole - near
    shape = np.cosh(near) * np.cos(far) + np.cosh(far) * np.cos(near)
    return np.asarray(whole * shape / (sinh(whole) + sin(whole)))
