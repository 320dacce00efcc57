"""The builder of a problem from tables of right form; gathers what the constructors refuse."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from math import cos
from pathlib import Path
from typing import Any, TypeVar, cast

from rollnip._errors import InvalidInputError, RollnipError
from rollnip.cooling import HeatBalance
from rollnip.io.build_energy import energy_of
from rollnip.io.build_face import ShaftBuilder, face_of
from rollnip.io.build_heat import THERMAL_KEYS, heat_of, thermal_of
from rollnip.io.messages import placed, unknown_name
from rollnip.io.profile import read_profile
from rollnip.io.tables import (
    AnyMaterial,
    ArrheniusTable,
    CaseTable,
    ElasticTable,
    EnergyTable,
    FractionalZenerTable,
    LayerTable,
    LossFactorTable,
    NipTable,
    PronyTable,
    RollerTable,
    SheetTable,
    ShiftTable,
    StandardLinearSolidTable,
    TabulatedTable,
    ViscoelasticTable,
    WlfTable,
)
from rollnip.materials import (
    WLF,
    Arrhenius,
    Elastic,
    Energy,
    FractionalZener,
    LossFactor,
    Material,
    Prony,
    Shift,
    StandardLinearSolid,
    TabulatedShift,
    Thermal,
    Viscoelastic,
    with_shore_a,
)
from rollnip.materials.relaxation import READING_TIME
from rollnip.materials.shift import Vertical
from rollnip.materials.shore import shore_a_modulus
from rollnip.model import Geometry, Model
from rollnip.nip import Approach, Creepage, LineLoad, Nip, Torque, Traction
from rollnip.rollers import Layer, Profile, Roller
from rollnip.shafts import Face
from rollnip.sheets import SHEETS, Sheet

_OF_THE_WHOLE = {
    "title": "title",
    "upper": "nip",
    "lower": "nip",
    "radius": "upper.radius, lower.radius",
    "profile": "upper.profile, lower.profile",
    **{
        name: f"sheet.{name}"
        for name in ("sheet", "thickness", "tension_in", "friction_upper", "friction_lower")
    },
}
_KINDS: dict[type[ViscoelasticTable], type[Viscoelastic]] = {
    StandardLinearSolidTable: StandardLinearSolid,
    PronyTable: Prony,
    FractionalZenerTable: FractionalZener,
    LossFactorTable: LossFactor,
}
T = TypeVar("T")


class Builder:
    """Builds the parts of a case one by one; a part that is refused is None and a line in errors.

    Parameters
    ----------
    table :
        the case as read.
    folder :
        where the files it names are found; None: no file is read.
    """

    def __init__(self, table: CaseTable, folder: Path | None = None) -> None:
        self.table = table
        self.folder = folder
        self.errors: list[str] = []

    def model(self) -> Model | None:
        """The model of the geometry, with the tolerance."""
        model = Model()
        geometry, tolerance = self.table.model.geometry, self.table.solver.tolerance
        return self._made(
            "model",
            lambda: Model(
                geometry=cast("Geometry", model.geometry if geometry is None else geometry),
                tolerance=model.tolerance if tolerance is None else tolerance,
            ),
            {"tolerance": "solver.tolerance"},
        )

    def nip(self) -> Nip | None:
        """The problem; None where any part of it was refused."""
        rollers = self.rollers()
        controls = self._controls(self.table.nip, None if rollers is None else rollers[0])
        sheet = self._sheet(self.table.sheet)
        if rollers is None or controls is None or self.errors:
            return None
        upper, lower = rollers
        normal, tangential = controls
        table = self.table.nip
        return self._made(
            "nip",
            lambda: Nip(
                upper=upper,
                lower=lower,
                normal=normal,
                tangential=tangential,
                friction=table.friction,
                speed=table.speed,
                face_width=table.face_width,
                title=self.table.title,
                sheet=sheet,
            ),
            _OF_THE_WHOLE,
        )

    def _made(
        self, path: str, make: Callable[[], T], elsewhere: Mapping[str, str] | None = None
    ) -> T | None:
        try:
            return make()
        except InvalidInputError as error:
            line = placed(path, str(error), elsewhere)
            if line not in self.errors:
                self.errors.append(line)
            return None

    def _check_materials(self) -> None:
        """Check every material, also those that no layer names."""
        for name, table in self.table.materials.items():
            if name == "rigid":
                self.errors.append('materials.rigid: must have another name; "rigid" is a core.')
            self._material(f"materials.{name}", table)

    def _controls(
        self, table: NipTable, upper: Roller | None
    ) -> tuple[LineLoad | Approach, Traction | Creepage | Torque] | None:
        face = self.face()
        if face is None and self.table.face is not None:
            return None
        normal = self._made("nip", lambda: _normal(table, face, upper))
        tangential = self._made("nip", lambda: _tangential(table))
        return None if normal is None or tangential is None else (normal, tangential)

    def rollers(self) -> tuple[Roller, Roller] | None:
        """The upper and the lower roller; None where any part of them was refused."""
        self._check_materials()
        upper = self._roller("upper", self.table.upper)
        lower = self._roller("lower", self.table.lower)
        return None if upper is None or lower is None or self.errors else (upper, lower)

    def _roller(self, path: str, table: RollerTable) -> Roller | None:
        profile = self._profile(f"{path}.profile", table.profile)
        layers = [self._layer(f"{path}.layers[{i}]", layer) for i, layer in enumerate(table.layers)]
        core = None if table.core == "rigid" else self._named(f"{path}.core", table.core)
        whole = tuple(layer for layer in layers if layer is not None)
        outermost = whole[0].material if whole else None
        shaft = ShaftBuilder(self._made, self.errors, self.folder, outermost).shaft(
            f"{path}.shaft", table.shaft
        )
        return self._made(
            path,
            lambda: Roller(
                radius=table.radius, layers=whole, core=core, profile=profile, shaft=shaft
            ),
        )

    def face(self) -> Face | None:
        """Return the face; None where the case has none, or where it was refused."""
        table = self.table.face
        return None if table is None else self._made("face", lambda: face_of(table))

    def heat(self) -> HeatBalance | None:
        """Return the heat balance; None where the case has none, or where it was refused."""
        return heat_of(self.table, self.errors)

    def _sheet(self, table: SheetTable | None) -> Sheet | None:
        if table is None:
            return None
        values = table.model_dump(exclude={"kind"}, exclude_none=True)
        if table.kind is not None:
            if table.kind not in SHEETS:
                known = "the usual sheets"
                self.errors.append(unknown_name("sheet.kind", table.kind, [*SHEETS], known))
                return None
            usual = SHEETS[table.kind]
            return self._made("sheet", lambda: replace(usual, **values))
        missing = [name for name in ("thickness", "modulus") if name not in values]
        self.errors += [f"sheet.{name}: is missing." for name in missing]
        return None if missing else self._made("sheet", lambda: Sheet(**values))

    def _profile(self, path: str, name: str | None) -> Profile | None:
        if name is None:
            return None
        if self.folder is None:
            self.errors.append(
                f"{path}: names a file, which is read for a case file alone; use `rollnip solve`, "
                "or `Roller(profile=Profile(x=..., height=...))` in Python."
            )
            return None
        try:
            return read_profile(self.folder / name)
        except RollnipError as error:
            self.errors.append(f"{path}: {error}")
            return None

    def _layer(self, path: str, table: LayerTable) -> Layer | None:
        material = self._named(f"{path}.material", table.material)
        if material is None:
            return None
        return self._made(path, lambda: Layer(table.thickness, material))

    def _named(self, path: str, material: str | AnyMaterial) -> Material | None:
        if not isinstance(material, str):
            return self._material(path, material)
        known = self.table.materials
        if material in known:
            return self._material(f"materials.{material}", known[material])
        names, instead = list(known), "; add a table [materials.NAME] for it"
        if path.endswith("core"):
            names, instead = [*names, "rigid"], f"{instead}, or leave it out: a core is rigid then"
        self.errors.append(unknown_name(path, material, names, "[materials]", instead=instead))
        return None

    def _material(self, path: str, table: AnyMaterial) -> Material | None:
        before = len(self.errors)
        thermal = self._made(path, lambda: thermal_of(table))
        if len(self.errors) > before:
            return None
        energy = self._energy(f"{path}.energy", table.energy)
        if energy is None and table.energy is not None:
            return None
        if isinstance(table, ElasticTable):
            return self._made(
                path, lambda: replace(_elastic(table), thermal=thermal, energy=energy)
            )
        shift = self._shift(path, table)
        if shift is None and table.shift is not None:
            return None
        return self._made(path, lambda: _viscoelastic(table, shift, thermal, energy))

    def _energy(self, path: str, table: EnergyTable | None) -> Energy | None:
        return None if table is None else self._made(path, lambda: energy_of(table))

    def _shift(self, path: str, table: ViscoelasticTable) -> Shift | None:
        shift = table.shift
        return None if shift is None else self._made(f"{path}.shift", lambda: _shift(shift))


def _normal(table: NipTable, face: Face | None, upper: Roller | None) -> LineLoad | Approach:
    """Return the load or the approach; with end loads, the mean load that they and weight make."""
    if face is not None and face.end_loads is not None:
        mean = sum(face.end_loads) / face.length
        return LineLoad(mean if upper is None else mean + upper.core_weight * cos(face.nip_angle))
    if table.approach is not None:
        return Approach(table.approach)
    assert table.load is not None  # `wrong_controls` refuses a nip with neither
    return LineLoad(table.load)


def _tangential(table: NipTable) -> Traction | Creepage | Torque:
    if table.creepage is not None:
        return Creepage(table.creepage)
    if table.torque_lower is not None:
        return Torque(table.torque_lower)
    return Traction(table.traction if table.traction is not None else 0.0)


def _elastic(table: ElasticTable) -> Elastic:
    given = [
        name for name in ("modulus", "shear_modulus", "shore_a") if getattr(table, name) is not None
    ]
    if len(given) != 1:
        raise InvalidInputError(
            "must hold exactly one of modulus, shear_modulus, shore_a, "
            f"got {' and '.join(given) or 'none'}."
        )
    if table.shear_modulus is not None:
        return Elastic.from_shear_modulus(table.shear_modulus, table.poisson)
    if table.shore_a is not None:
        return Elastic.from_shore_a(table.shore_a, table.poisson)
    assert table.modulus is not None
    return Elastic(modulus=table.modulus, poisson=table.poisson)


def _shift(table: WlfTable | ArrheniusTable | TabulatedTable) -> Shift:
    vertical = _vertical(table)
    if isinstance(table, WlfTable):
        return WLF(table.c1, table.c2, table.reference, vertical)
    if isinstance(table, ArrheniusTable):
        return Arrhenius(table.activation_energy, table.reference, vertical)
    points = tuple((point.temperature, point.factor) for point in table.points)
    return TabulatedShift(points, table.reference, vertical)


def _vertical(table: ShiftTable) -> Vertical:
    if table.levels is None:
        return table.vertical or "none"
    if table.vertical is not None:
        raise InvalidInputError("must hold only one of vertical, levels, got both.")
    return tuple((point.temperature, point.factor) for point in table.levels)


def _viscoelastic(
    table: ViscoelasticTable, shift: Shift | None, thermal: Thermal | None, energy: Energy | None
) -> Material:
    values = table.model_dump(
        exclude={"model", "terms", "shift", "energy", "shore_a", "reading_time", *THERMAL_KEYS}
    )
    values |= {"thermal": thermal, "energy": energy}
    if isinstance(table, PronyTable):
        values["terms"] = tuple((term.modulus, term.relaxation_time) for term in table.terms)
    given = [name for name in ("modulus", "shore_a") if getattr(table, name) is not None]
    if len(given) != 1:
        raise InvalidInputError(
            f"must hold exactly one of modulus, shore_a, got {' and '.join(given) or 'none'}."
        )
    if table.shore_a is None:
        if table.reading_time is not None:
            raise InvalidInputError("must hold reading_time only together with shore_a.")
        return _KINDS[type(table)](**values, shift=shift)
    values["modulus"] = shore_a_modulus(table.shore_a)  # until the relaxed one is known
    made: Any = _KINDS[type(table)](**values, shift=shift)
    after = READING_TIME if table.reading_time is None else table.reading_time
    hard: Material = with_shore_a(made, table.shore_a, reading_time=after)
    return hard
