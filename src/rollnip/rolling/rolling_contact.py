"""The rolling contact to solve: a nip, the model it is solved in, how its rollers respond."""

from __future__ import annotations

from dataclasses import dataclass, replace

from rollnip.model import FINITE, Geometry, Model
from rollnip.nip import Nip, Torque
from rollnip.rolling.displacements import SecondFields
from rollnip.rolling.lengths import boundary_layer
from rollnip.rolling.surfaces import PairKernels


@dataclass(frozen=True, slots=True)
class RollingContact:
    """The rolling contact of two rollers that is to be solved.

    Attributes
    ----------
    nip : the rollers, and what is prescribed.
    model : geometry and tolerance.
    kernels : influence functions of both rollers, with the correction that they hold, if any.
    """

    nip: Nip
    model: Model
    kernels: PairKernels

    @property
    def geometry(self) -> Geometry:
        """The geometry model."""
        return self.model.geometry

    @property
    def tolerance(self) -> float:
        """The wanted relative accuracy of the figures."""
        return self.model.tolerance

    @property
    def has_finite_strain(self) -> bool:
        """Whether tractions and displacements refer to the deformed configuration."""
        return self.geometry in FINITE

    @property
    def has_no_lagged_terms(self) -> bool:
        """Whether no term of the contact conditions depends on the solution."""
        if isinstance(self.nip.tangential, Torque):
            return False
        is_curved = self.geometry == "curved"
        return self.geometry == "linear" or (is_curved and self.nip.friction == 0.0)

    def holding(self, correction: SecondFields) -> RollingContact:
        """Return the contact with displacements beyond the linear ones kept fixed."""
        return replace(self, kernels=replace(self.kernels, held=correction))

    def with_model(self, model: Model) -> RollingContact:
        """Return the contact to be solved in another model."""
        return replace(self, model=model)

    def shortest_zone(self, width: float) -> float:
        """Return the length of the shortest zone to search for in a contact of a width [mm].

        It is the tolerance times the width, or times the boundary layer if that is shorter. Unlike
        surfaces that stick up to an edge slip there over some length, however short, and next to it
        in the other direction over a shorter one. Edges move by a tenth of the length of a slip
        zone that is left out (decision 87).
        """
        return self.tolerance * min(width, boundary_layer(self.nip))
