"""Messages of the commands: one for each user error, exit codes, letters that can be encoded."""

from __future__ import annotations

import codecs
import os
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, TextIO, cast

import typer

from rollnip._errors import ConvergenceError, InvalidInputError, RollnipError

if TYPE_CHECKING:
    from rich.console import Console

    from rollnip._units import Dimension
    from rollnip.model import Geometry, Model

CLOSED_PIPE = 141
"""Exit code where the reader of the output has gone, as a shell has it after SIGPIPE."""

_PLAIN = {"±": "+-", "−": "-", "–": "-", "·": ".", "µ": "u", "°": "deg ", "²": "2", "…": "..."}
_ERRORS = "rollnip.plain"


@contextmanager
def clear_failures() -> Iterator[None]:
    """Turn what a user can cause into one message on stderr and an exit code.

    The standard output is written out at the end, so that what goes wrong there is heard of.
    """
    try:
        yield
        sys.stdout.flush()
    except ConvergenceError as error:
        leave(str(error), 1)
    except RollnipError as error:
        leave(str(error), 2)
    except KeyboardInterrupt:
        leave("interrupted.", 130)
    except ImportError as error:
        if not is_interrupt(error):
            raise
        leave("interrupted.", 130)
    except BrokenPipeError:
        silence(sys.stdout)
        raise typer.Exit(CLOSED_PIPE) from None
    except OSError as error:
        silence(sys.stdout)
        leave(f"cannot write to the standard output: {error.strerror or error}.", 2)


def is_interrupt(error: BaseException | None) -> bool:
    """Return whether an error is, or comes of, a Ctrl-C.

    A compiled module that is interrupted while it is loaded says that its initialization failed.
    """
    while error is not None and not isinstance(error, KeyboardInterrupt):
        error = error.__cause__ or error.__context__
    return error is not None


def require_no_empty(arguments: Sequence[str]) -> None:
    """Raise InvalidInputError where an argument is an empty text, as of an unset shell variable.

    An empty path would mean the working directory.
    """
    for before, argument in zip(("", *arguments), arguments, strict=False):
        option = argument[:-1] if argument[:1] == "-" and argument[-1:] == "=" else before
        if argument and option is before:
            continue
        if option.startswith("--"):
            raise InvalidInputError(f"`{option}` is empty; give it a value, or leave it out.")
        raise InvalidInputError(
            'an argument is empty; give the name of a file, such as "nip.toml".'
        )


def look_at(file: str) -> None:
    """Raise CaseFileError where a file is missing or no document, before numerics are loaded.

    The standard input can be read but once: it is left to who reads it.
    """
    from rollnip.io.document import read_document

    if file != "-":
        read_document(file)


@contextmanager
def named(source: str) -> Iterator[None]:
    """Prefix an input error raised inside the block with the name of its option or file."""
    try:
        yield
    except InvalidInputError as error:
        raise InvalidInputError(f"{source}: {error}") from None


@contextmanager
def named_by(sources: Mapping[str, str], otherwise: str) -> Iterator[None]:
    """Prefix an input error raised inside the block with the source of the value it is about.

    Parameters
    ----------
    sources : option or file of each value, by the name with which a message begins.
    otherwise : source of all others.
    """
    try:
        yield
    except InvalidInputError as error:
        name = str(error).partition("` ")[0].removeprefix("`")
        raise InvalidInputError(f"{sources.get(name, otherwise)}: {error}") from None


def overridden(model: Model, geometry: str | None, tolerance: str | None) -> Model:
    """Return the model with what the options ``--geometry`` and ``--tolerance`` say."""
    from dataclasses import replace

    from rollnip._units import parse_quantity

    if tolerance is not None:
        with named("--tolerance"):
            model = replace(model, tolerance=parse_quantity(tolerance, "ratio"))
    if geometry is not None:
        with named("--geometry"):
            model = replace(model, geometry=cast("Geometry", geometry))
    return model


def read_option(option: str, text: str | None, dimension: Dimension) -> float | None:
    """Return what an option says, in base units; None where it is not given."""
    if text is None:
        return None
    from rollnip._units import parse_quantity

    with named(option):
        return parse_quantity(text, dimension)


def write(text: str) -> None:
    """Write a text to the standard output, at once."""
    sys.stdout.write(text)
    sys.stdout.flush()


def say(text: str) -> None:
    """Write a text to the standard error, at once; where that cannot be written, nothing.

    The exit code and the standard output then still say what became of the command.
    """
    try:
        sys.stderr.write(text)
        sys.stderr.flush()
    except OSError:
        silence(sys.stderr)


def warn(texts: Iterable[str]) -> None:
    """Write warnings to the standard error, each in a line of its own."""
    say("".join(f"rollnip: warning: {text}\n" for text in texts))


def leave(message: str, code: int) -> None:
    """Say why on the standard error, and leave with a code."""
    say(f"rollnip: {message}\n")
    raise typer.Exit(code) from None


def silence(stream: TextIO) -> None:
    """Send what is still in the buffer nowhere, so that leaving does not fail on it again."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def terminal() -> Console:
    """Return a console on the standard output that lets a closed pipe be heard of."""
    from rich.console import Console

    class Terminal(Console):
        def on_broken_pipe(self) -> None:
            raise BrokenPipeError

    return Terminal(highlight=False)


def open_closed_streams() -> None:
    """Open streams that the caller has closed: nothing to read, what is written goes nowhere."""
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            stream = Path(os.devnull).open(mode, encoding="utf-8")  # noqa: SIM115 - to the end
            setattr(sys, name, stream)


def write_plain_letters() -> None:
    """Let both outputs write letters that their encoding does not have as others, never fail."""
    codecs.register_error(_ERRORS, _plain)
    for stream in (sys.stdout, sys.stderr):
        reconfigure = getattr(stream, "reconfigure", None)
        if reconfigure is not None:
            reconfigure(errors=_ERRORS)


def _plain(error: UnicodeError) -> tuple[str, int]:
    """Replace letters that cannot be encoded: by a plain equivalent, else by their code number."""
    assert isinstance(error, UnicodeEncodeError)
    letters = error.object[error.start : error.end]
    told = (_PLAIN.get(one, one.encode("ascii", "backslashreplace").decode()) for one in letters)
    return "".join(told), error.end
