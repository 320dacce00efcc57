"""Relaxation and creep: a modulus or a compliance over the time since a sudden strain or stress."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError, require_finite
from rollnip.dma.data import isotherms_of, modulus_of
from rollnip.dma.heads import Modulus
from rollnip.dma.reading import read_tables
from rollnip.materials.shift import checked_temperature

Array = NDArray[np.float64]

_LEAST = 4  # measurements


@dataclass(frozen=True, eq=False, slots=True)
class TimeData:
    """A relaxation modulus E(t) or creep compliance D(t) = strain/stress in tension.

    Attributes
    ----------
    time : (n,) [s].
    temperature : (n,) [degC].
    values : (n,) [MPa] of a relaxation modulus, [1/MPa] of a compliance.
    kind : "relaxation" or "creep".
    poisson : with which shear data were, or would be, converted.
    source : name of the file or other source.
    rows : where each measurement stands in the source, for messages; empty where it is not known.

    Raises
    ------
    InvalidInputError
        where there are fewer than four measurements, shapes differ, or a value is not positive
        and finite.
    """

    time: Array
    temperature: Array
    values: Array
    kind: Literal["relaxation", "creep"] = "relaxation"
    poisson: float = 0.5
    source: str = "data"
    rows: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        count = self.time.size
        if count < _LEAST:
            raise InvalidInputError(
                f"`{self.source}` must hold at least {_LEAST} measurements, got {count}."
            )
        if self.kind not in ("relaxation", "creep"):
            raise InvalidInputError(f'`kind` must be relaxation or creep, got "{self.kind}".')
        for name in ("time", "temperature", "values"):
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
        checked_temperature("temperature", float(np.min(self.temperature)))
        require_finite("poisson", self.poisson)

    @property
    def frequency(self) -> Array:
        """(n,) 1/(2 pi time) [Hz]: where a dynamic measurement would see about the same."""
        return np.asarray(1.0 / (2.0 * np.pi * self.time))

    @property
    def storage(self) -> Array:
        """(n,) the values: they take the place of the storage modulus."""
        return self.values

    @property
    def loss(self) -> Array:
        """(n,) the values again: nothing is measured beside them."""
        return self.values

    def row(self, index: int) -> str:
        """Return the place of a measurement in its source, as messages name it."""
        return self.rows[index] if self.rows else f"measurement {index + 1}"

    def isotherms(self, width: float = 1.0) -> list[NDArray[np.int64]]:
        """Indices of the measurements of each temperature, coldest first; see `DmaData`."""
        return isotherms_of(self.temperature, width)


def read_time_data(
    path: str | Path,
    *,
    modulus: Modulus | None = None,
    poisson: float = 0.5,
    temperature: float | None = None,
    sheet: str | None = None,
    tables: Sequence[int] = (),
) -> TimeData:
    """Read a relaxation or creep test: time with E(t), G(t) or a compliance.

    Rows at or before time zero are left out. Parameters and errors as `read_dma`: ``modulus``
    says whether a compliance is that of tension, strain/stress = 1/E ("E"), or shear ("G").
    """
    reading = read_tables(path, temperature=temperature, sheet=sheet)
    kinds = [table.kind for table in reading.tables if table.kind in ("relaxation", "creep")]
    kind: Literal["relaxation", "creep"] = "creep" if kinds[:1] == ["creep"] else "relaxation"
    chosen = reading.chosen(kind, tables)
    told = modulus_of(reading.source, chosen, modulus)
    factor = 2.0 * (1.0 + poisson) if told == "G" else 1.0
    quantity: Literal["compliance", "relaxation"] = (
        "compliance" if kind == "creep" else "relaxation"
    )
    time = np.concatenate([table.values["time"] for table in chosen])
    values = np.concatenate([table.values[quantity] for table in chosen])
    degrees = np.concatenate([table.values["temperature"] for table in chosen])
    rows = [row for table in chosen for row in table.rows]
    later = time > 0.0
    return TimeData(
        time=time[later],
        temperature=degrees[later],
        values=values[later] * (1.0 / factor if kind == "creep" else factor),
        kind=kind,
        poisson=poisson,
        source=str(path),
        rows=tuple(row for row, kept in zip(rows, later, strict=True) if kept),
    )
