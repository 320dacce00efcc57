"""The database of a sweep: SQLite, one writer, each case committed as it ends.

A process killed at any moment leaves a database that holds every case committed before, thanks to
write-ahead logging. The log, ``results.db-wal``, is part of the database until it is closed; every
ten seconds, and at the end, its cases are moved into ``results.db`` itself. Only this module knows
the tables.
"""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from time import monotonic
from types import TracebackType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import RollnipError
from rollnip._files import reading
from rollnip.sweeps.connect import Writer, open_to_read, open_to_write, plain
from rollnip.sweeps.foreign import checked_about, require_schema, require_sound_rows
from rollnip.sweeps.row import SCALARS, Row
from rollnip.sweeps.study import Study, case_digest
from rollnip.sweeps.task import Outcome

FORMAT = 2
_LOG_SECONDS = 10.0  # longest time that cases are in the log alone
_APPLICATION = 0x726E6970  # marks the file as one of ours
_TEXTS = ("hash", "parameters", "status", "message", "geometry", "warnings")
_NAMES = ("position", *_TEXTS, *SCALARS, "seconds")
_QUOTED = ", ".join(f'"{name}"' for name in _NAMES)
_INSERT = f"INSERT OR REPLACE INTO cases ({_QUOTED}) VALUES ({', '.join('?' * len(_NAMES))})"
_INSERT_PROFILES = "INSERT OR REPLACE INTO profiles VALUES (?, ?)"
_TABLES = f"""
CREATE TABLE IF NOT EXISTS about (value TEXT);
CREATE TABLE IF NOT EXISTS cases (
    position INTEGER PRIMARY KEY,
    {", ".join(f'"{name}" TEXT' for name in _TEXTS)},
    {", ".join(f'"{name}" REAL' for name in SCALARS)},
    seconds REAL
);
CREATE TABLE IF NOT EXISTS profiles (position INTEGER PRIMARY KEY, data BLOB);
"""


_COLUMNS = {"about": ("value",), "cases": _NAMES, "profiles": ("position", "data")}


@dataclass(frozen=True, slots=True, kw_only=True)
class About:
    """The description of the cases that a database holds.

    Attributes
    ----------
    version : version of rollnip and of its code, as `own_version` returns it.
    study : digest of the study.
    title, count : title and number of cases; 0 for a search, whose cases come one by one.
    paths, units : paths and units of the parameters.
    results, profiles : names of the results and profiles wanted.
    shard : (which, of how many), counted from 1.
    case : case of the study, as JSON; empty for a search.
    """

    version: str
    study: str
    title: str
    count: int
    paths: tuple[str, ...]
    units: tuple[str, ...]
    results: tuple[str, ...]
    profiles: tuple[str, ...]
    shard: tuple[int, int] = (1, 1)
    case: str = ""

    @classmethod
    def of(cls, study: Study, version: str, shard: tuple[int, int] = (1, 1)) -> About:
        """Return the description of a study's database."""
        return cls(
            version=version,
            study=study.digest,
            title=study.title,
            count=study.count,
            paths=study.paths,
            units=study.units,
            results=study.results,
            profiles=study.profiles,
            shard=shard,
            case=json.dumps(study.tree, sort_keys=True),
        )

    @classmethod
    def of_search(cls, case: Mapping[str, Any], paths: Sequence[str], version: str) -> About:
        """Return the description of a search's database: its case and the paths that it varies."""
        return cls(
            version=version,
            study=case_digest(case, "search", *paths),
            title=str(case.get("title", "")),
            count=0,
            paths=tuple(paths),
            units=(),
            results=(),
            profiles=(),
        )

    @property
    def positions(self) -> range:
        """Positions in the study of the cases of this shard."""
        which, shards = self.shard
        return range(which - 1, self.count, shards)


_ABOUT = {
    **dict.fromkeys(("version", "study", "title", "case"), str),
    "count": int,
    **dict.fromkeys(("paths", "units", "results", "profiles"), tuple),
}


class Store:
    """A database of a sweep, written by this process alone; others may read it meanwhile.

    Parameters
    ----------
    path :
        path of the file, created if needed; None: in memory.
    about :
        description of the cases that it is to hold; None: read only, whatever study it holds.

    Raises
    ------
    RollnipError
        where the file cannot be opened, is being written by another process, is no database of a
        sweep, or is of another version or another study.
    """

    def __init__(self, path: Path | None, about: About | None = None) -> None:
        self.name = "the database" if path is None else str(path)
        self.is_in_memory = path is None
        self._writer: Writer | None = None
        self._emptied = monotonic()
        if path is not None:
            reading(path)  # it holds solved cases: no table may overwrite it
        if about is None and path is not None:
            self._base = open_to_read(path)
        else:
            self._base = open_to_write(path)
        try:
            with self._plain_errors():
                self._require_ours(must_be_there=about is None)
                if about is not None:
                    if path is not None:
                        self._writer = Writer(path)
                    self._prepare()
                require_schema(self._base, self.name, _COLUMNS)
            self.about = self._matching_about(about)
            with self._plain_errors():
                require_sound_rows(self._base, self.name, self.about.count, len(self.about.paths))
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> Store:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, _: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the file; all that was written is then in the database itself, not in the log."""
        with suppress(sqlite3.Error):
            self._empty_log("TRUNCATE")
        self._base.close()
        if self._writer is not None:
            self._writer.close()

    def write(self, outcome: Outcome) -> None:
        """Commit one case. Raises RollnipError where the disk cannot take it."""
        with self._plain_errors():
            if outcome.profiles is None:
                self._write(outcome)  # one statement is a transaction of its own
            else:
                with self._transaction():
                    self._write(outcome)
                    self._base.execute(_INSERT_PROFILES, (outcome.position, outcome.profiles))
            if monotonic() - self._emptied > _LOG_SECONDS:
                self._empty_log("PASSIVE")

    def held(self, *, with_profiles: bool) -> NDArray[np.bool_]:
        """Return a mask (count,) of the cases that need not be solved again."""
        found = np.zeros(self.about.count, dtype=np.bool_)
        query = "SELECT position FROM cases WHERE status != 'lost'"
        if with_profiles:
            query += (
                " AND (status NOT IN ('solved', 'unverified')"
                " OR position IN (SELECT position FROM profiles))"
            )
        with self._plain_errors():
            for (position,) in self._base.execute(query):
                found[position] = True
        return found

    @property
    def size(self) -> int:
        """Number of cases in the database."""
        return sum(self.tally().values())

    def row(self, position: int) -> Row:
        """Return the row of one case, as `rollnip.sweeps.evaluate` returned it."""
        names = ("status", "message", "status", "geometry", *SCALARS, "warnings")
        wanted = ", ".join(f'"{name}"' for name in names)
        with self._plain_errors():
            found = self._base.execute(
                f"SELECT {wanted} FROM cases WHERE position = ?", (position,)
            ).fetchone()
        keys = ("status", "message", "converged", "geometry", *SCALARS, "warnings")
        row: Row = dict(zip(keys, found, strict=True))
        return row | {"converged": row["status"] == "solved"}

    def tally(self) -> dict[str, int]:
        """Return the number of cases by status."""
        with self._plain_errors():
            return dict(self._base.execute("SELECT status, count(*) FROM cases GROUP BY status"))

    def seconds_each(self) -> float | None:
        """Return the mean time that a case took [s]; None without any case."""
        with self._plain_errors():
            query = "SELECT avg(seconds) FROM cases WHERE status != 'lost'"
            found: float | None = self._base.execute(query).fetchone()[0]
        return found

    def rows(self, names: Sequence[str]) -> Iterator[tuple[Any, ...]]:
        """Yield the requested columns of each case as a tuple, in the order of the study."""
        wanted = ", ".join(f'"{name}"' for name in names)
        with self._plain_errors():
            yield from self._base.execute(f"SELECT {wanted} FROM cases ORDER BY position")

    def rows_not_solved(self) -> Iterator[tuple[int, str]]:
        """Yield position and message of the cases without a verified solution."""
        query = "SELECT position, message FROM cases WHERE status != 'solved' ORDER BY position"
        with self._plain_errors():
            yield from self._base.execute(query)

    def profiles(self) -> Iterator[tuple[int, bytes]]:
        """Yield position and profiles of the cases that have them, in the order of the study."""
        with self._plain_errors():
            yield from self._base.execute("SELECT position, data FROM profiles ORDER BY position")

    def known(self) -> dict[str, int]:
        """Return the position by hash of all cases that need not be solved again, of any study."""
        query = "SELECT hash, position FROM cases WHERE hash IS NOT NULL AND status != 'lost'"
        with self._plain_errors():
            return dict(self._base.execute(query))

    def adopt(self, other: Store, there: int, position: int, values: Sequence[float | str]) -> None:
        """Copy one case from position ``there`` of another database to ``position`` of this one."""
        with other._plain_errors():
            row = other._base.execute(
                f"SELECT {_QUOTED} FROM cases WHERE position = ?", (there,)
            ).fetchone()
            profiles = other._base.execute(
                "SELECT data FROM profiles WHERE position = ?", (there,)
            ).fetchone()
        found = dict(zip(_NAMES, row, strict=True))
        found |= {"position": position, "parameters": json.dumps(values)}
        with self._plain_errors(), self._transaction():
            self._base.execute(_INSERT, list(found.values()))
            if profiles is not None:
                self._base.execute(_INSERT_PROFILES, (position, *profiles))

    def take(self, other: Store) -> None:
        """Copy all cases from another database of the same study."""
        with self._plain_errors(), self._transaction():
            self._base.executemany(_INSERT, other.rows(_NAMES))
            self._base.executemany(_INSERT_PROFILES, other.profiles())

    def _require_ours(self, *, must_be_there: bool) -> None:
        """Raise RollnipError unless the file is a database of a sweep, or may become one."""
        mark = self._base.execute("PRAGMA application_id").fetchone()[0]
        is_new = not self._base.execute("PRAGMA schema_version").fetchone()[0]
        if mark != _APPLICATION and not (is_new and not must_be_there):
            raise RollnipError(
                f"{self.name}: is no database of a sweep; name one that `--database` made."
            )

    def _prepare(self) -> None:
        """Create the tables where the file is empty."""
        self._base.execute("PRAGMA journal_mode = WAL")
        # a commit then does not wait for the disk; only a power failure can undo the last ones
        self._base.execute("PRAGMA synchronous = NORMAL")
        self._base.execute("BEGIN IMMEDIATE")
        if not self._base.execute("PRAGMA schema_version").fetchone()[0]:
            self._base.execute(f"PRAGMA application_id = {_APPLICATION}")
            for statement in _TABLES.split(";"):
                self._base.execute(statement)
        self._base.execute("COMMIT")

    def _empty_log(self, how: str) -> None:
        """Move the log into the database file, so that a copy of that file alone has all cases."""
        if self._writer is not None:
            self._base.execute(f"PRAGMA wal_checkpoint({how})")
        self._emptied = monotonic()

    def _matching_about(self, about: About | None) -> About:
        """Return the description, writing it if new; raise where the file is another study's."""
        found = self._stored_about()
        if about is None:
            if found is None:
                raise RollnipError(f"{self.name}: holds no study yet.")
            return found
        if found is not None:
            _require_same(self.name, found, about)
        if found == about:
            return about
        with self._plain_errors(), self._transaction():
            self._base.execute("DELETE FROM about")
            text = json.dumps({"format": FORMAT, **asdict(about)})
            self._base.execute("INSERT INTO about VALUES (?)", (text,))
        return about

    def _stored_about(self) -> About | None:
        with self._plain_errors():
            rows = self._base.execute("SELECT value FROM about").fetchall()
        if not rows:
            return None
        return About(**checked_about(self.name, rows[0][0], FORMAT, _ABOUT))

    def _write(self, outcome: Outcome) -> None:
        row = outcome.row
        values: dict[str, Any] = {
            "position": outcome.position,
            "hash": outcome.case,
            "parameters": json.dumps(outcome.values),
            "seconds": outcome.seconds,
        }
        self._base.execute(_INSERT, [values[n] if n in values else row[n] for n in _NAMES])

    @contextmanager
    def snapshot(self) -> Iterator[None]:
        """Read one consistent state of the database while another process may write to it."""
        self._base.execute("BEGIN")
        try:
            yield
        finally:
            self._base.execute("ROLLBACK")

    @contextmanager
    def _transaction(self) -> Iterator[None]:
        self._base.execute("BEGIN IMMEDIATE")
        try:
            yield
            self._base.execute("COMMIT")
        except BaseException:
            if self._base.in_transaction:
                self._base.execute("ROLLBACK")
            raise

    @contextmanager
    def _plain_errors(self) -> Iterator[None]:
        """Turn an SQLite error into one clear sentence."""
        try:
            yield
        except sqlite3.Error as error:
            raise RollnipError(f"{self.name}: {plain(error)}") from error


def _require_same(name: str, found: About, wanted: About) -> None:
    hint = "choose another name for the results or the database, or delete it."
    if found.version != wanted.version:
        raise RollnipError(
            f"{name}: was made by rollnip {found.version}, this is {wanted.version}; results of "
            f"two versions are not mixed: {hint}"
        )
    if found.study != wanted.study:
        title = f'"{found.title}", ' if found.title else ""
        kind = f"{found.count} cases" if found.count else "a search"
        raise RollnipError(
            f"{name}: holds another study ({title}{kind} of {', '.join(found.paths)}): its case or "
            f"its parameters differ; {hint}"
        )
    if found.shard != wanted.shard:
        ours, theirs = ("/".join(map(str, one.shard)) for one in (wanted, found))
        raise RollnipError(f"{name}: holds shard {theirs}, not {ours}; {hint}")
