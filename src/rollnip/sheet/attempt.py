"""A solution between given ends of zones, as searches for zones keep it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Generic, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import ContactState
from rollnip.nip import Nip
from rollnip.rolling import Displacements
from rollnip.rolling.surfaces import Mesh
from rollnip.sheet.zones import SideZones

Array = NDArray[np.float64]


class Interfaces(Protocol):
    """A problem on the meshes of both interfaces, the upper one first."""

    @property
    def nip(self) -> Nip:
        """The nip with its sheet."""
        ...

    @property
    def meshes(self) -> tuple[Mesh, Mesh]:
        """The mesh of either interface."""
        ...

    @property
    def frictions(self) -> tuple[float, float]:
        """Coefficients of either interface."""
        ...

    def creeps(self, state: Any, lagged: Any) -> tuple[Array, Array]:
        """Return the creep of either interface over each interval, each (n,) [mm]."""
        ...

    def sheared(self, state: Any, side: int) -> Array:
        """Return int q ds over the intervals of one interface but the last, (n - 1,) [N/mm]."""
        ...

    def displacements(self, state: Any, side: int, /) -> Displacements:
        """Return displacements at nodes[1:] of one interface, those of its roller at least."""
        ...


class Tractions(Protocol):
    """A solution of such a problem."""

    @property
    def approach(self) -> float:
        """Approach of the rollers [mm]."""
        ...

    @property
    def creepages(self) -> tuple[float, float]:
        """(V_u - V_s)/V and (V_s - V_l)/V."""
        ...

    def side(self, number: int) -> ContactState:
        """Return one interface as if it were all of the contact."""
        ...


class Terms(Protocol):
    """Terms that follow the solution."""

    @property
    def traction(self) -> float | None:
        """T_l that is asked for [N/mm]; None where none is."""
        ...

    @property
    def lean(self) -> float:
        """Line load that the shears take from the pressure [N/mm]."""
        ...


ZonesT = TypeVar("ZonesT", bound=SideZones, covariant=True)
ProblemT = TypeVar("ProblemT", bound=Interfaces, covariant=True)
StateT = TypeVar("StateT", bound=Tractions, covariant=True)
TermsT = TypeVar("TermsT", bound=Terms, covariant=True)


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

    @cached_property
    def creeps(self) -> tuple[Array, Array]:
        """Return the creep of either interface over each interval, each (n,) [mm]."""
        return self.problem.creeps(self.state, self.lagged)


AnyAttempt = Attempt[SideZones, Interfaces, Tractions, Terms]
"""A solution of a sheet of any kind."""
