"""Worker processes for searches, which ask for their cases one by one or in small batches."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import BrokenExecutor, ThreadPoolExecutor, wait
from contextlib import contextmanager
from threading import Event
from typing import Any, TypeVar

from rollnip._errors import RollnipError
from rollnip.sweeps.crew import processes
from rollnip.sweeps.interrupt import Interrupts
from rollnip.sweeps.row import Row, evaluate

_A = TypeVar("_A")
_B = TypeVar("_B")
_LOOK = 0.2  # s, between two checks for an interrupt

Evaluate = Callable[[Mapping[str, Any]], Row]


class Together:
    """Worker processes for a search; see `together`.

    Attributes
    ----------
    evaluate : like `rollnip.sweeps.evaluate`, but run in a worker process; may be called from
        threads.
    """

    def __init__(
        self, evaluate: Evaluate, threads: ThreadPoolExecutor | None, interrupts: Interrupts
    ) -> None:
        self.evaluate = evaluate
        self._threads, self._interrupts = threads, interrupts

    def like(self, evaluate: Evaluate) -> Together:
        """Return these workers with another ``evaluate``, which may call the present one."""
        return Together(evaluate, self._threads, self._interrupts)

    def each(self, function: Callable[[_A], _B], items: Sequence[_A], /) -> list[_B]:
        """Call a function with every item concurrently; the results are in the order of the items.

        Raises KeyboardInterrupt after Ctrl-C, and otherwise whatever the first failed item raised.
        """
        if self._threads is None or len(items) < 2:
            return [function(one) for one in items]
        futures = [self._threads.submit(function, one) for one in items]
        left = set(futures)
        while left:
            self._interrupts.check()
            left = wait(left, timeout=_LOOK).not_done
        return [one.result() for one in futures]


@contextmanager
def together(workers: int, interrupts: Interrupts) -> Iterator[Together]:
    """Start worker processes that solve cases; with one worker, this process solves them itself.

    Parameters
    ----------
    workers :
        number of workers.
    interrupts :
        interrupts of the caller, entered before this context and left after it.

    Raises
    ------
    RollnipError
        where processes cannot be started, and from `Together.evaluate` where a process dies on a
        case.
    """
    if workers <= 1:
        interrupts.strike_at(1)
        yield Together(evaluate, None, interrupts)
        return
    stopped = Event()
    with processes(workers) as crew, ThreadPoolExecutor(workers) as threads:

        def elsewhere(tree: Mapping[str, Any]) -> Row:
            if stopped.is_set():
                raise RollnipError("Stopped.")  # in a thread that nobody waits for any more
            try:
                return crew.call(evaluate, tree).result()
            except BrokenExecutor:
                raise RollnipError(
                    "A worker process ended while it solved a case (out of memory?)."
                ) from None

        try:
            yield Together(elsewhere, threads, interrupts)
        finally:
            stopped.set()
            if interrupts.count > 1:
                crew.abandon()
