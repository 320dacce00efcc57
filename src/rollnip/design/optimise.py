"""The best values of a few parameters: one result small or large, others within limits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Literal

import numpy as np

from rollnip._units import format_quantity
from rollnip.design.aims import Limit, LimitKept, Maximise, Objective, standing
from rollnip.design.find import Evaluate
from rollnip.design.problem import Bounds, Problem
from rollnip.design.quantities import QUANTITIES, json_tree, result_error
from rollnip.design.search import Array, Search, Trial, search_cube
from rollnip.io import with_values
from rollnip.sweep import evaluate as evaluated

_DIGITS = 8
_SHOWN = 5
_AT_BOUND = 2e-3  # of the interval
_AS_GOOD = 0.01  # of the objective


@dataclass(frozen=True, slots=True, kw_only=True)
class Chosen:
    """A parameter of an optimum, in base units.

    Attributes
    ----------
    path, unit, low, high : the parameter and its bounds.
    value : at the optimum.
    at : the bound it stands at, "low" or "high"; None: inside.
    as_good : from where to where it was in cases that keep all limits with an objective within
        1 % of the best: how well it is determined; (value, value) where only the optimum is.
    """

    path: str
    unit: str
    low: float
    high: float
    value: float
    at: Literal["low", "high"] | None
    as_good: tuple[float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Optimum:
    """What `optimise` found.

    Attributes
    ----------
    is_feasible : whether the case keeps all limits, by a solve of its own.
    chosen : the parameters.
    quantity, unit, sense : the objective; "minimise" or "maximise".
    value, error : the objective at the optimum, by a solve of its own; the solver's estimate of
        its error, None without one.
    limits : how each limit stands; of an infeasible answer, the case nearest to keeping them.
    solves : how many cases were solved, the last included.
    failures : (values by path, message) of those that could not be.
    trials : (values by path, objective, whether all limits are kept) of every solved case in turn.
    scalars : all results at the optimum, as `rollnip.sweep.evaluate` returns them.
    case : the case with the chosen values.
    message : what was found, in a few sentences.
    """

    is_feasible: bool
    chosen: tuple[Chosen, ...]
    quantity: str
    unit: str
    sense: Literal["minimise", "maximise"]
    value: float | None
    error: float | None
    limits: tuple[LimitKept, ...]
    solves: int
    failures: tuple[tuple[Mapping[str, float], str], ...]
    trials: tuple[tuple[Mapping[str, float], float, bool], ...]
    scalars: Mapping[str, Any]
    case: Mapping[str, Any]
    message: str

    def as_dict(self) -> dict[str, Any]:
        """All of it as plain values, for JSON."""
        found: dict[str, Any] = json_tree(asdict(self))
        return found


def optimise(
    case: Mapping[str, Any],
    parameters: Sequence[Bounds],
    objective: Objective,
    limits: Sequence[Limit] = (),
    *,
    search: Search | None = None,
    evaluate: Evaluate = evaluated,
) -> Optimum:
    """Find the values of a few parameters that make one result as small or large as can be.

    The whole box is searched by differential evolution, the best of it followed to the nearest
    optimum by COBYQA; both keep the limits on results. A case that cannot be solved counts as
    worse than any other, and is reported. The answer is solved afresh.

    Parameters
    ----------
    case : tree of a case file; stays as it was.
    parameters : paths with their bounds, 1 to 20; a few are found well.
    objective : ``Minimise("peak_pressure")`` or ``Maximise("nip_width")``.
    limits : ``AtLeast("nip_width", "8 mm")``, ``AtMost("peak_pressure", "0.5 MPa")``.
    search : how; ``Search()`` by default.
    evaluate : solves one case; for tests, and for programs that keep count.

    Returns
    -------
    Optimum; ``is_feasible`` is False where no case was found that keeps all limits.

    Raises
    ------
    InvalidInputError
        for unknown paths, bounds that cannot be read or are the wrong way round, limits that
        contradict each other, or where not one case could be solved.
    """
    problem = Problem(case, tuple(parameters), objective, tuple(limits), evaluate)
    best, trials = search_cube(
        problem.judge, problem.start, len(problem.paths), Search() if search is None else search
    )
    problem.require_some()
    values = _rounded(problem, best.at)
    return _answer(problem, values, problem.solve(values), trials)


def _rounded(problem: Problem, place: Array) -> dict[str, float]:
    """Values by path to 8 digits, within the bounds."""
    values = problem.values(place)
    ends = zip(values.items(), problem.low, problem.high, strict=True)
    return {
        path: min(max(float(f"{value:.{_DIGITS}g}"), float(low)), float(high))
        for (path, value), low, high in ends
    }


def _answer(
    problem: Problem,
    values: dict[str, float],
    row: Mapping[str, Any],
    trials: tuple[Trial, ...],
) -> Optimum:
    objective = problem.objective
    sign = -1.0 if isinstance(objective, Maximise) else 1.0
    limits: tuple[LimitKept, ...] = ()
    if not problem.fault(row):
        limits = tuple(
            standing(limit, row, result_error(row, limit.quantity)) for limit in problem.limits
        )
    is_feasible = not problem.fault(row) and all(limit.is_kept for limit in limits)
    chosen = _chosen(problem, values, trials, sign * (row[objective.quantity] or 0.0))
    return Optimum(
        is_feasible=is_feasible,
        chosen=chosen,
        quantity=objective.quantity,
        unit=QUANTITIES[objective.quantity],
        sense="maximise" if isinstance(objective, Maximise) else "minimise",
        value=row[objective.quantity],
        error=result_error(row, objective.quantity),
        limits=limits,
        solves=problem.count,
        failures=tuple(problem.failures),
        trials=tuple(
            (problem.values(trial.at), sign * trial.cost, trial.violation == 0.0)
            for trial in trials
            if np.isfinite(trial.cost)
        ),
        scalars=dict(row),
        case=with_values(problem.case, values),
        message=" ".join(_sentences(problem, values, row, limits, chosen)),
    )


def _chosen(
    problem: Problem, values: Mapping[str, float], trials: Sequence[Trial], cost: float
) -> tuple[Chosen, ...]:
    allowed = cost + _AS_GOOD * abs(cost)
    good = [one.at for one in trials if one.violation == 0.0 and one.cost <= allowed]
    chosen = []
    for index, path in enumerate(problem.paths):
        low, high, value = float(problem.low[index]), float(problem.high[index]), values[path]
        near = _AT_BOUND * (high - low)
        also = [low + float(place[index]) * (high - low) for place in good]
        chosen.append(
            Chosen(
                path=path,
                unit=problem.units[index],
                low=low,
                high=high,
                value=value,
                at="low" if value - low <= near else "high" if high - value <= near else None,
                as_good=(min([value, *also]), max([value, *also])),
            )
        )
    return tuple(chosen)


def _sentences(
    problem: Problem,
    values: Mapping[str, float],
    row: Mapping[str, Any],
    limits: Sequence[LimitKept],
    chosen: Sequence[Chosen],
) -> list[str]:
    fault = problem.fault(row)
    if fault:
        return [
            f"The best case found could not be solved once more, at {problem.said(values)}: {fault}"
        ]
    quantity = problem.objective.quantity
    value = format_quantity(row[quantity], QUANTITIES[quantity], digits=_SHOWN)
    broken = [one for one in limits if not one.is_kept]
    if broken:
        missed = "; ".join(
            f"{one.quantity} is {_shown(one.value, one)} there, not {one.sense} "
            f"{_shown(one.limit, one)}"
            for one in broken
        )
        said = [
            f"No case was found that keeps all limits. The nearest: {problem.said(values)}, "
            f"with {quantity} = {value}; {missed}."
        ]
    else:
        goal = "largest" if isinstance(problem.objective, Maximise) else "smallest"
        said = [f"{quantity} is {goal}, {value}, at {problem.said(values)}."]
        said += [
            f"The limit decides: {one.quantity} {one.sense} {_shown(one.limit, one)}."
            for one in limits
            if one.is_active
        ]
    said += [
        f"{one.path} stands at its {'lower' if one.at == 'low' else 'upper'} bound."
        for one in chosen
        if one.at
    ]
    if problem.failures:
        at, message = problem.failures[0]
        said.append(
            f"{len(problem.failures)} of {problem.count} cases could not be solved; at "
            f"{problem.said(at)}: {message}"
        )
    return said


def _shown(value: float, limit: LimitKept) -> str:
    return format_quantity(value, limit.unit, digits=_SHOWN)
