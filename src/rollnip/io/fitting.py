"""The tables of a file that describes a fit: which keys there are and what form each may have."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

from pydantic import ConfigDict, Field

from rollnip.io.forms import FileTable, Length, Ratio
from rollnip.io.kinds import require_kind
from rollnip.io.messages import checked_form
from rollnip.rollers import Side

Kind = Literal[
    "nip-width",
    "approach",
    "load",
    "peak-pressure",
    "creepage",
    "torque",
    "rolling-resistance",
    "feed",
    "impression",
    "strain",
    "velocity",
]


class PriorTable(FileTable):
    """Prior knowledge of an unknown."""

    value: Any
    standard_error: Any


class UnknownTable(FileTable):
    """A value of the case to be found, within bounds."""

    path: str = Field(description="Of the key in the case: materials.cover.modulus.")
    low: Any = Field(description="Lower bound, with its unit.")
    high: Any = Field(description="Upper bound.")
    start: Any = Field(None, description="First guess; none: the middle of the bounds.")
    scale: Literal["linear", "log"] = "linear"
    prior: PriorTable | None = None


class DataTable(FileTable):
    """A set of measurements in a table of its own."""

    kind: Kind
    file: str = Field(description="CSV or workbook, from the folder of this file.")
    sheet: str | None = Field(None, description="Of the workbook; none: the first.")
    name: str = ""
    column: str | None = Field(None, description="Of what was measured; none: named as the kind.")
    standard_error: Any = Field(
        None, description='Of every value; none: the column "standard error", or estimated.'
    )
    weight: float = 1.0
    at: dict[str, Any] = Field({}, description="Values by path that held for the whole set.")
    ignore: list[str] = Field([], description="Columns of the table to pass over.")
    roller: Side = "upper"
    width: Length = Field(0.0, description="Standard deviation of the averaging along x.")


class MethodTable(FileTable):
    """The settings of a fit."""

    geometry: Literal["linear", "corrected", "curved", "second", "finite", "full"] | None = None
    tolerance: Ratio | None = None
    tried: int | None = None
    followed: int | None = None
    step: Ratio | None = None
    confidence: Ratio | None = None
    profile: bool | None = None
    loss: Literal["squares", "huber"] | None = None


class FitTable(FileTable):
    """A whole file of a fit."""

    model_config = ConfigDict(title="rollnip fit file")

    title: str = ""
    case: Any = Field(description="A case file, or the case itself as a table.")
    unknowns: list[UnknownTable]
    data: list[DataTable]
    method: MethodTable = MethodTable()


_TABLES: dict[str, type[FileTable]] = {
    "unknowns": UnknownTable,
    "prior": PriorTable,
    "data": DataTable,
    "method": MethodTable,
}


def parse_fit(tree: Mapping[str, Any], source: str) -> FitTable:
    """Check the form of a fit's file.

    Raises
    ------
    CaseFileError
        one line for each error, with the name of the file and the path of the key.
    """
    require_kind(tree, source, "fit")
    return checked_form(tree, source, FitTable, _TABLES)
