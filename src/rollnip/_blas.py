"""One thread for small linear systems.

A second BLAS thread makes systems of a hundred unknowns ten to a thousand times slower: the
threads wait for each other longer than they compute. A caller's process may have any number, and
has it again afterwards.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from threading import Lock
from typing import Any

from threadpoolctl import ThreadpoolController

_lock = Lock()
_inside: list[Any] = []  # one entry for each caller inside; the first holds the limits before


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Limit the BLAS libraries to one thread; the last to leave gives back what they had."""
    with _lock:
        _inside.append(None if _inside else _limited())
    try:
        yield
    finally:
        with _lock:
            had = _inside[0]
            _inside.pop()
            if not _inside:
                for library, threads in had:
                    library.set_num_threads(threads)


def _limited() -> list[tuple[Any, int]]:
    """Each library, limited now, with the threads that it had."""
    # The limits of threadpoolctl itself read the version of each library in each call.
    had = [(library, library.num_threads) for library in _libraries().lib_controllers]
    for library, _ in had:
        library.set_num_threads(1)
    return had


@cache
def _libraries() -> ThreadpoolController:
    # Numpy and scipy each bring their own; finding them takes a millisecond.
    import scipy.linalg  # noqa: F401

    return ThreadpoolController().select(user_api="blas")
