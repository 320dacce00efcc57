"""Counts of kept cases: what a stopped command says of its database, and how to go on."""

from __future__ import annotations

import signal
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from rollnip.cli.console import say

if TYPE_CHECKING:
    from rollnip.sweeps import Together
    from rollnip.sweeps.interrupt import Interrupts
    from rollnip.sweeps.store import Store


@contextmanager
def interrupts_told(store: Store, total: int | None = None) -> Iterator[Interrupts]:
    """Leave with one line and 130 after Ctrl-C, and after what a batch queue sends before it kills.

    ``total`` is the number of all cases, where it is known.
    """
    from rollnip.sweeps.interrupt import Interrupts

    with Interrupts((signal.SIGINT, signal.SIGTERM)) as interrupts:
        try:
            yield interrupts
        except KeyboardInterrupt:
            say(f"rollnip: interrupted{kept(store, total, '; ')}.\n")
            raise typer.Exit(130) from None


def kept(store: Store, total: int | None = None, before: str = "", after: str = "") -> str:
    """Return a sentence on how many cases a database holds; empty where none or in memory."""
    if store.is_in_memory or not store.size:
        return ""
    count = f"{store.size:,} cases" if total is None else f"{store.size:,} of {total:,} cases"
    return f"{before}{count} are in {store.name}: the same command goes on from there{after}"


@contextmanager
def evaluating(
    database: Path | None, tree: Mapping[str, Any], paths: Sequence[str], workers: int | None
) -> Iterator[Together]:
    """Yield the workers that solve cases; with a database, no case in it is solved again."""
    from rollnip.sweeps import recalling, together
    from rollnip.sweeps.crew import available_cores
    from rollnip.sweeps.interrupt import Interrupts

    count = available_cores() if workers is None else workers
    if database is None:
        with Interrupts() as interrupts, together(count, interrupts) as crew:
            yield crew
        return
    with (
        recalling(database, tree, paths) as recall,
        interrupts_told(recall.store) as interrupts,
        together(count, interrupts) as crew,
    ):
        recall.solve = crew.evaluate
        yield crew.like(recall)
