"""A figure to verify: its expected value, the source of that, its tolerance with the reason."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from math import inf, isfinite, nan
from typing import Any, NamedTuple

from rollnip._errors import RollnipError
from rollnip.solution import Solution
from rollnip.verification.sources import Source


class AllowedError(NamedTuple):
    """Relative error that is allowed, and the reason for its size."""

    value: float
    reason: str


SOLVER = AllowedError(
    3e-3,
    "default settings: the solver estimates its error below 0.1 % and may under-claim threefold",
)
ROUNDING = AllowedError(1e-9, "both sides are exact but for rounding")


@dataclass(frozen=True, slots=True, kw_only=True)
class VerificationCase:
    """A figure to verify, with its source and its tolerance.

    Attributes
    ----------
    name :
        the problem; figures of one problem share it.
    source :
        where the expected figure comes from.
    quantity, unit :
        what it is; "" where it has no unit.
    expected :
        the figure.
    tolerance :
        largest |got - expected|/scale allowed.
    reason :
        why the tolerance is what it is.
    problem :
        computes what the figure is read from; figures that share the callable share its result.
    read :
        takes the figure from it.
    scale :
        what an error counts against; |expected| by default.
    """

    name: str
    source: Source
    quantity: str
    unit: str
    expected: float
    tolerance: float
    reason: str
    problem: Callable[[], Any]
    read: Callable[[Any], float]
    scale: float

    def compute(self) -> float:
        """Compute the figure."""
        return float(self.read(self.problem()))


@dataclass(frozen=True, slots=True)
class Experiment:
    """A problem that several figures are read from.

    Attributes
    ----------
    name, source :
        of its figures.
    problem :
        computes what they are read from.
    """

    name: str
    source: Source
    problem: Callable[[], Any]

    def figure(
        self,
        quantity: str,
        unit: str,
        expected: float,
        read: Callable[[Any], float],
        tolerance: AllowedError = SOLVER,
        *,
        scale: float | None = None,
    ) -> VerificationCase:
        """Figure of this problem; ``scale`` is |expected| by default."""
        return VerificationCase(
            name=self.name,
            source=self.source,
            quantity=quantity,
            unit=unit,
            expected=expected,
            tolerance=tolerance.value,
            reason=tolerance.reason,
            problem=self.problem,
            read=read,
            scale=abs(expected) if scale is None else scale,
        )


@dataclass(frozen=True, slots=True)
class VerificationResult:
    """The outcome of one verification case.

    Attributes
    ----------
    case : the figure.
    got : the figure computed; nan where it could not be.
    geometry : of the nips that were solved for it, as their solutions say; "" where none was.
    message : why it could not be computed; "" otherwise.
    """

    case: VerificationCase
    got: float
    geometry: str = ""
    message: str = ""

    @property
    def error(self) -> float:
        """|got - expected|/scale; inf where nothing was computed."""
        if not isfinite(self.got):
            return inf
        return float(abs(self.got - self.case.expected) / self.case.scale)

    @property
    def passed(self) -> bool:
        """Return whether the error is within the tolerance."""
        return bool(self.error <= self.case.tolerance)


def verify(cases: Iterable[VerificationCase]) -> Iterator[VerificationResult]:
    """Compute figures one after the other; each problem is solved once.

    A figure that cannot be computed is a failure with its message, not an exception.
    """
    solved: dict[Callable[[], Any], Any] = {}
    for case in cases:
        try:
            if case.problem not in solved:
                solved[case.problem] = case.problem()
            result = solved[case.problem]
            yield VerificationResult(case, float(case.read(result)), _geometry(result))
        except (RollnipError, ArithmeticError, LookupError, TypeError, ValueError) as error:
            yield VerificationResult(case, nan, message=f"{type(error).__name__}: {error}")


def _geometry(result: object) -> str:
    """Return the geometry of a solution, or of several; "" where a result holds none."""
    parts = result if isinstance(result, tuple) else (result,)
    found = {part.model.geometry for part in parts if isinstance(part, Solution)}
    return " and ".join(sorted(found))
