"""Bending of a plate in the nip by the tractions on its faces.

The height y of its middle obeys D y'''' - N y'' = w. The load w = p_l - p_u - (h/2) (q_u + q_l)'
includes the couples of the shears on the faces. All forces on the sheet come from the nip, so they
are in equilibrium. Without tension the sheet leaves the nip straight on either side, in the
direction that the nip gives it. With tension it returns to the x axis, along which it is drawn,
over the length L = sqrt(D/N):

    y = y_0 + theta x + int K(x - s) w(s) ds,   M = int s w ds = 2 sqrt(D N) theta,
    K(x) = L^3/(2 D) (t^2/2 - t + 1 - exp(-t)),  t = |x|/L;  |x|^3/(12 D) without tension.

K is the decaying solution -(|x| + L exp(-t))/(2 N) plus a parabola. Under forces in equilibrium the
parabola amounts to a rotation by M/(2 sqrt(D N)), and in this form the equations hold down to zero
tension.

Sections also shear. In an isotropic layer the part of the deflection proportional to 1/k^2 is, per
load, 1.2/(G h) - 2.4 nu (1 + nu)/(E h): the shear of the section, less the effect of the pressures
through the thickness on its curvature (`rollnip.sheet.local_deformation` has the rest, for short
waves).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import factorial, inf, sqrt

import numpy as np
from numpy.typing import NDArray

from rollnip.sheet.bending import mean_tension
from rollnip.sheets import Sheet

Array = NDArray[np.float64]

_SERIES = 0.1  # over the length: shorter intervals are integrated by series


@dataclass(frozen=True, slots=True)
class Plate:
    """Constants of a sheet as a plate under constant tension.

    Attributes
    ----------
    stiffness : D [N mm].
    tension : N, the mean of those at both sides [N/mm].
    shear : second derivative of the deflection by shear of the sections, per load [1/MPa mm].
    """

    stiffness: float
    tension: float
    shear: float

    @classmethod
    def of(cls, sheet: Sheet) -> Plate:
        """Return the plate for a sheet."""
        h = sheet.thickness
        shear = 1.2 * sheet.shear_by_thickness / h**2 - 2.4 * sheet.stretch_by_pressure / h
        return cls(sheet.bending_stiffness, mean_tension(sheet), shear)

    @property
    def length(self) -> float:
        """Length L = sqrt(D/N) over which tension straightens the sheet [mm]; inf without it."""
        return sqrt(self.stiffness / self.tension) if self.tension > 0.0 else inf

    @property
    def righting_moment(self) -> float:
        """Righting moment of the tension per rotation of the sheet, 2 sqrt(D N) [N]."""
        return 2.0 * sqrt(self.stiffness * self.tension)

    def curvature(self, x: Array) -> Array:
        """Return K'', the curvature due to a force of 1 N/mm, at distances ``x`` from it [1/mm]."""
        away, yielding = np.abs(x), 0.5 / self.stiffness
        length = self.length
        return yielding * (away if length == inf else -length * np.expm1(-away / length))


def exponential_weights(pieces: Array, length: float) -> Array:
    """Return int exp(-s/length) t ds over intervals, per end value of a linear t.

    ``pieces``: (m,) lengths of the intervals, which begin at s = 0. Returns (2, m): per value at
    the near end and at the far end.
    """
    t = np.maximum(pieces / length, np.finfo(float).tiny)
    once, series = -np.expm1(-t) / t, np.zeros(t.shape)
    for n in range(8, 1, -1):
        series = series * -t + 1.0 / factorial(n)
    near = np.where(t < _SERIES, series, (1.0 - once) / t)
    return np.asarray(pieces * np.stack([near, once - near]))
