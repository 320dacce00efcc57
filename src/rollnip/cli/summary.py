"""The summary of a solution on the terminal."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from rich.console import Console, Group, RenderableType
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from rollnip._units import format_quantity
from rollnip.solution import Solution

_WIDTH = 96
_DIGITS = 4
_ROUNDING = 1e-9
_MOST_INTERVALS = 4  # listed one by one
_SIGNS = (
    "x points to the inlet (leading edge). Traction and creepage > 0: the upper roller drives. "
    "Torque > 0: that axle puts power in."
)


class _Row(NamedTuple):
    """One number: its name, value in the solution's unit, unit shown and factor to it, error.

    ``size`` is what the value is to be compared with: a rounding error of it is shown as 0.
    """

    name: str
    value: float | None
    unit: str = ""
    scale: float = 1.0
    error: float | None = None
    note: str = ""
    size: float = 0.0


def print_summary(solution: Solution, console: Console | None = None) -> None:
    """Print a solution: loads, nip, drive, zones, losses, errors, warnings.

    Parameters
    ----------
    solution :
        what `solve` returned.
    console :
        where to; the standard output by default, at most 96 columns wide.
    """
    console = console or Console(highlight=False)
    console.width = min(console.width, _WIDTH)
    console.print(Group(*_parts(solution)))


def _parts(solution: Solution) -> Iterator[RenderableType]:
    yield Text(solution.nip.title or "Nip", style="bold")
    yield _verdict(solution)
    for heading, rows in (
        ("Nip", _nip_rows(solution)),
        ("Drive", _drive_rows(solution)),
        ("Losses", _loss_rows(solution)),
        ("In all", _total_rows(solution)),
    ):
        if rows:
            yield Text(f"\n{heading}", style="bold")
            yield _table(rows)
    if solution.zones:
        yield Text("\nStick and slip", style="bold")
        yield _zones(solution)
    if solution.interfaces:
        yield Text("\nInterfaces, range per revolution", style="bold")
        yield _interfaces(solution)
    yield Text()
    for warning in solution.warnings:
        yield Text(f"Note: {warning}", style="yellow")
    yield Text(_SIGNS, style="dim")


def _verdict(solution: Solution) -> Text:
    solver = solution.solver
    how = (
        f"geometry {solution.model.geometry}, {solver.elements} elements, "
        f"residual {format_quantity(solver.residual, digits=2)}, {solver.seconds:.2f} s"
    )
    if solution.converged:
        return Text.assemble(("converged and verified", "green"), f" ({how})")
    return Text.assemble(("NOT CONVERGED", "bold red"), f": {solution.status} ({how})")


def _nip_rows(solution: Solution) -> list[_Row]:
    error = solution.error
    return [
        _Row("line load", solution.load, "N/mm", error=error.get("load")),
        _Row(
            "approach",
            solution.approach,
            "mm",
            error=error.get("approach"),
            note="not defined with a half-space core",
        ),
        _Row("nip width", solution.nip_width, "mm", error=error.get("nip_width")),
        *_contact_rows(solution),
        _Row("dwell time", solution.dwell_time, "ms", 1e3, note="needs `speed`"),
        _Row("peak pressure", solution.peak_pressure, "MPa", error=error.get("peak_pressure")),
        _Row("  at x", solution.peak_pressure_x, "mm", size=solution.nip_width),
        _Row("mean pressure", solution.mean_pressure, "MPa"),
    ]


def _contact_rows(solution: Solution) -> Iterator[_Row]:
    size = solution.nip_width
    if len(solution.contact) > _MOST_INTERVALS:
        length = sum(leading - trailing for trailing, leading in solution.contact)
        yield _Row("  from x", solution.contact[0][0], "mm", size=size)
        yield _Row("  to x", solution.contact[-1][1], "mm", size=size)
        yield _Row(f"  touching in {len(solution.contact)} pieces", length, "mm")
        return
    for trailing, leading in solution.contact:
        yield _Row("  from x", trailing, "mm", size=size)
        yield _Row("  to x", leading, "mm", size=size)


def _drive_rows(solution: Solution) -> list[_Row]:
    moment = solution.load * solution.nip_width
    return [
        _Row("traction", solution.traction, "N/mm", size=solution.load),
        _Row(
            "creepage",
            solution.creepage,
            "%",
            100.0,
            solution.error.get("creepage"),
            "not defined without friction",
        ),
        _Row("speed ratio upper/lower", solution.speed_ratio),
        _Row("torque on the upper axle", solution.torque_upper, "N mm/mm", size=moment),
        _Row("torque on the lower axle", solution.torque_lower, "N mm/mm", size=moment),
    ]


def _loss_rows(solution: Solution) -> list[_Row]:
    return [
        _Row("rolling resistance", solution.rolling_resistance),
        _Row("friction", solution.dissipation_friction, "mW/mm", note="needs `speed`"),
        _Row("viscous", solution.dissipation_viscous, "mW/mm", note="needs `speed`"),
    ]


def _total_rows(solution: Solution) -> list[_Row]:
    width = solution.nip.face_width
    if width is None:
        return []
    moment = solution.load * solution.nip_width
    return [
        _Row("face width", width, "mm"),
        _Row("load", solution.load, "N", width),
        _Row("torque on the upper axle", solution.torque_upper, "N m", 1e-3 * width, size=moment),
        _Row("torque on the lower axle", solution.torque_lower, "N m", 1e-3 * width, size=moment),
    ]


def _table(rows: Sequence[_Row]) -> RenderableType:
    table = Table.grid(padding=(0, 1))
    table.add_column(min_width=26)
    table.add_column(justify="right", min_width=11)
    table.add_column(min_width=7)
    table.add_column(style="dim")
    for row in rows:
        if row.value is None:
            table.add_row(row.name, "-", "", row.note or "not defined")
            continue
        rounding = abs(row.value) < _ROUNDING * row.size
        value = 0.0 if rounding else row.value * row.scale
        number = format_quantity(value, digits=_DIGITS)
        table.add_row(row.name, number, row.unit, _plus_minus(row))
    return Padding(table, (0, 0, 0, 2))


def _plus_minus(row: _Row) -> str:
    if row.error is None or not row.error > _ROUNDING * abs(row.value or 0.0):
        return ""
    return f"± {format_quantity(abs(row.error * row.scale), digits=2)}"


def _zones(solution: Solution) -> RenderableType:
    table = Table.grid(padding=(0, 1))
    table.add_column(min_width=6)
    for _ in range(2):
        table.add_column(justify="right", min_width=9)
    table.add_column()
    faster = {-1: "the upper surface is faster", 1: "the lower surface is faster"}
    for zone in solution.zones:
        table.add_row(
            zone.state,
            format_quantity(zone.start, digits=_DIGITS),
            format_quantity(zone.stop, digits=_DIGITS),
            Text.assemble("mm  ", (faster.get(zone.direction or 0, ""), "dim")),
        )
    return Padding(table, (0, 0, 0, 2))


def _interfaces(solution: Solution) -> RenderableType:
    table = Table.grid(padding=(0, 1))
    table.add_column(min_width=26)
    for _ in range(2):
        table.add_column()
    for one in solution.interfaces:
        kind = "bond" if one.is_bond else "interface"
        table.add_row(
            f"{one.roller} {kind} at {format_quantity(one.depth, digits=_DIGITS)} mm",
            f"shear {format_quantity(one.shear_range, digits=_DIGITS)} MPa",
            f"peel {format_quantity(one.peel_range, digits=_DIGITS)} MPa",
        )
    return Padding(table, (0, 0, 0, 2))
