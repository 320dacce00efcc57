"""Cases that come one by one, as a search asks for them: none is solved twice."""

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
    """`evaluate` with a database, for searches that are to go on where they were stopped.

    A case that the database holds, by its hash, is taken from there; any other is solved and
    committed before the search goes on::

        with recalling("find.db", case, ["nip.load"]) as evaluate:
            wanted = ("nip.load", "nip_width", "8 mm", "1 N/mm", "20 N/mm")
            found = find(case, *wanted, evaluate=evaluate)

    Parameters
    ----------
    database :
        SQLite file, made where it is not there.
    case :
        tree of the case in which the search changes values.
    paths :
        paths of what it changes; their limits and the results wanted may change from run to run.
    solve :
        solves what the database does not hold, as `rollnip.sweeps.evaluate` does.

    Raises
    ------
    RollnipError
        where the database cannot be opened or written, is in use, or is of another version or
        of other questions.
    """
    with Store(Path(database), About.of_search(case, paths, own_version())) as store:
        yield Recall(store, solve)


class Recall:
    """Rows of cases from a database, where it holds them; else solved, and committed to it.

    Parameters
    ----------
    store :
        store of a search.
    solve :
        solves what it does not hold.
    """

    def __init__(self, store: Store, solve: Callable[[Mapping[str, Any]], Row] = evaluate) -> None:
        self.store = store
        self.solve = solve
        self._lock = Lock()
        self._known = store.known()
        self._next = store.size

    def __call__(self, tree: Mapping[str, Any]) -> Row:
        """Return a case's row, from the database or by solving; safe to call from any thread."""
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
