"""Tables of measurements and of cases: CSV or Excel, units in the column heads.

    # anything after a hash is a comment
    load [N/mm]; nip width [mm]
    1,5;         4,2

Columns are parted by semicolons, tabs or commas, the first of these that the head holds; a
decimal comma needs one of the first two. In Excel the first sheet counts unless another is named.
"""

from __future__ import annotations

import csv
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from io import StringIO
from math import isfinite
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError, RollnipError
from rollnip._units import Dimension, parse_quantity

Array = NDArray[np.float64]
Cell = str | float

LARGEST = 64 * 2**20  # bytes
EXCEL = (".xlsx", ".xls", ".xlsb", ".ods")


@dataclass(frozen=True, slots=True)
class Columns:
    """A table as read: texts and numbers, each column with a name and, maybe, a unit.

    Attributes
    ----------
    source : name of the file, for messages.
    names : as in the head, without the unit.
    units : as in the head, empty where there is none.
    rows : (n, len(names)) cells; an empty one is "".
    lines : (n,) line of the file, or row of the sheet, each row stands in.
    comments : lines behind a hash, without it.
    """

    source: str
    names: tuple[str, ...]
    units: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]
    lines: tuple[int, ...]
    comments: tuple[str, ...] = ()

    def cells(self, name: str) -> tuple[Cell, ...]:
        """The cells of one column. Raises InvalidInputError where there is no such column."""
        index = self._index(name)
        return tuple(row[index] for row in self.rows)

    def unit(self, name: str) -> str:
        """The unit in the head of one column. Raises InvalidInputError."""
        return self.units[self._index(name)]

    def numbers(self, name: str, dimension: Dimension) -> Array:
        """One column in base units.

        Parameters
        ----------
        name : of the column.
        dimension : what its unit must be; without a unit in the head, cells are in base units
            or carry their own.

        Returns
        -------
        (n,) array, in mm, N/mm, N, MPa, mm/s, s, degC, Hz or 1.

        Raises
        ------
        InvalidInputError
            naming file, line and column: no such column, a unit of another kind, a cell that is
            empty or no number.
        """
        unit = self.unit(name)
        self._check_unit(name, unit, dimension)
        values = [
            self._number(cell, line, name, unit, dimension)
            for cell, line in zip(self.cells(name), self.lines, strict=True)
        ]
        return np.array(values, dtype=float)

    def _index(self, name: str) -> int:
        if name in self.names:
            return self.names.index(name)
        near = get_close_matches(name, self.names, n=1)
        hint = f'did you mean "{near[0]}"?' if near else f"has {', '.join(self.names)}."
        raise InvalidInputError(f'{self.source}: has no column "{name}"; {hint}')

    def _check_unit(self, name: str, unit: str, dimension: Dimension) -> None:
        try:
            parse_quantity(f"1 {unit}" if unit else 1.0, dimension)
        except InvalidInputError as problem:
            raise InvalidInputError(f'{self.source}: unit of column "{name}" {problem}') from None

    def _number(self, cell: Cell, line: int, name: str, unit: str, dimension: Dimension) -> float:
        where = f'{self.source}, line {line}: "{name}"'
        if cell == "":
            raise InvalidInputError(f"{where} must not be empty.")
        written = f"{cell!r}" if isinstance(cell, float) else cell
        if unit:
            written = f"{written} {unit}"
        elif _is_plain(written):
            return _finite(written, where)
        try:
            return parse_quantity(written, dimension)
        except InvalidInputError as problem:
            raise InvalidInputError(f"{where} {problem}") from None


def read_columns(path: str | Path, *, sheet: str | None = None) -> Columns:
    """Read a table from a text file (CSV) or an Excel or OpenDocument sheet.

    Parameters
    ----------
    path :
        the file; .xlsx, .xls, .xlsb, .ods (with the extra ``rollnip[tables]``) or text.
    sheet :
        of a workbook; the first by default.

    Raises
    ------
    InvalidInputError
        naming file and line: it cannot be read, is too large, has no rows, a head is empty or
        there twice, a row has too few or too many cells.
    """
    file = Path(path)
    _check_size(file)
    comments: list[str] = []
    if file.suffix.lower() in EXCEL:
        numbered = _sheet_rows(file, sheet)
    else:
        if sheet is not None:
            raise InvalidInputError(f"{path}: is a text file and has no sheets; leave out `sheet`.")
        numbered, comments = _text_rows(file)
    return _columns(str(path), list(numbered), comments)


def _check_size(file: Path) -> None:
    try:
        size = file.stat().st_size
    except (OSError, ValueError) as problem:
        why = getattr(problem, "strerror", None) or problem
        raise InvalidInputError(f"{file}: cannot be read: {why}.") from None
    if file.is_dir():
        raise InvalidInputError(f"{file}: is a directory, not a table.")
    if size > LARGEST:
        raise InvalidInputError(f"{file}: must be at most {LARGEST >> 20} MiB large.")


def _text_rows(file: Path) -> tuple[Iterator[tuple[int, list[Cell]]], list[str]]:
    try:
        text = file.read_text("utf-8-sig")
    except OSError as problem:
        raise InvalidInputError(f"{file}: cannot be read: {problem.strerror}.") from None
    except UnicodeDecodeError:
        raise InvalidInputError(f"{file}: must be a text file in UTF-8.") from None
    comments, body = [], []
    for number, line in enumerate(text.splitlines(), start=1):
        if line.lstrip().startswith("#"):
            comments.append(line.lstrip().lstrip("#").strip())
        elif line.strip():
            body.append((number, line))
    head = body[0][1] if body else ""
    mark = next((mark for mark in (";", "\t") if mark in head), ",")
    return ((number, _split(line, mark)) for number, line in body), comments


def _split(line: str, mark: str) -> list[Cell]:
    return [cell.strip() for cell in next(csv.reader(StringIO(line), delimiter=mark))]


def _sheet_rows(file: Path, sheet: str | None) -> Iterator[tuple[int, list[Cell]]]:
    try:
        from python_calamine import CalamineError, CalamineWorkbook
    except ImportError:
        raise RollnipError(
            f'{file}: reading workbooks needs an extra; pip install "rollnip[tables]", or save '
            "the sheet as CSV."
        ) from None
    try:
        with CalamineWorkbook.from_path(str(file)) as book:
            name = _sheet_name(file, book.sheet_names, sheet)
            rows = book.get_sheet_by_name(name).to_python(skip_empty_area=False)
    except (CalamineError, OSError) as problem:
        raise InvalidInputError(f"{file}: cannot be read as a workbook: {problem}.") from None
    for number, row in enumerate(rows, start=1):
        cells = [_cell(value) for value in row]
        if any(cell != "" for cell in cells) and not str(cells[0]).startswith("#"):
            yield number, cells


def _sheet_name(file: Path, names: Sequence[str], wanted: str | None) -> str:
    if not names:
        raise InvalidInputError(f"{file}: has no sheets.")
    if wanted is not None and wanted not in names:
        raise InvalidInputError(f'{file}: has no sheet "{wanted}" (there: {", ".join(names)}).')
    return wanted or names[0]


def _cell(value: object) -> Cell:
    if isinstance(value, bool):
        return str(value)
    if isinstance(value, int | float):
        return float(value)
    return str(value).strip()


def _columns(
    source: str, numbered: list[tuple[int, list[Cell]]], comments: Sequence[str]
) -> Columns:
    if len(numbered) < 2:
        raise InvalidInputError(f"{source}: must hold a line of column names and rows below it.")
    heads = [str(head) for head in numbered[0][1]]
    while heads and not heads[-1]:
        heads.pop()
    names, units = zip(*(_head(head, source) for head in heads), strict=True)
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise InvalidInputError(f'{source}: column "{twice}" must not be there twice.')
    rows = [_row(source, line, cells, len(names)) for line, cells in numbered[1:]]
    lines = tuple(line for line, _ in numbered[1:])
    return Columns(source, names, units, tuple(rows), lines, tuple(comments))


def _head(head: str, source: str) -> tuple[str, str]:
    """Name and unit of ``load [N/mm]``; a path may itself hold an index in brackets."""
    name, bracket, unit = head.rpartition("[")
    if not bracket or not unit.endswith("]") or unit[:-1].isdigit():
        name, unit = head, "]"
    name = name.strip()
    if not name:
        raise InvalidInputError(f"{source}: every column must have a name, one has none.")
    return name, unit[:-1].strip()


def _row(source: str, line: int, cells: list[Cell], count: int) -> tuple[Cell, ...]:
    while len(cells) > count and cells[-1] == "":
        cells = cells[:-1]
    if len(cells) != count:
        raise InvalidInputError(
            f"{source}, line {line}: must have {count} cells, has {len(cells)}."
        )
    return tuple(cells)


def _is_plain(text: str) -> bool:
    return not any(letter.isalpha() and letter not in "eE" for letter in text) and "%" not in text


def _finite(text: str, where: str) -> float:
    try:
        value = float(text.replace(",", ".") if text.count(",") == 1 and "." not in text else text)
    except ValueError:
        value = float("nan")
    if not isfinite(value):
        raise InvalidInputError(f'{where} must be a finite number, got "{text[:60]}".')
    return value
