"""How a file of measurements was understood: tables, columns, and what was left out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError
from rollnip.dma.heads import SHOWN, Head, MeasuredQuantity, Modulus, scale_of
from rollnip.dma.shown import KINDS, UNITS, counted, description_lines, named_lines, table_tree
from rollnip.dma.tables import RawTable, column, find_tables, has_decimal_commas
from rollnip.io.cells import Cells, read_cells

Array = NDArray[np.float64]
Kind = Literal["dynamic", "relaxation", "creep"]

_WAYS: tuple[tuple[MeasuredQuantity, MeasuredQuantity], ...] = (
    ("storage", "loss"),
    ("storage", "tan delta"),
    ("storage", "phase"),
    ("absolute", "phase"),
    ("absolute", "tan delta"),
)
_OVER_TIME: tuple[tuple[MeasuredQuantity, Kind], ...] = (
    ("relaxation", "relaxation"),
    ("compliance", "creep"),
)


@dataclass(frozen=True, eq=False, slots=True)
class ReadTable:
    """One table as it was understood.

    Attributes
    ----------
    name : name of the sheet or step, with its number.
    line : line of its heads.
    heads : heads of all columns.
    used : column index of each quantity that is used.
    values : (n,) values of each quantity in base units: Hz, degC, MPa, rad, s, 1/MPa.
    rows : location of each of the n rows.
    kind : kind of measurement; None where the table cannot be used.
    modulus : E or G, where the heads say which.
    notes : values taken from outside the table, and rows left out.
    problem : why the table holds no known kind of measurement; empty where it does.
    fault : the error in a table that cannot be used.
    """

    name: str
    line: int
    heads: tuple[Head, ...]
    used: dict[MeasuredQuantity, int]
    values: dict[MeasuredQuantity, Array]
    rows: tuple[str, ...]
    kind: Kind | None
    modulus: Modulus | None
    notes: tuple[str, ...]
    problem: str
    fault: str


@dataclass(frozen=True, eq=False, slots=True)
class Reading:
    """A file of measurements as it was understood.

    Attributes
    ----------
    source : name of the file.
    encoding, separator : of a text file, in words; empty for a workbook.
    decimal_comma : whether commas were read as decimal commas.
    tables : the tables in the order of the file.
    passed : numbers of the lines that belong to no table.
    """

    source: str
    encoding: str
    separator: str
    decimal_comma: bool
    tables: tuple[ReadTable, ...]
    passed: tuple[int, ...]

    def chosen(self, kind: Kind, numbers: Sequence[int] = ()) -> tuple[ReadTable, ...]:
        """Return the tables of a kind, or those of the given numbers, counted from 1.

        Raises
        ------
        InvalidInputError
            where there is none; the message says what each table lacks.
        """
        for number in numbers:
            if not 1 <= number <= len(self.tables):
                raise InvalidInputError(
                    f"{self.source}: has no table {number}, it has {len(self.tables)}."
                )
            if numbers.count(number) > 1:
                raise InvalidInputError(
                    f"{self.source}: table {number} must be given once; its rows would count "
                    f"{numbers.count(number)} times."
                )
        tables = [self.tables[n - 1] for n in numbers] if numbers else list(self.tables)
        fault = next((table.fault for table in tables if table.fault), "")
        if fault:
            raise InvalidInputError(fault)
        good = tuple(table for table in tables if table.kind == kind)
        if good and not (numbers and len(good) < len(tables)):
            return good
        if not self.tables:
            lacks = "no table whose heads are known" if self.passed else "no rows"
            raise InvalidInputError(
                f"{self.source}: holds {lacks}; write one line of heads over the numbers, "
                "such as \"temperature [degC]; frequency [Hz]; E' [MPa]; "
                "E'' [MPa]\"."
            )
        why = [f"{table.name}: {table.problem or _other(table)}" for table in tables]
        raise InvalidInputError(f"{self.source}: {' '.join(dict.fromkeys(why))}")

    def text(self) -> str:
        """Return a description of the file as it was understood, for people."""
        return "\n".join(description_lines(self)) + "\n"

    def as_dict(self) -> dict[str, Any]:
        """Return the description as plain values, for JSON: ranges in base units."""
        return {
            "source": self.source,
            "encoding": self.encoding,
            "separator": self.separator,
            "decimal_comma": self.decimal_comma,
            "passed": list(self.passed),
            "tables": [table_tree(table) for table in self.tables],
        }


def read_tables(
    path: str | Path,
    *,
    temperature: float | None = None,
    frequency: float | None = None,
    sheet: str | None = None,
) -> Reading:
    """Find and interpret the tables of measurements in a text file or workbook.

    Parameters
    ----------
    path :
        path of the file.
    temperature, frequency :
        value for all measurements [degC, Hz], where there is no such column.
    sheet :
        the one sheet of a workbook to read; all by default.

    Raises
    ------
    InvalidInputError
        where the file cannot be read, or does not have the given sheet.
    """
    cells = _sheets(read_cells(path), sheet)
    raw, passed = find_tables(cells, Path(path).suffix.lower())
    comma = cells.separator != "comma" and has_decimal_commas(raw)
    given: dict[MeasuredQuantity, float] = {}
    if temperature is not None:
        given["temperature"] = temperature
    if frequency is not None:
        given["frequency"] = frequency
    tables = tuple(
        _understood(table, number, comma, cells, given) for number, table in enumerate(raw, 1)
    )
    return Reading(str(path), cells.encoding, cells.separator, comma, tables, tuple(passed))


def _sheets(cells: Cells, wanted: str | None) -> Cells:
    if wanted is None:
        return cells
    names = [sheet.name for sheet in cells.sheets]
    if names == [""]:
        raise InvalidInputError(
            f"{cells.source}: is a text file and has no sheets; leave out `sheet`."
        )
    if wanted not in names:
        raise InvalidInputError(
            f'{cells.source}: has no sheet "{wanted}" (there: {", ".join(names)}).'
        )
    kept = tuple(sheet for sheet in cells.sheets if sheet.name == wanted)
    return Cells(cells.source, kept, cells.encoding, cells.separator)


def _understood(
    table: RawTable, number: int, comma: bool, cells: Cells, given: dict[MeasuredQuantity, float]
) -> ReadTable:
    name = f"table {number}" + (f", {table.name}" if table.name else "")
    empty = ReadTable(name, table.line, table.heads, {}, {}, (), None, None, (), "", "")
    source = cells.source
    try:
        columns = _columns(table, source)
        kind, used, problem = _kind(columns, given, table)
        if kind is None:
            return replace(empty, problem=problem)
        values = _values(table, used, comma, source)
        notes = _add_known(values, table, given, source)
    except InvalidInputError as error:
        return replace(empty, fault=str(error))
    good = np.all([np.isfinite(column) for column in values.values()], axis=0)
    lost = [line for line, kept in zip(table.lines, good, strict=True) if not kept]
    if lost:
        notes.append(f"left out: {counted(len(lost), 'row')} without a value ({named_lines(lost)})")
    where = "line" if cells.encoding else f'sheet "{table.name}", row'
    rows = tuple(f"{where} {line}" for line, k in zip(table.lines, good, strict=True) if k)
    if not table.rows:
        problem = f"it has no rows of numbers; write them below its heads {_seen(table)}."
        return replace(empty, problem=problem)
    if not rows:
        return replace(empty, problem=f"it has no row in which all values stand {_seen(table)}.")
    kinds = {table.heads[i].kind for i in used.values()} - {None}
    if len(kinds) > 1:
        fault = f"{source}, line {table.line}: moduli must be of one kind, got E and G."
        return replace(empty, fault=fault)
    return replace(
        empty,
        used=used,
        values={key: column[good] for key, column in values.items()},
        rows=rows,
        kind=kind,
        modulus=kinds.pop() if kinds else None,
        notes=tuple(notes),
    )


def _columns(table: RawTable, source: str) -> dict[MeasuredQuantity, int]:
    """Return the column of each quantity.

    Of step time and time, and of a frequency in Hz and in rad/s, the first column is used; any
    other
    quantity with two columns is an error.
    """
    found: dict[MeasuredQuantity, int] = {}
    for index, head in enumerate(table.heads):
        quantity = head.quantity
        if quantity is None:
            continue
        if quantity in found:
            first = table.heads[found[quantity]]
            if quantity == "time" or head.angular != first.angular:
                continue  # step time precedes time; Hz and rad/s are the same quantity
            raise InvalidInputError(
                f'{source}, line {table.line}: columns "{first.text}" and "{head.text}" both say '
                f"{SHOWN[quantity]}; rename the one that is not to be used."
            )
        found[quantity] = index
    return found


def _kind(
    columns: dict[MeasuredQuantity, int], given: dict[MeasuredQuantity, float], table: RawTable
) -> tuple[Kind | None, dict[MeasuredQuantity, int], str]:
    """Return the kind of measurement and the columns it uses, or a sentence on what is missing."""
    temperature = {k: i for k, i in columns.items() if k == "temperature"}
    way = next((way for way in _WAYS if all(one in columns for one in way)), None)
    if way is not None:
        used = {key: columns[key] for key in way} | temperature
        if "frequency" in columns:
            used["frequency"] = columns["frequency"]
        elif "frequency" not in given and table.frequency is None:
            return None, {}, f"it has no column of frequencies {_seen(table)}."
        return "dynamic", used, ""
    if "time" in columns:
        for quantity, kind in _OVER_TIME:
            if quantity in columns:
                used = {"time": columns["time"], quantity: columns[quantity]} | temperature
                return kind, used, ""
    lacks = (
        "the loss modulus, tan delta or the phase"
        if columns.keys() & {"storage", "absolute"}
        else "a column of the storage modulus or the complex modulus (or of time and E(t) or J(t))"
    )
    return None, {}, f"it lacks {lacks} {_seen(table)}."


def _seen(table: RawTable) -> str:
    texts = [head.text for head in table.heads if head.text]
    names = [
        "storage modulus",
        "loss modulus",
        "frequency",
        "temperature",
        "tan delta",
        "phase angle",
    ]
    unknown = [head.text.lower() for head in table.heads if head.quantity is None and head.text]
    near = [(text, get_close_matches(text, names, n=1, cutoff=0.75)) for text in unknown]
    hint = next((f'; "{text}" may mean "{found[0]}"' for text, found in near if found), "")
    return f"(its heads, line {table.line}: {', '.join(texts[:12])}{hint})"


def _values(
    table: RawTable, used: dict[MeasuredQuantity, int], comma: bool, source: str
) -> dict[MeasuredQuantity, Array]:
    values = {}
    for quantity, index in used.items():
        head = table.heads[index]
        where = f"{source}, line {table.line}"
        scale, offset = scale_of(head, head.unit, where)
        values[quantity] = scale * column(table, index, comma=comma, source=source) + offset
    return values


def _add_known(
    values: dict[MeasuredQuantity, Array],
    table: RawTable,
    given: dict[MeasuredQuantity, float],
    source: str,
) -> list[str]:
    """Add temperature and frequency where the whole table has one value; return notes on it."""
    notes: list[str] = []
    count = len(table.rows)
    needed: tuple[MeasuredQuantity, ...] = ("temperature", "frequency")
    for key in needed[: 1 if "time" in values else 2]:
        if key in values and key in given:
            raise InvalidInputError(f"`{key}` must not be given: {source} has such a column.")
        if key in values:
            continue
        said = table.temperature if key == "temperature" else table.frequency
        if key in given:
            values[key] = np.full(count, given[key])
        elif said is not None:
            values[key] = np.full(count, said[0])
            at = f"line {said[1]}" if said[1] else "the name of the sheet"
            notes.append(f"{key} {said[0]:g} {UNITS[key]} from {at}")
        else:
            raise InvalidInputError(
                f'{source}, line {table.line}: the table must have a column "{key}", or '
                f"`{key}` must be given {_seen(table)}."
            )
    return notes


def _other(table: ReadTable) -> str:
    return f"it holds {KINDS[table.kind]}." if table.kind else table.problem
