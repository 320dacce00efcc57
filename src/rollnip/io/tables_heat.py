"""The tables of a case file about heat: which keys there are and what each may hold."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from rollnip.io.forms import (
    Conductivity,
    Density,
    Expansion,
    FileTable,
    Film,
    HeatCapacity,
    Length,
    Temperature,
)

TYPICAL_HELP = (
    "Typical properties by name: natural-rubber, natural-rubber-filled, sbr-filled, polyurethane, "
    "paper, polyester-film, steel or aluminium; keys beside it take the place of single ones."
)


class ThermalTable(FileTable):
    """The thermal keys that all materials share; they count only for a heat balance."""

    thermal: str | None = Field(None, description=TYPICAL_HELP)
    conductivity: Conductivity | None = None
    density: Density | None = None
    heat_capacity: HeatCapacity | None = Field(None, description="Per mass.")
    expansion: Expansion | None = Field(
        None, description="Linear; without it the size does not follow the temperature."
    )


class CoolantTable(FileTable):
    """A fluid behind the core."""

    coolant: Temperature
    film: Film


class ShellTable(ThermalTable):
    """The wall of the core under the coverings."""

    thickness: Length


class PassingSheetTable(ThermalTable):
    """A sheet that takes heat along."""

    thickness: Length | None = Field(
        None, description="That of [sheet] by default; needed where the case has none."
    )
    temperature: Temperature = Field(description="Where it enters the nip.")


def _core(value: Any) -> str:
    if isinstance(value, dict):
        return "<coolant>"
    return "<insulated>" if value == "insulated" else "<held>"


class RollerHeatTable(FileTable):
    """The ways in which a roller loses heat."""

    film: Film = Field(description="Film coefficient between the surface and the ambient air.")
    core: Annotated[
        Annotated[CoolantTable, Tag("<coolant>")]
        | Annotated[Literal["insulated"], Tag("<insulated>")]
        | Annotated[Temperature, Tag("<held>")],
        Discriminator(_core),
    ] = Field(
        "insulated",
        description="'insulated', the temperature at which it is held, or a table with coolant "
        "and film.",
    )
    shell: ShellTable | None = None


class HeatTable(FileTable):
    """The surroundings that take the heat of the nip."""

    ambient: Temperature
    start: Temperature | None = Field(
        None, description="Of everything when a warm-up begins; the ambient one by default."
    )
    sheet: PassingSheetTable | None = None
