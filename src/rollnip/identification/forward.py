"""Predictions of the measurements from values of the unknowns, with one solve for each nip."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any, Protocol, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError, RollnipError
from rollnip.face import NipRows, solve_face
from rollnip.identification.costs import Measurements, Scalars
from rollnip.identification.unknowns import Unknown
from rollnip.io import Case, case_hash, dimension_at, parse_case, with_values
from rollnip.model import Model
from rollnip.solution import Solution
from rollnip.solver import geometry_for, solve

Array = NDArray[np.float64]
Predictions = tuple[Array, ...]
_A = TypeVar("_A")
_B = TypeVar("_B")


class Predictor(Protocol):
    """A predictor of the measurements at given values of the unknowns."""

    def predict(self, values: Mapping[str, float]) -> Predictions | None:
        """Return the predictions of each set; None where there are none at these values."""


class Workforce(Protocol):
    """A solver of many nips, possibly in parallel; `rollnip.sweeps.Together` is one."""

    @property
    def evaluate(self) -> Callable[[Mapping[str, Any]], Mapping[str, Any]]:
        """The function that solves one case, as `rollnip.sweeps.evaluate` does."""
        ...

    def each(self, function: Callable[[_A], _B], items: Sequence[_A], /) -> list[_B]:
        """Call a function with every item, possibly in parallel; return the results in order."""
        ...


class Numbers:
    """The numbers of a solution as attributes, from a row of `rollnip.sweeps.evaluate`."""

    def __init__(self, row: Mapping[str, Any]) -> None:
        self._row = row
        self.converged = bool(row["converged"])

    @property
    def sheet(self) -> Numbers:
        """The numbers of the sheet."""
        mine = {key: value for key, value in self._row.items() if key.startswith("sheet.")}
        named = {key.removeprefix("sheet."): value for key, value in mine.items()}
        return Numbers({"converged": self.converged, **named})

    def __getattr__(self, name: str) -> Any:
        """Return a number; None where it is not defined."""
        row: Mapping[str, Any] = self.__dict__["_row"]
        if name not in row:
            raise AttributeError(name)
        return row[name]


class Forward:
    """Predictions by solving nips.

    Parameters
    ----------
    tree :
        the case.
    parts :
        the sets of measurements.
    overrides :
        values by path for every nip: geometry and tolerance.
    on_solve :
        called after each nip with the number solved so far.
    workforce :
        what solves the nips of which only numbers are needed, such as several processes or a
        database; None: this process, one nip after the other.
    """

    def __init__(
        self,
        tree: Mapping[str, Any],
        parts: tuple[Measurements, ...],
        overrides: Mapping[str, Any],
        on_solve: Callable[[int], None] | None = None,
        workforce: Workforce | None = None,
    ) -> None:
        self.tree = with_values(tree, overrides)
        self.parts = parts
        self.solves = 0
        self.unverified = 0
        self.refused = ""
        self.is_verified = True  # whether all nips of the last prediction were verified
        self.fallbacks = 0  # number of solves in another geometry than wanted
        self._on_solve = on_solve
        self._rows = NipRows()
        self._workforce = workforce

    def predict(self, values: Mapping[str, float]) -> Predictions | None:
        """Return the predictions of each set; None, and why in ``refused``, without a solution."""
        known: dict[str, Solution | Numbers] = {}
        self.is_verified, self.fallbacks = True, 0
        try:
            if self._workforce is not None:
                self._solve_together(self._workforce, values, known)
            predictions = tuple(self._predict(part, values, known) for part in self.parts)
        except RollnipError as problem:
            self.refused = str(problem)
            return None
        except (ArithmeticError, np.linalg.LinAlgError) as problem:
            self.refused = f"The solver failed: {problem}."  # at values far from any real nip
            return None
        for part, prediction in zip(self.parts, predictions, strict=True):
            if not np.all(np.isfinite(prediction)):
                self.refused = f"{part.quantity} is not defined in this nip."
                return None
        return predictions

    def _solve_together(
        self,
        workforce: Workforce,
        values: Mapping[str, float],
        known: dict[str, Solution | Numbers],
    ) -> None:
        """Solve the nips of all sets that need only numbers, in parallel where possible."""
        trees: dict[str, dict[str, Any]] = {}
        for part in (one for one in self.parts if isinstance(one, Scalars)):
            for row in part.conditions:
                tree = with_values(self.tree, {**values, **row})
                trees[case_hash(parse_case(tree))] = tree
        rows = workforce.each(workforce.evaluate, list(trees.values()))
        for key, found in zip(trees, rows, strict=True):
            if found["geometry"] is None:
                raise InvalidInputError(str(found["message"]))
            known[key] = Numbers(found)
            wanted = _geometry_of(parse_case(trees[key]))
            self._count(known[key].converged, found["geometry"] != wanted)

    def _count(self, converged: bool, is_fallback: bool) -> None:
        self.solves += 1
        self.fallbacks += is_fallback
        if not converged:
            self.unverified, self.is_verified = self.unverified + 1, False
        if self._on_solve is not None:
            self._on_solve(self.solves)

    def _predict(
        self,
        part: Measurements,
        values: Mapping[str, float],
        known: dict[str, Solution | Numbers],
    ) -> Array:
        if part.along_face:
            return part.predict([self._face(values, row) for row in part.conditions])
        found = [self._solved(values, row, known) for row in part.conditions]
        return part.predict(cast("list[Solution]", found))

    def _face(self, values: Mapping[str, float], row: Mapping[str, Any]) -> Any:
        """Return the solution of one face; faces share the cross-sections that were solved."""
        case = parse_case(with_values(self.tree, {**values, **row}))
        if case.face is None:
            raise InvalidInputError("The case must have a table [face] to fit an impression.")
        found = solve_face(case.nip, case.face, case.model, rows=self._rows)
        self._count(found.converged, False)
        return found

    def _solved(
        self,
        values: Mapping[str, float],
        row: Mapping[str, Any],
        known: dict[str, Solution | Numbers],
    ) -> Solution | Numbers:
        """Return the solution of one nip; nips with equal values are solved once."""
        case = parse_case(with_values(self.tree, {**values, **row}))
        key = case_hash(case)
        if key not in known:
            found = solve(case.nip, case.model, on_failure="return")
            known[key] = found
            self._count(found.converged, found.model.geometry != _geometry_of(case))
        return known[key]


def _geometry_of(case: Case) -> str:
    """Return the geometry in which the nip of a case is solved."""
    return geometry_for(case.nip, case.model)


def check_paths(
    tree: Mapping[str, Any], unknowns: Sequence[Unknown], parts: Sequence[Measurements]
) -> None:
    """Raise InvalidInputError where a path is not a number of the case, or is used twice."""
    paths = [one.path for one in unknowns]
    for path in paths:
        if dimension_at(tree, path) is None:
            raise InvalidInputError(f"`{path}` must be a number of the case to be an unknown.")
        if paths.count(path) > 1:
            raise InvalidInputError(f"`{path}` must be among the unknowns once only.")
    for part in parts:
        for path in part.at:
            dimension_at(tree, path)
            if path in paths:
                raise InvalidInputError(
                    f"`{path}` must not be an unknown: the {part.quantity} was measured at "
                    "known values of it."
                )


def model_of(tree: Mapping[str, Any], geometry: str | None, tolerance: float | None) -> Model:
    """Return the model of the case, with geometry and tolerance replaced where they are given."""
    model = parse_case(tree).model
    changed: dict[str, Any] = {"geometry": geometry, "tolerance": tolerance}
    return replace(model, **{name: value for name, value in changed.items() if value is not None})
