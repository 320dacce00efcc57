"""Search in the unit cube under limits: differential evolution, then COBYQA from several places.

Numbers only. The cases tried do not depend on how many are solved at a time.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import NonlinearConstraint, differential_evolution, minimize

from rollnip._errors import InvalidInputError

Array = NDArray[np.float64]
_A = TypeVar("_A")
_B = TypeVar("_B")

_INSIDE = 1e-5  # margin of the search to a limit, as a share of it, for its own last digits
_UNSOLVED = 1e3  # excess of a case without results: worse than any other
_GLOBAL = 0.4  # share of the solves for the global search
_MEMBERS = 6  # members of the population for each parameter
_FEWEST = 12  # smallest population
_FIRST_RADIUS = 0.1
_APART = 0.25  # smallest distance between the starts, as a share of an interval
_LEAST_SOLVES, _MOST_SOLVES = 20, 100_000
_SOLVES, _SOLVES_EACH = 150, 100  # default: a fixed number, plus one for each parameter


class Each(Protocol):
    """A function that calls another with every item, in turn or in parallel; results in order."""

    def __call__(self, function: Callable[[_A], _B], items: Sequence[_A], /) -> list[_B]:
        """Return the results."""
        ...


def in_turn(function: Callable[[_A], _B], items: Sequence[_A], /) -> list[_B]:
    """Call a function with every item, one after the other."""
    return [function(one) for one in items]


@dataclass(frozen=True, slots=True, kw_only=True)
class Search:
    """The settings of a search: differential evolution, then COBYQA from the best places.

    Parameters
    ----------
    solves : largest number of cases, 20 to 100000; None: 150 plus 100 for each parameter.
    starts : number of searches by COBYQA, 1 to 20, each from a different place.
    tolerance : accuracy of the parameters, as a share of their intervals.
    seed : seed of the random numbers; the same seed gives the same answer.

    Raises
    ------
    InvalidInputError
        where one is out of its range.

    References
    ----------
    Storn & Price (1997), J. Global Optimization 11, 341-359; Ragonneau & Zhang (2024), COBYQA.
    """

    solves: int | None = None
    starts: int = 3
    tolerance: float = 1e-3
    seed: int = 0

    def __post_init__(self) -> None:
        if self.solves is not None and not _LEAST_SOLVES <= self.solves <= _MOST_SOLVES:
            raise InvalidInputError(
                f"`solves` must lie between {_LEAST_SOLVES} and {_MOST_SOLVES}, got {self.solves}."
            )
        if not 1 <= self.starts <= 20:
            raise InvalidInputError(f"`starts` must lie between 1 and 20, got {self.starts}.")
        if not 1e-6 <= self.tolerance <= 0.1:
            raise InvalidInputError(
                f"`tolerance` must lie between 1e-6 and 0.1, got {self.tolerance!r}."
            )
        if self.seed < 0:
            raise InvalidInputError(f"`seed` must be zero or positive, got {self.seed}.")

    def budget(self, count: int) -> int:
        """Return the largest number of cases to solve for ``count`` parameters."""
        return _SOLVES + _SOLVES_EACH * count if self.solves is None else self.solves


@dataclass(frozen=True, slots=True)
class Trial:
    """One case of a search.

    Attributes
    ----------
    at : (d,) shares of the intervals, 0 to 1.
    cost : to be minimised; inf where there are no results.
    excess : beyond each limit and its tolerance, as a share of the limit; <= 0: kept.
    values : the parameters that were solved there.
    fault : why there are no results; empty where there are some.
    """

    at: Array
    cost: float
    excess: tuple[float, ...]
    values: tuple[float, ...] = ()
    fault: str = ""

    @property
    def violation(self) -> float:
        """Sum of the excesses over the limits; 0 where all are kept."""
        if not np.isfinite(self.cost):
            return float("inf")
        return sum(one for one in self.excess if one > 0.0)

    @property
    def rank(self) -> tuple[float, float]:
        """Smaller is better: limits first, then the cost."""
        return (self.violation, self.cost)


@dataclass(frozen=True, slots=True)
class LocalSearch:
    """One search by COBYQA.

    Attributes
    ----------
    begun : (d,) where it began.
    best : the best trial.
    is_finished : whether it ended by its own tolerance, and not because its solves ran out.
    """

    begun: Array
    best: Trial
    is_finished: bool


@dataclass(frozen=True, slots=True)
class Searched:
    """The answer of `search_cube`: the best trial, all trials in order, and each search's end."""

    best: Trial
    trials: tuple[Trial, ...]
    ends: tuple[LocalSearch, ...]

    @property
    def is_finished(self) -> bool:
        """Whether no search ended because its solves ran out."""
        return all(one.is_finished for one in self.ends)


class _Spent(Exception):
    """The solves are used up."""


class _Log:
    """The log of all trials of one search; each place is tried once."""

    def __init__(self, judge: Callable[[Array], Trial], solves: int, each: Each) -> None:
        self.judge, self.solves, self.each = judge, solves, each
        self.trials: dict[bytes, Trial] = {}

    def at(self, places: Array) -> list[Trial]:
        """Return the trials at places (n, d); raise _Spent where too few solves are left."""
        inside = np.clip(np.asarray(places, dtype=float), 0.0, 1.0)
        keys = [one.tobytes() for one in inside]
        new = dict(zip(keys, inside, strict=True))
        new = {key: place for key, place in new.items() if key not in self.trials}
        room = self.solves - len(self.trials)
        asked = list(new.items())[: max(room, 0)]
        found = self.each(self.judge, [place.copy() for _, place in asked])
        self.trials.update(zip((key for key, _ in asked), found, strict=True))
        if len(asked) < len(new):
            raise _Spent
        return [self.trials[key] for key in keys]

    def excess(self, places: Array) -> Array:
        """Return constraints for scipy (m, n), <= 0 where kept; the first: whether it is solved."""
        rows = []
        for trial in self.at(places):
            solved = bool(np.isfinite(trial.cost))
            beyond = [one + _INSIDE if solved else _UNSOLVED for one in trial.excess]
            rows.append([-1.0 if solved else _UNSOLVED, *beyond])
        return np.array(rows).T

    @property
    def ranked(self) -> list[Trial]:
        """All trials, the best first."""
        return sorted(self.trials.values(), key=lambda trial: trial.rank)


def search_cube(
    judge: Callable[[Array], Trial],
    start: Array | None,
    count: int,
    search: Search,
    each: Each = in_turn,
) -> Searched:
    """Search the unit cube.

    Parameters
    ----------
    judge : function that returns the trial at a place in the cube.
    start : (count,) a first place; None: none.
    count : number of dimensions.
    search : settings.
    each : calls a function with several items, possibly in parallel.
    """
    budget = search.budget(count)
    log = _Log(judge, max(int(_GLOBAL * budget), 1), each)
    _globally(log, start, count, search)
    known = log.ranked
    begins = _apart(known, search.starts)
    share = (budget - len(log.trials)) // max(len(begins), 1)
    worst = max((one.cost for one in known if np.isfinite(one.cost)), default=0.0)
    searches = each(lambda begin: _locally(judge, begin, share, worst, search), begins)
    trials = [*log.trials.values(), *(trial for _, tried in searches for trial in tried)]
    return Searched(
        min(trials, key=lambda trial: trial.rank), tuple(trials), tuple(end for end, _ in searches)
    )


def _globally(log: _Log, start: Array | None, count: int, search: Search) -> None:
    members = max(_FEWEST, _MEMBERS * count)
    try:
        differential_evolution(
            lambda places: np.array([one.cost for one in log.at(np.atleast_2d(places.T))]),
            [(0.0, 1.0)] * count,
            popsize=-(-members // count),
            maxiter=search.budget(count),
            tol=search.tolerance,
            seed=np.random.default_rng(search.seed),
            constraints=[
                NonlinearConstraint(
                    lambda places: log.excess(np.atleast_2d(places.T)), -np.inf, 0.0
                )
            ],
            polish=False,
            x0=start,
            vectorized=True,
            updating="deferred",
        )
    except _Spent:
        return


def _apart(ranked: Sequence[Trial], count: int) -> list[Trial]:
    """Return the best solved trials that are apart from each other, the best of all first."""
    solved = [trial for trial in ranked if np.isfinite(trial.cost)]
    chosen: list[Trial] = []
    for trial in solved:
        gaps = [float(np.max(np.abs(trial.at - one.at))) for one in chosen]
        if len(chosen) < count and all(gap >= _APART for gap in gaps):
            chosen.append(trial)
    return chosen


def _locally(
    judge: Callable[[Array], Trial], begin: Trial, solves: int, worst: float, search: Search
) -> tuple[LocalSearch, tuple[Trial, ...]]:
    """Return the end of COBYQA from one place, and its trials without that place."""
    log = _Log(judge, solves + 1, in_turn)
    log.trials[begin.at.tobytes()] = begin
    size = abs(begin.cost) or 1.0
    is_finished = False
    try:
        found = minimize(
            lambda place: min(log.at(place[None, :])[0].cost, worst) / size,
            begin.at,
            method="COBYQA",
            bounds=[(0.0, 1.0)] * begin.at.size,
            constraints=[
                NonlinearConstraint(lambda place: log.excess(place[None, :])[:, 0], -np.inf, 0.0)
            ],
            options={
                "initial_tr_radius": max(_FIRST_RADIUS, search.tolerance),
                "final_tr_radius": search.tolerance,
            },
        )
        is_finished = found.status in (0, 2)  # the final radius is reached, or all bounds coincide
    except _Spent:
        pass
    return LocalSearch(begin.at, log.ranked[0], is_finished), tuple(log.trials.values())[1:]
