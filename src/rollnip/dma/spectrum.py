"""Relaxation spectra by non-negative least squares, as smooth as cross-validation asks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import lsq_linear, nnls

Array = NDArray[np.float64]
Measured = Literal["dynamic", "relaxation", "creep"]

_FOLDS = 5
_LEAST_NORM = 1e-6  # of a column over the largest; below it the data do not determine its term
# Most and fewest terms per decade: equal terms, evenly spaced, make the loss modulus ripple by the
# fraction 2/cosh(pi^2/ln spacing), 5 % with one term per decade, 0.6 % with one and a half.
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
    storage, loss : (n,) moduli [MPa]; both are the relaxation modulus [MPa] or the creep compliance
        [1/MPa] where that was measured.
    errors : relative standard errors of storage and loss.
    weights : (n,) factors on the residuals of each measurement; all 1 by default.
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
        """(2 n,) right-hand side of the fit: 1/error of storage, then of loss, times the weights.

        Rows are divided by the measured value and its relative error. (n,) for a relaxation modulus
        or a
        creep compliance.
        """
        ones = np.ones(self.omega.size) if self.weights is None else self.weights
        if self.kind != "dynamic":
            return np.asarray(ones / self.errors[0])
        return np.concatenate([ones / self.errors[0], ones / self.errors[1]])

    def design(self, times: Array) -> Array:
        """Return what the relaxed modulus and each term contribute to the target, (2 n, m + 1).

        (n, m + 1) for a relaxation modulus, E + sum E_i e^(-t/tau_i), or for a creep compliance,
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
    """Return ``count`` times [s], evenly spaced on a logarithmic scale.

    They reach half a decade beyond the data on both sides.
    """
    first, last = 1.0 / (float(np.max(omega)) * _MARGIN), _MARGIN / float(np.min(omega))
    return np.geomspace(first, last, count) if count > 1 else np.array([np.sqrt(first * last)])


def most_terms(omega: Array) -> int:
    """Return the number of terms at three per decade, half a decade beyond the data on both sides.

    It is at most 80 and at most the number of measurements.
    """
    decades = np.log10(float(np.max(omega)) / float(np.min(omega))) + 1.0
    return int(min(max(np.ceil(_PER_DECADE * decades), 1), _MOST_TERMS, omega.size))


def non_negative(data: Reduced, times: Array, smoothing: float = 0.0) -> tuple[Array, Array]:
    """Return the best-fitting moduli (m + 1,), the relaxed one first, and the residuals.

    The residuals are those of ``Reduced.target``. ``smoothing`` weights the second differences of
    neighbouring terms, each over the storage modulus measured at its frequency, against the
    residuals
    (Tikhonov 1963).
    """
    design, target = data.design(times), data.target
    whole, aim = design, target
    if smoothing > 0.0 and times.size > 2:
        rows = smoothing * _second_differences(data, times)
        whole = np.concatenate([design, rows])
        aim = np.concatenate([target, np.zeros(rows.shape[0])])
    # normalise the columns, since the solver's thresholds are absolute
    scale = np.linalg.norm(whole, axis=0)
    is_determined = scale > _LEAST_NORM * float(np.max(scale))
    scale[~is_determined] = np.inf  # a term that has decayed before the data begin stays zero
    try:
        moduli, _ = nnls(whole / scale, aim, maxiter=30 * scale.size)
    except RuntimeError:  # its active set cycled; this solver is slower and as good
        moduli = np.maximum(lsq_linear(whole / scale, aim, bounds=(0.0, np.inf)).x, 0.0)
    moduli = moduli / scale
    return moduli, design @ moduli - target


def _second_differences(data: Reduced, times: Array) -> Array:
    """Return (m - 2, m + 1): second differences of the terms over the local storage modulus."""
    order = np.argsort(data.omega)
    log_omega, log_storage = np.log(data.omega[order]), np.log(data.storage[order])
    storage = np.exp(np.interp(-np.log(times), log_omega, log_storage))
    differences = np.diff(np.eye(times.size), n=2, axis=0) / storage
    return np.column_stack([np.zeros(times.size - 2), differences])


def crossvalidated(data: Reduced) -> tuple[int, float, Array]:
    """Return the number of terms and the smoothing that best predict held-out data.

    Candidates are one and a half to three terms per decade without smoothing, which follow a
    spectrum
    of discrete lines, and three per decade with various degrees of smoothing, which follow a
    continuous
    spectrum without ripples. Five folds, the same every time. Data within half a decade of the ends
    are
    never held out: predicting them would be extrapolation, which says nothing about the terms.

    Returns
    -------
    number of terms, smoothing, and for each candidate the mean square (k,) of the residuals of
    held-out
    data; empty where there are too few data to hold some out.
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
    """Return the mean square of the residuals of each fold in a fit without it."""
    times = relaxation_times(data.omega, count)
    squares = 0.0
    for k in range(_FOLDS):
        moduli, _ = non_negative(data.at(fold != k), times, strength)
        rest = data.at(fold == k)
        squares += float(np.mean((rest.design(times) @ moduli - rest.target) ** 2))
    return squares / _FOLDS
