"""Unknowns of a fit: values of a case by path, within bounds."""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, log, sqrt

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError, require_finite, require_positive

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Prior:
    """Prior knowledge of an unknown, which counts as one more measurement of it.

    Parameters
    ----------
    value :
        in base units.
    standard_error :
        standard error of that value, in the same unit; positive.

    Raises
    ------
    InvalidInputError
        where either is out of range.
    """

    value: float
    standard_error: float

    def __post_init__(self) -> None:
        require_finite("prior.value", self.value)
        require_positive("prior.standard_error", self.standard_error)


@dataclass(frozen=True, slots=True, kw_only=True)
class Unknown:
    """A value of the case that the measurements are to determine.

    Parameters
    ----------
    path :
        its path in the case: ``materials.cover.modulus``, ``nip.friction``.
    low, high :
        bounds of the fit, in base units.
    start :
        first guess; the middle of the bounds by default, on a log scale the geometric mean.
    log :
        whether to search on a logarithmic scale. This suits positive values of which only the order
        of magnitude is known, such as a modulus or a relaxation time.
    prior :
        what else is known about it.

    Raises
    ------
    InvalidInputError
        where the bounds are not in order, the start lies outside them, or a log scale is wanted
        with a bound that is not positive.
    """

    path: str
    low: float
    high: float
    start: float | None = None
    log: bool = False
    prior: Prior | None = None

    def __post_init__(self) -> None:
        for name in ("low", "high"):
            require_finite(f"{self.path}: {name}", getattr(self, name))
        if not self.low < self.high:
            raise InvalidInputError(
                f"`{self.path}` must have a lower bound below the upper one, "
                f"got {self.low!r} and {self.high!r}."
            )
        if self.log and self.low <= 0.0:
            raise InvalidInputError(
                f"`{self.path}` must have positive bounds on a log scale, got {self.low!r}."
            )
        if self.start is not None:
            require_finite(f"{self.path}: start", self.start)
            if not self.low <= self.start <= self.high:
                raise InvalidInputError(
                    f"`{self.path}` must start between {self.low!r} and {self.high!r}, "
                    f"got {self.start!r}."
                )

    @property
    def first(self) -> float:
        """The value at which the search begins."""
        if self.start is not None:
            return self.start
        return sqrt(self.low) * sqrt(self.high) if self.log else 0.5 * (self.low + self.high)

    def inner(self, value: float) -> float:
        """Return the coordinate of the search: the value or its logarithm."""
        return log(value) if self.log else value

    def outer(self, coordinate: float) -> float:
        """Return the value at a coordinate of the search, within the bounds despite rounding."""
        within = min(max(coordinate, self.inner(self.low)), self.inner(self.high))
        value = exp(within) if self.log else within
        return min(max(value, self.low), self.high)

    def slope(self, value: float) -> float:
        """Return the derivative of the value with respect to the coordinate of the search."""
        return value if self.log else 1.0


def inner_bounds(unknowns: tuple[Unknown, ...]) -> tuple[Array, Array]:
    """Return the bounds of the coordinates of the search, two arrays of shape (p,)."""
    low = np.array([one.inner(one.low) for one in unknowns])
    high = np.array([one.inner(one.high) for one in unknowns])
    return low, high


def outer_values(unknowns: tuple[Unknown, ...], coordinates: Array) -> dict[str, float]:
    """Return the values by path at coordinates of the search (p,)."""
    pairs = zip(unknowns, coordinates, strict=True)
    return {one.path: one.outer(float(coordinate)) for one, coordinate in pairs}
