"""The command ``paper``: figures 4 to 8 of Braat & Kalker (1993), computed."""

from __future__ import annotations

from json import dumps
from pathlib import Path
from typing import Annotated

import typer

from rollnip._files import make_folder, one_run
from rollnip.cli.console import clear_failures, write
from rollnip.cli.options import Force


def paper(
    out: Annotated[Path, typer.Option(help="Folder for the pictures; made where there is none.")],
    table: Annotated[
        bool,
        typer.Option("--table", help="Also assumptions.md: what is not said, and how it matters."),
    ] = False,
    json: Annotated[bool, typer.Option("--json", help="Print the files as JSON.")] = False,
    force: Force = False,
) -> None:
    """Compute and draw figures 4 to 8 of Braat & Kalker (1993).

    The points in figures 6 to 8 are simulated, not measured, and say so.
    """
    with clear_failures(), one_run(force=force) as run:
        make_folder(out)
        from rollnip.plots.paper import PICTURES, save_paper

        targets = [*PICTURES, "assumptions.md"] if table else PICTURES
        run.reserve({f"--out ({name})": out / name for name in targets})

        written = save_paper(out)
        if table:
            from rollnip._files import write_whole
            from rollnip.paper import effects, effects_table

            text, path = effects_table(list(effects())), out / "assumptions.md"
            write_whole(path, lambda file: file.write_text(text, "utf-8"))
            written.append(path)
        names = [str(path) for path in written]
        plain = "".join(f"{name}\n" for name in names)
        write(f"{dumps({'files': names}, indent=2)}\n" if json else plain)
