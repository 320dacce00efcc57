"""Measured profiles and crowns as tables: places and heights, units in the column heads.

x [mm], height [um]
-4.000, 1.27
-3.998, 1.31
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from rollnip._errors import InvalidInputError
from rollnip.io.columns import read_columns
from rollnip.rollers import Profile
from rollnip.shafts import CrownTable


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
