"""Ctrl-C while many cases are solved: counted, and acted upon only where nothing is half done."""

from __future__ import annotations

import signal
import threading
from collections.abc import Sequence
from types import FrameType, TracebackType
from typing import Any


class Interrupts:
    """Counts the signals that ask the process to end, within ``with``; restores the handlers after.

    A KeyboardInterrupt may be raised anywhere; raised inside a lock of the process pool, it leaves
    the
    pool waiting for ever. So none is raised while workers are busy: the code that waits for them
    reads
    ``count``.

    Parameters
    ----------
    signals :
        signals to count; none can be caught outside the main thread.

    Attributes
    ----------
    count : number of interrupts so far.
    strikes_at : number of the interrupt that raises KeyboardInterrupt immediately; 0: none does.
    """

    def __init__(self, signals: Sequence[signal.Signals] = (signal.SIGINT,)) -> None:
        self.count = 0
        self.strikes_at = 0
        self._signals = tuple(signals)
        self._before: dict[signal.Signals, Any] = {}

    def __enter__(self) -> Interrupts:
        if threading.current_thread() is threading.main_thread():
            self._before = {one: signal.signal(one, self._strike) for one in self._signals}
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, _: TracebackType | None
    ) -> None:
        for one, handler in self._before.items():
            signal.signal(one, handler)

    def strike_at(self, number: int) -> None:
        """Raise KeyboardInterrupt at once from this interrupt on; 0: never. Earlier ones count."""
        self.strikes_at = number
        if number and self.count >= number:
            raise KeyboardInterrupt

    def check(self) -> None:
        """Raise KeyboardInterrupt if any interrupt came."""
        if self.count:
            raise KeyboardInterrupt

    def _strike(self, _number: int, _frame: FrameType | None) -> None:
        self.count += 1
        if self.count == self.strikes_at:
            raise KeyboardInterrupt
