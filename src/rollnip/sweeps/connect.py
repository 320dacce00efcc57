"""Connections to the database of a sweep: one process writes while any number read."""

from __future__ import annotations

import os
import sqlite3
from contextlib import suppress
from pathlib import Path

from rollnip._errors import RollnipError
from rollnip._files import check_place

_LOCK_SECONDS = 0.5  # longest wait for the lock file of the writer
_BUSY_SECONDS = 30.0  # longest wait for another connection that is closing the database


class Writer:
    """The right to write a database, held by one process at a time until it closes or dies.

    It is a lock that SQLite keeps on a separate file beside the database, so that the database
    itself
    stays open to readers. The operating system releases the lock however the process ends.

    Parameters
    ----------
    path : path of the database.

    Raises
    ------
    RollnipError
        where another process holds the lock, or the folder cannot be written.
    """

    def __init__(self, path: Path) -> None:
        self._file = path.with_name(f"{path.name}-lock")
        self._base = sqlite3.connect(self._file, isolation_level=None, timeout=_LOCK_SECONDS)
        try:
            self._base.execute("BEGIN EXCLUSIVE")
        except sqlite3.Error as error:
            self._base.close()
            raise RollnipError(f"{path}: {plain(error)}") from error

    def close(self) -> None:
        """Release the lock and remove its file."""
        with suppress(OSError):
            self._file.unlink(missing_ok=True)
        with suppress(sqlite3.Error):
            self._base.close()


def open_to_write(path: Path | None) -> sqlite3.Connection:
    """Open a database, creating it if needed; None: in memory. Raises RollnipError."""
    if path is not None:
        check_place(path)
    try:
        return sqlite3.connect(
            ":memory:" if path is None else path,
            isolation_level=None,
            timeout=_BUSY_SECONDS,
            check_same_thread=False,  # `Recall` is called from threads, one at a time
        )
    except sqlite3.Error as error:
        raise RollnipError(f"{path}: cannot be opened: {error}.") from None


def open_to_read(path: Path) -> sqlite3.Connection:
    """Open an existing database for reading, even while another process writes it.

    Raises
    ------
    RollnipError
        where there is no such file, or some of its rows are in a write-ahead log that cannot be
        read
        without writing.
    """
    if not path.is_file():
        raise RollnipError(f"{path}: there is no such file.")
    log = log_of(path)
    if os.access(path, os.W_OK) and os.access(path.parent, os.W_OK):
        mode = "mode=rw"
    elif log.is_file() and log.stat().st_size:
        raise RollnipError(
            f"{path}: cannot be read where nothing can be written, for some of its cases are in "
            f"{log.name}; copy both files to a folder that can be written."
        )
    else:
        mode = "mode=ro&immutable=1"
    try:
        return sqlite3.connect(
            f"{path.absolute().as_uri()}?{mode}",
            uri=True,
            isolation_level=None,
            timeout=_BUSY_SECONDS,
        )
    except sqlite3.Error as error:
        raise RollnipError(f"{path}: cannot be opened: {error}.") from None


def log_of(path: Path) -> Path:
    """Return the path of a database's write-ahead log, which holds the newest cases.

    They stay there until they are moved into the database itself.
    """
    return path.with_name(f"{path.name}-wal")


def is_being_written(path: Path) -> bool:
    """Return whether a process is writing the database now."""
    if not path.with_name(f"{path.name}-lock").is_file():
        return False
    try:
        Writer(path).close()
    except RollnipError:
        return True
    return False


def plain(error: sqlite3.Error) -> str:
    """Return an SQLite error as one clear sentence without its subject."""
    text, code = str(error), getattr(error, "sqlite_errorname", "") or ""
    if code.startswith(("SQLITE_BUSY", "SQLITE_LOCKED")) or "locked" in text:
        return "is in use by another process; wait for it to end."
    if code.startswith(("SQLITE_NOTADB", "SQLITE_CORRUPT")):
        return f"is no database of a sweep, or is damaged ({text})."
    if code.startswith(("SQLITE_READONLY", "SQLITE_CANTOPEN", "SQLITE_PERM")):
        return f"cannot be written, nor files beside it ({text}): choose a folder that can be."
    kept = "What was finished before is kept; run the same again then."
    if code.startswith("SQLITE_FULL"):
        return f"cannot write ({text}): the disk is full; make room. {kept}"
    if "READ" in code:
        return f"cannot be read ({text}): the disk fails."
    if code.startswith("SQLITE_IOERR"):
        return f"cannot write ({text}): the disk is full, or fails. {kept}"
    return f"cannot be used: {text}."
