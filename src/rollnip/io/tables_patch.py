"""The tables of a case file in three dimensions: which keys there are and what each may hold."""

from __future__ import annotations

from typing import Literal

from pydantic import ConfigDict, Field

from rollnip.io.forms import FileTable, Force, Length, Radius, Ratio, Speed, TurnPerLength
from rollnip.io.tables import TABLES, LayerTable, Material, MaterialOrName, SolverTable


class PatchNipTable(FileTable):
    """Load or approach, creepages or forces, friction and speed."""

    load: Force | None = None
    approach: Length | None = None
    traction: Force | None = None
    creepage: Ratio | None = None
    lateral_traction: Force | None = None
    lateral_creepage: Ratio | None = None
    spin: TurnPerLength = 0.0
    friction: Ratio
    speed: Speed | None = None


class PatchRollerTable(FileTable):
    """A roller with its shape along the axis."""

    radius: Radius
    core: MaterialOrName = Field(
        "rigid", description="'rigid', or the material of a half-space below the layers."
    )
    layers: list[LayerTable] = Field(default=[])
    lateral_radius: Radius = Field(
        float("inf"), description="Radius of the crown along the axis; negative: hollow."
    )
    face: Length | None = Field(None, description="Length of the face along the axis.")
    end_radius: Length = Field(0.0, description="Radius that rounds both ends of the face.")
    lateral_profile: str | None = Field(
        None,
        description="CSV file with the columns x and height over the smooth surface, x along the "
        "axis from the middle of the face, in the folder of the case file.",
    )


class PatchTable(FileTable):
    """The contact is a patch in three dimensions."""

    grid: list[int] | None = Field(
        None, description="Numbers of rectangles along x and y; by default, what accuracy asks for."
    )


class PatchModelTable(FileTable):
    """The model of the geometry: a patch has flat layers and small strains."""

    geometry: Literal["linear"] | None = None


class PatchCaseTable(FileTable):
    """A whole case file in three dimensions. Units: mm, N, MPa, s, or those that a text carries."""

    model_config = ConfigDict(title="rollnip case file in three dimensions")

    title: str = ""
    nip: PatchNipTable
    patch: PatchTable
    model: PatchModelTable = PatchModelTable()
    solver: SolverTable = SolverTable()
    upper: PatchRollerTable
    lower: PatchRollerTable
    materials: dict[str, Material] = Field(default={})


PATCH_TABLES: dict[str, type[FileTable]] = TABLES | {
    "nip": PatchNipTable,
    "model": PatchModelTable,
    "patch": PatchTable,
    "upper": PatchRollerTable,
    "lower": PatchRollerTable,
}
