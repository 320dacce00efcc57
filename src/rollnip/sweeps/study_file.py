"""The reader of study files: paths, values and units are checked, every fault is one clear line."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from difflib import get_close_matches
from math import prod
from pathlib import Path
from typing import Any

import numpy as np

from rollnip._errors import CaseFileError, InvalidInputError, RollnipError
from rollnip._units import Dimension, base_unit
from rollnip.figures import PROFILES
from rollnip.io import TableColumns, dimension_at, read_columns, value_at
from rollnip.io.document import folder_of, plain_tree, read_document
from rollnip.io.forms import read_quantity
from rollnip.io.patch_case import any_case
from rollnip.io.study import ParameterTable, StudyTable, parse_study
from rollnip.sweeps.row import SCALARS
from rollnip.sweeps.sampling import Range, samples
from rollnip.sweeps.study import Axis, Column, Study

MOST_CASES = 10**8
_EITHER = (
    ("nip.load", "nip.approach"),
    ("nip.traction", "nip.creepage", "nip.torque_lower"),
    ("nip.lateral_traction", "nip.lateral_creepage"),
)


def read_study(study: str | Path | Mapping[str, Any]) -> Study:
    """Read a study file, TOML or JSON, or the tree that such a file holds.

    Names of other files in it are relative to the folder of the study, or to the working directory
    where ``study`` is a tree.

    Raises
    ------
    CaseFileError
        where a file cannot be read or does not describe a study; the message names the file and the
        path of the key.
    InvalidInputError
        where a table of designs is wrong; the message names the file, line and column.
    """
    if isinstance(study, Mapping):
        return _StudyReader(plain_tree(study), "study", Path()).study()
    tree = read_document(study, name="study")
    return _StudyReader(tree, str(study), folder_of(study)).study()


class _StudyReader:
    def __init__(self, tree: Mapping[str, Any], source: str, folder: Path) -> None:
        self.table: StudyTable = parse_study(tree, source)
        self.source = source
        self.folder = folder
        self.case, self.case_source = self._case()

    def study(self) -> Study:
        axes = self._axes()
        self._check_paths([path for axis in axes for path in axis.paths])
        _require_few(self.source, prod(len(axis) for axis in axes))
        study = Study(
            title=self.table.title or str(self.case.get("title", "")),
            tree=self.case,
            axes=axes,
            results=self._names("results", self.table.results, self._scalars()),
            profiles=self._profiles(),
            source=self.source,
        )
        self._check_cases(study)
        return study

    def _profiles(self) -> tuple[str, ...]:
        """Return the names of the profiles wanted; a patch has no profiles over x alone."""
        if "patch" in self.case and self.table.profiles:
            raise self._wrong("profiles: must be left out where the case has a table [patch].")
        return self._names("profiles", self.table.profiles or [], PROFILES)

    def _scalars(self) -> dict[str, str]:
        """Return the results that the cases have; those of face, heat and sheet need that table.

        A case with a patch has only the results of the patch.
        """
        if "patch" in self.case:
            return {name: unit for name, unit in SCALARS.items() if name.startswith("patch.")}
        tables = ("face", "heat", "patch", "sheet")
        absent = [f"{table}." for table in tables if table not in self.case]
        return {
            name: unit
            for name, unit in SCALARS.items()
            if not name.removeprefix("error.").startswith(tuple(absent))
        }

    def _case(self) -> tuple[dict[str, Any], str]:
        given = self.table.case
        if isinstance(given, str):
            path = self.folder / given
            return read_document(path), str(path)
        if not isinstance(given, dict):
            raise self._wrong("case: must be the name of a case file, or a table.")
        return given, f"{self.source}: case"

    def _axes(self) -> tuple[Axis, ...]:
        """Return the axes: one for all sampled ranges, one for each group or other parameter."""
        if not self.table.parameters:
            raise self._wrong("parameters: must hold at least one parameter, holds none.")
        parts: dict[str, list[Axis]] = {}
        sampled: list[tuple[str, ParameterTable, Range]] = []
        for index, parameter in enumerate(self.table.parameters):
            where = f"parameters[{index}]"
            kind = self._kind(where, parameter)
            if kind == "sampled":
                parts.setdefault("sampled", [])
                sampled.append((where, parameter, self._range(where, parameter)))
                continue
            name = f"group {parameter.group}" if parameter.group is not None else where
            parts.setdefault(name, []).append(self._axis(where, parameter, kind))
        self._check_sampling(bool(sampled))
        if sampled:
            parts["sampled"] = [self._sampled(sampled)]
        return tuple(self._joined(name, axes) for name, axes in parts.items())

    def _kind(self, where: str, parameter: ParameterTable) -> str:
        """Return the kind of a parameter: values, start (a range with count), sampled or table."""
        given = [name for name in ("values", "start", "table") if _has(parameter, name)]
        if len(given) != 1:
            got = " and ".join(given) or "none"
            raise self._wrong(f"{where}: must hold one of values, start and table, got {got}.")
        kind = given[0]
        allowed = {
            "values": {"path", "values", "group"},
            "start": {"path", "start", "stop", "count", "spacing", "group"},
            "table": {"table", "sheet", "group"},
        }[kind]
        for name in sorted(parameter.model_fields_set - allowed):
            raise self._wrong(f"{where}.{name}: has no meaning beside `{kind}`; leave it out.")
        needed = {"values": ("path",), "start": ("path", "stop"), "table": ()}[kind]
        for name in needed:
            if not _has(parameter, name):
                raise self._wrong(f"{where}.{name}: is missing.")
        if kind == "start" and parameter.count is None:
            if parameter.group is not None:
                raise self._wrong(f"{where}.count: is missing; a group needs it.")
            return "sampled"
        return kind

    def _check_sampling(self, is_sampled: bool) -> None:
        sampling = self.table.sampling
        if is_sampled and sampling.method == "grid":
            raise self._wrong(
                "parameters: a range has no `count`; give one, or choose [sampling] method = "
                '"latin-hypercube" or "sobol" with a count there.'
            )
        if is_sampled and sampling.count is None:
            raise self._wrong("sampling.count: is missing.")
        if not is_sampled and (sampling.method != "grid" or sampling.count is not None):
            raise self._wrong(
                "sampling: there is nothing to sample; leave out the `count` of the ranges that "
                "are to be sampled."
            )
        if sampling.seed < 0:
            raise self._wrong(f"sampling.seed: must be zero or positive, got {sampling.seed}.")

    def _axis(self, where: str, parameter: ParameterTable, kind: str) -> Axis:
        if kind == "table":
            return self._from_table(parameter)
        path = str(parameter.path)
        dimension = self._dimension(f"{where}.path", path)
        if kind == "values":
            column = self._values(where, parameter.values or [], dimension)
        else:
            count = parameter.count or 0
            if count < 2:
                raise self._wrong(f"{where}.count: must be 2 or more, got {parameter.count}.")
            _require_few(f"{self.source}: {where}.count", count)
            column = self._range(where, parameter).steps(count)
        return Axis((path,), (_unit(dimension),), (column,))

    def _values(self, where: str, values: Sequence[Any], dimension: Dimension | None) -> Column:
        if not values:
            raise self._wrong(f"{where}.values: must hold at least one value, holds none.")
        if dimension is None:
            return tuple(json.dumps(value, default=str) for value in values)
        numbers = []
        for index, value in enumerate(values):
            with self._placed(f"{where}.values[{index}]"):
                numbers.append(read_quantity(value, dimension, infinite=True))
        return np.array(numbers, dtype=np.float64)

    def _range(self, where: str, parameter: ParameterTable) -> Range:
        dimension = self._dimension(f"{where}.path", str(parameter.path))
        if dimension is None:
            raise self._wrong(f"{where}: {parameter.path} is no quantity; give `values`.")
        ends = []
        for name in ("start", "stop"):
            with self._placed(f"{where}.{name}"):
                ends.append(read_quantity(getattr(parameter, name), dimension))
        with self._placed(where):
            return Range(ends[0], ends[1], parameter.spacing)

    def _sampled(self, parameters: list[tuple[str, ParameterTable, Range]]) -> Axis:
        sampling = self.table.sampling
        assert sampling.method != "grid"
        _require_few(f"{self.source}: sampling.count", sampling.count or 0)
        paths = tuple(str(parameter.path) for _, parameter, _ in parameters)
        dimensions = [
            self._dimension(where, path)
            for (where, *_), path in zip(parameters, paths, strict=True)
        ]
        ranges = [one for *_, one in parameters]
        with self._placed("sampling"):
            columns = samples(ranges, sampling.method, sampling.count or 0, sampling.seed)
        return Axis(paths, tuple(_unit(dimension) for dimension in dimensions), columns)

    def _from_table(self, parameter: ParameterTable) -> Axis:
        """Return an axis whose parameters, the columns of a table of designs, change row by row."""
        table = read_columns(self.folder / str(parameter.table), sheet=parameter.sheet)
        paths, units, columns = table.names, [], []
        for path in paths:
            dimension = self._dimension(table.source, path)
            units.append(_unit(dimension))
            columns.append(_column(table, path, dimension))
        return Axis(paths, tuple(units), tuple(columns))

    def _joined(self, name: str, axes: list[Axis]) -> Axis:
        """Return one axis made from those of a group."""
        lengths = [len(axis) for axis in axes]
        if len(set(lengths)) > 1:
            raise self._wrong(
                f"parameters: those of {name} must have equally many values, have "
                f"{', '.join(map(str, lengths))}."
            )
        return Axis(
            tuple(path for axis in axes for path in axis.paths),
            tuple(unit for axis in axes for unit in axis.units),
            tuple(column for axis in axes for column in axis.columns),
        )

    def _check_paths(self, paths: list[str]) -> None:
        """Check that no two parameters set the same value, or one a part of the other."""
        for path in paths:
            if paths.count(path) > 1:
                raise self._wrong(f"parameters: {path} must not be there twice.")
            below = next((p for p in paths if p.startswith((f"{path}.", f"{path}["))), None)
            if below is not None:
                raise self._wrong(f"parameters: {below} is a part of {path}; leave one out.")
        for group in _EITHER:
            both = [path for path in paths if path in group]
            if len(both) > 1:
                raise self._wrong(
                    f"parameters: {' and '.join(both)} exclude each other; leave one out."
                )

    def _check_cases(self, study: Study) -> None:
        """Raise where a path leads nowhere, or the first and the last case are both invalid.

        In the latter instance the case itself is at fault, not the value of a parameter.
        """
        refused = []
        for position in (0, study.count - 1):
            try:
                any_case(study.case(position), f"{self.case_source} (case {position})")
            except InvalidInputError as error:
                raise self._wrong(f"parameters: {error}") from None
            except CaseFileError as error:
                refused.append(error)
        if len(refused) == 2:
            raise refused[0]

    def _dimension(self, where: str, path: str) -> Dimension | None:
        with self._placed(where):
            dimension = dimension_at(self.case, path)
            above = path.rpartition(".")[0]
            if above and above not in ("model", "solver"):
                value_at(self.case, above)
            return dimension

    def _names(
        self, key: str, wanted: Sequence[str] | None, known: Mapping[str, object]
    ) -> tuple[str, ...]:
        if wanted is None:
            return tuple(known)
        for index, name in enumerate(wanted):
            if name not in known:
                near = get_close_matches(name, known, n=1)
                hint = f'did you mean "{near[0]}"?' if near else f"known: {', '.join(known)}."
                raise self._wrong(f'{key}[{index}]: there is no "{name}"; {hint}')
            if name in wanted[:index]:
                raise self._wrong(f'{key}[{index}]: "{name}" must not be there twice.')
        return tuple(wanted)

    @contextmanager
    def _placed(self, where: str) -> Iterator[None]:
        """Prefix an input error raised inside the block with the file and the key."""
        try:
            yield
        except InvalidInputError as error:
            raise self._wrong(f"{where}: {error}") from None

    def _wrong(self, line: str) -> RollnipError:
        return CaseFileError(f"{self.source}: {line}")


def _require_few(where: str, count: int) -> None:
    if count > MOST_CASES:
        raise CaseFileError(
            f"{where}: must make at most {MOST_CASES:,} cases, makes {count:,}; part the study."
        )


def _has(parameter: ParameterTable, name: str) -> bool:
    return name in parameter.model_fields_set


def _unit(dimension: Dimension | None) -> str:
    """Return the base unit; "1" for ratios, empty where the value is no quantity."""
    return "" if dimension is None else base_unit(dimension) or "1"


def _column(table: TableColumns, path: str, dimension: Dimension | None) -> Column:
    if dimension is not None:
        return table.numbers(path, dimension)
    if table.unit(path):
        raise InvalidInputError(
            f'{table.source}: column "{path}" holds no quantities and must have no unit, '
            f'has "{table.unit(path)}".'
        )
    return tuple(json.dumps(cell) for cell in table.cells(path))
