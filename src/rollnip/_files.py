"""Writing a file all or nothing."""

from __future__ import annotations

import os
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from rollnip._errors import RollnipError


def check_target(path: Path, suffixes: tuple[str, ...]) -> None:
    """Raise RollnipError unless ``path`` could be written: its ending, its folder, no folder."""
    if path.suffix.lower() not in suffixes:
        raise RollnipError(f"{path}: the name must end in {' or '.join(suffixes)}.")
    check_place(path)


def check_place(path: Path) -> None:
    """Raise RollnipError unless a file could be written to ``path``, whatever its ending."""
    if path.is_dir():
        raise RollnipError(f"{path}: cannot write, it is a directory.")
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
    becomes a RollnipError of one line.
    """
    target = Path(os.path.realpath(path))
    temporary = target.with_name(f".{os.getpid()}-{target.name}")
    try:
        write(temporary)
        temporary.replace(target)
    except OSError as error:
        raise RollnipError(f"{path}: cannot write: {error.strerror or error}.") from error
    finally:
        with suppress(OSError):
            temporary.unlink(missing_ok=True)
