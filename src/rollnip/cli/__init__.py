"""The command line, `rollnip`: parse, call, print."""

from __future__ import annotations

import os
import signal
import sys

from rollnip._own_process import ONE_THREAD, keep_freed_memory

__all__ = ["main"]


def main() -> None:
    """Run the command ``rollnip``; leaves through SystemExit with its exit code.

    0 is done, 1 not converged, 2 wrong input, 130 after Ctrl-C, 141 where the reader of the output
    has gone.
    """
    try:
        _run()
    except KeyboardInterrupt:
        sys.exit(130)
    finally:
        # Another Ctrl-C would end in a traceback, as the interpreter waits for its threads.
        signal.signal(signal.SIGINT, signal.SIG_IGN)


def _run() -> None:
    """Run the command; Ctrl-C may come at any moment, while modules are loaded, too."""
    # Threaded BLAS makes small dense systems many times slower; set before numpy loads.
    for name, threads in ONE_THREAD.items():
        os.environ.setdefault(name, threads)
    from rollnip.cli.console import (
        CLOSED_PIPE,
        open_closed_streams,
        say,
        silence,
        write_plain_letters,
    )

    keep_freed_memory()
    open_closed_streams()
    write_plain_letters()
    try:
        from rollnip.cli.app import app

        app()
    except SystemExit as error:
        # Of the help: what parses the command line makes an exit of 1 of a closed pipe.
        if isinstance(error.__context__, BrokenPipeError):
            sys.exit(CLOSED_PIPE)
        raise
    except BrokenPipeError:  # of the help; commands say what they cannot write themselves
        silence(sys.stdout)
        sys.exit(CLOSED_PIPE)
    except OSError as error:
        silence(sys.stdout)
        reason = error.strerror or error
        say(f"rollnip: cannot write to the standard output: {reason}.\n")
        sys.exit(2)
