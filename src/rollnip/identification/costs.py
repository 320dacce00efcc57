"""Measurements as costs: each states which nips it needs and predicts what is measured there."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rollnip._errors import InvalidInputError, require_positive
from rollnip.figures import FIGURES
from rollnip.rollers import Side
from rollnip.solution import Solution

Array = NDArray[np.float64]


class Cost(ABC):
    """A cost to minimise: one set of measurements or several; ``a + 2 * b`` is one, too."""

    @property
    @abstractmethod
    def parts(self) -> tuple[Measurements, ...]:
        """The sets of measurements."""

    def __add__(self, other: Cost) -> Total:
        """Return the sum of two costs, to be fitted together."""
        return Total(self.parts + other.parts)

    def __rmul__(self, factor: float) -> Total:
        """Return the cost with every weight multiplied by a factor."""
        require_positive("weight", factor)
        return Total(tuple(replace(one, weight=factor * one.weight) for one in self.parts))


@dataclass(frozen=True, slots=True)
class Total(Cost):
    """Several sets of measurements, fitted together."""

    sets: tuple[Measurements, ...]

    @property
    def parts(self) -> tuple[Measurements, ...]:
        """The sets of measurements."""
        return self.sets


@dataclass(frozen=True, eq=False, kw_only=True)
class Measurements(Cost):
    """A set of measurements of one kind.

    Parameters
    ----------
    at :
        values of the case, by path, at which the measurements were made: arrays of shape (n,), or
        single values that hold for the whole set, which may be texts with units.
    measured :
        (n,) measured values, in base units.
    standard_error :
        of each value, or of all; None where it is not known. It is then estimated from the scatter
        of the measurements about the fit.
    weight :
        factor on the squares of the set; 1 leaves the weighting to the standard errors.
    name :
        for reports; the kind by default.
    rows :
        (n,) where each value stands, for messages, such as "widths.csv line 3".

    Raises
    ------
    InvalidInputError
        where shapes do not fit together, or a value is not finite or not positive as required.
    """

    quantity: ClassVar[str]
    """What is measured, in words."""
    unit: ClassVar[str]
    """Its base unit."""
    needs_speed: ClassVar[bool] = False
    nuisances: ClassVar[int] = 0
    """Number of parameters fitted within the set, besides the unknowns."""
    along_face: ClassVar[bool] = False
    """Whether faces are solved for it instead of single nips."""

    at: Mapping[str, Any]
    measured: ArrayLike
    standard_error: ArrayLike | None = None
    weight: float = 1.0
    name: str = ""
    rows: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        measured = np.atleast_1d(np.asarray(self.measured, dtype=float))
        if measured.ndim != 1 or measured.size == 0 or not np.all(np.isfinite(measured)):
            raise InvalidInputError(
                f"`{self.quantity}` must be a list of finite numbers, got {self.measured!r}."
            )
        object.__setattr__(self, "measured", measured)
        object.__setattr__(self, "standard_error", self._checked_error(measured))
        require_positive("weight", self.weight)
        object.__setattr__(self, "at", {path: _condition(path, v) for path, v in self.at.items()})
        if not self.name:
            object.__setattr__(self, "name", self.quantity)
        self._check_conditions()

    @property
    def parts(self) -> tuple[Measurements, ...]:
        """The set itself, as the only part."""
        return (self,)

    @property
    def values(self) -> Array:
        """The measured values, (n,)."""
        return np.asarray(self.measured, dtype=float)

    @property
    def errors(self) -> Array | None:
        """The standard error of each value, (n,); None where they are not known."""
        return None if self.standard_error is None else np.asarray(self.standard_error, dtype=float)

    def with_values(self, measured: ArrayLike) -> Self:
        """Return the set with other measured values."""
        return replace(self, measured=measured)

    @property
    @abstractmethod
    def conditions(self) -> list[dict[str, Any]]:
        """The changes of the case, by path, for each nip that has to be solved."""

    @property
    @abstractmethod
    def abscissa(self) -> tuple[str, Array]:
        """The path (or ``x``) and the (n,) numbers against which the values are plotted."""

    @abstractmethod
    def predict(self, solutions: Sequence[Solution]) -> Array:
        """Return the predicted measurements (n,) from the solutions of ``conditions``."""

    def _check_conditions(self) -> None:
        """Raise where an array of conditions has not the length of the values."""
        for path, value in self.at.items():
            if isinstance(value, np.ndarray) and value.shape != self.values.shape:
                raise InvalidInputError(
                    f"`{path}` must hold one number for each of the {self.values.size} values of "
                    f"the {self.quantity}, got {value.size}."
                )

    def _checked_error(self, measured: Array) -> Array | None:
        if self.standard_error is None:
            return None
        given = np.asarray(self.standard_error, dtype=float)
        if given.shape not in ((), measured.shape):
            raise InvalidInputError(
                f"`standard_error` must be one number or one for each of the {measured.size} "
                f"values, got {given.size}."
            )
        errors = np.broadcast_to(given, measured.shape).astype(float)
        if not np.all((errors > 0.0) & np.isfinite(errors)):
            raise InvalidInputError(
                f"`standard_error` must be positive and finite, got {np.min(errors):g}."
            )
        return errors


@dataclass(frozen=True, eq=False, kw_only=True)
class Scalars(Measurements):
    """Measurements of one number of the result, one nip for each; see the kinds below."""

    result: ClassVar[str]

    @property
    def conditions(self) -> list[dict[str, Any]]:
        """The changes of the case for each value: one nip each."""
        return [
            {path: entry_of(value, index) for path, value in self.at.items()}
            for index in range(self.values.size)
        ]

    @property
    def abscissa(self) -> tuple[str, Array]:
        """The first condition that varies, or else the number of the measurement."""
        for path, value in self.at.items():
            if isinstance(value, np.ndarray) and np.ptp(value) > 0.0:
                return path, value
        return "measurement", np.arange(1.0, self.values.size + 1.0)

    def predict(self, solutions: Sequence[Solution]) -> Array:
        """Return the number from each solution; nan where it is not defined."""
        found = [getattr(solution, self._result) for solution in solutions]
        return np.array([np.nan if one is None else one for one in found], dtype=float)

    @property
    def _result(self) -> str:
        return self.result


def _figure(key: str) -> tuple[str, str, str]:
    """Return label, unit and attribute of a figure of the registry."""
    figure = FIGURES[key]
    return figure.label, figure.unit.removeprefix("1"), figure.name


class NipWidths(Scalars):
    """Nip widths [mm], usually at line loads: ``at={"nip.load": [...]}``."""

    quantity, unit, result = _figure("nip_width")


class Approaches(Scalars):
    """Approaches of the axles [mm], usually at line loads."""

    quantity, unit, result = _figure("approach")


class Loads(Scalars):
    """Line loads [N/mm], usually at approaches: ``at={"nip.approach": [...]}``."""

    quantity, unit, result = _figure("load")


class PeakPressures(Scalars):
    """Peak pressures [MPa], usually at line loads."""

    quantity, unit, result = _figure("peak_pressure")


class Creepages(Scalars):
    """Creepages, usually at tractions: ``at={"nip.traction": [...]}``."""

    quantity, unit, result = _figure("creepage")


class RollingResistances(Scalars):
    """Rolling-resistance coefficients, usually at speeds: ``at={"nip.speed": [...]}``."""

    quantity, unit, result = _figure("rolling_resistance")


@dataclass(frozen=True, eq=False, kw_only=True)
class _OfOneRoller(Scalars):
    """A figure that each roller has."""

    roller: Side = "upper"

    def __post_init__(self) -> None:
        check_roller(self.roller)
        super().__post_init__()

    @property
    def _result(self) -> str:
        return f"{self.result}_{self.roller}"


@dataclass(frozen=True, eq=False, kw_only=True)
class Torques(_OfOneRoller):
    """Driving torques per length [N] on the axle of one roller, usually at speeds.

    Parameters
    ----------
    roller :
        "upper" or "lower".
    at, measured, standard_error, weight, name :
        see `Measurements`.
    """

    quantity, unit, result = "torque", "N", "torque"


@dataclass(frozen=True, eq=False, kw_only=True)
class Feeds(_OfOneRoller):
    """Feeds of a sheet over one roller, usually at loads or tensions.

    A feed is the length of sheet, free of tension, over the length rolled off by the roller, minus
    1: ``at={"sheet.tension_in": [...]}``.

    Parameters
    ----------
    roller :
        "upper" or "lower".
    at, measured, standard_error, weight, name :
        see `Measurements`.
    """

    quantity, unit, result = "feed", "", "feed"

    def predict(self, solutions: Sequence[Solution]) -> Array:
        """Return the feed of each solution; nan where there is no sheet."""
        sheets = [solution.sheet for solution in solutions]
        found = [None if one is None else getattr(one, self._result) for one in sheets]
        return np.array([np.nan if one is None else one for one in found], dtype=float)


def check_roller(roller: str) -> None:
    """Raise InvalidInputError unless ``roller`` is "upper" or "lower"."""
    if roller not in ("upper", "lower"):
        raise InvalidInputError(f'`roller` must be "upper" or "lower", got {roller!r}.')


def _condition(path: str, value: Any) -> Array | float | str:
    if isinstance(value, str):
        return value
    try:
        numbers = np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        numbers = np.array([np.nan])
    if numbers.ndim > 1 or not np.all(np.isfinite(numbers)):
        raise InvalidInputError(
            f"`{path}` must be a finite number or a list of them, got {value!r}."
        )
    return numbers if numbers.ndim else float(numbers)


def entry_of(value: Any, index: int) -> Any:
    """Return the condition of one measurement: its own, or that of the whole set."""
    return float(value[index]) if isinstance(value, np.ndarray) else value
