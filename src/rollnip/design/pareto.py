"""The Pareto front: cases that no other case beats in two or more results at once."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from io import StringIO
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rollnip._errors import InvalidInputError

Sense = Literal["minimise", "maximise"]
_BLOCK = 4096  # number of rows compared with a row of the front at once


def pareto_front(values: ArrayLike, senses: Sequence[Sense]) -> NDArray[np.intp]:
    """Return the rows that no other row dominates: as good in every column and better in one.

    Parameters
    ----------
    values : (n, m) results, a row for each case; rows with nan are left out.
    senses : (m,) "minimise" or "maximise" for each column.

    Returns
    -------
    (k,) row numbers, ordered by the first column from its best value on; equal rows are all
    included.

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
    for first in range(0, order.size, _BLOCK):  # a later row never dominates an earlier one
        block = order[first : first + _BLOCK]
        beaten = np.zeros(block.size, dtype=bool)
        for row in front:
            beaten |= _dominates(costs[row], costs[block])
        begun = len(front)
        for row in block[~beaten]:
            if not _dominates(costs[front[begun:]], costs[row]).any():
                front.append(int(row))
    return np.array(front, dtype=np.intp)


def _dominates(one: NDArray[np.float64], other: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return, row by row, whether ``one`` is nowhere worse than ``other`` and somewhere better."""
    return np.asarray(np.all(one <= other, axis=-1) & np.any(one < other, axis=-1))


def rows_text(heads: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Return rows of a table as CSV text under its heads."""
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(heads)
    writer.writerows(rows)
    return text.getvalue()
