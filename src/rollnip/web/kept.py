"""The last things that were made, by key, so that asking for one again takes no time."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from typing import Generic, TypeVar

T = TypeVar("T")


class Kept(Generic[T]):
    """Keeps what was made last; what was not asked for longest gives way.

    Parameters
    ----------
    most :
        sum of the sizes of all that is kept; what is larger by itself is not kept.
    size :
        size of one thing; each counts one by default.
    """

    def __init__(self, most: int, size: Callable[[T], int] = lambda _: 1) -> None:
        self._most, self._size = most, size
        self._kept: OrderedDict[str, T] = OrderedDict()
        self._sum = 0

    def get(self, key: str) -> T | None:
        """Return what is kept under a key, or None."""
        if key in self._kept:
            self._kept.move_to_end(key)
        return self._kept.get(key)

    def put(self, key: str, value: T) -> T:
        """Keep a thing under a key, and return it."""
        if key in self._kept:
            self._sum -= self._size(self._kept.pop(key))
        if self._size(value) <= self._most:
            self._kept[key] = value
            self._sum += self._size(value)
        while self._sum > self._most:
            _, oldest = self._kept.popitem(last=False)
            self._sum -= self._size(oldest)
        return value
