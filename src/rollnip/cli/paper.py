"""The command ``paper``: figures 4 to 8 of Braat & Kalker (1993), and its process on a case."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, cast

import typer

from rollnip._errors import InvalidInputError
from rollnip._files import make_folder, one_run
from rollnip._json import json_text
from rollnip.cli.console import clear_failures, write
from rollnip.cli.options import Force

if TYPE_CHECKING:
    from rollnip.model import Geometry
    from rollnip.paper.process import ProcessSolution

paper = typer.Typer(name="paper", rich_markup_mode=None)


@paper.callback(invoke_without_command=True)
def figures(
    context: typer.Context,
    out: Annotated[
        Path | None, typer.Option(help="Folder for the pictures, made if it does not exist.")
    ] = None,
    table: Annotated[
        bool,
        typer.Option(
            "--table",
            help="Write assumptions.md too: what the paper leaves open, and how it matters.",
        ),
    ] = False,
    json: Annotated[bool, typer.Option("--json", help="Print the files as JSON.")] = False,
    force: Force = False,
) -> None:
    """Compute and draw figures 4 to 8 of Braat & Kalker (1993).

    The points in figures 6 to 8 are simulated, not measured, and say so.
    """
    if context.invoked_subcommand is not None:
        return
    with clear_failures(), one_run(force=force) as run:
        if out is None:
            raise InvalidInputError("`--out` must name a folder for the pictures, got none.")
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
        write(f"{json_text({'files': names})}\n" if json else plain)


@paper.command()
def process(
    case: Annotated[str, typer.Argument(help="Case file, TOML or JSON; - is the standard input.")],
    geometry: Annotated[
        str, typer.Option(help="Geometry: linear, corrected or curved.")
    ] = "curved",
    elements: Annotated[int, typer.Option(help="Linear elements in the nip.", min=16)] = 100,
    json: Annotated[bool, typer.Option("--json", help="Print the figures as JSON.")] = False,
) -> None:
    """Solve one nip by the paper's own process: NORM and TANG in turn, on linear elements.

    `rollnip solve` finds the same faster and says how large its errors are. The exit code is 0
    where the turns converged, 1 where they did not, 2 for wrong input.
    """
    with clear_failures():
        from rollnip.io import read_case
        from rollnip.paper.process import solve_by_process

        nip = read_case(case).nip
        found = solve_by_process(nip, cast("Geometry", geometry), elements=elements)
        rows = _figures_of(found)
        if json:
            write(f"{json_text({name: value for name, value, _ in rows})}\n")
        else:
            write(
                "".join(
                    f"{name:16}{_text(value)} {unit}".rstrip() + "\n" for name, value, unit in rows
                )
            )
    if not found.converged:
        raise typer.Exit(1)


_Value = float | int | bool | None
_FIGURES = ("approach", "load", "traction", "creepage", "nip_width", "peak_pressure")


def _figures_of(found: ProcessSolution) -> list[tuple[str, _Value, str]]:
    """Return name, value and base unit of the figures of the process."""
    from rollnip.figures import FIGURES

    units = {name: FIGURES[name].unit.removeprefix("1") for name in _FIGURES}
    return [
        *((name, getattr(found, name), unit) for name, unit in units.items()),
        ("elements", int(found.x.size + 1), ""),
        ("systems", found.systems, ""),
        ("converged", found.converged, ""),
    ]


def _text(value: _Value) -> str:
    if value is None:
        return "not defined"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.6g}"
