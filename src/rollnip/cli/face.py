"""The commands ``face``: along the face of a nip, which crown, and reading an impression."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from math import degrees
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rollnip._errors import InvalidInputError
from rollnip._files import one_run
from rollnip.cli.console import clear_failures, leave, named, named_by
from rollnip.cli.options import Force, Units
from rollnip.figure import checked_units

if TYPE_CHECKING:
    from rollnip.model import Model
    from rollnip.nip import Nip
    from rollnip.shafts import Face

face = typer.Typer(
    name="face",
    help="Along the face: load and width over rollers that bend; crowns; nip impressions.",
    no_args_is_help=True,
)
CaseFile = Annotated[
    str, typer.Argument(help="Case file with [face] and shafts; - is the standard input.")
]
Json = Annotated[bool, typer.Option("--json", help="Print JSON.")]
Plot = Annotated[Path | None, typer.Option(help="Draw the face: name.png, .svg or .pdf.")]
Workers = Annotated[
    int,
    typer.Option(
        help="Processes that solve cross-sections; several pay where coverings are viscoelastic "
        "or vary along the face."
    ),
]
Crowned = Annotated[str, typer.Option(help="Roller that has the crown: upper or lower.")]


@face.command("solve")
def solve(
    case: CaseFile,
    json: Json = False,
    plot: Plot = None,
    workers: Workers = 1,
    units: Units = "metric",
    force: Force = False,
) -> None:
    """Solve a nip along its face and print line load, width and scrub.

    The exit code is 0 where the solution was verified, 1 where it was not, 2 for wrong input.
    """
    with clear_failures(), one_run(force=force) as run:
        system = checked_units("--units", units)
        nip, along, model = _read(case)
        run.reserve({"--plot": plot})
        from rollnip.cli.progress import counting
        from rollnip.face import solve_face
        from rollnip.face.report import face_dict, face_lines

        with _processes(workers) as executor, counting() as progress, named(case):
            solution = solve_face(nip, along, model, executor=executor, progress=progress)
        _draw(solution, plot)
        lines = face_lines(solution, units=system)
        _print(face_dict(solution) if json else "\n".join(lines) + "\n")
    if not solution.converged:
        raise typer.Exit(1)


@face.command()
def crown(
    case: CaseFile,
    roller: Crowned = "upper",
    within: Annotated[
        str,
        typer.Option(
            help="Largest departure of the line load from its mean, as a share of the mean."
        ),
    ] = "10 %",
    json: Json = False,
    plot: Plot = None,
    force: Force = False,
) -> None:
    """Find the crown that makes the line load even, and the loads that it serves.

    The case's own crown on that roller does not matter.
    """
    with clear_failures(), one_run(force=force) as run:
        nip, along, model = _read(case)
        run.reserve({"--plot": plot})
        from rollnip._units import parse_quantity
        from rollnip.face import even_crown, load_range, plain_wall, with_crown
        from rollnip.face.design import require_share
        from rollnip.shafts import Crown

        name = _roller(roller)
        with named("--within"):
            share = parse_quantity(within, "ratio")
            require_share(share)
        with named(case):
            best = even_crown(nip, along, model, roller=name)
        crowned = with_crown(nip, name, Crown(best.height))
        law = best.solution.law
        loads = load_range(_at_mean(crowned, along), along, model, within=share, law=law)
        wall = plain_wall(nip, along, model, within=share, roller=name, law=law)
        _draw(best.solution, plot)
        _print(_crown_dict(best, loads, wall) if json else _crown_text(best, loads, wall))
        if not best.solution.converged:
            leave(f"{case}: not converged: {best.solution.status}", 1)


@face.command()
def read(
    case: CaseFile,
    widths: Annotated[
        str,
        typer.Argument(
            help="CSV or workbook with the columns y and width, and load where it differs."
        ),
    ],
    unknown: Annotated[
        list[str] | None,
        typer.Option(
            help="Unknown to read: crown, tilt, load or modulus; may be given more than once."
        ),
    ] = None,
    scatter: Annotated[str, typer.Option(help="Standard deviation of a width.")] = "0.2 mm",
    roller: Crowned = "upper",
    json: Json = False,
) -> None:
    """Read a nip impression: crown, tilt, load or modulus from widths along the face."""
    with clear_failures():
        nip, along, model = _read(case)
        from rollnip._units import parse_quantity
        from rollnip.face import Impression, read_impressions
        from rollnip.face.report import reading_dict
        from rollnip.io.columns import read_columns

        table = read_columns(widths)
        y, found = table.samples("y", "length"), table.samples("width", "length")
        with named("--scatter"):
            spread = parse_quantity(scatter, "length")
        side = _roller(roller)
        # What is wrong with a crown or with end loads here is what the widths ask for: those of the
        # case were checked when it was read.
        sources = dict.fromkeys(("y", "width", "load", "crown", "end_loads"), widths)
        sources |= {"scatter": "--scatter", "unknowns": "--unknown"}
        with named_by(sources, case):
            impressions = [Impression(y, found, spread)]
            if "load" in table.names:
                loads = table.samples("load", "line load")
                impressions = [
                    Impression(y[loads == one], found[loads == one], spread, float(one))
                    for one in sorted(set(loads.tolist()))
                ]
            reading = read_impressions(
                nip,
                along,
                impressions,
                tuple(unknown or ("crown", "tilt")),  # type: ignore[arg-type]
                model,
                roller=side,
            )
        _print(reading_dict(reading) if json else _reading_text(reading))


def _read(case: str) -> tuple[Nip, Face, Model]:
    from rollnip.io import read_case

    problem = read_case(case)
    if problem.face is None:
        raise InvalidInputError(
            f"{problem.source}: face: is missing; add a table [face] with a length."
        )
    return problem.nip, problem.face, problem.model


@contextmanager
def _processes(count: int) -> Iterator[Executor | None]:
    """Yield processes that solve cross-sections; None for a single one, which is this.

    They are deaf to Ctrl-C, and killed where it stops this process.
    """
    if count < 1:
        raise InvalidInputError(f"`--workers` must be 1 or more, got {count}.")
    if count == 1:
        yield None
        return
    from rollnip.sweeps.crew import processes

    with processes(count) as crew:
        try:
            yield crew.pool
        except KeyboardInterrupt:
            crew.abandon()
            raise


def _roller(name: str) -> Any:
    if name not in ("upper", "lower"):
        raise InvalidInputError(f"`--roller` must be upper or lower, got {name!r}.")
    return name


def _draw(solution: Any, plot: Path | None) -> None:
    if plot is not None:
        from rollnip.plots import plot_face, save_figure

        save_figure(plot_face(solution), plot)


def _print(what: dict[str, Any] | str) -> None:
    from rollnip._json import json_text

    text = what if isinstance(what, str) else json_text(what) + "\n"
    sys.stdout.write(text)
    sys.stdout.flush()


def _at_mean(nip: Nip, along: Face) -> Nip:
    """Return the nip under its mean line load, which end loads may give."""
    if along.end_loads is None:
        return nip
    from dataclasses import replace

    from rollnip.face import face_problem
    from rollnip.nip import LineLoad

    total = face_problem(nip, along, 3).total
    assert total is not None
    return replace(nip, normal=LineLoad(total / along.length))


def _crown_dict(best: Any, loads: Any, wall: Any) -> dict[str, Any]:
    from rollnip.face.report import face_dict

    span = None if loads is None else {"within": loads.within, "low": loads.low, "high": loads.high}
    skewed = best.skewed
    return {
        "roller": best.roller,
        "height": best.height,
        "skew_instead": best.skew,
        "departure_with_skew": None if skewed is None else skewed.largest_departure,
        "y": best.y.tolist(),
        "diameter": best.diameter.tolist(),
        "loads": span,
        "without_crown": {
            "within": wall.within,
            "bore": wall.bore,
            "wall": wall.wall,
            "departure_if_solid": wall.solid,
        },
        "face": face_dict(best.solution),
    }


def _crown_text(best: Any, loads: Any, wall: Any) -> str:
    from rollnip.face.figures import FACE_PROFILES
    from rollnip.figures import FIGURES

    length, per_length = FACE_PROFILES["y"].shown_unit, FIGURES["load"].shown_unit
    found, within = best.solution, 100 * wall.within
    lines = [
        f"Parabolic crown of the {best.roller} roller: {best.height:.4g} {length} on the diameter",
        f"  line load with it      {found.load.min():.4g} to {found.load.max():.4g} {per_length}, "
        f"within {_per_cent(found.largest_departure)} of the mean",
        f"  even load asks for     {best.diameter[best.y.size // 2]:.4g} {length} in the middle "
        "(table with --json)",
    ]
    if best.skewed is not None:
        skewed = _per_cent(best.skewed.largest_departure)
        lines.append(
            f"  skew instead           {degrees(best.skew):.4g} degrees, "
            f"within {skewed} of the mean"
        )
    if loads is None:
        lines.append(f"  no load is within {within:g} % of its mean over the whole face")
    else:
        low = "less" if loads.low is None else f"{loads.low:.4g}"
        high = "more" if loads.high is None else f"{loads.high:.4g}"
        lines.append(f"  within {within:g} % of the mean  from {low} to {high} {per_length}")
    if wall.wall is None:
        lines.append(
            f"  without a crown        even a solid core is too soft: the load departs from its "
            f"mean by {_per_cent(wall.solid)}"
        )
    else:
        lines.append(
            f"  without a crown        a wall of {wall.wall:.4g} {length} "
            f"(bore {wall.bore:.4g} {length}) keeps within {within:g} %"
        )
    return "\n".join(lines) + "\n"


def _per_cent(share: float, sign: str = "") -> str:
    """Return a share in per cent to two digits, and without an exponent where it is large.

    ``sign``: "+" where a positive share is to have a sign.
    """
    value = 100.0 * share
    digits = ".2g" if abs(value) < 99.5 else ".0f"
    return f"{value:{sign}{digits}} %"


def _reading_text(reading: Any) -> str:
    from rollnip.face.figures import ADDED_CROWN, FACE_FIGURES, IMPRESSION_FIGURES

    lines = ["Read from the impression, with 95 % intervals:"]
    for one in reading.estimates:
        figure = IMPRESSION_FIGURES[one.name]
        span = f"({figure.number(one.low)} to {figure.number(one.high)})"
        lines.append(f"  {one.name:10s} {figure.text(one.value):>10s}  {span}")
    if reading.bearing_offset is not None and any(one.name == "tilt" for one in reading.estimates):
        offset = reading.bearing_offset
        side = ">" if offset > 0.0 else "<"
        further = FACE_FIGURES["bearing_offset"].text(abs(offset), 3)
        lines.append(f"  the upper bearing at y {side} 0 has come {further} further than the other")
    needed, said = (ADDED_CROWN.text(one) for one in (reading.needed_crown, reading.shop_crown))
    lines.append(f"  an even load needs a crown of {needed} more on the diameter")
    shop = f"  the shop formula says {said}"
    if reading.shop_error is not None:
        shop += f", off by {_per_cent(reading.shop_error, '+')}"
    lines.append(shop)
    lines += [f"  note: {line}" for line in reading.warnings]
    return "\n".join(lines) + "\n"
