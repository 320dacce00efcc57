"""Estimates of the scatter of measurements whose standard errors are not given."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError
from rollnip.identification.costs import Measurements
from rollnip.identification.loss import Loss
from rollnip.identification.search import Local

Array = NDArray[np.float64]

_MEDIAN = 0.6745  # median of the magnitudes of standard normal deviates
_GUESS = 0.02  # first guess of the errors, over the root mean square of the values


@dataclass(frozen=True, slots=True)
class Noise:
    """Standard errors used for each set.

    Attributes
    ----------
    errors : (n,) standard error of each value, for each set.
    estimated : whether they were estimated, for each set.
    degrees : degrees of freedom of the worst estimate; None where none was estimated.
    """

    errors: tuple[Array, ...]
    estimated: tuple[bool, ...]
    degrees: float | None = None


def first_noise(parts: Sequence[Measurements]) -> Noise:
    """Return the errors as given, and a guess where there are none."""
    errors = tuple(
        part.errors if part.errors is not None else np.full(part.values.size, _guess(part))
        for part in parts
    )
    return Noise(errors, tuple(part.errors is None for part in parts))


def estimated_noise(
    parts: Sequence[Measurements], noise: Noise, end: Local, loss: Loss = "squares"
) -> Noise:
    """Return errors from the residuals of each set, over its share of the degrees of freedom.

    Each set has one error for all its values. Of the p unknowns a set of n values takes the sum of
    its leverages. Its variance is therefore its sum of squares over n minus that sum, minus the
    number of parameters fitted within it (Foerstner 1979, variance components). With Huber's loss
    the median of the magnitudes of the residuals takes the place of their mean square. ``end``
    holds plain residuals, as `straightened` returns them.

    Raises
    ------
    InvalidInputError
        where a set has too few values to estimate its noise.
    """
    errors, degrees, first = list(noise.errors), [], 0
    projected = leverages(end.jacobian)
    for index, part in enumerate(parts):
        rows = slice(first, first + part.values.size)
        first = rows.stop
        if not noise.estimated[index]:
            continue
        free = part.values.size - part.nuisances - float(np.sum(projected[rows]))
        if free < 0.5:
            raise InvalidInputError(
                f"`standard_error` must be given for the {part.name}: {part.values.size} values "
                "are too few to estimate it from their scatter."
            )
        residuals = end.residuals[rows] * errors[index] / np.sqrt(part.weight)
        size = float(np.sqrt(np.sum(residuals**2) / free))
        if loss == "huber":  # the median is independent of how far off the farthest values are
            share = np.sqrt(part.values.size / free)
            size = float(np.median(np.abs(residuals))) / _MEDIAN * float(share)
        # exact data, as from a simulation without noise, still carry rounding
        least = 1e-12 * float(np.max(np.abs(part.values)) or 1.0)
        errors[index] = np.full(part.values.size, max(size, least))
        degrees.append(free)
    return Noise(tuple(errors), noise.estimated, min(degrees) if degrees else None)


def largest_change(old: Noise, new: Noise) -> float:
    """Return the largest relative change of the ratios of the errors of sets."""
    ratios = [float(b[0] / a[0]) for a, b in zip(old.errors, new.errors, strict=True)]
    return max(ratios) / min(ratios) - 1.0


def leverages(jacobian: Array) -> Array:
    """Return the diagonal of the projection onto the columns, leaving out those that vanish."""
    left, values, _ = np.linalg.svd(jacobian, full_matrices=False)
    kept = left[:, values > 1e-10 * max(float(values[0]), 1e-300)]
    return np.asarray(np.sum(kept**2, axis=1))


def _guess(part: Measurements) -> float:
    return _GUESS * float(np.sqrt(np.mean(part.values**2))) or 1.0
