"""The iterate of a search for zones: a solution for given zones, and the protocols it relies on."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Generic, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import ContactState
from rollnip.nip import Nip
from rollnip.rolling import Displacements, PairKernels
from rollnip.rolling.displacements import NO_SECOND_ORDER
from rollnip.rolling.surfaces import Mesh
from rollnip.sheet.zones import SideZones

Array = NDArray[np.float64]


class InterfaceProblem(Protocol):
    """A discrete problem with one mesh per interface, the upper one first."""

    @property
    def nip(self) -> Nip:
        """The nip with its sheet."""
        ...

    @property
    def meshes(self) -> tuple[Mesh, Mesh]:
        """The meshes of both interfaces."""
        ...

    @property
    def frictions(self) -> tuple[float, float]:
        """The friction coefficients of both interfaces."""
        ...

    @property
    def curvatures(self) -> tuple[float, float]:
        """The curvatures of the gaps that both interfaces close [1/mm]."""
        ...

    def creeps(self, state: Any, lagged: Any) -> tuple[Array, Array]:
        """Return the creep of both interfaces over each interval, each (n,) [mm]."""
        ...

    def shear_forces(self, state: Any, side: int) -> Array:
        """Return int q ds over all intervals but the last of one interface, (n - 1,) [N/mm]."""
        ...

    def displacements(self, state: Any, side: int, /) -> Displacements:
        """Return displacements at nodes[1:] of one interface, at least those of its own roller."""
        ...


class InterfaceSolution(Protocol):
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
        """Return one interface as a contact state of its own."""
        ...


class SheetTerms(Protocol):
    """Lagged terms of a sheet, of a membrane or a plate: they follow from the last solution."""

    @property
    def traction(self) -> float | None:
        """Prescribed T_l [N/mm]; None where none is prescribed."""
        ...

    @property
    def lean(self) -> float:
        """Part of the line load that is carried by the shears instead of the pressure [N/mm]."""
        ...

    def of_side(self, number: int) -> tuple[Array, Array]:
        """Return the terms of the gap and of the creep of one interface, each (n,) [mm]."""
        ...


ZonesT = TypeVar("ZonesT", bound=SideZones, covariant=True)
ProblemT = TypeVar("ProblemT", bound=InterfaceProblem, covariant=True)
StateT = TypeVar("StateT", bound=InterfaceSolution, covariant=True)
TermsT = TypeVar("TermsT", bound=SheetTerms, covariant=True)


@dataclass(frozen=True)
class SheetIterate(Generic[ZonesT, ProblemT, StateT, TermsT]):
    """A solution for given zones of stick and slip, and how well the ends of these are placed.

    Attributes
    ----------
    zones : with the ends where this solution puts them.
    problem, state, lagged : the solved problem.
    change : last relative change of the lagged terms.
    misplacement : error of the zone ends over the width.
    steps : number of linear systems solved so far.
    settled : whether zones and lagged terms have converged.
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
        """Prescribed T_l [N/mm]; None where none is prescribed."""
        return self.lagged.traction

    @cached_property
    def creeps(self) -> tuple[Array, Array]:
        """Return the creep of both interfaces over each interval, each (n,) [mm]."""
        return self.problem.creeps(self.state, self.lagged)


AnyIterate = SheetIterate[SideZones, InterfaceProblem, InterfaceSolution, SheetTerms]
"""The iterate of a membrane or of a plate."""


def kernels_after(before: AnyIterate | None, kernels: PairKernels, side: int = 0) -> PairKernels:
    """Return influence functions with one mesh's second-order terms of the previous solution.

    Those without second-order terms are returned unchanged.
    """
    if kernels.is_fixed:
        return kernels
    held = NO_SECOND_ORDER
    if before is not None:
        held = before.problem.meshes[side].second_fields(before.state.side(side))
    return replace(kernels, held=held)
