"""The running server: one socket, one event loop, until Ctrl-C."""

from __future__ import annotations

import socket
import sys
import webbrowser

import uvicorn

from rollnip._errors import RollnipError
from rollnip.web import create_app
from rollnip.web.guard import is_loopback


def run(host: str, port: int, *, open_page: bool) -> None:
    """Serve until Ctrl-C; see `rollnip.web.serve`."""
    app = create_app(host=host)
    with _bound(host, port) as listener:
        shown = f"[{host}]" if ":" in host else host
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
            timeout_graceful_shutdown=2,
        )
        uvicorn.Server(config).run(sockets=[listener])


def _bound(host: str, port: int) -> socket.socket:
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    try:
        return socket.create_server((host.strip("[]"), port), family=family, backlog=256)
    except (OSError, OverflowError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise RollnipError(
            f"cannot serve at {host}, port {port}: {reason}; choose another with --port or --host."
        ) from None


def _say(text: str) -> None:
    sys.stderr.write(text + "\n")
    sys.stderr.flush()
