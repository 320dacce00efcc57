"""The command ``feed``: how far the feed of a sheet depends on load, hardness and dimensions."""

from __future__ import annotations

from dataclasses import asdict
from math import isfinite
from typing import TYPE_CHECKING, Annotated

import typer

from rollnip._errors import InvalidInputError
from rollnip.cli.console import clear_failures, named, overridden, warn, write
from rollnip.cli.options import Json, Tolerance

if TYPE_CHECKING:
    from rollnip.feed import FeedChange

_HEAD = ("1 % more of", "over the upper", "over the lower", "in a turn", "error")


def feed(
    case: Annotated[str, typer.Argument(help="Case file with [sheet]; - is the standard input.")],
    json: Json = False,
    geometry: Annotated[
        str | None,
        typer.Option(help="Geometry: linear, curved, second or finite; overrides the file."),
    ] = None,
    tolerance: Tolerance = None,
) -> None:
    """Print how the feed of a sheet changes with load, hardness, diameters, thicknesses, tensions.

    Changes are in mm per metre that rolled off the roller, for 1 % more of each quantity; "in a
    turn" in mm per metre fed in a turn of the upper roller. JSON has the derivatives by the
    relative change. The exit code is 0 where all solutions were verified, 1 where one was not, 2
    for wrong input.
    """
    with clear_failures():
        from rollnip.io import read_case

        problem = read_case(case)
        if problem.nip.sheet is None:
            raise InvalidInputError(
                f"{problem.source}: sheet: is missing; add a table [sheet] with thickness and "
                'modulus, or kind = "office paper".'
            )
        model = overridden(problem.model, geometry, tolerance)
        from rollnip.cli.progress import counting
        from rollnip.feed import feed_sensitivity, is_geared
        from rollnip.rollers import SIDES
        from rollnip.validity import energies_left_out

        with named(problem.source), counting("quantities") as progress:
            changes = feed_sensitivity(problem.nip, model, progress=progress)
        for side in SIDES:
            warn(one.text for one in energies_left_out(side, getattr(problem.nip, side)))
        geared = is_geared(problem.nip)
        write((_as_json(changes) if json else _as_text(changes, geared=geared)) + "\n")
    if not all(one.converged for one in changes):
        raise typer.Exit(1)


def _as_json(changes: tuple[FeedChange, ...]) -> str:
    from rollnip._json import json_text

    rows = [
        {name: None if _is_nan(value) else value for name, value in asdict(one).items()}
        for one in changes
    ]
    return json_text(rows)


def _is_nan(value: object) -> bool:
    return isinstance(value, float) and not isfinite(value)


def _as_text(changes: tuple[FeedChange, ...], *, geared: bool) -> str:
    lines = ["Change of the feed in mm per m:", "{:34}{:>16}{:>16}{:>12}{:>10}".format(*_HEAD)]
    for one in changes:
        four = one.upper, one.lower, one.per_turn, one.error
        values = (round(10.0 * value, 4) + 0.0 for value in four)  # no -0
        lines.append("{:34}{:16.4f}{:16.4f}{:12.4f}{:10.4f}".format(one.quantity, *values))
    if geared:
        lines.append(
            "The creepage is prescribed: a diameter changes at the same gears, and the creepage "
            "with it."
        )
    if not all(one.converged for one in changes):
        lines.append("Not every solution was verified.")
    return "\n".join(lines)
