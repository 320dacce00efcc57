"""Finite strain of all orders: equilibrium of a covering under given tractions."""

from rollnip.finite._spline import Spline
from rollnip.finite.acting import nodal
from rollnip.finite.equilibrium import Body
from rollnip.finite.pull import Tractions
from rollnip.finite.response import (
    CUT,
    DeformedSurface,
    Equilibrium,
    FiniteResponse,
    deformed_surface,
    linear_surface,
)
from rollnip.finite.state import MeshState, NoEquilibriumError
from rollnip.finite.stress import PARTS, element_fields, present_place
from rollnip.finite.strip import Depths, Strip

__all__ = [
    "CUT",
    "PARTS",
    "Body",
    "DeformedSurface",
    "Depths",
    "Equilibrium",
    "FiniteResponse",
    "MeshState",
    "NoEquilibriumError",
    "Spline",
    "Strip",
    "Tractions",
    "deformed_surface",
    "element_fields",
    "linear_surface",
    "nodal",
    "present_place",
]
