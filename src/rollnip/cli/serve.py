"""The command ``serve``: the nip designer in the browser."""

from __future__ import annotations

from typing import Annotated

import typer

from rollnip.cli.console import clear_failures


def serve(
    host: Annotated[
        str, typer.Option(help="Address to bind; any but 127.0.0.1 is open to the network.")
    ] = "127.0.0.1",
    port: Annotated[
        int, typer.Option(help="Port to bind; 0 takes a free one.", min=0, max=65535)
    ] = 8000,
    no_open: Annotated[bool, typer.Option("--no-open", help="Do not open a browser.")] = False,
) -> None:
    """Serve the nip designer, a web page and a JSON API, until Ctrl-C."""
    with clear_failures():
        from rollnip.web import serve as serve_page

        serve_page(host=host, port=port, open_page=not no_open)
