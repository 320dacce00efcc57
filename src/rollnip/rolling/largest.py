"""The largest of some numbers, of which none may be lost."""

from __future__ import annotations

from math import isnan, nan


def largest(*values: float) -> float:
    """The largest value; nan where one of them is, which ``max`` would leave out.

    What is no number must not pass for a small error.
    """
    return nan if any(map(isnan, values)) else max(values)
