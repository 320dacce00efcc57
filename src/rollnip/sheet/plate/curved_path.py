"""Loads on a plate due to the curvature of its path, of the order of thickness times curvature.

The faces of a plate take pressures p_u, p_l and shears q_u, q_l at their own abscissae
x -+ (h/2) y', where y(x) is its path, and the tension N varies along the nip. Equilibrium of forces
and moments on an element then gives the load on the plate (`rollnip.sheet.plate.bending`)

    w = p_l - p_u - (h/2) d(q_u + q_l)/dx + dc/dx + f,
    c = (N - N_o) y' + (h/2) y' (p_u + p_l),    f = -(q_u - q_l - dN_o/dx) y',

where f has the shears themselves, and N includes what the curvature adds to it
(`rollnip.sheet.tension`). N_o varies linearly from the tension at the outlet to that at the inlet.
The couple c and the force f are lagged. The plate is solved with the mean of both tensions; the
difference of N_o from it is neglected. A face lies h/2 sqrt(1 + y'^2) above or below the path at
its own abscissa, so each gap is smaller by (h/4) y'^2. Bending stretches the faces as the direction
of the path changes, by -+ (h/2) d(sin theta), tan theta = y'. All of this is neglected where
tension rather than stiffness spreads the pressures on the sheet.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rollnip.sheet.bending import COUNTED, bending_length
from rollnip.sheet.plate.interface import SIGNS, values_at
from rollnip.sheet.plate.loads import PiecewiseLoads

if TYPE_CHECKING:
    from rollnip.sheet.plate.system import PlateProblem, PlateState
    from rollnip.sheet.tension import KnownTension

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class CurvedLoad:
    """Couple and force on a plate due to its curved path, and their effect at given places.

    Attributes
    ----------
    couple, force : c [N/mm] and f [MPa], each of one set, at the same nodes.
    places : (m,) at which their effect on the plate is known, in ascending order [mm].
    height, rotation : height [mm] and rotation of the plate due to them at these places, each (m,).
    """

    couple: PiecewiseLoads
    force: PiecewiseLoads
    places: Array
    height: Array
    rotation: Array

    @classmethod
    def of(cls, couple: PiecewiseLoads, force: PiecewiseLoads, places: Array) -> CurvedLoad:
        """Return the load with its effect at given places."""
        return cls(couple, force, places, *_deflection(couple, force, places))

    @property
    def total(self) -> float:
        """Return the force per width [N/mm]."""
        return float(self.force.total[0])

    @property
    def moment(self) -> float:
        """Return the moment about x = 0 per width [N]."""
        return float(self.force.moment[0] - self.couple.total[0])

    def deflection_at(self, x: Array) -> tuple[Array, Array]:
        """Return height [mm] and rotation of the plate under the load at places, each (m,)."""
        at = np.minimum(np.searchsorted(self.places, x), self.places.size - 1)
        if np.array_equal(self.places[at], x):
            return self.height[at], self.rotation[at]
        return _deflection(self.couple, self.force, x)

    def change_from(self, old: CurvedLoad, load: float) -> float:
        """Return the largest change of couple and force since an older load, over the line load."""
        x = self.couple.nodes
        couple, force = (
            np.abs(new.lines[:, 0] - np.interp(x, one.nodes, one.lines[:, 0]))
            for new, one in ((self.couple, old.couple), (self.force, old.force))
        )
        return float(couple.max() + np.trapezoid(force, x)) / load


def _deflection(couple: PiecewiseLoads, force: PiecewiseLoads, x: Array) -> tuple[Array, Array]:
    by_couple, by_force = (
        couple.deflection(x, couple.tail_moments_at(x)),
        force.deflection(x, force.tail_moments_at(x)),
    )
    return (by_couple[1] + by_force[0])[:, 0], (by_couple[2] + by_force[1])[:, 0]


def direction_of(turned: Array, curved: CurvedLoad | None) -> Array:
    """Return the sine of the path's direction, whose change stretches the faces, (m,).

    Where the path counts as straight, ``curved`` None, it is the rotation ``turned`` itself.
    """
    return turned if curved is None else np.asarray(turned / np.sqrt(1.0 + turned**2))


def is_stiff(problem: PlateProblem, state: PlateState, known: KnownTension, x: Array) -> bool:
    """Return whether stiffness rather than tension spreads the pressures on the sheet.

    A couple of N times the slope bends a wave of length 2 pi l by N l^2/(D + N_o l^2 + k l^4) of
    the slope itself, where k = E/d of the softer covering. This is at most N/(N_o + 2 sqrt(D k)),
    so iterations with a lagged couple converge where N is smaller than that denominator. Half of it
    is required as a margin, and that N_o is smaller too: where tension spreads the pressures,
    bending is small beside it. The same holds where l is below the share of the nip width from
    which stiffness counts.
    """
    length = bending_length(problem.nip)
    if length < COUNTED * float(np.ptp(x)):
        return False
    left_out = _tension_left_out(problem, state, known, x)
    pulled = problem.plate.tension + float(np.max(np.abs(left_out)))
    return pulled * length**2 < problem.sheet.bending_stiffness


def places_along(problem: PlateProblem) -> Array:
    """Return nodes[1:] of both interfaces in ascending order, (m,) [mm]."""
    return np.unique(problem.places)


def curved_load(
    problem: PlateProblem, state: PlateState, known: KnownTension, x: Array, slope: Array
) -> CurvedLoad:
    """Return the load on a plate whose path has the given slope at given places, each (m,)."""
    sheet, plate = problem.sheet, problem.plate
    sheared = np.zeros(x.size)
    for side, mesh in enumerate(problem.meshes):
        sheared += SIGNS[side] * (values_at(mesh, x) @ state.shear[side])
    rise = (sheet.tension_in - sheet.tension_out) / float(np.ptp(x))
    couple = slope * _tension_left_out(problem, state, known, x)
    parts = couple[:, None], (-slope * (sheared - rise))[:, None]
    first, second = (PiecewiseLoads.of_lines(x, part, sheet, plate) for part in parts)
    return CurvedLoad.of(first, second, x)


def _tension_left_out(
    problem: PlateProblem, state: PlateState, known: KnownTension, x: Array
) -> Array:
    """Return N - N_o + (h/2) (p_u + p_l) at given places, (m,) [N/mm]."""
    sheet, pressed = problem.sheet, np.zeros(x.size)
    for side, mesh in enumerate(problem.meshes):
        pressed += values_at(mesh, x) @ state.pressure[side]
    rise = (sheet.tension_in - sheet.tension_out) / float(np.ptp(x))
    outside = sheet.tension_out + rise * (x - x[0])
    pulled = problem.tension_at(state, known, x) - outside
    return np.asarray(pulled + 0.5 * sheet.thickness * pressed)
