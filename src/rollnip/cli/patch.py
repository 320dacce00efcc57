"""The commands ``patch``: the contact of wheels and crowned rollers; readings of hardness."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rollnip._errors import InvalidInputError
from rollnip._files import one_run
from rollnip.cli.console import clear_failures, read_option, write
from rollnip.cli.options import Force

if TYPE_CHECKING:
    from rollnip.io.patch_case import PatchCase

patch = typer.Typer(
    name="patch",
    help="In three dimensions: wheels, crowned and short rollers; readings of hardness.",
    no_args_is_help=True,
)
CaseFile = Annotated[str, typer.Argument(help="Case file with [patch]; - reads standard input.")]


@patch.command("solve")
def solve(
    case: CaseFile,
    json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
    fields: Annotated[
        bool, typer.Option("--fields", help="Put the fields over the grid into the JSON.")
    ] = False,
    plot: Annotated[
        Path | None, typer.Option(help="Draw the patch: name.png, .svg or .pdf.")
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="Write the result with its fields: name.json or .nc.")
    ] = None,
    tolerance: Annotated[
        str | None, typer.Option(help="Wanted relative accuracy, such as 0.01 or 1%.")
    ] = None,
    force: Force = False,
) -> None:
    """Solve a contact patch and print its size, pressure, forces and creepages.

    The exit code is 0 where the solution was verified, 1 where it was not, 2 for wrong input.
    """
    with clear_failures(), one_run(force=force) as run:
        from rollnip.io.patch_case import read_patch_case

        problem = read_patch_case(case)
        run.reserve({"--plot": plot, "--out": out})
        if out is not None:
            from rollnip.io.patch_files import check_patch_target

            check_patch_target(out)
        from rollnip.patch import solve_patch
        from rollnip.patch.report import patch_dict, patch_lines

        wanted = read_option("--tolerance", tolerance, "ratio") or problem.tolerance
        solution = solve_patch(problem.patch, tolerance=wanted or 5e-3, grid=problem.grid)
        if plot is not None:
            from rollnip.plots import plot_patch, save_figure

            save_figure(plot_patch(solution), plot)
        if out is not None:
            from rollnip.io.patch_files import write_patch

            write_patch(solution, out)
        if json or fields:
            from json import dumps

            tree = patch_dict(solution, fields=fields)
            write(dumps(tree, indent=None if fields else 2, allow_nan=False) + "\n")
        else:
            write("\n".join(patch_lines(solution)) + "\n")
    if not solution.converged:
        raise typer.Exit(1)


@patch.command("hardness")
def hardness(
    case: CaseFile,
    roller: Annotated[
        str, typer.Option(help="Roller whose covering is read: upper or lower.")
    ] = "upper",
) -> None:
    """Print what a Shore A durometer reads on a covering, and on a thick block of its top layer."""
    with clear_failures():
        from rollnip.io.patch_case import read_patch_case

        problem = read_patch_case(case)
        write(_readings(problem, roller))


def _readings(problem: PatchCase, name: str) -> str:
    if name not in ("upper", "lower"):
        raise InvalidInputError(f"`--roller` must be upper or lower, got {name!r}.")
    from rollnip.patch import shore_a_reading

    roller = problem.patch.upper if name == "upper" else problem.patch.lower
    covering = shore_a_reading(roller.layers, roller.core)
    block = shore_a_reading([], roller.materials[0])
    return (
        f"Shore A on the covering of the {name} roller: {covering:.1f}\n"
        f"Shore A on a thick block of its top layer: {block:.1f}\n"
    )
