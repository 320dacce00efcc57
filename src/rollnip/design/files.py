"""Readers of optimise.toml and tolerance.toml; every error is one clear line."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from itertools import chain
from pathlib import Path
from typing import Any, Literal, TypeVar

from rollnip._errors import CaseFileError, InvalidInputError
from rollnip.design.aims import (
    AtLeast,
    AtMost,
    LeastChange,
    Limit,
    Maximise,
    Minimise,
    Objective,
)
from rollnip.design.distributions import (
    Correlation,
    Distribution,
    LogNormal,
    Normal,
    Triangular,
    Uniform,
    Varied,
    frozen,
)
from rollnip.design.posteriors import posterior
from rollnip.design.problem import Bounds, limits_of
from rollnip.design.quantities import parameter_dimension, require_quantity
from rollnip.design.scatter import Sampling
from rollnip.design.search import Search
from rollnip.io import value_at
from rollnip.io.designs import (
    BoundsTable,
    CorrelationTable,
    LimitTable,
    ObjectiveTable,
    SamplingPlanTable,
    SearchTable,
    VariedTable,
    parse_optimise,
    parse_tolerance,
)
from rollnip.io.document import folder_of, read_document
from rollnip.io.messages import placed

_Entry = TypeVar("_Entry")
_Read = TypeVar("_Read")

_KEYS = {
    "normal": ("mean", "deviation", "low", "high"),
    "uniform": ("low", "high"),
    "triangular": ("low", "mode", "high"),
    "lognormal": ("median", "spread", "low", "high"),
}
_FROM_CASE = ("mean", "mode", "median")
_MAY_MISS = {"normal": ("low", "high"), "lognormal": ("low", "high")}


@dataclass(frozen=True, slots=True, kw_only=True)
class OptimiseStudy:
    """The contents of a file for `optimise`."""

    title: str
    case: Mapping[str, Any]
    parameters: tuple[Bounds, ...]
    objective: Objective
    limits: tuple[Limit, ...]
    search: Search


@dataclass(frozen=True, slots=True, kw_only=True)
class ToleranceStudy:
    """The contents of a file for `tolerance`."""

    title: str
    case: Mapping[str, Any]
    parameters: tuple[Varied, ...]
    results: tuple[str, ...]
    limits: tuple[Limit, ...]
    correlations: tuple[Correlation, ...]
    sampling: Sampling


def read_optimise(path: str | Path) -> OptimiseStudy:
    """Read a file that describes an optimisation, TOML or JSON.

    The name of the case in it is relative to the folder of the file.

    Raises
    ------
    CaseFileError
        where a file cannot be read or its contents are impossible; with the name of the file and
        the path of the key.
    """
    source = str(path)
    table = parse_optimise(read_document(path), source)
    case = _case(table.case, path)
    return OptimiseStudy(
        title=table.title or str(case.get("title", "")),
        case=case,
        parameters=_each(table.parameters, source, "parameters", partial(_bounds, case)),
        objective=_objective(table.objective, source),
        limits=_limits(table.limits, source),
        search=_search(table.search, source),
    )


def read_tolerance(path: str | Path) -> ToleranceStudy:
    """Read a file that describes a computation of tolerances, TOML or JSON.

    The name of the case in it is relative to the folder of the file. A mean, mode or median that is
    left out is the value in the case.

    Raises
    ------
    CaseFileError
        where a file cannot be read or its contents are impossible; with the name of the file and
        the path of the key.
    """
    source = str(path)
    table = parse_tolerance(read_document(path), source)
    case = _case(table.case, path)
    known, together = _fitted(table.fit, path)
    return ToleranceStudy(
        title=table.title or str(case.get("title", "")),
        case=case,
        parameters=(
            *known,
            *_each(table.parameters, source, "parameters", partial(_varied, case)),
        ),
        results=_each(table.results, source, "results", _result),
        limits=_limits(table.limits, source),
        correlations=(
            *together,
            *_each(table.correlations, source, "correlations", _correlation),
        ),
        sampling=_sampling(table.sampling, source),
    )


def _each(
    entries: Sequence[_Entry], source: str, key: str, read: Callable[[_Entry], _Read]
) -> tuple[_Read, ...]:
    """Return the entries of a list as read; an error names the file and the entry."""
    found = []
    for index, entry in enumerate(entries):
        with _at(source, f"{key}[{index}]"):
            found.append(read(entry))
    return tuple(found)


@contextmanager
def _at(source: str, where: str) -> Iterator[None]:
    """Prefix an input error raised inside the block with the file and the place in it."""
    try:
        yield
    except InvalidInputError as error:
        said = str(error)
        of_path = "` is no path of this case" in said
        line = f"{where}.path: {said}" if of_path else placed(where, said)
        raise CaseFileError(f"{source}: {line}") from None


def _case(given: Any, path: str | Path) -> Mapping[str, Any]:
    if isinstance(given, str):
        folder = folder_of(path)
        return read_document(folder / given)
    if not isinstance(given, dict):
        raise CaseFileError(f"{path}: case: must be the name of a case file, or a table.")
    return given


def _fitted(
    name: str | None, path: str | Path
) -> tuple[tuple[Varied, ...], tuple[Correlation, ...]]:
    """Return the unknowns of a fit as parameters, and their correlations; empty without a fit."""
    if name is None:
        return (), ()
    folder = folder_of(path)
    with _at(str(path), "fit"):
        return posterior(read_document(folder / name))


def _objective(table: ObjectiveTable, source: str) -> Objective:
    with _at(source, "objective"):
        aims = {name: getattr(table, name) for name in ("minimise", "maximise", "least_change")}
        given = [name for name, value in aims.items() if value is not None]
        if len(given) != 1:
            got = " and ".join(given) if given else "none"
            raise InvalidInputError(f"must hold one of {', '.join(aims)}, got {got}.")
        if (table.least_change is None) != (table.against is None):
            raise InvalidInputError("must hold least_change and against together, or neither.")
        if table.least_change is not None:
            return LeastChange(table.least_change, str(table.against))
        return Maximise(table.maximise) if table.maximise else Minimise(str(table.minimise))


def _bounds(case: Mapping[str, Any], table: BoundsTable) -> Bounds:
    bounds = Bounds(table.path, table.low, table.high)
    limits_of(case, bounds)
    return bounds


def _varied(case: Mapping[str, Any], table: VariedTable) -> Varied:
    dimension = parameter_dimension(case, table.path)
    varied = Varied(table.path, _distribution(table, case))
    frozen(varied.distribution, dimension)
    return varied


def _limits(tables: Sequence[LimitTable], source: str) -> tuple[Limit, ...]:
    return tuple(chain.from_iterable(_each(tables, source, "limits", _both_limits)))


def _both_limits(table: LimitTable) -> list[Limit]:
    if table.at_least is None and table.at_most is None:
        raise InvalidInputError("must hold at_least, at_most or both, got neither.")
    limits: list[Limit] = []
    if table.at_least is not None:
        limits.append(AtLeast(table.result, table.at_least, table.tolerance))
    if table.at_most is not None:
        limits.append(AtMost(table.result, table.at_most, table.tolerance))
    return limits


def _correlation(table: CorrelationTable) -> Correlation:
    if len(table.between) != 2:
        raise InvalidInputError(f"`between` must name two parameters, got {len(table.between)}.")
    one, other = table.between
    return Correlation(one, other, table.coefficient)


def _result(name: str) -> str:
    try:
        require_quantity(name)
    except InvalidInputError as error:
        raise InvalidInputError(str(error).removeprefix("`quantity` ")) from None
    return name


def _search(table: SearchTable, source: str) -> Search:
    given = {name: getattr(table, name) for name in ("solves", "starts", "tolerance", "seed")}
    with _at(source, "search"):
        return Search(**{name: value for name, value in given.items() if value is not None})


def _sampling(table: SamplingPlanTable, source: str) -> Sampling:
    given = {name: getattr(table, name) for name in ("count", "sobol", "confidence", "seed")}
    given["probabilities"] = None if table.quantiles is None else tuple(table.quantiles)
    with _at(source, "sampling"):
        try:
            return Sampling(**{name: value for name, value in given.items() if value is not None})
        except InvalidInputError as error:
            said = str(error).replace("`probabilities`", "`quantiles`", 1)  # as the file calls them
            raise InvalidInputError(said) from None


def _distribution(table: VariedTable, case: Mapping[str, Any]) -> Distribution:
    kind: Literal["normal", "uniform", "triangular", "lognormal"] = table.distribution
    keys = _KEYS[kind]
    given = table.model_fields_set - {"path", "distribution"}
    for name in sorted(given - set(keys)):
        raise InvalidInputError(
            f"`{name}` has no meaning for a {kind} distribution (there: {', '.join(keys)})."
        )
    values: dict[str, Any] = {}
    for name in keys:
        value = getattr(table, name)
        if value is None and name in _FROM_CASE:
            value = value_at(case, table.path)
        if value is None and name not in _MAY_MISS.get(kind, ()):
            raise InvalidInputError(f"`{name}` must be given for a {kind} distribution.")
        values[name] = value
    makers: dict[str, Any] = {
        "normal": Normal,
        "uniform": Uniform,
        "triangular": Triangular,
        "lognormal": LogNormal,
    }
    made: Distribution = makers[kind](**values)
    return made
