"""Limits of a request: sizes, numbers, times."""

from __future__ import annotations

import os
from dataclasses import dataclass, field


def _workers() -> int:
    """One per core up to four; two at least, so that a long solve never stops the slider."""
    return min(max(os.cpu_count() or 1, 2), 4)


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """Limits of the server; beyond each of them a request is refused with a clear answer.

    Parameters
    ----------
    body :
        bytes of a request's body.
    body_seconds :
        time for the body to arrive [s].
    connections :
        connections at once, fewer where the system has fewer file descriptors; beyond it the
        oldest one that waits for a request gives way.
    head_seconds :
        time for the head of a request to arrive [s].
    exchange_seconds :
        time for a request and its answer [s].
    memory :
        address space of a worker [MB]; a solve that needs more is refused.
    workers :
        processes that solve; so many requests are solved at once.
    waiting :
        requests that wait for one of them; beyond it the answer is 429.
    waiting_seconds :
        time that a request waits; beyond it the answer is 429, too [s].
    long_waiting :
        sweeps and inverse solves that are under way or wait; beyond it the answer is 429.
    solve_seconds :
        time of one solve [s].
    long_seconds :
        time of a sweep or an inverse solve, once it is begun [s].
    kept :
        bytes of answers that are kept, so that a question that comes again needs no worker.
    depth :
        nesting of a body.
    layers :
        layers of a roller.
    terms :
        terms of a Prony series.
    tolerance :
        finest relative accuracy; it bounds the number of elements.
    values :
        values of a sweep.
    points :
        points of an interior field along x, and along z.
    """

    body: int = 256 * 1024
    body_seconds: float = 10.0
    connections: int = 512
    head_seconds: float = 10.0
    exchange_seconds: float = 180.0
    memory: int = 3072
    workers: int = field(default_factory=_workers)
    waiting: int = 16
    waiting_seconds: float = 5.0
    long_waiting: int = 8
    solve_seconds: float = 10.0
    long_seconds: float = 60.0
    kept: int = 16 * 1024 * 1024
    depth: int = 32
    layers: int = 20
    terms: int = 60
    tolerance: float = 1e-4
    values: int = 41
    points: int = 240
