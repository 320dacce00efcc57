"""Parameters and results by name: their kinds of quantity, read from numbers or texts."""

from __future__ import annotations

from collections.abc import Mapping
from difflib import get_close_matches
from math import isfinite, isnan
from typing import Any, get_args

from rollnip._errors import InvalidInputError
from rollnip._units import Dimension, base_unit, parse_quantity
from rollnip.io import dimension_at
from rollnip.sweeps import SCALARS

# Information on how a case was solved cannot be an aim of a design.
QUANTITIES: Mapping[str, str] = {
    name: "" if unit == "1" else unit
    for name, unit in SCALARS.items()
    if not name.startswith(("error.", "solver.", "patch.error."))
}
"""The results that can be aims, with their base units; empty for a ratio."""

# Units that a reader is shown, where they have another name but the same size.
_SHOWN = {"N/s": "mW/mm"}
# Results whose error follows from that of another by proportion.
_PROPORTIONAL = {"dwell_time": "nip_width", "mean_pressure": "nip_width"}


def require_quantity(name: str, said: str = "quantity") -> None:
    """Raise InvalidInputError, with the nearest name, unless ``name`` is a result."""
    if name in QUANTITIES:
        return
    near = get_close_matches(str(name), QUANTITIES, n=1, cutoff=0.5)
    hint = f'did you mean "{near[0]}"?' if near else f"there are {', '.join(QUANTITIES)}."
    raise InvalidInputError(f'`{said}` must be the name of a result, got "{name}"; {hint}')


def parameter_dimension(tree: Mapping[str, Any], path: str) -> Dimension:
    """Return the dimension of the number at a path; raise InvalidInputError if there is none."""
    dimension = dimension_at(tree, path)
    if dimension is None:
        raise InvalidInputError(f"`path` must lead to a number of the case, got {path}.")
    return dimension


def read_parameter(said: str, value: object, dimension: Dimension) -> float:
    """Return a value in base units, from a number or a text with its unit.

    Raises InvalidInputError, which calls the value ``said``.
    """
    try:
        return parse_quantity(value, dimension)
    except InvalidInputError as error:
        raise InvalidInputError(f"`{said}` {error}") from None


def read_result(said: str, value: object, quantity: str) -> float:
    """Return a wanted value of a result in its base unit, as `read_parameter` does."""
    unit = QUANTITIES[quantity]
    dimension = next((one for one in get_args(Dimension) if base_unit(one) == unit), None)
    if dimension is not None:
        return read_parameter(said, value, dimension)
    shown = _SHOWN.get(unit, unit)
    if isinstance(value, str):
        value = _plain(value.strip().removesuffix(unit).removesuffix(shown).strip())
    if not isinstance(value, int | float) or isinstance(value, bool) or not isfinite(value):
        units = unit if shown == unit else f"{shown} (= {unit})"
        raise InvalidInputError(f"`{said}` must be a finite number in {units}, got {value!r}.")
    return float(value)


def result_error(row: Mapping[str, Any], quantity: str) -> float | None:
    """Return the estimated error of a result in its unit; None where there is no estimate."""
    source = _PROPORTIONAL.get(quantity, quantity)
    error, value, size = row.get(f"error.{source}"), row.get(quantity), row.get(source)
    if error is None or value is None or not size:
        return error if source == quantity else None
    return float(abs(error * value / size))


def json_tree(value: Any) -> Any:
    """Return plain values for JSON: an infinite number (a plane's radius) as text, nan as None."""
    if isinstance(value, Mapping):
        return {str(name): json_tree(one) for name, one in value.items()}
    if isinstance(value, list | tuple):
        return [json_tree(one) for one in value]
    if isinstance(value, float) and not isfinite(value):
        return None if isnan(value) else str(value)
    return value


def _plain(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text
