"""Crews that work on the tasks: processes of this machine, or any executor that is given."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Iterator
from concurrent.futures import (
    BrokenExecutor,
    Executor,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
)
from contextlib import contextmanager
from multiprocessing import get_context
from typing import Protocol, TypeVar

from rollnip._errors import RollnipError
from rollnip._own_process import prepare_worker
from rollnip.sweeps import version
from rollnip.sweeps.task import Outcome, Task, perform
from rollnip.sweeps.version import own_version

_A = TypeVar("_A")
_B = TypeVar("_B")


class Crew(Protocol):
    """A crew of workers that run tasks elsewhere.

    Attributes
    ----------
    in_flight : tasks that it should have at a time: enough that nobody waits for the next.
    chunk_seconds : how long a task should take; 0: one case a task.
    """

    in_flight: int
    chunk_seconds: float

    def submit(self, task: Task) -> Future[list[Outcome]]:
        """Start a task. Raises BrokenExecutor where the crew is broken."""
        ...

    def restart(self) -> None:
        """Make the crew whole again after it broke. Raises RollnipError where it cannot."""
        ...

    def require_alive(self) -> None:
        """Raise RollnipError where nobody is left who could work."""
        ...

    def abandon(self) -> None:
        """Give up what is running: its results are not waited for."""
        ...


class Processes:
    """Worker processes of this machine; see `processes`. A task is one case.

    Parameters
    ----------
    count :
        number of processes.
    """

    def __init__(self, count: int) -> None:
        self.in_flight = 2 * count + 2
        self.chunk_seconds = 0.0
        self._count = count
        self._pool = self._started()

    def submit(self, task: Task) -> Future[list[Outcome]]:
        """Start a task."""
        return self._pool.submit(perform, task)

    def call(self, function: Callable[[_A], _B], argument: _A) -> Future[_B]:
        """Call a function of a module in one of the processes."""
        return self._pool.submit(function, argument)

    def restart(self) -> None:
        """New processes in place of those that broke."""
        self.close()
        self._pool = self._started()

    def require_alive(self) -> None:
        """Do nothing: a pool reports a process that died by itself."""

    def abandon(self) -> None:
        """End the processes in the middle of what they do."""
        for process in list((self._pool._processes or {}).values()):
            process.kill()

    def close(self) -> None:
        """Let the processes end after the case each is at."""
        self._pool.shutdown(wait=True, cancel_futures=True)

    def _started(self) -> ProcessPoolExecutor:
        pool = ProcessPoolExecutor(
            self._count, mp_context=get_context("spawn"), initializer=prepare_worker
        )
        try:
            with ThreadPoolExecutor(1, initializer=_block_interrupts) as thread:
                answers = list(thread.map(pool.submit, [version.own_version] * self._count))
            theirs = answers[0].result()
        except BrokenExecutor:
            raise RollnipError(
                "worker processes cannot be started. In a script, call the sweep below "
                '`if __name__ == "__main__":`, or choose `workers=1`.'
            ) from None
        if theirs != own_version():
            pool.shutdown(wait=True, cancel_futures=True)
            raise RollnipError(
                f"new worker processes have rollnip {theirs}, this is {own_version()}: its code "
                "changed since this process began; start it again."
            )
        return pool


class Given:
    """An executor of the caller's.

    Parameters
    ----------
    executor :
        anything that is a concurrent.futures.Executor.
    workers :
        how many tasks it can run at a time.
    chunk_seconds :
        how long a task should take, for executors to which a task costs milliseconds.
    """

    def __init__(self, executor: Executor, workers: int, chunk_seconds: float = 0.0) -> None:
        self.in_flight = 2 * workers + 2
        self.chunk_seconds = chunk_seconds
        self._executor = executor

    def submit(self, task: Task) -> Future[list[Outcome]]:
        """Start a task."""
        return self._executor.submit(perform, task)

    def restart(self) -> None:
        """Refuse: the executor belongs to the caller. Raises RollnipError."""
        raise RollnipError("the executor broke; what was finished is kept: run the same again.")

    def require_alive(self) -> None:
        """Do nothing: an executor cannot tell whether its workers are alive."""

    def abandon(self) -> None:
        """Do nothing: running tasks are the executor's, and waiting ones were cancelled."""


@contextmanager
def crew_of(workers: int, executor: Executor | None = None) -> Iterator[Crew | None]:
    """The executor that is given, else processes of this machine; None for a single worker."""
    if executor is not None:
        yield Given(executor, workers)
    elif workers <= 1:
        yield None
    else:
        with processes(workers) as crew:
            yield crew


def available_cores() -> int:
    """Cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


@contextmanager
def processes(count: int) -> Iterator[Processes]:
    """Worker processes of this machine, gone at the end; one thread for linear algebra in each.

    They are new processes, not forked, leave Ctrl-C to this process, and end with it whatever
    ends it. Raises RollnipError where they cannot be started.
    """
    crew = Processes(count)
    try:
        yield crew
    finally:
        crew.close()


def _block_interrupts() -> None:
    """Block Ctrl-C in this thread; processes that it starts do not hear it until they ignore it.

    The handlers and masks of the process that calls are left alone.
    """
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
