"""The guard before every route: who may ask, how much, and the headers of every answer."""

from __future__ import annotations

import asyncio
import re
import socket
from collections.abc import Awaitable, Callable, MutableMapping
from ipaddress import ip_address
from typing import Any

from rollnip._errors import CaseFileError
from rollnip.io.document import parse_document
from rollnip.web.answers import RefusedError
from rollnip.web.limits import Limits

Scope = MutableMapping[str, Any]
Message = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Message]]
Send = Callable[[Message], Awaitable[None]]
App = Callable[[Scope, Receive, Send], Awaitable[None]]

HEADERS = {
    # Seen of plotly.js 4.1 in Chromium: it adds two <style> elements and sets style attributes
    # (both fail without 'unsafe-inline'), draws heatmaps from data: and PNG files from blob:
    # addresses; it needs no inline script, no eval, no worker.
    "content-security-policy": (
        "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; "
        "img-src 'self' data: blob:; connect-src 'self'; font-src 'self'; manifest-src 'self'; "
        "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    ),
    "x-content-type-options": "nosniff",
    "x-frame-options": "DENY",
    "referrer-policy": "no-referrer",
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "permissions-policy": "camera=(), geolocation=(), microphone=(), payment=(), usb=()",
}
_HOST = re.compile(r"(?:\[([0-9A-Fa-f:.]+)\]|([A-Za-z0-9._-]+))(?::\d{1,5})?")
_METHODS = ("GET", "HEAD", "POST")


class Guard:
    """An ASGI application before another one.

    Refuses foreign origins and host names, bodies that are too large, too slow or no JSON; puts
    the security headers on every answer, also on those of errors.

    Parameters
    ----------
    app :
        the application behind.
    limits :
        limits of the body.
    host :
        the address the server is bound to.
    """

    def __init__(self, app: App, limits: Limits, host: str) -> None:
        self.app = app
        self._limits = limits
        self._names = own_names(host)
        self._any_address = not is_loopback(host)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer one request, or pass it on."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        sender = _with_headers(scope, send)
        try:
            body = await self._admitted(scope, receive)
        except RefusedError as error:
            await _refuse(sender, error)
        except _GoneError:
            return
        else:
            await self.app(scope, _replayed(body, receive), sender)

    async def _admitted(self, scope: Scope, receive: Receive) -> bytes:
        """The body, where the request may come in."""
        headers = {
            name.decode("latin-1"): value.decode("latin-1") for name, value in scope["headers"]
        }
        self._check_host(headers.get("host", ""))
        if scope["method"] not in _METHODS:
            raise RefusedError(405, "Only GET and POST are answered here.")
        if scope["method"] != "POST":
            return await self._body(headers, receive)
        _check_origin(headers, scope["scheme"])
        _check_type(headers.get("content-type", ""))
        body = await self._body(headers, receive)
        _check_json(body, self._limits.depth)
        return body

    def _check_host(self, host: str) -> None:
        """Refuse a Host header with a foreign name, so that no site passes for this server."""
        name = _host_name(host)
        if name in self._names or (self._any_address and _is_address(name)):
            return
        raise RefusedError(
            403, "The Host header must name this server as it was started, such as localhost."
        )

    async def _body(self, headers: dict[str, str], receive: Receive) -> bytes:
        """The whole body; its length is counted, whatever the header says."""
        most = self._limits.body
        too_large = RefusedError(413, f"A body may hold at most {most // 1024} kB.")
        length = headers.get("content-length", "")
        if length.isdecimal() and int(length) > most:
            raise too_large
        parts, size = [], 0
        try:
            async with asyncio.timeout(self._limits.body_seconds):
                while True:
                    message = await receive()
                    if message["type"] == "http.disconnect":
                        raise _GoneError
                    parts.append(message.get("body", b""))
                    size += len(parts[-1])
                    if size > most:
                        raise too_large
                    if not message.get("more_body", False):
                        return b"".join(parts)
        except TimeoutError:
            raise RefusedError(408, "The body of the request did not arrive in time.") from None


class _GoneError(Exception):
    """The client left before its request was whole."""


def is_loopback(host: str) -> bool:
    """Return whether an address is reachable from this machine only."""
    name = host.strip("[]")
    return name == "localhost" or (_is_address(name) and ip_address(name).is_loopback)


def own_names(host: str) -> frozenset[str]:
    """Names by which a server bound to ``host`` is rightly called."""
    names = {"localhost", "127.0.0.1", "::1", host.strip("[]").lower()}
    return frozenset(names if is_loopback(host) else names | {socket.gethostname().lower()})


def _is_address(name: str) -> bool:
    try:
        ip_address(name)
    except ValueError:
        return False
    return True


def _host_name(host: str) -> str:
    """The name in a Host header, without its port; empty where it cannot be read."""
    match = _HOST.fullmatch(host)
    return (match[1] or match[2]).lower() if match else ""


def _check_origin(headers: dict[str, str], scheme: str) -> None:
    """Refuse requests from pages of other sites; programs other than browsers send no Origin."""
    origin = headers.get("origin")
    site = headers.get("sec-fetch-site", "same-origin")
    own = {f"{kind}://{headers.get('host', '')}" for kind in (scheme, "https")}
    if (origin is not None and origin.lower() not in {o.lower() for o in own}) or site not in (
        "same-origin",
        "none",
    ):
        raise RefusedError(403, "Only pages of this server may send requests to it.")


def _check_type(content_type: str) -> None:
    if content_type.partition(";")[0].strip().lower() != "application/json":
        raise RefusedError(415, "The body must be JSON, sent with Content-Type: application/json.")


def _check_json(body: bytes, depth: int) -> None:
    """Refuse a body that is no JSON object, gives a key twice or is nested too deeply."""
    try:
        level: list[Any] = [parse_document(body.decode(), "body.json")]
    except UnicodeDecodeError:
        raise RefusedError(400, "The body must be JSON in UTF-8.") from None
    except CaseFileError as error:
        raise RefusedError(400, str(error).replace("body.json:", "The body")) from None
    for _ in range(depth):
        level = [part for whole in level for part in _parts(whole)]
        if not level:
            return
    raise RefusedError(400, f"The body may be nested at most {depth} deep.")


def _parts(value: Any) -> list[Any]:
    if isinstance(value, dict):
        return list(value.values())
    return value if isinstance(value, list) else []


def _replayed(body: bytes, receive: Receive) -> Receive:
    """Give the body once, then what else comes: that the client has left."""
    given = False

    async def replay() -> Message:
        nonlocal given
        if given:
            return await receive()
        given = True
        return {"type": "http.request", "body": body, "more_body": False}

    return replay


def _with_headers(scope: Scope, send: Send) -> Send:
    """Send with the security headers."""
    fixed = [(name.encode(), value.encode()) for name, value in HEADERS.items()]
    is_api = scope["path"].startswith("/api/")
    fixed.append((b"cache-control", b"no-store" if is_api else b"no-cache"))

    async def sender(message: Message) -> None:
        if message["type"] == "http.response.start":
            message = {**message, "headers": [*message.get("headers", []), *fixed]}
        await send(message)

    return sender


async def _refuse(send: Send, error: RefusedError) -> None:
    headers = {
        "content-type": "application/json",
        "content-length": str(len(error.body)),
        "connection": "close",  # what is left of the body is not read
        **error.headers,
    }
    raw = [(name.encode(), value.encode()) for name, value in headers.items()]
    await send({"type": "http.response.start", "status": error.status, "headers": raw})
    await send({"type": "http.response.body", "body": error.body})
