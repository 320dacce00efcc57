"""Crews that work on tasks: processes of this machine, or an executor of the caller."""

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
    """A crew of workers that run tasks outside this process.

    Attributes
    ----------
    in_flight : number of tasks to keep submitted, enough that no worker waits for its next one.
    chunk_seconds : how long a task should take; 0: one case per task.
    """

    in_flight: int
    chunk_seconds: float

    def submit(self, task: Task) -> Future[list[Outcome]]:
        """Start a task. Raises BrokenExecutor where the crew is broken."""
        ...

    def restart(self) -> None:
        """Replace a broken crew by a working one. Raises RollnipError where it cannot."""
        ...

    def require_alive(self) -> None:
        """Raise RollnipError where no worker is left."""
        ...

    def abandon(self) -> None:
        """Stop waiting for the running tasks; their results are lost."""
        ...


class Processes:
    """Worker processes of this machine, each task one case; see `processes`.

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
        """Start new processes in place of the broken ones."""
        self.close()
        self._pool = self._started()

    def require_alive(self) -> None:
        """Do nothing: the pool itself reports a process that died."""

    @property
    def pool(self) -> ProcessPoolExecutor:
        """The processes as an executor, for callers with work of their own."""
        return self._pool

    def abandon(self) -> None:
        """Kill the processes in the middle of their work."""
        _kill(self._pool)

    def close(self) -> None:
        """Let each process finish its present case, then end."""
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
                "Worker processes cannot be started. In a script, call the sweep below "
                '`if __name__ == "__main__":`, or choose `workers=1`.'
            ) from None
        except KeyboardInterrupt:
            _kill(pool)
            raise
        if theirs != own_version():
            pool.shutdown(wait=True, cancel_futures=True)
            raise RollnipError(
                f"New worker processes have rollnip {theirs}, this is {own_version()}: its code "
                "changed since this process began; start it again."
            )
        return pool


class Given:
    """An executor that the caller supplies.

    Parameters
    ----------
    executor :
        any concurrent.futures.Executor.
    workers :
        number of tasks that it can run at a time.
    chunk_seconds :
        how long a task should take, for executors with an overhead of milliseconds per task.
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
        raise RollnipError("The executor broke; what was finished is kept: run the same again.")

    def require_alive(self) -> None:
        """Do nothing: an executor cannot tell whether its workers are alive."""

    def abandon(self) -> None:
        """Do nothing: the executor owns the running tasks, and the waiting ones were cancelled."""


@contextmanager
def crew_of(workers: int, executor: Executor | None = None) -> Iterator[Crew | None]:
    """Yield the given executor as a crew, else processes of this machine; None for one worker."""
    if executor is not None:
        yield Given(executor, workers)
    elif workers <= 1:
        yield None
    else:
        with processes(workers) as crew:
            yield crew


def available_cores() -> int:
    """Return the number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


@contextmanager
def processes(count: int) -> Iterator[Processes]:
    """Start worker processes of this machine, one thread each for linear algebra; end them on exit.

    They are spawned, not forked; they leave Ctrl-C to this process, and end with it however it
    ends.
    Raises RollnipError where they cannot be started.
    """
    crew = Processes(count)
    try:
        yield crew
    finally:
        crew.close()


def _kill(pool: ProcessPoolExecutor) -> None:
    for process in list((pool._processes or {}).values()):
        process.kill()


def _block_interrupts() -> None:
    """Block Ctrl-C in this thread, and so in the processes it starts, until they ignore it.

    The signal handlers and masks of the calling process are left alone.
    """
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
