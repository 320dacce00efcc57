"""Displacement under elliptic pressures such as Hertz's, for half-widths of every size."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rollnip.influence.kernel import MOST_OCTAVES, Kernel

Array = NDArray[np.float64]

_PIECES = 24  # straight pieces of an ellipse; Hertz's half-width is then right to 4e-5


@dataclass(frozen=True, slots=True)
class Ellipses:
    """Displacement at the centre and at the edge under p = sqrt(1 - x^2/a^2), for many a.

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
        """Tabulate the displacements for half-widths up to ``longest`` [mm].

        There is one half-width in each octave, down to the shortest length that any table covers.
        """
        octaves = np.arange(0.0, np.log2(kernel.reach / longest) - MOST_OCTAVES, -1.0)
        half_width = longest * 2.0 ** octaves[::-1]
        angle = np.linspace(-0.5 * np.pi, 0.5 * np.pi, _PIECES + 1)
        x, height = np.sin(angle), np.cos(angle)
        kinks = np.diff(np.diff(height) / np.diff(x), prepend=0.0, append=0.0)
        from_centre_and_edge = np.array([0.0, 1.0])[:, None] - x
        values = kernel.double_integral(np.multiply.outer(half_width, from_centre_and_edge))
        centre, edge = (values @ kinks).T / half_width
        return cls(half_width, centre, edge)
