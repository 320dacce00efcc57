"""The rolling contact of two rollers: assembly, rounds of refinement, the check afterwards."""

from rollnip.rolling.assemble import stretch_excess, surface_depths
from rollnip.rolling.check import (
    Fields,
    fields_at,
    fine_points,
    slip_velocity,
    surface_strain,
    surface_strain_in_nip,
)
from rollnip.rolling.impossible import MOST_PRESSED_IN, impossible
from rollnip.rolling.powers import Powers, powers
from rollnip.rolling.records import DeformedSurfaces, Profiles, SolverInfo, Zone
from rollnip.rolling.refinement import refine
from rollnip.rolling.round import Figures, Round, creepage_scale, excess, has_grip, peak_pressure
from rollnip.rolling.start import half_width_guess
from rollnip.rolling.surfaces import (
    Displacements,
    PairKernels,
    hoop_curvature,
    pair_kernels,
    with_second_order,
)

__all__ = [
    "MOST_PRESSED_IN",
    "DeformedSurfaces",
    "Displacements",
    "Fields",
    "Figures",
    "PairKernels",
    "Powers",
    "Profiles",
    "Round",
    "SolverInfo",
    "Zone",
    "creepage_scale",
    "excess",
    "fields_at",
    "fine_points",
    "half_width_guess",
    "has_grip",
    "hoop_curvature",
    "impossible",
    "pair_kernels",
    "peak_pressure",
    "powers",
    "refine",
    "slip_velocity",
    "stretch_excess",
    "surface_depths",
    "surface_strain",
    "surface_strain_in_nip",
    "with_second_order",
]
