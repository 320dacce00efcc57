"""What is small, and error estimates from changes between mesh sizes (Richardson)."""

from __future__ import annotations

from itertools import pairwise
from math import inf

import numpy as np

from rollnip.contact.problem import Array

_SAFETY_FACTOR = 1.5  # on a second-order estimate from two meshes; first order is cautious enough
NEGLIGIBLE = 0.1
"""Share of the tolerance that counts as negligible.

Such changes of the lagged terms end an iteration, which reduces their remaining error at
least tenfold.
"""
ROUNDING = float(np.sqrt(np.finfo(float).eps))
"""Relative difference up to which two numbers that have been computed count as equal."""
LEAST_SIZE = 0.05
"""Least size that an error is relative to, over the largest that its figure may have.

A figure that is zero by symmetry has no relative error.
"""


def shown_order(counts: Array, steps: Array) -> Array:
    """Return the order of each error in 1/elements: second, or first if the meshes show that.

    They show it where the last change is larger than second order predicts from the one before, as
    where unlike surfaces stick up to an edge.

    Parameters
    ----------
    counts : (s,) elements of three meshes or more, coarsest first.
    steps : (s - 1, n) changes of the figures from mesh to mesh.
    """
    first, second, third = counts[-3:] ** -2.0
    predicted = np.abs(steps[-2]) * (second - third) / (first - second)
    return np.where(np.abs(steps[-1]) > (1.0 + ROUNDING) * predicted, 1.0, 2.0)


def errors_from_changes(counts: Array, values: Array, order: Array) -> Array:
    """Return the estimated errors of the figures on the finest mesh, (n,).

    Two meshes may agree by chance, so earlier changes count too, scaled down by second order.

    Parameters
    ----------
    counts : (s,) elements of two meshes or more, coarsest first.
    values : (s, n) figures on them.
    order : (n,) order of the errors, applied to the last change.
    """
    steps = np.abs(np.diff(values, axis=0))
    second = np.full(order.size, 2.0)
    error = steps[-1] * share_left(counts[-2:], order)
    for pair, step in zip(pairwise(counts[:-1]), steps[:-1], strict=True):
        earlier = step * share_left(np.array(pair), second) * (pair[1] / counts[-1]) ** 2
        error = np.maximum(error, earlier)
    return np.asarray(error)


def share_left(counts: Array, order: Array) -> Array:
    """Return the error on the finer of two meshes, divided by their difference; with safety."""
    safety = np.where(order > 1.0, _SAFETY_FACTOR, 1.0)
    return np.asarray(safety / ((counts[1] / counts[0]) ** order - 1.0))


def to_come_after(change: float, before: float) -> float:
    """Return the sum of all changes to come, as a geometric series from the last two.

    It is inf where that has no sum, and where there has been a single change: ``before`` is inf. A
    change that is rounding alone has none to come.
    """
    if change < ROUNDING and before < inf:
        return 0.0
    return change * change / (before - change) if change < before < inf else inf


def scale_of_creepage(creepage: float, slope: float) -> float:
    """Return |creepage|, or `LEAST_SIZE` of the slope of the gap at the edge if that is more."""
    return max(LEAST_SIZE * slope, abs(creepage))  # in this order: max(a, nan) is a
