"""The tables of a case file about a face: which keys there are and what each may hold."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from rollnip.io.forms import (
    Angle,
    Density,
    FileTable,
    Force,
    Length,
    Pressure,
    Ratio,
)


class CrownTableTable(FileTable):
    """A crown on the diameter: a height and a shape, lists over y, or a file."""

    height: Length | None = None
    shape: Literal["parabolic", "cosine", "circular"] = "parabolic"
    y: list[Length] | None = Field(None, description="Places from the middle of the face.")
    diameter: list[Length] | None = Field(None, description="There, over the nominal one.")
    file: str | None = Field(
        None,
        description="CSV file with the columns y, from the middle of the face, and diameter over "
        "the nominal one.",
    )


class JournalStepTable(FileTable):
    """A part of a journal of one diameter."""

    diameter: Length
    length: Length | None = Field(None, description="Along the axis; none: on to the bearing.")


class CoveringTableTable(FileTable):
    """The covering over the face: lists over y, or a file."""

    y: list[Length] | None = Field(None, description="Places from the middle of the face.")
    thickness: list[Length] | None = Field(None, description="Of the outermost layer.")
    stiffness: list[Ratio] | None = Field(
        None, description="Modulus of the outermost layer over that of its material."
    )
    file: str | None = Field(
        None,
        description="CSV file with the column y and thickness, and one of stiffness, modulus, "
        "shore_a.",
    )


def _crown(value: Any) -> str:
    return "<crown>" if isinstance(value, dict) else "<height>"


class ShaftTable(FileTable):
    """The shaft that carries the core of a roller over its face."""

    bearing_distance: Length
    bearing_middle: Length = Field(
        0.0, description="Where the middle between the bearings lies, from that of the face."
    )
    bore: Length = 0.0
    journal_diameter: Length | None = None
    journals: list[JournalStepTable] = Field(
        [], description="Steps of both journals instead, from the face to the bearing."
    )
    modulus: Pressure | None = None
    poisson: Ratio = 0.3
    density: Density | None = None
    crown: (
        Annotated[
            Annotated[Length, Tag("<height>")] | Annotated[CrownTableTable, Tag("<crown>")],
            Discriminator(_crown),
        ]
        | None
    ) = Field(
        None, description="Height on the diameter, parabolic; or a table with height and shape."
    )
    profiles: list[CrownTableTable] = Field(
        [], description="Further changes of the diameter: wear, thermal growth."
    )
    covering: CoveringTableTable | None = None


class ArmForceTable(FileTable):
    """A force on a pivot arm, with its distance from the pivot."""

    force: Force
    lever: Length


class ArmTable(FileTable):
    """A pivot arm that presses a bearing of the upper roller onto the lower one."""

    bearing_lever: Length = Field(
        description="Distance of the bearing's line of pressing from the pivot."
    )
    forces: list[ArmForceTable] = Field(
        description="Dead weights, the arm's own weight, a cylinder; negative where they lift."
    )


class FaceTable(FileTable):
    """The nip along its rollers."""

    length: Length
    skew: Angle = 0.0
    end_loads: list[Force] | None = Field(
        None, description="Forces on the bearings of the upper roller, at y < 0 and at y > 0."
    )
    arms: list[ArmTable] | None = Field(
        None, description="Pivot arms that make the end loads: one for both ends, or two."
    )
    bearing_offset: Length | None = Field(
        None,
        description="How much further the upper roller's bearing at y > 0 comes towards the lower "
        "roller than that at y < 0.",
    )
    nip_angle: Angle = 0.0
    sheet_across: Literal["free", "one-speed"] = Field(
        "free",
        description="Whether a sheet in the nip runs as strips of their own speed, or as one web.",
    )
    ends: Literal["plane", "edge", "covering", "covering-upper", "covering-lower"] = Field(
        "plane",
        description="Whether the nip is plane up to the ends, one face ends on a longer covering, "
        "or the coverings themselves end, both or one.",
    )
    end_radius: Length = Field(0.0, description="Of the ends of the shorter face; 0: sharp.")
