"""Cubics through values at whole numbers, and what integrals of them take."""

from __future__ import annotations

from functools import lru_cache
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from rollnip.contact.problem import Array

Number = TypeVar("Number", np.float64, np.complex128)


@lru_cache(maxsize=8)
def gauss_points(count: int) -> tuple[Array, Array]:
    """Return the Gauss points on [-1, 1], and their weights."""
    points, weights = np.polynomial.legendre.leggauss(count)
    for array in (points, weights):
        array.setflags(write=False)
    return points, weights


def with_means(values: NDArray[Number], means: NDArray[Number]) -> NDArray[Number]:
    """Return ``values`` at finer nodes, adjusted to have given means between them.

    The first and the last stay as they are: nothing is smooth there.
    """
    lacking = means - 0.5 * (values[:-1] + values[1:])
    out = values.copy()
    out[1:-1] += 0.5 * (lacking[1:] + lacking[:-1])
    return out


def cubic_matrix(t: Array, count: int) -> Array:
    """Return the weights of values at 0 ... count - 1 in their cubics at ``t``, (*t, count).

    Each cubic (Lagrange) goes through the nearest four, two on either side where there are as many.
    """
    first = np.clip(np.floor(t).astype(int) - 1, 0, count - 4)
    s = t - first
    a, b, c = s - 1.0, s - 2.0, s - 3.0
    weights = np.stack(
        [-a * b * c / 6.0, s * b * c / 2.0, -s * a * c / 2.0, s * a * b / 6.0], axis=-1
    )
    out = np.zeros((*t.shape, count))
    np.put_along_axis(out, first[..., None] + np.arange(4), weights, axis=-1)
    return out
