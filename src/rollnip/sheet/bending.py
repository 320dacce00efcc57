"""The length over which a sheet's stiffness against bending acts, and what it changes."""

from __future__ import annotations

from math import inf

import numpy as np
from numpy.typing import NDArray

from rollnip.nip import Nip
from rollnip.rollers import Roller

STIFF = 0.01
"""Bending length over the nip width, beyond which bending stiffness matters."""
_BY_STIFFNESS = np.array(
    [
        *(0.03, 0.0, 1.2, 1.2, 0.15, 1.2, 1.2),
        *(0.6, 0.6, 4.0, 4.0),
        *(0.6, 0.6, 0.2, 0.2, 0.3, 0.3, 0.02, 0.15, 4.0),
    ]
)
"""Change of each figure of `SheetFigures` by stiffness, relative, over the share of the bending
length in the nip width: what nips at a share of 0.05 need, each solved both ways (decision 36)."""
_BY_TENSION = np.array(
    [
        *(0.1, 0.0, 2.0, 8.0, 0.2, 2.0, 2.0),
        *(1.0, 1.0, 2.0, 2.0),
        *(1.0, 1.0, 0.5, 0.5, 0.5, 0.5, 0.1, 1.0, 2.0),
    ]
)
"""The same by tension, over the mean tension over the load: a pulled sheet that resists bending, if
ever so little, wraps both rollers until it runs straight; one that bends freely does not."""
_MOST_BY_TENSION = 0.1  # tension over the load: where a wider contact hardly grows any more
_PEAK, _PEAK_ON_RIGID = 4, 6.5  # place and change of the highest pressure, which has edges there


def left_by_stiffness(nip: Nip, width: float, load: float) -> NDArray[np.float64]:
    """Return the relative change of each figure by the stiffness that is left out, (20,).

    It is 0 where the sheet is asked to bend freely. ``width``, ``load``: of the nip [mm], [N/mm].
    """
    sheet = nip.sheet
    assert sheet is not None
    if sheet.bending is False or not min(width, load) > 0.0:
        return np.zeros(_BY_STIFFNESS.size)
    stiffness = _BY_STIFFNESS.copy()
    if nip.upper.is_rigid or nip.lower.is_rigid:
        stiffness[_PEAK] = _PEAK_ON_RIGID
    pulled = min(0.5 * (sheet.tension_in + sheet.tension_out) / load, _MOST_BY_TENSION)
    return np.asarray(bending_length(nip) / width * stiffness + pulled * _BY_TENSION)


def bending_length(nip: Nip) -> float:
    """Return (D d/E)^(1/4) on the softer covering, over which bending stiffness counts [mm].

    D is the bending stiffness of the sheet, d and E thickness and relaxed modulus of the covering.
    A half-space core takes the length (D/E)^(1/3).
    """
    assert nip.sheet is not None
    stiffness = nip.sheet.bending_stiffness
    lengths = [_on_covering(roller, stiffness) for roller in (nip.upper, nip.lower)]
    return max(length for length in lengths if length < inf)


def _on_covering(roller: Roller, stiffness: float) -> float:
    if roller.is_rigid:
        return inf
    if not roller.layers:
        assert roller.core is not None
        return float((stiffness / roller.core.relaxed_modulus) ** (1.0 / 3.0))
    yielding = sum(layer.thickness / layer.material.relaxed_modulus for layer in roller.layers)
    return float((stiffness * yielding) ** 0.25)
