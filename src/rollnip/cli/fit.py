"""The command ``fit``: unknown values of a case from measurements."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, cast

import typer

from rollnip._files import make_folder, one_run
from rollnip.cli.console import clear_failures, look_at, named
from rollnip.cli.kept import evaluating
from rollnip.cli.options import Force

if TYPE_CHECKING:
    from rollnip.identification import Fit
    from rollnip.model import Geometry

_FILES = ("report.txt", "fit.json", "case.toml", "fit.png")


def fit(
    file: Annotated[str, typer.Argument(help="Fit file, TOML or JSON: case, unknowns, data.")],
    out: Annotated[
        Path | None,
        typer.Option(help="Folder for report.txt, fit.json, fit.png and the fitted case.toml."),
    ] = None,
    geometry: Annotated[
        str | None,
        typer.Option(
            help="Geometry: linear, corrected, curved, second or finite; overrides the file."
        ),
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print the fit as JSON.")] = False,
    workers: Annotated[int, typer.Option(help="Number of processes that solve nips.", min=1)] = 1,
    database: Annotated[
        Path | None,
        typer.Option(
            help="Database, name.db, of the finished nips; the same command resumes from it."
        ),
    ] = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print no report.")] = False,
    force: Force = False,
) -> None:
    """Find unknown values of a case from measurements, with intervals and warnings.

    The exit code is 0 where the nips at the fitted values were verified, 1 where they were not,
    2 for wrong input.
    """
    with clear_failures(), one_run(force=force) as run:
        look_at(file)
        from dataclasses import replace

        from rollnip._json import json_text
        from rollnip.identification import fit_dict, fit_report, identify, read_fit

        study = read_fit(file)
        method = study.method
        if geometry is not None:
            with named("--geometry"):
                method = replace(method, geometry=_geometry(geometry))
        if out is not None:
            make_folder(out)
            run.reserve({f"--out ({name})": out / name for name in _FILES})
        paths = [one.path for one in study.unknowns]
        with (
            named(file),
            evaluating(database, study.case, paths, workers) as workforce,
            _progress() as on_solve,
        ):
            found = identify(
                study.case,
                study.unknowns,
                study.cost,
                method,
                on_solve=on_solve,
                workforce=workforce,
            )
        if out is not None:
            _write(found, study.title, out)
        if json:
            sys.stdout.write(json_text(fit_dict(found)) + "\n")
        elif not quiet:
            sys.stdout.write(fit_report(found, study.title))
        sys.stdout.flush()
    if not found.verified:
        raise typer.Exit(1)


def _geometry(name: str) -> Geometry:
    from rollnip.model import Model

    return Model(geometry=cast("Geometry", name)).geometry


@contextmanager
def _progress() -> Iterator[Callable[[int], None]]:
    """Count solved nips on the standard error: on a terminal, else now and then in a line."""
    if not sys.stderr.isatty():
        from rollnip.cli.progress import Lines

        lines = Lines(None, "nips solved")
        yield lambda _: lines.advance()
        return
    from rich.console import Console
    from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    columns = (SpinnerColumn(), TextColumn("{task.completed:.0f} nips solved"), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task("", total=None)
        yield lambda count: progress.update(task, completed=count)


def _write(found: Fit, title: str, folder: Path) -> None:
    from functools import partial

    from rollnip._files import write_whole
    from rollnip._json import json_text
    from rollnip.identification import fit_case, fit_dict, fit_report, plot_fit
    from rollnip.plots import save_figure

    texts = {
        "report.txt": fit_report(found, title),
        "fit.json": json_text(fit_dict(found)) + "\n",
        "case.toml": fit_case(found),
    }
    for name, text in texts.items():
        write_whole(folder / name, partial(Path.write_text, data=text, encoding="utf-8"))
    save_figure(plot_fit(found), folder / "fit.png")
