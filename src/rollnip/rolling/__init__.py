"""The rolling contact of two rollers, from a nip to its figures and their claimed errors.

1. Influence functions of both rollers are tabulated (`surfaces.pair_kernels`), and the width of the
   contact is estimated from elliptic pressures (`start`).
2. Free, sticking and slipping zones are found node by node, on a coarse mesh that extends beyond
   the estimated contact (`refinement`; solvers in `rollnip.contact`).
3. The ends of these zones are then a free boundary: a mesh has nodes at them, the tractions beside
   each end tell where it should be, and the mesh follows. Once the ends are placed, the solution
   shows whether there are other zones (`placing`, `end_search`, `zone_search`). On each mesh, terms
   that depend on the solution are found by fixed-point iteration (`iterations`).
4. Meshes are refined until the estimated discretisation errors are below the tolerance
   (`free_ends`, `estimates`). If that fails, zones are found again from more nodes (`refinement`).
5. The contact conditions are evaluated between the nodes as well (`check`). Their residual and the
   estimated errors give the errors that the figures claim (`claimed_errors`).

In "finite" this contact is solved again and again, each time with another correction by finite
elements held fixed: see `rollnip.all_orders`.
"""

from rollnip.rolling.check import (
    PairFields,
    fields_at,
    surface_strain_in_nip,
)
from rollnip.rolling.claimed_errors import (
    claims,
    long_columns,
    model_shares,
    relative_claims,
    secondary_claims,
)
from rollnip.rolling.displacements import Displacements
from rollnip.rolling.kinematics import stretch_excess, surface_depths
from rollnip.rolling.mesh_solution import (
    Figures,
    IterationFailure,
    MeshSolution,
    peak_at,
    peak_pressure,
    peaks_alike,
)
from rollnip.rolling.power_balance import Powers, powers, rates_of
from rollnip.rolling.refinement import refine
from rollnip.rolling.rolling_contact import RollingContact
from rollnip.rolling.start import half_width_guess
from rollnip.rolling.surfaces import (
    PairKernels,
    hoop_curvature,
    pair_kernels,
)

__all__ = [
    "Displacements",
    "Figures",
    "IterationFailure",
    "MeshSolution",
    "PairFields",
    "PairKernels",
    "Powers",
    "RollingContact",
    "claims",
    "fields_at",
    "half_width_guess",
    "hoop_curvature",
    "long_columns",
    "model_shares",
    "pair_kernels",
    "peak_at",
    "peak_pressure",
    "peaks_alike",
    "powers",
    "rates_of",
    "refine",
    "relative_claims",
    "secondary_claims",
    "stretch_excess",
    "surface_depths",
    "surface_strain_in_nip",
]
