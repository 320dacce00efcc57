"""The reader of TOML and JSON files into trees of plain values; every fault is one clear line."""

from __future__ import annotations

import json
import re
import sys
import tomllib
from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from rollnip._errors import CaseFileError, InvalidInputError
from rollnip._files import reading
from rollnip._reading import UnreadableError, read_regular

LARGEST = 1_000_000  # bytes; a case file has some thousand
_DEEPEST = 32  # dots in a key; a case file has three
_AT = re.compile(r"at line (\d+), column (\d+)")
_COMMA = re.compile(r"(?<==)\s*([+-]?\d+),(\d+)")
_NUMBER = re.compile(r"[=\[,]\s*([+-]?\d[\d.]*)\s*$")  # a value as far as it can be read
_UNIT = re.compile(r"[^\W\d]|[%°'\"]")
_WORD = re.compile(r"[^\W\d][\w-]*")
_SIGNS = re.compile(r"""(?<=[\w"'-])[ \t]*\.|[^.\w"' \t-]""")  # a dot in a key, or what ends keys


def read_document(path: str | Path, *, name: str = "path", hint: str = "") -> dict[str, Any]:
    """Read a TOML or JSON file; ``-`` is the standard input.

    Parameters
    ----------
    path : of the file.
    name : what the caller calls it, for messages.
    hint : what takes a tree, for which there is no file.

    Raises
    ------
    CaseFileError
        where it cannot be read, is too large, is no text, or its syntax is broken.
    InvalidInputError
        where ``path`` is no name of a file.
    """
    if not isinstance(path, str | PathLike):
        end = f"; {hint}" if hint and isinstance(path, Mapping) else ""
        raise InvalidInputError(
            f"`{name}` must be the name of a file, got {type(path).__name__}{end}."
        )
    file = str(path)
    reading(file)
    return parse_document(_text(_bytes(file), file), file)


def folder_of(path: str | Path) -> Path:
    """Return where the files that a file names are; those of the standard input, here."""
    return Path() if str(path) == "-" else Path(path).parent


def parse_document(text: str, name: str) -> dict[str, Any]:
    """Return the tree that a text in TOML or JSON holds.

    JSON is a text that opens with a brace, or one whose name ends in .json. Raises CaseFileError
    with that name where the text is neither, is nested too deeply, or holds no table.
    """
    is_json = name.lower().endswith(".json") or text.lstrip().startswith("{")
    if not is_json and _has_deep_key(text):
        raise CaseFileError(f"{name}: is nested too deeply for a case file.")
    try:
        tree = _json(text) if is_json else tomllib.loads(text)
    except RecursionError:
        raise CaseFileError(f"{name}: is nested too deeply for a case file.") from None
    except ValueError as error:
        kind = "JSON" if is_json else "TOML"
        hint = "" if is_json else _hint(text, str(error))
        raise CaseFileError(f"{name}: is not valid {kind}: {_one_line(error)}{hint}.") from None
    if not isinstance(tree, dict):
        raise CaseFileError(f"{name}: must hold a table (an object), got {type(tree).__name__}.")
    return tree


def tree_of(case: str | Mapping[str, Any], name: str) -> dict[str, Any]:
    """Return the tree of a case, which is that tree or a text for `parse_document`."""
    return parse_document(case, name) if isinstance(case, str) else plain_tree(case)


def plain_tree(tree: Mapping[str, Any]) -> dict[str, Any]:
    """Return a tree with plain numbers and lists in place of numpy's, as a file would hold them."""
    return {name: _plain(value) for name, value in tree.items()}


def _plain(value: Any) -> Any:
    if isinstance(value, np.generic | np.ndarray):
        return value.tolist()
    if isinstance(value, Mapping):
        return plain_tree(value)
    return [_plain(one) for one in value] if isinstance(value, list | tuple) else value


def _has_deep_key(text: str) -> bool:
    """Return whether a dotted key has too many parts: reading takes time with their square."""
    dots = 0
    for sign in _SIGNS.findall(text):
        dots = dots + 1 if sign.endswith(".") else 0
        if dots > _DEEPEST:
            return True
    return False


def _bytes(name: str) -> bytes:
    if name != "-":
        try:
            return read_regular(name, LARGEST)
        except UnreadableError as error:
            shown = name if name.isprintable() else repr(name)
            raise CaseFileError(f"{shown}: {error}") from None
    try:
        data = sys.stdin.buffer.read(LARGEST + 1)
    except OSError as error:
        raise CaseFileError(f"{name}: cannot be read: {error.strerror or error}.") from None
    if len(data) > LARGEST:
        raise CaseFileError(f"{name}: must be at most {LARGEST:,} bytes large, it is larger.")
    return data


def _text(data: bytes, name: str) -> str:
    if b"\0" in data:
        raise CaseFileError(f"{name}: is not a text file (it holds zero bytes).")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise CaseFileError(
            f"{name}: is not UTF-8 text (byte 0x{data[error.start]:02x} on line {line})."
        ) from None


def _json(text: str) -> Any:
    def table(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        tree: dict[str, Any] = {}
        for name, value in pairs:
            if name in tree:
                raise ValueError(f"the key {name!r} is given twice")
            tree[name] = value
        return tree

    return json.loads(text, object_pairs_hook=table)


def _hint(text: str, message: str) -> str:
    """Return what to write in place of what stands where a message about TOML points; or ""."""
    if message.startswith("Cannot declare"):
        return "; keep one of the two tables"
    if message.startswith("Cannot overwrite"):
        return "; a key is given twice: keep one of the two"
    place = _AT.search(message)
    lines = text.splitlines()
    if place is None or int(place[1]) > len(lines):
        return ""
    line = lines[int(place[1]) - 1]
    comma = _COMMA.search(line)
    if comma is not None:
        whole, part = comma.groups()
        return f'; write {whole}.{part}, or a text with its unit, such as "{whole},{part} mm"'
    column = int(place[2]) - 1
    return _quote_hint(line[:column], line[column:])


def _quote_hint(before: str, rest: str) -> str:
    """Return what to write for a quantity, or a name, without straight quotes."""
    number, word = _NUMBER.search(before), _WORD.match(rest)
    if number is not None and _UNIT.match(rest):
        unit = re.split(r"[,#\]}]", rest)[0].strip().replace('"', "in")
        return f'; write "{number[1]} {unit}", in quotes'
    if rest[:1] in {"\u201c", "\u201d", "\u201e", "\u2018", "\u2019"}:
        return '; write straight quotes (")'
    if word is None or not before.rstrip().endswith(("=", "[", ",")):
        return ""
    if word[0].lower() in {"true", "false"}:
        return f"; write {word[0].lower()}"
    return f'; write "{word[0]}", in quotes'


def _one_line(error: ValueError) -> str:
    text = " ".join(str(error).split()).rstrip(".")
    return text if len(text) <= 200 else text[:200] + "..."
