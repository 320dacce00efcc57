"""The commands ``patch``: the contact of wheels and crowned rollers; readings of hardness."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rollnip._errors import InvalidInputError
from rollnip._files import one_run
from rollnip.cli.console import clear_failures, leave, named, named_by, read_option, write
from rollnip.cli.options import Force, Units
from rollnip.figure import checked_units

if TYPE_CHECKING:
    from rollnip.figure import Units as System
    from rollnip.io.patch_case import PatchCase
    from rollnip.patch import PatchSolution
    from rollnip.rollers import Roller, Side

patch = typer.Typer(
    name="patch",
    help="In three dimensions: wheels, crowned and short rollers; stresses below, ends of a face, "
    "readings of hardness.",
    no_args_is_help=True,
)
CaseFile = Annotated[str, typer.Argument(help="Case file with [patch]; - is the standard input.")]


Tolerance = Annotated[
    str | None, typer.Option(help="Wanted relative accuracy, such as 0.01 or 1%.")
]
RollerName = Annotated[str, typer.Option(help="Roller, upper or lower.")]


@dataclass(frozen=True, slots=True, kw_only=True)
class Wanted:
    """The options of a command: what to print and to write of a solution.

    Attributes
    ----------
    json, fields : whether JSON is printed, and whether with the fields over the grid.
    quiet : print no summary.
    plot, out, stresses : files of the picture, the result, the stresses inside; None: none.
    tolerance : as the option says it; None: that of the case.
    units : of the summary.
    """

    json: bool = False
    fields: bool = False
    quiet: bool = False
    plot: Path | None = None
    out: Path | None = None
    stresses: Path | None = None
    tolerance: str | None = None
    units: System = "metric"


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
        Path | None,
        typer.Option(help="Write the result with its fields: name.json, .nc, or .vtr (ParaView)."),
    ] = None,
    tolerance: Tolerance = None,
    units: Units = "metric",
    force: Force = False,
) -> None:
    """Solve a contact patch and print its size, pressure, forces and creepages.

    The exit code is 0 where the solution was verified, 1 where it was not, 2 for wrong input.
    """
    with clear_failures(), one_run(force=force) as run:
        from rollnip.io.patch_case import read_patch_case

        system = checked_units("--units", units)
        problem = read_patch_case(case)
        run.reserve({"--plot": plot, "--out": out})
        wanted = Wanted(
            json=json,
            fields=fields,
            plot=plot,
            out=out,
            tolerance=tolerance,
            units=system,
        )
        is_verified = answer(problem, wanted)
    if not is_verified:
        raise typer.Exit(1)


def answer(problem: PatchCase, wanted: Wanted) -> bool:
    """Solve a patch, write and print what is wanted, and return whether it was verified."""
    _check_targets(wanted)
    solution = _solved(problem, wanted.tolerance)
    if wanted.plot is not None:
        from rollnip.plots import plot_patch, save_figure

        save_figure(plot_patch(solution), wanted.plot)
    if wanted.out is not None:
        from rollnip.io.patch_files import write_patch

        write_patch(solution, wanted.out)
    if wanted.stresses is not None:
        _write_stresses(solution, wanted.stresses)
    if wanted.json or wanted.fields:
        from rollnip._json import json_text
        from rollnip.patch.report import patch_dict

        tree = patch_dict(solution, fields=wanted.fields)
        write(json_text(tree, indent=None if wanted.fields else 2) + "\n")
    elif not wanted.quiet:
        from rollnip.patch.report import patch_lines

        write("\n".join(patch_lines(solution, wanted.units)) + "\n")
    return solution.converged


def require_linear(geometry: str | None) -> None:
    """Raise unless the option ``--geometry`` is left out or says linear, as patches are."""
    if geometry not in (None, "linear"):
        raise InvalidInputError(
            f"`--geometry` must be linear for a case with [patch], got {geometry!r}."
        )


def _check_targets(wanted: Wanted) -> None:
    """Raise where a file could not be written, before anything is computed."""
    from rollnip.io.patch_files import STRESS_SUFFIXES, check_patch_target

    if wanted.plot is not None:
        from rollnip.plots import check_figure_target

        check_figure_target(wanted.plot)
    if wanted.out is not None:
        check_patch_target(wanted.out)
    if wanted.stresses is not None:
        check_patch_target(wanted.stresses, STRESS_SUFFIXES)


def _solved(problem: PatchCase, tolerance: str | None) -> PatchSolution:
    from rollnip.patch import PATCH_TOLERANCE, solve_patch

    given = read_option("--tolerance", tolerance, "ratio")
    wanted = problem.tolerance if given is None else given
    sources = {} if given is None else {"tolerance": "--tolerance"}
    with named_by(sources, problem.source):
        return solve_patch(
            problem.patch,
            tolerance=PATCH_TOLERANCE if wanted is None else wanted,
            grid=problem.grid,
        )


def _write_stresses(solution: PatchSolution, path: Path) -> None:
    """Write the stresses of the upper roller, or of the lower one under a rigid upper one."""
    from rollnip.io.patch_files import write_stress
    from rollnip.patch.depth import usual_depths

    side: Side = "lower" if solution.patch.upper.is_rigid else "upper"
    write_stress(solution, side, usual_depths(solution, side), path)


@patch.command("stress")
def stress(
    case: CaseFile,
    depth: Annotated[
        list[str] | None,
        typer.Option(help='Depth below the surface, such as "2 mm"; may be given several times.'),
    ] = None,
    roller: RollerName = "upper",
    out: Annotated[
        Path | None, typer.Option(help="Write the stresses: name.nc, or .vtr for ParaView.")
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
    tolerance: Tolerance = None,
    force: Force = False,
) -> None:
    """Print the largest stresses under a patch at some depths of one roller.

    Without depths: some within the size of the patch, and the bonds between layers.
    """
    with clear_failures(), one_run(force=force) as run:
        from rollnip.io.patch_case import read_patch_case
        from rollnip.io.patch_files import STRESS_SUFFIXES, check_patch_target, write_stress
        from rollnip.patch.depth import usual_depths
        from rollnip.patch.report import stress_lines, stress_rows

        problem = read_patch_case(case)
        side, _ = _deforming(problem, roller)
        run.reserve({"--out": out})
        if out is not None:
            check_patch_target(out, STRESS_SUFFIXES)
        given = sorted(_depth(one) for one in depth or [])
        solution = _solved(problem, tolerance)
        z = given or usual_depths(solution, side)
        with named_by({"z": "--depth"}, problem.source):
            rows = stress_rows(solution.stress(side, z))
            if out is not None:
                write_stress(solution, side, z, out)
        if json:
            from rollnip._json import json_text

            said = list(solution.warnings)
            write(json_text({"roller": side, "depths": rows, "warnings": said}) + "\n")
        else:
            lines = stress_lines(solution.patch.title, side, rows, solution.warnings)
            write("\n".join(lines) + "\n")
    if not solution.converged:
        leave(f"{problem.source}: not converged: {solution.status}", 1)


@patch.command("ends")
def ends(
    case: CaseFile,
    approach: Annotated[
        str | None, typer.Option(help='Approach of the axles, such as "0.4 mm"; else the case\'s.')
    ] = None,
    covering: Annotated[
        bool, typer.Option("--covering", help="The coverings of both rollers end there.")
    ] = False,
    json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Print the nip near the end of the upper roller's face, on a lower one that goes on.

    Line load and peak pressure over the distance from the end, and the length of face that the end
    adds to the load of the plane nip or takes from it. The exit code is 1 where the coverings are
    pressed in too far.
    """
    with clear_failures():
        from rollnip.io.patch_case import read_patch_case
        from rollnip.nip import Approach
        from rollnip.patch import covering_end, face_end
        from rollnip.patch.report import end_dict, end_lines

        problem = read_patch_case(case)
        given = read_option("--approach", approach, "length")
        normal = problem.patch.normal
        if given is None and isinstance(normal, Approach):
            given = normal.approach
        if given is None:
            raise InvalidInputError(
                "`--approach` must be given, for the case gives a load of the whole patch."
            )
        radius = problem.patch.across_upper.end_radius
        sources = {} if approach is None else {"approach": "--approach"}
        with named_by(sources, problem.source):
            upper, lower = problem.patch.upper, problem.patch.lower
            if covering and radius > 0.0:
                raise InvalidInputError(
                    f"`end_radius` must be left out with `--covering`, got {radius:g} mm: a "
                    "covering ends square."
                )
            found = (
                covering_end(upper, lower, given)
                if covering
                else face_end(upper, lower, given, radius)
            )
        if json:
            from rollnip._json import json_text

            write(json_text(end_dict(found)) + "\n")
        else:
            write("\n".join(end_lines(found)) + "\n")
    if found.status:
        leave(f"{problem.source}: not converged: {found.status}", 1)


def _side(name: str) -> Side:
    if name == "upper":
        return "upper"
    if name == "lower":
        return "lower"
    raise InvalidInputError(f"`--roller` must be upper or lower, got {name!r}.")


@patch.command("hardness")
def hardness(
    case: CaseFile,
    roller: RollerName = "upper",
) -> None:
    """Print what a Shore A durometer reads on a covering, and on a thick block of its top layer.

    Also how thick a sheet of that layer must be to be measured to one point.
    """
    with clear_failures():
        from rollnip.io.patch_case import read_patch_case

        problem = read_patch_case(case)
        write(_readings(problem, roller))


_GENT = (
    "note: Gent's formula, by which `shore_a` gives a modulus, has Shore A {:.1f} for this layer. "
    "It takes a wider, flat punch for the indenter, so rely on the difference of two readings here."
    "\n"
)


def _deforming(problem: PatchCase, name: str) -> tuple[Side, Roller]:
    """Return the roller that ``--roller`` names; it must be one that deforms."""
    side = _side(name)
    roller = problem.patch.upper if side == "upper" else problem.patch.lower
    if roller.is_rigid:
        raise InvalidInputError(
            f"`--roller` must name a roller that deforms; the {side} one is bare and rigid."
        )
    return side, roller


def _depth(text: str) -> float:
    z = read_option("--depth", text, "length")
    if z is None or not z > 0.0:
        raise InvalidInputError(f"`--depth` must be positive, got {text}.")
    return z


def _readings(problem: PatchCase, name: str) -> str:
    side, roller = _deforming(problem, name)
    from rollnip.materials import shore_a_of_modulus
    from rollnip.patch import least_thickness, shore_a_reading

    with named(problem.source):
        covering = shore_a_reading(roller.layers, roller.core)
        block = shore_a_reading([], roller.materials[0])
    by_gent = shore_a_of_modulus(roller.materials[0].relaxed_modulus)
    note = "" if by_gent is None else _GENT.format(by_gent)
    return (
        f"Shore A on the covering of the {side} roller: {covering:.1f}\n"
        f"Shore A on a thick block of its top layer: {block:.1f}\n"
        "A sheet of the top layer on a hard base reads within 1 point of the block from "
        f"{least_thickness(roller.materials[0]):.2g} mm on.\n{note}"
    )
