"""The errors and warnings of rollnip: one small tree, one form of message.

A message names what is wrong, the rule, and the value that came:
"`thickness` must be positive and finite, got -1."
"""

from __future__ import annotations

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


def require_positive(name: str, value: float) -> None:
    """Raise InvalidInputError unless ``value`` is a positive, finite number."""
    if not _is_number(value) or not 0.0 < value < float("inf"):
        raise InvalidInputError(f"`{name}` must be positive and finite, got {value!r}.")


def require_not_negative(name: str, value: float) -> None:
    """Raise InvalidInputError unless ``value`` is a finite number >= 0."""
    if not _is_number(value) or not 0.0 <= value < float("inf"):
        raise InvalidInputError(f"`{name}` must be zero or positive and finite, got {value!r}.")


def require_finite(name: str, value: float) -> None:
    """Raise InvalidInputError unless ``value`` is a finite number."""
    if not _is_number(value) or not abs(value) < float("inf"):
        raise InvalidInputError(f"`{name}` must be a finite number, got {value!r}.")


def _is_number(value: object) -> bool:
    try:
        float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError):
        return False
    return not isinstance(value, str | bool)
