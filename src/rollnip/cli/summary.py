"""The summary of a solution on the terminal."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from rich.console import Console, Group, RenderableType
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from rollnip._results.summary import (
    SIGNS,
    Line,
    finite_inside,
    inside_notes,
    sections,
    verdict,
    zone_sections,
)
from rollnip.cli.console import terminal
from rollnip.figure import Units
from rollnip.figures import INTERFACE_FIGURES, PULL
from rollnip.solution import Solution

_WIDTH = 96
_DEPTH, _RANGE = INTERFACE_FIGURES["depth"], INTERFACE_FIGURES["shear_range"]


def print_summary(
    solution: Solution, console: Console | None = None, units: Units = "metric"
) -> None:
    """Print a solution: loads, nip, drive, zones, losses, errors, warnings.

    Parameters
    ----------
    solution :
        what `solve` returned.
    console :
        where to; the standard output by default, at most 96 columns wide.
    units :
        metric or US ones.
    """
    console = console or terminal()
    console.width = min(console.width, _WIDTH)
    console.print(Group(*_parts(solution, units)))


def _parts(solution: Solution, units: Units) -> Iterator[RenderableType]:
    yield Text(solution.nip.title or "Nip", style="bold")
    said, how = verdict(solution)
    yield Text.assemble((said, "green" if solution.converged else "bold red"), how)
    for heading, lines in sections(solution, units):
        yield Text(f"\n{heading}", style="bold")
        yield _table(lines)
    for heading, lines in zone_sections(solution, units):
        yield Text(f"\n{heading}", style="bold")
        yield _table(lines, label=6, value=18)
    if solution.interfaces:
        yield Text(f"\nInterfaces, each revolution{_theory(solution)}", style="bold")
        yield _interfaces(solution, units)
    yield Text()
    for warning in (*solution.warnings, *inside_notes(solution)):
        yield Text(f"Note: {warning}", style="yellow")
    yield Text(SIGNS, style="dim")


def _theory(solution: Solution) -> str:
    """Return where the stresses on interfaces are those of finite strain, for the heading."""
    finite, linear = finite_inside(solution), inside_notes(solution)
    if not finite:
        return ""
    return ", finite strain" + (f" in the {finite[0]} roller" if linear else "")


def _table(lines: Iterable[Line], *, label: int = 26, value: int = 11) -> RenderableType:
    """Lines in columns, the first two at least so many letters wide."""
    table = Table.grid(padding=(0, 1))
    table.add_column(min_width=label)
    table.add_column(justify="right", min_width=value)
    table.add_column(min_width=7)
    table.add_column(style="dim")
    for line in lines:
        table.add_row(line.label, line.value, line.unit, line.error or line.note)
    return Padding(table, (0, 0, 0, 2))


def _interfaces(solution: Solution, units: Units) -> RenderableType:
    depth, span, pull = (one.in_units(units) for one in (_DEPTH, _RANGE, PULL))
    table = Table.grid(padding=(0, 1))
    table.add_column(min_width=26)
    for _ in range(2):
        table.add_column()
    for one in solution.interfaces:
        kind = "bond" if one.is_bond else "interface"
        table.add_row(
            f"{one.roller} {kind} at {depth.text(one.depth)}",
            f"{span.label} {span.text(one.shear_range)}",
            f"{pull.label} {pull.text(one.pull)}",
        )
    return Padding(table, (0, 0, 0, 2))
