"""Rolling contact of cylinders coated with layered, viscoelastic rubber.

Units: mm, N, MPa, s. Two rollers, upper and lower; x points to the leading edge (inlet);
traction and creepage are positive where the upper roller drives. Names are loaded when first
asked for, so that the command line starts without the numerics. So are the packages for studies
and pictures: `rn.plots.plot_overview(solution)` needs no further import.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from rollnip._errors import (
    CaseFileError,
    ConvergenceError,
    InvalidInputError,
    RollnipError,
    RollnipWarning,
)

if TYPE_CHECKING:
    from rollnip.cooling import (
        Coolant,
        Cooling,
        HeatBalance,
        Held,
        Insulated,
        PassingSheet,
        Shell,
    )
    from rollnip.face import solve_face
    from rollnip.feed import feed_sensitivity
    from rollnip.heat import follow_heat, solve_heat, warm_up
    from rollnip.identification import identify
    from rollnip.influence import KernelCache
    from rollnip.io import Case, read_case, write_result
    from rollnip.io.patch_case import read_patch_case
    from rollnip.materials import (
        WLF,
        Arrhenius,
        Elastic,
        FractionalZener,
        Gent,
        LossFactor,
        NeoHookean,
        Ogden,
        Prony,
        StandardLinearSolid,
        TabulatedShift,
        Thermal,
        Yeoh,
    )
    from rollnip.model import Model
    from rollnip.nip import Approach, Creepage, LineLoad, Nip, Torque, Traction
    from rollnip.patch import solve_patch
    from rollnip.patches import Across, Force, Patch
    from rollnip.rollers import Layer, Profile, Roller
    from rollnip.shafts import (
        CoveringTable,
        Crown,
        CrownTable,
        Face,
        JournalStep,
        PivotArm,
        Shaft,
    )
    from rollnip.sheets import Sheet
    from rollnip.solution import Solution
    from rollnip.solver import solve
    from rollnip.sweeps import sweep

    __version__: str

_HOMES = {
    "rollnip.identification": ("identify",),
    "rollnip.influence": ("KernelCache",),
    "rollnip.io": ("Case", "read_case", "write_result"),
    "rollnip.io.patch_case": ("read_patch_case",),
    "rollnip.materials": (
        "WLF",
        "Arrhenius",
        "Elastic",
        "FractionalZener",
        "Gent",
        "LossFactor",
        "NeoHookean",
        "Ogden",
        "Prony",
        "StandardLinearSolid",
        "TabulatedShift",
        "Thermal",
        "Yeoh",
    ),
    "rollnip.model": ("Model",),
    "rollnip.nip": ("Approach", "Creepage", "LineLoad", "Nip", "Torque", "Traction"),
    "rollnip.cooling": (
        "Coolant",
        "Cooling",
        "HeatBalance",
        "Held",
        "Insulated",
        "PassingSheet",
        "Shell",
    ),
    "rollnip.face": ("solve_face",),
    "rollnip.feed": ("feed_sensitivity",),
    "rollnip.patch": ("solve_patch",),
    "rollnip.patches": ("Across", "Force", "Patch"),
    "rollnip.heat": ("follow_heat", "solve_heat", "warm_up"),
    "rollnip.rollers": ("Layer", "Profile", "Roller"),
    "rollnip.shafts": (
        "CoveringTable",
        "Crown",
        "CrownTable",
        "Face",
        "JournalStep",
        "PivotArm",
        "Shaft",
    ),
    "rollnip.sheets": ("Sheet",),
    "rollnip.solution": ("Solution",),
    "rollnip.solver": ("solve",),
    "rollnip.sweeps": ("sweep",),
}
_PACKAGES = (
    "closed_forms",
    "design",
    "dma",
    "face",
    "heat",
    "identification",
    "interior",
    "io",
    "lda",
    "materials",
    "patch",
    "plots",
    "rubber",
    "sheet",
    "sweeps",
    "verification",
)
_HOME = {name: module for module, names in _HOMES.items() for name in names}

__all__ = [
    "WLF",
    "Across",
    "Approach",
    "Arrhenius",
    "Case",
    "CaseFileError",
    "ConvergenceError",
    "Coolant",
    "Cooling",
    "CoveringTable",
    "Creepage",
    "Crown",
    "CrownTable",
    "Elastic",
    "Face",
    "Force",
    "FractionalZener",
    "Gent",
    "HeatBalance",
    "Held",
    "Insulated",
    "InvalidInputError",
    "JournalStep",
    "KernelCache",
    "Layer",
    "LineLoad",
    "LossFactor",
    "Model",
    "NeoHookean",
    "Nip",
    "Ogden",
    "PassingSheet",
    "Patch",
    "PivotArm",
    "Profile",
    "Prony",
    "Roller",
    "RollnipError",
    "RollnipWarning",
    "Shaft",
    "Sheet",
    "Shell",
    "Solution",
    "StandardLinearSolid",
    "TabulatedShift",
    "Thermal",
    "Torque",
    "Traction",
    "Yeoh",
    "__version__",
    "feed_sensitivity",
    "follow_heat",
    "identify",
    "read_case",
    "read_patch_case",
    "solve",
    "solve_face",
    "solve_heat",
    "solve_patch",
    "sweep",
    "warm_up",
    "write_result",
]


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from importlib.metadata import version

        return version("rollnip")
    if name in _PACKAGES:
        return import_module(f"rollnip.{name}")
    if name not in _HOME:
        raise AttributeError(f"module 'rollnip' has no attribute {name!r}")
    value = getattr(import_module(_HOME[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*__all__, *_PACKAGES])
