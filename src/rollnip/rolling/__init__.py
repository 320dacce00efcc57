"""The rolling contact of two rollers, from a nip to its figures and what they claim.

1. Influence functions of both rollers are tabulated (`surfaces.pair_kernels`), and the width of the
   contact is guessed from elliptic pressures (`start`).
2. Where surfaces are free, stick or slip is found node by node on a coarse mesh that reaches beyond
   that contact (`refinement`; solvers in `rollnip.contact`).
3. These zones get nodes at their ends. The tractions beside each end tell where it should be, and
   it is moved there; a solution with placed ends tells whether its zones are right (`placing`,
   `search`). On each mesh, terms that depend on the solution are found by iteration (`iterations`).
4. Meshes are refined until the estimated errors are below the tolerance (`free_ends`, `estimates`).
   Where they do not become so, zones are found again from more nodes (`refinement`).
5. The contact conditions are evaluated between the nodes, too (`check`). With the errors, that is
   what the figures claim (`claimed_errors`).

At finite strain a correction of all orders is held through steps 2 to 4 and evaluated again from
their solution, until both agree (`all_orders`, `contact_stages`, `corrections`).
"""

from rollnip.rolling.all_orders import refine_all_orders, with_second_order
from rollnip.rolling.assemble import stretch_excess, surface_depths
from rollnip.rolling.check import (
    PairFields,
    fields_at,
    surface_strain_in_nip,
)
from rollnip.rolling.claimed_errors import (
    claims,
    further_claims,
    model_shares,
    relative_claims,
)
from rollnip.rolling.displacements import Displacements
from rollnip.rolling.further import further_figures, further_sizes
from rollnip.rolling.nearby import Nearby
from rollnip.rolling.power_balance import Powers, powers, rates_of
from rollnip.rolling.refinement import refine
from rollnip.rolling.round import (
    Ended,
    Figures,
    Further,
    Round,
    creepage_scale,
    excess,
    has_grip,
    peak_at,
    peak_pressure,
    peaks_alike,
)
from rollnip.rolling.start import half_width_guess
from rollnip.rolling.surfaces import (
    PairKernels,
    hoop_curvature,
    pair_kernels,
)

__all__ = [
    "Displacements",
    "Ended",
    "Figures",
    "Further",
    "Nearby",
    "PairFields",
    "PairKernels",
    "Powers",
    "Round",
    "claims",
    "creepage_scale",
    "excess",
    "fields_at",
    "further_claims",
    "further_figures",
    "further_sizes",
    "half_width_guess",
    "has_grip",
    "hoop_curvature",
    "model_shares",
    "pair_kernels",
    "peak_at",
    "peak_pressure",
    "peaks_alike",
    "powers",
    "rates_of",
    "refine",
    "refine_all_orders",
    "relative_claims",
    "stretch_excess",
    "surface_depths",
    "surface_strain_in_nip",
    "with_second_order",
]
