"""Answers in the one form that errors have: a sentence, and the paths of the keys at fault."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import date, datetime, time
from math import isfinite
from typing import Any

from rollnip._errors import CaseFileError, InvalidInputError, RollnipError
from rollnip._json import json_bytes

_PATH = re.compile(r"(materials\..{1,80}?|[^\s:]{1,120}): (.*)", re.DOTALL)
_NAMED = re.compile(r"`([\w.]+)`")
SOURCE = "case"
_NIP_KEYS = {"geometry": "model.geometry", "profile": "upper.profile"} | {
    name: f"nip.{name}" for name in ("load", "approach", "traction", "creepage", "torque_lower")
}
"""Keys at fault where a nip is refused while it is solved, by the names in the errors."""


@dataclass(frozen=True, slots=True)
class Reply:
    """The reply of a worker: HTTP status, JSON body, hash of the case where there is one."""

    status: int
    body: bytes
    case: str | None = None


class RefusedError(Exception):
    """A request that is not answered as it wished: HTTP status, a sentence, the keys at fault."""

    def __init__(self, status: int, error: str, details: Sequence[tuple[str, str]] = ()) -> None:
        super().__init__(error)
        self.status = status
        self.body = json_bytes(error_tree(error, details))
        # A second is what the longest queue takes, more or less.
        self.headers = {"retry-after": "1"} if status == 429 else {}


def as_json(value: Any) -> Any:
    """A TOML tree as JSON holds it: dates and numbers without end become texts."""
    if isinstance(value, dict):
        return {name: as_json(part) for name, part in value.items()}
    if isinstance(value, list):
        return [as_json(part) for part in value]
    if isinstance(value, date | datetime | time):
        return value.isoformat()
    return str(value) if isinstance(value, float) and not isfinite(value) else value


def error_tree(error: str, details: Sequence[tuple[str, str]] = ()) -> dict[str, Any]:
    """The body of every refusal: {"error", "details": [{"path", "message"}]}."""
    lines = [{"path": path, "message": message} for path, message in details]
    return {"error": error, "details": lines}


def refusal(error: RollnipError) -> dict[str, Any]:
    """The body for an error of rollnip: each of its lines is a detail."""
    details = [_placed(line) for line in str(error).splitlines()]
    path, message = details[0]
    first = f"{path}: {message}" if path else message
    more = f" ({len(details) - 1} more below.)" if len(details) > 1 else ""
    return error_tree(first + more, details)


def at_its_key(error: InvalidInputError, path_of: Callable[[str], str]) -> CaseFileError:
    """Return an error of the solver as one of the case.

    Parameters
    ----------
    error :
        begins with the name of a value in backticks, or with none.
    path_of :
        path of the key in the case by that name, "" where there is none; a name with points is a
        path already.
    """
    named = _NAMED.match(str(error))
    name = named[1] if named else ""
    path = name if "." in name else path_of(name)
    return CaseFileError(f"{SOURCE}: {path}: {error}")


@contextmanager
def at_keys(places: Mapping[str, str] | None = None, otherwise: str = "nip") -> Iterator[None]:
    """Raise what the solver refuses within the block as an error of the case, at its key.

    ``places``: paths of keys by the names that errors begin with, those of a nip by default;
    ``otherwise``: of other errors.
    """
    keys = _NIP_KEYS if places is None else places
    try:
        yield
    except InvalidInputError as error:
        raise at_its_key(error, lambda name: keys.get(name, otherwise)) from None


def _placed(line: str) -> tuple[str, str]:
    """Path and message of a line "case: upper.radius: must be ..."."""
    line = line.removeprefix(f"{SOURCE}: ")
    match = _PATH.fullmatch(line)
    return (match[1], match[2]) if match else ("", line)
