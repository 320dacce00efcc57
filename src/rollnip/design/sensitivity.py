"""Sobol indices and regression: on which parameters a result depends. Arrays only, no nips."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy  # its parts are imported where they are first used
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError

Array = NDArray[np.float64]

_RESAMPLES = 400
_FEWEST, _MOST = 8, 2**16


@dataclass(frozen=True, slots=True, eq=False)
class SobolIndices:
    """Shares of the variance of one result, a value for each of d parameters.

    Attributes
    ----------
    first : (d,) share of each parameter alone.
    first_low, first_high : (d,) its confidence interval.
    total : (d,) share of each parameter with all its interactions.
    total_low, total_high : (d,) its confidence interval.
    """

    first: Array
    first_low: Array
    first_high: Array
    total: Array
    total_low: Array
    total_high: Array

    def first_of(self, index: int) -> tuple[float, float, float]:
        """Return the share of one parameter alone: value, low, high."""
        return (
            float(self.first[index]),
            float(self.first_low[index]),
            float(self.first_high[index]),
        )

    def total_of(self, index: int) -> tuple[float, float, float]:
        """Return the share of one parameter with its interactions: value, low, high."""
        return (
            float(self.total[index]),
            float(self.total_low[index]),
            float(self.total_high[index]),
        )


@dataclass(frozen=True, slots=True, eq=False)
class Regression:
    """A linear regression of results on parameters, both over their standard deviations.

    Attributes
    ----------
    coefficients : (d,) standardised: change of the result with the parameter.
    explained : share of the variance that it explains, R^2.
    """

    coefficients: Array
    explained: float


def require_sobol_count(count: int) -> None:
    """Raise InvalidInputError unless ``count`` is a power of two in its range."""
    if not (_FEWEST <= count <= _MOST and count & (count - 1) == 0):
        raise InvalidInputError(
            f"`sobol` must be a power of two from {_FEWEST} to {_MOST}, got {count}."
        )


def sobol_places(count: int, dimensions: int, seed: int) -> Array:
    """Return the places in the unit cube at which Sobol indices need the results.

    Parameters
    ----------
    count : n, a power of two.
    dimensions : d, number of parameters.
    seed : seed of the scrambling.

    Returns
    -------
    (n (d + 2), d) array: the samples A, B, and A with each column in turn replaced by that of B.

    References
    ----------
    Saltelli et al. (2010), Comput. Phys. Commun. 181, 259-270.
    """
    require_sobol_count(count)
    engine = scipy.stats.qmc.Sobol(2 * dimensions, seed=np.random.default_rng(seed))
    both = engine.random_base2(count.bit_length() - 1)
    a, b = both[:, :dimensions], both[:, dimensions:]
    mixed = []
    for column in range(dimensions):
        one = a.copy()
        one[:, column] = b[:, column]
        mixed.append(one)
    return np.concatenate([a, b, *mixed])


def sobol_shares(values: Array, count: int, *, confidence: float, seed: int) -> SobolIndices:
    """Return Sobol indices from the results at `sobol_places`, with bootstrap intervals.

    Parameters
    ----------
    values : (n (d + 2),) results, all finite.
    count : n.
    confidence : confidence level of the intervals, such as 0.95; percentiles of resampled indices.
    seed : seed of the resampling.
    """
    parts = values.reshape(-1, count)
    generator = np.random.default_rng(seed)
    drawn = [_indices(parts[:, generator.integers(0, count, count)]) for _ in range(_RESAMPLES)]
    first, total = _indices(parts)
    tails = [0.5 * (1.0 - confidence), 0.5 * (1.0 + confidence)]
    (first_low, total_low), (first_high, total_high) = np.quantile(np.array(drawn), tails, axis=0)
    return SobolIndices(first, first_low, first_high, total, total_low, total_high)


def regression(samples: Array, values: Array) -> Regression:
    """Return standardised regression coefficients.

    Parameters
    ----------
    samples : (n, d) parameters, each with some variance.
    values : (n,) results; without variance the coefficients are 0.
    """
    spread = values.std()
    if spread <= 1e-12 * max(float(np.max(np.abs(values))), 1e-300):
        return Regression(np.zeros(samples.shape[1]), 1.0)
    x = (samples - samples.mean(axis=0)) / samples.std(axis=0)
    y = (values - values.mean()) / spread
    coefficients = np.linalg.lstsq(x, y, rcond=None)[0]
    left = y - x @ coefficients
    return Regression(coefficients, float(1.0 - left @ left / (y @ y)))


def _indices(parts: Array) -> tuple[Array, Array]:
    """Return first-order and total Sobol indices, (d,) each, from the rows f_A, f_B, f_AB."""
    # duplicated, because scipy 1.17 cannot take a single result of a single parameter
    twice = np.stack([parts, parts], axis=1)
    found = scipy.stats.sobol_indices(
        func={"f_A": twice[0], "f_B": twice[1], "f_AB": twice[2:]}, n=parts.shape[1]
    )
    return found.first_order.reshape(2, -1)[0], found.total_order.reshape(2, -1)[0]
