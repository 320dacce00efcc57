"""Tables of results of any size: CSV by rows, Parquet by columns, workbooks as a whole."""

from __future__ import annotations

import csv
from abc import ABC, abstractmethod
from array import array
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from difflib import get_close_matches
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError
from rollnip._extras import require_extra
from rollnip._files import reading
from rollnip.figure import axis_label
from rollnip.io import read_columns
from rollnip.io.columns import EXCEL, head_parts, is_comment

Cell = str | float | int | None
Array = NDArray[np.float64]
_CONVERGED = "converged"
_TRUE = ("1", "1.0", "true")


class ResultTable(ABC):
    """A table of results on disk, of which only the wanted parts are read.

    Attributes
    ----------
    source : name of the file, for messages.
    names, units : of the columns, from their heads ``name [unit]``; the unit is empty where there
        is none.
    """

    source: str
    names: tuple[str, ...]
    units: tuple[str, ...]

    @property
    def heads(self) -> list[str]:
        """The heads of the columns, with their units."""
        return [axis_label(name, unit) for name, unit in zip(self.names, self.units, strict=True)]

    def head(self, name: str) -> str:
        """Return the head of one column; raise InvalidInputError for an unknown name."""
        return self.heads[self.index(name)]

    def index(self, name: str) -> int:
        """Return the index of a column; raise InvalidInputError for an unknown name."""
        if name in self.names:
            return self.names.index(name)
        near = get_close_matches(name, self.names, n=1)
        hint = f'did you mean "{near[0]}"?' if near else f"has {', '.join(self.names)}."
        raise InvalidInputError(f'{self.source}: has no column "{name}"; {hint}')

    def values(self, names: Sequence[str]) -> Array:
        """Return columns as numbers, each in the unit of its head.

        Parameters
        ----------
        names : (m,) of columns.

        Returns
        -------
        (n, m) array; nan where a cell is empty, and in rows whose column "converged", if there is
        one, is not true.

        Raises
        ------
        InvalidInputError
            where there is no such column, or a cell is not a number; with file, line and column.
        """
        places = [self.index(name) for name in names]
        judged = self.index(_CONVERGED) if _CONVERGED in self.names else None
        found = array("d")
        empty = [float("nan")] * len(places)
        for line, cells in self._cells([*places, *([] if judged is None else [judged])]):
            numbers = [
                self._number(cell, f'{self.source}, line {line}: "{name}"')
                for cell, name in zip(cells, names, strict=False)
            ]
            is_good = judged is None or str(cells[-1]).strip().lower() in _TRUE
            found.extend(numbers if is_good else empty)
        return np.array(found).reshape(-1, len(places))

    def rows(self, wanted: Iterable[int]) -> dict[int, list[Cell]]:
        """Return whole rows by their number, from 0."""
        left = set(wanted)
        every = list(range(len(self.names)))
        return {n: cells for n, (_, cells) in enumerate(self._cells(every)) if n in left}

    @abstractmethod
    def _cells(self, places: Sequence[int]) -> Iterator[tuple[int, list[Cell]]]:
        """Yield the line number and the cells of the given columns, for every row."""

    def _number(self, cell: Cell, where: str) -> float:
        if cell is None or cell == "":
            return float("nan")
        try:
            return float(self._point(cell) if isinstance(cell, str) else cell)
        except ValueError:
            raise InvalidInputError(f'{where} must be a number, got "{str(cell)[:60]}".') from None

    def _point(self, cell: str) -> str:
        return cell

    def _name(self, source: str, heads: Sequence[str]) -> None:
        self.source = source
        if not heads:
            raise InvalidInputError(
                f"{source}: must hold a line of column names and rows below it."
            )
        names, units = zip(*(head_parts(head, source) for head in heads), strict=True)
        self.names, self.units = names, units


def open_results(path: Path) -> ResultTable:
    """Open a table of results: .parquet, a workbook, or text.

    Raises
    ------
    InvalidInputError, RollnipError
        where it cannot be read, an extra is missing, or a row has too few or too many cells.
    """
    reading(path)
    if path.suffix.lower() == ".parquet":
        return _Parquet(path)
    return _Worksheet(path) if path.suffix.lower() in EXCEL else _Text(path)


class _Text(ResultTable):
    def __init__(self, path: Path) -> None:
        self._path = path
        if path.is_dir() or (path.exists() and not path.is_file()):
            raise InvalidInputError(f"{path}: must be a file, it is none.")
        with self._lines() as lines:
            head = next((one for one in lines if one.strip() and not is_comment(one)), "")
        self._mark = next((mark for mark in (";", "\t") if mark in head), ",")
        self._name(str(path), [one.strip() for one in self._split([head])])

    @contextmanager
    def _lines(self) -> Iterator[Iterator[str]]:
        try:
            with self._path.open(encoding="utf-8-sig", newline="") as stream:
                yield iter(stream)
        except OSError as error:
            said = "there is no such file" if isinstance(error, FileNotFoundError) else ""
            raise InvalidInputError(
                f"{self._path}: {said or f'cannot be read: {error.strerror}'}."
            ) from None
        except UnicodeDecodeError:
            raise InvalidInputError(f"{self._path}: must be a text file in UTF-8.") from None

    def _split(self, lines: Iterable[str]) -> list[str]:
        return next(csv.reader(lines, delimiter=self._mark), [])

    def _cells(self, places: Sequence[int]) -> Iterator[tuple[int, list[Cell]]]:
        count, is_head = len(self.names), True
        with self._lines() as lines:
            parted = csv.reader(lines, delimiter=self._mark)
            for cells in parted:
                if not any(cells) or is_comment(cells[0]):
                    continue
                if is_head:
                    is_head = False
                    continue
                if len(cells) != count:
                    raise InvalidInputError(
                        f"{self.source}, line {parted.line_num}: must have {count} cells, has "
                        f"{len(cells)}."
                    )
                yield parted.line_num, [cells[place].strip() for place in places]

    def _point(self, cell: str) -> str:
        is_decimal = self._mark != "," and cell.count(",") == 1 and "." not in cell
        return cell.replace(",", ".") if is_decimal else cell


class _Worksheet(ResultTable):
    def __init__(self, path: Path) -> None:
        self._table = read_columns(path)
        self.source, self.names, self.units = str(path), self._table.names, self._table.units

    def _cells(self, places: Sequence[int]) -> Iterator[tuple[int, list[Cell]]]:
        for line, row in zip(self._table.lines, self._table.rows, strict=True):
            yield line, [row[place] for place in places]


class _Parquet(ResultTable):
    _AT_ONCE = 50_000  # rows

    def __init__(self, path: Path) -> None:
        require_extra("tables", f"{path}: reading Parquet", "take a table that ends in .csv")
        import polars as pl

        if not path.is_file():
            raise InvalidInputError(f"{path}: there is no such file.")
        try:
            self._frame: Any = pl.scan_parquet(path)
            self._heads = list(self._frame.collect_schema())
            self._count = int(self._frame.select(pl.len()).collect().item())
        except (pl.exceptions.PolarsError, OSError) as error:
            said = " ".join(str(error).split())[:200]
            raise InvalidInputError(f"{path}: cannot be read as Parquet: {said}.") from None
        self._name(str(path), self._heads)

    def _cells(self, places: Sequence[int]) -> Iterator[tuple[int, list[Cell]]]:
        wanted = self._frame.select([self._heads[place] for place in dict.fromkeys(places)])
        order = {place: i for i, place in enumerate(dict.fromkeys(places))}
        for first in range(0, self._count, self._AT_ONCE):
            part = wanted.slice(first, self._AT_ONCE).collect()
            for number, row in enumerate(part.iter_rows(), first + 1):
                yield number, [row[order[place]] for place in places]
