"""Numpy-style docstrings, as rollnip writes them, to reStructuredText.

A section is a heading with a rule of dashes. In Parameters, Attributes, Returns, Yields and Raises
each entry is `names : text` (the text may go on, indented); other sections are paragraphs. Types
stand in the signature; what follows the colon is prose, so no cross-references are guessed from it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

SECTIONS = ("Parameters", "Attributes", "Returns", "Yields", "Raises", "References", "Notes")
LISTED = ("Parameters", "Attributes", "Raises")
_ENTRY = re.compile(r"^(?P<names>[A-Za-z_][\w ,.]*?)\s*:(?:\s+(?P<text>.*))?$")
_CODE = re.compile(r"(``.*?``|`[^`]*`)", re.DOTALL)
_SPECIAL = re.compile(r"([|*\\])|(?<=\w)(_)(?=\W|$)")


def escape(line: str) -> str:
    """Keep |x|, a * b and trailing underscores from being read as markup; leave code alone."""
    parts = _CODE.split(line)
    return "".join(
        part if i % 2 else _SPECIAL.sub(lambda found: "\\" + found[0], part)
        for i, part in enumerate(parts)
    )


def sections(lines: list[str]) -> Iterator[tuple[str, list[str]]]:
    """Yield (title, lines) of each section; what comes first has the title ""."""
    title, body = "", []
    i = 0
    while i < len(lines):
        rule = lines[i + 1].strip() if i + 1 < len(lines) else ""
        if lines[i].strip() in SECTIONS and rule and set(rule) == {"-"}:
            yield title, body
            title, body = lines[i].strip(), []
            i += 2
            continue
        body.append(lines[i])
        i += 1
    yield title, body


def entries(lines: list[str], *, raises: bool) -> Iterator[tuple[str, list[str]]]:
    """Yield (names, text lines) of each entry of a listed section."""
    names, text = "", []
    for line in lines:
        if not line.strip():
            continue
        found = _ENTRY.match(line)
        starts = not line.startswith(" ") and (found or (raises and " " not in line.strip()))
        if not starts:
            text.append(line.strip())
            continue
        if names or text:
            yield names, text
        names = found["names"] if found else line.strip()
        text = [found["text"]] if found and found["text"] else []
    if names or text:
        yield names, text


def converted(lines: list[str]) -> list[str]:
    """The docstring as reStructuredText."""
    out: list[str] = []
    for title, body in sections(lines):
        if not title:
            out += [escape(line) for line in body]
            continue
        out += ["", f":{title}:"]
        if title in LISTED:
            for names, text in entries(body, raises=title == "Raises"):
                term = (
                    ", ".join(f"``{name.strip()}``" for name in names.split(",")) if names else ""
                )
                out += [f"   {term}"] if term else []
                out += [f"   {'   ' if term else ''}{escape(line)}" for line in text]
                out += [""]
        else:
            out += [f"   {escape(line)}" for line in body] + [""]
    return [*out, ""]


def process(_app: Any, _what: str, _name: str, _obj: Any, _options: Any, lines: list[str]) -> None:
    """Replace the lines of a docstring in place."""
    lines[:] = converted(lines)


_ALIAS = re.compile(r"TypeAliasForwardRef\('(\w+)'\)")
_NDARRAY = re.compile(r"(?:numpy\.)?ndarray\[tuple\[Any, \.\.\.\], (?:numpy\.)?dtype\[(\w+)\]\]")


def readable(text: str | None) -> str | None:
    """A signature with arrays as they are written in the source."""
    return text and _NDARRAY.sub(r"NDArray[\1]", _ALIAS.sub(r"\1", text))


def sign(
    _app: Any, _what: str, _name: str, _obj: Any, _options: Any, signature: str, returns: str
) -> tuple[str | None, str | None]:
    """Make a signature readable."""
    return readable(signature), readable(returns)


def setup(app: Any) -> dict[str, bool]:
    """Connect to autodoc."""
    app.connect("autodoc-process-docstring", process)
    app.connect("autodoc-process-signature", sign)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
