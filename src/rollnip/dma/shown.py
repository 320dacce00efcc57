"""How a file of measurements was understood, as lines for people or as a tree for programs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rollnip._units import format_quantity
from rollnip.dma.heads import SHOWN, MeasuredQuantity

if TYPE_CHECKING:
    from rollnip.dma.reading import Reading, ReadTable

KINDS: Mapping[str, str] = {
    "dynamic": "a sweep of frequency or temperature",
    "relaxation": "a relaxation modulus over time",
    "creep": "a creep compliance over time",
}
"""What a table of each kind holds."""
UNITS = {"frequency": "Hz", "temperature": "degC", "time": "s", "phase": "rad", "tan delta": ""}
"""Base units of the quantities that are not in MPa."""
_NAMED = 6  # most line numbers that are listed


def description_lines(reading: Reading) -> Iterator[str]:
    """Yield the lines of a description, for people."""
    how = [
        one
        for one in (reading.encoding, reading.separator and f"{reading.separator}-separated")
        if one
    ]
    if reading.decimal_comma:
        how.append("decimal commas")
    yield f"{reading.source}" + (f": {', '.join(how)}" if how else "")
    if reading.passed:
        left = counted(len(reading.passed), "line")
        yield f"  {left} outside of tables ({named_lines(reading.passed)})"
    for table in reading.tables:
        yield f"{table.name}, heads in line {table.line}"
        if table.kind is None:
            yield f"  not used: {table.problem or table.fault}"
            continue
        yield f"  {KINDS[table.kind]}, {counted(len(table.rows), 'row')}"
        yield from _shown_columns(table)
        yield from (f"  {note}" for note in table.notes)
    if not reading.tables:
        yield "  no table whose heads are known"


def table_tree(table: ReadTable) -> dict[str, Any]:
    """Return the description of one table as plain values."""
    columns = {
        quantity: {
            "head": table.heads[index].text,
            "unit": _unit(quantity),
            "low": float(table.values[quantity].min()),
            "high": float(table.values[quantity].max()),
        }
        for quantity, index in table.used.items()
        if quantity in table.values and table.kind is not None
    }
    return {
        "name": table.name,
        "line": table.line,
        "kind": table.kind,
        "modulus": table.modulus,
        "rows": len(table.rows),
        "columns": columns,
        "notes": list(table.notes),
        "problem": (table.problem or table.fault) if table.kind is None else "",
    }


def _unit(quantity: MeasuredQuantity) -> str:
    return "1/MPa" if quantity == "compliance" else UNITS.get(quantity, "MPa")


def _shown_columns(table: ReadTable) -> Iterator[str]:
    by_index = {index: quantity for quantity, index in table.used.items()}
    for index, head in enumerate(table.heads):
        if not head.text:
            continue
        quantity = by_index.get(index)
        if quantity is None:
            yield f"  {head.text:<28} passed over"
            continue
        values = table.values[quantity]
        unit = _unit(quantity)
        low, high = (
            format_quantity(float(v), unit, digits=4) for v in (values.min(), values.max())
        )
        name = SHOWN[quantity] + (f" {head.kind}" if head.kind else "")
        told = f" (in {head.unit})" if head.unit else ""
        several = np.unique(np.round(values)).size if quantity == "temperature" else 0
        more = f", {counted(several, 'temperature')} to the degree" if several else ""
        yield f"  {head.text:<28} {name}{told}: {low} to {high}{more}"


def counted(number: int, name: str) -> str:
    """Return a number with its noun, in the singular or plural."""
    return f"{number} {name}{'' if number == 1 else 's'}"


def named_lines(lines: Sequence[int]) -> str:
    """Return the numbers of the first few of these lines, as text."""
    shown = ", ".join(str(line) for line in lines[:_NAMED])
    word = "line" if len(lines) == 1 else "lines"
    return f"{word} {shown}{', ...' if len(lines) > _NAMED else ''}"
