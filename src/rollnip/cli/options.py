"""Options that several commands have."""

from __future__ import annotations

from typing import Annotated

import typer

Force = Annotated[
    bool,
    typer.Option("--force", help="Write over files that rollnip did not make, or that changed."),
]

WORKERS = typer.Option(help="Processes; by default one for each core.", min=1)
