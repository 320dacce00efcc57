"""Displacement under elliptic pressures: as Hertz's, over half-widths of every size."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rollnip.influence.kernel import Kernel

Array = NDArray[np.float64]

_HALF_WIDTHS = np.geomspace(1e-9, 1.0, 40)  # of the longest
# The pressure of half-width 1 on some nodes, by its changes of slope there; how far the nodes are
# from the centre and from an edge.
_ANGLES = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 25)
_SLOPES = np.pad(np.diff(np.cos(_ANGLES)) / np.diff(np.sin(_ANGLES)), 1)
_KINKS = np.diff(_SLOPES)
_DISTANCES = np.array([0.0, 1.0])[:, None] - np.sin(_ANGLES)


@dataclass(frozen=True, slots=True)
class Ellipses:
    """Displacement at the centre and the edge under p = sqrt(1 - x^2/a^2), for many a.

    Attributes
    ----------
    half_width : (n,) a, in a geometric series [mm].
    centre, edge : (n,) displacement [mm/MPa].
    """

    half_width: Array
    centre: Array
    edge: Array

    @classmethod
    def under(cls, kernel: Kernel, longest: float) -> Ellipses:
        """Tabulate an influence function's displacements for half-widths up to ``longest`` [mm]."""
        half_width = longest * _HALF_WIDTHS
        values = kernel.double_integral(np.multiply.outer(half_width, _DISTANCES))
        centre, edge = (values @ _KINKS).T / half_width
        return cls(half_width, centre, edge)
