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

from rollnip.sheets import Sheet

Array = NDArray[np.float64]

_SHORT = 0.5  # below, exponentials are summed as series
_TERMS = 12


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
        tension = 0.5 * (sheet.tension_in + sheet.tension_out)
        return cls(sheet.bending_stiffness, tension, shear)

    @property
    def length(self) -> float:
        """Length L over which tension straightens the sheet [mm]; inf without tension."""
        return sqrt(self.stiffness / self.tension) if self.tension > 0.0 else inf

    @property
    def righting(self) -> float:
        """Moment per rotation of the sheet that its tension makes, 2 sqrt(D N) [N]."""
        return 2.0 * sqrt(self.stiffness * self.tension)

    def height(self, x: Array) -> Array:
        """Return K at some distances, the height per load [mm/(N/mm)]."""
        away = np.abs(x)
        return self._scale(3) * self._rest(away, 3)

    def slope(self, x: Array) -> Array:
        """Return K', the slope per load [1/(N/mm)]."""
        return np.sign(x) * self._scale(2) * self._rest(np.abs(x), 2)

    def bend(self, x: Array) -> Array:
        """Return K'', the curvature per load [1/mm/(N/mm)]."""
        return self._scale(1) * self._rest(np.abs(x), 1)

    def sheared(self, x: Array) -> Array:
        """Return the height by the shear of sections per load [mm/(N/mm)]."""
        return -0.5 * self.shear * np.abs(x)

    def _scale(self, power: int) -> float:
        length = self.length
        return (length**power if length < inf else 1.0) / (2.0 * self.stiffness)

    def _rest(self, away: Array, order: int) -> Array:
        """Return what exp(-t) leaves after its terms below ``order``, with the sign of t^order."""
        length = self.length
        if length == inf:
            return np.asarray(away**order / factorial(order))
        t = away / length
        short = t < _SHORT
        out = np.empty(t.shape)
        near = t[short]
        series = np.zeros(near.shape)
        for n in range(order + _TERMS, order - 1, -1):
            series = series * -near + 1.0 / factorial(n)
        out[short] = series * near**order
        far = t[~short]
        known = sum((-far) ** n / factorial(n) for n in range(order))
        out[~short] = (-1.0) ** order * (np.exp(-far) - known)
        return out
