"""The result of a fit as frozen data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rollnip._frames import Column, Frame, Framed, numbers
from rollnip._html import html_table
from rollnip._sealed import Sealed
from rollnip._units import format_quantity
from rollnip.identification.costs import Measurements
from rollnip.identification.loss import Loss
from rollnip.model import Model

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Estimate:
    """One fitted value, in base units.

    Attributes
    ----------
    path : path of the value in the case.
    value : the best fit.
    standard_error : from the covariance.
    low, high : interval from the covariance, in the scale of the search, cut off at the bounds.
    log : whether the search, and thus the interval, is on a logarithmic scale.
    profile : interval from the profile of the likelihood; None where none was computed.
    open_ends : whether the lower and the upper end of ``profile`` are only the bound.
    bounds : bounds of the search, lower and upper.
    bound : "low" or "high" where the best fit lies at that bound, else None.
    """

    path: str
    value: float
    standard_error: float
    low: float
    high: float
    profile: tuple[float, float] | None
    open_ends: tuple[bool, bool]
    bounds: tuple[float, float]
    bound: str | None
    log: bool = False

    @property
    def interval(self) -> tuple[float, float]:
        """The interval from the profile of the likelihood if there is one, or the covariance."""
        return (self.low, self.high) if self.profile is None else self.profile

    @property
    def is_told(self) -> bool:
        """Whether the data determine the value: its standard error is below its range."""
        return self.standard_error < self.bounds[1] - self.bounds[0]


@dataclass(frozen=True, slots=True, eq=False)
class FittedSet(Framed, Sealed):
    """One set of measurements beside its predictions.

    Attributes
    ----------
    name, quantity, unit : name of the set, measured quantity and its unit.
    against : path of the condition at which the values were measured, or ``x``.
    at, measured, predicted : (n,).
    standard_error : (n,) given or estimated.
    estimated : whether it was estimated.
    weight : weight of the set.
    prediction_error : (n,) standard error of each prediction, from those of the unknowns.
    """

    name: str
    quantity: str
    unit: str
    against: str
    at: Array
    measured: Array
    predicted: Array
    standard_error: Array
    estimated: bool
    weight: float
    prediction_error: Array

    @classmethod
    def of(
        cls, part: Measurements, predicted: Array, error: Array, estimated: bool, band: Array
    ) -> FittedSet:
        """Return the set ``part`` with its predictions, standard errors and prediction errors."""
        against, at = part.abscissa
        return cls(
            part.name,
            part.quantity,
            part.unit,
            against,
            at,
            part.values,
            predicted,
            error,
            estimated,
            part.weight,
            band,
        )

    def _frame(self) -> Frame:
        """Return a row for each measurement, beside its prediction."""
        columns: dict[str, Column] = {
            self.against: self.at,
            "measured": self.measured,
            "predicted": self.predicted,
            "standard_error": self.standard_error,
            "prediction_error": self.prediction_error,
        }
        units = dict.fromkeys(list(columns)[1:], self.unit)
        return Frame(columns, units, {"name": self.name, "quantity": self.quantity})

    @property
    def residuals(self) -> Array:
        """Measured minus predicted over the standard error, (n,)."""
        return np.asarray((self.measured - self.predicted) / self.standard_error)

    @property
    def rms(self) -> float:
        """Root mean square of measured minus predicted, in the unit of the set."""
        return float(np.sqrt(np.mean((self.measured - self.predicted) ** 2)))


@dataclass(frozen=True, slots=True)
class Start:
    """One search: where it began and ended (values by path), and its sum of squares."""

    begun: Mapping[str, float]
    ended: Mapping[str, float]
    cost: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Fit(Framed, Sealed):
    """A fit of unknown values to measurements.

    Attributes
    ----------
    estimates : the values with their intervals, in the order of the unknowns.
    correlation : (p, p) of their errors.
    singular_values : (p,) of the Jacobian scaled with the bounds, largest first.
    sets : measurements beside predictions.
    chi_square : sum of squared residuals over squared standard errors, without weights.
    degrees : degrees of freedom.
    probability : probability of a chi-square this large or larger; None where standard errors were
        estimated.
    widened : factor on the intervals where chi-square is improbably large, else 1.
    confidence : confidence level of the intervals.
    quantile : standard errors from a value to the end of its interval.
    loss : function of the deviations, "squares" or "huber".
    spread : (p, p) covariance of the unknowns in the scale of the search: of the logarithm where
        that is logarithmic.
    starts : the searches, best first.
    warnings : what the fit does not determine or explain, in plain words.
    case : the tree of the case with the fitted values.
    units : base unit of each unknown by its path.
    model : geometry and tolerance of the solves; None where no nip was solved.
    solves : number of nips solved.
    verified : whether all nips at the fitted values were verified.
    """

    estimates: tuple[Estimate, ...]
    correlation: Array
    singular_values: Array
    sets: tuple[FittedSet, ...]
    chi_square: float
    degrees: float
    probability: float | None
    widened: float
    confidence: float
    quantile: float
    loss: Loss
    spread: Array
    starts: tuple[Start, ...]
    warnings: tuple[str, ...]
    case: Mapping[str, Any] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    model: Model | None = None
    solves: int = 0
    verified: bool = True

    @property
    def values(self) -> dict[str, float]:
        """The fitted values by path, in base units."""
        return {one.path: one.value for one in self.estimates}

    def __repr__(self) -> str:
        found = ", ".join(self._said(one) for one in self.estimates)
        return f"<Fit to {sum(one.measured.size for one in self.sets)} measurements: {found}>"

    def _repr_html_(self) -> str:
        level = f"{100.0 * self.confidence:g} %"
        rows = []
        for one in self.estimates:
            low, high = one.interval
            numbers = (one.value, one.standard_error, low, high)
            shown = [format_quantity(number, digits=4) for number in numbers]
            rows.append([one.path, self.units.get(one.path, ""), *shown])
        heads = ("unknown", "unit", "value", "std. error", f"{level} from", "to")
        return html_table("Fit", heads, rows, self.warnings)

    def _frame(self) -> Frame:
        """Return a row for each unknown: its value, standard error and interval.

        The interval is that of the profile if there is one.
        """
        ends = [one.interval for one in self.estimates]
        columns: dict[str, Column] = {
            "path": tuple(one.path for one in self.estimates),
            "unit": tuple(self.units.get(one.path, "") for one in self.estimates),
            "value": numbers(one.value for one in self.estimates),
            "standard_error": numbers(one.standard_error for one in self.estimates),
            "low": numbers(low for low, _ in ends),
            "high": numbers(high for _, high in ends),
        }
        about = {"confidence": self.confidence, "warnings": list(self.warnings)}
        return Frame(columns, {}, about | {"case": dict(self.case)})

    def _said(self, one: Estimate) -> str:
        value, error = (format_quantity(x, digits=4) for x in (one.value, one.standard_error))
        return f"{one.path} = {value} ± {error} {self.units.get(one.path, '')}".rstrip()

    def __getitem__(self, path: str) -> Estimate:
        """Return the estimate of one path."""
        return next(one for one in self.estimates if one.path == path)
