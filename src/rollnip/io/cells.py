"""The bare cells of a text file or of all sheets of a workbook, before anything is understood.

Instruments write in many encodings and with any separator: UTF-8 or UTF-16 with a mark, or the
code page of western Windows; tabs, semicolons, commas or blanks; decimal points or commas.
"""

from __future__ import annotations

import csv
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path

from rollnip._errors import InvalidInputError
from rollnip._extras import require_extra
from rollnip._files import reading
from rollnip._reading import UnreadableError, read_regular
from rollnip.io.columns import EXCEL, LARGEST, MOST_CELLS, Cell, cell_of, check_extents
from rollnip.io.encodings import decoded

_NUMBER = r"[+\-\u2212]?(?:\d+[.,]?\d*|[.,]\d+)(?:[eE][+-]?\d+)?"
_NUMERIC = re.compile(_NUMBER)
_BLANKS = re.compile(r"\s+")
_WIDE = re.compile(r"\s{2,}")
_SEPARATORS = {"\t": "tab", ";": "semicolon", ",": "comma", " ": "blank"}


@dataclass(frozen=True, slots=True)
class CellSheet:
    """The cells of a text file or of one sheet.

    Attributes
    ----------
    name : name of the sheet; empty for a text file.
    rows : cells of each row that is not empty; texts without blanks around them, or numbers.
    lines : line of the file, or row of the sheet, of each.
    """

    name: str
    rows: tuple[tuple[Cell, ...], ...]
    lines: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Cells:
    """A file as rows of cells.

    Attributes
    ----------
    source : name of the file.
    sheets : sheets of a workbook; one for a text file.
    encoding, separator : in words; empty for a workbook.
    """

    source: str
    sheets: tuple[CellSheet, ...]
    encoding: str = ""
    separator: str = ""


def read_cells(path: str | Path) -> Cells:
    """Read the cells of a text file or workbook.

    Raises
    ------
    InvalidInputError
        where it cannot be read, is no regular file or too large, or is no text.
    """
    file = Path(path)
    if file.suffix.lower() in EXCEL:
        return Cells(str(path), tuple(_sheets(file, _bytes(file))))
    text, encoding = read_text(file)
    numbered = [(n, line) for n, line in enumerate(text.splitlines(), 1) if line.strip()]
    mark = _separator([line for _, line in numbered])
    if len(numbered) + text.count(mark) > MOST_CELLS:
        raise InvalidInputError(f"{path}: must hold at most {MOST_CELLS:,} cells, it holds more.")
    rows = _split([line for _, line in numbered], mark)
    sheet = CellSheet("", tuple(rows), tuple(n for n, _ in numbered))
    return Cells(str(path), (sheet,), encoding, _SEPARATORS[mark])


def read_text(path: str | Path) -> tuple[str, str]:
    """Read a text file in UTF-8, UTF-16 or Windows-1252: its text and the name of its encoding.

    Raises
    ------
    InvalidInputError
        where it cannot be read, is no regular file or too large, or is no text.
    """
    return decoded(_bytes(Path(path)), str(path))


def _bytes(file: Path) -> bytes:
    reading(file)
    try:
        return read_regular(file, LARGEST)
    except UnreadableError as error:
        raise InvalidInputError(f"{file}: {error}") from None


def _sheets(file: Path, data: bytes) -> Iterator[CellSheet]:
    require_extra("tables", f"{file}: reading a workbook", "save the sheet as CSV")
    from python_calamine import CalamineError, CalamineWorkbook

    check_extents(file, data)
    try:
        with CalamineWorkbook.from_filelike(BytesIO(data)) as book:
            for name in book.sheet_names:
                rows = book.get_sheet_by_name(name).to_python(skip_empty_area=False)
                filled = [
                    (number, tuple(cell_of(value) for value in row))
                    for number, row in enumerate(rows, start=1)
                    if any(value != "" for value in row)
                ]
                yield CellSheet(name, tuple(row for _, row in filled), tuple(n for n, _ in filled))
    except (CalamineError, OSError) as problem:
        raise InvalidInputError(f"{file}: cannot be read as a workbook: {problem}.") from None


def _separator(lines: Sequence[str]) -> str:
    """Return the separator of cells in most of the lines that hold numbers.

    Where no line does, as in a file of heads alone, that of the first line with a tab or semicolon.
    """
    found: Counter[str] = Counter()
    for line in lines:
        if len(_NUMERIC.findall(line)) < 2:
            continue
        if "\t" in line.strip():
            found["\t"] += 1
        elif ";" in line and "=" not in line:
            found[";"] += 1
        elif "," in line and not _is_blank_separated(line):
            found[","] += 1
        elif _is_blank_separated(line):
            found[" "] += 1
    if found:
        return found.most_common(1)[0][0]
    marks = (mark for line in lines for mark in "\t;" if mark in line.strip())
    return next(marks, ",")


def _is_blank_separated(line: str) -> bool:
    """Return whether blanks separate two numbers or more, and commas and points are not mixed."""
    parts = _BLANKS.split(line.strip())
    numbers = [part for part in parts if _NUMERIC.fullmatch(part) and not part.endswith(",")]
    return len(numbers) >= 2 and 2 * len(numbers) > len(parts) and not ("," in line and "." in line)


def _parted(line: str, mark: str) -> list[str]:
    try:
        return next(csv.reader([line], delimiter=mark))
    except csv.Error:  # a cell longer than any number or head
        return line.split(mark)


def _split(lines: Sequence[str], mark: str) -> list[tuple[Cell, ...]]:
    if mark != " ":
        return [tuple(cell.strip() for cell in _parted(line, mark)) for line in lines]
    narrow = [tuple(_BLANKS.split(line.strip())) for line in lines]
    counts = Counter(len(row) for row in narrow if len(_NUMERIC.findall(" ".join(row))) >= 2)
    width = counts.most_common(1)[0][0]
    # heads may hold blanks of their own; then more of them part the columns
    wide = [tuple(_WIDE.split(line.strip())) for line in lines]
    return [
        one if len(one) == width or len(other) != width else other
        for one, other in zip(narrow, wide, strict=True)
    ]
