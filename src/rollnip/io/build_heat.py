"""The builder of thermal properties and heat balances from tables of right form."""

from __future__ import annotations

from math import isinf

from rollnip._errors import InvalidInputError
from rollnip.cooling import (
    Coolant,
    Cooling,
    Core,
    HeatBalance,
    Held,
    Insulated,
    PassingSheet,
    Shell,
)
from rollnip.io.messages import placed
from rollnip.io.tables import CaseTable, RollerTable
from rollnip.io.tables_heat import CoolantTable, RollerHeatTable, ShellTable, ThermalTable
from rollnip.materials import TYPICAL, Thermal

THERMAL_KEYS = ("thermal", "conductivity", "density", "heat_capacity", "expansion")
_NEEDED = ("conductivity", "density", "heat_capacity")


def thermal_of(table: ThermalTable) -> Thermal | None:
    """Return the thermal properties of a material; None where it has none.

    Raises
    ------
    InvalidInputError
        where some are missing, one lies outside its range, or the name is not known.
    """
    given = {name: getattr(table, name) for name in THERMAL_KEYS[1:]}
    given = {name: value for name, value in given.items() if value is not None}
    if table.thermal is not None:
        if table.thermal not in TYPICAL:
            raise InvalidInputError(
                f"`thermal` must be one of {', '.join(TYPICAL)}, got {table.thermal!r}."
            )
        typical = TYPICAL[table.thermal]
        given = {name: getattr(typical, name) for name in THERMAL_KEYS[1:]} | given
    if not given:
        return None
    missing = [name for name in _NEEDED if name not in given]
    if missing:
        raise InvalidInputError(
            f"`{missing[0]}` must be given together with {', '.join(given)}, got none; or name "
            "typical properties with `thermal`."
        )
    return Thermal(**given)


def heat_of(table: CaseTable, errors: list[str]) -> HeatBalance | None:
    """Return the heat balance of a case; None where it has none, or where it was refused."""
    sides = {"upper": table.upper, "lower": table.lower}
    if table.heat is None:
        errors += [
            f"{side}.heat: must stand beside a table [heat] with ambient, which is missing."
            for side, roller in sides.items()
            if roller.heat is not None
        ]
        return None
    before = len(errors)
    cooling = {side: _cooling(f"{side}.heat", roller, errors) for side, roller in sides.items()}
    sheet = _sheet(table, errors)
    upper, lower = cooling["upper"], cooling["lower"]
    if len(errors) > before or upper is None or lower is None:
        return None
    try:
        return HeatBalance(
            ambient=table.heat.ambient,
            upper=upper,
            lower=lower,
            start=table.heat.start,
            sheet=sheet,
        )
    except InvalidInputError as error:
        errors.append(placed("heat", str(error)))
        return None


def _sheet(table: CaseTable, errors: list[str]) -> PassingSheet | None:
    assert table.heat is not None
    sheet = table.heat.sheet
    if sheet is None:
        if table.sheet is not None:
            errors.append(
                "heat.sheet: is missing; a sheet takes heat along: add a table [heat.sheet] with "
                "its temperature and thermal properties."
            )
        return None
    if sheet.thickness is None and table.sheet is None:
        errors.append("heat.sheet.thickness: must be given in a case without a table [sheet].")
        return None
    try:
        return PassingSheet(
            thickness=sheet.thickness, thermal=_given(sheet), temperature=sheet.temperature
        )
    except InvalidInputError as error:
        errors.append(placed("heat.sheet", str(error)))
        return None


def _cooling(path: str, roller: RollerTable, errors: list[str]) -> Cooling | None:
    table = roller.heat
    if table is None:
        if isinf(roller.radius):
            return Cooling(film=0.0)
        errors.append(f"{path}: is missing; add a table [{path}] with a film coefficient.")
        return None
    core = _core(f"{path}.core", table, errors)
    shell = None if table.shell is None else _shell(f"{path}.shell", table.shell, errors)
    if core is None or (shell is None and table.shell is not None):
        return None
    try:
        return Cooling(film=table.film, core=core, shell=shell)
    except InvalidInputError as error:
        errors.append(placed(path, str(error)))
        return None


def _core(path: str, table: RollerHeatTable, errors: list[str]) -> Core | None:
    is_cooled = isinstance(table.core, CoolantTable)
    try:
        if isinstance(table.core, CoolantTable):
            return Coolant(table.core.coolant, film=table.core.film)
        return Insulated() if isinstance(table.core, str) else Held(table.core)
    except InvalidInputError as error:
        key = f"{path}.coolant" if is_cooled else path
        errors.append(placed(path, str(error)).replace(f"{path}.temperature", key))
        return None


def _shell(path: str, table: ShellTable, errors: list[str]) -> Shell | None:
    try:
        return Shell(thickness=table.thickness, thermal=_given(table))
    except InvalidInputError as error:
        errors.append(placed(path, str(error)))
        return None


def _given(table: ThermalTable) -> Thermal:
    thermal = thermal_of(table)
    if thermal is None:
        raise InvalidInputError(
            "`conductivity` must be given, got none; or name typical properties, such as "
            '`thermal = "steel"`.'
        )
    return thermal
