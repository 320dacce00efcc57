"""Relaxation and creep: modulus or compliance over the time since a sudden strain or stress."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError
from rollnip.dma.data import Measured, modulus_of
from rollnip.dma.heads import Modulus
from rollnip.dma.reading import read_tables

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False, slots=True)
class TimeData(Measured):
    """A relaxation modulus E(t) or creep compliance D(t) = strain/stress in tension.

    Attributes
    ----------
    time : (n,) [s].
    temperature : (n,) [degC].
    values : (n,) relaxation modulus [MPa] or compliance [1/MPa].
    kind : "relaxation" or "creep".
    poisson, source, rows : as in `DmaData`.

    Raises
    ------
    InvalidInputError
        as in `DmaData`, or where ``kind`` is unknown.
    """

    time: Array
    temperature: Array
    values: Array
    kind: Literal["relaxation", "creep"] = "relaxation"
    poisson: float = 0.5
    source: str = "data"
    rows: tuple[str, ...] = ()

    _POSITIVE: ClassVar[tuple[str, ...]] = ("time", "values")

    def __post_init__(self) -> None:
        if self.kind not in ("relaxation", "creep"):
            raise InvalidInputError(f'`kind` must be relaxation or creep, got "{self.kind}".')
        Measured.__post_init__(self)

    @property
    def frequency(self) -> Array:
        """(n,) 1/(2 pi time) [Hz], at which a dynamic measurement gives about the same modulus."""
        return np.asarray(1.0 / (2.0 * np.pi * self.time))

    @property
    def storage(self) -> Array:
        """(n,) the values, which take the place of the storage modulus."""
        return self.values

    @property
    def loss(self) -> Array:
        """(n,) the values again, since no second quantity is measured."""
        return self.values


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

    Rows at or before time zero are left out. Parameters and errors are those of `read_dma`; for a
    compliance, ``modulus`` says whether it is that of tension, strain/stress = 1/E ("E"), or of
    shear
    ("G").
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
