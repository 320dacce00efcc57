"""Friction on the interfaces of a sheet: coefficients and the states of stick and slip."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rollnip.nip import Nip

Array = NDArray[np.float64]

SIGNS = np.array([0.0, 0.0, 1.0, -1.0])
"""Sign of the shear for each state of a node, in the order of `State`."""


def frictions_of(nip: Nip) -> tuple[float, float]:
    """Return the friction coefficients of the sheet on the upper and on the lower roller."""
    return nip.friction_on("upper"), nip.friction_on("lower")
