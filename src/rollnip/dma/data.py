"""Dynamic-mechanical data: frequency and temperature sweeps of a complex modulus."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError, require_finite
from rollnip.dma.heads import Modulus
from rollnip.dma.reading import ReadTable, read_tables
from rollnip.materials.shift import checked_temperature

Array = NDArray[np.float64]

_LEAST = 4  # fewest measurements accepted
_FARTHEST = 1e30  # Hz, MPa, s; beyond it, or below its inverse, a unit was mistaken
_HOTTEST = 1e4  # degC


class Measured:
    """Base class of measurements of a material at temperatures: their checks and their isotherms.

    Each measurement has a ``temperature``, and positive values in the arrays listed in
    ``_POSITIVE``.
    """

    __slots__ = ()

    temperature: Array
    poisson: float
    source: str
    rows: tuple[str, ...]

    _POSITIVE: ClassVar[tuple[str, ...]] = ()

    def __post_init__(self) -> None:
        count = getattr(self, self._POSITIVE[0]).size
        if count < _LEAST:
            raise InvalidInputError(
                f"`{self.source}` must hold at least {_LEAST} measurements, got {count}."
            )
        for name in (*self._POSITIVE, "temperature"):
            values = getattr(self, name)
            if values.shape != (count,):
                raise InvalidInputError(f"`{name}` must hold {count} values, got {values.shape}.")
            good = np.isfinite(values) & ((values > 0.0) | (name == "temperature"))
            if not np.all(good):
                first = int(np.flatnonzero(~good)[0])
                raise InvalidInputError(
                    f"`{name}` must be positive and finite, got {values[first]:g} in "
                    f"{self.source}, {self.row(first)}."
                )
            self._check_size(name, values)
        checked_temperature("temperature", float(np.min(self.temperature)))
        require_finite("poisson", self.poisson)

    def _check_size(self, name: str, values: Array) -> None:
        """Raise where a value is so far from any rubber's that a unit was mistaken."""
        if name == "temperature":
            good, said = values <= _HOTTEST, f"at most {_HOTTEST:g} degC"
        else:
            good = (values >= 1.0 / _FARTHEST) & (values <= _FARTHEST)
            said = f"between {1.0 / _FARTHEST:g} and {_FARTHEST:g}"
        if not np.all(good):
            first = int(np.flatnonzero(~good)[0])
            raise InvalidInputError(
                f"`{name}` must be {said}, got {values[first]:g} in {self.source}, "
                f"{self.row(first)}."
            )

    def row(self, index: int) -> str:
        """Return the location of a measurement in its source, as messages name it."""
        return self.rows[index] if self.rows else f"measurement {index + 1}"

    def isotherms(self, width: float = 1.0) -> list[NDArray[np.int64]]:
        """Return the indices of the measurements of each isotherm, coldest first.

        Temperatures within ``width`` [K] of the coldest of a group count as one.
        """
        order = np.argsort(self.temperature, kind="stable")
        groups: list[list[int]] = []
        for index in order:
            first = groups[-1][0] if groups else index
            if groups and self.temperature[index] - self.temperature[first] <= width:
                groups[-1].append(int(index))
            else:
                groups.append([int(index)])
        return [np.array(group, dtype=np.int64) for group in groups]


@dataclass(frozen=True, eq=False, slots=True)
class DmaData(Measured):
    """A complex Young's modulus measured at frequencies and temperatures.

    Attributes
    ----------
    frequency : (n,) [Hz].
    temperature : (n,) [degC].
    storage, loss : (n,) real and imaginary part of E* [MPa].
    poisson : Poisson ratio with which shear moduli were, or would be, converted.
    source : name of the file or other source.
    rows : location of each measurement in the source, for messages; empty where it is not known.

    Raises
    ------
    InvalidInputError
        where there are fewer than four measurements, shapes differ, or a value is not positive
        and finite.
    """

    frequency: Array
    temperature: Array
    storage: Array
    loss: Array
    poisson: float = 0.5
    source: str = "data"
    rows: tuple[str, ...] = ()

    _POSITIVE: ClassVar[tuple[str, ...]] = ("frequency", "storage", "loss")

    @property
    def kind(self) -> Literal["dynamic"]:
        """The kind of measurement: moduli over frequency."""
        return "dynamic"


def read_dma(
    path: str | Path,
    *,
    modulus: Modulus | None = None,
    poisson: float = 0.5,
    temperature: float | None = None,
    frequency: float | None = None,
    sheet: str | None = None,
    tables: Sequence[int] = (),
) -> DmaData:
    """Read a frequency or temperature sweep from a file that an instrument wrote, text or workbook.

    Columns are recognised by their heads, in English or German, in any order: frequency or angular
    frequency, temperature, and two of storage modulus, loss modulus, magnitude of the complex
    modulus,
    tan delta and phase. Units stand in the heads or in a row below them. All tables of a file and
    all
    sheets of a workbook are combined. `read_tables` reports how the file was understood.

    Parameters
    ----------
    path :
        path of the file.
    modulus :
        "E" or "G", where the heads do not say which was measured.
    poisson :
        Poisson ratio that converts G into E = 2 (1 + poisson) G.
    temperature, frequency :
        value for all measurements [degC, Hz], where there is no such column.
    sheet :
        the one sheet of a workbook to read; all by default.
    tables :
        numbers of the tables to use, counted from 1; all by default.

    Raises
    ------
    InvalidInputError
        where a column or a unit is missing, or a cell is not a number.
    """
    reading = read_tables(path, temperature=temperature, frequency=frequency, sheet=sheet)
    chosen = reading.chosen("dynamic", tables)
    kind = modulus_of(reading.source, chosen, modulus)
    factor = 2.0 * (1.0 + poisson) if kind == "G" else 1.0
    storage, loss = (np.concatenate(part) for part in zip(*map(_complex, chosen), strict=True))
    return DmaData(
        frequency=np.concatenate([table.values["frequency"] for table in chosen]),
        temperature=np.concatenate([table.values["temperature"] for table in chosen]),
        storage=factor * storage,
        loss=factor * loss,
        poisson=poisson,
        source=str(path),
        rows=tuple(row for table in chosen for row in table.rows),
    )


def modulus_of(source: str, tables: Sequence[ReadTable], given: Modulus | None) -> Modulus:
    """Return which modulus was measured, E or G, from the heads or as given.

    Raises
    ------
    InvalidInputError
        where neither states it, or they contradict each other.
    """
    said = {table.modulus for table in tables} - {None}
    if len(said) > 1:
        raise InvalidInputError(f"{source}: moduli must be of one kind, got E and G.")
    kind = said.pop() if said else None
    if kind is not None and given is not None and kind != given:
        raise InvalidInputError(f"{source}: the heads say {kind}, `modulus` says {given}.")
    kind = kind or given
    if kind is None:
        raise InvalidInputError(
            f'{source}: `modulus` must say whether it was Young\'s modulus ("E") or the shear '
            'modulus ("G"): they differ by a factor of 3 in rubber, and the heads do not tell.'
        )
    return kind


def _complex(table: ReadTable) -> tuple[Array, Array]:
    """Return storage and loss modulus, computed from the two columns present."""
    values = table.values
    if "storage" in values and "loss" in values:
        return values["storage"], values["loss"]
    tangent = values["tan delta"] if "tan delta" in values else np.tan(values["phase"])
    if "storage" in values:
        return values["storage"], values["storage"] * tangent
    storage = values["absolute"] / np.hypot(1.0, tangent)
    return storage, storage * tangent
