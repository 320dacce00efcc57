"""Connections: how many at once, and how long each may take to say what it wants."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from typing import Any

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol

from rollnip.web.limits import Limits

BACKLOG = 32
"""Connections that the system accepts at once, before the first of them is looked at."""
_FILES = 64  # file descriptors of the server itself and of the files that it serves


def connections_at_once(limits: Limits) -> int:
    """Return the number of connections allowed, so that a file descriptor is always left."""
    try:
        import resource
    except ImportError:  # no such limit on this system
        return limits.connections
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = limits.connections + 2 * BACKLOG + _FILES + 8 * limits.workers
    if soft < wanted:
        most = wanted if hard == resource.RLIM_INFINITY else min(hard, wanted)
        with suppress(ValueError, OSError):
            resource.setrlimit(resource.RLIMIT_NOFILE, (most, hard))
        soft = resource.getrlimit(resource.RLIMIT_NOFILE)[0]
    return max(8, limits.connections - max(0, wanted - soft))


def protocol(limits: Limits, most: int) -> type[H11Protocol]:
    """The class of a connection for uvicorn, with these limits and at most ``most`` at once."""
    return type("Connection", (_Connection,), {"limits": limits, "most": most})


class _Connection(H11Protocol):
    """One connection, which is closed where it does not say in time what it wants.

    Where too many are open, the oldest that waits for a request gives way: one that never sent a
    whole request before one that did. Who says what he wants is thus never locked out by those
    who do not.
    """

    limits: Limits
    most: int
    since = 0.0
    served = 0
    _deadline: asyncio.TimerHandle | None = None

    def connection_made(self, transport: Any) -> None:
        """Take the connection, or the place of another."""
        super().connection_made(transport)
        self.since = self.loop.time()
        self._allow(self.limits.head_seconds)
        if len(self.connections) > self.most:
            waiting: list[_Connection] = [one for one in self.connections if one.is_waiting]  # type: ignore[misc,union-attr]
            min(waiting, key=lambda one: (one.served > 0, one.since)).drop()

    def connection_lost(self, exc: Exception | None) -> None:
        """Forget the connection."""
        self._allow(None)
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """Read on; a head that has begun must end in time."""
        super().data_received(data)
        if not self.is_waiting:
            self._allow(self.limits.exchange_seconds)
        elif self._deadline is None:
            self._allow(self.limits.head_seconds)

    def on_response_complete(self) -> None:
        """An exchange has ended; the next one may begin."""
        self.served += 1
        self.since = self.loop.time()
        self._allow(None)
        super().on_response_complete()

    @property
    def is_waiting(self) -> bool:
        """True while no complete head of a request waits for its answer."""
        return self.conn.their_state is h11.IDLE

    def drop(self) -> None:
        """Close the connection at once."""
        self.connections.discard(self)
        self.transport.abort()

    def _allow(self, seconds: float | None) -> None:
        """Close after some seconds; None: never."""
        if self._deadline is not None:
            self._deadline.cancel()
        self._deadline = None if seconds is None else self.loop.call_later(seconds, self.drop)
