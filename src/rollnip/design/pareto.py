"""The cases that no other case beats in two or more results at once."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from io import StringIO
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rollnip._errors import InvalidInputError
from rollnip.io import Columns

Sense = Literal["minimise", "maximise"]


def pareto_front(values: ArrayLike, senses: Sequence[Sense]) -> NDArray[np.intp]:
    """Which rows are not dominated: none is as good in every column and better in one.

    Parameters
    ----------
    values : (n, m) results, a row for each case; rows with nan are left out.
    senses : (m,) "minimise" or "maximise" for each column.

    Returns
    -------
    (k,) row numbers, by the first column from its best value on; equal rows are all there.

    Raises
    ------
    InvalidInputError
        where the shapes do not fit or a sense is unknown.
    """
    table = np.asarray(values, dtype=float)
    if table.ndim != 2 or table.shape[1] != len(senses) or table.shape[1] < 2:
        raise InvalidInputError(
            f"`values` must have a row for each case and two or more columns, one for each sense "
            f"(there: {len(senses)}), got shape {table.shape}."
        )
    unknown = next((one for one in senses if one not in ("minimise", "maximise")), None)
    if unknown is not None:
        raise InvalidInputError(f'`senses` must be "minimise" or "maximise", got "{unknown}".')
    signs = [1.0 if sense == "minimise" else -1.0 for sense in senses]
    costs = table * np.array(signs)
    rows = np.flatnonzero(~np.isnan(costs).any(axis=1))
    order = rows[np.lexsort(costs[rows].T[::-1])]
    front: list[int] = []
    for row in order:  # a later row never dominates an earlier one
        kept = costs[front]
        dominated = np.all(kept <= costs[row], axis=1) & np.any(kept < costs[row], axis=1)
        if not dominated.any():
            front.append(int(row))
    return np.array(front, dtype=np.intp)


def column_values(table: Columns, names: Sequence[str]) -> NDArray[np.float64]:
    """Columns of a table of results, each in the unit of its head.

    Parameters
    ----------
    table : as read.
    names : (m,) of columns.

    Returns
    -------
    (n, m) array; nan where a cell is empty, and in rows whose column "converged", where there is
    one, does not say so.

    Raises
    ------
    InvalidInputError
        where there is no such column, or a cell is no number; with file, line and column.
    """
    values = np.array(
        [
            [
                _number(cell, f'{table.source}, line {line}: "{name}"')
                for cell, line in zip(table.cells(name), table.lines, strict=True)
            ]
            for name in names
        ]
    ).T
    if "converged" in table.names:
        said = [str(cell).strip().lower() for cell in table.cells("converged")]
        values[[one not in ("1", "1.0", "true") for one in said]] = np.nan
    return values


def rows_text(table: Columns, rows: Sequence[int] | NDArray[np.intp]) -> str:
    """Some rows of a table as CSV, under its heads."""
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    heads = zip(table.names, table.units, strict=True)
    writer.writerow([f"{name} [{unit}]" if unit else name for name, unit in heads])
    writer.writerows(table.rows[row] for row in rows)
    return text.getvalue()


def _number(cell: str | float, where: str) -> float:
    if cell == "":
        return float("nan")
    try:
        return float(cell)
    except ValueError:
        raise InvalidInputError(f'{where} must be a number, got "{str(cell)[:60]}".') from None
