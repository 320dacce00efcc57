"""What stops a command that keeps its cases in a database: it says how many, and how to go on."""

from __future__ import annotations

import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from rollnip.sweep.interrupt import Interrupts
    from rollnip.sweep.store import Store


@contextmanager
def interrupts_told(store: Store, total: int | None = None) -> Iterator[Interrupts]:
    """Leave with one line and 130 after Ctrl-C, and after what a batch queue sends before it kills.

    ``total`` is the number of all cases, where it is known.
    """
    from rollnip.sweep.interrupt import Interrupts

    with Interrupts((signal.SIGINT, signal.SIGTERM)) as interrupts:
        try:
            yield interrupts
        except KeyboardInterrupt:
            sys.stderr.write(f"rollnip: interrupted{kept(store, total, '; ')}.\n")
            raise typer.Exit(130) from None


def kept(store: Store, total: int | None = None, before: str = "", after: str = "") -> str:
    """How many cases a database holds, in words; nothing where none, or where it is in memory."""
    if store.is_in_memory or not store.size:
        return ""
    count = f"{store.size:,} cases" if total is None else f"{store.size:,} of {total:,} cases"
    return f"{before}{count} are in {store.name}: the same command goes on from there{after}"
