"""Relaxation spectra by non-negative least squares, and how many terms the data bear."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import lsq_linear, nnls

Array = NDArray[np.float64]

_FOLDS = 5
_PER_DECADE = 3.0  # terms at most
_MARGIN = 10.0**0.5  # by which relaxation times reach beyond the data
_MOST_TERMS = 80


@dataclass(frozen=True, eq=False, slots=True)
class Reduced:
    """Data reduced to one temperature.

    Attributes
    ----------
    omega : (n,) reduced angular frequency [rad/s].
    storage, loss : (n,) [MPa].
    errors : relative standard errors of storage and loss.
    """

    omega: Array
    storage: Array
    loss: Array
    errors: tuple[float, float] = (1.0, 1.0)

    @property
    def target(self) -> Array:
        """(2 n,) storage over its error, then loss over its error: both relative, 1/error."""
        ones = np.ones(self.omega.size)
        return np.concatenate([ones / self.errors[0], ones / self.errors[1]])

    def design(self, times: Array) -> Array:
        """(2 n, m + 1): what the relaxed modulus and each term add to the target."""
        x = np.outer(self.omega, times)
        imaginary = 1.0 / (x + 1.0 / x)
        real = x * imaginary  # x^2/(1 + x^2), without overflow
        above = np.column_stack([np.ones(self.omega.size), real]) / self.storage[:, None]
        below = np.column_stack([np.zeros(self.omega.size), imaginary]) / self.loss[:, None]
        return np.concatenate([above / self.errors[0], below / self.errors[1]])

    def at(self, chosen: NDArray[np.bool_]) -> Reduced:
        """Only the measurements where ``chosen`` (n,) is true."""
        return Reduced(self.omega[chosen], self.storage[chosen], self.loss[chosen], self.errors)


def relaxation_times(omega: Array, count: int) -> Array:
    """``count`` times, evenly on a logarithmic scale, half a decade beyond the data [s]."""
    first, last = 1.0 / (float(np.max(omega)) * _MARGIN), _MARGIN / float(np.min(omega))
    return np.geomspace(first, last, count) if count > 1 else np.array([np.sqrt(first * last)])


def most_terms(omega: Array) -> int:
    """Three terms a decade, half a decade beyond the data on both sides."""
    decades = np.log10(float(np.max(omega)) / float(np.min(omega))) + 1.0
    return int(min(max(np.ceil(_PER_DECADE * decades), 1), _MOST_TERMS, omega.size))


def non_negative(data: Reduced, times: Array) -> tuple[Array, Array]:
    """Moduli (m + 1,), the relaxed one first, and residuals (2 n,) of the best fit."""
    design, target = data.design(times), data.target
    # columns of one size: the solver's thresholds are absolute
    scale = np.linalg.norm(design, axis=0)
    try:
        moduli, _ = nnls(design / scale, target, maxiter=30 * scale.size)
    except RuntimeError:  # its active set cycled; slower, and as good
        moduli = np.maximum(lsq_linear(design / scale, target, bounds=(0.0, np.inf)).x, 0.0)
    moduli = moduli / scale
    return moduli, design @ moduli - target


def crossvalidated(data: Reduced) -> tuple[int, Array]:
    """Number of terms that best predicts what it was not fitted to; mean squares (m,) of each.

    One term, and no mean squares, where there are too few data to leave some out.

    Five folds, the same every time. The fewest terms are taken that predict no worse than the
    best number does, but for one standard error of the difference over the folds (after Breiman
    et al. 1984): more would follow the noise. What lies within half a decade of the ends is never
    left out: without it a spectrum would have to extrapolate, which tells nothing of its terms.
    """
    counts = np.arange(1, most_terms(data.omega) + 1)
    inner = data.omega > _MARGIN * np.min(data.omega)
    inner &= data.omega < np.max(data.omega) / _MARGIN
    if np.count_nonzero(inner) < _FOLDS:
        return 1, np.zeros(0)
    fold = np.full(data.omega.size, -1)
    size = int(np.count_nonzero(inner))
    fold[inner] = np.random.default_rng(0).permutation(size) % _FOLDS
    squares = np.array([_held_out(data, int(count), fold) for count in counts])
    means = squares.mean(axis=1)
    worse = squares - squares[int(np.argmin(means))]
    error = worse.std(axis=1, ddof=1) / np.sqrt(_FOLDS)
    return int(counts[np.flatnonzero(worse.mean(axis=1) <= error)[0]]), means


def _held_out(data: Reduced, count: int, fold: NDArray[np.int64]) -> Array:
    """Mean square (folds,) of what a fit without it leaves of each fold."""
    times = relaxation_times(data.omega, count)
    out = []
    for k in range(_FOLDS):
        moduli, _ = non_negative(data.at(fold != k), times)
        rest = data.at(fold == k)
        out.append(float(np.mean((rest.design(times) @ moduli - rest.target) ** 2)))
    return np.array(out)
