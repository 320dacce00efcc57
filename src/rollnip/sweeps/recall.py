"""Rows of cases that a search asks for one by one; a database keeps any from being solved twice."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from threading import Lock
from time import perf_counter
from typing import Any

from rollnip.sweeps.row import Row, evaluate, ready
from rollnip.sweeps.store import About, Store
from rollnip.sweeps.task import Outcome
from rollnip.sweeps.version import own_version


@contextmanager
def recalling(
    database: str | Path,
    case: Mapping[str, Any],
    paths: Sequence[str],
    solve: Callable[[Mapping[str, Any]], Row] = evaluate,
) -> Iterator[Recall]:
    """Yield `evaluate` backed by a database, so that an interrupted search can be resumed.

    A case that the database holds, by its hash, is read from it; any other is solved and committed
    before the search continues::

        with recalling("find.db", case, ["nip.load"]) as evaluate:
            wanted = ("nip.load", "nip_width", "8 mm", "1 N/mm", "20 N/mm")
            found = find(case, *wanted, evaluate=evaluate)

    Parameters
    ----------
    database :
        SQLite file, created if needed.
    case :
        tree of the case in which the search varies values.
    paths :
        paths of the values varied; their limits and the results wanted may differ from run to run.
    solve :
        solves the cases that the database does not hold, as `rollnip.sweeps.evaluate` does.

    Raises
    ------
    RollnipError
        where the database cannot be opened or written, is in use, or belongs to another version,
        case
        or list of paths.
    """
    with Store(Path(database), About.of_search(case, paths, own_version())) as store:
        yield Recall(store, solve)


class Recall:
    """Rows of cases, read from a database where it holds them, else solved and committed to it.

    Parameters
    ----------
    store :
        store of a search.
    solve :
        solves the cases that the store does not hold.
    """

    def __init__(self, store: Store, solve: Callable[[Mapping[str, Any]], Row] = evaluate) -> None:
        self.store = store
        self.solve = solve
        self._lock = Lock()
        self._known = store.known()
        self._next = store.size

    def __call__(self, tree: Mapping[str, Any]) -> Row:
        """Return a case's row, from the database or by solving it; safe to call from any thread."""
        start = perf_counter()
        one = ready(lambda: tree)
        if one.refusal is not None or one.name is None:
            return self.solve(tree)
        with self._lock:
            if one.name in self._known:
                return self.store.row(self._known[one.name])
        row = self.solve(tree)
        with self._lock:
            if one.name not in self._known:
                self.store.write(Outcome(self._next, (), one.name, row, perf_counter() - start))
                self._known[one.name] = self._next
                self._next += 1
        return row
