"""The running server: one socket, one event loop, until Ctrl-C."""

from __future__ import annotations

import os
import socket
import sys
import webbrowser

import uvicorn

from rollnip._errors import RollnipError
from rollnip.web.app import application
from rollnip.web.desk import Desk
from rollnip.web.guard import is_loopback
from rollnip.web.limits import Limits
from rollnip.web.quiet import keep_quiet
from rollnip.web.wire import BACKLOG, connections_at_once, protocol

_EVERY = {"0.0.0.0": "127.0.0.1", "::": "::1"}  # not to be asked by that name


class _Server(uvicorn.Server):
    """Ends the solves before it waits for their requests, so that Ctrl-C takes no time."""

    def __init__(self, config: uvicorn.Config, desk: Desk) -> None:
        super().__init__(config)
        self._desk = desk

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Stop."""
        await self._desk.pool.stop()
        await super().shutdown(sockets)


def run(host: str, port: int, *, open_page: bool) -> None:
    """Serve until Ctrl-C; see `rollnip.web.serve`."""
    limits = Limits()
    app, desk = application(limits, host)
    with _bound(host, port) as listener:
        name = _EVERY.get(host, host).strip("[]")
        shown = f"[{name}]" if ":" in name else name
        address = f"http://{shown}:{listener.getsockname()[1]}/"
        if not is_loopback(host):
            _say(
                f"Warning: {host} lets everyone on the network use this server; it knows no "
                "passwords. Leave out --host to serve this machine only."
            )
        _say(f"rollnip designer at {address} (stop with Ctrl-C)")
        if open_page:
            webbrowser.open(address)
        config = uvicorn.Config(
            app,
            log_level="warning",
            server_header=False,
            proxy_headers=False,
            ws="none",
            loop="asyncio",
            http=protocol(limits, connections_at_once(limits)),
            backlog=BACKLOG,
            timeout_graceful_shutdown=2,
        )
        keep_quiet("uvicorn.error", "asyncio", "rollnip.web.pool")
        _Server(config, desk).run(sockets=[listener])


def _bound(host: str, port: int) -> socket.socket:
    if not host.strip("[]"):
        raise RollnipError("`--host` must be an address, got an empty text (0.0.0.0 is every one).")
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    try:
        return socket.create_server((host.strip("[]"), port), family=family, backlog=BACKLOG)
    except (OSError, OverflowError) as error:
        # create_server puts the address into the text of an error of the system.
        number = getattr(error, "errno", None) or 0
        reason = os.strerror(number) if number > 0 else str(error)
        raise RollnipError(
            f"Cannot serve at {host}, port {port}: {reason}; choose another with --port or --host."
        ) from None


def _say(text: str) -> None:
    sys.stderr.write(text + "\n")
    sys.stderr.flush()
