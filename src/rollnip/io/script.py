"""A case written out again: as Python, as TOML, and as a tree of numbers in base units."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import MISSING, fields, is_dataclass
from math import isinf
from typing import Any

import numpy as np
import tomli_w

from rollnip._errors import RollnipError
from rollnip._units import base_unit
from rollnip.cooling import (
    Coolant,
    Cooling,
    HeatBalance,
    Held,
    Insulated,
    PassingSheet,
    Shell,
)
from rollnip.crowns import CoveringTable, CrownTable
from rollnip.io.case import Case, parse_case
from rollnip.io.paths import dimension_at
from rollnip.io.tables import CaseTable
from rollnip.materials import (
    WLF,
    Arrhenius,
    Elastic,
    FractionalZener,
    Gent,
    LossFactor,
    NeoHookean,
    Ogden,
    Prony,
    StandardLinearSolid,
    TabulatedShift,
    Thermal,
    Yeoh,
)
from rollnip.nip import Approach, Creepage, LineLoad, Nip, Torque, Traction
from rollnip.rollers import Layer, Roller
from rollnip.shafts import Crown, Face, JournalStep, Shaft
from rollnip.sheets import Sheet

_WIDTH = 88
# What stands in `rollnip` itself under the same name.
_TYPES = (
    *(Nip, Roller, Layer, LineLoad, Approach, Traction, Creepage, Torque),
    *(Elastic, StandardLinearSolid, Prony, FractionalZener, LossFactor),
    *(WLF, Arrhenius, TabulatedShift),
    *(NeoHookean, Yeoh, Gent, Ogden),
    *(Shaft, JournalStep, Crown, CrownTable, CoveringTable, Face, Sheet),
    *(Thermal, HeatBalance, Cooling, Insulated, Held, Coolant, Shell, PassingSheet),
)


def case_python(case: Case) -> str:
    """Python text that builds the nip with ``rn.`` calls, solves it and prints the main figures.

    Raises
    ------
    RollnipError
        where a part of the case is no object of `rollnip`.
    """
    arguments = [f"{name}={_python(value, 1)}" for name, value in _given(case.model)]
    model = f"rn.Model({', '.join(arguments)})"
    along = ""
    if case.face is not None:
        along = (
            f"face = {_python(case.face, 0)}\n"
            f"along = rn.solve_face(nip, face, {model})\n"
            'print(f"line load {along.load.min():.4g} to {along.load.max():.4g} N/mm")\n'
        )
    if case.heat is not None:
        along += (
            f"heat = {_python(case.heat, 0)}\n"
            f"warm = rn.solve_heat(nip, heat, {model})\n"
            'print(f"hot spot {warm.upper.hot_spot:.4g} and {warm.lower.hot_spot:.4g} degC")\n'
        )
    return (
        "import rollnip as rn\n\n"
        f"nip = {_python(case.nip, 0)}\n"
        f"solution = rn.solve(nip, {model})\n"
        'print(f"nip width {solution.nip_width:.4g} mm, '
        'peak pressure {solution.peak_pressure:.4g} MPa")\n'
    ) + along


def case_toml(tree: Mapping[str, Any]) -> str:
    """A case as a TOML file, its values as they were written; empty keys (None) are left out."""
    return tomli_w.dumps(_without_none(dict(tree)))


def base_tree(tree: Mapping[str, Any]) -> dict[str, Any]:
    """The case with every quantity as a plain number in its base unit (mm, N, MPa, s, degC).

    Names of materials stay; an infinite radius is the text "inf"; keys without a value are left
    out; geometry and tolerance are there even where the case leaves them to their defaults.

    Raises
    ------
    CaseFileError
        where the tree does not describe a nip.
    """
    model = parse_case(tree).model
    out = _plain(CaseTable.model_validate(tree).model_dump(exclude_none=True))
    out["model"]["geometry"], out["solver"]["tolerance"] = model.geometry, model.tolerance
    assert isinstance(out, dict)
    return out


def units_of(tree: Mapping[str, Any]) -> dict[str, str]:
    """Base unit by path of every quantity of a `base_tree`; empty text for plain numbers."""
    units = {}
    for path, value in _leaves(tree, ""):
        if isinstance(value, bool) or (isinstance(value, str) and value != "inf"):
            continue
        dimension = dimension_at(tree, path)
        if dimension is not None:
            units[path] = base_unit(dimension)
    return units


def _python(value: Any, depth: int) -> str:
    """Source text of a value; calls that do not fit on a line take one for each argument."""
    if isinstance(value, tuple):
        parts = [_python(part, depth + 1) for part in value]
        return _call("(", parts, ")", depth, comma=len(parts) == 1)
    if isinstance(value, np.ndarray):
        return _call("[", [repr(part) for part in value.tolist()], "]", depth)
    if is_dataclass(value):
        name = type(value).__name__
        if type(value) not in _TYPES:
            raise RollnipError(f"`{name}` cannot be written as Python.")
        parts = [f"{key}={_python(part, depth + 1)}" for key, part in _given(value)]
        return _call(f"rn.{name}(", parts, ")", depth)
    if isinstance(value, float) and isinf(value):
        return 'float("inf")'
    return repr(value)


def _call(head: str, parts: list[str], tail: str, depth: int, *, comma: bool = False) -> str:
    line = head + ", ".join(parts) + ("," if comma else "") + tail
    if len(line) + 4 * depth <= _WIDTH and "\n" not in line:
        return line
    indent = "    " * (depth + 1)
    return head + "\n" + "".join(f"{indent}{part},\n" for part in parts) + "    " * depth + tail


def _given(value: Any) -> Iterator[tuple[str, Any]]:
    """The fields of a dataclass that differ from their defaults."""
    for field in fields(value):
        here = getattr(value, field.name)
        given = field.default is MISSING or isinstance(here, np.ndarray) or here != field.default
        if given:
            yield field.name, here


def _without_none(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _without_none(part) for name, part in value.items() if part is not None}
    if isinstance(value, list):
        return [_without_none(part) for part in value]
    return value


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _plain(part) for name, part in value.items()}
    if isinstance(value, list):
        return [_plain(part) for part in value]
    return "inf" if isinstance(value, float) and isinf(value) else value


def _leaves(value: Any, path: str) -> Iterator[tuple[str, Any]]:
    if isinstance(value, Mapping):
        for name, part in value.items():
            yield from _leaves(part, f"{path}.{name}" if path else name)
    elif isinstance(value, list):
        for index, part in enumerate(value):
            yield from _leaves(part, f"{path}[{index}]")
    else:
        yield path, value
