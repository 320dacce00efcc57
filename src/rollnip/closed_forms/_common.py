"""Checks, shapes and a quadrature that the closed forms share."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rollnip._errors import InvalidInputError, require_finite, require_positive


def require_all_positive(values: Mapping[str, float]) -> None:
    """Raise InvalidInputError unless every value is positive and finite."""
    for name, value in values.items():
        require_positive(name, value)


def require_poisson(name: str, value: float) -> None:
    """Raise InvalidInputError unless ``value`` lies in (-1, 0.5]."""
    require_finite(name, value)
    if not -1.0 < value <= 0.5:
        raise InvalidInputError(f"`{name}` must lie in (-1, 0.5], got {value!r}.")


def require_below_bound(traction: float, bound: float) -> None:
    """Raise InvalidInputError unless the magnitude of ``traction`` is below friction * load."""
    require_finite("traction", traction)
    if not abs(traction) < bound:
        raise InvalidInputError(
            f"`traction` must be smaller than friction * load = {bound:.6g} N/mm in size, "
            f"got {traction!r}."
        )


def parabola(x: ArrayLike, half_width: float) -> NDArray[np.float64]:
    """Return 1 - (x/half_width)^2 inside, 0 outside and for half_width 0."""
    place = np.asarray(x, dtype=np.float64)
    if half_width == 0.0:
        return np.zeros_like(place)
    ratio = place / half_width
    return np.maximum((1.0 - ratio) * (1.0 + ratio), 0.0)


def half_ellipse(x: ArrayLike, half_width: float) -> NDArray[np.float64]:
    """Return sqrt(1 - (x/half_width)^2) inside, 0 outside and for half_width 0."""
    return np.sqrt(parabola(x, half_width))


def graded_rule(
    levels: int = 24, order: int = 10
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return nodes and weights on [0, 1]: Gauss-Legendre on panels that halve towards 0.

    The rule integrates functions that are smooth except for a boundary layer at 0, of any width
    above 2^-levels.
    """
    ends = np.concatenate([[0.0], 0.5 ** np.arange(levels, -1, -1.0)])
    nodes, weights = np.polynomial.legendre.leggauss(order)
    half = 0.5 * np.diff(ends)[:, None]
    return (ends[:-1, None] + half * (1.0 + nodes)).ravel(), (half * weights).ravel()
