"""The rolling contact of two rollers: assembly, rounds of refinement, the check afterwards."""

from rollnip.rolling.assemble import (
    Displacements,
    PairKernels,
    hoop_curvature,
    pair_kernels,
    pressure_work,
)
from rollnip.rolling.check import (
    Fields,
    fields_at,
    fields_on_mesh,
    fine_points,
    slip_velocity,
    surface_strain,
)
from rollnip.rolling.refinement import refine
from rollnip.rolling.round import Figures, Round, creepage_scale, excess, has_grip, peak_pressure
from rollnip.rolling.start import half_width_guess

__all__ = [
    "Displacements",
    "Fields",
    "Figures",
    "PairKernels",
    "Round",
    "creepage_scale",
    "excess",
    "fields_at",
    "fields_on_mesh",
    "fine_points",
    "half_width_guess",
    "has_grip",
    "hoop_curvature",
    "pair_kernels",
    "peak_pressure",
    "pressure_work",
    "refine",
    "slip_velocity",
    "surface_strain",
]
