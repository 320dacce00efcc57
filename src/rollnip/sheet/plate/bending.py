r"""How a plate in the nip bends under what presses on its faces.

The height y of its middle obeys D y'''' - N y'' = w, w = p_l - p_u - (h/2) (q_u + q_l)' the load
and the couples of the shears at the faces. All forces on the sheet are those of the nip: they add
up to nothing. Without tension it runs on straight at either side, in whatever direction the nip
gives it; with tension it comes back to the x axis, along which it is drawn, over the length
L = sqrt(D/N):

    y = y_0 + theta x + int K(x - s) w(s) ds,   M = int s w ds = 2 sqrt(D N) theta,
    K(x) = L^3/(2 D) (t^2/2 - t + 1 - exp(-t)),  t = |x|/L;  |x|^3/(12 D) without tension.

K is the decaying solution -(|x| + L exp(-t))/(2 N) but for a parabola, which under forces that add
up to nothing is a rotation by M/(2 sqrt(D N)): so the equations hold down to no tension at all.

Sections also shear. Of an isotropic layer the share of the deflection that goes as 1/k^2 is, per
load, 1.2/(G h) - 2.4 nu (1 + nu)/(E h): the shear of the section, less what the pressures through
the thickness do to its curvature (`rollnip.sheet.squeeze` has what is left at short waves).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import factorial, inf, sqrt

import numpy as np
from numpy.typing import NDArray

from rollnip.sheet.bending import mean_tension
from rollnip.sheets import Sheet

Array = NDArray[np.float64]

_SERIES = 0.1  # of the length: pieces below are integrated by series of exponentials


@dataclass(frozen=True, slots=True)
class Plate:
    """A sheet as a plate under one tension.

    Attributes
    ----------
    stiffness : D [N mm].
    tension : N, the mean of those at both sides [N/mm].
    shear : deflection by the shear of sections: its second derivative per load [1/MPa mm].
    """

    stiffness: float
    tension: float
    shear: float

    @classmethod
    def of(cls, sheet: Sheet) -> Plate:
        """Return the plate that a sheet is."""
        h = sheet.thickness
        shear = 1.2 * sheet.shear_by_thickness / h**2 - 2.4 * sheet.stretch_by_pressure / h
        return cls(sheet.bending_stiffness, mean_tension(sheet), shear)

    @property
    def length(self) -> float:
        """Length L over which tension straightens the sheet [mm]; inf without tension."""
        return sqrt(self.stiffness / self.tension) if self.tension > 0.0 else inf

    @property
    def righting(self) -> float:
        """Moment per rotation of the sheet that its tension makes, 2 sqrt(D N) [N]."""
        return 2.0 * sqrt(self.stiffness * self.tension)

    def curvature(self, x: Array) -> Array:
        """Return K'', the curvature by a force of 1 N/mm at distances ``x`` from it [1/mm]."""
        away, yielding = np.abs(x), 0.5 / self.stiffness
        length = self.length
        return yielding * (away if length == inf else -length * np.expm1(-away / length))


def exponential_weights(pieces: Array, length: float) -> Array:
    """Return int exp(-s/length) t ds over pieces per value of straight lines at either end.

    ``pieces``: (m,) lengths from s = 0 on. Returns (2, m): by the value at the near and at the far
    end.
    """
    t = np.maximum(pieces / length, np.finfo(float).tiny)
    once, series = -np.expm1(-t) / t, np.zeros(t.shape)
    for n in range(8, 1, -1):
        series = series * -t + 1.0 / factorial(n)
    near = np.where(t < _SERIES, series, (1.0 - once) / t)
    return np.asarray(pieces * np.stack([near, once - near]))
