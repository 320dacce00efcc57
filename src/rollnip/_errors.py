"""The errors and warnings of rollnip: one small tree, one form of message.

A message names what is wrong, the rule, and the value that came:
"`thickness` must be positive and finite, got -1."
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import wraps
from inspect import Parameter, signature
from math import inf, nan
from typing import Any, TypeVar, get_args

T = TypeVar("T")
_FASTEST = 1e11  # mm/s; a third of the speed of light: beyond it a unit was mistaken
_LARGEST_FRICTION = 1e6  # no surfaces come near it; far beyond it numbers run over


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
        raise InvalidInputError(f"`{name}` must be positive and finite, got {shown(value)}.")
    return number


def require_not_negative(name: str, value: float) -> float:
    """Return ``value`` as a float, or raise InvalidInputError unless it is finite and >= 0."""
    number = _number(value)
    if not 0.0 <= number < inf:
        raise InvalidInputError(
            f"`{name}` must be zero or positive and finite, got {shown(value)}."
        )
    return number


def require_friction(name: str, value: float) -> float:
    """Return ``value`` as a float, or raise InvalidInputError unless 0 <= value <= 1e6."""
    number = require_not_negative(name, value)
    if number > _LARGEST_FRICTION:
        raise InvalidInputError(f"`{name}` must be at most 1e6 here, got {shown(value)}.")
    return number


def require_speed(name: str, value: float) -> float:
    """Return ``value`` as a float, or raise InvalidInputError unless 0 < value <= 1e11 mm/s."""
    number = require_positive(name, value)
    if number > _FASTEST:
        raise InvalidInputError(f"`{name}` must be at most 1e11 mm/s, got {shown(value)}.")
    return number


def require_finite(name: str, value: float) -> float:
    """Return ``value`` as a float, or raise InvalidInputError unless it is a finite number."""
    number = _number(value)
    if not abs(number) < inf:
        raise InvalidInputError(f"`{name}` must be a finite number, got {shown(value)}.")
    return number


def require_instance(name: str, value: object, kind: type, hint: str = "") -> None:
    """Raise InvalidInputError unless ``value`` is a ``kind``; ``hint`` ends the message."""
    if isinstance(value, kind):
        return
    wanted, got = (_with_article(one.__name__) for one in (kind, type(value)))
    if value is None:
        got = "None"
    raise InvalidInputError(f"`{name}` must be {wanted}, got {got}{hint}.")


def shown(value: object) -> str:
    """Write a value for a message; a text with the number to write instead, where it has one."""
    if not isinstance(value, str):
        return repr(value)
    from rollnip._units import Dimension, base_unit, parse_quantity  # it needs this module

    for dimension in get_args(Dimension):
        try:
            number = parse_quantity(value, dimension)
        except InvalidInputError:
            continue
        unit = base_unit(dimension)
        plain = f"a number in {unit}" if unit else "a plain number"
        return f"the text {value!r}; in Python give {plain}: {number!r}"
    return f"the text {value!r}; give a number"


def with_hints(**hints: str) -> Callable[[type[T]], type[T]]:
    """Let a class answer an unknown keyword with a sentence instead of a TypeError.

    So it answers a value without a keyword, where all have to have one.

    Parameters
    ----------
    hints :
        what to write instead, for keywords that are often tried; others are told the nearest
        known one.
    """

    def decorate(cls: type[T]) -> type[T]:
        build = cls.__init__
        parameters = tuple(signature(build).parameters.values())[1:]
        known = tuple(one.name for one in parameters)
        by_name_only = all(one.kind is Parameter.KEYWORD_ONLY for one in parameters)

        @wraps(build)
        def checked(self: T, /, *values: Any, **named: Any) -> None:
            for name in named:
                if name not in known:
                    raise InvalidInputError(_unknown(cls.__name__, name, known, hints))
            if values and by_name_only:
                raise InvalidInputError(_unnamed(cls.__name__, parameters, len(values)))
            build(self, *values, **named)

        cls.__init__ = checked  # type: ignore[method-assign, assignment]
        return cls

    return decorate


def _unknown(kind: str, name: str, known: Sequence[str], hints: Mapping[str, str]) -> str:
    from difflib import get_close_matches  # of no use until a name is misspelt

    near = get_close_matches(name, known, n=1, cutoff=0.5)
    hint = hints.get(name) or (
        f"did you mean `{near[0]}`?" if near else f"it has {', '.join(known)}."
    )
    return f"`{name}` must be a parameter of {kind}, and is none; {hint}"


def _unnamed(kind: str, parameters: Sequence[Parameter], count: int) -> str:
    needed = [one.name for one in parameters if one.default is Parameter.empty]
    written = ", ".join(f"{name}=..." for name in needed or [parameters[0].name])
    return (
        f"Values of {kind} must be given by name, as in {kind}({written}), "
        f"got {count} without a name."
    )


def _with_article(name: str) -> str:
    return f"{'an' if name[0] in 'aeiouAEIO' else 'a'} {name}"


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
