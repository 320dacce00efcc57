"""A solution between given ends of zones, as the search for zones keeps it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, Protocol, TypeVar

ZonesT = TypeVar("ZonesT")
ProblemT = TypeVar("ProblemT")
StateT = TypeVar("StateT")


class Terms(Protocol):
    """Terms that follow the solution."""

    @property
    def traction(self) -> float | None:
        """T_l that is asked for [N/mm]; None where none is."""
        ...


TermsT = TypeVar("TermsT", bound=Terms)


@dataclass(frozen=True)
class Attempt(Generic[ZonesT, ProblemT, StateT, TermsT]):
    """A solution between the ends of some zones, and how well these are placed.

    Attributes
    ----------
    zones : where it puts the zones.
    problem, state, lagged : the solved problem.
    change : last change of the lagged terms, relative.
    misplacement : how far ends were off, over the width.
    steps : linear systems solved so far.
    settled : whether zones and terms have settled.
    """

    zones: ZonesT
    problem: ProblemT
    state: StateT
    lagged: TermsT
    change: float
    misplacement: float
    steps: int
    settled: bool

    @property
    def wanted_traction(self) -> float | None:
        """T_l that is asked for [N/mm]; None where none is."""
        return self.lagged.traction
