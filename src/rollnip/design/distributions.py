"""Distributions of parameters, and Latin hypercube samples of them, with or without correlation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy  # its parts are imported where they are first used
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError
from rollnip._units import Dimension
from rollnip.design.quantities import read_parameter

Array = NDArray[np.float64]
Number = float | str

_LEAST_SHARE = 1e-6  # smallest probability between the ends of a truncated distribution
_EDGE = 1e-12  # smallest distance of a sampled probability from 0 and 1


@dataclass(frozen=True, slots=True)
class Normal:
    """A normal distribution: numbers in base units, or texts with their unit.

    With ``low`` or ``high`` it is truncated there; mean and deviation are those before truncation.
    """

    mean: Number
    deviation: Number
    low: Number | None = None
    high: Number | None = None


@dataclass(frozen=True, slots=True)
class Uniform:
    """A uniform distribution over an interval: numbers in base units, or texts with their unit."""

    low: Number
    high: Number


@dataclass(frozen=True, slots=True)
class Triangular:
    """A triangular distribution: numbers in base units, or texts with their unit."""

    low: Number
    mode: Number
    high: Number


@dataclass(frozen=True, slots=True)
class LogNormal:
    """A log-normal distribution: its median, and the standard deviation of the natural logarithm.

    With ``low`` or ``high`` it is truncated there, as for `Normal`.
    """

    median: Number
    spread: Number
    low: Number | None = None
    high: Number | None = None


Distribution = Normal | Uniform | Triangular | LogNormal


@dataclass(frozen=True, slots=True)
class Varied:
    """A parameter, by its path in the case, and its distribution."""

    path: str
    distribution: Distribution


@dataclass(frozen=True, slots=True)
class Correlation:
    """The correlation of the normal scores of two parameters.

    For two normal distributions it is that of the parameters themselves.
    """

    one: str
    other: str
    coefficient: float

    def __post_init__(self) -> None:
        if not -1.0 < self.coefficient < 1.0:
            raise InvalidInputError(
                f"`coefficient` must lie between -1 and 1, got {self.coefficient!r}."
            )
        if self.one == self.other:
            raise InvalidInputError(f"`between` must name two parameters, got {self.one} twice.")


def frozen(distribution: Distribution, dimension: Dimension) -> Any:
    """Return the distribution as a frozen distribution of scipy, in base units.

    Raises
    ------
    InvalidInputError
        for a value that cannot be read, a deviation that is not positive, or limits in the wrong
        order.
    """
    match distribution:
        case Normal(mean, deviation, low, high):
            kind: Dimension = "temperature difference" if dimension == "temperature" else dimension
            whole = scipy.stats.norm(
                read_parameter("mean", mean, dimension), _positive("deviation", deviation, kind)
            )
            return _cut(whole, dimension, low, high)
        case Uniform(low, high):
            a, b = _ordered(dimension, low=low, high=high)
            return scipy.stats.uniform(a, b - a)
        case Triangular(low, mode, high):
            a, b = _ordered(dimension, low=low, high=high)
            c = read_parameter("mode", mode, dimension)
            if not a <= c <= b:
                raise InvalidInputError(f"`mode` must lie between low and high, got {mode!r}.")
            return scipy.stats.triang((c - a) / (b - a), a, b - a)
        case LogNormal(median, spread, low, high):
            whole = scipy.stats.lognorm(
                _positive("spread", spread, "ratio"), scale=_positive("median", median, dimension)
            )
            return _cut(whole, dimension, low, high)


class Truncated:
    """A distribution truncated at both ends.

    Parameters
    ----------
    whole : distribution of scipy.
    low, high : the ends.

    Raises
    ------
    InvalidInputError
        where almost nothing of it lies between them.
    """

    def __init__(self, whole: Any, low: float, high: float) -> None:
        self.whole, self.low, self.high = whole, low, high
        self._below = float(whole.cdf(low))
        self._share = float(whole.cdf(high)) - self._below
        if self._share < _LEAST_SHARE:
            raise InvalidInputError(
                f"`low` and `high` must leave more than {_LEAST_SHARE:g} of the distribution, "
                f"they leave {max(self._share, 0.0):.1g}."
            )

    def ppf(self, probability: Any) -> Any:
        """Return the quantiles of the truncated distribution at given probabilities."""
        found = self.whole.ppf(self._below + np.asarray(probability) * self._share)
        return np.clip(found, self.low, self.high)


def _cut(whole: Any, dimension: Dimension, low: Number | None, high: Number | None) -> Any:
    """Return the distribution truncated at both ends, either of which may be missing."""
    if low is None and high is None:
        return whole
    a = -np.inf if low is None else read_parameter("low", low, dimension)
    b = np.inf if high is None else read_parameter("high", high, dimension)
    if not a < b:
        raise InvalidInputError(f"`low` must be below `high`, got {low!r} and {high!r}.")
    return Truncated(whole, a, b)


def hypercube(distributions: Sequence[Any], count: int, scores: Array | None, seed: int) -> Array:
    """Return a Latin hypercube sample.

    Parameters
    ----------
    distributions : (d,) distributions of scipy.
    count : n.
    scores :
        (d, d) correlations of the normal scores, positive definite; None: independent. The samples
        of each parameter remain one in each of n strata; only their pairing changes.
    seed : seed of the random numbers.

    Returns
    -------
    (n, d) array.

    References
    ----------
    McKay, Beckman & Conover (1979), Technometrics 21, 239-245; Iman & Conover (1982), Commun.
    Statist. B 11, 311-334.
    """
    generator = np.random.default_rng(seed)
    shares = scipy.stats.qmc.LatinHypercube(len(distributions), seed=generator).random(count)
    if scores is not None:
        wanted = scipy.stats.norm.ppf(shares) @ np.linalg.cholesky(scores).T
        ranks = np.argsort(np.argsort(wanted, axis=0), axis=0)
        shares = np.take_along_axis(np.sort(shares, axis=0), ranks, axis=0)
    return quantiles_at(distributions, shares)


def quantiles_at(distributions: Sequence[Any], shares: Array) -> Array:
    """Return the values (n, d) at which the distributions reach the given probabilities (n, d)."""
    inside = np.clip(shares, _EDGE, 1.0 - _EDGE)
    return np.column_stack([one.ppf(inside[:, i]) for i, one in enumerate(distributions)])


def score_matrix(paths: Sequence[str], correlations: Sequence[Correlation]) -> Array | None:
    """Return the (d, d) correlations of the normal scores; None without any.

    Raises
    ------
    InvalidInputError
        for a parameter that does not vary, a pair given twice, or correlations that are
        inconsistent with each other.
    """
    if not correlations:
        return None
    matrix = np.eye(len(paths))
    for one in correlations:
        for path in (one.one, one.other):
            if path not in paths:
                raise InvalidInputError(
                    f"`between` must name parameters that vary, got {path} (there: "
                    f"{', '.join(paths)})."
                )
        i, j = paths.index(one.one), paths.index(one.other)
        if matrix[i, j] != 0.0:
            raise InvalidInputError(f"`between` must not hold {one.one} and {one.other} twice.")
        matrix[i, j] = matrix[j, i] = one.coefficient
    if np.linalg.eigvalsh(matrix)[0] <= 1e-9:
        raise InvalidInputError(
            "`coefficient`: these correlations cannot hold together; make them weaker."
        )
    return matrix


def _positive(name: str, value: Number, dimension: Dimension) -> float:
    number = read_parameter(name, value, dimension)
    if not number > 0.0:
        raise InvalidInputError(f"`{name}` must be positive, got {value!r}.")
    return number


def _ordered(dimension: Dimension, *, low: Number, high: Number) -> tuple[float, float]:
    a, b = read_parameter("low", low, dimension), read_parameter("high", high, dimension)
    if not a < b:
        raise InvalidInputError(f"`low` must be below `high`, got {low!r} and {high!r}.")
    return a, b
