"""What a worker does: solve one case after the other and hand back what is to be kept."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from multiprocessing import parent_process
from multiprocessing.connection import wait
from time import perf_counter
from typing import Any

import numpy as np

from rollnip.io.netcdf import PROFILE_UNITS
from rollnip.solution import Solution
from rollnip.sweep.row import Row, attempt, own_kernels, without_solution
from rollnip.sweep.study import Value, case_with


@dataclass(frozen=True, slots=True)
class Task:
    """Some cases of a study.

    Attributes
    ----------
    tree : the case of the study.
    paths : of the parameters.
    cases : position and values of the parameters of each case.
    with_profiles : whether profiles are kept.
    """

    tree: Mapping[str, Any]
    paths: Sequence[str]
    cases: Sequence[tuple[int, tuple[Value, ...]]]
    with_profiles: bool = False

    def split(self) -> list[Task]:
        """The same cases, each a task."""
        return [Task(self.tree, self.paths, (one,), self.with_profiles) for one in self.cases]


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of one case.

    Attributes
    ----------
    position : of the case in the study.
    values : of its parameters.
    case : its hash, as `rollnip.io.case_hash` has it; None where it is no case.
    row : as `evaluate` returns it.
    seconds : that it took.
    profiles : all profiles, 8 bytes a number, one after the other; None where not kept.
    """

    position: int
    values: tuple[Value, ...]
    case: str | None
    row: Row
    seconds: float
    profiles: bytes | None = None


def perform(task: Task) -> list[Outcome]:
    """Solve the cases of a task; a case that goes wrong is a row with its message."""
    return [_outcome(task, position, values) for position, values in task.cases]


def given_up(task: Task, why: str) -> list[Outcome]:
    """Outcomes of a task whose worker did not live to tell."""
    row = without_solution("lost", why)
    return [Outcome(position, values, None, row, 0.0) for position, values in task.cases]


def stand_alone() -> None:
    """Let a new worker process leave Ctrl-C to its parent, and end when the parent is gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = parent_process()
    if parent is not None:
        threading.Thread(target=_end_with, args=(parent.sentinel,), daemon=True).start()


def _end_with(sentinel: int) -> None:
    wait([sentinel])
    os._exit(1)


def _outcome(task: Task, position: int, values: tuple[Value, ...]) -> Outcome:
    start = perf_counter()
    done = attempt(lambda: case_with(task.tree, task.paths, values), own_kernels())
    profiles = None
    if task.with_profiles and done.solution is not None:
        profiles = _profiles(done.solution)
    return Outcome(position, values, done.case, done.row, perf_counter() - start, profiles)


def _profiles(solution: Solution) -> bytes:
    """The profiles in the order of `PROFILE_UNITS`; those not defined are nan."""
    profiles = solution.profiles
    nothing = np.full(profiles.x.size, np.nan)
    found = (getattr(profiles, name) for name in PROFILE_UNITS)
    return np.concatenate([nothing if one is None else one for one in found]).tobytes()
