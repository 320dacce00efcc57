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
from rollnip.sheet.friction import SIDE_SIGNS
from rollnip.sheet.plate.interface import values_at
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
    loads : two sets, c [N/mm] and f [MPa].
    places : (m,) at which their effect on the plate is known, in ascending order [mm].
    height, rotation : height [mm] and rotation of the plate due to them at these places, each (m,).
    """

    loads: PiecewiseLoads
    places: Array
    height: Array
    rotation: Array

    @classmethod
    def at_nodes(cls, loads: PiecewiseLoads) -> CurvedLoad:
        """Return the load with its effect at its own nodes."""
        x = loads.nodes
        return cls(loads, x, *_deflection(loads, x, loads.tail_moments))

    def at(self, places: Array) -> CurvedLoad:
        """Return the same load with its effect interpolated to given places."""
        height, rotation = (np.interp(places, self.places, y) for y in (self.height, self.rotation))
        return CurvedLoad(self.loads, places, height, rotation)

    @property
    def total(self) -> float:
        """Return the force per width [N/mm]."""
        return float(self.loads.total[1])

    @property
    def moment(self) -> float:
        """Return the moment about x = 0 per width [N]."""
        return float(self.loads.moment[1] - self.loads.total[0])

    def deflection_at(self, x: Array) -> tuple[Array, Array]:
        """Return height [mm] and rotation of the plate under the load at places, each (m,)."""
        at = np.minimum(np.searchsorted(self.places, x), self.places.size - 1)
        if np.array_equal(self.places[at], x):
            return self.height[at], self.rotation[at]
        return _deflection(self.loads, x, self.loads.tail_moments_at(x))

    def change_from(self, old: CurvedLoad) -> float:
        """Return the largest change of couple and force since an older load [N/mm]."""
        x = self.loads.nodes
        couple, force = (
            np.abs(new - np.interp(x, old.loads.nodes, one))
            for new, one in zip(self.loads.lines.T, old.loads.lines.T, strict=True)
        )
        return float(couple.max() + np.trapezoid(force, x))


def _deflection(loads: PiecewiseLoads, x: Array, tail_moments: Array) -> tuple[Array, Array]:
    height, slope, bend = loads.deflection(x, tail_moments)
    return slope[:, 0] + height[:, 1], bend[:, 0] + slope[:, 1]


def direction_of(turned: Array, curved: CurvedLoad | None) -> Array:
    """Return the sine of the path's direction, whose change stretches the faces, (m,).

    Where the path counts as straight, ``curved`` None, it is the rotation ``turned`` itself.
    """
    return turned if curved is None else np.asarray(turned / np.sqrt(1.0 + turned**2))


def is_stiff(problem: PlateProblem, x: Array, left_out: Array) -> bool:
    """Return whether stiffness rather than tension spreads the pressures on the sheet.

    A couple of N times the slope bends a wave of length 2 pi l by N l^2/(D + N_o l^2 + k l^4) of
    the slope itself, where k = E/d of the softer covering. This is at most N/(N_o + 2 sqrt(D k)),
    so iterations with a lagged couple converge where N is smaller than that denominator. Half of it
    is required as a margin, and that N_o is smaller too: where tension spreads the pressures,
    bending is small beside it. The same holds where l is below the share of the nip width from
    which stiffness counts. ``left_out``: see `tension_left_out`, at ``x``.
    """
    length = bending_length(problem.nip)
    if length < COUNTED * float(np.ptp(x)):
        return False
    pulled = problem.plate.tension + float(np.max(np.abs(left_out)))
    return pulled * length**2 < problem.sheet.bending_stiffness


def places_along(problem: PlateProblem) -> Array:
    """Return nodes[1:] of both interfaces in ascending order, (m,) [mm]."""
    return np.unique(problem.places)


def curved_load(
    problem: PlateProblem, state: PlateState, x: Array, slope: Array, left_out: Array
) -> CurvedLoad:
    """Return the load on a plate whose path has the given slope at given places, each (m,).

    ``left_out``: see `tension_left_out`, at the same places.
    """
    sheet, plate = problem.sheet, problem.plate
    sheared = np.zeros(x.size)
    for side, mesh in enumerate(problem.meshes):
        sheared += SIDE_SIGNS[side] * values_at(mesh, state.shear[side], x)
    rise = (sheet.tension_in - sheet.tension_out) / float(np.ptp(x))
    lines = np.stack([slope * left_out, -slope * (sheared - rise)], axis=1)
    return CurvedLoad.at_nodes(PiecewiseLoads.of_lines(x, lines, sheet, plate))


def tension_left_out(
    problem: PlateProblem, state: PlateState, known: KnownTension, x: Array
) -> Array:
    """Return N - N_o + (h/2) (p_u + p_l) at given places, (m,) [N/mm]."""
    sheet, pressed = problem.sheet, np.zeros(x.size)
    for side, mesh in enumerate(problem.meshes):
        pressed += values_at(mesh, state.pressure[side], x)
    rise = (sheet.tension_in - sheet.tension_out) / float(np.ptp(x))
    outside = sheet.tension_out + rise * (x - x[0])
    pulled = problem.tension_at(state, known, x) - outside
    return np.asarray(pulled + 0.5 * sheet.thickness * pressed)
