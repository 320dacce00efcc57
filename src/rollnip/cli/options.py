"""Options that several commands share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

Force = Annotated[
    bool,
    typer.Option(
        "--force", help="Overwrite files that rollnip did not make, or that changed since."
    ),
]

Json = Annotated[bool, typer.Option("--json", help="Print the result as JSON.")]
Out = Annotated[Path | None, typer.Option(help="Write the result: name.json or name.nc (netCDF).")]
Geometry = Annotated[
    str | None,
    typer.Option(help="Geometry: linear, corrected, curved, second or finite; overrides the file."),
]
Tolerance = Annotated[
    str | None, typer.Option(help="Wanted relative accuracy, such as 1e-3; overrides the file.")
]
Units = Annotated[
    str,
    typer.Option(
        help="Units of the summary: metric, or us (in, pli, psi, fpm, °F); JSON, files and "
        "pictures are in base units."
    ),
]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Print no summary.")]

InstrumentFile = Annotated[Path, typer.Argument(help="Text file or workbook of an instrument.")]
Temperature = Annotated[
    str | None, typer.Option(help="Temperature of all data, where there is no such column.")
]
Frequency = Annotated[
    str | None, typer.Option(help="Frequency of all data, where there is no such column.")
]
Sheet = Annotated[
    str | None, typer.Option(help="Sheet of a workbook to read; by default, all sheets.")
]

WORKERS = typer.Option(help="Number of processes; by default, one for each core.", min=1)
