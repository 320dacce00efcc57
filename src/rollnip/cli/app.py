"""The commands. Numerics are imported inside them, so that help comes at once."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer.core import TyperGroup

from rollnip._files import one_run
from rollnip.cli.console import (
    clear_failures,
    named,
    overridden,
    require_no_empty,
    say,
    write,
)
from rollnip.cli.design import find, optimise, pareto, tolerance
from rollnip.cli.dma import dma
from rollnip.cli.face import face
from rollnip.cli.feed import feed
from rollnip.cli.fit import fit
from rollnip.cli.heat import heat
from rollnip.cli.lda import lda
from rollnip.cli.options import Force, Geometry, Json, Out, Quiet, Tolerance, Units
from rollnip.cli.paper import paper
from rollnip.cli.patch import Wanted, answer, patch, require_linear
from rollnip.cli.rubber import rubber
from rollnip.cli.serve import serve
from rollnip.cli.sweep import sweep
from rollnip.cli.verify import verify
from rollnip.figure import checked_units

if TYPE_CHECKING:
    from rollnip.face import FaceSolution
    from rollnip.figure import Units as System
    from rollnip.heat import HeatSolution
    from rollnip.io import Case
    from rollnip.model import Model
    from rollnip.solution import Solution

_MANY_LAYERS = 100  # finite elements take time with the cube of their number

_ORDER = (
    *("solve", "serve", "face", "heat", "patch", "feed", "sweep"),
    *("find", "optimise", "tolerance", "pareto", "fit"),
    *("dma", "rubber", "lda", "paper", "verify", "schema", "version"),
)


class _Commands(TyperGroup):
    """Lists what most users want before the rest, and refuses empty arguments of all commands."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Return the arguments that are left; leave with one message where one is empty."""
        with clear_failures():
            require_no_empty(args)
        return super().parse_args(ctx, args)

    def list_commands(self, ctx: Any) -> list[str]:
        """Return the names of the commands in the order of the help."""
        return sorted(super().list_commands(ctx), key=_ORDER.index)


app = typer.Typer(
    name="rollnip",
    cls=_Commands,
    help="Rolling contact of cylinders coated with layered, viscoelastic rubber.",
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
)
app.command()(verify)
app.add_typer(lda)
app.add_typer(dma)
app.add_typer(rubber)
app.add_typer(sweep)
app.add_typer(face)
app.add_typer(patch)
app.command()(heat)
app.command()(feed)
app.add_typer(paper)
app.command()(fit)
app.command()(find)
app.command()(optimise)
app.command()(tolerance)
app.command()(pareto)
app.command()(serve)


@app.callback(invoke_without_command=True)
def root(
    version: Annotated[
        bool, typer.Option("--version", help="Print the version and leave.")
    ] = False,
) -> None:
    """Take the options that stand before a command."""
    if version:
        with clear_failures():
            from importlib.metadata import version as version_of

            write(f"rollnip {version_of('rollnip')}\n")
        raise typer.Exit


@app.command()
def solve(
    case: Annotated[str, typer.Argument(help="Case file, TOML or JSON; - is the standard input.")],
    json: Json = False,
    out: Out = None,
    fields: Annotated[
        Path | None,
        typer.Option(help="Write stresses inside the layers: name.nc, or name.vtr for ParaView."),
    ] = None,
    plot: Annotated[
        Path | None, typer.Option(help="Draw an overview on one page: name.png, .svg or .pdf.")
    ] = None,
    geometry: Geometry = None,
    tolerance: Tolerance = None,
    units: Units = "metric",
    quiet: Quiet = False,
    force: Force = False,
) -> None:
    """Solve one nip, or one patch where the case has a table [patch], and print a summary.

    The exit code is 0 where the solution was verified, 1 where it did not converge, 2 for wrong
    input.
    """
    with clear_failures(), one_run(force=force) as run:
        from rollnip.io.patch_case import PatchCase, read_any_case

        problem = read_any_case(case)
        run.reserve({"--out": out, "--fields": fields, "--plot": plot})
        wanted = Wanted(
            json=json,
            quiet=quiet,
            plot=plot,
            out=out,
            stresses=fields,
            tolerance=tolerance,
            units=checked_units("--units", units),
        )
        if isinstance(problem, PatchCase):
            require_linear(geometry)
            is_verified = answer(problem, wanted)
        else:
            model = overridden(problem.model, geometry, tolerance)
            is_verified = _answer(problem, model, wanted)
    if not is_verified:
        raise typer.Exit(1)


def _answer(problem: Case, model: Model, wanted: Wanted) -> bool:
    """Solve a nip, write and print what is wanted, and return whether it was verified."""
    from rollnip.io import check_result_target, result_text, write_result

    if wanted.out is not None:
        check_result_target(wanted.out)
    if wanted.plot is not None:
        from rollnip.plots import check_figure_target, plot_overview, save_figure

        check_figure_target(wanted.plot)
    if wanted.stresses is not None:
        from rollnip.io import check_fields_target, write_fields

        check_fields_target(wanted.stresses)
    from rollnip.solver import solve as solve_nip

    _say_what_takes_long(problem, model)
    with named(problem.source):
        solution = solve_nip(problem.nip, model, on_failure="return")
    along, warm = _along_the_face(problem, model), _warm(problem, model)
    parts = _parts(along, warm) if wanted.json or wanted.out is not None else None
    if wanted.out is not None:
        write_result(solution, wanted.out, parts)
    if wanted.stresses is not None:
        write_fields(solution, wanted.stresses)
    if wanted.plot is not None:
        save_figure(plot_overview(solution), wanted.plot)
    if wanted.json:
        write(result_text(solution, parts))
    elif not wanted.quiet:
        from rollnip.cli.summary import print_summary

        print_summary(solution, units=wanted.units)
        _print_more(solution, along, warm, wanted.units)
    return all(one.converged for one in (solution, along, warm) if one is not None)


def _say_what_takes_long(problem: Case, model: Model) -> None:
    """Write a line to the standard error where finite elements may take a minute or more."""
    most = max(len(one.layers) for one in (problem.nip.upper, problem.nip.lower))
    if model.geometry == "finite" and most >= _MANY_LAYERS:
        say(
            f'rollnip: {most} layers take long in geometry "finite": 100 up to fifteen seconds, '
            "viscoelastic ones a minute, 300 several times as long. With --geometry curved they "
            "take a second.\n"
        )


def _along_the_face(problem: Case, model: Model) -> FaceSolution | None:
    """Solve the face of a case; None where it has none."""
    if problem.face is None:
        return None
    from rollnip.cli.progress import counting
    from rollnip.face import solve_face

    with named(problem.source), counting() as progress:
        return solve_face(problem.nip, problem.face, model, progress=progress)


def _warm(problem: Case, model: Model) -> HeatSolution | None:
    """Solve the temperatures of a case; None where it has no table ``heat``."""
    if problem.heat is None:
        return None
    from rollnip.heat import solve_heat

    with named(problem.source):
        return solve_heat(problem.nip, problem.heat, model)


def _parts(along: FaceSolution | None, warm: HeatSolution | None) -> dict[str, Any]:
    from rollnip.io import case_parts

    return case_parts(along, warm)


def _print_more(
    solution: Solution, along: FaceSolution | None, warm: HeatSolution | None, units: System
) -> None:
    """Print what a face and a heat balance add to the summary of a nip."""
    from rollnip.face.report import face_lines
    from rollnip.heat.report import balance_lines

    said = solution.warnings
    for part in (
        None if along is None else face_lines(along, said, units),
        None if warm is None else balance_lines(warm, said, units),
    ):
        if part is not None:
            write("\n" + "\n".join(part) + "\n")


@app.command()
def schema() -> None:
    """Print the JSON schema of the case file, for editors and other programs."""
    with clear_failures():
        from json import dumps

        from rollnip.io import case_schema

        write(dumps(case_schema(), indent=2) + "\n")


@app.command()
def version() -> None:
    """Print the version."""
    with clear_failures():
        from importlib.metadata import version as version_of

        write(f"rollnip {version_of('rollnip')}\n")
