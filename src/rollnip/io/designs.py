"""The tables of files that ask for an optimum or for tolerances: which keys, and their form."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

from pydantic import ConfigDict, Field

from rollnip.io.forms import FileTable, Ratio
from rollnip.io.kinds import require_kind
from rollnip.io.messages import checked_form


class BoundsTable(FileTable):
    """A parameter of an optimum."""

    path: str = Field(description="Of the key in the case: upper.layers[0].thickness.")
    low: Any = Field(description="Lower bound, with its unit.")
    high: Any = Field(description="Upper bound.")


class ObjectiveTable(FileTable):
    """The objective of an optimum: a result to minimise, to maximise or to keep steady."""

    minimise: str | None = Field(default=None, description="Name of a result: peak_pressure.")
    maximise: str | None = Field(default=None, description="Name of a result.")
    least_change: str | None = Field(
        default=None, description="Name of a result that is to change least with a number."
    )
    against: str | None = Field(default=None, description="Path of that number: nip.load.")


class LimitTable(FileTable):
    """The limits of a result: at_least, at_most or both."""

    result: str = Field(description="Name of a result: nip_width.")
    at_least: Any = Field(default=None, description="With its unit.")
    at_most: Any = Field(default=None, description="With its unit.")
    tolerance: Ratio = Field(
        default=0.0, description="Share of the limit by which it may be passed; 0 by default."
    )


class SearchTable(FileTable):
    """The settings of the search for an optimum."""

    solves: int | None = Field(
        default=None, description="Cases at most; by default 150, and 100 for each parameter."
    )
    starts: int | None = Field(
        default=None, description="Searches, each from a place of its own; 3 by default."
    )
    tolerance: Ratio | None = Field(
        default=None, description="Of the parameters; 0.1 % of the intervals."
    )
    seed: int | None = Field(default=None, description="Of the random numbers; 0 by default.")


class OptimiseTable(FileTable):
    """A whole file that asks for an optimum."""

    model_config = ConfigDict(title="rollnip optimise file")

    title: str = ""
    case: Any = Field(description="A case file, or the case itself as a table.")
    parameters: list[BoundsTable]
    objective: ObjectiveTable
    limits: list[LimitTable] = Field(default=[])
    search: SearchTable = SearchTable()


class VariedTable(FileTable):
    """A parameter that scatters."""

    path: str = Field(description="Of the key in the case: upper.layers[0].thickness.")
    distribution: Literal["normal", "uniform", "triangular", "lognormal"]
    mean: Any = Field(default=None, description="Of a normal one; none: the value in the case.")
    deviation: Any = Field(default=None, description="Standard deviation of a normal one.")
    low: Any = Field(default=None, description="Least value; a normal one may go without.")
    high: Any = Field(default=None, description="Largest value; a normal one may go without.")
    mode: Any = Field(default=None, description="Of a triangular one; none: the value in the case.")
    median: Any = Field(
        default=None, description="Of a lognormal one; none: the value in the case."
    )
    spread: Any = Field(
        default=None, description="Standard deviation of its logarithm, such as 5 %."
    )


class CorrelationTable(FileTable):
    """The correlation of two parameters."""

    between: list[str] = Field(description="The paths of two parameters.")
    coefficient: Ratio = Field(description="Between -1 and 1.")


class SamplingPlanTable(FileTable):
    """The settings of a tolerance computation."""

    count: int | None = Field(
        default=None, description="Samples of the Latin hypercube; 200 by default."
    )
    sobol: int | None = Field(
        default=None,
        description="Power of two; 0 by default: no Sobol indices. Needs n (d + 2) cases.",
    )
    quantiles: list[Ratio] | None = Field(
        default=None, description="5 %, 50 % and 95 % by default."
    )
    confidence: Ratio | None = Field(default=None, description="Of all intervals; 95 % by default.")
    seed: int | None = Field(default=None, description="Of the random numbers; 0 by default.")


class ToleranceTable(FileTable):
    """A whole file that asks for tolerances."""

    model_config = ConfigDict(title="rollnip tolerance file")

    title: str = ""
    case: Any = Field(description="A case file, or the case itself as a table.")
    parameters: list[VariedTable] = Field(default=[])
    fit: str | None = Field(
        default=None, description="fit.json of a fit: its unknowns scatter as it knows them."
    )
    results: list[str] = Field(
        default=[], description="Names of results; those of limits are there too."
    )
    limits: list[LimitTable] = Field(default=[], description="The specifications.")
    correlations: list[CorrelationTable] = Field(default=[])
    sampling: SamplingPlanTable = SamplingPlanTable()


_OPTIMISE: dict[str, type[FileTable]] = {
    "parameters": BoundsTable,
    "objective": ObjectiveTable,
    "limits": LimitTable,
    "search": SearchTable,
}
_TOLERANCE: dict[str, type[FileTable]] = {
    "parameters": VariedTable,
    "limits": LimitTable,
    "correlations": CorrelationTable,
    "sampling": SamplingPlanTable,
}


def parse_optimise(tree: Mapping[str, Any], source: str) -> OptimiseTable:
    """Check the form. Raises CaseFileError, one line for each error."""
    require_kind(tree, source, "optimise")
    return checked_form(tree, source, OptimiseTable, _OPTIMISE)


def parse_tolerance(tree: Mapping[str, Any], source: str) -> ToleranceTable:
    """Check the form. Raises CaseFileError, one line for each error."""
    require_kind(tree, source, "tolerance")
    return checked_form(tree, source, ToleranceTable, _TOLERANCE)
