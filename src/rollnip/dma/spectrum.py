"""Relaxation spectra by non-negative least squares, as smooth as the data bear."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import lsq_linear, nnls

Array = NDArray[np.float64]
Measured = Literal["dynamic", "relaxation", "creep"]

_FOLDS = 5
_TOLD = 1e-6  # size of a column over the largest, below which the data do not determine its term
# Terms at most, and at least: evenly spaced equal terms ripple in the loss modulus by the part
# 2/cosh(pi^2/ln spacing), 5 % with one a decade, .6 % with one and a half.
_PER_DECADE, _LEAST_PER_DECADE = 3.0, 1.5
_MARGIN = 10.0**0.5  # factor by which relaxation times reach beyond the data
_MOST_TERMS = 80
_STRENGTHS = tuple(float(s) for s in np.geomspace(1e-3, 1e3, 10))  # smoothing strengths


@dataclass(frozen=True, eq=False, slots=True)
class Reduced:
    """Data reduced to one temperature.

    Attributes
    ----------
    omega : (n,) reduced angular frequency [rad/s], or the reciprocal of the time [1/s].
    storage, loss : (n,) [MPa]; the relaxation modulus [MPa] or creep compliance [1/MPa] both,
        where one of these was measured.
    errors : relative standard errors of storage and loss.
    weights : (n,) by which the residuals of a measurement are multiplied; all 1 by default.
    kind : kind of measurement.
    """

    omega: Array
    storage: Array
    loss: Array
    errors: tuple[float, float] = (1.0, 1.0)
    weights: Array | None = None
    kind: Measured = "dynamic"

    @property
    def target(self) -> Array:
        """(2 n,) storage over its error, then loss over its error: both relative, 1/error.

        (n,) of a relaxation modulus or a creep compliance.
        """
        ones = np.ones(self.omega.size) if self.weights is None else self.weights
        if self.kind != "dynamic":
            return np.asarray(ones / self.errors[0])
        return np.concatenate([ones / self.errors[0], ones / self.errors[1]])

    def design(self, times: Array) -> Array:
        """(2 n, m + 1): what the relaxed modulus and each term add to the target.

        (n, m + 1) of a relaxation modulus, E + sum E_i e^(-t/tau_i), or of a creep compliance,
        J + sum J_i (1 - e^(-t/tau_i)), with the instantaneous compliance first.
        """
        if self.kind != "dynamic":
            return self._over_time(times)
        x = np.outer(self.omega, times)
        imaginary = 1.0 / (x + 1.0 / x)
        real = x * imaginary  # x^2/(1 + x^2), without overflow
        above = np.column_stack([np.ones(self.omega.size), real]) / self.storage[:, None]
        below = np.column_stack([np.zeros(self.omega.size), imaginary]) / self.loss[:, None]
        whole = np.concatenate([above / self.errors[0], below / self.errors[1]])
        if self.weights is None:
            return whole
        return np.asarray(np.tile(self.weights, 2)[:, None] * whole)

    def _over_time(self, times: Array) -> Array:
        decay = np.exp(-1.0 / np.outer(self.omega, times))
        terms = decay if self.kind == "relaxation" else 1.0 - decay
        whole = np.column_stack([np.ones(self.omega.size), terms])
        weights = 1.0 if self.weights is None else self.weights[:, None]
        return np.asarray(weights * whole / (self.storage[:, None] * self.errors[0]))

    def at(self, chosen: NDArray[np.bool_]) -> Reduced:
        """Return the data at the measurements where ``chosen`` (n,) is true."""
        weights = None if self.weights is None else self.weights[chosen]
        storage, loss = self.storage[chosen], self.loss[chosen]
        return Reduced(self.omega[chosen], storage, loss, self.errors, weights, self.kind)


def relaxation_times(omega: Array, count: int) -> Array:
    """``count`` times, evenly on a logarithmic scale, half a decade beyond the data [s]."""
    first, last = 1.0 / (float(np.max(omega)) * _MARGIN), _MARGIN / float(np.min(omega))
    return np.geomspace(first, last, count) if count > 1 else np.array([np.sqrt(first * last)])


def most_terms(omega: Array) -> int:
    """Three terms a decade, half a decade beyond the data on both sides."""
    decades = np.log10(float(np.max(omega)) / float(np.min(omega))) + 1.0
    return int(min(max(np.ceil(_PER_DECADE * decades), 1), _MOST_TERMS, omega.size))


def non_negative(data: Reduced, times: Array, smoothing: float = 0.0) -> tuple[Array, Array]:
    """Moduli (m + 1,), the relaxed one first, and residuals of the best fit, as the target.

    ``smoothing`` weighs the second differences of neighbouring terms, each over the storage
    modulus measured at its frequency, against the residuals (Tikhonov 1963).
    """
    design, target = data.design(times), data.target
    whole, aim = design, target
    if smoothing > 0.0 and times.size > 2:
        rows = smoothing * _curvature(data, times)
        whole = np.concatenate([design, rows])
        aim = np.concatenate([target, np.zeros(rows.shape[0])])
    # columns of one size: the solver's thresholds are absolute
    scale = np.linalg.norm(whole, axis=0)
    told = scale > _TOLD * float(np.max(scale))
    scale[~told] = np.inf  # a term that has decayed before the data begin stays zero
    try:
        moduli, _ = nnls(whole / scale, aim, maxiter=30 * scale.size)
    except RuntimeError:  # its active set cycled; slower, and as good
        moduli = np.maximum(lsq_linear(whole / scale, aim, bounds=(0.0, np.inf)).x, 0.0)
    moduli = moduli / scale
    return moduli, design @ moduli - target


def _curvature(data: Reduced, times: Array) -> Array:
    """(m - 2, m + 1): second differences of the terms over the storage modulus there."""
    order = np.argsort(data.omega)
    log_omega, log_storage = np.log(data.omega[order]), np.log(data.storage[order])
    storage = np.exp(np.interp(-np.log(times), log_omega, log_storage))
    differences = np.diff(np.eye(times.size), n=2, axis=0) / storage
    return np.column_stack([np.zeros(times.size - 2), differences])


def crossvalidated(data: Reduced) -> tuple[int, float, Array]:
    """Number of terms and smoothing that best predict what they were not fitted to.

    Tried are one and a half to three terms a decade, each free, which follow a spectrum of single
    lines, and three a decade, more or less smoothed, which follow a continuous one without
    ripples. Five folds, the same every time. What lies within half a decade of the ends is never
    left out: without it a spectrum would have to extrapolate, which tells nothing of the terms.

    Returns
    -------
    number of terms, smoothing, and the mean square (k,) of what was left out for each try; no
    mean squares where there are too few data to leave some out.
    """
    most = most_terms(data.omega)
    least = min(int(np.ceil(_LEAST_PER_DECADE / _PER_DECADE * most)), most)
    inner = data.omega > _MARGIN * np.min(data.omega)
    inner &= data.omega < np.max(data.omega) / _MARGIN
    if np.count_nonzero(inner) < _FOLDS:
        return most, _STRENGTHS[len(_STRENGTHS) // 2], np.zeros(0)
    fold = np.full(data.omega.size, -1)
    size = int(np.count_nonzero(inner))
    fold[inner] = np.random.default_rng(0).permutation(size) % _FOLDS
    tried = [(count, 0.0) for count in range(least, most + 1)]
    tried += [(most, strength) for strength in _STRENGTHS]
    means = np.array([_held_out(data, *one, fold) for one in tried])
    return *tried[int(np.argmin(means))], means


def _held_out(data: Reduced, count: int, strength: float, fold: NDArray[np.int64]) -> float:
    """Mean square of what a fit without it leaves of each fold."""
    times = relaxation_times(data.omega, count)
    squares = 0.0
    for k in range(_FOLDS):
        moduli, _ = non_negative(data.at(fold != k), times, strength)
        rest = data.at(fold == k)
        squares += float(np.mean((rest.design(times) @ moduli - rest.target) ** 2))
    return squares / _FOLDS
