"""The best values of a few parameters: one result small or large, others within limits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Literal

from rollnip._frames import Column, Frame, Framed, numbers
from rollnip._html import html_table
from rollnip._units import format_quantity
from rollnip.design.aims import Limit, LimitKept, Objective, standing
from rollnip.design.problem import Bounds, Problem
from rollnip.design.quantities import QUANTITIES, json_tree, result_error
from rollnip.design.root import Evaluate
from rollnip.design.search import (
    Each,
    LocalSearch,
    Search,
    Searched,
    Trial,
    in_turn,
    search_cube,
)
from rollnip.io import with_values
from rollnip.sweeps import evaluate as evaluated

_SHOWN = 5
_AT_BOUND = 2e-3  # distance over the interval, within which a value is at its bound
_AS_GOOD = 0.01  # relative change of the objective, within which a case is as good


@dataclass(frozen=True, slots=True, kw_only=True)
class Chosen:
    """A parameter of an optimum, in base units.

    Attributes
    ----------
    path, unit, low, high : the parameter and its bounds.
    value : at the optimum.
    at : the bound at which it lies, "low" or "high"; None: inside.
    as_good : range of its values in cases that keep all limits with an objective within 1 % of the
        best, which shows how well it is determined; (value, value) where only the optimum is.
    """

    path: str
    unit: str
    low: float
    high: float
    value: float
    at: Literal["low", "high"] | None
    as_good: tuple[float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class SearchEnd:
    """The end of one of the searches from different starts.

    Attributes
    ----------
    values : by path, the best that it tried.
    value : the objective there; None where nothing was solved.
    is_feasible : whether all limits are kept there.
    is_finished : whether it ended by its own tolerance, and not because the solves ran out.
    agrees : whether it keeps all limits with an objective within 1 % of the best of all.
    """

    values: Mapping[str, float]
    value: float | None
    is_feasible: bool
    is_finished: bool
    agrees: bool


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Optimum(Framed):
    """The answer of `optimise`.

    Attributes
    ----------
    is_feasible : whether the case keeps all limits, in a separate solve.
    is_finished : whether all searches ended by their own tolerance; False: the solves ran out.
    searches : the end of each search.
    chosen : the parameters.
    quantity, unit, sense : the objective; "minimise" or "maximise".
    value, error : the objective at the optimum, in a separate solve, and the solver's estimate of
        its error, None without one.
    limits : the state of each limit; for an infeasible answer, in the case that comes closest to
        keeping them.
    solves : number of cases tried, the last included.
    failures : (values by path, message) of those that could not be solved.
    trials : (values by path, objective, whether all limits are kept) of every solved case in order.
    scalars : all results at the optimum, as `rollnip.sweeps.evaluate` returns them.
    case : the case with the chosen values.
    message : what was found, in a few sentences.
    """

    is_feasible: bool
    is_finished: bool
    searches: tuple[SearchEnd, ...]
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

    def __repr__(self) -> str:
        return f"<Optimum: {self.message}>"

    def _repr_html_(self) -> str:
        rows = [
            [one.path, format_quantity(one.value, one.unit, digits=_SHOWN), one.at or ""]
            for one in self.chosen
        ]
        return html_table("Optimum", ("parameter", "value", "at bound"), rows, [self.message])

    def _frame(self) -> Frame:
        """Return every solved case: parameters, objective, and 1 where all limits are kept."""
        columns: dict[str, Column] = {
            one.path: numbers(values[one.path] for values, _, _ in self.trials)
            for one in self.chosen
        }
        columns[self.quantity] = numbers(value for _, value, _ in self.trials)
        columns["is_feasible"] = numbers(kept for _, _, kept in self.trials)
        units = {one.path: one.unit for one in self.chosen} | {self.quantity: self.unit}
        return Frame(columns, units, {"message": self.message, "case": dict(self.case)})

    def as_dict(self) -> dict[str, Any]:
        """Return all fields as plain values, for JSON."""
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
    each: Each = in_turn,
) -> Optimum:
    """Find the values of a few parameters that make one result as small or large as possible.

    Differential evolution searches the whole box; from its best places that are apart from each
    other COBYQA descends to the nearest optimum. Both keep the limits on results. Agreement of the
    searches is an indication, not a proof, that there is nothing better. A case that cannot be
    solved counts as worse than any other, and is reported. The answer is solved again.

    Parameters
    ----------
    case : tree of a case file; it is not changed.
    parameters : paths with their bounds, 1 to 20; the search is reliable for a few.
    objective : ``Minimise("peak_pressure")``, ``Maximise("nip_width")``, or
        ``LeastChange("sheet.feed_upper", "nip.load")``.
    limits : ``AtLeast("nip_width", "8 mm")``, ``AtMost("peak_pressure", "0.5 MPa")``.
    search : settings; ``Search()`` by default.
    evaluate : solves one case; for tests, and for programs that count solves.
    each : calls a function with several items. With that of `rollnip.sweeps.together`, and its
        ``evaluate``, several cases are solved in parallel. The answer is the same.

    Returns
    -------
    Optimum; ``is_feasible`` is False where no case was found that keeps all limits.

    Raises
    ------
    InvalidInputError
        for unknown paths, bounds that cannot be read or are in the wrong order, limits that
        contradict each other, or where not one case could be solved.
    """
    problem = Problem(case, tuple(parameters), objective, tuple(limits), evaluate)
    plan = Search() if search is None else search
    found = search_cube(problem.judge, problem.start, len(problem.paths), plan, each)
    problem.require_some(found.trials)
    return _answer(problem, found, problem.solve(problem.by_path(found.best)))


def _answer(problem: Problem, found: Searched, row: Mapping[str, Any]) -> Optimum:
    objective, trials, values = problem.objective, found.trials, problem.by_path(found.best)
    sign = -1.0 if objective.sense == "maximise" else 1.0
    limits: tuple[LimitKept, ...] = ()
    if not problem.fault(row):
        limits = tuple(
            standing(limit, row, result_error(row, limit.quantity)) for limit in problem.limits
        )
    is_feasible = not problem.fault(row) and all(limit.is_kept for limit in limits)
    cost = sign * (row.get(objective.key) or 0.0)
    chosen = _chosen(problem, values, trials, cost)
    ends = tuple(_end(problem, one, sign, cost) for one in found.ends)
    failures = tuple((problem.by_path(one), one.fault) for one in trials if one.fault)
    return Optimum(
        is_feasible=is_feasible,
        is_finished=found.is_finished,
        searches=ends,
        chosen=chosen,
        quantity=objective.key,
        unit=QUANTITIES[objective.quantity],
        sense=objective.sense,
        value=row.get(objective.key),
        error=result_error(row, objective.key),
        limits=limits,
        solves=len(trials) + 1,
        failures=failures,
        trials=tuple(
            (problem.by_path(trial), sign * trial.cost, trial.violation == 0.0)
            for trial in trials
            if not trial.fault
        ),
        scalars=dict(row),
        case=with_values(problem.case, values),
        message=" ".join(
            [
                *_sentences(problem, values, row, limits, chosen),
                *_agreement(problem, ends, is_feasible, found.is_finished),
                *_failed(problem, failures, len(trials) + 1),
            ]
        ),
    )


def _end(problem: Problem, one: LocalSearch, sign: float, best: float) -> SearchEnd:
    kept = one.best.violation == 0.0
    return SearchEnd(
        values=problem.by_path(one.best),
        value=None if one.best.fault else sign * one.best.cost,
        is_feasible=kept,
        is_finished=one.is_finished,
        agrees=kept and one.best.cost <= best + _AS_GOOD * abs(best),
    )


def _agreement(
    problem: Problem, ends: Sequence[SearchEnd], is_feasible: bool, is_finished: bool
) -> list[str]:
    """Return sentences on whether the searches finished, and whether they agree."""
    said = []
    if not is_finished:
        said.append(
            "The search is not finished: the solves ran out before it settled; give more `solves`."
        )
    if not is_feasible or len(ends) < 2:
        return said
    agree, count = sum(one.agrees for one in ends), len(ends)
    if agree == count:
        said.append(f"All {count} searches, from different starts, came within 1 % of it.")
        return said
    values = [one.value for one in ends if one.is_feasible and one.value is not None]
    unit = QUANTITIES[problem.objective.quantity]
    pick = min if problem.objective.sense == "maximise" else max
    worst = pick(values, default=None)
    far = "" if worst is None else f", the others at up to {format_quantity(worst, unit, digits=5)}"
    said.append(
        f"{agree} of {count} searches from different starts came within 1 % of it{far}: there may "
        "be better cases; give more `solves` and `starts`."
    )
    return said


def _failed(
    problem: Problem, failures: Sequence[tuple[Mapping[str, float], str]], count: int
) -> list[str]:
    if not failures:
        return []
    at, message = failures[0]
    return [
        f"{len(failures)} of {count} cases could not be solved; at {problem.said(at)}: {message}"
    ]


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
            f"The best case found could not be solved again, at {problem.said(values)}: {fault}"
        ]
    quantity, unit = problem.objective.key, QUANTITIES[problem.objective.quantity]
    value = format_quantity(row[quantity], unit, digits=_SHOWN)
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
        goal = "largest" if problem.objective.sense == "maximise" else "smallest"
        said = [f"The {goal} {quantity} found is {value}, at {problem.said(values)}."]
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
    return said


def _shown(value: float, limit: LimitKept) -> str:
    return format_quantity(value, limit.unit, digits=_SHOWN)
