"""The errors and warnings of rollnip: one small tree, one form of message.

A message names what is wrong, the rule, and the value that came:
"`thickness` must be positive and finite, got -1."
"""

from __future__ import annotations

from math import inf, nan
from typing import Any


class RollnipError(Exception):
    """Base of every error that rollnip raises on purpose."""


class InvalidInputError(RollnipError, ValueError):
    """A value that no solution can be computed for; the message names it, the rule, the value."""


class CaseFileError(RollnipError):
    """A case file that cannot be read or understood; the message carries the path of the key."""


class ConvergenceError(RollnipError):
    """A solution that could not be verified.

    Attributes
    ----------
    solution :
        the last solution reached (its ``converged`` is False), or None where there is none.
    """

    def __init__(self, message: str, solution: Any = None) -> None:
        super().__init__(message)
        self.solution = solution


class RollnipWarning(UserWarning):
    """A result that stands, with a reservation the user should know of."""


def require_positive(name: str, value: float) -> float:
    """Return ``value`` as a float, or raise InvalidInputError unless it is positive and finite."""
    number = _number(value)
    if not 0.0 < number < inf:
        raise InvalidInputError(f"`{name}` must be positive and finite, got {value!r}.")
    return number


def require_not_negative(name: str, value: float) -> float:
    """Return ``value`` as a float, or raise InvalidInputError unless it is finite and >= 0."""
    number = _number(value)
    if not 0.0 <= number < inf:
        raise InvalidInputError(f"`{name}` must be zero or positive and finite, got {value!r}.")
    return number


def require_finite(name: str, value: float) -> float:
    """Return ``value`` as a float, or raise InvalidInputError unless it is a finite number."""
    number = _number(value)
    if not abs(number) < inf:
        raise InvalidInputError(f"`{name}` must be a finite number, got {value!r}.")
    return number


def _number(value: object) -> float:
    """A real number as a float, whatever its type; nan for what is none."""
    # numpy says of what kind its numbers are: truth values and complex ones are none here.
    kind = getattr(getattr(value, "dtype", None), "kind", "f")
    if isinstance(value, str | bytes | bool) or kind not in "fiu":
        return nan
    try:
        return float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError):
        return nan
