"""Options that several commands share."""

from __future__ import annotations

from typing import Annotated

import typer

Force = Annotated[
    bool,
    typer.Option(
        "--force", help="Overwrite files that rollnip did not make, or that changed since."
    ),
]

WORKERS = typer.Option(help="Number of processes; by default, one for each core.", min=1)
