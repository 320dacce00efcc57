"""Deflection of a roller under a line load along its face: a stepped Timoshenko beam.

The roller lies on two bearings, B apart and the same distance beyond both ends of the face of
length L. With reactions R_1, R_2 by statics, shear force Q and moment M over the face,

    psi' = -M/(E I),   v' = psi + Q/(kappa G A),   v = 0 at both bearings,

v the deflection in the direction of the load, psi the turn of the cross-section, kappa after
Cowper (1966). Journals carry the reactions: over their length l they add R l^2/(2 E I_j) of turn
and R l^3/(3 E I_j) + R l/(kappa G A_j) of deflection at their end. Everything is linear in the
load, so a matrix holds it. Integrals over the face are those of the polynomial through the nodes.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError
from rollnip.rollers import Roller
from rollnip.shafts import Shaft, bending_stiffness, shear_stiffness

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class FaceGrid:
    """Places along the face, with the integrals of the polynomial through their values.

    Attributes
    ----------
    y : (n,) from one end of the face to the other, dense at both [mm].
    weights : (n,) of the integral over the face [mm].
    running : (n, n) matrix of the integral from the first end to each place [mm].
    """

    y: Array
    weights: Array
    running: Array

    @classmethod
    def of(cls, length: float, count: int) -> FaceGrid:
        """Return ``count`` Chebyshev places on a face of some length [mm]."""
        t = -np.cos(np.pi * np.arange(count) / (count - 1))
        to_coefficients = np.linalg.inv(chebyshev.chebvander(t, count - 1))
        integrated = chebyshev.chebint(to_coefficients, lbnd=-1.0, axis=0)
        running = 0.5 * length * chebyshev.chebvander(t, count) @ integrated
        return cls(0.5 * length * t, running[-1].copy(), np.asarray(running, dtype=np.float64))

    @property
    def length(self) -> float:
        """Length of the face [mm]."""
        return float(self.y[-1] - self.y[0])


@dataclass(frozen=True, slots=True)
class Beam:
    """A roller as a beam, for the deflection of its axis.

    Attributes
    ----------
    length, bearing_distance : of the face, between the bearings [mm].
    bending, shear : E I [N mm2] and kappa G A [N] over the face; inf: rigid.
    journal_bending, journal_shear : the same between face and bearing.
    """

    length: float
    bearing_distance: float
    bending: float
    shear: float
    journal_bending: float = inf
    journal_shear: float = inf

    @classmethod
    def of(cls, roller: Roller, shaft: Shaft, length: float) -> Beam:
        """Return the beam of a roller and its shaft.

        Raises
        ------
        InvalidInputError
            where the bearings lie inside the face, the roller is a plane, or the bore is not
            smaller than the core.
        """
        if shaft.bearing_distance < length:
            raise InvalidInputError(
                f"`bearing_distance` must be at least the length of the face, {length:g} mm, got "
                f"{shaft.bearing_distance:g} mm; bearings inside the face are not modelled."
            )
        if roller.radius == inf:
            raise InvalidInputError("`shaft` needs a roller with a radius, not a plane.")
        core = 2.0 * (roller.radius - roller.coating_thickness)
        if shaft.bore >= core:
            raise InvalidInputError(
                f"`bore` must be smaller than the core's diameter, {core:g} mm, got "
                f"{shaft.bore:g} mm."
            )
        elastic = (shaft.modulus, shaft.poisson)
        journals = (inf, inf)
        if shaft.journal_diameter is not None:
            journals = (
                bending_stiffness(shaft.journal_diameter, 0.0, shaft.modulus),
                shear_stiffness(shaft.journal_diameter, 0.0, *elastic),
            )
        return cls(
            length,
            shaft.bearing_distance,
            bending_stiffness(core, shaft.bore, shaft.modulus),
            shear_stiffness(core, shaft.bore, *elastic),
            *journals,
        )

    def flexibility(self, grid: FaceGrid) -> Array:
        """Return the matrix of deflections by line loads at the places of a grid, (n, n) [mm2/N].

        ``flexibility @ load`` is v at the places, in the direction of the load [N/mm].
        """
        y, span, overhang = (
            grid.y,
            self.bearing_distance,
            0.5 * (self.bearing_distance - self.length),
        )
        total = grid.weights
        right = (grid.weights * (y + 0.5 * span)) / span  # reactions per load at a node
        left = total - right
        shear = left[None, :] - grid.running
        moment = left[None, :] * (y[:, None] + 0.5 * span) - grid.running @ grid.running
        bent = grid.running @ moment / self.bending
        turn = -bent  # psi less psi at the first end of the face
        down = grid.running @ turn + grid.running @ shear / self.shear
        # Over a journal, seen from its bearing: turn lost and deflection gained under R there.
        ends = (left, right)
        lost = [r * overhang**2 / (2.0 * self.journal_bending) for r in ends]
        sheared = [r * overhang / self.journal_shear for r in ends]
        cubic = [r * overhang**3 / (6.0 * self.journal_bending) for r in ends]
        # v(bearing 2) = 0 gives psi at bearing 1: psi_1 B + what the loads add = 0.
        at_end = down[-1] + (sheared[0] - cubic[0]) - lost[0] * self.length
        turn_end = turn[-1] - lost[0]
        beyond = turn_end * overhang - (sheared[1] + 2.0 * cubic[1])
        first = -(at_end + beyond) / span
        start = first * overhang + sheared[0] - cubic[0]
        slope = first - lost[0]
        return np.asarray(start[None, :] + slope[None, :] * (y[:, None] - y[0]) + down)
