"""The reader of a fit's file: unknowns and measurements; every error is one clear line."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from math import inf
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import CaseFileError, InvalidInputError
from rollnip._units import Dimension, parse_quantity
from rollnip.identification.costs import (
    Approaches,
    Creepages,
    Feeds,
    Loads,
    Measurements,
    NipWidths,
    PeakPressures,
    RollingResistances,
    Scalars,
    Torques,
    Total,
)
from rollnip.identification.fit import LeastSquares
from rollnip.identification.impressions import Impressions
from rollnip.identification.quality import row_names
from rollnip.identification.surface import Strains, Velocities
from rollnip.identification.unknowns import Prior, Unknown
from rollnip.io import TableColumns, dimension_at, read_columns
from rollnip.io.document import folder_of, read_document
from rollnip.io.fitting import DataTable, FitTable, UnknownTable, parse_fit
from rollnip.io.forms import read_quantity
from rollnip.io.velocities import Settings, read_velocities

_ERROR = "standard error"
_SCALARS: dict[str, tuple[type[Scalars], Dimension]] = {
    "nip-width": (NipWidths, "length"),
    "approach": (Approaches, "length"),
    "load": (Loads, "line load"),
    "peak-pressure": (PeakPressures, "pressure"),
    "creepage": (Creepages, "ratio"),
    "torque": (Torques, "force"),
    "rolling-resistance": (RollingResistances, "ratio"),
    "feed": (Feeds, "ratio"),
}
_POSITIVE = ("nip-width", "load", "peak-pressure")  # positive in any nip, whatever the noise
_SHORT = ("load", "approach", "traction", "creepage", "torque_lower", "friction", "speed")


@dataclass(frozen=True, slots=True)
class FitStudy:
    """The contents of a fit's file, as arguments of `identify`.

    Attributes
    ----------
    title : title of the file.
    case : the tree of the case.
    unknowns : what is to be found.
    cost : the measurements.
    method : the settings of the fit.
    """

    title: str
    case: Mapping[str, Any]
    unknowns: tuple[Unknown, ...]
    cost: Total
    method: LeastSquares


def read_fit(path: str | Path) -> FitStudy:
    """Read a file that describes a fit, TOML or JSON.

    Names of other files in it are relative to its folder.

    Raises
    ------
    CaseFileError
        where the file, or the case that it names, cannot be read or understood.
    InvalidInputError
        where a table of measurements is wrong, with file, line and column.
    """
    folder = folder_of(path)
    reader = _FitReader(parse_fit(read_document(path), str(path)), str(path), folder)
    return reader.study()


class _FitReader:
    def __init__(self, table: FitTable, source: str, folder: Path) -> None:
        self.table, self.source, self.folder = table, source, folder
        self.case = self._case()

    def study(self) -> FitStudy:
        unknowns = [self._unknown(i, one) for i, one in enumerate(self.table.unknowns)]
        sets = [self._measurements(i, one) for i, one in enumerate(self.table.data)]
        if not unknowns or not sets:
            what = "unknowns" if not unknowns else "data"
            raise CaseFileError(f"{self.source}: {what}: must hold at least one, holds none.")
        with self._placed("method"):
            given = self.table.method.model_dump(exclude_none=True)
            method = LeastSquares(**given)
        title = self.table.title or str(self.case.get("title", ""))
        return FitStudy(title, self.case, tuple(unknowns), Total(tuple(sets)), method)

    def _case(self) -> dict[str, Any]:
        given = self.table.case
        if isinstance(given, str):
            return read_document(self.folder / given)
        if not isinstance(given, dict):
            raise CaseFileError(
                f"{self.source}: case: must be the name of a case file, or a table."
            )
        return given

    def _unknown(self, index: int, table: UnknownTable) -> Unknown:
        where = f"unknowns[{index}]"
        with self._placed(f"{where}.path"):
            dimension = dimension_at(self.case, table.path)
            if dimension is None:
                raise InvalidInputError(f"`{table.path}` is no number of the case.")

        def read(key: str, value: Any) -> float:
            with self._placed(f"{where}.{key}"):
                return read_quantity(value, dimension)

        prior = None
        if table.prior is not None:
            with self._placed(f"{where}.prior"):
                error = _difference(table.prior.standard_error, dimension)
                prior = Prior(read("prior.value", table.prior.value), error)
        start = None if table.start is None else read("start", table.start)
        low, high = read("low", table.low), read("high", table.high)
        with self._placed(where):
            return Unknown(
                path=table.path,
                low=low,
                high=high,
                start=start,
                log=table.scale == "log",
                prior=prior,
            )

    def _measurements(self, index: int, table: DataTable) -> Measurements:
        where = f"data[{index}]"
        with self._placed(f"{where}.at"):
            at = {path: self._single(path, value) for path, value in table.at.items()}
        if table.kind == "velocity":
            return self._velocities(where, table, at)
        columns = read_columns(self.folder / table.file, sheet=table.sheet)
        if table.kind == "strain":
            return self._strains(where, table, columns, at)
        if table.kind == "impression":
            return self._impressions(where, table, columns, at)
        if table.kind == "feed" and "sheet" not in self.case:
            raise CaseFileError(
                f"{self.source}: {where}: a feed needs a table [sheet] in the case."
            )
        kind, dimension = _SCALARS[table.kind]
        column = table.column or kind.quantity
        measured = columns.numbers(column, dimension)
        if table.kind in _POSITIVE:
            _require_positive(columns, column, measured)
        at |= self._conditions(columns, {column, _ERROR, *table.ignore})
        shared: dict[str, Any] = {"roller": table.roller} if kind in (Torques, Feeds) else {}
        with self._placed(where):
            return kind(
                at=at,
                measured=measured,
                standard_error=self._errors(where, table, columns, dimension),
                weight=table.weight,
                name=table.name or kind.quantity,
                rows=row_names(Path(columns.source).name, columns.lines),
                **shared,
            )

    def _impressions(
        self, where: str, table: DataTable, columns: TableColumns, at: dict[str, Any]
    ) -> Impressions:
        if "face" not in self.case:
            raise CaseFileError(
                f"{self.source}: {where}: an impression needs a table [face] in the case."
            )
        column = table.column or "width"
        measured = columns.numbers(column, "length")
        _require_positive(columns, column, measured)
        y = columns.numbers("y", "length")
        at |= self._conditions(columns, {"y", column, _ERROR, *table.ignore})
        if "face.length" not in {*at, *(one.path for one in self.table.unknowns)}:
            self._require_on_face(columns, y)
        with self._placed(where):
            return Impressions(
                y=y,
                measured=measured,
                standard_error=self._errors(where, table, columns, "length"),
                at=at,
                weight=table.weight,
                name=table.name,
                rows=row_names(Path(columns.source).name, columns.lines),
            )

    def _require_on_face(self, columns: TableColumns, y: NDArray[np.float64]) -> None:
        """Raise InvalidInputError where a place lies outside the face of the case."""
        with self._placed("case: face.length"):
            half = 0.5 * parse_quantity(
                self.case["face"].get("length", inf), "length", infinite=True
            )
        for line, place in zip(columns.lines, y, strict=True):
            if not abs(place) <= half * (1.0 + 1e-9):
                raise InvalidInputError(
                    f'{columns.source}, line {line}: "y" must lie on the face, within {half:g} mm '
                    f"of its middle, got {place:g}."
                )

    def _strains(
        self, where: str, table: DataTable, columns: TableColumns, at: dict[str, Any]
    ) -> Strains:
        column = table.column or "strain"
        self._conditions(columns, {"x", column, _ERROR, *table.ignore}, allowed=False)
        with self._placed(where):
            return Strains(
                x=columns.numbers("x", "length"),
                measured=columns.numbers(column, "ratio"),
                standard_error=self._errors(where, table, columns, "ratio"),
                at=at,
                weight=table.weight,
                name=table.name,
                rows=row_names(Path(columns.source).name, columns.lines),
                roller=table.roller,
                width=table.width,
            )

    def _velocities(self, where: str, table: DataTable, at: dict[str, Any]) -> Velocities:
        readings = read_velocities(self.folder / table.file)
        settings = Settings(roller=table.roller).over(readings.settings)
        with self._placed(where):
            return Velocities(
                profile=readings.profile(settings),
                at=at,
                weight=table.weight,
                name=table.name,
                roller=table.roller,
                width=table.width or settings.averaging_width,
            )

    def _errors(
        self, where: str, table: DataTable, columns: TableColumns, dimension: Dimension
    ) -> Any:
        """Return the standard errors from the key or the column; None where there is neither."""
        if table.standard_error is not None:
            with self._placed(f"{where}.standard_error"):
                return _difference(table.standard_error, dimension)
        return columns.numbers(_ERROR, dimension) if _ERROR in columns.names else None

    def _conditions(
        self, columns: TableColumns, known: set[str], *, allowed: bool = True
    ) -> dict[str, Any]:
        """Return all other columns as values of the case by path; those in [nip] may be short."""
        found: dict[str, Any] = {}
        for name in columns.names:
            if name in known:
                continue
            short = name.lower().replace(" ", "_")
            path = f"nip.{short}" if short in _SHORT else name
            hint = f"; to pass over it, put it into `ignore` ({self.source})."
            if not allowed:
                raise InvalidInputError(f'{columns.source}: column "{name}" has no use here{hint}')
            try:
                dimension = dimension_at(self.case, path)
            except InvalidInputError as problem:
                said = str(problem).rstrip(".?")
                raise InvalidInputError(
                    f'{columns.source}: column "{name}": {said}{hint}'
                ) from None
            if dimension is None:
                raise InvalidInputError(f'{columns.source}: column "{name}" is no number{hint}')
            found[path] = columns.numbers(name, dimension)
        return found

    def _single(self, path: str, value: Any) -> float:
        dimension = dimension_at(self.case, path)
        if dimension is None:
            raise InvalidInputError(f"`{path}` is no number of the case.")
        return read_quantity(value, dimension)

    @contextmanager
    def _placed(self, where: str) -> Iterator[None]:
        """Prefix an input error raised inside the block with the file and the key, once."""
        try:
            yield
        except InvalidInputError as problem:
            if str(problem).startswith(f"{self.source}: "):
                raise
            raise InvalidInputError(f"{self.source}: {where}: {problem}") from None


def _require_positive(columns: TableColumns, name: str, values: NDArray[np.float64]) -> None:
    for line, value in zip(columns.lines, values, strict=True):
        if not value > 0.0:
            raise InvalidInputError(
                f'{columns.source}, line {line}: "{name}" must be positive, got {value:g}.'
            )


def _difference(value: Any, dimension: Dimension) -> float:
    """Return a standard error; for temperatures it is a difference, whose unit has no offset."""
    kind: Dimension = "temperature difference" if dimension == "temperature" else dimension
    error = parse_quantity(value, kind)
    if not 0.0 < error < np.inf:
        raise InvalidInputError(f"must be positive and finite, got {value}.")
    return error
