"""The summary of a solution, as lines of text and as HTML for notebooks."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from html import escape
from typing import Any, NamedTuple

from rollnip._units import format_quantity
from rollnip.figure import ROUNDING, Figure, Units
from rollnip.figures import FIGURES, PLACES
from rollnip.sheet_figures import PULL_FIGURES, SHEET_FIGURES

SIGNS = (
    "x points to the inlet (leading edge). Traction and creepage > 0: the upper roller drives. "
    "Torque > 0: that axle puts power in."
)
FASTER = {-1: "the upper surface is faster", 1: "the lower surface is faster"}
"""Which surface is faster in a slip zone, by its direction."""

_EDGE = PLACES["contact"]
_MOST_INTERVALS = 4  # listed one by one
_HEADINGS = {"nip": "Nip", "drive": "Drive", "losses": "Losses"}
_BRIEF = ("nip_width", "peak_pressure", "creepage", "traction")
_STYLE = "text-align:left;border:0;padding:0.1em 0.8em 0.1em 0"


class Line(NamedTuple):
    """One line of a summary: a figure as text; ``value`` is "-" where it is not defined.

    ``note`` then says why it is not defined.
    """

    label: str
    value: str
    unit: str = ""
    error: str = ""
    note: str = ""


def line(figure: Figure, solution: Any) -> Line:
    """Return the line of one figure, with 0 where it is nothing but rounding or error."""
    value = figure.cleaned(solution)
    if value is None:
        return Line(figure.label, "-", note=figure.undefined or "not defined")
    error = figure.error(solution)
    shown = ""
    if error is not None and error > max(ROUNDING * abs(value), figure.noise(solution)):
        shown = f"± {format_quantity(abs(error * figure.factor), digits=2)}"
    return Line(figure.label, figure.number(value), figure.shown_unit, shown)


def sections(solution: Any, units: Units = "metric") -> Iterator[tuple[str, list[Line]]]:
    """Yield headings with their lines: nip, drive, losses and, if there are any, sheet and face."""
    for section, heading in _HEADINGS.items():
        lines = []
        for figure in FIGURES.values():
            if figure.section == section:
                lines.append(line(figure.in_units(units), solution))
                lines += _contact(solution, units) if figure.key == "nip_width" else ()
                lines += _alike(solution, units) if figure.key == "peak_pressure_x" else ()
        yield heading, lines
    if solution.sheet is not None:
        figures = [line(figure.in_units(units), solution) for figure in SHEET_FIGURES.values()]
        yield "Sheet", [*figures, *_grip(solution.sheet.grip, units)]
    if solution.nip.face_width is not None:
        yield "Whole face", list(_totals(solution, solution.nip.face_width, units))


def finite_inside(solution: Any) -> list[str]:
    """Return the rollers inside which displacements and stresses are those of finite strain."""
    return [name for name in ("upper", "lower") if solution.is_finite_inside(name)]


def inside_notes(solution: Any) -> list[str]:
    """Return a sentence for each roller whose interior fields are linear in geometry "finite"."""
    if solution.model.geometry != "finite" or not solution.peak_pressure > 0.0:
        return []
    finite = finite_inside(solution)
    return [
        f"Displacements and stresses inside the {name} roller are those of linear theory: no "
        "equilibrium at finite strain was found there."
        for name in ("upper", "lower")
        if name not in finite and not getattr(solution.nip, name).is_rigid
    ]


def verdict(solution: Any) -> tuple[str, str]:
    """Return whether the solution converged, and how it was reached, in words."""
    solver = solution.solver
    how = (
        f"geometry {solution.model.geometry}, {solver.elements} elements, "
        f"residual {format_quantity(solver.residual, digits=2)}, {solver.seconds:.2f} s"
    )
    if solution.converged:
        return "converged and verified", f" ({how})"
    return "NOT CONVERGED", f": {solution.status} ({how})"


def brief(solution: Any) -> str:
    """Return one line: the title, whether the solution converged, and the main figures."""
    figures = (line(FIGURES[key], solution) for key in _BRIEF)
    texts = [f"{one.label} {one.value} {one.unit}".rstrip() for one in figures if one.value != "-"]
    return one_line(solution, solution.nip.title, f", geometry {solution.model.geometry}", *texts)


def one_line(result: Any, title: str, model: str, *texts: str) -> str:
    """Return a result of any kind in one line, with texts on its main figures."""
    name = f'"{title}", ' if title else ""
    state = "converged" if result.converged else "NOT CONVERGED"
    return f"<{type(result).__name__} {name}{state}{model}: {', '.join(texts)}>"


def text(solution: Any, units: Units = "metric") -> str:
    """Return the summary as lines of plain text."""
    lines = [solution.nip.title or "Nip", "".join(verdict(solution))]
    for heading, rows in sections(solution, units):
        lines += ["", heading, *map(_plain, rows)]
    for heading, rows in zone_sections(solution, units):
        lines += ["", heading, *map(_plain, rows)]
    lines += ["", *(f"Note: {warning}" for warning in solution.warnings), SIGNS]
    return "\n".join(lines)


def html(solution: Any) -> str:
    """Return the summary as HTML for notebooks."""
    title = escape(solution.nip.title or "Nip")
    parts = [f"<p><strong>{title}</strong><br>{escape(''.join(verdict(solution)))}</p>", "<table>"]
    for heading, rows in sections(solution):
        parts.append(f'<tr><th colspan="3" style="{_STYLE}">{escape(heading)}</th></tr>')
        parts += map(_row, rows)
    parts.append("</table>")
    notes = [*(f"Note: {warning}" for warning in solution.warnings), SIGNS]
    return "".join([*parts, *(f"<p>{escape(note)}</p>" for note in notes)])


def zone_sections(solution: Any, units: Units = "metric") -> Iterator[tuple[str, list[Line]]]:
    """Yield headings with a line for each zone of stick or slip; a sheet has two headings."""
    if solution.sheet is None:
        if solution.zones:
            yield "Stick and slip", list(_zone_lines(solution.zones, FASTER, units))
        return
    above = {-1: "the upper roller is faster", 1: "the sheet is faster"}
    below = {-1: "the sheet is faster", 1: "the lower roller is faster"}
    yield "Stick and slip, upper side of the sheet", list(_zone_lines(solution.zones, above, units))
    lower = solution.sheet.zones_lower
    yield "Stick and slip, lower side of the sheet", list(_zone_lines(lower, below, units))


def _zone_lines(zones: Iterable[Any], faster: Mapping[int, str], units: Units) -> Iterator[Line]:
    edge = _EDGE.in_units(units)
    for zone in zones:
        ends = " to ".join(edge.number(end) for end in (zone.start, zone.stop))
        yield Line(zone.state, ends, edge.shown_unit, note=faster.get(zone.direction or 0, ""))


def _grip(grip: Any, units: Units) -> Iterator[Line]:
    """Yield the limits of the pull on the sheet, and the side that slides all over first."""
    for key, figure in PULL_FIGURES.items():
        yield _sub_line(figure.label, figure.in_units(units), getattr(grip, key))
    yield Line("  slides first where pulled", f"{grip.first} side")


def _contact(solution: Any, units: Units) -> Iterator[Line]:
    """Yield the edges of each contact interval; of many, the outermost edges and total length."""
    intervals = solution.contact
    if len(intervals) > _MOST_INTERVALS:
        length = sum(leading - trailing for trailing, leading in intervals)
        yield from _edges(solution, intervals[0][0], intervals[-1][1], units)
        yield _sub_line(f"touching in {len(intervals)} pieces", _EDGE.in_units(units), length)
        return
    for trailing, leading in intervals:
        yield from _edges(solution, trailing, leading, units)


def _alike(solution: Any, units: Units) -> Iterator[Line]:
    """Yield a line for the place of each further peak as high as the highest; for many, one."""
    places = solution.peaks_alike_x
    if len(places) > _MOST_INTERVALS:
        yield Line("  as high in", f"{len(places)}", "other places")
        return
    for place in places:
        yield _sub_line("as high at x", FIGURES["peak_pressure_x"].in_units(units), place)


def _edges(solution: Any, trailing: float, leading: float, units: Units) -> Iterator[Line]:
    for label, edge in (("from x", trailing), ("to x", leading)):
        is_noise = abs(edge) < ROUNDING * solution.nip_width
        yield _sub_line(label, _EDGE.in_units(units), 0.0 if is_noise else edge)


def _totals(solution: Any, width: float, units: Units) -> Iterator[Line]:
    face = PLACES["face_width"].in_units(units)
    yield Line(face.label, face.number(width), face.shown_unit)
    for figure in FIGURES.values():
        value = figure.cleaned(solution)
        if figure.total is not None and value is not None:
            total = figure.total.in_units(units)
            number = format_quantity(value * width * total.factor, digits=figure.digits)
            yield Line(figure.label, number, total.unit)


def _sub_line(label: str, figure: Figure, value: float) -> Line:
    """Return an indented line, in the unit and with the digits of a figure."""
    return Line(f"  {label}", figure.number(value), figure.shown_unit)


def _plain(row: Line) -> str:
    parts: Iterable[str] = (f"  {row.label:26s}", f"{row.value:>11s}", f" {row.unit:7s}")
    return " ".join(["".join(parts), row.error or row.note]).rstrip()


def _row(row: Line) -> str:
    cells = (row.label, f"{row.value} {row.unit}".rstrip(), row.error or row.note)
    return "<tr>" + "".join(f'<td style="{_STYLE}">{escape(cell)}</td>' for cell in cells) + "</tr>"
