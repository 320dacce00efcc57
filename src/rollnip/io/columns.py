"""Tables of measurements and of cases: CSV or Excel, units in the column heads.

    # lines behind a hash are comments
    load [N/mm]; nip width [mm]
    1,5;         4,2

Columns are parted by semicolons, tabs or commas, the first of these that the head holds, or by what
a first line such as ``sep=;`` says; a decimal comma needs one of the first two. Text is in UTF-8,
UTF-16 or Windows-1252. In Excel the first sheet counts unless another is named.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from io import BytesIO
from itertools import compress
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError
from rollnip._extras import require_extra
from rollnip._files import reading
from rollnip._reading import UnreadableError, read_regular
from rollnip._units import Dimension, base_unit, parse_quantity
from rollnip.io.encodings import decoded
from rollnip.io.extents import BrokenWorkbookError, extents

Array = NDArray[np.float64]
Cell = str | float
_Line = tuple[int, list[Cell]]

LARGEST = 64 * 2**20  # bytes
MOST_CELLS = 2**22
_SPARSEST = 64  # cells of the rectangle for each that is filled
_SMALL = 2**16  # cells of a rectangle that may be as empty as it likes
EXCEL = (".xlsx", ".xls", ".xlsb", ".ods")
# #DIV/0!, #NAME?, #WERT!, #N/A and #NV alone in a cell: a value that is missing, and no comment.
_SPREADSHEET_ERROR = re.compile(r"\s*#(N/A|NV|[^\W\d_a-z][^\W_a-z/]*(/0)?[!?])\s*([;,\t]|$)")
# A first line that says to spreadsheets what parts the columns.
_DECLARED = re.compile(r"\s*sep=([;,\t])\s*")
_DATE = re.compile(r"\d{4}-\d\d-\d\d")
_DIGIT = re.compile(r"\d")


@dataclass(frozen=True, slots=True)
class TableColumns:
    """A table as read: texts and numbers, each column with a name and, maybe, a unit.

    Attributes
    ----------
    source : name of the file, for messages.
    names : names in the heads, without the unit.
    units : units in the heads, empty where there is none.
    rows : (n, len(names)) cells; an empty one is "".
    lines : (n,) line of the file, or row of the sheet, each row stands in.
    comments : (line, text) behind each hash, without it.
    decimal_comma : whether a comma in a number can only be a decimal one.
    is_workbook : whether the cells are those of a sheet.
    """

    source: str
    names: tuple[str, ...]
    units: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]
    lines: tuple[int, ...]
    comments: tuple[tuple[int, str], ...] = ()
    decimal_comma: bool = False
    is_workbook: bool = False

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
        name : name of the column.
        dimension : what its unit must be; without a unit in the head, cells are in base units
            or carry their own.

        Returns
        -------
        (n,) array, in mm, N/mm, N, MPa, mm/s, s, degC, Hz, rad or 1.

        Raises
        ------
        InvalidInputError
            naming file, line and column: no such column, a unit of another kind, a cell that is
            empty or no number.
        """
        self._scale(name, dimension)
        values = [
            self._number(cell, line, name, dimension)
            for cell, line in zip(self.cells(name), self.lines, strict=True)
        ]
        return np.array(values, dtype=float)

    def samples(self, name: str, dimension: Dimension) -> Array:
        """Return a column as `numbers` does, ten times as fast, for many readings.

        All plain numbers are converted at once, which rounds each a second time.
        """
        scale, offset = self._scale(name, dimension)
        try:
            plain = np.array([_plain(cell) for cell in self.cells(name)], dtype=float)
        except ValueError:
            return self.numbers(name, dimension)
        values = scale * plain + offset
        return values if np.all(np.isfinite(values)) else self.numbers(name, dimension)

    def require_unit(self, name: str, dimension: Dimension) -> None:
        """Raise InvalidInputError unless the head, or every cell, says its unit."""
        if self.unit(name) or not any(_is_plain(cell) for cell in self.cells(name)):
            return
        raise InvalidInputError(
            f'{self.source}: column "{name}" must say its unit, such as '
            f'"{name} [{base_unit(dimension)}]".'
        )

    @property
    def _of_empty(self) -> str:
        """Return a remark on cells that look filled but are empty; "" where it is no workbook."""
        if not self.is_workbook:
            return ""
        return " (merged cells hold their value in the first only; an error value counts as empty)"

    def _index(self, name: str) -> int:
        if name in self.names:
            return self.names.index(name)
        raise InvalidInputError(f'{self.source}: has no column "{name}"; {self._near(name)}')

    def _near(self, name: str) -> str:
        """Return what the table has in place of a column."""
        marks = tuple(f"{name} {mark}" for mark in "(/")
        other = next((one for one in self.names if one.startswith(marks)), None)
        if other is not None:
            return f'write the unit in square brackets: "{name} [...]" for "{other}".'
        near = get_close_matches(name, self.names, n=1)
        if near:
            return f'it has "{near[0]}": both names must be the same.'
        return f"has {', '.join(self.names)}."

    def _scale(self, name: str, dimension: Dimension) -> tuple[float, float]:
        """Scale and offset from the unit in the head to the base unit."""
        unit = self.unit(name)
        if not unit:
            return 1.0, 0.0
        try:
            one = parse_quantity(f"1 {unit}", dimension)
            offset = parse_quantity(f"0 {unit}", dimension)
            return one - offset, offset
        except InvalidInputError as problem:
            raise InvalidInputError(f'{self.source}: unit of column "{name}" {problem}') from None

    def _number(self, cell: Cell, line: int, name: str, dimension: Dimension) -> float:
        where = f'{self.source}, line {line}: "{name}"'
        if cell == "":
            raise InvalidInputError(f"{where} must not be empty{self._of_empty}.")
        self._require_digits(cell, where, name, dimension)
        written = f"{cell!r}" if isinstance(cell, float) else cell
        if self.decimal_comma and written.count(",") == 1 and "." not in written:
            written = written.replace(",", ".")
        unit = self.unit(name) or (base_unit(dimension) if _is_plain(cell) else "")
        try:
            return parse_quantity(f"{written} {unit}".rstrip(), dimension)
        except InvalidInputError as problem:
            raise InvalidInputError(f"{where} {problem}") from None

    def _require_digits(self, cell: Cell, where: str, name: str, dimension: Dimension) -> None:
        """Raise InvalidInputError where a cell is a date, or a text without digits."""
        text = str(cell)
        if _DATE.match(text):
            raise InvalidInputError(
                f'{where} must be a number, got the date "{text}"; give its cell the format of a '
                "number, and enter it again."
            )
        if _DIGIT.search(text):
            return
        hint = ""
        unit = text.strip("[]()")
        if _is_unit(unit, dimension):
            hint = f'; a unit belongs to the column name: "{name} [{unit}]"'
        raise InvalidInputError(f'{where} must be a number, got "{text}"{hint}.')


def _is_unit(text: str, dimension: Dimension) -> bool:
    try:
        parse_quantity(f"1 {text}", dimension)
    except InvalidInputError:
        return False
    return True


def read_columns(path: str | Path, *, sheet: str | None = None) -> TableColumns:
    """Read a table from a text file (CSV) or an Excel or OpenDocument sheet.

    Parameters
    ----------
    path :
        the file; .xlsx, .xls, .xlsb, .ods (with the extra ``rollnip[tables]``) or text.
    sheet :
        sheet of a workbook; the first by default.

    Raises
    ------
    InvalidInputError
        naming file and line: it cannot be read, is too large, has no rows, a head is empty or
        there twice, a row has too few or too many cells.
    """
    file = Path(path)
    reading(file)
    try:
        data = read_regular(file, LARGEST)
    except UnreadableError as error:
        raise InvalidInputError(f"{file}: {error}") from None
    if file.suffix.lower() in EXCEL:
        source, numbered = _sheet_rows(file, data, sheet)
        return _columns(source, numbered, is_workbook=True)
    if sheet is not None:
        raise InvalidInputError(f"{path}: is a text file and has no sheets; leave out `sheet`.")
    numbered, decimal_comma = _text_rows(file, data)
    return _columns(str(path), numbered, decimal_comma=decimal_comma)


def _text_rows(file: Path, data: bytes) -> tuple[list[_Line], bool]:
    """Lines parted into cells (a comment is one cell), and whether a comma is a decimal one."""
    text, _ = decoded(data, str(file))
    lines = [(number, line) for number, line in enumerate(text.splitlines(), 1) if line.strip()]
    declared = _DECLARED.fullmatch(lines[0][1]) if lines else None
    if declared is not None:
        lines = lines[1:]
    head = next((line for _, line in lines if not is_comment(line)), "")
    found = next((mark for mark in (";", "\t") if mark in head), ",")
    mark = found if declared is None else declared[1]
    if len(lines) + text.count(mark) > MOST_CELLS:
        raise InvalidInputError(f"{file}: must hold at most {MOST_CELLS:,} cells, it holds more.")
    parted: list[_Line] = [
        (number, [line] if is_comment(line) else _split(line, mark)) for number, line in lines
    ]
    return parted, mark != ","


def _split(line: str, mark: str) -> list[Cell]:
    return [cell.strip() for cell in next(csv.reader([line], delimiter=mark))]


def _sheet_rows(file: Path, data: bytes, sheet: str | None) -> tuple[str, list[_Line]]:
    """Return the name of the file, with that of its sheet if one of several, and its rows.

    Rows and columns without any value are left out.
    """
    require_extra("tables", f"{file}: reading a workbook", "save the sheet as CSV")
    from python_calamine import CalamineError, CalamineWorkbook

    check_extents(file, data)
    try:
        with CalamineWorkbook.from_filelike(BytesIO(data)) as book:
            name = _sheet_name(file, book.sheet_names, sheet)
            rows = book.get_sheet_by_name(name).to_python(skip_empty_area=False)
            several = len(book.sheet_names) > 1
    except (CalamineError, OSError) as problem:
        raise InvalidInputError(f"{file}: cannot be read as a workbook: {problem}.") from None
    filled = [any(cell != "" for cell in column) for column in zip(*rows, strict=True)]
    cells = [list(compress(map(cell_of, row), filled)) for row in rows]
    numbered = [(number, row) for number, row in enumerate(cells, 1) if any(c != "" for c in row)]
    return f'{file}, sheet "{name}"' if several else str(file), numbered


def check_extents(file: Path, data: bytes) -> None:
    """Raise InvalidInputError for a workbook whose rectangles of cells would be too large."""
    try:
        found = list(extents(data, file.suffix.lower()))
    except BrokenWorkbookError as error:
        raise InvalidInputError(f"{file}: cannot be read as a workbook: {error}.") from None
    for one in found:
        cells = one.rows * one.columns
        if cells > min(MOST_CELLS, _SMALL + _SPARSEST * one.filled):
            raise InvalidInputError(
                f"{file}: a sheet must hold at most {MOST_CELLS:,} cells, and not be nearly empty; "
                f"it has {one.filled:,} cells over {one.rows:,} rows and {one.columns:,} columns. "
                "Keep the table at the top left of a sheet of its own."
            )


def _sheet_name(file: Path, names: Sequence[str], wanted: str | None) -> str:
    if not names:
        raise InvalidInputError(f"{file}: has no sheets.")
    if wanted is not None and wanted not in names:
        raise InvalidInputError(f'{file}: has no sheet "{wanted}" (there: {", ".join(names)}).')
    return wanted or names[0]


def cell_of(value: object) -> Cell:
    """A value of a workbook as a number or a text without blanks around it."""
    if isinstance(value, bool):
        return str(value)
    if isinstance(value, int | float):
        return float(value)
    return str(value).strip()


def _columns(
    source: str,
    lines: Sequence[_Line],
    *,
    decimal_comma: bool = False,
    is_workbook: bool = False,
) -> TableColumns:
    comments = tuple(
        (number, " ".join(map(str, cells)).strip().lstrip("#").strip())
        for number, cells in lines
        if is_comment(cells[0])
    )
    numbered = [(number, cells) for number, cells in lines if not is_comment(cells[0])]
    if len(numbered) < 2:
        raise InvalidInputError(f"{source}: must hold a line of column names and rows below it.")
    heads = [str(head) for head in numbered[0][1]]
    while heads and not heads[-1]:
        heads.pop()
    names, units = zip(*(head_parts(head, source) for head in heads), strict=True)
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise InvalidInputError(f'{source}: column "{twice}" must not be there twice.')
    head = numbered[0][0]
    rows = [_row(source, line, cells, len(names), head) for line, cells in numbered[1:]]
    return TableColumns(
        source=source,
        names=names,
        units=units,
        rows=tuple(rows),
        lines=tuple(line for line, _ in numbered[1:]),
        comments=comments,
        decimal_comma=decimal_comma,
        is_workbook=is_workbook,
    )


def head_parts(head: str, source: str) -> tuple[str, str]:
    """Return name and unit of a head such as ``load [N/mm]``; without brackets the unit is empty.

    An index in brackets belongs to the name: ``upper.layers[0]``. Raises InvalidInputError with the
    ``source`` where the name is empty.
    """
    name, bracket, unit = head.rpartition("[")
    if not bracket or not unit.endswith("]") or unit[:-1].isdigit():
        name, unit = head, "]"
    name = name.strip()
    if not name:
        raise InvalidInputError(f"{source}: every column must have a name, one has none.")
    return name, unit[:-1].strip()


def _row(source: str, line: int, cells: list[Cell], count: int, head: int) -> tuple[Cell, ...]:
    while len(cells) > count and cells[-1] == "":
        cells = cells[:-1]
    if len(cells) != count:
        raise InvalidInputError(
            f"{source}, line {line}: must have {count} cells, has {len(cells)}; line {head} counts "
            "as the column names, so a title above them must begin with #."
        )
    return tuple(cells)


def is_comment(text: Cell) -> bool:
    """Return whether a line, or its first cell, is a comment and no error of a spreadsheet."""
    return str(text).lstrip().startswith("#") and not _SPREADSHEET_ERROR.match(str(text))


def _is_plain(cell: Cell) -> bool:
    """Return whether a cell holds no unit."""
    return not any(
        (letter.isalpha() and letter not in "eE") or letter in "%°" for letter in str(cell)
    )


def _plain(cell: Cell) -> float:
    """A cell that is a number; raises ValueError where only a closer look can say so."""
    if isinstance(cell, str) and "_" in cell:
        raise ValueError(cell)
    return float(cell)
