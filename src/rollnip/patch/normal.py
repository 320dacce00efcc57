"""Normal contact of elastic bodies on a grid: conjugate gradients under the constraint p >= 0.

    gap = clearance - delta + sum zz p >= 0,   p >= 0,   p gap = 0,

with either the force or delta given (Polonsky & Keer 1999, Wear 231, 206-219; Vollebregt 2014, J.
Optim. Theory Appl. 162, 931-953).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from rollnip.patch.coefficients import Array

Mask = NDArray[np.bool_]

_MOST_STEPS = 2000


class Products(Protocol):
    """Displacements of a surface under pressures."""

    def normal(self, pressure: Array) -> Array:
        """Return displacements under a pressure, of its shape [mm]."""
        ...

    def symmetric(self) -> Products:
        """Return the products with the symmetric part of the compliance."""
        ...

    @property
    def element(self) -> float:
        """Area of one rectangle [mm2]."""
        ...

    @property
    def largest(self) -> float:
        """Largest displacement of a rectangle under a unit pressure on it [mm/MPa]."""
        ...


@dataclass(frozen=True, slots=True)
class NormalProblem:
    """Frictionless contact on a grid, or the normal part of a contact with friction.

    Attributes
    ----------
    products : displacements under tractions.
    clearance : (ny, nx) gap of the undeformed surfaces, less what shear closes [mm]; inf beyond the
        end of a face.
    force, approach : one is given [N], [mm]; the other is None.
    """

    products: Products
    clearance: Array
    force: float | None
    approach: float | None

    def symmetric(self) -> NormalProblem:
        """Return the problem with the symmetric part of the compliance."""
        return replace(self, products=self.products.symmetric())


@dataclass(frozen=True, slots=True)
class NormalState:
    """Pressures on a grid.

    Attributes
    ----------
    pressure : (ny, nx) [MPa].
    approach : delta [mm].
    gap : (ny, nx) [mm].
    steps : number of steps of conjugate gradients.
    change : largest change of the pressure in the last step, over its peak.
    settled : whether the iteration met its tolerance.
    """

    pressure: Array
    approach: float
    gap: Array
    steps: int
    change: float
    settled: bool


def solve_symmetric(problem: NormalProblem, tolerance: float, start: Array | None) -> NormalState:
    """Return the contact of elastic bodies on a grid.

    Parameters
    ----------
    problem : clearance and compliance; force or approach.
    tolerance : of the gap in the contact, over the depth of the contact, and of the last change of
        the pressure, over its peak.
    start : initial pressures, positive where contact is likely; None: where the clearance is
        smaller than elsewhere.
    """
    allowed = np.isfinite(problem.clearance)
    clearance = np.where(allowed, problem.clearance, 0.0)
    pressure = np.where(allowed, _start(problem, start), 0.0)
    direction = np.zeros_like(pressure)
    previous, fresh, change, settled = 1.0, True, np.inf, False
    gap = clearance + problem.products.normal(pressure)
    steps, shift = 0, 0.0
    while steps < _MOST_STEPS:
        steps += 1
        contact = pressure > 0.0
        shift = _shift(problem, gap, contact)
        rest = gap - shift
        power = float(np.sum(rest[contact] ** 2))
        if _closed(rest, contact, allowed, problem, pressure) < tolerance and change < tolerance:
            settled = True
            break
        along = 0.0 if fresh else power / previous
        direction = np.where(contact, rest + along * direction, 0.0)
        moved = problem.products.normal(direction)
        if problem.force is not None:
            moved -= np.mean(moved[contact])
        slope = float(np.sum(moved[contact] * direction[contact]))
        step = float(np.sum(rest[contact] * direction[contact])) / slope if slope > 0.0 else 0.0
        before = pressure
        pressure = np.maximum(pressure - step * direction, 0.0)
        overlap = allowed & (pressure == 0.0) & (rest < 0.0) & ~contact
        pressure[overlap] = -step * rest[overlap]
        fresh, previous = bool(np.any(overlap)), max(power, 1e-300)
        if problem.force is not None:
            pressure *= problem.force / (float(np.sum(pressure)) * problem.products.element)
        change = float(np.max(np.abs(pressure - before)) / np.max(pressure, initial=1e-300))
        gap = clearance + problem.products.normal(pressure)
    full = np.where(allowed, gap - shift, np.inf)
    return NormalState(pressure, shift, full, steps, change, settled)


def _start(problem: NormalProblem, start: Array | None) -> Array:
    """Return initial pressures, which add up to the force if that is given."""
    pressure = start
    if pressure is None or not np.any(pressure > 0.0):
        finite = problem.clearance[np.isfinite(problem.clearance)]
        level = float(np.quantile(finite, 0.25))
        if problem.approach is not None:
            level = min(level, problem.approach)
        pressure = np.where(problem.clearance <= max(level, finite.min()), 1.0, 0.0)
        stiff = float(np.max(problem.products.normal(pressure)))
        pressure *= max(level - float(finite.min()), 1e-300) / stiff
    if problem.force is not None:
        total = float(np.sum(pressure)) * problem.products.element
        pressure = pressure * (problem.force / total)
    return pressure


def _shift(problem: NormalProblem, gap: Array, contact: Mask) -> float:
    """Return the approach: the given one, or the one that makes the mean gap in contact zero."""
    if problem.approach is not None:
        return problem.approach
    return float(np.mean(gap[contact]))


def _closed(
    rest: Array, contact: Mask, allowed: Mask, problem: NormalProblem, pressure: Array
) -> float:
    """Return the largest violation of the contact conditions, over the depth of the contact."""
    wrong = np.where(contact, np.abs(rest), np.where(allowed, -rest, 0.0))
    return float(np.max(wrong)) / depth_of(problem, contact, float(np.max(pressure)))


def depth_of(problem: NormalProblem, contact: Mask, peak: float) -> float:
    """Return the depth of a contact, with which violations of its conditions are compared [mm].

    It is the displacement of one rectangle under the peak pressure [MPa], or the variation of the
    clearance over the contact if that is larger.
    """
    depth = problem.products.largest * peak
    depth = max(depth, float(np.ptp(problem.clearance[contact])) if np.any(contact) else 0.0)
    return max(depth, 1e-300)
