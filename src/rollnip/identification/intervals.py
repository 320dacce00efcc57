"""Uncertainty of the unknowns: covariance, and profiles of the likelihood."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import lsq_linear

from rollnip.identification.search import Local, Misfit

Array = NDArray[np.float64]

_MOST_ENDS = 8  # most trials for one end of an interval
_MOST_STEPS = 6  # most steps of the other unknowns at one value of this one
_CLOSE = 0.01  # relative accuracy of the distance of an end
_LITTLE = 0.01  # gain over the wanted rise, below which the search over the others ends


@dataclass(frozen=True, slots=True)
class IntervalEnd:
    """One end of a profile-likelihood interval.

    Attributes
    ----------
    coordinate : coordinate of the unknown, in the scale of the search.
    is_bound : whether it is the bound, because the data alone do not limit the interval.
    gain : by how much the sum of squares fell below that of the fit on the way; it should be 0.
    """

    coordinate: float
    is_bound: bool
    gain: float


def covariance(jacobian: Array, weights: Array) -> Array:
    """Return the covariance of the unknowns (p, p) from the weighted Jacobian at the best fit.

    With weights other than 1, the factors on the rows do not match their scatter: (J'J)^-1 J'WJ
    (J'J)^-1, W the weights. Directions that the data do not determine get 1e300.
    """
    _, values, right = np.linalg.svd(jacobian, full_matrices=False)
    floor = 1e-10 * max(float(values[0]), 1e-300)
    inverse = np.where(values > floor, 1.0 / np.maximum(values, floor), 1e150)
    bread = (right.T * inverse**2) @ right
    if np.all(weights == 1.0):
        return np.asarray(bread)
    meat = jacobian.T @ (weights[:, None] * jacobian)
    return np.asarray(bread @ meat @ bread)


def prediction_errors(misfit: Misfit, jacobian: Array, spread: Array) -> list[Array]:
    """Return the standard errors of the predictions of each set, in its unit.

    They follow from those of the unknowns to first order: sqrt(J C J') for each value, or inf where
    it depends on a direction that the data do not determine. They say how well the fitted curve is
    known, not how far measurements lie from it.

    Parameters
    ----------
    jacobian : (n, p) derivatives of the weighted residuals, without the loss function.
    spread : (p, p) covariance of the unknowns.
    """
    found, first = [], 0
    for part, error in zip(misfit.parts, misfit.errors, strict=True):
        rows = jacobian[first : first + part.values.size]
        first += part.values.size
        size = np.sqrt(np.maximum(np.einsum("ij,jk,ik->i", rows, spread, rows), 0.0))
        size = size * error / np.sqrt(part.weight)
        found.append(np.where(size < 1e100, size, np.inf))
    return found


def profile_ends(
    misfit: Misfit, best: Local, spread: Array, index: int, quantile: float
) -> tuple[IntervalEnd, IntervalEnd]:
    """Return both ends of the profile-likelihood interval of one unknown.

    The interval ends where the sum of squares, minimised over all other unknowns, is quantile^2
    above its minimum. Where the model is linear this is the interval of the covariance.

    Parameters
    ----------
    spread : (p, p) covariance, for the first guess.
    index : index of the unknown.
    """
    return (
        _profile_end(misfit, best, spread, index, -quantile),
        _profile_end(misfit, best, spread, index, quantile),
    )


def _profile_end(
    misfit: Misfit, best: Local, spread: Array, index: int, wanted: float
) -> IntervalEnd:
    sign, target = np.sign(wanted), abs(wanted)
    bound = misfit.high[index] if sign > 0 else misfit.low[index]
    room = abs(float(bound - best.ended[index]))
    error = float(np.sqrt(spread[index, index]))
    along = spread[:, index] / spread[index, index]
    distance, gain = min(target * error, room), 0.0
    inner, outer = 0.0, np.inf  # distances known to lie inside and outside the interval
    for _ in range(_MOST_ENDS):
        begin = best.ended + sign * distance * along
        begin[index] = best.ended[index] + sign * distance
        rise = _least_rise(misfit, best, begin, index, target)
        gain = max(gain, -rise)
        reached = np.sqrt(max(rise, 0.0)) / target
        if abs(reached - 1.0) < _CLOSE:
            break
        if reached < 1.0:
            if distance >= room * (1.0 - 1e-9):
                return IntervalEnd(float(bound), True, gain)
            inner = distance
        else:
            outer = distance
        guess = distance / min(max(reached, 0.3), 3.0) if np.isfinite(reached) else 0.0
        if not inner < guess < outer:
            guess = 0.5 * (inner + outer)
        distance = min(guess, room)
    return IntervalEnd(float(best.ended[index] + sign * distance), False, gain)


def _least_rise(misfit: Misfit, best: Local, begin: Array, index: int, target: float) -> float:
    """Return the rise of the sum of squares with one unknown held, minimised over the others.

    It takes Gauss-Newton steps. The derivatives are those at the best fit, updated after each step
    (Broyden 1965), so that a step costs one evaluation instead of 2 p.
    """
    others = np.arange(begin.size) != index
    z = np.clip(begin, misfit.low, misfit.high)
    jacobian = best.jacobian.copy()
    residuals = misfit.residuals(z)
    if not np.all(np.isfinite(residuals)):
        return np.inf
    _update(jacobian, z - best.ended, residuals - best.residuals)
    for _ in range(_MOST_STEPS if np.any(others) else 0):
        step = np.zeros_like(z)
        bounds = ((misfit.low - z)[others] - 1e-12, (misfit.high - z)[others] + 1e-12)
        step[others] = lsq_linear(jacobian[:, others], -residuals, bounds=bounds).x
        promised = float(residuals @ residuals - np.sum((residuals + jacobian @ step) ** 2))
        if promised < _LITTLE * target**2:
            break
        trial = np.clip(z + step, misfit.low, misfit.high)
        found = misfit.residuals(trial)
        if not np.all(np.isfinite(found)):
            break
        _update(jacobian, trial - z, found - residuals)
        if found @ found < residuals @ residuals:
            z, residuals = trial, found
    return float(residuals @ residuals) - best.cost


def _update(jacobian: Array, step: Array, change: Array) -> None:
    """Apply Broyden's update in place, the smallest change with ``jacobian @ step == change``."""
    size = float(step @ step)
    if size > 0.0:
        jacobian += np.outer(change - jacobian @ step, step) / size
