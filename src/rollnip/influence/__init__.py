"""Influence functions: from compliances C(k) in the Fourier domain to displacements on a mesh."""

from rollnip.influence.cache import KernelCache
from rollnip.influence.ellipse import Ellipses
from rollnip.influence.grid import grid_displacements, grid_strains
from rollnip.influence.hats import (
    displacement_matrix,
    displacement_under,
    load_weights,
    strain_matrix,
)
from rollnip.influence.kernel import Kernel, Window, tabulate
from rollnip.influence.second import SecondResponse
from rollnip.influence.surface import (
    SurfaceKernels,
    covering_window,
    has_stiff_skin,
    is_ring,
    surface_compliance,
    surface_kernels,
)

__all__ = [
    "Ellipses",
    "Kernel",
    "KernelCache",
    "SecondResponse",
    "SurfaceKernels",
    "Window",
    "covering_window",
    "displacement_matrix",
    "displacement_under",
    "grid_displacements",
    "grid_strains",
    "has_stiff_skin",
    "is_ring",
    "load_weights",
    "strain_matrix",
    "surface_compliance",
    "surface_kernels",
    "tabulate",
]
