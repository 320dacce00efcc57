"""Search in the unit cube under limits: differential evolution, then COBYQA. Numbers only."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import NonlinearConstraint, differential_evolution, minimize

from rollnip._errors import InvalidInputError

Array = NDArray[np.float64]

FORGIVEN = 1e-5  # excess that still counts as kept: rounding, and the search's own last digits
_UNSOLVED = 1e3  # excess of a case without results: worse than any other
_GLOBAL = 0.7  # share of the solves for the global part
_MEMBERS = 6  # of the population, for each parameter
_FEWEST = 12
_FIRST_RADIUS = 0.1
_LEAST_SOLVES, _MOST_SOLVES = 20, 100_000


@dataclass(frozen=True, slots=True, kw_only=True)
class Search:
    """How an optimum is searched: differential evolution first, then COBYQA from the best.

    Parameters
    ----------
    solves : at most so many cases, 20 to 100000.
    tolerance : how closely the parameters are found, as a share of their intervals.
    seed : of the random numbers; the same seed gives the same answer.

    Raises
    ------
    InvalidInputError
        where one is out of its range.

    References
    ----------
    Storn & Price (1997), J. Global Optimization 11, 341-359; Ragonneau & Zhang (2024), COBYQA.
    """

    solves: int = 250
    tolerance: float = 1e-3
    seed: int = 0

    def __post_init__(self) -> None:
        if not _LEAST_SOLVES <= self.solves <= _MOST_SOLVES:
            raise InvalidInputError(
                f"`solves` must lie between {_LEAST_SOLVES} and {_MOST_SOLVES}, got {self.solves}."
            )
        if not 1e-6 <= self.tolerance <= 0.1:
            raise InvalidInputError(
                f"`tolerance` must lie between 1e-6 and 0.1, got {self.tolerance!r}."
            )
        if self.seed < 0:
            raise InvalidInputError(f"`seed` must be zero or positive, got {self.seed}.")


@dataclass(frozen=True, slots=True)
class Trial:
    """One case of a search.

    Attributes
    ----------
    at : (d,) shares of the intervals, 0 to 1.
    cost : to be made small; inf where there are no results.
    excess : beyond each limit, as a share of it; < 0: within.
    """

    at: Array
    cost: float
    excess: tuple[float, ...]

    @property
    def violation(self) -> float:
        """Sum of what is beyond the limits; 0 where all are kept."""
        if not np.isfinite(self.cost):
            return float("inf")
        return sum(one for one in self.excess if one > FORGIVEN)

    @property
    def rank(self) -> tuple[float, float]:
        """The smaller the better: limits first, then the cost."""
        return (self.violation, self.cost)


class _Spent(Exception):
    """The solves are used up."""


class _Log:
    """Every trial, each place tried once."""

    def __init__(self, judge: Callable[[Array], Trial], solves: int) -> None:
        self.judge, self.solves = judge, solves
        self.trials: dict[bytes, Trial] = {}

    def at(self, place: Array) -> Trial:
        """The trial at a place; raises _Spent where it is new and none is left."""
        inside = np.clip(np.asarray(place, dtype=float), 0.0, 1.0)
        key = inside.tobytes()
        if key not in self.trials:
            if len(self.trials) >= self.solves:
                raise _Spent
            self.trials[key] = self.judge(inside.copy())
        return self.trials[key]

    def excess(self, place: Array) -> Array:
        """Constraints of scipy: all must be <= 0; the first is whether there are results."""
        trial = self.at(place)
        solved = bool(np.isfinite(trial.cost))
        return np.array(
            [-1.0 if solved else _UNSOLVED] + [one if solved else _UNSOLVED for one in trial.excess]
        )

    @property
    def best(self) -> Trial:
        """The best so far, the first of equals."""
        return min(self.trials.values(), key=lambda trial: trial.rank)


def search_cube(
    judge: Callable[[Array], Trial], start: Array | None, count: int, search: Search
) -> tuple[Trial, tuple[Trial, ...]]:
    """Search the unit cube.

    Parameters
    ----------
    judge : what a place in the cube is worth.
    start : (count,) a first place; None: none.
    count : of the dimensions.
    search : how.

    Returns
    -------
    the best trial, and all in the order tried.
    """
    log = _Log(judge, int(_GLOBAL * search.solves))
    _globally(log, start, count, search)
    log.solves = search.solves
    _locally(log, search)
    return log.best, tuple(log.trials.values())


def _globally(log: _Log, start: Array | None, count: int, search: Search) -> None:
    members = max(_FEWEST, _MEMBERS * count)
    try:
        differential_evolution(
            lambda place: log.at(place).cost,
            [(0.0, 1.0)] * count,
            popsize=-(-members // count),
            maxiter=search.solves,
            tol=search.tolerance,
            seed=np.random.default_rng(search.seed),
            constraints=[NonlinearConstraint(log.excess, -np.inf, 0.0)],
            polish=False,
            x0=start,
        )
    except _Spent:
        return


def _locally(log: _Log, search: Search) -> None:
    best = log.best
    if not np.isfinite(best.cost):
        return
    size = abs(best.cost) or 1.0
    solved = [trial.cost for trial in log.trials.values() if np.isfinite(trial.cost)]
    worst = max(solved)

    def cost(place: Array) -> float:
        return min(log.at(place).cost, worst) / size

    try:
        minimize(
            cost,
            best.at,
            method="COBYQA",
            bounds=[(0.0, 1.0)] * best.at.size,
            constraints=[NonlinearConstraint(log.excess, -np.inf, 0.0)],
            options={
                "initial_tr_radius": max(_FIRST_RADIUS, search.tolerance),
                "final_tr_radius": search.tolerance,
            },
        )
    except _Spent:
        return
