"""Measurements of rubber at large strain: stretch and nominal stress in homogeneous tests.

    # Treloar 1944
    test,        stretch, stress [MPa]
    tension,     1.24,    0.226
    equibiaxial, 1.31,    0.434

A table has one of the columns ``stretch`` and ``strain`` (stretch less 1, or in "shear" the amount
of shear) and a column ``stress``, force over undeformed area, with its unit. A column ``test``
names the test of each row; without it all rows belong to one test.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, cast, get_args

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError
from rollnip.io.columns import TableColumns, read_columns

Array = NDArray[np.float64]
Test = Literal["tension", "compression", "equibiaxial", "planar", "shear"]
TESTS: tuple[Test, ...] = get_args(Test)
_NAMES = ("test", "stretch", "strain", "stress")
_LARGEST_STRESS = 1e12  # MPa, as moduli
_OF_A_ROW = re.compile(r"`(\w+)\[(\d+)\]` (.*)", re.DOTALL)
_FARTHEST = 1e3  # largest stretch; rubber breaks at some ten


@dataclass(frozen=True, eq=False)
class RubberData:
    """Homogeneous tests of one rubber.

    Attributes
    ----------
    source : origin of the data, for messages.
    test : (n,) test of each row: "tension" or "compression" along one direction, "equibiaxial"
        tension, "planar" tension of a wide sheet, or simple "shear".
    stretch : (n,) stretch along the loaded direction; in "shear" the amount of shear.
    stress : (n,) force over undeformed area, tension positive [MPa].

    Raises
    ------
    InvalidInputError
        where lengths differ, there is no row, a test is unknown, a number is not finite or out of
        any rubber's range, a stretch is not positive, or a row of "compression" has one above 1.
    """

    source: str
    test: tuple[Test, ...]
    stretch: Array
    stress: Array

    def __post_init__(self) -> None:
        for name in ("stretch", "stress"):
            object.__setattr__(self, name, np.array(getattr(self, name), dtype=float))
        size = len(self.test)
        if size == 0 or self.stretch.shape != (size,) or self.stress.shape != (size,):
            raise InvalidInputError(
                "`test`, `stretch` and `stress` must have as many entries as each other and one "
                f"or more, got {size}, {self.stretch.size} and {self.stress.size}."
            )
        for row, (test, stretch, stress) in enumerate(
            zip(self.test, self.stretch, self.stress, strict=True)
        ):
            self._check(row, test, float(stretch), float(stress))

    def _check(self, row: int, test: str, stretch: float, stress: float) -> None:
        if test not in TESTS:
            raise InvalidInputError(
                f"`test[{row}]` must be one of {', '.join(TESTS)}, got {test!r}."
            )
        if not np.isfinite(stress):
            raise InvalidInputError(f"`stress[{row}]` must be finite, got {stress!r}.")
        if abs(stress) > _LARGEST_STRESS:
            raise InvalidInputError(
                f"`stress[{row}]` must be at most {_LARGEST_STRESS:g} MPa in size, got {stress!r}."
            )
        if not np.isfinite(stretch) or (test != "shear" and stretch <= 0.0):
            raise InvalidInputError(
                f"`stretch[{row}]` must be positive and finite, got {stretch!r}."
            )
        least = -_FARTHEST if test == "shear" else 1.0 / _FARTHEST
        if not least <= stretch <= _FARTHEST:
            raise InvalidInputError(
                f"`stretch[{row}]` must lie between {least:g} and {_FARTHEST:g}, got {stretch!r}."
            )
        if test == "compression" and stretch > 1.0:
            raise InvalidInputError(
                f"`stretch[{row}]` must be at most 1 in compression, got {stretch!r}."
            )

    def rows(self, test: Test) -> NDArray[np.bool_]:
        """Return a mask (n,) of the rows of one test."""
        return np.array([one == test for one in self.test])

    @property
    def tests(self) -> tuple[Test, ...]:
        """The tests that occur in the data."""
        return tuple(test for test in TESTS if test in self.test)

    def up_to(self, strain: float) -> RubberData:
        """Return the rows whose strain, stretch less 1, is at most this in absolute value.

        Raises
        ------
        InvalidInputError
            where no row is left.
        """
        kept = [
            abs(stretch - (0.0 if test == "shear" else 1.0)) <= strain
            for test, stretch in zip(self.test, self.stretch, strict=True)
        ]
        if not any(kept):
            raise InvalidInputError(
                f"`strain` must leave measurements, got {strain:g}: all those of {self.source} "
                "lie beyond."
            )
        test = tuple(one for one, keep in zip(self.test, kept, strict=True) if keep)
        return RubberData(self.source, test, self.stretch[kept], self.stress[kept])


def joined(parts: list[RubberData]) -> RubberData:
    """Return the rows of several data sets, one after the other."""
    return RubberData(
        ", ".join(one.source for one in parts),
        tuple(test for one in parts for test in one.test),
        np.concatenate([one.stretch for one in parts]),
        np.concatenate([one.stress for one in parts]),
    )


def read_rubber(
    path: str | Path, *, test: Test | None = None, sheet: str | None = None
) -> RubberData:
    """Read tests from a CSV file or workbook.

    Parameters
    ----------
    path :
        the file.
    test :
        test of all rows, where there is no column ``test``.
    sheet :
        sheet of a workbook; the first by default.

    Returns
    -------
    RubberData. In rows of "compression", strains and stresses may be written as positive numbers,
    if all of them are.

    Raises
    ------
    InvalidInputError
        where the file cannot be read, a column is missing or has a wrong unit, a row belongs to no
        known test, or a stretch is impossible; the message names file, line and column.
    """
    table = read_columns(path, sheet=sheet)
    unknown = [name for name in table.names if name not in _NAMES]
    if unknown:
        raise InvalidInputError(
            f'{path}: has a column "{unknown[0]}", which is none of {", ".join(_NAMES)}; '
            "rename or remove it."
        )
    given = [name for name in ("stretch", "strain") if name in table.names]
    if len(given) != 1:
        raise InvalidInputError(
            f"{path}: must have exactly one of the columns stretch, strain, has "
            f"{' and '.join(given) or 'none'}."
        )
    table.require_unit("stress", "pressure")
    tests = _tests(table, test, str(path))
    values = table.numbers(given[0], "ratio")
    stress = table.numbers("stress", "pressure")
    is_sheared = np.array([one == "shear" for one in tests])
    if given[0] == "stretch" and is_sheared.any():
        raise InvalidInputError(
            f"{path}: shear is given by its amount; name the column strain, not stretch."
        )
    if given[0] == "strain":
        pressed = np.array([one == "compression" for one in tests])
        if pressed.any() and np.all(values[pressed] >= 0.0) and np.all(stress[pressed] >= 0.0):
            values, stress = (np.where(pressed, -one, one) for one in (values, stress))
        values = np.where(is_sheared, values, 1.0 + values)
    try:
        return RubberData(str(path), tests, values, stress)
    except InvalidInputError as error:
        said = _in_the_file(str(error), given[0], table.lines)
        raise InvalidInputError(f"{path}{said}") from None


def _in_the_file(message: str, strained: str, lines: Sequence[int]) -> str:
    """Return what was refused of a row as the line and the column of the file."""
    found = _OF_A_ROW.fullmatch(message)
    if found is None:
        return f": {message}"
    name, row, rest = found.groups()
    is_strain = name == "stretch" and strained == "strain"
    what = 'the stretch, 1 + "strain",' if is_strain else f'"{name}"'
    return f", line {lines[int(row)]}: {what} {rest}"


def _tests(table: TableColumns, test: Test | None, path: str) -> tuple[Test, ...]:
    if test is not None and test not in TESTS:
        raise InvalidInputError(f"`test` must be one of {', '.join(TESTS)}, got {test!r}.")
    if "test" not in table.names:
        if test is None:
            raise InvalidInputError(
                f'{path}: must have a column "test" ({", ".join(TESTS)}), or `test` must be given.'
            )
        return (test,) * len(table.rows)
    if test is not None:
        raise InvalidInputError(f'`test` must not be given: {path} has a column "test".')
    found = [str(cell).strip().lower() for cell in table.cells("test")]
    for name, line in zip(found, table.lines, strict=True):
        if name not in TESTS:
            raise InvalidInputError(
                f'{path}, line {line}: "test" must be one of {", ".join(TESTS)}, got "{name}".'
            )
    return tuple(cast(Test, name) for name in found)
