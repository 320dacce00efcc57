"""Messages about the form of a case file: path of the key, rule, value."""

from __future__ import annotations

import re
from collections.abc import Container, Iterable, Mapping, Sequence
from difflib import get_close_matches
from typing import Any, NoReturn, TypeVar

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from rollnip._errors import CaseFileError
from rollnip.io.forms import FileTable
from rollnip.io.tables import TABLES, CaseTable

_CONTROLS = (("load", "approach"), ("traction", "creepage", "torque_lower"))
_NAMED = re.compile(r"`(\w+)([^`]*)` (.*)", re.DOTALL)
_INSTEAD = {
    "nip.friction": "; give a coefficient such as 0.5 (0: frictionless); only a sheet with "
    "`friction_upper` and `friction_lower` of its own does without"
}
_OTHER_NAMES = {
    "diameter": ("radius", ", half of it"),
    "hardness": ("shore_a", ""),
    "nu": ("poisson", ""),
    "mu": ("friction", ""),
}
"""Keys that are tried, the key that is meant, and what to write there."""
_MOST_ERRORS = 20
_ALIKE, _VERY_ALIKE = 0.66, 0.75  # share of letters that a misspelt key has right, `difflib`
T = TypeVar("T", bound=FileTable)
_WORDS = {
    "list_type": "a list",
    "string_type": "a text",
    "bool_type": "true or false",
    "int_type": "a whole number",
    "float_type": "a number",
}


def more_than_one(choices: Iterable[tuple[str, ...]], nip: Container[str]) -> list[str]:
    """Lines about choices of which [nip] holds more than one key; ``nip``: the keys given."""
    given = [(names, [name for name in names if name in nip]) for names in choices]
    return [
        f"nip: must hold only one of {', '.join(names)}, got {' and '.join(keys)}."
        for names, keys in given
        if len(keys) > 1
    ]


def wrong_controls(tree: Mapping[str, Any]) -> list[str]:
    """Lines about the keys of which [nip] takes exactly one; null in JSON is a key left out."""
    table = tree.get("nip")
    if not isinstance(table, dict):
        return []
    nip = [name for name, value in table.items() if value is not None]
    lines = more_than_one(_CONTROLS, nip)
    face = tree.get("face")
    named = [one for one in ("end_loads", "arms") if isinstance(face, dict) and one in face]
    ends = bool(named)
    if len(named) > 1:
        lines.append("face: must hold only one of end_loads, arms, got both.")
    if ends and ("load" in nip or "approach" in nip):
        lines.append(f"nip: must not hold load or approach beside face.{named[0]}.")
    if not ends and "load" not in nip and "approach" not in nip:
        lines.append("nip: must hold load or approach, got neither.")
    return lines


def checked_form(
    tree: Mapping[str, Any],
    source: str,
    root: type[T],
    tables: Mapping[str, type[FileTable]],
    also: Sequence[str] = (),
) -> T:
    """The tree of a file as its table, where its form is right.

    ``root`` is the table of the whole file, ``tables`` those below it by key, ``also`` what else
    is wrong. Raises CaseFileError as `refuse`.
    """
    try:
        table = root.model_validate(dict(tree))
    except ValidationError as error:
        lines = [form_error(details, tables, root) for details in error.errors()]
        refuse(source, [*lines, *also])
    if also:
        refuse(source, also)
    return table


def refuse(source: str, lines: Sequence[str]) -> NoReturn:
    """Raise CaseFileError, a line for each of the first errors, with the name of the file."""
    shown = [f"{source}: {line}" for line in lines[:_MOST_ERRORS]]
    if len(lines) > _MOST_ERRORS:
        shown.append(f"{source}: and {len(lines) - _MOST_ERRORS} more errors.")
    raise CaseFileError("\n".join(shown)) from None


def form_error(
    details: ErrorDetails,
    tables: Mapping[str, type[FileTable]] = TABLES,
    root: type[FileTable] = CaseTable,
) -> str:
    """One error of pydantic as a line of ours.

    ``root`` is the table of the whole file, ``tables`` those below it by key.
    """
    kind, context = details["type"], details.get("ctx", {})
    path, got = _path(details["loc"]), shown(details["input"])
    if kind == "missing":
        return f"{path}: is missing{_INSTEAD.get(path, '')}."
    if kind == "extra_forbidden":
        return f"{path}: is not a known key{_suggestion(details['loc'], tables, root)}"
    if kind == "quantity":
        return f"{path}: {details['msg']}"
    if kind == "model" and isinstance(details["input"], dict) and "model" in details["input"]:
        choices = details["msg"].partition(" one of ")[2].split(", ")
        return _unknown_model(path, details["input"]["model"], choices)
    if kind == "model":
        return f"{path}: {details['msg']}, got {got}."
    wanted = _WORDS.get(kind, context.get("expected", "a table"))
    return f"{path}: must be {wanted}, got {got}."


def _unknown_model(path: str, model: object, choices: Sequence[str]) -> str:
    near = get_close_matches(str(model), choices, n=1, cutoff=0.7)
    hint = f'; did you mean "{near[0]}"?' if near else "."
    return f"{path}.model: must be one of {', '.join(choices)}, got {shown(model)}{hint}"


def placed(path: str, message: str, elsewhere: Mapping[str, str] | None = None) -> str:
    """Return a constructor's message "`name` must ..., got ..." with the path of its key.

    ``elsewhere`` gives the whole path of names that do not stand at ``path``.
    """
    match = _NAMED.fullmatch(message)
    if match is None:
        return f"{path}: {message}"
    name, index, rest = match.groups()
    if name in (elsewhere or {}) or index.startswith(" "):
        return f"{(elsewhere or {}).get(name, path)}: {message}"
    # the terms of a Prony series are pairs in Python and tables in the file
    index = index.replace("][0]", "].modulus").replace("][1]", "].relaxation_time")
    return f"{path}.{name}{index}: {rest}"


def unknown_name(
    path: str, name: str, known: Sequence[str], where: str, *, instead: str = ""
) -> str:
    """Line about a name that is not among the known ones; ``instead``: what else to do."""
    near = get_close_matches(name, known, n=1, cutoff=0.5)
    there = f" (there: {', '.join(known) or 'none'}){instead}."
    hint = f'; did you mean "{near[0]}"?' if near else there
    return f"{path}: {shown(name)} is not in {where}{hint}"


def shown(value: object) -> str:
    """A value as it stands in a message: short, on one line."""
    text = f'"{value}"' if isinstance(value, str) and value.isprintable() else repr(value)
    return text if len(text) <= 60 else text[:60] + "..."


def _path(loc: Sequence[str | int]) -> str:
    path = ""
    for part in loc:
        if isinstance(part, int):
            path += f"[{part}]"
        elif part != "<name>" and not (part.startswith("<") and part in TABLES):
            key = part if part.isprintable() and len(part) <= 40 else repr(part[:40])
            path += f".{key}" if path else key
    return path or "case"


def _suggestion(
    loc: Sequence[str | int], tables: Mapping[str, type[FileTable]], root: type[FileTable]
) -> str:
    walked = [part for part in loc[:-1] if isinstance(part, str)]
    # The same key may name another table below another one: [sheet] and [heat.sheet].
    paths = [".".join(walked[max(i - 1, 0) : i + 1]) for i in range(len(walked))]
    found = [path if path in tables else part for path, part in zip(paths, walked, strict=True)]
    above = [tables[name] for name in found if name in tables]
    table = above[-1] if above else root
    names = list(table.model_fields)
    meant, how = _OTHER_NAMES.get(str(loc[-1]), ("", ""))
    if meant in names:
        return f'; give "{meant}"{how}.'
    if table is root:
        names = [*names, "patch"]  # a case is one of a patch by that table alone
    near = get_close_matches(str(loc[-1]), names, n=1, cutoff=_ALIKE)
    if near:
        return f'; did you mean "{near[0]}"?'
    return _in_another(str(loc[-1]), tables, root) or f" here (known: {', '.join(names)})."


def _in_another(key: str, tables: Mapping[str, type[FileTable]], root: type[FileTable]) -> str:
    """Say to which other table of the file an unknown key belongs or may belong; "" if to none."""
    owners = [name for name, other in tables.items() if key in other.model_fields]
    if len(owners) == 1 and owners[0] in root.model_fields:
        return f" here; it belongs to [{owners[0]}]."
    if owners:
        return ""
    known = {name: one.model_fields for name, one in tables.items() if name in root.model_fields}
    every = sorted({field for fields in known.values() for field in fields})
    near = get_close_matches(key, every, n=1, cutoff=_VERY_ALIKE)
    places = [f"[{name}]" for name, fields in known.items() if near and near[0] in fields]
    return f' here; did you mean "{near[0]}" in {" or ".join(places)}?' if near else ""
