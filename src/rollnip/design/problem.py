"""The optimisation problem: cases of one tree that differ in parameters, in base units."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rollnip._errors import InvalidInputError
from rollnip._units import base_unit, format_quantity
from rollnip.design.aims import (
    LeastChange,
    Limit,
    Objective,
    excess_over,
    require_consistent,
)
from rollnip.design.quantities import parameter_dimension, read_parameter, result_error
from rollnip.design.root import Evaluate
from rollnip.design.search import Array, Trial
from rollnip.io import value_at, with_values

_DIGITS = 8
_SHOWN = 5
_MOST = 20


@dataclass(frozen=True, slots=True)
class Bounds:
    """A parameter and its limits: numbers in base units, or texts with their unit."""

    path: str
    low: float | str
    high: float | str


class Problem:
    """An optimisation problem in base units."""

    def __init__(
        self,
        case: Mapping[str, Any],
        parameters: tuple[Bounds, ...],
        objective: Objective,
        limits: tuple[Limit, ...],
        evaluate: Evaluate,
    ) -> None:
        if not 1 <= len(parameters) <= _MOST:
            raise InvalidInputError(
                f"`parameters` must hold 1 to {_MOST} parameters, got {len(parameters)}."
            )
        require_consistent(limits)
        self.case, self.objective, self.limits = case, objective, limits
        self.evaluate = evaluate
        if isinstance(objective, LeastChange):
            _number_at(case, objective.against)
        self.paths = tuple(one.path for one in parameters)
        twice = next((path for path in self.paths if self.paths.count(path) > 1), None)
        if twice is not None:
            raise InvalidInputError(f"`parameters` must not name {twice} twice.")
        self.units = tuple(base_unit(parameter_dimension(case, path)) for path in self.paths)
        bounds = [limits_of(case, one) for one in parameters]
        with_values(case, dict(zip(self.paths, (low for low, _ in bounds), strict=True)))
        self.low, self.high = (np.array(ends) for ends in zip(*bounds, strict=True))

    @property
    def start(self) -> Array | None:
        """The case's own values as a place in the unit cube; None where one is out of bounds."""
        try:
            own = [
                read_parameter(
                    "path", value_at(self.case, path), parameter_dimension(self.case, path)
                )
                for path in self.paths
            ]
        except InvalidInputError:
            return None
        place = (np.array(own) - self.low) / (self.high - self.low)
        return place if np.all((place >= 0.0) & (place <= 1.0)) else None

    def values(self, place: Array) -> dict[str, float]:
        """Return values by path at shares of the intervals: 8 digits, within the bounds."""
        values = self.low + place * (self.high - self.low)
        rounded = (float(f"{value:.{_DIGITS}g}") for value in values)
        inside = np.clip(list(rounded), self.low, self.high)
        return dict(zip(self.paths, map(float, inside), strict=True))

    def solve(self, values: Mapping[str, float]) -> Mapping[str, Any]:
        """Return the results of one case, with those that the objective adds."""
        tree = with_values(self.case, values)
        row = self.evaluate(tree)
        if isinstance(self.objective, LeastChange) and row["converged"]:
            return self._with_change(self.objective, tree, row)
        return row

    def _with_change(
        self, objective: LeastChange, tree: Mapping[str, Any], row: Mapping[str, Any]
    ) -> Mapping[str, Any]:
        """Return a row with the change of a result; not converged where the change is unknown."""
        path, share = objective.against, objective.share
        number = _number_at(tree, path)
        steps = [(1.0 - share) * number, (1.0 + share) * number]
        ends = [self.evaluate(with_values(tree, {path: one})) for one in steps]
        for value, end in zip(steps, ends, strict=True):
            fault = str(end["message"])
            if end["converged"] and end.get("geometry") != row.get("geometry"):
                fault = f'only geometry "{end["geometry"]}" has a solution there.'
            elif end["converged"]:
                continue
            return {**row, "converged": False, "message": f"with {path} = {value:.6g}: {fault}"}
        both = [end[objective.quantity] for end in ends]
        if None in both:
            return {**row, objective.key: None}
        errors = [result_error(end, objective.quantity) or 0.0 for end in ends]
        return {
            **row,
            objective.key: objective.change(*both),
            f"error.{objective.key}": objective.change(-errors[0], errors[1]),
        }

    def fault(self, row: Mapping[str, Any]) -> str:
        """Return why a row cannot be used; empty where it can."""
        if not row["converged"]:
            return str(row["message"])
        names = [self.objective.key, *(limit.quantity for limit in self.limits)]
        missing = next((name for name in names if row[name] is None), None)
        return f"`{missing}` is not defined there." if missing else ""

    def judge(self, place: Array) -> Trial:
        """Solve the case at a place in the unit cube and return its cost and limit violations."""
        found = self.values(place)
        row, values = self.solve(found), tuple(found.values())
        fault = self.fault(row)
        if fault:
            beyond = (float("inf"),) * len(self.limits)
            return Trial(place, float("inf"), beyond, values, fault)
        sign = -1.0 if self.objective.sense == "maximise" else 1.0
        excess = tuple(excess_over(limit, row[limit.quantity]) for limit in self.limits)
        return Trial(place, sign * row[self.objective.key], excess, values)

    def by_path(self, trial: Trial) -> dict[str, float]:
        """Return the values of a trial by path."""
        return dict(zip(self.paths, trial.values, strict=True))

    def require_some(self, trials: Sequence[Trial]) -> None:
        """Raise InvalidInputError where every case failed."""
        if any(not trial.fault for trial in trials):
            return
        first = trials[0]
        raise InvalidInputError(
            f"Not one of {len(trials)} cases could be solved; at "
            f"{self.said(self.by_path(first))}: {first.fault}"
        )

    def said(self, values: Mapping[str, float]) -> str:
        """Return values by path, in words."""
        return ", ".join(
            f"{path} = {format_quantity(values[path], unit, digits=_SHOWN)}"
            for path, unit in zip(self.paths, self.units, strict=True)
        )


def _number_at(case: Mapping[str, Any], path: str) -> float:
    """Return the number of a case at a path, which is varied by shares of itself."""
    dimension = parameter_dimension(case, path)
    number = read_parameter("against", value_at(case, path), dimension)
    if number == 0.0:
        raise InvalidInputError(f"`against` must name a number that is not 0, {path} is 0.")
    return number


def limits_of(case: Mapping[str, Any], bounds: Bounds) -> tuple[float, float]:
    """Return both bounds in base units; raise InvalidInputError where they cannot be read."""
    dimension = parameter_dimension(case, bounds.path)
    low = read_parameter("low", bounds.low, dimension)
    high = read_parameter("high", bounds.high, dimension)
    if not low < high:
        unit = base_unit(dimension)
        raise InvalidInputError(
            f"`low` must be below `high` for {bounds.path}, got {format_quantity(low, unit)} and "
            f"{format_quantity(high, unit)}."
        )
    return low, high
