"""The contact patch in three dimensions: pressure, stick and slip of rollers of finite width."""

from rollnip.patch.coefficients import Grid
from rollnip.patch.covering_ends import covering_end
from rollnip.patch.depth import PatchStress
from rollnip.patch.durometer import Indentation, least_thickness, shore_a_reading
from rollnip.patch.ends import FaceEnd, face_end
from rollnip.patch.solution import PatchSolution
from rollnip.patch.solve import solve_patch
from rollnip.patches import PATCH_TOLERANCE, Across, Force, Patch

__all__ = [
    "PATCH_TOLERANCE",
    "Across",
    "FaceEnd",
    "Force",
    "Grid",
    "Indentation",
    "Patch",
    "PatchSolution",
    "PatchStress",
    "covering_end",
    "face_end",
    "least_thickness",
    "shore_a_reading",
    "solve_patch",
]
