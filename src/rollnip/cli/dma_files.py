"""The commands ``dma show``: what was understood of the file of an instrument."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer


def show(
    file: Annotated[Path, typer.Argument(help="Text file or workbook of an instrument.")],
    temperature: Annotated[
        str | None, typer.Option(help="Of all data, where there is no such column.")
    ] = None,
    frequency: Annotated[
        str | None, typer.Option(help="Of all data, where there is no such column.")
    ] = None,
    sheet: Annotated[str | None, typer.Option(help="The only one of a workbook to read.")] = None,
) -> None:
    """Say what is understood of a file: tables, columns, units, ranges, and what is left out."""
    from rollnip.cli.app import _clear_failures
    from rollnip.cli.dma import _read

    with _clear_failures():
        from rollnip.dma import read_tables

        reading = read_tables(
            file,
            temperature=_read("--temperature", temperature, "temperature"),
            frequency=_read("--frequency", frequency, "frequency"),
            sheet=sheet,
        )
        sys.stdout.write(reading.text())
        sys.stdout.flush()
