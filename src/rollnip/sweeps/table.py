"""The table of results, in memory or as a CSV, Parquet or Excel file, in the order of the study.

All are made from the database alone, so that they are the same however the sweep was run.
"""

from __future__ import annotations

import csv
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError, RollnipError
from rollnip._extras import require_extra
from rollnip._files import check_target, write_whole
from rollnip._frames import Frame, Framed
from rollnip._units import parse_quantity
from rollnip.figure import axis_label
from rollnip.model import Model
from rollnip.sweeps.row import SCALARS
from rollnip.sweeps.store import About, Store
from rollnip.sweeps.workbook import MOST_ROWS, write_workbook

SUFFIXES = (".csv", ".parquet", ".xlsx")
_TEXTS = ("status", "message", "geometry")
_AFTER = ("warnings", "hash")
_TEXT = ""
_TOLERANCE = "solver.tolerance"

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Table(Framed):
    """Results of a sweep, a row for each case, in the order of the study.

    Attributes
    ----------
    columns :
        by name: ``case`` (position in the study, from 0), the paths of the parameters, ``status``,
        ``message``, ``geometry``, ``converged`` (1 or 0), the results, ``warnings``, ``hash``,
        ``tolerance`` and ``version``. Numbers are float arrays with nan for missing values, texts
        are
        tuples.
    units :
        units of the numeric columns, "1" where there is none.
    case :
        case of the study, as the tree of a case file; the parameters change it from row to row.
    """

    columns: Mapping[str, Array | tuple[str, ...]]
    units: Mapping[str, str]
    case: Mapping[str, Any] = field(default_factory=dict)

    def __getitem__(self, name: str) -> Any:
        """Return one column. Raises InvalidInputError where there is none of that name."""
        if name not in self.columns:
            raise InvalidInputError(
                f'`name` must be one of {", ".join(self.columns)}, got "{name}".'
            )
        return self.columns[name]

    def __len__(self) -> int:
        """Return the number of cases."""
        return len(self.columns["case"])

    def __repr__(self) -> str:
        done = sum(status == "solved" for status in self.columns.get("status", ()))
        return f"<Table of {len(self)} cases, {done} solved: {', '.join(self.columns)}>"

    def _frame(self) -> Frame:
        return Frame(self.columns, self.units, {"case": dict(self.case)}, row="case")


def check_table_target(path: Path) -> None:
    """Raise RollnipError where a table could not be written to ``path``, before a sweep."""
    check_target(path, SUFFIXES)
    if path.suffix.lower() == ".parquet":
        require_extra("tables", f"{path}: Parquet", "choose a name that ends in .csv")


def read_table(store: Store) -> Table:
    """Return all results of a sweep, in memory."""
    heads = _columns(store.about)
    rows = list(_rows(store))
    found = zip(*rows, strict=True) if rows else ((),) * len(heads)
    columns: dict[str, Array | tuple[str, ...]] = {}
    for (name, unit), values in zip(heads.items(), found, strict=True):
        if unit == _TEXT:
            columns[name] = tuple("" if value is None else str(value) for value in values)
        else:
            columns[name] = np.array(
                [np.nan if value is None else value for value in values], dtype=np.float64
            )
    units = {name: unit for name, unit in heads.items() if unit != _TEXT}
    return Table(columns, units, json.loads(store.about.case or "{}"))


def write_table(store: Store, path: Path) -> None:
    """Write the results to a file, completely or not at all, one row at a time.

    Memory use therefore does not depend on the number of cases.

    Parameters
    ----------
    store :
        store of the sweep.
    path :
        ends in .csv, .parquet (with the extra ``rollnip[tables]``) or .xlsx. Column heads carry the
        unit: ``nip_width [mm]``; missing values are empty.

    Raises
    ------
    RollnipError
        where the name ends otherwise, the extra is missing, there are more cases than rows in an
        Excel
        sheet, or the file cannot be written.
    """
    check_table_target(path)
    if path.suffix.lower() == ".csv":
        write_whole(path, lambda file: _write_csv(store, file))
    elif path.suffix.lower() == ".xlsx":
        if store.size >= MOST_ROWS:
            raise RollnipError(
                f"{path}: a sheet of a workbook has {MOST_ROWS:,} rows, for {store.size:,} cases "
                "too few; choose a name that ends in .csv or .parquet."
            )
        write_whole(path, lambda file: write_workbook(file, _heads(store.about), _rows(store)))
    else:
        write_whole(path, lambda file: _write_parquet(store, file))


def _columns(about: About) -> dict[str, str]:
    """Return the unit of each column, empty for texts."""
    columns = {"case": "1"} | dict(zip(about.paths, about.units, strict=True))
    columns |= dict.fromkeys(_TEXTS, _TEXT) | {"converged": "1"}
    columns |= {name: SCALARS[name] for name in about.results}
    return columns | dict.fromkeys(_AFTER, _TEXT) | {"tolerance": "1", "version": _TEXT}


def _heads(about: About) -> list[str]:
    return [
        name if unit == _TEXT else axis_label(name, unit) for name, unit in _columns(about).items()
    ]


def _rows(store: Store) -> Iterator[list[Any]]:
    about = store.about
    names = ("position", "parameters", *_TEXTS, *about.results, *_AFTER)
    tolerance = _tolerance(about)
    changed = about.paths.index(_TOLERANCE) if _TOLERANCE in about.paths else None
    for position, parameters, *rest in store.rows(names):
        values = zip(json.loads(parameters), about.units, strict=True)
        shown = [_shown(value, unit) for value, unit in values]
        texts, others = rest[: len(_TEXTS)], rest[len(_TEXTS) :]
        here = tolerance if changed is None else shown[changed]
        yield [position, *shown, *texts, int(texts[0] == "solved"), *others, here, about.version]


def _tolerance(about: About) -> float | None:
    """Return the tolerance in the study's case; None where it is invalid."""
    solver = json.loads(about.case or "{}").get("solver")
    given = solver.get("tolerance") if isinstance(solver, dict) else None
    if given is None:
        return Model().tolerance
    try:
        return parse_quantity(given, "ratio")
    except InvalidInputError:
        return None


def _shown(value: Any, unit: str) -> Any:
    """Return a parameter as it stands in the table; in the database, texts are JSON."""
    if unit != _TEXT:
        return value
    read = json.loads(value)
    return read if isinstance(read, str) else value


def _write_csv(store: Store, file: Path) -> None:
    with file.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(_heads(store.about))
        writer.writerows(_rows(store))


def _write_parquet(store: Store, file: Path) -> None:
    """Write Parquet from a temporary CSV beside it, so that the rows are never all in memory."""
    import polars as pl

    kinds = _columns(store.about).values()
    schema = {
        head: pl.String if unit == _TEXT else pl.Float64
        for head, unit in zip(_heads(store.about), kinds, strict=True)
    } | {"case": pl.Int64}
    between = file.with_name(f"{file.name}.csv")
    try:
        _write_csv(store, between)
        frame = pl.scan_csv(between, schema=schema).with_columns(pl.col(pl.String).fill_null(""))
        about = store.about
        frame.sink_parquet(file, metadata={"rollnip": about.version, "case": about.case})
    except pl.exceptions.PolarsError as error:
        raise OSError(str(error)) from None  # like any other failure to write
    finally:
        between.unlink(missing_ok=True)
