"""Tolerances: how results are distributed where parameters are."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
import scipy  # its parts are imported where they are first used

from rollnip._errors import InvalidInputError
from rollnip._units import base_unit
from rollnip.design.aims import AtMost, Limit, limit_text, require_consistent
from rollnip.design.distributions import (
    Array,
    Correlation,
    Varied,
    frozen,
    hypercube,
    quantiles_at,
    score_matrix,
)
from rollnip.design.quantities import QUANTITIES, parameter_dimension, require_quantity
from rollnip.design.scatter import (
    FEWEST,
    Chance,
    Quantile,
    Sampling,
    Scatter,
    Share,
    Tolerance,
)
from rollnip.design.sensitivity import SobolIndices, regression, sobol_places, sobol_shares
from rollnip.sweeps import SCALARS, Axis, Study, Table, sweep

Solver = Callable[[Study], Table]

_MOST_PARAMETERS = 20


@dataclass(frozen=True, slots=True)
class _ToleranceQuestion:
    case: Mapping[str, Any]
    paths: tuple[str, ...]
    units: tuple[str, ...]
    distributions: tuple[Any, ...]
    results: tuple[str, ...]
    limits: tuple[Limit, ...]
    scores: Array | None
    sampling: Sampling
    solve: Solver

    def solved(self, samples: Array) -> Table:
        """Return the table of results, with a case for every sample."""
        errors = [f"error.{name}" for name in self.results if f"error.{name}" in SCALARS]
        columns = tuple(np.ascontiguousarray(column) for column in samples.T)
        axis = Axis(self.paths, tuple(unit or "1" for unit in self.units), columns)
        title = str(self.case.get("title", ""))
        return self.solve(Study(title, self.case, (axis,), (*self.results, *errors)))


def tolerance(
    case: Mapping[str, Any],
    parameters: Sequence[Varied],
    *,
    results: Sequence[str] = (),
    limits: Sequence[Limit] = (),
    correlations: Sequence[Correlation] = (),
    sampling: Sampling | None = None,
    solve: Solver | None = None,
) -> Tolerance:
    """Compute how results scatter where parameters do, and how often specifications are met.

    Parameters
    ----------
    case : tree of a case file; it is not changed.
    parameters : paths with their distributions, 1 to 20.
    results : names of results, such as ``nip_width``; those of the limits are included anyway.
    limits : the specifications, such as ``AtLeast("nip_width", "7 mm")``.
    correlations : between parameters; none: they are independent.
    sampling : number of samples, intervals; ``Sampling()`` by default.
    solve : solves a study; by default `rollnip.sweeps.sweep` in this process. For several processes
        use ``functools.partial(sweep, workers=8)``; with ``database="tolerance.db"`` an interrupted
        run can be continued.

    Raises
    ------
    InvalidInputError
        for unknown paths or results, distributions that cannot be read, inconsistent correlations,
        or where fewer than 20 samples could be solved.
    """
    question = _question(
        case,
        parameters,
        (results, limits, correlations),
        Sampling() if sampling is None else sampling,
        partial(sweep, workers=1) if solve is None else solve,
    )
    plan = question.sampling
    samples = hypercube(question.distributions, plan.count, question.scores, plan.seed)
    # one study, so that one database holds it all
    whole = question.solved(np.concatenate([samples, _mixed(question)]))
    table, mixed = _rows(whole, slice(plan.count)), _rows(whole, slice(plan.count, None))
    is_solved = np.asarray(table["converged"]) == 1.0
    for name in question.results:
        is_solved &= np.isfinite(table[name])
    failures = _failures(question, samples, table, is_solved)
    if is_solved.sum() < FEWEST:
        raise InvalidInputError(
            f"only {int(is_solved.sum())} of {plan.count} samples could be solved, at least "
            f"{FEWEST} must be" + (f"; one of them: {failures[0][1]}" if failures else ".")
        )
    sobol, notes = _sobol(question, mixed)
    scatters = tuple(
        _scatter(question, name, samples[is_solved], table[name][is_solved], sobol.get(name))
        for name in question.results
    )
    return Tolerance(
        scatters=scatters,
        chances=tuple(_chance(question, table, is_solved, (one,)) for one in question.limits),
        together=_chance(question, table, is_solved, question.limits) if question.limits else None,
        paths=question.paths,
        units=question.units,
        samples=tuple(tuple(map(float, row)) for row in samples[is_solved]),
        count=plan.count,
        confidence=plan.confidence,
        seed=plan.seed,
        failures=failures,
        notes=(*notes, *_notes(question, scatters, failures)),
    )


def _question(
    case: Mapping[str, Any],
    parameters: Sequence[Varied],
    wanted: tuple[Sequence[str], Sequence[Limit], Sequence[Correlation]],
    sampling: Sampling,
    solve: Solver,
) -> _ToleranceQuestion:
    results, limits, correlations = wanted
    if not 1 <= len(parameters) <= _MOST_PARAMETERS:
        raise InvalidInputError(
            f"`parameters` must hold 1 to {_MOST_PARAMETERS} parameters, got {len(parameters)}."
        )
    for name in results:
        require_quantity(name, "results")
    names = tuple(dict.fromkeys([*results, *(limit.quantity for limit in limits)]))
    if not names:
        raise InvalidInputError("`results` must name at least one result, or limits do.")
    require_consistent(tuple(limits))
    paths = tuple(one.path for one in parameters)
    twice = next((path for path in paths if paths.count(path) > 1), None)
    if twice is not None:
        raise InvalidInputError(f"`parameters` must not name {twice} twice.")
    kinds = [parameter_dimension(case, path) for path in paths]
    drawn = []
    for one, kind in zip(parameters, kinds, strict=True):
        try:
            drawn.append(frozen(one.distribution, kind))
        except InvalidInputError as error:
            raise InvalidInputError(f"{one.path}: {error}") from None
    scores = score_matrix(paths, correlations)
    if scores is not None and sampling.sobol:
        raise InvalidInputError(
            "`sobol` must be 0 where parameters are correlated: the shares would have no meaning."
        )
    units = tuple(base_unit(kind) for kind in kinds)
    return _ToleranceQuestion(
        case, paths, units, tuple(drawn), names, tuple(limits), scores, sampling, solve
    )


def _failures(
    question: _ToleranceQuestion, samples: Array, table: Table, is_solved: Any
) -> tuple[tuple[Mapping[str, float], str], ...]:
    found = []
    for row in np.flatnonzero(~is_solved):
        values = dict(zip(question.paths, map(float, samples[row]), strict=True))
        found.append((values, table["message"][row] or "A result is not defined there."))
    return tuple(found)


def _scatter(
    question: _ToleranceQuestion, name: str, samples: Array, values: Array, sobol: Any
) -> Scatter:
    plan = question.sampling
    plane = regression(samples, values)
    shares = tuple(
        Share(
            path=path,
            coefficient=float(plane.coefficients[index]),
            first=None if sobol is None else sobol.first_of(index),
            total=None if sobol is None else sobol.total_of(index),
        )
        for index, path in enumerate(question.paths)
    )
    return Scatter(
        quantity=name,
        unit=QUANTITIES[name],
        mean=float(values.mean()),
        deviation=float(values.std(ddof=1)),
        least=float(values.min()),
        most=float(values.max()),
        quantiles=tuple(
            quantile(values, probability, plan.confidence) for probability in plan.probabilities
        ),
        shares=shares,
        linear_share=plane.explained,
        values=tuple(map(float, values)),
    )


def quantile(values: Array, probability: float, confidence: float) -> Quantile:
    """Return a quantile, and the order statistics between which it lies with some confidence.

    The number of samples below the true quantile is binomial, whatever the distribution. An end is
    None where too few samples lie beyond it. For a Latin hypercube the interval is conservative.
    """
    ordered, count = np.sort(values), values.size
    tail = 0.5 * (1.0 - confidence)
    # P(x_(low) <= quantile) = P(at least `low` samples below), ranks counted from 1
    low = int(scipy.stats.binom.ppf(tail, count, probability))
    high = int(scipy.stats.binom.ppf(1.0 - tail, count, probability)) + 1
    return Quantile(
        probability=probability,
        value=float(np.quantile(values, probability)),
        low=float(ordered[low - 1]) if low >= 1 else None,
        high=float(ordered[high - 1]) if high <= count else None,
    )


def _chance(
    question: _ToleranceQuestion, table: Table, is_solved: Any, limits: tuple[Limit, ...]
) -> Chance:
    is_met = np.array(is_solved)
    is_near = np.zeros_like(is_met)
    for limit in limits:
        values, bound = table[limit.quantity], float(limit.limit)
        is_met &= values <= bound if isinstance(limit, AtMost) else values >= bound
        name = f"error.{limit.quantity}"
        if name in table.columns:
            is_near |= is_solved & (np.abs(values - bound) <= table[name])
    met, solved, count = int(is_met.sum()), int(is_solved.sum()), is_met.size
    level = question.sampling.confidence
    return Chance(
        limits=limits,
        text=" and ".join(limit_text(limit) for limit in limits),
        value=met / solved,
        low=float(scipy.stats.binomtest(met, count).proportion_ci(level).low),
        high=float(scipy.stats.binomtest(met + count - solved, count).proportion_ci(level).high),
        undecided=int(is_near.sum()),
    )


def _mixed(question: _ToleranceQuestion) -> Array:
    """Return the samples that Sobol indices need; empty where they are not wanted."""
    plan, dimensions = question.sampling, len(question.paths)
    if not plan.sobol:
        return np.empty((0, dimensions))
    return quantiles_at(question.distributions, sobol_places(plan.sobol, dimensions, plan.seed))


def _rows(table: Table, which: slice) -> Table:
    """Return a slice of the rows of a table."""
    columns = {name: column[which] for name, column in table.columns.items()}
    return replace(table, columns=columns)


def _sobol(question: _ToleranceQuestion, table: Table) -> tuple[dict[str, SobolIndices], list[str]]:
    plan = question.sampling
    if not plan.sobol:
        return {}, []
    is_solved = np.asarray(table["converged"]) == 1.0
    found, notes = {}, []
    for name in question.results:
        lost = int(np.sum(~(is_solved & np.isfinite(table[name]))))
        if lost:
            notes.append(
                f"No Sobol indices of {name}: they need every case, and {lost} of {len(table)} "
                "were not solved."
            )
            continue
        found[name] = sobol_shares(
            np.asarray(table[name]), plan.sobol, confidence=plan.confidence, seed=plan.seed
        )
    return found, notes


def _notes(
    question: _ToleranceQuestion, scatters: Sequence[Scatter], failures: Sequence[Any]
) -> list[str]:
    notes = []
    if failures:
        notes.append(
            f"{len(failures)} of {question.sampling.count} samples were not solved and are left "
            f"out, save in the intervals of the chances; the first: {failures[0][1]}"
        )
    bent = [one.quantity for one in scatters if one.linear_share < 0.9]
    if bent and not question.sampling.sobol:
        notes.append(
            f"The regression explains less than 90 % of the variance of {', '.join(bent)}: ask "
            "for Sobol indices."
        )
    if question.scores is not None:
        notes.append("Correlated parameters share their influence: squares do not add up to 1.")
    return notes
