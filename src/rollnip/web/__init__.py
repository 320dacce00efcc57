"""The nip designer: a web page and a JSON API over `rollnip.io` and `rollnip.solver`.

Needs the extra ``rollnip[web]``. The web framework is imported only when one of these is called,
so that the worker processes, which need no more than the solver, start quickly.
"""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import Any

from rollnip._extras import require_extra
from rollnip.web.limits import Limits

__all__ = ["Limits", "create_app", "serve"]


def create_app(
    limits: Limits | None = None, *, host: str = "127.0.0.1"
) -> Callable[[Any, Any, Any], Awaitable[None]]:
    """Build the application, a callable as ASGI has it, for tests and for other servers.

    Parameters
    ----------
    limits :
        sizes, times and numbers beyond which a request is refused; ``Limits()`` by default.
    host :
        the address it is bound to; it decides which Host headers are answered.

    Raises
    ------
    RollnipError
        where the extra ``rollnip[web]`` is not installed.
    """
    require_extra("web", "the web page")
    from rollnip.web.app import application

    return application(limits or Limits(), host)[0]


def serve(*, host: str = "127.0.0.1", port: int = 8000, open_page: bool = True) -> None:
    """Serve the designer until Ctrl-C.

    Parameters
    ----------
    host :
        address to bind; another than the loopback one is reachable by others, which is warned of.
    port :
        from 0 to 65535; 0 takes a free one.
    open_page :
        whether to open the page in a browser.

    Raises
    ------
    RollnipError
        where the address or the port cannot be bound, or the extra ``rollnip[web]`` is missing.
    KeyboardInterrupt
        after Ctrl-C, once all has been stopped.
    """
    require_extra("web", "the web page")
    from rollnip.web.server import run

    run(host, port, open_page=open_page)
