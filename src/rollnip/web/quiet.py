"""A log that stays short whatever is sent: equal lines are written only a few times a minute."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable

_MOST = 5
_SECONDS = 60.0


class Quiet(logging.Filter):
    """A log filter that passes the first few of equal lines each minute and marks the last of them.

    Parameters
    ----------
    clock :
        seconds, always growing.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        super().__init__()
        self._clock = clock
        self._begun = clock()
        self._counts: dict[tuple[str, str], int] = {}

    def filter(self, record: logging.LogRecord) -> bool:
        """Return whether the line is written."""
        if self._clock() - self._begun > _SECONDS:
            self._begun = self._clock()
            self._counts.clear()
        key = (record.name, str(record.msg)[:200])
        if key not in self._counts and len(self._counts) >= _MOST:
            key = (record.name, "")  # lines that are all different count as one kind, too
        self._counts[key] = count = self._counts.get(key, 0) + 1
        if count == _MOST:
            record.msg = f"{record.msg} (Lines like this are left out for up to {_SECONDS:g} s.)"
        return count <= _MOST


def keep_quiet(*names: str) -> None:
    """Have the loggers of these names say the same only some times a minute."""
    quiet = Quiet()
    for name in names:
        logging.getLogger(name).addFilter(quiet)
