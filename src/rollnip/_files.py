"""Files of one command: what it reads is never written over, what it writes is whole or not there.

A command opens a run (`one_run`). Readers tell the run what they read (`reading`); the command
reserves what it will write (`Run.reserve`) before it computes. A file that is there already may
be written over where a run of rollnip wrote it and nobody changed it since, or with ``force``.
That is told by a checksum of what was written, kept under the name of the file in the folder for
the state of programs of the user; the files themselves carry no mark.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from dataclasses import dataclass, field
from hashlib import file_digest, sha256
from pathlib import Path

from rollnip._errors import RollnipError

_DIGITS = 24  # of each checksum
_Identity = tuple[int, int]


@dataclass(slots=True)
class Run:
    """The files of one command.

    Attributes
    ----------
    force : whether files that rollnip did not make may be written over.
    """

    force: bool
    _read: dict[str | _Identity, str] = field(default_factory=dict)
    _targets: dict[str, str] = field(default_factory=dict)

    def reserve(self, targets: Mapping[str, Path | None]) -> None:
        """Claim files to be written, each under its option; None: the option was not given.

        Raises
        ------
        RollnipError
            where two options name one file, the run reads the file, or it is there, is not as
            rollnip wrote it and ``force`` is not given.
        """
        for option, path in targets.items():
            if path is None:
                continue
            place = os.path.realpath(path)
            if place in self._targets:
                raise RollnipError(
                    f"{path}: must not be written by {self._targets[place]} and {option} both; "
                    "choose two names."
                )
            self._targets[place] = option
            self.require_free(path)

    def require_free(self, path: Path) -> None:
        """Raise RollnipError where a file must not be written over."""
        if any(key in self._read for key in _keys(path)):
            raise RollnipError(
                f"{path}: must not be written over, this command reads it; choose another name."
            )
        if not self.force and path.is_file() and not _is_own(path):
            raise RollnipError(
                f"{path}: is there already, and is not as rollnip wrote it; choose another name, "
                "or write over it with --force."
            )

    def note(self, path: Path) -> None:
        """Record a file that is read; raise RollnipError if it is to be written."""
        for key in _keys(path):
            self._read[key] = str(path)
        for place, option in self._targets.items():
            if any(key in self._read for key in _keys(Path(place))):
                raise RollnipError(
                    f"{path}: must not be written over, this command reads it; choose another "
                    f"name for {option}."
                )

    def note_input(self) -> None:
        """Record the file that the standard input comes from, if it comes from a file."""
        with suppress(OSError, ValueError):
            found = os.fstat(sys.stdin.fileno())
            self._read[(found.st_dev, found.st_ino)] = "the standard input"


# The run that is open in this context. The functions that read files lie several layers below the
# commands, and Python programs, which open no run, call them too: a context variable reaches them
# without an argument.
_RUN: ContextVar[Run | None] = ContextVar("run", default=None)


@contextmanager
def one_run(*, force: bool = False) -> Iterator[Run]:
    """Open a run, in which no file that is read is written over; keep a run that is open."""
    outer = _RUN.get()
    if outer is not None:
        yield outer
        return
    token = _RUN.set(Run(force))
    try:
        run = _RUN.get()
        assert run is not None
        yield run
    finally:
        _RUN.reset(token)


def reading(path: str | Path) -> None:
    """Record with the open run, if any, that a file is read; ``-`` is the standard input.

    Raises RollnipError where the run is to write that file.
    """
    run = _RUN.get()
    if run is None:
        return
    if str(path) == "-":
        run.note_input()
    else:
        run.note(Path(path))


def check_target(path: Path, suffixes: tuple[str, ...]) -> None:
    """Raise RollnipError unless ``path`` could be written: its ending, its folder, no folder."""
    if path.suffix.lower() not in suffixes:
        raise RollnipError(f"{path}: the name must end in {' or '.join(suffixes)}.")
    check_place(path)


def check_place(path: Path) -> None:
    """Raise RollnipError unless a file could be written to ``path``, whatever its ending."""
    if path.is_dir():
        raise RollnipError(f"{path}: cannot write, it is a directory.")
    _require_regular(path)
    folder = path.parent
    if not folder.is_dir():
        raise RollnipError(f"{path}: cannot write, there is no directory {folder}.")
    if not os.access(folder, os.W_OK):
        raise RollnipError(f"{path}: cannot write, the directory {folder} is not writable.")


def make_folder(folder: Path) -> None:
    """Make a folder and those above it; RollnipError where it is a file or cannot be made."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except FileExistsError:
        raise RollnipError(f"{folder}: must be a folder, it is a file.") from None
    except OSError as error:
        raise RollnipError(
            f"{folder}: cannot make the folder: {error.strerror or error}."
        ) from error


def write_whole(path: Path, write: Callable[[Path], object]) -> None:
    """Let ``write`` fill a temporary file beside ``path``, then rename it onto ``path``.

    Whatever goes wrong, ``path`` stays as it was and the temporary file is removed; an OSError
    becomes a RollnipError of one line. In a run, what it must not write over raises RollnipError.
    """
    run = _RUN.get()
    target = Path(os.path.realpath(path))
    temporary = target.with_name(f".{os.getpid()}-{target.name}")
    if run is not None:
        run.require_free(path)
    try:
        _require_regular(path)
        write(temporary)
        old = None if run is None else _mark(target)
        temporary.replace(target)
        if run is not None:
            _remember(target, old)
    except OSError as error:
        raise RollnipError(f"{path}: cannot write: {error.strerror or error}.") from error
    finally:
        with suppress(OSError):
            temporary.unlink(missing_ok=True)


def _require_regular(path: Path) -> None:
    """Raise RollnipError for a pipe or a device, which the finished file would take the place of.

    ``/dev/null`` itself would be lost to all programs of the machine.
    """
    if path.exists() and not path.is_file() and not path.is_dir():
        raise RollnipError(f"{path}: cannot write, it is a pipe or a device; name a file.")


def _keys(path: Path) -> list[str | _Identity]:
    """Return what identifies a file: its true path and, where it exists, its device and inode."""
    keys: list[str | _Identity] = []
    with suppress(OSError, ValueError):
        keys.append(os.path.realpath(path))
        found = path.stat()
        keys.append((found.st_dev, found.st_ino))
    return keys


def _is_own(path: Path) -> bool:
    """Return whether a file is as a run of rollnip last wrote it."""
    try:
        mark = _mark(Path(os.path.realpath(path)))
        return mark is not None and mark.exists()
    except OSError:
        return False


def _remember(target: Path, old: Path | None) -> None:
    """Store the mark of the present content of ``target``, in place of an old mark.

    Where the mark cannot be stored, the file counts as written by another program.
    """
    with suppress(OSError):
        mark = _mark(target)
        if mark is None:
            return
        mark.parent.mkdir(parents=True, exist_ok=True)
        mark.touch()
        if old is not None and old != mark:
            old.unlink(missing_ok=True)


def _mark(target: Path) -> Path | None:
    """Return the path of the mark that rollnip wrote ``target`` as it is; None: no file there."""
    if not target.is_file():
        return None
    name = sha256(str(target).encode("utf-8", "surrogateescape")).hexdigest()[:_DIGITS]
    with target.open("rb") as stream:
        found = file_digest(stream, "sha256").hexdigest()[:_DIGITS]
    return _memory() / f"{name}-{found}"


def _memory() -> Path:
    """Return the folder of this user's marks."""
    state = os.environ.get("XDG_STATE_HOME") or os.environ.get("LOCALAPPDATA")
    try:
        folder = Path(state) if state else Path.home() / ".local" / "state"
    except RuntimeError as error:  # a user without a home
        raise OSError(str(error)) from None
    return folder / "rollnip" / "written"
