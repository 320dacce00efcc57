"""Progress of a command: a bar on the standard error, or now and then a line in a log."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import monotonic

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    Task,
    TextColumn,
    TimeRemainingColumn,
)
from rich.text import Text

from rollnip.cli.console import say

_LINES = 60.0  # s, from one line of a log to the next
_OF_LATE = 60.0  # s, over which the rate is taken


class _Rate(ProgressColumn):
    def render(self, task: Task) -> Text:
        speed = task.finished_speed or task.speed
        return Text("" if speed is None else f"{speed:.3g}/s", style="progress.data.speed")


class Lines:
    """Lines of a log: how many of ``total`` cases are solved, at what rate, and the time left.

    Parameters
    ----------
    total :
        number of cases; None: not known.
    what :
        is counted.
    """

    def __init__(self, total: int | None, what: str = "cases") -> None:
        self._total, self._what = total, what
        self._begun = monotonic()
        self._next = self._begun + _LINES
        self._done = 0

    def advance(self) -> None:
        """Count one more, and write a line where it is time."""
        self._done += 1
        now = monotonic()
        if now >= self._next:
            self._next = now + _LINES
            say(f"rollnip: {self._line(now - self._begun)}\n")

    def _line(self, seconds: float) -> str:
        rate = self._done / seconds
        if self._total is None:
            return f"{self._done:,} {self._what}, {rate:.3g} a second"
        left = round((self._total - self._done) / rate)
        minutes, rest = divmod(left, 60)
        hours, minutes = divmod(minutes, 60)
        return (
            f"{self._done:,} of {self._total:,} {self._what}, {rate:.3g} a second, "
            f"{hours}:{minutes:02d}:{rest:02d} left"
        )


@contextmanager
def progress(total: int, what: str) -> Iterator[Callable[[], None]]:
    """Show how far ``total`` cases are, at what rate, and the time left; call what it yields.

    On a terminal that is a bar; elsewhere a line every minute.
    """
    console = Console(stderr=True)
    if not console.is_terminal:
        yield Lines(total).advance
        return
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        _Rate(),
        TimeRemainingColumn(),
    )
    with Progress(
        *columns,
        console=console,
        speed_estimate_period=_OF_LATE,
    ) as bar:
        task = bar.add_task(what, total=total)
        yield lambda: bar.advance(task)


@contextmanager
def counting(what: str = "cross-sections") -> Iterator[Callable[[int, int], None] | None]:
    """Show a bar of what is counted on a terminal; yield what is told how many of how many.

    Elsewhere None is yielded: a log wants no bar.
    """
    console = Console(stderr=True)
    if not console.is_terminal:
        yield None
        return
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn())
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task(what, total=None)
        yield lambda done, total: bar.update(task, completed=done, total=total)
