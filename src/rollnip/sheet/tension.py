"""The part of a sheet's tension that does not follow from the shears of the same solution.

The shears act on the faces of a sheet, at h/2 from its middle. On a path of curvature kappa (centre
on the upper side positive) this lever counts. With the forces dF_u and dF_l of the shears on the
faces, q times the length of the face, the tension N along the path, the force Q across it and the
bending moment M, an element of the sheet is in equilibrium along the path, and about its middle, if

    dN = dF_u - dF_l + kappa Q ds,    Q ds = -(h/2) (dF_u + dF_l) - dM,

where s is the length of the middle. So the tension grows by

    dN = dF_u (1 - h kappa/2) - dF_l (1 + h kappa/2) - kappa dM.

The faces run at V_s (1 + e) (1 -+ h kappa/2), so the power of the shears on them is
V_s (1 + e) (dN + kappa dM), the work against tension and bending moment. A belt on a pulley of
radius R is an example: kappa = -1/(R + h/2), and dN (R + h/2) = -dF_l R is the balance of moments
about the axis. The bending moment is D kappa with the bending stiffness D, so the last term is the
change of -D kappa^2/2, which is zero far away on both sides, where N has its given values. A sheet
that bends freely is without it.

What the curvature adds to N in this way is evaluated from the previous iterate. `linear` neglects
it, as products of shears and curvatures.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rollnip.sheets import Sheet

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class FaceLevers:
    """Forces on one face of a sheet, and the levers of its shears.

    Attributes
    ----------
    places : (n,) in ascending order [mm].
    forces, pressed : (n - 1,) int q ds and int p ds between them [N/mm].
    ratios : (n - 1,) h kappa/2: lever over radius of curvature.
    """

    places: Array
    forces: Array
    pressed: Array
    ratios: Array

    @property
    def lever_force(self) -> float:
        """Return what the levers take of the tension: the sum of forces times ratios [N/mm]."""
        return float(self.forces @ self.ratios)

    def lever_force_beyond(self, x: Array) -> Array:
        """Return the part of ``lever_force`` that lies beyond given places, (m,) [N/mm]."""
        beyond = np.append(np.cumsum((self.forces * self.ratios)[::-1])[::-1], 0.0)
        return np.asarray(np.interp(x, self.places, beyond))

    def holds(self, x: Array) -> NDArray[np.bool_]:
        """Return which places lie among those of this face, (m,)."""
        return np.asarray((x >= self.places[0]) & (x <= self.places[-1]))

    def ratio_at(self, x: Array) -> Array:
        """Return h kappa/2 at given places, (m,); beyond those of this face, that at its end."""
        middles = 0.5 * (self.places[1:] + self.places[:-1])
        return np.asarray(np.interp(x, middles, self.ratios))


@dataclass(frozen=True, slots=True)
class KnownTension:
    """The tension of a sheet without what the shears of the solution itself add to it.

    Attributes
    ----------
    inlet : tension on the inlet side of the nip [N/mm].
    places : (m,) in ascending order [mm].
    added : (m,) what the curvature of the path adds there [N/mm].
    change : int (q_u - q_l) ds that leads from the outlet to the inlet [N/mm].
    """

    inlet: float
    places: Array
    added: Array
    change: float

    @classmethod
    def on_straight_path(cls, sheet: Sheet) -> KnownTension:
        """Return the known tension for a path without curvature."""
        inlet, pull = sheet.tension_in, sheet.tension_in - sheet.tension_out
        return cls(inlet, np.zeros(1), np.zeros(1), pull)

    @classmethod
    def after(
        cls, sheet: Sheet, faces: tuple[FaceLevers, FaceLevers], *, bends: bool
    ) -> KnownTension:
        """Return the known tension for the levers in an earlier solution.

        It is linear between the places of both faces.

        ``bends``: whether a bending moment goes with the curvature.
        """
        places = np.unique(np.concatenate([one.places for one in faces]))
        added = faces[0].lever_force_beyond(places) + faces[1].lever_force_beyond(places)
        if bends:
            upper, lower = (one.ratio_at(places) for one in faces)
            on_upper, on_lower = (one.holds(places) for one in faces)
            # between the edges of the wider contact alone, that contact knows the curvature
            ratio = np.where(on_lower, np.where(on_upper, 0.5 * (upper + lower), lower), upper)
            added -= ratio**2 / (6.0 * sheet.stretch_by_tension)
        inlet, pull = sheet.tension_in, sheet.tension_in - sheet.tension_out
        change = pull + faces[0].lever_force + faces[1].lever_force
        return cls(inlet, places, added, change)

    def change_from(self, old: KnownTension) -> float:
        """Return the largest change since an older one [N/mm]."""
        return float(np.abs(self.added - np.interp(self.places, old.places, old.added)).max())

    def at(self, x: Array) -> Array:
        """Return the known tension at given places, (m,) [N/mm]."""
        return np.asarray(self.inlet + np.interp(x, self.places, self.added))

    def over(self, x: Array) -> Array:
        """Return the integral of the known tension from each of m places to the next one [N]."""
        places, added = self.places, self.added
        along = np.zeros(places.size)
        np.cumsum((places[1:] - places[:-1]) * (added[1:] + added[:-1]), out=along[1:])
        last = np.maximum(places.searchsorted(x, side="right") - 1, 0)
        along = along[last] + (x - places[last]) * (added[last] + np.interp(x, places, added))
        return np.asarray(self.inlet * (x[1:] - x[:-1]) + 0.5 * (along[1:] - along[:-1]))
