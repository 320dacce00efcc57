"""Normal contact of viscoelastic bodies, whose compliance is not symmetric.

    gap = clearance - delta + sum zz p >= 0,   p >= 0,   p gap = 0.

The symmetric part of zz is positive definite, because no wave returns more work than it takes. The
solution is therefore unique, but it does not minimise an energy, so that conjugate gradients do not
find it. Newton's method does, on the projection of p - gap/c onto p >= 0. In the present contact
the gap is 0: a linear system that GMRES solves, preconditioned by the inverse magnitude of each
wave's compliance. Then points with p < 0 leave the contact, and points that overlap join it. With a
prescribed force, delta is an unknown of the system.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft2, rfft2

from rollnip.patch.coefficients import Array
from rollnip.patch.krylov import gmres
from rollnip.patch.normal import NormalProblem, NormalState, depth_of, solve_symmetric

Mask = NDArray[np.bool_]

_MOST_STEPS = 60
_LINEAR = 0.1
"""Share of the tolerance that a linear system may leave."""
_ROUGH = 0.03
"""Tolerance of the initial pressures."""


def solve_lossy(
    problem: NormalProblem, tolerance: float, start: Array | None, symbols: Array
) -> NormalState:
    """Return the contact of viscoelastic bodies on a grid.

    Parameters
    ----------
    problem : clearance and compliance; force or approach.
    tolerance : of the gap in the contact and of overlaps, over the depth of the contact, and of
        negative pressures, over the peak.
    start : initial pressures; None: those under the symmetric part of the compliance.
    symbols : (py, px//2 + 1) preconditioner: inverse magnitude of the compliance over the wave
        vector.
    """
    allowed = np.isfinite(problem.clearance)
    clearance = np.where(allowed, problem.clearance, 0.0)
    pressure = start
    if pressure is None or not np.any(pressure > 0.0):
        pressure = solve_symmetric(problem.symmetric(), _ROUGH, None).pressure
    pressure = np.where(allowed, pressure, 0.0)
    contact = pressure > 0.0
    delta = problem.approach or 0.0
    steps, products, worst = 0, 0, np.inf
    while np.any(contact):
        steps += 1
        inside = _ContactSystem(problem, contact, symbols)
        pressure, delta = inside.closed(pressure * contact, delta, clearance, tolerance)
        products += inside.products
        rest = clearance + problem.products.normal(pressure) - delta
        peak = max(float(np.max(pressure)), 1e-300)
        scale = depth_of(problem, contact, peak)
        wrong = np.where(contact, np.abs(rest), np.where(allowed, -rest, 0.0)) / scale
        worst = max(float(np.max(wrong)), -float(np.min(pressure)) / peak)
        if worst < tolerance or steps == _MOST_STEPS:
            break
        contact = np.where(contact, pressure > 0.0, allowed & (rest < 0.0))
    pressure = np.maximum(pressure, 0.0)
    gap = clearance + problem.products.normal(pressure) - delta
    gap = np.where(allowed, gap, np.inf)
    return NormalState(pressure, delta, gap, steps + products, worst, worst < tolerance)


class _ContactSystem:
    """The linear system for the pressures that close the gap over a given contact.

    Attributes
    ----------
    products : number of products with the compliance so far.
    """

    def __init__(self, problem: NormalProblem, contact: Mask, symbols: Array) -> None:
        self.problem, self.contact, self.symbols, self.products = problem, contact, symbols, 0
        self.free = problem.force is not None
        element = problem.products.element
        self.wanted = 0.0 if problem.force is None else problem.force / element
        # The row of the force is scaled to the size of the other rows.
        self.unit = problem.products.largest
        self.unit /= float(np.sqrt(np.sum(contact)))

    def closed(
        self, pressure: Array, delta: float, clearance: Array, tolerance: float
    ) -> tuple[Array, float]:
        """Return the pressures and the approach that close the gap, from present ones."""
        rest = clearance + self.problem.products.normal(pressure) - delta
        depth = depth_of(self.problem, self.contact, max(float(np.max(pressure)), 1e-300))
        right = -(rest * self.contact).ravel()
        if self.free:
            right = np.append(right, self.unit * (self.wanted - float(np.sum(pressure))))
        size = max(float(np.linalg.norm(right)), 1e-300)
        goal = _LINEAR * tolerance * depth * float(np.sqrt(np.sum(self.contact)))
        found = gmres(self._product, self._roughly, right, min(goal / size, 0.5))
        change = found[: pressure.size].reshape(pressure.shape)
        return pressure + change, delta + (float(found[-1]) if self.free else 0.0)

    @cached_property
    def answer(self) -> Array:
        """Approximate pressure due to a unit of approach."""
        return self._smoothed(self.contact.astype(float))

    def _product(self, vector: Array) -> Array:
        self.products += 1
        values = vector[: self.contact.size].reshape(self.contact.shape)
        out = self.problem.products.normal(values)
        if not self.free:
            return np.asarray((out * self.contact).ravel())
        out = (out - vector[-1]) * self.contact
        return np.append(out.ravel(), self.unit * float(np.sum(values)))

    def _roughly(self, vector: Array) -> Array:
        values = self._smoothed(vector[: self.contact.size].reshape(self.contact.shape))
        if not self.free:
            return np.asarray(values.ravel())
        lacks = vector[-1] / self.unit - float(np.sum(values))
        moved = lacks / float(np.sum(self.answer))
        return np.append((values + moved * self.answer).ravel(), moved)

    def _smoothed(self, values: Array) -> Array:
        """Return approximately the pressure that causes a displacement, (ny, nx)."""
        (py, half), (ny, nx) = self.symbols.shape, self.contact.shape
        shape = (py, 2 * (half - 1))
        spectrum = self.symbols * rfft2(values * self.contact, shape, workers=1)
        return np.asarray(irfft2(spectrum, shape, workers=1)[:ny, :nx] * self.contact)
