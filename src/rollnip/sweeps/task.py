"""Tasks of a worker: solve one case after the other and return what is to be kept."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from time import perf_counter
from typing import Any

import numpy as np

from rollnip.figures import PROFILES
from rollnip.solution import Solution
from rollnip.sweeps.row import Row, own_kernels, ready, solved, without_solution
from rollnip.sweeps.study import Value, case_with


@dataclass(frozen=True, slots=True)
class Task:
    """A batch of cases of a study.

    Attributes
    ----------
    tree : the case of the study.
    paths : paths of the parameters.
    cases : position and parameter values of each case.
    with_profiles : whether profiles are kept.
    """

    tree: Mapping[str, Any]
    paths: Sequence[str]
    cases: Sequence[tuple[int, tuple[Value, ...]]]
    with_profiles: bool = False

    def split(self) -> list[Task]:
        """Return a task for each case."""
        return [Task(self.tree, self.paths, (one,), self.with_profiles) for one in self.cases]


@dataclass(frozen=True, slots=True)
class Outcome:
    """The outcome of one case.

    Attributes
    ----------
    position : position of the case in the study.
    values : values of its parameters.
    case : its hash, as `rollnip.io.case_hash` returns it; None where the case is invalid.
    row : row as `evaluate` returns it.
    seconds : time that it took [s].
    profiles : all profiles, one after the other, 8 bytes per number; None where not kept.
    """

    position: int
    values: tuple[Value, ...]
    case: str | None
    row: Row
    seconds: float
    profiles: bytes | None = None


def perform(task: Task) -> list[Outcome]:
    """Solve the cases of a task; a case that fails has a row with its message."""
    return list(performed(task))


def performed(task: Task) -> Iterator[Outcome]:
    """Solve the cases of a task and yield each outcome as it is ready.

    All cases are read before the first is solved: the code that reads then stays in the caches of
    the
    processor core, and reading takes a third of the time.
    """
    start = perf_counter()
    read = [ready(partial(case_with, task.tree, task.paths, values)) for _, values in task.cases]
    share = (perf_counter() - start) / len(read)
    for (position, values), one in zip(task.cases, read, strict=True):
        start = perf_counter()
        row, solution = solved(one, own_kernels())
        profiles = None
        if task.with_profiles and solution is not None:
            profiles = _profiles(solution)
        seconds = share + perf_counter() - start
        yield Outcome(position, values, one.name, row, seconds, profiles)


def given_up(task: Task, why: str) -> list[Outcome]:
    """Return the outcomes of a task whose worker died or returned nothing."""
    row = without_solution("lost", why)
    return [Outcome(position, values, None, row, 0.0) for position, values in task.cases]


def _profiles(solution: Solution) -> bytes:
    """Return the profiles in the order of `PROFILES`; nan where one is not defined."""
    profiles = solution.profiles
    nothing = np.full(profiles.x.size, np.nan)
    found = (getattr(profiles, name) for name in PROFILES)
    return np.concatenate([nothing if one is None else one for one in found]).tobytes()
