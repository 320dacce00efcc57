"""The tables of a case file as pydantic models: which keys there are and what each may hold.

Only the form is checked here: keys, types, units. What the numbers must satisfy is said by the
constructors of the problem itself.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Discriminator, Field, Tag, model_validator

from rollnip.io.forms import (
    FileTable,
    Force,
    Length,
    LineLoad,
    MolarEnergy,
    Pressure,
    Radius,
    Ratio,
    Speed,
    Temperature,
    TemperatureDifference,
    Time,
)
from rollnip.io.tables_face import (
    ArmForceTable,
    ArmTable,
    CoveringTableTable,
    CrownTableTable,
    FaceTable,
    JournalStepTable,
    ShaftTable,
)
from rollnip.io.tables_heat import (
    CoolantTable,
    HeatTable,
    PassingSheetTable,
    RollerHeatTable,
    ShellTable,
    ThermalTable,
)


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


class PointTable(FileTable):
    """A factor at a temperature: of relaxation times (a_T) or of moduli (b_T)."""

    temperature: Temperature
    factor: Ratio


class ShiftTable(FileTable):
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


class EnergyTable(FileTable):
    """The key that all strain energies share: the law of the change of volume."""

    volumetric: Literal["log", "square"] | None = Field(
        None, description="Where compressible: lambda/2 (ln J)^2, the default, or (J - 1)^2."
    )


class NeoHookeanTable(EnergyTable):
    """The neo-Hookean energy, the default."""

    model: Literal["neo-hookean"]


class YeohTable(EnergyTable):
    """Yeoh's energy: C20/C10 and C30/C10."""

    model: Literal["yeoh"]
    second: Ratio
    third: Ratio = 0.0


class GentTable(EnergyTable):
    """Gent's energy: the largest I1 - 3."""

    model: Literal["gent"]
    limit: Ratio


class OgdenTermTable(FileTable):
    """One term of Ogden's energy; only ratios of the weights count."""

    weight: Ratio
    exponent: Ratio


class OgdenTable(EnergyTable):
    """Ogden's energy."""

    model: Literal["ogden"]
    terms: list[OgdenTermTable]


Energy = Annotated[
    Annotated[NeoHookeanTable, Tag("<neo-hookean>")]
    | Annotated[YeohTable, Tag("<yeoh>")]
    | Annotated[GentTable, Tag("<gent>")]
    | Annotated[OgdenTable, Tag("<ogden>")],
    _choice(("neo-hookean", "yeoh", "gent", "ogden")),
]


class ElasticTable(ThermalTable):
    """An elastic material; exactly one of modulus, shear_modulus, shore_a."""

    model: Literal["elastic"]
    modulus: Pressure | None = None
    shear_modulus: Pressure | None = None
    shore_a: Ratio | None = None
    poisson: Ratio
    energy: Energy | None = Field(
        None, description="Strain energy, for geometry 'finite'; neo-Hookean by default."
    )


class ViscoelasticTable(ThermalTable):
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
    energy: Energy | None = Field(
        None, description="Strain energy, for geometry 'finite'; neo-Hookean by default."
    )


class StandardLinearSolidTable(ViscoelasticTable):
    """The standard linear solid: sigma + tau sigma' = E0 eps + (E0 + k) tau eps'."""

    model: Literal["standard-linear-solid"]
    stiffening: Pressure
    relaxation_time: Time


class TermTable(FileTable):
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


MATERIALS: dict[str, type[FileTable]] = {
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


class LayerTable(FileTable):
    """One layer of a coating."""

    thickness: Length
    material: MaterialOrName


class SheetTable(FileTable):
    """The sheet that runs between the rollers."""

    kind: str | None = Field(
        None, description="Name of a usual sheet; keys beside it replace its values."
    )
    thickness: Length | None = None
    modulus: Pressure | None = Field(None, description="In the plane, along the nip.")
    poisson: Ratio | None = None
    modulus_thickness: Pressure | None = Field(
        None, description="Across the thickness; by default that in the plane."
    )
    tension_in: LineLoad = Field(0.0, description="On the inlet side, per width.")
    tension_out: LineLoad = 0.0
    friction_upper: Ratio | None = Field(None, description="By default that of the nip.")
    friction_lower: Ratio | None = None
    bending: bool | None = Field(
        None, description="Whether it resists bending; by default where that shows."
    )


class RollerTable(FileTable):
    """A roller: radius, core, and layers from the surface to the core."""

    radius: Radius
    core: MaterialOrName = Field(
        "rigid", description="'rigid', or the material of a half-space below the layers."
    )
    layers: list[LayerTable] = Field(default=[])
    profile: str | None = Field(
        None,
        description="CSV file with the columns x and height over the smooth surface, in the "
        "folder of the case file.",
    )
    shaft: ShaftTable | None = None
    heat: RollerHeatTable | None = None


class NipTable(FileTable):
    """The load or approach, the drive, friction and speed of the nip."""

    load: LineLoad | None = None
    approach: Length | None = None
    traction: LineLoad | None = None
    creepage: Ratio | None = None
    torque_lower: Force | None = None
    friction: Ratio = Field(
        description="May be left out where the sheet has its own on both sides."
    )
    speed: Speed | None = None
    face_width: Length | None = None


class ModelTable(FileTable):
    """The model of the geometry."""

    geometry: Literal["linear", "corrected", "curved", "second", "finite", "full"] | None = None


class SolverTable(FileTable):
    """The accuracy of the solution."""

    tolerance: Ratio | None = None


class CaseTable(FileTable):
    """A whole case file. Units: mm, N, MPa, s, unless a text carries its own."""

    model_config = ConfigDict(title="rollnip case file")

    title: str = ""
    nip: NipTable
    model: ModelTable = ModelTable()
    solver: SolverTable = SolverTable()
    face: FaceTable | None = None
    sheet: SheetTable | None = None
    heat: HeatTable | None = None
    upper: RollerTable
    lower: RollerTable
    materials: dict[str, Material] = Field(default={})

    @model_validator(mode="before")
    @classmethod
    def _with_friction(cls, tree: dict[str, Any]) -> dict[str, Any]:
        """Return the tree with a friction of the nip where both sides of a sheet have their own."""
        nip, sheet = tree.get("nip"), tree.get("sheet")
        if not (isinstance(nip, dict) and isinstance(sheet, dict)) or "friction" in nip:
            return tree
        sides = [sheet.get(f"friction_{side}") for side in ("upper", "lower")]
        return tree if None in sides else {**tree, "nip": {**nip, "friction": sides[0]}}


TABLES: dict[str, type[FileTable]] = {f"<{name}>": table for name, table in MATERIALS.items()} | {
    "nip": NipTable,
    "model": ModelTable,
    "solver": SolverTable,
    "upper": RollerTable,
    "lower": RollerTable,
    "layers": LayerTable,
    "face": FaceTable,
    "sheet": SheetTable,
    "heat": HeatTable,
    "upper.heat": RollerHeatTable,
    "lower.heat": RollerHeatTable,
    "shaft": ShaftTable,
    "crown": CrownTableTable,
    "<crown>": CrownTableTable,
    "<height>": CrownTableTable,
    "profiles": CrownTableTable,
    "journals": JournalStepTable,
    "covering": CoveringTableTable,
    "arms": ArmTable,
    "forces": ArmForceTable,
    "terms": TermTable,
    "<neo-hookean>": NeoHookeanTable,
    "<yeoh>": YeohTable,
    "<gent>": GentTable,
    "<ogden>": OgdenTable,
    "<ogden>.terms": OgdenTermTable,
    "<wlf>": WlfTable,
    "<arrhenius>": ArrheniusTable,
    "<table>": TabulatedTable,
    "points": PointTable,
    "levels": PointTable,
    "<coolant>": CoolantTable,
    "<held>": CoolantTable,
    "<insulated>": CoolantTable,
    "shell": ShellTable,
    "heat.sheet": PassingSheetTable,
}
