"""The tables of a study file: which keys there are and what form each may have."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

from pydantic import ConfigDict, Field

from rollnip.io.forms import FileTable
from rollnip.io.kinds import require_kind
from rollnip.io.messages import checked_form


class ParameterTable(FileTable):
    """One parameter: a list of values, a range, or the columns of a table of designs."""

    path: str | None = Field(None, description="Of the key in the case: upper.radius.")
    values: list[Any] | None = Field(None, description="Numbers in base units, or texts.")
    start: Any = Field(None, description="First value of a range.")
    stop: Any = Field(None, description="Last value of a range.")
    count: int | None = Field(None, description="Of the values of a range; none: it is sampled.")
    spacing: Literal["linear", "log"] = "linear"
    group: str | None = Field(None, description="Parameters of one group step together.")
    table: str | None = Field(None, description="CSV or workbook; the heads are paths.")
    sheet: str | None = Field(None, description="Of the workbook; none: the first.")


class SamplingTable(FileTable):
    """The sampling of ranges that have no count."""

    method: Literal["grid", "latin-hypercube", "sobol"] = "grid"
    count: int | None = None
    seed: int = 0


class StudyTable(FileTable):
    """A whole study file."""

    model_config = ConfigDict(title="rollnip study file")

    title: str = ""
    case: Any = Field(description="A case file, or the case itself as a table.")
    parameters: list[ParameterTable]
    sampling: SamplingTable = SamplingTable()
    results: list[str] | None = Field(None, description="Columns of the table; none: all.")
    profiles: list[str] | None = Field(None, description="Kept for each case; none: no profiles.")


_TABLES: dict[str, type[FileTable]] = {"parameters": ParameterTable, "sampling": SamplingTable}


def parse_study(tree: Mapping[str, Any], source: str) -> StudyTable:
    """Check the form of a study.

    Raises
    ------
    CaseFileError
        one line for each error, with the name of the file and the path of the key.
    """
    require_kind(tree, source, "sweep")
    return checked_form(tree, source, StudyTable, _TABLES)
