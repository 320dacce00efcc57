"""The tables of a case file as pydantic models: which keys there are and what each may hold.

Only the form is checked here: keys, types, units. What the numbers must satisfy is said by the
constructors of the problem itself.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Discriminator, Field, GetJsonSchemaHandler, Tag
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from rollnip._errors import InvalidInputError
from rollnip._units import Dimension, base_unit, example, known_units, parse_quantity


@dataclass(frozen=True, slots=True)
class Quantity:
    """Marks a float of a table as a number in the base unit, or a text that carries its unit."""

    dimension: Dimension
    infinite: bool = False

    def __get_pydantic_core_schema__(self, _source: Any, _handler: Any) -> CoreSchema:
        """Read with the unit parser."""
        return core_schema.no_info_plain_validator_function(self._read)

    def __get_pydantic_json_schema__(
        self, _schema: CoreSchema, _handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        """Say which units there are."""
        number = f"A number in {base_unit(self.dimension)}".removesuffix(" in ")
        units = ", ".join(known_units(self.dimension))
        return {
            "description": f"{number}, or a text with one of: {units}.",
            "anyOf": [{"type": "number"}, {"type": "string"}],
            "examples": [example(self.dimension)],
        }

    def _read(self, value: object) -> float:
        try:
            return parse_quantity(value, self.dimension, infinite=self.infinite)
        except InvalidInputError as error:
            raise PydanticCustomError("quantity", "{why}", {"why": str(error)}) from None


Length = Annotated[float, Quantity("length")]
Radius = Annotated[float, Quantity("length", infinite=True)]
Force = Annotated[float, Quantity("force")]
Density = Annotated[float, Quantity("density")]
Angle = Annotated[float, Quantity("angle")]
LineLoad = Annotated[float, Quantity("line load")]
Pressure = Annotated[float, Quantity("pressure")]
Ratio = Annotated[float, Quantity("ratio")]
Speed = Annotated[float, Quantity("speed")]
Temperature = Annotated[float, Quantity("temperature")]
TemperatureDifference = Annotated[float, Quantity("temperature difference")]
Time = Annotated[float, Quantity("time")]
MolarEnergy = Annotated[float, Quantity("molar energy")]


class Table(BaseModel):
    """A table of the file; unknown keys are errors."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


def _tag(models: tuple[str, ...], *, names: bool = False) -> Callable[[Any], str | None]:
    """Choose by the `model` key; tags stand in <> so that error paths can drop them."""

    def tag(value: Any) -> str | None:
        if names and isinstance(value, str):
            return "<name>"
        model = value.get("model") if isinstance(value, dict) else getattr(value, "model", None)
        return f"<{model}>" if model in models else None

    return tag


def _choice(models: tuple[str, ...], *, names: bool = False) -> Discriminator:
    allowed = "the name of a material or a table" if names else "a table"
    return Discriminator(
        _tag(models, names=names),
        custom_error_type="model",
        custom_error_message=f"must be {allowed} with `model` one of {', '.join(models)}",
    )


class PointTable(Table):
    """A factor at a temperature: of relaxation times (a_T) or of moduli (b_T)."""

    temperature: Temperature
    factor: Ratio


class ShiftTable(Table):
    """The keys that all shift laws share: reference, and how moduli go with temperature."""

    reference: Temperature
    vertical: Literal["none", "entropic"] | None = Field(
        None, description="Moduli: 'none', or 'entropic', in proportion to the kelvin."
    )
    levels: list[PointTable] | None = Field(
        None, description="Measured factors of the moduli instead; only ratios count."
    )


class WlfTable(ShiftTable):
    """Williams-Landel-Ferry shift of the relaxation times with temperature."""

    model: Literal["wlf"]
    c1: Ratio
    c2: TemperatureDifference


class ArrheniusTable(ShiftTable):
    """Arrhenius shift of the relaxation times with temperature."""

    model: Literal["arrhenius"]
    activation_energy: MolarEnergy


class TabulatedTable(ShiftTable):
    """Measured factors of the relaxation times; their logarithm is linear between."""

    model: Literal["table"]
    points: list[PointTable]


Shift = Annotated[
    Annotated[WlfTable, Tag("<wlf>")]
    | Annotated[ArrheniusTable, Tag("<arrhenius>")]
    | Annotated[TabulatedTable, Tag("<table>")],
    _choice(("wlf", "arrhenius", "table")),
]


class ElasticTable(Table):
    """An elastic material; exactly one of modulus, shear_modulus, shore_a."""

    model: Literal["elastic"]
    modulus: Pressure | None = None
    shear_modulus: Pressure | None = None
    shore_a: Ratio | None = None
    poisson: Ratio


class ViscoelasticTable(Table):
    """The keys that all viscoelastic materials share."""

    modulus: Pressure | None = Field(None, description="Relaxed modulus; or shore_a.")
    shore_a: Ratio | None = Field(
        None, description="Shore A hardness at 23 degC, which fixes the relaxed modulus."
    )
    reading_time: Time | None = Field(
        None, description="When the hardness was read after contact; 3 s by default (ISO 48-4)."
    )
    poisson: Ratio
    temperature: Temperature | None = None
    shift: Shift | None = None


class StandardLinearSolidTable(ViscoelasticTable):
    """The standard linear solid: sigma + tau sigma' = E0 eps + (E0 + k) tau eps'."""

    model: Literal["standard-linear-solid"]
    stiffening: Pressure
    relaxation_time: Time


class TermTable(Table):
    """One term of a Prony series."""

    modulus: Pressure
    relaxation_time: Time


class PronyTable(ViscoelasticTable):
    """A Prony series over its relaxed modulus."""

    model: Literal["prony"]
    terms: list[TermTable]


class FractionalZenerTable(ViscoelasticTable):
    """The fractional Zener solid; order in (0, 1]."""

    model: Literal["fractional-zener"]
    stiffening: Pressure
    relaxation_time: Time
    order: Ratio


class LossFactorTable(ViscoelasticTable):
    """A constant loss factor at every frequency."""

    model: Literal["loss-factor"]
    loss_factor: Ratio


MATERIALS: dict[str, type[Table]] = {
    "elastic": ElasticTable,
    "standard-linear-solid": StandardLinearSolidTable,
    "prony": PronyTable,
    "fractional-zener": FractionalZenerTable,
    "loss-factor": LossFactorTable,
}

AnyMaterial = (
    Annotated[ElasticTable, Tag("<elastic>")]
    | Annotated[StandardLinearSolidTable, Tag("<standard-linear-solid>")]
    | Annotated[PronyTable, Tag("<prony>")]
    | Annotated[FractionalZenerTable, Tag("<fractional-zener>")]
    | Annotated[LossFactorTable, Tag("<loss-factor>")]
)
Material = Annotated[AnyMaterial, _choice(tuple(MATERIALS))]
MaterialOrName = Annotated[
    Annotated[str, Tag("<name>")] | AnyMaterial, _choice(tuple(MATERIALS), names=True)
]


class LayerTable(Table):
    """One layer of a coating."""

    thickness: Length
    material: MaterialOrName


class CrownTableTable(Table):
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


class JournalStepTable(Table):
    """A part of a journal of one diameter."""

    diameter: Length
    length: Length | None = Field(None, description="Along the axis; none: on to the bearing.")


class CoveringTableTable(Table):
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


class ShaftTable(Table):
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
    crown: Length | CrownTableTable | None = Field(
        None, description="Height on the diameter, parabolic; or a table with height and shape."
    )
    profiles: list[CrownTableTable] = Field(
        [], description="Further changes of the diameter: wear, thermal growth."
    )
    covering: CoveringTableTable | None = None


class ArmForceTable(Table):
    """A force on a pivot arm, with its distance from the pivot."""

    force: Force
    lever: Length


class ArmTable(Table):
    """A pivot arm that presses a bearing of the upper roller onto the lower one."""

    bearing_lever: Length = Field(
        description="Distance of the bearing's line of pressing from the pivot."
    )
    forces: list[ArmForceTable] = Field(
        description="Dead weights, the arm's own weight, a cylinder; negative where they lift."
    )


class FaceTable(Table):
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


class RollerTable(Table):
    """A roller: radius, core, and layers from the surface to the core."""

    radius: Radius
    core: MaterialOrName = Field(
        "rigid", description="'rigid', or the material of a half-space below the layers."
    )
    layers: list[LayerTable] = []
    profile: str | None = Field(
        None,
        description="CSV file with the columns x and height over the smooth surface, in the "
        "folder of the case file.",
    )
    shaft: ShaftTable | None = None


class NipTable(Table):
    """The load or approach, the drive, friction and speed of the nip."""

    load: LineLoad | None = None
    approach: Length | None = None
    traction: LineLoad | None = None
    creepage: Ratio | None = None
    torque_lower: Force | None = None
    friction: Ratio
    speed: Speed | None = None
    face_width: Length | None = None


class ModelTable(Table):
    """The model of the geometry."""

    geometry: Literal["linear", "corrected", "curved", "finite"] | None = None


class SolverTable(Table):
    """The accuracy of the solution."""

    tolerance: Ratio | None = None


class CaseTable(Table):
    """A whole case file. Units: mm, N, MPa, s, unless a text carries its own."""

    model_config = ConfigDict(title="rollnip case file")

    title: str = ""
    nip: NipTable
    model: ModelTable = ModelTable()
    solver: SolverTable = SolverTable()
    face: FaceTable | None = None
    upper: RollerTable
    lower: RollerTable
    materials: dict[str, Material] = {}


TABLES: dict[str, type[Table]] = {f"<{name}>": table for name, table in MATERIALS.items()} | {
    "nip": NipTable,
    "model": ModelTable,
    "solver": SolverTable,
    "upper": RollerTable,
    "lower": RollerTable,
    "layers": LayerTable,
    "face": FaceTable,
    "shaft": ShaftTable,
    "crown": CrownTableTable,
    "profiles": CrownTableTable,
    "journals": JournalStepTable,
    "covering": CoveringTableTable,
    "arms": ArmTable,
    "forces": ArmForceTable,
    "terms": TermTable,
    "<wlf>": WlfTable,
    "<arrhenius>": ArrheniusTable,
    "<table>": TabulatedTable,
    "points": PointTable,
    "levels": PointTable,
}
