"""Deflection of a roller under a line load along its face: a stepped Timoshenko beam.

The roller lies on two bearings, B apart, beyond both ends of the face of length L. With reactions
R_1, R_2 by statics, shear force Q and moment M over the face,

    psi' = -M/(E I),   v' = psi + Q/(kappa G A),   v = 0 at both bearings,

where v is the deflection in the direction of the load, psi the rotation of the cross-section, and
kappa the shear coefficient of Cowper (1966). Journals carry the reactions. With s from the bearing,
over the journal's length l, its end at the face loses a rotation of int R s/(E I_j) ds, deflects
from the tangent by int R (l - s) s/(E I_j) ds, and moves by int R/(kappa G A_j) ds in shear; each
integral is taken step by step. Everything is linear in the load, so that it is held in a matrix.
Integrals over the face are those of the polynomial through the nodes.
"""

from __future__ import annotations

from collections.abc import Sequence
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
    y : (n,) from one end of the face to the other, dense near both [mm].
    weights : (n,) of the integral over the face [mm].
    running : (n, n) matrix of the integral from the first end to each place [mm].
    """

    y: Array
    weights: Array
    running: Array

    @classmethod
    def of(cls, length: float, count: int) -> FaceGrid:
        """Return ``count`` Chebyshev places on a face of a given length [mm]."""
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
class Journal:
    """Deflections of a journal under a unit force at its bearing.

    Attributes
    ----------
    length : from bearing to face [mm].
    turn : rotation of its end at the face relative to the bearing [1/N].
    fall : deflection of that end from the tangent at the bearing, by bending [mm/N].
    shear : deflection by shear [mm/N].
    """

    length: float
    turn: float = 0.0
    fall: float = 0.0
    shear: float = 0.0

    @classmethod
    def of(cls, length: float, steps: Sequence[tuple[float, float, float]]) -> Journal:
        """Return a journal, given its steps from the face to the bearing.

        Parameters
        ----------
        length : of the journal [mm].
        steps : length [mm], E I [N mm2] and kappa G A [N] of each; the last extends to the bearing.
        """
        turn = fall = shear = 0.0
        upper = length  # distance of the step's end next to the face from the bearing
        for i, (own, bending, rigidity) in enumerate(steps):
            low = 0.0 if i == len(steps) - 1 else max(upper - own, 0.0)
            first = (upper**2 - low**2) / 2.0  # int s ds
            second = (upper**3 - low**3) / 3.0  # int s^2 ds
            turn += first / bending
            fall += (length * first - second) / bending
            shear += (upper - low) / rigidity
            upper = low
        return cls(length, turn, fall, shear)


@dataclass(frozen=True, slots=True)
class Beam:
    """A roller as a beam, for the deflection of its axis.

    Attributes
    ----------
    length : of the face [mm].
    bending, shear : E I [N mm2] and kappa G A [N] over the face; inf: rigid.
    journals : at y < 0 and at y > 0.
    """

    length: float
    bending: float
    shear: float
    journals: tuple[Journal, Journal]

    @classmethod
    def of(cls, roller: Roller, shaft: Shaft, length: float) -> Beam:
        """Return the beam of a roller and its shaft.

        Raises
        ------
        InvalidInputError
            where the bearings lie inside the face, the roller is a plane, the bore is not smaller
            than the core, or the journals are longer or thicker than there is room for.
        """
        if roller.radius == inf:
            raise InvalidInputError("`shaft` needs a roller with a radius, not a plane.")
        overhangs = _overhangs(shaft, length)
        core = 2.0 * (roller.radius - roller.coating_thickness)
        if shaft.bore >= core:
            raise InvalidInputError(
                f"`bore` must be smaller than the core's diameter, {core:g} mm, got "
                f"{shaft.bore:g} mm."
            )
        first, second = (Journal.of(one, _steps(shaft, one, core)) for one in overhangs)
        return cls(
            length,
            bending_stiffness(core, shaft.bore, shaft.modulus),
            shear_stiffness(core, shaft.bore, shaft.modulus, shaft.poisson),
            (first, second),
        )

    def flexibility(self, grid: FaceGrid) -> Array:
        """Return the matrix of deflections per line load at the places of a grid, (n, n) [mm2/N].

        ``flexibility @ load`` is v at the places, in the direction of the load [N/mm].
        """
        one, two = self.journals
        span = one.length + self.length + two.length
        from_first = grid.y + 0.5 * self.length + one.length  # distance from the first bearing
        right = (grid.weights * from_first) / span  # reactions per load at a node
        left = grid.weights - right
        shear = left[None, :] - grid.running
        moment = left[None, :] * from_first[:, None] - grid.running @ grid.running
        turned = -(grid.running @ moment) / self.bending  # psi minus psi at the first end
        down = grid.running @ turned + grid.running @ shear / self.shear
        # First journal, from its bearing on: rotation lost, deflection gained.
        lost = left * one.turn
        gained = left * (one.shear - one.fall)
        # Second journal, from the face on: int s^2/(E I) = length * turn - fall.
        fallen = right * (two.shear + two.length * two.turn - two.fall)
        # v(second bearing) = 0 gives psi at the first: psi * span + the loads' part = 0.
        at_end = gained - lost * self.length + down[-1]
        beyond = (turned[-1] - lost) * two.length - fallen
        first = -(at_end + beyond) / span
        start, slope = first * one.length + gained, first - lost
        return np.asarray(start[None, :] + slope[None, :] * (grid.y - grid.y[0])[:, None] + down)


def _overhangs(shaft: Shaft, length: float) -> tuple[float, float]:
    """Return the distances of both bearings from the ends of the face [mm]."""
    first, second = shaft.bearings
    overhangs = -0.5 * length - first, second - 0.5 * length
    if shaft.bearing_distance < length:
        raise InvalidInputError(
            f"`bearing_distance` must be at least the length of the face, {length:g} mm, got "
            f"{shaft.bearing_distance:g} mm; bearings inside the face are not modelled."
        )
    if min(overhangs) < 0.0:
        raise InvalidInputError(
            f"`bearing_middle` must leave both bearings beyond the face, at most "
            f"{0.5 * (shaft.bearing_distance - length):g} mm in size, got "
            f"{shaft.bearing_middle:g} mm; bearings inside the face are not modelled."
        )
    return overhangs


def _steps(shaft: Shaft, overhang: float, core: float) -> list[tuple[float, float, float]]:
    """Return length, E I and kappa G A of the steps of a journal from the face outwards."""
    steps = shaft.journal_steps
    for step in steps:
        if step.diameter > core:
            raise InvalidInputError(
                f"`journal_diameter` must not be larger than the core's diameter, {core:g} mm, got "
                f"{step.diameter:g} mm."
            )
    if sum(step.length for step in steps[:-1]) > overhang * (1.0 + 1e-9):
        raise InvalidInputError(
            f"`journals` must fit between face and bearing, {overhang:g} mm; all steps but the "
            f"last are {sum(step.length for step in steps[:-1]):g} mm long."
        )
    return [
        (
            step.length,
            bending_stiffness(step.diameter, 0.0, shaft.modulus),
            shear_stiffness(step.diameter, 0.0, shaft.modulus, shaft.poisson),
        )
        for step in steps
    ]
