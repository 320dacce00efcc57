"""Single values of a case by their path: ``nip.load``, ``upper.layers[0].thickness``.

The tree is that of a case file; a path is written as messages about the file write it.
"""

from __future__ import annotations

import re
import types
from collections.abc import Mapping, Sequence
from copy import deepcopy
from difflib import get_close_matches
from functools import cache, lru_cache
from typing import Annotated, Any, Union, get_args, get_origin

from pydantic import BaseModel

from rollnip._errors import InvalidInputError
from rollnip._units import Dimension
from rollnip.io.forms import Quantity
from rollnip.io.tables import MATERIALS, CaseTable
from rollnip.io.tables_patch import PatchCaseTable

_PART = re.compile(r"([A-Za-z_][A-Za-z0-9_-]*)((?:\[\d{1,4}\])*)")
_EITHER = (
    ("load", "approach"),
    ("traction", "creepage", "torque_lower"),
    ("lateral_traction", "lateral_creepage"),
)
_MODULI = ("modulus", "shear_modulus", "shore_a")


def value_at(tree: Mapping[str, Any], path: str) -> Any:
    """Return the value at ``path``, as the file holds it.

    Raises
    ------
    InvalidInputError
        where the path leads nowhere; the message names the nearest key.
    """
    here: Any = tree
    walked = ""
    for part in _parts(path):
        here = _step(here, part, path, walked)
        walked = _joined(walked, part)
    return here


def with_values(tree: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return a copy of the tree with other values at some paths.

    The last key of a path may be new; the tables above it must be there. Setting one of the keys
    of which [nip] takes one (load or approach; traction, creepage or torque_lower; in three
    dimensions lateral_traction or lateral_creepage)
    removes the others, and so with the modulus of an elastic material.

    Parameters
    ----------
    tree :
        a case; stays as it was.
    changes :
        value by path: numbers in base units (mm, N, MPa, s), or texts with their unit.

    Raises
    ------
    InvalidInputError
        where a path leads nowhere, or to no key that a case may hold, or where two exclude each
        other.
    """
    return deepcopy(with_shared(tree, changes))


def with_shared(tree: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return a read-only copy with other values that shares its unchanged parts with ``tree``."""
    out = dict(tree)
    for path, value in changes.items():
        dimension_at(out, path)
        *above, last = _parts(path)
        here: Any = out
        walked = ""
        for depth, part in enumerate(above):
            if depth == 0 and part in ("model", "solver"):
                out.setdefault(part, {})  # the two tables a file may leave out
            below = _step(here, part, path, walked)
            if isinstance(below, dict | list):
                below = here[part] = below.copy()
            here = below
            walked = _joined(walked, part)
        if isinstance(last, int):
            _step(here, last, path, walked)
        elif not isinstance(here, dict):
            raise _nowhere(path, f"{walked} is no table here")
        else:
            _drop_others(here, last, walked, changes)
        here[last] = value
    return out


def dimension_at(tree: Mapping[str, Any], path: str) -> Dimension | None:
    """Return the dimension of the quantity at ``path``; None for texts, tables and lists.

    Raises
    ------
    InvalidInputError
        where a case has no such key; the message names the nearest.
    """
    kind: Any = PatchCaseTable if "patch" in tree else CaseTable
    walked = ""
    for part in _parts(path):
        kind = _kind_below(kind, part, tree, path, walked)
        walked = _joined(walked, part)
    found = [mark for mark in _marks(kind) if isinstance(mark, Quantity)]
    return found[0].dimension if found else None


@lru_cache(maxsize=256)  # a sweep asks for the same few, case after case
def _parts(path: str) -> tuple[str | int, ...]:
    parts: list[str | int] = []
    for piece in path.strip().split("."):
        match = _PART.fullmatch(piece)
        if match is None:
            raise InvalidInputError(
                f'`path` must be written like nip.load or upper.layers[0].thickness, got "{path}".'
            )
        parts.append(match[1])
        parts.extend(int(index) for index in re.findall(r"\d+", match[2]))
    return tuple(parts)


def _joined(walked: str, part: str | int) -> str:
    if isinstance(part, int):
        return f"{walked}[{part}]"
    return f"{walked}.{part}" if walked else part


def _step(here: Any, part: str | int, path: str, walked: str) -> Any:
    if isinstance(part, int):
        if not isinstance(here, list):
            raise _nowhere(path, f"{walked} is no list here")
        if part >= len(here):
            counted = f"{len(here)} entries" if len(here) != 1 else "1 entry"
            raise _nowhere(path, f"{walked} has {counted}, counted from 0")
        return here[part]
    if isinstance(here, str) and walked.endswith(("material", "core")):
        raise _nowhere(path, f'{walked} is the name "{here}": say materials.{here}.{part}')
    if not isinstance(here, Mapping) or part not in here:
        known = list(here) if isinstance(here, Mapping) else []
        raise _nowhere(path, _unknown(part, known, walked))
    return here[part]


def _drop_others(table: dict[str, Any], name: str, walked: str, changes: Mapping[str, Any]) -> None:
    groups: tuple[tuple[str, ...], ...] = _EITHER if walked == "nip" else ()
    if "model" in table:
        groups = (_MODULI,)
    for group in groups:
        if name in group:
            for other in group:
                if other != name and _joined(walked, other) in changes:
                    raise InvalidInputError(
                        f"`{walked}.{name}` and `{walked}.{other}` exclude each other; "
                        "leave one out."
                    )
                table.pop(other, None)


def _kind_below(kind: Any, part: str | int, tree: Any, path: str, walked: str) -> Any:
    """Type of the key or entry ``part`` of a thing of type ``kind``."""
    options = _options(kind)
    if isinstance(part, int):
        entries = [get_args(option)[0] for option in options if get_origin(option) is list]
        if not entries:
            raise _nowhere(path, f"{walked} is no list")
        return entries[0]
    for option in options:
        if get_origin(option) is dict:
            return get_args(option)[1]
    tables = [o for o in options if isinstance(o, type) and issubclass(o, BaseModel)]
    if len(tables) > 1:
        tables = _chosen(tables, tree, walked, path)
    for table in tables:
        if part in table.model_fields:
            return _field(table, part)
    known = [name for table in tables for name in table.model_fields]
    raise _nowhere(path, _unknown(part, known, walked))


def _chosen(tables: Sequence[Any], tree: Any, walked: str, path: str) -> list[Any]:
    """The table that the ``model`` key chooses."""
    here = value_at(tree, walked)
    if isinstance(here, str):
        name = path.removeprefix(walked).lstrip(".")
        raise _nowhere(path, f'{walked} is the name "{here}": say materials.{here}.{name}')
    model = here.get("model") if isinstance(here, Mapping) else None
    if model in MATERIALS and MATERIALS[model] in tables:
        return [MATERIALS[model]]
    literal = [t for t in tables if model in get_args(t.model_fields["model"].annotation)]
    return literal or list(tables)


@cache  # as many as a case file has types
def _field(table: type[BaseModel], name: str) -> Any:
    """Type of a key of a table, with its annotations."""
    field = table.model_fields[name]
    return Annotated[(field.annotation, *field.metadata)] if field.metadata else field.annotation


@cache
def _options(kind: Any) -> tuple[Any, ...]:
    """The members of a union, without None and without annotations."""
    if get_origin(kind) is Annotated:
        return _options(get_args(kind)[0])
    if get_origin(kind) in (Union, types.UnionType):
        return tuple(o for member in get_args(kind) for o in _options(member))
    return () if kind is type(None) else (kind,)


@cache
def _marks(kind: Any) -> tuple[Any, ...]:
    """All annotations of a type and of the members of a union."""
    if get_origin(kind) is Annotated:
        inner, *marks = get_args(kind)
        return (*marks, *_marks(inner))
    if get_origin(kind) in (Union, types.UnionType):
        return tuple(mark for member in get_args(kind) for mark in _marks(member))
    return ()


def _unknown(part: str, known: Sequence[str], walked: str) -> str:
    near = get_close_matches(part, known, n=1, cutoff=0.6)
    where = walked or "a case"
    if near:
        return f'{where} has no "{part}"; did you mean "{near[0]}"?'
    return f'{where} has no "{part}" (there: {", ".join(known) or "nothing"})'


def _nowhere(path: str, why: str) -> InvalidInputError:
    end = "" if why.endswith((".", "?")) else "."
    return InvalidInputError(f"`{path}` is no path of this case: {why}{end}")
