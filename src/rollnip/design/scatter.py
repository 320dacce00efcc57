"""Settings and answer of a tolerance computation: distributions, quantiles, chances, shares."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from rollnip._errors import InvalidInputError
from rollnip._frames import Column, Frame, Framed, numbers
from rollnip._html import html_table
from rollnip.design.aims import Limit
from rollnip.design.quantities import json_tree
from rollnip.design.sensitivity import require_sobol_count

FEWEST, MOST = 20, 1_000_000


@dataclass(frozen=True, slots=True, kw_only=True)
class Sampling:
    """The settings of a tolerance computation.

    Parameters
    ----------
    count : number of samples of the Latin hypercube, 20 to 1000000.
    sobol :
        0, or a power of two n from 8 on: Sobol indices as well, from n (d + 2) more cases with d
        parameters.
    probabilities : probabilities of the quantiles, each between 0 and 1.
    confidence : confidence level of all intervals.
    seed : seed of the random numbers; the same seed gives the same answer.

    Raises
    ------
    InvalidInputError
        where one is out of its range.
    """

    count: int = 200
    sobol: int = 0
    probabilities: tuple[float, ...] = (0.05, 0.5, 0.95)
    confidence: float = 0.95
    seed: int = 0

    def __post_init__(self) -> None:
        if not FEWEST <= self.count <= MOST:
            raise InvalidInputError(
                f"`count` must lie between {FEWEST} and {MOST}, got {self.count}."
            )
        if self.sobol:
            require_sobol_count(self.sobol)
        if not self.probabilities or not all(0.0 < one < 1.0 for one in self.probabilities):
            raise InvalidInputError(
                f"`probabilities` must lie between 0 and 1, got {list(self.probabilities)!r}."
            )
        if not 0.5 <= self.confidence < 1.0:
            raise InvalidInputError(
                f"`confidence` must lie from 0.5 to below 1, got {self.confidence!r}."
            )
        if self.seed < 0:
            raise InvalidInputError(f"`seed` must be zero or positive, got {self.seed}.")


@dataclass(frozen=True, slots=True, kw_only=True)
class Quantile:
    """A quantile of a result with its interval; an end is None where there are too few samples."""

    probability: float
    value: float
    low: float | None
    high: float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Share:
    """The influence of one parameter on the scatter of a result.

    Attributes
    ----------
    path : path of the parameter.
    coefficient : standardised regression coefficient; its sign is that of the influence.
    first, total : Sobol indices (value, low, high); None where they were not computed.
    """

    path: str
    coefficient: float
    first: tuple[float, float, float] | None
    total: tuple[float, float, float] | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Scatter:
    """The distribution of one result, in its base unit.

    Attributes
    ----------
    quantity, unit : the result.
    mean, deviation, least, most : mean, standard deviation and extremes of the samples.
    quantiles : with intervals from order statistics, valid for any distribution.
    shares : influence of each parameter.
    linear_share : share of the variance that the regression explains, R^2; below some 0.9 its
        coefficients do not describe the influence fully.
    values : (n,) of the solved samples.
    """

    quantity: str
    unit: str
    mean: float
    deviation: float
    least: float
    most: float
    quantiles: tuple[Quantile, ...]
    shares: tuple[Share, ...]
    linear_share: float
    values: tuple[float, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Chance:
    """The probability that a specification is met.

    Attributes
    ----------
    limits : the specification, one limit or several at once.
    text : the specification in words.
    value : share of the solved samples that meet it.
    low, high : its interval (Clopper & Pearson); a sample that was not solved counts as a miss in
        ``low`` and as met in ``high``.
    undecided : number of solved samples closer to the limit than the solver's estimated error.
    """

    limits: tuple[Limit, ...]
    text: str
    value: float
    low: float
    high: float
    undecided: int


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Tolerance(Framed):
    """The answer of `tolerance`.

    Attributes
    ----------
    scatters : a distribution for each result.
    chances : one for each specification.
    together : probability that all specifications are met at once; None without any.
    paths, units : the parameters.
    samples : (n, d) solved samples of the parameters, in base units.
    count, confidence, seed : as in the settings.
    failures : (values by path, message) of the samples that were not solved.
    notes : what limits the answer, in plain words.
    """

    scatters: tuple[Scatter, ...]
    chances: tuple[Chance, ...]
    together: Chance | None
    paths: tuple[str, ...]
    units: tuple[str, ...]
    samples: tuple[tuple[float, ...], ...]
    count: int
    confidence: float
    seed: int
    failures: tuple[tuple[Mapping[str, float], str], ...]
    notes: tuple[str, ...]

    def __repr__(self) -> str:
        found = ", ".join(
            f"{one.quantity} = {one.mean:.5g} ± {one.deviation:.3g} {one.unit}".rstrip()
            for one in self.scatters
        )
        return f"<Tolerance of {len(self.samples)} samples: {found}>"

    def _repr_html_(self) -> str:
        rows = [
            [one.quantity, one.unit, *(f"{x:.5g}" for x in (one.mean, one.deviation))]
            for one in self.scatters
        ]
        chances = [f"{one.text}: {100.0 * one.value:.1f} %" for one in self.chances]
        heads = ("result", "unit", "mean", "standard deviation")
        return html_table("Tolerance", heads, rows, [*chances, *self.notes])

    def _frame(self) -> Frame:
        """Return every solved sample: parameters and results."""
        columns: dict[str, Column] = {
            path: numbers(sample[i] for sample in self.samples) for i, path in enumerate(self.paths)
        }
        columns |= {one.quantity: numbers(one.values) for one in self.scatters}
        units = dict(zip(self.paths, self.units, strict=True))
        units |= {one.quantity: one.unit for one in self.scatters}
        return Frame(columns, units, {"seed": self.seed})

    def as_dict(self) -> dict[str, Any]:
        """Return all fields as plain values, for JSON."""
        found: dict[str, Any] = json_tree(asdict(self))
        return found
