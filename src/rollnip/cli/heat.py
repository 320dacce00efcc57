"""The command ``heat``: how warm rollers get, how they warm up, and when they run away."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, cast

import typer

from rollnip._errors import InvalidInputError
from rollnip._files import one_run
from rollnip.cli.console import clear_failures, named, overridden, read_option, write
from rollnip.cli.options import Force, Geometry, Json, Out, Quiet, Tolerance, Units
from rollnip.figure import checked_units

if TYPE_CHECKING:
    from rollnip._units import Dimension
    from rollnip.figure import Units as System
    from rollnip.heat import Branch, HeatSolution, WarmUp
    from rollnip.io import Case
    from rollnip.model import Model

_DIMENSIONS = {"speed": "speed", "load": "line load"}
_LOW = 0.1  # of the case's own value: where a branch begins


def heat(
    case: Annotated[str, typer.Argument(help="Case file with [heat]; - is the standard input.")],
    json: Json = False,
    out: Out = None,
    plot: Annotated[
        Path | None, typer.Option(help="Draw temperatures: name.png, .svg or .pdf.")
    ] = None,
    warm_up: Annotated[
        bool, typer.Option("--warm-up", help="Compute the temperatures over time as well.")
    ] = False,
    duration: Annotated[
        str | None, typer.Option(help='How long it warms up, such as "2 h"; implies --warm-up.')
    ] = None,
    follow: Annotated[
        str | None,
        typer.Option(
            help='Follow the steady states with the speed or the load: "speed=20 m/s" or '
            '"load=5 N/mm:60 N/mm".'
        ),
    ] = None,
    geometry: Geometry = None,
    tolerance: Tolerance = None,
    units: Units = "metric",
    quiet: Quiet = False,
    force: Force = False,
) -> None:
    """Solve a nip and the temperatures of its rollers together.

    The exit code is 0 where a steady state was found and verified, 1 where there is none, 2 for
    wrong input.
    """
    with clear_failures(), one_run(force=force) as run:
        system = checked_units("--units", units)
        problem = _read(case)
        run.reserve({"--out": out, "--plot": plot})
        model = overridden(problem.model, geometry, tolerance)
        wanted = None if follow is None else _range(follow, problem)
        seconds = read_option("--duration", duration, "time")
        if seconds is not None and seconds <= 0.0:
            raise InvalidInputError(f"`--duration` must be positive, got {duration}.")
        _check_targets(out, plot)
        from rollnip.influence import KernelCache

        cache = KernelCache()
        with named(problem.source):
            course = _course(problem, model, seconds, cache) if warm_up or duration else None
            solution = course.steady if course is not None else _steady(problem, model, cache)
            branch = None if wanted is None else _branch(problem, model, wanted, cache)
        _give(solution, course, branch, (out, plot), system, json=json, quiet=quiet)
    if not solution.converged or (course is not None and not course.converged):
        raise typer.Exit(1)


def _read(case: str) -> Case:
    from rollnip.io import read_case

    problem = read_case(case)
    if problem.heat is None:
        raise InvalidInputError(
            f"{problem.source}: heat: is missing; add a table [heat] with ambient, and "
            "[upper.heat] and [lower.heat] with film."
        )
    return problem


def _check_targets(out: Path | None, plot: Path | None) -> None:
    if out is not None:
        from rollnip.io import check_result_target

        check_result_target(out)
    if plot is not None:
        from rollnip.plots import check_figure_target

        check_figure_target(plot)


def _steady(problem: Case, model: Model, cache: object) -> HeatSolution:
    from rollnip.heat import solve_heat

    assert problem.heat is not None
    return solve_heat(problem.nip, problem.heat, model, cache=cache)  # type: ignore[arg-type]


def _course(problem: Case, model: Model, duration: float | None, cache: object) -> WarmUp:
    from rollnip.heat import warm_up

    assert problem.heat is not None
    return warm_up(
        problem.nip,
        problem.heat,
        model,
        duration=duration,
        cache=cache,  # type: ignore[arg-type]
    )


def _branch(problem: Case, model: Model, wanted: tuple[str, float, float], cache: object) -> Branch:
    from rollnip.heat import follow_heat

    assert problem.heat is not None
    parameter, low, high = wanted
    return follow_heat(
        problem.nip,
        problem.heat,
        model,
        parameter=parameter,  # type: ignore[arg-type]
        low=low,
        high=high,
        cache=cache,  # type: ignore[arg-type]
    )


def _range(text: str, problem: Case) -> tuple[str, float, float]:
    """Return parameter, low and high of ``--follow``."""
    name, _, span = text.partition("=")
    name = name.strip()
    if name not in _DIMENSIONS or not span:
        raise InvalidInputError(
            f'`--follow` must be "speed=20 m/s" or "load=5 N/mm:60 N/mm", got "{text}".'
        )
    dimension = cast("Dimension", _DIMENSIONS[name])
    first, colon, second = span.partition(":")
    high = read_option("--follow", (second if colon else first).strip(), dimension)
    assert high is not None
    if colon:
        low = read_option("--follow", first.strip(), dimension)
        assert low is not None
    else:
        low = _LOW * min(high, _own(problem, name) or high)
    if not 0.0 < low < high:
        raise InvalidInputError(
            f"`--follow` must begin above 0 and below its end, got {low:g} and {high:g}."
        )
    return name, low, high


def _own(problem: Case, name: str) -> float | None:
    from rollnip.nip import LineLoad

    if name == "speed":
        return problem.nip.speed
    return problem.nip.normal.load if isinstance(problem.nip.normal, LineLoad) else None


def _give(
    solution: HeatSolution,
    course: WarmUp | None,
    branch: Branch | None,
    files: tuple[Path | None, Path | None],
    units: System,
    *,
    json: bool,
    quiet: bool,
) -> None:
    """Write the files, and print JSON or the summary."""
    out, plot = files
    if out is not None:
        from rollnip.io.heat import write_heat

        write_heat(solution, out, course, branch)
    if plot is not None:
        from rollnip.plots import plot_heat, save_figure

        save_figure(plot_heat(solution, course, branch), plot)
    if json:
        from rollnip.io.heat import heat_text

        write(heat_text(solution, course, branch))
    elif not quiet:
        from rollnip.heat.report import branch_lines, heat_lines, warm_up_lines

        lines = [*heat_lines(solution, units)]
        lines += [] if course is None else warm_up_lines(course, units)
        if branch is not None:
            speed = branch.parameter == "speed"
            lines += branch_lines(
                branch, solution.nip.speed if speed else solution.cold.load, units
            )
        write("\n".join(lines) + "\n")
