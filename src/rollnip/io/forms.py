"""The forms that values of a file may have: quantities with their units, and tables of keys."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, GetJsonSchemaHandler
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from rollnip._errors import InvalidInputError
from rollnip._units import Dimension, base_unit, example, known_units, parse_quantity


def read_quantity(value: object, dimension: Dimension, *, infinite: bool = False) -> float:
    """Return a value of a file in its base unit, as `parse_quantity` does.

    Where a text lacks its unit, the refusal also says what a number without quotes is in.
    """
    try:
        return parse_quantity(value, dimension, infinite=infinite)
    except InvalidInputError as error:
        if not (isinstance(value, str) and _is_number(value) and base_unit(dimension)):
            raise
        hint = f"a number without quotes is in {base_unit(dimension)}"
        raise InvalidInputError(f"{str(error).rstrip('.')} ({hint}).") from None


def _is_number(text: str) -> bool:
    try:
        return isfinite(float(text))
    except ValueError:
        return False


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
            return read_quantity(value, self.dimension, infinite=self.infinite)
        except InvalidInputError as error:
            raise PydanticCustomError("quantity", "{why}", {"why": str(error)}) from None


Length = Annotated[float, Quantity("length")]
Radius = Annotated[float, Quantity("length", infinite=True)]
Force = Annotated[float, Quantity("force")]
TurnPerLength = Annotated[float, Quantity("turn per length")]
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
Conductivity = Annotated[float, Quantity("thermal conductivity")]
HeatCapacity = Annotated[float, Quantity("heat capacity")]
Film = Annotated[float, Quantity("film coefficient")]
Expansion = Annotated[float, Quantity("thermal expansion")]


class FileTable(BaseModel):
    """A table of the file; unknown keys are errors."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)
