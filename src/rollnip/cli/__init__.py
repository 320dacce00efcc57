"""The command line: parse, call, print."""

from __future__ import annotations

import os
import sys
from pathlib import Path

__all__ = ["main"]


def main() -> None:
    """Run the command ``rollnip``; leaves through SystemExit with 0, 1 or 2 (130 after Ctrl-C)."""
    # Threaded BLAS makes small dense systems many times slower; set before numpy loads.
    for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(name, "1")
    _open_closed_streams()
    try:
        from rollnip.cli.app import app

        app()
    except KeyboardInterrupt:
        sys.exit(130)
    except OSError as error:  # of the help; commands say what they cannot write themselves
        from rollnip.cli.app import _silence

        _silence(sys.stdout)
        reason = error.strerror or error
        sys.stderr.write(f"rollnip: cannot write to the standard output: {reason}.\n")
        sys.exit(2)


def _open_closed_streams() -> None:
    """Streams that the caller has closed: nothing to read, and what is written goes nowhere."""
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            stream = Path(os.devnull).open(mode, encoding="utf-8")  # noqa: SIM115 - to the end
            setattr(sys, name, stream)
