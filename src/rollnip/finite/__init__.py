"""Finite strain of all orders: equilibrium of a covering under given tractions."""

from rollnip.finite.equilibrium import Body, NoEquilibriumError, State, Tractions
from rollnip.finite.response import (
    DeformedSurface,
    FiniteResponse,
    deformed_surface,
    linear_surface,
    nodal,
)
from rollnip.finite.strip import Depths, Strip

__all__ = [
    "Body",
    "DeformedSurface",
    "Depths",
    "FiniteResponse",
    "NoEquilibriumError",
    "State",
    "Strip",
    "Tractions",
    "deformed_surface",
    "linear_surface",
    "nodal",
]
