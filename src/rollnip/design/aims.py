"""Aims of a design: a result to minimise or maximise, and limits that results must keep."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Literal

from rollnip._errors import InvalidInputError, require_finite
from rollnip._units import format_quantity
from rollnip.design.quantities import QUANTITIES, read_result, require_quantity

_DIGITS = 5
_LARGEST_STEP = 0.2  # largest relative step of the number on which a result is to depend little
_ACTIVE = 1e-3  # relative distance from a limit, below which the limit is active


@dataclass(frozen=True, slots=True)
class _Extreme:
    """A result of a case that is to be as small or as large as possible."""

    sense: ClassVar[Literal["minimise", "maximise"]]

    quantity: str

    def __post_init__(self) -> None:
        require_quantity(self.quantity, self.sense)

    @property
    def key(self) -> str:
        """Key of the objective in the results of a case."""
        return self.quantity

    @property
    def solves(self) -> int:
        """Number of solves for one case."""
        return 1


class Minimise(_Extreme):
    """The result that is to be as small as possible."""

    __slots__ = ()
    sense = "minimise"


class Maximise(_Extreme):
    """The result that is to be as large as possible."""

    __slots__ = ()
    sense = "maximise"


@dataclass(frozen=True, slots=True)
class LeastChange:
    """The result that is to depend as little as possible on one number of the case.

    The objective is the magnitude of the change of the result when that number grows by 1 %, by a
    central difference: each case is solved with three values of the number.

    Parameters
    ----------
    quantity : the result.
    against : path of the number in the case; it must not be zero there.
    share : relative step of the difference, positive and at most 0.2.
    """

    sense: ClassVar[Literal["minimise"]] = "minimise"

    quantity: str
    against: str
    share: float = 0.05

    def __post_init__(self) -> None:
        require_quantity(self.quantity, "least_change")
        if not 0.0 < require_finite("share", self.share) <= _LARGEST_STEP:
            raise InvalidInputError(
                f"`share` must be positive and at most {_LARGEST_STEP}, got {self.share!r}."
            )

    @property
    def key(self) -> str:
        """Key of the objective in the results of a case."""
        return f"change of {self.quantity} for 1 % of {self.against}"

    @property
    def solves(self) -> int:
        """Number of solves for one case."""
        return 3

    def change(self, less: float, more: float) -> float:
        """Return the objective from the results at both ends of the step."""
        return 0.01 * abs(more - less) / (2.0 * self.share)


@dataclass(frozen=True, slots=True)
class _Bound:
    """A limit on a result: a number in base units, or a text with its unit.

    ``tolerance`` is the share of the limit (of 1 where it is 0) by which it may be exceeded.
    """

    sense: ClassVar[Literal["at least", "at most"]]

    quantity: str
    limit: float | str
    tolerance: float = 0.0

    def __post_init__(self) -> None:
        require_quantity(self.quantity, "result")
        _require_tolerance(self.tolerance)
        key = self.sense.replace(" ", "_")
        object.__setattr__(self, "limit", read_result(key, self.limit, self.quantity))


class AtLeast(_Bound):
    """A lower limit on a result: a number in base units, or a text with its unit.

    ``tolerance`` is the share of the limit (of 1 where it is 0) by which it may be exceeded.
    """

    __slots__ = ()
    sense = "at least"


class AtMost(_Bound):
    """An upper limit on a result: a number in base units, or a text with its unit.

    ``tolerance`` is the share of the limit (of 1 where it is 0) by which it may be exceeded.
    """

    __slots__ = ()
    sense = "at most"


Objective = Minimise | Maximise | LeastChange
Limit = AtLeast | AtMost


@dataclass(frozen=True, slots=True, kw_only=True)
class LimitKept:
    """The state of one limit in a solved case.

    Attributes
    ----------
    quantity, unit : the result.
    sense : "at least" or "at most".
    limit, value, error : in that unit; the error is the solver's estimate, None without one.
    is_kept : whether the value keeps the limit, within its tolerance.
    is_active : whether the value is at the limit, within a share of 1e-3, so that the limit
        decides.
    """

    quantity: str
    unit: str
    sense: Literal["at least", "at most"]
    limit: float
    value: float
    error: float | None
    is_kept: bool
    is_active: bool


def limit_text(limit: Limit) -> str:
    """Return a limit in words, such as "nip_width at least 8.0000 mm"."""
    bound = format_quantity(float(limit.limit), QUANTITIES[limit.quantity], digits=_DIGITS)
    return f"{limit.quantity} {limit.sense} {bound}"


def excess_over(limit: Limit, value: float) -> float:
    """Return how far a value exceeds a limit and its tolerance, over the limit; <= 0: kept.

    Where the limit is 0, the excess is not divided.
    """
    bound = float(limit.limit)
    beyond = value - bound if isinstance(limit, AtMost) else bound - value
    return beyond / (abs(bound) or 1.0) - limit.tolerance


def standing(limit: Limit, row: Mapping[str, Any], error: float | None) -> LimitKept:
    """Return the state of a limit in a solved case."""
    value = float(row[limit.quantity])
    excess = excess_over(limit, value)
    return LimitKept(
        quantity=limit.quantity,
        unit=QUANTITIES[limit.quantity],
        sense=limit.sense,
        limit=float(limit.limit),
        value=value,
        error=error,
        is_kept=excess <= 0.0,
        is_active=abs(excess) <= max(_ACTIVE, 2.0 * limit.tolerance),
    )


def _require_tolerance(value: float) -> None:
    if not 0.0 <= value < 1.0:
        raise InvalidInputError(f"`tolerance` must lie from 0 to below 1, got {value!r}.")


def require_consistent(limits: tuple[Limit, ...]) -> None:
    """Raise InvalidInputError where two limits on one result leave no range between them."""
    for low in (one for one in limits if isinstance(one, AtLeast)):
        for high in (one for one in limits if isinstance(one, AtMost)):
            if low.quantity != high.quantity:
                continue
            if low.limit == high.limit and low.tolerance == high.tolerance == 0.0:
                raise InvalidInputError(
                    f"`tolerance` must be given where a result is to have one value, got "
                    f"{limit_text(low)} and at most the same; no result is exact to the last digit."
                )
            if float(low.limit) > float(high.limit):
                raise InvalidInputError(
                    f"`at_least` must not be above `at_most`, got {limit_text(low)} and "
                    f"{limit_text(high)}."
                )
