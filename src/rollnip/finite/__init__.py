"""Finite strain of all orders: equilibrium of a covering under given tractions."""

from rollnip.finite.energy import Energy, Gent, NeoHookean, Yeoh
from rollnip.finite.equilibrium import Body, NoEquilibriumError, State, Tractions, Volumetric
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
    "Energy",
    "FiniteResponse",
    "Gent",
    "NeoHookean",
    "NoEquilibriumError",
    "State",
    "Strip",
    "Tractions",
    "Volumetric",
    "Yeoh",
    "deformed_surface",
    "linear_surface",
    "nodal",
]
