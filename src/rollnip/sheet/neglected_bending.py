"""Errors of a membrane's figures due to what it neglects: stiffness, and tension times curvature.

The pressures on both faces of a sheet differ by D y'''' - N y'' and by the couples of the shears,
with the height y of its path (`rollnip.sheet.plate.bending`). A membrane has one pressure. The
errors of its figures include the effect of that, unless bending was explicitly switched off.
"""

from __future__ import annotations

from math import sqrt

import numpy as np
from numpy.typing import NDArray

from rollnip._results.records import DeformedSurfaces
from rollnip.nip import Creepage, Nip
from rollnip.sheet.bending import mean_tension, spreading_length
from rollnip.sheet.figures import NAMES, SheetFigures, scales
from rollnip.sheet.friction import SIDE_SIGNS

Array = NDArray[np.float64]

_BY_LENGTH = np.array(
    [
        *(0.06, 0.0, 2.5, 1.4, 0.15, 2.5, 2.5),
        *(0.6, 0.6, 4.0, 4.0),
        *(0.9, 0.9, 0.2, 0.2, 0.5, 0.5, 0.02, 0.5, 4.0),
    ]
)
"""Relative change of each figure of `SheetFigures` due to stiffness and tension, over the ratio of
the spreading length to the nip width. The values cover nips with a ratio of 0.05, each solved as
membrane and as plate (decisions 36 and 42).
"""
_OF_GEARED = 1.2  # the same for tractions at a given creepage, over the limit of friction
_WIDTH = 3  # index of the nip width
_PEAK, _PEAK_ON_RIGID = 4, 6.5  # index of the peak pressure; its change where edges have peaks
_TRACTIONS = [n for n, name in enumerate(NAMES) if name.startswith(("traction", "pull"))]


def neglected_bending_errors(nip: Nip, figures: SheetFigures, wrapped: float) -> Array:
    """Return the error of each figure due to the neglected bending, (20,).

    Parameters
    ----------
    nip : with a sheet.
    figures : of its solution.
    wrapped : length over which the sheet lies on one roller beyond the nip, see `wrapped_length`.
    """
    if not figures.nip_width > 0.0:
        return np.zeros(len(NAMES))
    changes = _BY_LENGTH.copy()
    if nip.upper.is_rigid or nip.lower.is_rigid:
        changes[_PEAK] = _PEAK_ON_RIGID
    ratio = spreading_length(nip) / figures.nip_width
    out = ratio * changes * scales(nip, figures)
    out[_WIDTH] += wrapped
    if isinstance(nip.tangential, Creepage):  # creepages are given, so tractions change
        friction = min(nip.friction_on("upper"), nip.friction_on("lower"))
        out[_TRACTIONS] += _OF_GEARED * ratio * friction * figures.load
    return np.asarray(out)


def wrapped_length(nip: Nip, surfaces: DeformedSurfaces, edges: tuple[float, float]) -> float:
    """Return the length over which a sheet under tension wraps one roller beyond the nip [mm].

    Far outside the nip the sheet runs along x. As it leaves the nip it turns into that direction
    over the length sqrt(D/N). Where the surface of a roller is in its way, it follows the surface
    until that runs along x too. The pressure there is tension times curvature: low, but neglected
    by a membrane.

    Parameters
    ----------
    nip : with a sheet.
    surfaces : of both rollers in and outside the nip, from the membrane solution.
    edges : trailing and leading edge of the nip [mm].

    Returns
    -------
    The longer of the lengths on both rollers, at most as far as the surfaces are given.
    """
    sheet, lengths = nip.sheet, [0.0, 0.0]
    assert sheet is not None
    tension = mean_tension(sheet)
    if not tension > 0.0:
        return 0.0
    x, heights = surfaces.x, (surfaces.upper, surfaces.lower)
    turning = sqrt(sheet.bending_stiffness / tension)
    for edge, outward in zip(edges, (-1.0, 1.0), strict=True):
        beyond = np.flatnonzero(outward * (x - edge) >= 0.0)[:: int(outward)]
        away = np.abs(x[beyond] - x[beyond[0]])
        for side, sign in enumerate(SIDE_SIGNS):
            clear = sign * heights[side][beyond]  # surface height, away from the sheet
            slope = (clear[1] - clear[0]) / away[1]
            path = clear[0] - slope * turning * np.expm1(-away / turning)
            if slope < 0.0 and (clear < path)[2:].any():
                turned = np.flatnonzero(np.diff(clear) >= 0.0)
                lengths[side] += float(away[turned[0] if turned.size else -1])
    return max(lengths)
