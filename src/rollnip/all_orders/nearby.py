"""A solved nip, as initial guess for a similar one at finite strain.

The new contact is first solved with the old solution's correction of all orders held, and the
finite elements start from their old equilibrium. The iterations that follow end as any others do:
when the contact conditions are met with the correction of the solution itself.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import log

from rollnip.contact import NEAR_ENOUGH, Layout
from rollnip.finite import Equilibrium
from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.rolling.free_ends import is_verified, with_free_ends
from rollnip.rolling.mesh_solution import MeshSolution
from rollnip.rolling.start import half_width_guess
from rollnip.rolling.surfaces import PairKernels


@dataclass(frozen=True, slots=True)
class Nearby:
    """A nip with its solution in geometry "finite".

    Attributes
    ----------
    nip : the nip solved.
    kernels : its influence functions, holding the correction of the solution.
    final : the solution.
    """

    nip: Nip
    kernels: PairKernels
    final: MeshSolution

    @property
    def bodies(self) -> tuple[Equilibrium | None, Equilibrium | None]:
        """Equilibria of the upper and the lower roller."""
        held = self.kernels.held
        return (None, None) if held is None else held.bodies

    def first_contact(
        self, nip: Nip, model: Model, kernels: PairKernels, half_width: float
    ) -> tuple[PairKernels, MeshSolution] | None:
        """Return the contact of another nip with the correction of this one held.

        Returns
        -------
        The influence functions that hold the correction, and the solution; None where the nips are
        not alike enough, or no solution is found.
        """
        held, layout = self.kernels.held, Layout.of(self.final.zones, nip.friction)
        if held is None or held.share < 1.0 or layout is None:
            return None
        if not self._is_like(nip, half_width):
            return None
        kernels = replace(kernels, held=held)
        before = replace(self.final, mesh=self.final.mesh.holding(kernels), steps=0)
        found = with_free_ends(nip, model, kernels, layout, before, NEAR_ENOUGH)
        return (kernels, found) if is_verified(found, model) else None

    def _is_like(self, nip: Nip, half_width: float) -> bool:
        own = self.nip
        if _kind(own) != _kind(nip):
            return False
        return abs(log(half_width_guess(own, self.kernels) / half_width)) < NEAR_ENOUGH


def _kind(nip: Nip) -> tuple[object, ...]:
    """Return what similar nips must share: what is prescribed, and which rollers are rigid."""
    given = type(nip.normal), type(nip.tangential), nip.friction > 0.0
    return *given, nip.upper.is_rigid, nip.lower.is_rigid
