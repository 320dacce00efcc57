"""The largest of some numbers, nan included."""

from __future__ import annotations

from math import isnan, nan


def largest(*values: float) -> float:
    """Return the largest value, or nan where one value is nan, which ``max`` would leave out.

    A nan must not pass for a small error.
    """
    return nan if any(map(isnan, values)) else max(values)
