"""Dynamic-mechanical data: frequency and temperature sweeps of a complex modulus."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError, require_finite
from rollnip._units import Dimension
from rollnip.io import Columns, read_columns
from rollnip.materials.shift import checked_temperature

Array = NDArray[np.float64]
Modulus = Literal["E", "G"]

_FREQUENCY = ("frequency", "freq", "f")
_ANGULAR = ("angular frequency", "ang. frequency", "omega")
_TEMPERATURE = ("temperature", "temp", "t")
_STORAGE = {"storage modulus": None, "e'": "E", "g'": "G"}
_LOSS = {"loss modulus": None, "e''": "E", "g''": "G"}
_TAN = ("tan delta", "tan(delta)", "tan d", "loss factor", "tan δ")
_LEAST = 4  # measurements


@dataclass(frozen=True, eq=False, slots=True)
class DmaData:
    """A complex Young's modulus measured at frequencies and temperatures.

    Attributes
    ----------
    frequency : (n,) [Hz].
    temperature : (n,) [degC].
    storage, loss : (n,) real and imaginary part of E* [MPa].
    poisson : with which shear moduli were, or would be, converted.
    source : where they come from.
    rows : where each measurement stands in the source, for messages; empty where it is not known.

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

    def __post_init__(self) -> None:
        count = self.frequency.size
        if count < _LEAST:
            raise InvalidInputError(
                f"`{self.source}` must hold at least {_LEAST} measurements, got {count}."
            )
        for name in ("frequency", "temperature", "storage", "loss"):
            values = getattr(self, name)
            if values.shape != (count,):
                raise InvalidInputError(f"`{name}` must hold {count} values, got {values.shape}.")
            good = np.isfinite(values) & ((values > 0.0) | (name == "temperature"))
            if not np.all(good):
                raise InvalidInputError(
                    f"`{name}` must be positive and finite, got {values[~good][0]:g} in "
                    f"{self.source}, measurement {int(np.flatnonzero(~good)[0]) + 1}."
                )
        checked_temperature("temperature", float(np.min(self.temperature)))
        require_finite("poisson", self.poisson)

    def row(self, index: int) -> str:
        """Where a measurement stands in the source."""
        return self.rows[index] if self.rows else f"measurement {index + 1}"

    def isotherms(self, width: float = 1.0) -> list[NDArray[np.int64]]:
        """Indices of the measurements of each temperature, coldest first.

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


def read_dma(
    path: str | Path,
    *,
    modulus: Modulus | None = None,
    poisson: float = 0.5,
    temperature: float | None = None,
    frequency: float | None = None,
    sheet: str | None = None,
) -> DmaData:
    """Read a table of a frequency or temperature sweep, CSV or Excel.

    Columns are found by their heads, in any order; others are passed over: ``frequency`` or
    ``angular frequency``, ``temperature``, ``storage modulus`` (or ``E'``, ``G'``), and
    ``loss modulus`` (``E''``, ``G''``) or ``tan delta``. All but tan delta must say their unit.

    Parameters
    ----------
    path :
        of the table.
    modulus :
        "E" or "G", where the heads do not say which was measured.
    poisson :
        turns G into E = 2 (1 + poisson) G.
    temperature, frequency :
        of all measurements [degC, Hz], where there is no such column.
    sheet :
        of a workbook; the first by default.

    Raises
    ------
    InvalidInputError
        where a column or a unit is missing, or a value is none.
    """
    columns = read_columns(path, sheet=sheet)
    heads = {_plain(name): name for name in columns.names}
    storage_name, kind = _modulus_column(columns, heads, _STORAGE, modulus, "storage modulus")
    storage = _numbers(columns, storage_name, "pressure")
    loss = _loss(columns, heads, storage, modulus, kind)
    factor = 2.0 * (1.0 + poisson) if kind == "G" else 1.0
    return DmaData(
        frequency=_frequencies(columns, heads, frequency),
        temperature=_temperatures(columns, heads, temperature),
        storage=factor * storage,
        loss=factor * loss,
        poisson=poisson,
        source=str(path),
    )


def _loss(
    columns: Columns, heads: dict[str, str], storage: Array, modulus: Modulus | None, kind: Modulus
) -> Array:
    tangent = next((heads[name] for name in _TAN if name in heads), None)
    if any(name in heads for name in _LOSS):
        names = {name: said or kind for name, said in _LOSS.items()}
        name, other = _modulus_column(columns, heads, names, modulus, "loss modulus")
        if other != kind:
            raise InvalidInputError(
                f"{columns.source}: storage and loss modulus must be of one kind, got {kind} and "
                f"{other}."
            )
        return _numbers(columns, name, "pressure")
    if tangent is None:
        raise InvalidInputError(
            f'{columns.source}: must have a column "loss modulus" or "tan delta", has '
            f"{', '.join(columns.names)}."
        )
    return storage * columns.numbers(tangent, "ratio")


def _modulus_column(
    columns: Columns,
    heads: dict[str, str],
    names: Mapping[str, str | None],
    modulus: Modulus | None,
    called: str,
) -> tuple[str, Modulus]:
    """Name of the column in the table, and whether it holds E or G."""
    there = [name for name in names if name in heads]
    if len(there) != 1:
        has = "several" if there else f"has {', '.join(columns.names)}"
        raise InvalidInputError(
            f"{columns.source}: must have one column \"{called}\" (or E', G'), {has}."
        )
    said = names[there[0]]
    if said is not None and modulus is not None and said != modulus:
        raise InvalidInputError(
            f'{columns.source}: column "{heads[there[0]]}" says {said}, `modulus` says {modulus}.'
        )
    kind = said or modulus
    if kind is None:
        raise InvalidInputError(
            f'{columns.source}: `modulus` must say whether column "{heads[there[0]]}" is Young\'s '
            'modulus ("E") or the shear modulus ("G"): they differ by a factor of 3 in rubber.'
        )
    return heads[there[0]], "G" if kind == "G" else "E"


def _frequencies(columns: Columns, heads: dict[str, str], given: float | None) -> Array:
    plain = _found(heads, _FREQUENCY)
    angular = _found(heads, _ANGULAR)
    _require_one(columns, "frequency", plain or angular, given)
    if angular is not None and plain is None:
        if columns.unit(angular) != "rad/s":
            raise InvalidInputError(
                f'{columns.source}: column "{angular}" must be in [rad/s], got '
                f'[{columns.unit(angular)}]; in Hz it is called "frequency".'
            )
        return _numbers(columns, angular, "frequency")
    if plain is not None:
        return _numbers(columns, plain, "frequency")
    return _constant(columns, "frequency", given)


def _temperatures(columns: Columns, heads: dict[str, str], given: float | None) -> Array:
    name = _found(heads, _TEMPERATURE)
    _require_one(columns, "temperature", name, given)
    if name is not None:
        return _numbers(columns, name, "temperature")
    return _constant(columns, "temperature", given)


def _require_one(columns: Columns, name: str, column: str | None, given: float | None) -> None:
    if column is not None and given is not None:
        raise InvalidInputError(
            f'{columns.source}: `{name}` must not be given where there is a column "{column}"; '
            "leave it out, or give the column another head."
        )


def _constant(columns: Columns, name: str, given: float | None) -> Array:
    if given is None:
        raise InvalidInputError(
            f'{columns.source}: must have a column "{name}", or `{name}` must be given for all.'
        )
    return np.full(len(columns.rows), float(given))


def _numbers(columns: Columns, name: str, dimension: Dimension) -> Array:
    """A column whose unit must be said: moduli come in Pa and MPa, temperatures in degC and K."""
    columns.require_unit(name, dimension)
    return columns.numbers(name, dimension)


def _found(heads: dict[str, str], names: Sequence[str]) -> str | None:
    return next((heads[name] for name in names if name in heads), None)


def _plain(head: str) -> str:
    """A head in small letters, with primes as apostrophes."""
    text = head.strip().lower().replace("″", "''").replace("′", "'").replace('"', "''")
    return " ".join(text.replace("’", "'").replace("_", " ").split())
