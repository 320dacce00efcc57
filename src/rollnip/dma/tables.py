"""The tables of measurements in the cells of a file: where each begins, and its columns."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError
from rollnip.dma.heads import Head, bare_unit, is_unit, read_head
from rollnip.io.cells import Cells, CellSheet
from rollnip.io.columns import Cell

Array = NDArray[np.float64]

_LEAST_HEADS = 2  # recognised heads that make a row the heads of a table
_STEP = re.compile(r"\[\s*step\s*\]", re.IGNORECASE)
_DEGREES = re.compile(r"([+\-\u2212]?\d+(?:[.,]\d+)?)\s*(?:°|º|deg\.?\s?)\s?C\b(?!\s*/)")
_KEYED = re.compile(r"(?:^|[;,\s])T\s*=\s*([+\-\u2212]?\d+(?:[.,]\d+)?)\s*(?:[;,]|$)")
_HERTZ = re.compile(r"(?:^|[^\d.,])(\d+(?:[.,]\d+)?)\s*Hz\b")
_NUMBER = re.compile(r"[+-]?(?:\d+[.,]?\d*|[.,]\d+)(?:[eE][+-]?\d+)?")
_MISSING = {"", "-", "--", "---", "n/a", "n. a.", "nan", "#n/a", "none", "null", "*", "n.a."}
_POSITIONS = {  # columns and units of RepTate's files, which may have no heads
    ".osc": (("w", "rad/s"), ("G'", "Pa"), ("G''", "Pa")),
    ".tts": (("w", "rad/s"), ("G'", "Pa"), ("G''", "Pa")),
    ".gt": (("t", "s"), ("G(t)", "Pa")),
}


@dataclass(slots=True)
class RawTable:
    """A table as it stands in the file.

    Attributes
    ----------
    name : name of the sheet or step, empty where it has none.
    line : line of its heads.
    heads : heads of all columns.
    rows : cells of each row of numbers.
    lines : line of each row.
    temperature, frequency : (value [degC, Hz], line) stated above the table; None where not stated.
    """

    name: str
    line: int
    heads: tuple[Head, ...]
    temperature: tuple[float, int] | None = None
    frequency: tuple[float, int] | None = None
    rows: list[tuple[Cell, ...]] = field(default_factory=list)
    lines: list[int] = field(default_factory=list)


def find_tables(cells: Cells, suffix: str) -> tuple[list[RawTable], list[int]]:
    """Return the tables of a file, and the lines that belong to none."""
    tables: list[RawTable] = []
    passed: list[int] = []
    for sheet in cells.sheets:
        found, left = _Finder(sheet, _POSITIONS.get(suffix)).tables()
        tables += found
        passed += left
    return tables, passed


class _Finder:
    """Scans a sheet from top to bottom and remembers what was stated since the last table."""

    def __init__(self, sheet: CellSheet, positions: tuple[tuple[str, str], ...] | None) -> None:
        self.sheet, self.positions = sheet, positions
        self.name = sheet.name
        self.facts: dict[str, tuple[float, int]] = {}
        self.outer: dict[str, tuple[float, int]] = {}  # stated before the first step
        self.steps = 0
        self._note([sheet.name], 0)

    def tables(self) -> tuple[list[RawTable], list[int]]:
        found: list[RawTable] = []
        passed: list[int] = []
        rows, lines = self.sheet.rows, self.sheet.lines
        table: RawTable | None = None
        index = 0
        while index < len(rows):
            row, line = rows[index], lines[index]
            heads = _heads(row)
            if heads is not None:
                table, index = self._new_table(heads, index)
                found.append(table)
                continue
            if table is None and not found and self.positions and _numbers(row) >= 2:
                table = self._table(tuple(read_head(n, u) for n, u in self.positions), line)
                found.append(table)
            if table is not None and _is_data(row, table):
                table.rows.append(row)
                table.lines.append(line)
            else:
                if table is not None and table.rows:
                    table, self.facts, self.name = None, dict(self.outer), self.sheet.name
                passed.append(line)
                self._note([str(cell) for cell in row], line)
            index += 1
        return found, passed

    def _new_table(self, heads: tuple[Head, ...], index: int) -> tuple[RawTable, int]:
        """Return a new table, and the index of the row after its heads and units."""
        rows, lines = self.sheet.rows, self.sheet.lines
        line, after = lines[index], index + 1
        if after < len(rows) and _is_unit_row(rows[after]):
            units = [bare_unit(str(cell)) for cell in rows[after]]
            units += [""] * (len(heads) - len(units))
            heads = tuple(
                head if head.unit is not None else read_head(head.text, unit)
                for head, unit in zip(heads, units, strict=False)
            )
            after += 1
        elif self.positions:
            units_of = dict(self.positions) | {"Freq": "rad/s", "G": "Pa"}
            heads = tuple(_with_default(head, units_of) for head in heads)
        return self._table(heads, line), after

    def _table(self, heads: tuple[Head, ...], line: int) -> RawTable:
        return RawTable(
            self.name, line, heads, self.facts.get("temperature"), self.facts.get("frequency")
        )

    def _note(self, texts: Sequence[str], line: int) -> None:
        """Remember a temperature or frequency stated outside the tables, or begin a new step."""
        whole = " ".join(text for text in texts if text)
        if _STEP.search(whole):
            if self.steps == 0:
                self.outer = dict(self.facts)
            self.steps += 1
            self.facts, self.name = dict(self.outer), f"step {self.steps}"
            return
        named = re.fullmatch(r"step name\s+(.*)", whole, re.IGNORECASE)
        if self.steps and (named or self.name == f"step {self.steps}"):
            shown = named[1] if named else whole
            self.name = f"step {self.steps}: {shown[:60]}"
        for key, patterns in (("temperature", (_DEGREES, _KEYED)), ("frequency", (_HERTZ,))):
            values = {m for pattern in patterns for m in pattern.findall(whole)}
            if len(values) == 1:
                text = values.pop().replace(",", ".").replace("\u2212", "-")
                self.facts[key] = (float(text), line)


def _heads(row: Sequence[Cell]) -> tuple[Head, ...] | None:
    """Return the heads if the row consists of heads, else None."""
    texts = [str(cell) for cell in row]
    if sum(len(text) > 0 for text in texts) < _LEAST_HEADS or _numbers(row) > 0:
        return None
    heads = tuple(read_head(text) for text in texts)
    known = {head.quantity for head in heads if head.quantity is not None}
    return heads if len(known) >= _LEAST_HEADS else None


def _with_default(head: Head, units: dict[str, str]) -> Head:
    if head.unit is not None or head.quantity is None:
        return head
    kind = {"frequency": "rad/s", "temperature": "degC", "time": "s"}.get(head.quantity, "Pa")
    return read_head(head.text, units.get(head.text, kind))


def _is_unit_row(row: Sequence[Cell]) -> bool:
    texts = [str(cell) for cell in row]
    return any(texts) and _numbers(row) == 0 and all(is_unit(text) for text in texts)


def _is_data(row: Sequence[Cell], table: RawTable) -> bool:
    """Return whether a row holds data: mostly numbers or gaps under the heads that are used."""
    under = [
        cell
        for head, cell in zip(table.heads, row, strict=False)
        if head.quantity is not None and not is_missing(cell)
    ]
    numbers = sum(_is_number(cell) for cell in under)
    return numbers > 0 and 2 * numbers >= len(under)


def _numbers(row: Sequence[Cell]) -> int:
    return sum(_is_number(cell) for cell in row)


def _is_number(cell: Cell) -> bool:
    return isinstance(cell, float) or _NUMBER.fullmatch(cell.replace("\u2212", "-")) is not None


def is_missing(cell: Cell) -> bool:
    """Return whether a cell holds no value: it is empty or holds a mark for a missing one."""
    return cell != cell if isinstance(cell, float) else cell.strip().lower() in _MISSING


def column(table: RawTable, index: int, *, comma: bool, source: str) -> Array:
    """Return the numbers of a column (n,), nan where one is missing.

    Parameters
    ----------
    table, index :
        the table, and the index of the column in it.
    comma :
        whether this file uses decimal commas.
    source :
        name of the file, for messages.

    Raises
    ------
    InvalidInputError
        where a cell is neither a number nor empty; the message names its line.
    """
    return np.array(
        [
            _value(row[index] if index < len(row) else "", comma, f"{source}, line {line}")
            for row, line in zip(table.rows, table.lines, strict=True)
        ],
        dtype=float,
    )


def _value(cell: Cell, comma: bool, where: str) -> float:
    if is_missing(cell):
        return float("nan")
    if isinstance(cell, float):
        return cell
    text = cell.replace("\u2212", "-")
    if comma:
        text = text.replace(",", ".") if text.count(",") == 1 and "." not in text else text
    try:
        if "_" in text or "," in text:
            raise ValueError(text)
        return float(text)
    except ValueError:
        raise InvalidInputError(
            f'{where}: "{cell}" cannot be read as a number; write it as 1234.5, without marks '
            "between thousands."
        ) from None


def has_decimal_commas(tables: Sequence[RawTable]) -> bool:
    """Return whether some numbers of the file hold a comma and none holds a point."""
    texts = list(_texts(tables))
    return any("," in text for text in texts) and not any("." in text for text in texts)


def _texts(tables: Sequence[RawTable]) -> Iterator[str]:
    for table in tables:
        for row in table.rows:
            for head, cell in zip(table.heads, row, strict=False):
                if head.quantity is not None and isinstance(cell, str):
                    yield cell
