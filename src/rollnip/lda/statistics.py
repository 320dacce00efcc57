"""Velocity and strain with confidence bands from the bursts at each position."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy  # its parts are imported where they are first used
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError, require_positive

Array = NDArray[np.float64]

_SAME_PLACE = 1e-6  # mm
_OUTLIER = 4.5  # robust standard deviations; 7 in a million normal values lie beyond
_MAD = 1.482602218505602  # standard deviation over median absolute deviation of normal values
LEAST = 5  # bursts at a position; the variance of their mean is finite from 4 on


@dataclass(frozen=True, slots=True)
class VelocityProfile:
    """Mean velocity at each position.

    Attributes
    ----------
    x : (m,) increasing [mm].
    velocity : (m,) in the direction of motion [mm/s], corrected for the velocity bias.
    error : (m,) its standard error [mm/s].
    count : (m,) number of bursts kept; 0 where the error was given.
    rejected : (m,) number of outliers left out.
    confidence : confidence level of the bands, in (0, 1).
    speed : circumferential speed of the roller [mm/s]; None where it is not known.
    """

    x: Array
    velocity: Array
    error: Array
    count: NDArray[np.int64]
    rejected: NDArray[np.int64]
    confidence: float
    speed: float | None = None

    @property
    def strain(self) -> Array | None:
        """v/V - 1, (m,); None without the roller's speed. It holds in steady rolling only."""
        return None if self.speed is None else self.velocity / self.speed - 1.0

    @property
    def band(self) -> Array:
        """Half-width of the confidence interval at each single position, (m,) [mm/s]."""
        return self.error * self._quantile(self.confidence)

    @property
    def joint_band(self) -> Array:
        """Half-width of the band that holds at all positions jointly, (m,) [mm/s].

        Sidak: each interval has the confidence to the power 1/m; positions are independent.
        """
        return self.error * self._quantile(self.confidence ** (1.0 / self.x.size))

    @property
    def variance(self) -> Array:
        """Variance of the estimated mean by the distribution of t, (m,) [mm2/s2].

        n bursts give error^2 (n - 1)/(n - 3).
        """
        n = np.where(self.count > 0, self.count, 10**9)
        return np.asarray(self.error**2 * (n - 1.0) / (n - 3.0))

    def at(self, chosen: NDArray[np.bool_]) -> VelocityProfile:
        """Return the profile at the positions where ``chosen`` (m,) is true."""
        names = ("x", "velocity", "error", "count", "rejected")
        return replace(self, **{name: getattr(self, name)[chosen] for name in names})

    def _quantile(self, confidence: float) -> Array:
        tail = 0.5 * (1.0 + confidence)
        degrees = np.maximum(self.count - 1, 1)
        return np.asarray(
            np.where(self.count > 0, scipy.stats.t.ppf(tail, degrees), scipy.stats.norm.ppf(tail))
        )


def estimate_profile(
    x: Array,
    velocity: Array,
    *,
    weight: Array | None = None,
    speed: float | None = None,
    confidence: float = 0.95,
    least: int = LEAST,
) -> VelocityProfile:
    """Return the velocity at each position from single bursts.

    Outliers are left out: values more than 4.5 robust standard deviations (of their position, or of
    most positions where that is larger) from the median of their position. The mean is weighted
    with the time that each scatterer stays in the volume. Fast ones arrive more often, in
    proportion to their speed, so that the plain mean would be too high by the variance over the
    mean.

    Parameters
    ----------
    x : (n,) position of each burst [mm].
    velocity : (n,) [mm/s].
    weight : (n,) stay in the volume [s]; None: 1/velocity, as every scatterer crosses the whole
        volume.
    speed : circumferential speed of the roller [mm/s].
    confidence : confidence level of the bands.
    least : smallest number of bursts at each position, 5 or more.

    Raises
    ------
    InvalidInputError
        where values are missing or not finite, or a position has too few bursts.
    """
    _check(x, velocity, confidence)
    if speed is not None:
        require_positive("speed", speed)
    if least < LEAST:
        raise InvalidInputError(f"`least` must be {LEAST} or more, got {least}.")
    if weight is None:
        if np.any(velocity == 0.0):
            raise InvalidInputError("`velocity` must not be zero: such a scatterer never leaves.")
        weight = 1.0 / np.abs(velocity)
    elif weight.shape != x.shape or not np.all((weight > 0.0) & np.isfinite(weight)):
        raise InvalidInputError("`weight` must be positive and finite, one for each burst.")
    order = np.argsort(x, kind="stable")
    x, velocity, weight = x[order], velocity[order], weight[order]
    starts = np.flatnonzero(np.diff(x, prepend=-np.inf) > _SAME_PLACE)
    parts = [slice(*ends) for ends in zip(starts, [*starts[1:], x.size], strict=True)]
    common = float(np.median([_scale(velocity[part]) for part in parts]))
    rows = []
    for part in parts:
        v, w = velocity[part], weight[part]
        kept = _kept(v, common)
        if np.count_nonzero(kept) < least:
            raise InvalidInputError(
                f"`x` must have at least {least} valid bursts at each position, got "
                f"{np.count_nonzero(kept)} at {x[part.start]:.6g} mm; measure longer, or give "
                "means with their standard errors."
            )
        rows.append((x[part.start], *_mean(v[kept], w[kept]), kept.sum(), np.sum(~kept)))
    place, mean, error, count, rejected = np.array(rows, dtype=float).T
    counts = (count.astype(np.int64), rejected.astype(np.int64))
    return VelocityProfile(place, mean, error, *counts, confidence, speed)


def profile_from_means(
    x: Array,
    velocity: Array,
    error: Array,
    *,
    speed: float | None = None,
    confidence: float = 0.95,
) -> VelocityProfile:
    """Return the profile of velocities whose standard errors [mm/s] are known.

    Raises InvalidInputError where a value is not finite, an error is not positive, or a position
    occurs twice.
    """
    _check(x, velocity, confidence)
    if speed is not None:
        require_positive("speed", speed)
    if error.shape != x.shape or not np.all((error > 0.0) & np.isfinite(error)):
        raise InvalidInputError("`error` must be positive and finite, one for each velocity.")
    order = np.argsort(x)
    if np.any(np.diff(x[order]) <= _SAME_PLACE):
        raise InvalidInputError("`x` must not hold a position twice where errors are given.")
    none = np.zeros(x.size, dtype=np.int64)
    return VelocityProfile(x[order], velocity[order], error[order], none, none, confidence, speed)


def _check(x: Array, velocity: Array, confidence: float) -> None:
    if x.ndim != 1 or x.size == 0 or x.shape != velocity.shape:
        raise InvalidInputError("`x` and `velocity` must be two lists of equal length, not empty.")
    for name, values in (("x", x), ("velocity", velocity)):
        if not np.all(np.isfinite(values)):
            raise InvalidInputError(f"`{name}` must be finite, without gaps.")
    if not 0.5 <= confidence < 1.0:
        raise InvalidInputError(f"`confidence` must lie in [0.5, 1), got {confidence!r}.")


def _scale(velocity: Array) -> float:
    """Return the robust standard deviation."""
    return _MAD * float(np.median(np.abs(velocity - np.median(velocity))))


def _kept(velocity: Array, common: float) -> NDArray[np.bool_]:
    """Return which values are kept; all are where half of them are equal at most positions.

    The scale of few values may come out far too small; that of most positions is its lower bound.
    """
    scale = max(_scale(velocity), common)
    away = np.abs(velocity - np.median(velocity))
    return np.asarray(away <= _OUTLIER * scale) if scale > 0.0 else np.ones(away.size, dtype=bool)


def _mean(velocity: Array, weight: Array) -> tuple[float, float]:
    """Return the weighted mean and its standard error."""
    total = float(np.sum(weight))
    mean = float(weight @ velocity) / total
    n = velocity.size
    spread = float(np.sum((weight * (velocity - mean)) ** 2)) * n / (n - 1)
    return mean, max(spread**0.5 / total, 1e-15 * abs(mean))
