"""The command ``rubber fit``: from tests at large strain to a strain energy."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rollnip._errors import InvalidInputError
from rollnip._files import one_run
from rollnip._json import json_text
from rollnip.cli.console import clear_failures, read_option, warn
from rollnip.cli.options import Force

if TYPE_CHECKING:
    from rollnip.rubber import RubberFit

rubber = typer.Typer(
    name="rubber",
    help="Rubber at large strain: tests and strain energies.",
    add_completion=False,
    rich_markup_mode=None,
    no_args_is_help=True,
)


@rubber.callback()
def of_rubber() -> None:
    """Tests of rubber at large strain, and strain energies."""


@rubber.command()
def fit(
    files: Annotated[
        list[Path],
        typer.Argument(help="Tables of tests, CSV or workbook: test, stretch or strain, stress."),
    ],
    test: Annotated[
        str | None,
        typer.Option(
            help="Test that all rows are of, where there is no such column: tension, "
            "compression, equibiaxial, planar or shear."
        ),
    ] = None,
    law: Annotated[
        str, typer.Option(help="Strain energy: neo-hookean, yeoh, gent or ogden.")
    ] = "yeoh",
    terms: Annotated[int, typer.Option(help="Number of terms of ogden, 1 to 4.")] = 2,
    strain: Annotated[
        str | None,
        typer.Option(help="Leave out measurements beyond this strain, such as 100 %."),
    ] = None,
    poisson: Annotated[float, typer.Option(help="Poisson's ratio that the material gets.")] = 0.5,
    sheet: Annotated[
        str | None, typer.Option(help="Sheet of a workbook to read; by default, the first.")
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="Write the material: name.toml, for [materials] of a case.")
    ] = None,
    plot: Annotated[
        Path | None, typer.Option(help="Draw tests and energy: name.png, .svg or .pdf.")
    ] = None,
    name: Annotated[str, typer.Option(help="Name of the material in the case.")] = "rubber",
    json: Annotated[
        bool, typer.Option("--json", help="Print what was found as JSON, in place of the table.")
    ] = False,
    force: Force = False,
) -> None:
    """Fit a strain energy to tension, compression, equibiaxial, planar and shear tests.

    Prints the material as a table for the case file, with its deviation from the data, the
    intervals of its constants and where it is not stable in comments; warnings go to the standard
    error.
    """
    with clear_failures(), one_run(force=force) as run:
        from rollnip._files import check_target
        from rollnip.rubber import fit_dict, fit_rubber, joined, read_rubber, rubber_toml

        if out is not None:
            check_target(out, (".toml",))
        if plot is not None:
            check_target(plot, (".png", ".svg", ".pdf"))
        _require_each_once(files)
        largest = read_option("--strain", strain, "ratio")
        data = joined([read_rubber(file, test=test, sheet=sheet) for file in files])  # type: ignore[arg-type]
        if largest is not None:
            if not largest > 0.0:
                raise InvalidInputError(f"`--strain` must be positive, got {strain}.")
            data = data.up_to(largest)
        run.reserve({"--out": out, "--plot": plot})
        found = fit_rubber(data, law, terms=terms, poisson=poisson)  # type: ignore[arg-type]
        text = rubber_toml(found, name)
        _write(found, text, out, plot)
        if json:
            sys.stdout.write(json_text(fit_dict(found)) + "\n")
        elif out is None:
            sys.stdout.write(text)
        sys.stdout.flush()
        warn(found.warnings)


def _require_each_once(files: list[Path]) -> None:
    """Raise where a file is given twice: its rows would count twice."""
    for number, file in enumerate(files):
        if file.resolve() in [one.resolve() for one in files[:number]]:
            raise InvalidInputError(f"{file}: must be given once; its rows would count twice.")


def _write(found: RubberFit, text: str, out: Path | None, plot: Path | None) -> None:
    from rollnip._files import write_whole

    if out is not None:
        write_whole(out, lambda file: file.write_text(text, "utf-8"))
    if plot is not None:
        from rollnip.plots import save_figure
        from rollnip.rubber import plot_rubber

        save_figure(plot_rubber(found), plot)
