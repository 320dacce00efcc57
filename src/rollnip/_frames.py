"""Answers that are tables, as the tables of pandas, polars and xarray."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import RollnipError

Column = NDArray[np.float64] | tuple[str, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """Columns of equal length.

    Attributes
    ----------
    columns : by name; numbers are arrays in which nan is what is not there, texts are tuples.
    units : units of the columns that have one.
    about : what holds for all rows, as plain values.
    row : name of the column that numbers the rows; where there is none, they count from 0.
    """

    columns: Mapping[str, Column]
    units: Mapping[str, str]
    about: Mapping[str, Any] = field(default_factory=dict)
    row: str = "row"


class Framed:
    """Base class of answers that other packages can take as a table."""

    __slots__ = ()

    def _frame(self) -> Frame:
        """Return the answer as columns."""
        raise NotImplementedError

    def to_pandas(self) -> Any:
        """Return a pandas DataFrame; its ``attrs`` hold the units and what all rows share.

        Raises
        ------
        RollnipError
            where pandas is not installed.
        """
        made = self._frame()
        frame = _module("pandas").DataFrame(dict(made.columns))
        frame.attrs = {"units": dict(made.units), **made.about}
        return frame

    def to_polars(self) -> Any:
        """Return a polars DataFrame.

        Raises
        ------
        RollnipError
            where polars is not installed.
        """
        columns = self._frame().columns
        return _module("polars").DataFrame({name: _plain(one) for name, one in columns.items()})

    def to_xarray(self) -> Any:
        """Return an xarray Dataset over the rows, units as attributes of its variables.

        Raises
        ------
        RollnipError
            where xarray is not installed.
        """
        made = self._frame()
        variables = {
            name: (made.row, _plain(one), {"units": made.units[name]} if name in made.units else {})
            for name, one in made.columns.items()
            if name != made.row
        }
        count = len(next(iter(made.columns.values())))
        numbers = np.asarray(made.columns.get(made.row, np.arange(count))).astype(int)
        attributes = {
            name: value if isinstance(value, str | int | float) else json.dumps(value)
            for name, value in made.about.items()
        }
        return _module("xarray").Dataset(variables, {made.row: numbers}, attributes)


def numbers(values: Any) -> NDArray[np.float64]:
    """Return numbers as an array in which nan stands for None."""
    return np.array([np.nan if one is None else one for one in values], dtype=np.float64)


def _plain(column: Column) -> Any:
    return list(column) if isinstance(column, tuple) else column


def _module(name: str) -> Any:
    try:
        return import_module(name)
    except ModuleNotFoundError:
        raise RollnipError(f"{name} is needed for this, and is not installed.") from None
