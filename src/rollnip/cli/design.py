"""The command ``find``: the parameter that gives a wanted result."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rollnip._errors import InvalidInputError

if TYPE_CHECKING:
    from rollnip.design import Found

_CASE = typer.Argument(help="Case file, TOML or JSON; - is the standard input.")
_GEOMETRY = typer.Option(help="linear, corrected, curved or finite; overrides the file.")
_ROUNDING = 1e-9
_SHOWN = (
    "load", "approach", "nip_width", "peak_pressure", "mean_pressure", "traction", "creepage",
    "dwell_time", "torque_upper", "torque_lower", "rolling_resistance",
)  # fmt: skip


def find(
    case: Annotated[str, _CASE],
    path: Annotated[str, typer.Argument(help="Of the parameter, such as nip.load.")],
    wanted: Annotated[
        str, typer.Option("--for", help='The wanted result: nip_width="8 mm".', metavar="RESULT")
    ],
    between: Annotated[
        tuple[str, str], typer.Option(help='Limits of the parameter: "1 N/mm" "20 N/mm".')
    ],
    tolerance: Annotated[
        str, typer.Option(help="How near the result must come, as a share of it.")
    ] = "0.01 %",
    points: Annotated[
        int, typer.Option(help="Cases from limit to limit before closing in; more find more bends.")
    ] = 5,
    geometry: Annotated[str | None, _GEOMETRY] = None,
    json: Annotated[bool, typer.Option("--json", help="Print the answer as JSON.")] = False,
    out: Annotated[
        Path | None, typer.Option(help="Write the case found: name.toml or name.json.")
    ] = None,
) -> None:
    """Find the value of a parameter that gives a wanted result.

    Leaves with 0 where a value was found and confirmed by a fresh solve, 1 where there is none
    between the limits, 2 for wrong input.
    """
    from rollnip.cli.app import _clear_failures, _named

    with _clear_failures():
        from rollnip._units import parse_quantity
        from rollnip.design import find as search
        from rollnip.io.document import read_document

        quantity, value = _parted(wanted)
        with _named("--tolerance"):
            share = parse_quantity(tolerance, "ratio")
        if out is not None:
            _check_case_target(out)
        tree = _with_geometry(read_document(case), geometry)
        with _named(case):
            found = search(tree, path, quantity, value, *between, tolerance=share, points=points)
        if out is not None and found.value is not None:
            _write_case(found.case, out)
        sys.stdout.write(_json(found.as_dict()) if json else _text(found, between[0]))
        sys.stdout.flush()
    if found.value is None:
        raise typer.Exit(1)


def _parted(wanted: str) -> tuple[str, str]:
    name, mark, value = wanted.partition("=")
    if not mark or not value.strip():
        raise InvalidInputError(
            f'`--for` must be a result and its value such as nip_width="8 mm", got "{wanted}".'
        )
    return name.strip(), value.strip()


def _with_geometry(tree: dict[str, Any], geometry: str | None) -> dict[str, Any]:
    from rollnip.io import with_values

    return tree if geometry is None else with_values(tree, {"model.geometry": geometry})


def _check_case_target(path: Path) -> None:
    from rollnip._files import check_target

    check_target(path, (".toml", ".json"))


def _write_case(tree: Any, path: Path) -> None:
    from rollnip._files import write_whole
    from rollnip.io import case_toml

    text = _json(tree) if path.suffix.lower() == ".json" else case_toml(tree)
    write_whole(path, lambda file: file.write_text(text, "utf-8"))


def _json(tree: Any) -> str:
    from json import dumps

    return dumps(tree, indent=2, allow_nan=False) + "\n"


def _text(found: Found, limit: str) -> str:
    from rollnip._units import format_quantity
    from rollnip.design import QUANTITIES

    lines = [found.message, f"{found.solves} cases solved."]
    if found.value is None:
        return "\n".join(lines) + "\n"
    other = _elsewhere(found, limit)
    if other:
        lines[0] += f" That is {other}."
    lines += ["", "At this value, solved afresh:"]
    for name in _SHOWN:
        value = found.scalars[name]
        if value is None:
            continue
        error = found.scalars.get(f"error.{name}") or 0.0
        real = error > _ROUNDING * abs(value)
        doubt = f" ± {format_quantity(error, digits=2)}" if real else ""
        number = format_quantity(value, QUANTITIES[name], digits=5)
        lines.append(f"  {name:20s}{number}{doubt}")
    warnings = str(found.scalars["warnings"])
    return "\n".join(lines + ([f"Note: {warnings}"] if warnings else [])) + "\n"


def _elsewhere(found: Found, limit: str) -> str:
    """The value in the unit the limit was written in, where that is another than the base unit."""
    from rollnip._units import format_quantity, parse_quantity
    from rollnip.design.quantities import parameter_dimension

    unit = re.sub(r"^[\s\d.,eE+\-\u2212]*", "", limit).strip()
    if found.value is None or unit in (found.unit, ""):
        return ""
    dimension = parameter_dimension(found.case, found.path)
    zero, one = (parse_quantity(f"{number} {unit}", dimension) for number in (0, 1))
    return format_quantity((found.value - zero) / (one - zero), unit, digits=5)
