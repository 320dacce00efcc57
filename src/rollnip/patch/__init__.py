"""The contact patch in three dimensions: pressure, stick and slip of rollers bounded across."""

from rollnip.patch.coefficients import Grid
from rollnip.patch.depth import PatchStress
from rollnip.patch.durometer import Indentation, shore_a_reading
from rollnip.patch.solution import PatchSolution
from rollnip.patch.solve import solve_patch
from rollnip.patches import Across, Force, Patch

__all__ = [
    "Across",
    "Force",
    "Grid",
    "Indentation",
    "Patch",
    "PatchSolution",
    "PatchStress",
    "shore_a_reading",
    "solve_patch",
]
