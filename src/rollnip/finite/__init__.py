"""Finite strain of all orders by finite elements: a covering under given surface tractions.

`strip` is the mesh of a covering, `numbering` its unknowns in banded storage, `columns` where its
columns lie. `equilibrium` solves it by Newton's method under tractions that follow the surface
(`follower_load`, `nodal_tractions`); `memory` and `relaxing_stress` add viscoelastic stresses,
`state` holds states and tangents, whose systems `conjugate_residuals` solves where layers are
viscoelastic. `response` turns equilibria into the correction of the linear displacement that a
contact is solved with; `_spline` and `_low_pass` make it a smooth function of the place. `stress`
evaluates the fields inside, `power` the heat.
"""

from rollnip.finite._spline import Spline
from rollnip.finite.columns import error_of_long_columns
from rollnip.finite.equilibrium import Body
from rollnip.finite.follower_load import Tractions
from rollnip.finite.nodal_tractions import linear_between_nodes
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
    "error_of_long_columns",
    "linear_between_nodes",
    "linear_surface",
    "present_place",
]
