"""Reading files that others wrote: regular files alone, at most so many bytes."""

from __future__ import annotations

import os
from pathlib import Path
from stat import S_ISDIR, S_ISREG

_PART = 2**18  # bytes


class UnreadableError(Exception):
    """Why a file is not read, as the end of a sentence that begins with its name."""


def read_regular(path: str | Path, largest: int) -> bytes:
    """Return the bytes of a regular file.

    What is no regular file (a pipe, a device, a socket) is refused before anything is read: it
    could block, or never end.

    Parameters
    ----------
    path : of the file.
    largest : number of bytes that are accepted.

    Raises
    ------
    UnreadableError
        with the reason: "there is no such file.", "is a directory.", ...
    """
    try:
        # Without waiting: a pipe that nobody writes to would block even while it is opened.
        number = os.open(
            path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
        )
    except FileNotFoundError:
        raise UnreadableError("there is no such file.") from None
    except OSError as error:
        if isinstance(error, PermissionError) and os.path.isdir(path):  # noqa: PTH112 - never raises
            raise UnreadableError("is a directory, not a file.") from None
        raise UnreadableError(f"cannot be read: {error.strerror or error}.") from None
    except ValueError:
        raise UnreadableError("cannot be the name of a file.") from None
    try:
        return _checked(number, largest)
    except OSError as error:
        raise UnreadableError(f"cannot be read: {error.strerror or error}.") from None
    finally:
        os.close(number)


def _checked(number: int, largest: int) -> bytes:
    found = os.fstat(number)
    if S_ISDIR(found.st_mode):
        raise UnreadableError("is a directory, not a file.")
    if not S_ISREG(found.st_mode):
        raise UnreadableError(
            "must be a regular file, it is a pipe or a device; write it to a file first (a case "
            "may come on the standard input: give - as its name)."
        )
    too_large = f"must be at most {largest:,} bytes large, it is larger."
    if found.st_size > largest:
        raise UnreadableError(too_large)
    parts: list[bytes] = []
    left = largest + 1  # /proc says 0, and a file may grow
    while left > 0 and (part := os.read(number, min(left, _PART))):
        parts.append(part)
        left -= len(part)
    if left <= 0:
        raise UnreadableError(too_large)
    return b"".join(parts)
