"""Checks of the arrays given to pictures of studies."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rollnip._errors import InvalidInputError

Array = NDArray[np.float64]


def finite_row(name: str, values: ArrayLike) -> Array:
    """Return values as a row, (n,). Raises InvalidInputError unless they are one, and finite."""
    array = np.asarray(values, dtype=float)
    if array.ndim != 1 or array.size == 0 or not np.isfinite(array).all():
        raise InvalidInputError(
            f"`{name}` must be a row of finite numbers, got shape {array.shape}"
            f"{' with some that are not' if array.size else ''}."
        )
    return array


def require_some(name: str, values: Any) -> None:
    """Raise InvalidInputError where there is not one value."""
    if not np.size(values):
        raise InvalidInputError(f"`{name}` must hold at least one finite number.")
