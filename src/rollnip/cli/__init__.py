"""The command line: parse, call, print."""

from __future__ import annotations

import os
import sys

__all__ = ["main"]


def main() -> None:
    """Run the command ``rollnip``; leaves through SystemExit with 0, 1 or 2 (130 after Ctrl-C)."""
    # Threaded BLAS makes small dense systems many times slower; set before numpy loads.
    for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(name, "1")
    try:
        from rollnip.cli.app import app

        app()
    except KeyboardInterrupt:
        sys.exit(130)
