"""The flow of a sweep: find the open cases, solve them, commit each as it ends."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import (
    ALL_COMPLETED,
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
    Future,
    wait,
)
from dataclasses import dataclass
from itertools import islice
from time import monotonic

import numpy as np

from rollnip._errors import RollnipError
from rollnip.sweeps.crew import Crew
from rollnip.sweeps.interrupt import Interrupts
from rollnip.sweeps.store import Store
from rollnip.sweeps.study import Study
from rollnip.sweeps.task import Outcome, Task, given_up, performed

Report = Callable[[Outcome], None]
_DIED = "The worker process ended while it solved this case (out of memory?)."
_ALL_LOST = "the workers were lost; what was finished is kept: run the same again."
_MOST_CASES = 256  # of one task
_AT_ONCE = 0.25  # s, duration of the cases read together where this process solves alone
_PATIENCE = 30.0  # s, for the cases that are running when the sweep is interrupted
_LOOK = 0.2  # s, between two checks for an interrupt


class OpenCases:
    """The cases of a study that a database does not hold yet, turned into tasks on demand.

    Parameters
    ----------
    study :
        the study to be solved.
    store :
        store of this study.
    with_profiles :
        keep the profiles too; cases held without profiles then count as open.
    """

    def __init__(self, study: Study, store: Store, *, with_profiles: bool = False) -> None:
        self._study, self._with_profiles = study, with_profiles
        held = store.held(with_profiles=with_profiles)
        which, shards = store.about.shard
        self.count = len(store.about.positions) - int(np.count_nonzero(held[which - 1 :: shards]))
        self._positions = (one for one in store.about.positions if not held[one])
        self._seconds = 0.0  # running mean of the time of a case

    def learn(self, outcomes: list[Outcome]) -> None:
        """Update the running mean of the time that a case takes."""
        for outcome in outcomes:
            change = 0.1 * (outcome.seconds - self._seconds)
            self._seconds = self._seconds + change if self._seconds else outcome.seconds

    def task(self, seconds: float = 0.0) -> Task | None:
        """Return the next task, of about ``seconds`` (0: one case); None where no case is left."""
        count = 1
        if seconds > 0.0 and self._seconds > 0.0:
            count = max(1, min(_MOST_CASES, round(seconds / self._seconds)))
        positions = islice(self._positions, count)
        cases = tuple((position, self._study.values(position)) for position in positions)
        if not cases:
            return None
        return Task(self._study.tree, self._study.paths, cases, self._with_profiles)


def run(
    cases: OpenCases,
    store: Store,
    crew: Crew | None = None,
    report: Report | None = None,
    interrupts: Interrupts | None = None,
) -> None:
    """Solve all open cases; each is committed as it ends.

    Parameters
    ----------
    cases :
        the open cases.
    store :
        receives the outcomes.
    crew :
        workers that solve; None: this process, one case after the other.
    report :
        called with every outcome once it is committed.
    interrupts :
        interrupts of the caller; None: this call counts its own.

    Raises
    ------
    RollnipError
        where the store cannot be written, or the crew is lost; what was finished is kept.
    KeyboardInterrupt
        after Ctrl-C. With a crew: once the running cases have ended and are committed, or at the
        second Ctrl-C, or after half a minute. Without one: immediately.
    """
    if interrupts is None:
        with Interrupts() as interrupts:
            run(cases, store, crew, report, interrupts)
        return

    def keep(outcomes: list[Outcome]) -> None:
        for outcome in outcomes:
            store.write(outcome)
            if report is not None:
                report(outcome)

    try:
        if crew is not None:
            interrupts.strike_at(0)
            _Flow(cases, crew, keep, interrupts).run()
            return
        interrupts.strike_at(1)
        while (task := cases.task(_AT_ONCE)) is not None:
            for outcome in performed(task):
                cases.learn([outcome])
                keep([outcome])
    finally:
        interrupts.strike_at(0)  # no KeyboardInterrupt while files are closed


@dataclass(slots=True)
class _Flow:
    """Keeps a crew busy until no case is left."""

    cases: OpenCases
    crew: Crew
    keep: Callable[[list[Outcome]], None]
    interrupts: Interrupts

    def run(self) -> None:
        running: dict[Future[list[Outcome]], Task] = {}
        try:
            while True:
                suspects = self._fill(running)
                if not running and not suspects:
                    return
                suspects += self._collect(running, self._awaited(running, FIRST_COMPLETED))
                if suspects:
                    self._try_singly(suspects, running)
        except KeyboardInterrupt:
            self._finish(running)
            raise

    def _awaited(
        self, futures: Iterable[Future[list[Outcome]]], until: str
    ) -> set[Future[list[Outcome]]]:
        """Wait for one or all futures and return those that are done. Raises KeyboardInterrupt."""
        left = set(futures)
        while True:
            self.interrupts.check()
            self.crew.require_alive()
            done, open_ones = wait(left, timeout=_LOOK, return_when=until)
            if not open_ones or (done and until == FIRST_COMPLETED):
                return done

    def _fill(self, running: dict[Future[list[Outcome]], Task]) -> list[Task]:
        """Start tasks until the crew is busy; return the task that a broken crew did not take."""
        while len(running) < self.crew.in_flight:
            task = self.cases.task(self.crew.chunk_seconds)
            if task is None:
                break
            try:
                running[self.crew.submit(task)] = task
            except BrokenExecutor:
                return [task]
        return []

    def _collect(
        self, running: dict[Future[list[Outcome]], Task], done: set[Future[list[Outcome]]]
    ) -> list[Task]:
        """Keep the outcomes of finished futures; return the tasks that gave none."""
        failed = []
        for future in done:
            task = running.pop(future)
            try:
                outcomes = future.result()
            except CancelledError:
                raise RollnipError(_ALL_LOST) from None
            except Exception:  # noqa: BLE001 - whatever an executor raises: the task has no result
                failed.append(task)
                continue
            self.cases.learn(outcomes)
            self.keep(outcomes)
        return failed

    def _try_singly(self, suspects: list[Task], running: dict[Future[list[Outcome]], Task]) -> None:
        """Run the suspects of a crash one case at a time, to find the one that kills its worker."""
        suspects += self._collect(running, self._awaited(running, ALL_COMPLETED))
        for task in (single for suspect in suspects for single in suspect.split()):
            self.keep(self._run_alone(task))

    def _run_alone(self, task: Task) -> list[Outcome]:
        try:
            future = self.crew.submit(task)
        except BrokenExecutor:
            self.crew.restart()
            future = self.crew.submit(task)
        self._awaited([future], ALL_COMPLETED)
        try:
            return future.result()
        except CancelledError:
            raise RollnipError(_ALL_LOST) from None
        except BrokenExecutor:
            return given_up(task, _DIED)
        except Exception as error:  # noqa: BLE001 - as above
            return given_up(task, f"The worker returned nothing: {type(error).__name__}: {error}")

    def _finish(self, running: dict[Future[list[Outcome]], Task]) -> None:
        """End after an interrupt: start nothing new, keep what ends soon, abandon the rest."""
        left = {future for future in running if not future.cancel()}
        end = monotonic() + _PATIENCE
        done, late = wait(left, timeout=0.0)
        while late and self.interrupts.count < 2 and monotonic() < end:
            done, late = wait(left, timeout=_LOOK)
        self._collect(running, {one for one in done if not one.cancelled()})
        if late:
            self.crew.abandon()
