"""The contact patch in three dimensions: pressure, stick and slip of rollers bounded across."""

from rollnip.patch.coefficients import Grid
from rollnip.patch.depth import PatchStress
from rollnip.patch.solution import PatchSolution
from rollnip.patch.solve import solve_patch
from rollnip.patches import Across, Force, Patch

__all__ = ["Across", "Force", "Grid", "Patch", "PatchSolution", "PatchStress", "solve_patch"]
