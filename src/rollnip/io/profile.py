"""Measured profiles and crowns as tables: places and heights, units in the column heads.

x [mm], height [um]
-4.000, 1.27
-3.998, 1.31
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from rollnip._errors import InvalidInputError
from rollnip.io.columns import TableColumns, read_columns
from rollnip.materials import Material, stiffness_of_hardness
from rollnip.rollers import Profile
from rollnip.shafts import CoveringTable, CrownTable


def read_profile(path: str | Path) -> Profile:
    """Read a profile from a CSV file or a workbook with the columns ``x`` and ``height``.

    Lengths are in mm where the head names no unit; other columns are left alone. A profile that
    was scanned towards -x is turned round.

    Raises
    ------
    InvalidInputError
        naming the file: it cannot be read, a column is missing, a unit is no length, a cell is
        empty or no number, places do not run in one direction, samples are too many.
    """
    table = read_columns(path)
    x, height = table.samples("x", "length"), table.samples("height", "length")
    if x.size > 1 and np.all(np.diff(x) < 0.0):
        x, height = x[::-1], height[::-1]
    try:
        return Profile(x=x, height=height)
    except InvalidInputError as problem:
        raise InvalidInputError(f"{table.source}: {problem}") from None


def read_crown(path: str | Path) -> CrownTable:
    """Read a crown from a CSV file or a workbook with the columns ``y`` and ``diameter``.

    y is measured from the middle of the face, the diameter over the nominal one; in mm where the
    head names no unit.

    Raises
    ------
    InvalidInputError
        as `read_profile` does.
    """
    table = read_columns(path)
    y, diameter = table.samples("y", "length"), table.samples("diameter", "length")
    if y.size > 1 and np.all(np.diff(y) < 0.0):
        y, diameter = y[::-1], diameter[::-1]
    try:
        return CrownTable(y, diameter)
    except InvalidInputError as problem:
        raise InvalidInputError(f"{table.source}: {problem}") from None


def read_covering(path: str | Path, material: Material | None) -> CoveringTable:
    """Read a covering from a CSV file or a workbook with the column ``y`` and others.

    ``thickness`` of the outermost layer, in mm where the head names no unit; and at most one of
    ``stiffness``, ``modulus`` (relaxed, in MPa) and ``shore_a``, by which it becomes stiffer or
    softer than ``material``.

    Raises
    ------
    InvalidInputError
        as `read_profile` does; also where there are several of these, or no layer.
    """
    table = read_columns(path)
    given = [name for name in ("stiffness", "modulus", "shore_a") if name in table.names]
    if len(given) > 1 or ("thickness" not in table.names and not given):
        raise InvalidInputError(
            f"{table.source}: must have thickness, or one of stiffness, modulus, shore_a, or both; "
            f"has {', '.join(table.names)}."
        )
    try:
        y = table.samples("y", "length")
        turn = slice(None, None, -1 if y.size > 1 and np.all(np.diff(y) < 0.0) else 1)
        thickness = table.samples("thickness", "length") if "thickness" in table.names else None
        stiffness = _stiffness(table, given[0], material) if given else None
        return CoveringTable(
            y[turn],
            None if thickness is None else thickness[turn],
            None if stiffness is None else stiffness[turn],
        )
    except InvalidInputError as problem:
        text = str(problem)
        raise InvalidInputError(
            text if text.startswith(table.source) else f"{table.source}: {text}"
        ) from None


def _stiffness(
    table: TableColumns, name: str, material: Material | None
) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Return the modulus over that of the material, (n,)."""
    if name == "stiffness":
        return table.samples(name, "ratio")
    if material is None:
        raise InvalidInputError(f"`{name}` needs a layer, and the roller has none.")
    if name == "modulus":
        return np.asarray(table.samples(name, "pressure") / material.relaxed_modulus)
    readings = table.samples(name, "ratio")
    return np.array([stiffness_of_hardness(material, float(one)) for one in readings])
