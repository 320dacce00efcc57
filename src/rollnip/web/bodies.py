"""Bodies of requests and answers, for checking and for the schema of the API."""

from __future__ import annotations

from math import inf
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, WithJsonSchema, field_validator

from rollnip._units import Dimension
from rollnip.rollers import Side

CASE = "x-case-file"
"""Marks where the schema of the API is to refer to that of the case file."""

Case = Annotated[dict[str, Any], WithJsonSchema({CASE: True})]
PatchCase = Annotated[
    dict[str, Any], Field(description="A case with a table [patch], as for `rollnip patch solve`.")
]
Path = Annotated[
    str, Field(min_length=1, max_length=200, examples=["nip.load", "upper.layers[0].thickness"])
]
Value = Annotated[float | str, Field(union_mode="left_to_right", examples=[2.0, "2 mm"])]


class RequestBody(BaseModel):
    """The body of a request; unknown keys are errors."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


class InteriorBody(RequestBody):
    """A request for one field inside one roller."""

    case: Case
    roller: Side
    nx: int = Field(120, ge=2, description="Places along the nip.")
    nz: int = Field(40, ge=2, description="Depths, three at least in each layer.")


class SweepBody(RequestBody):
    """A request for the results at several sizes of one value of the case."""

    case: Case
    path: Path
    values: list[Value] = Field(min_length=1)


class FindBody(RequestBody):
    """A request for the value of the case that gives a wanted figure."""

    case: Case
    path: Path
    quantity: str = Field(max_length=60, examples=["nip_width"])
    wanted: Value
    low: Value
    high: Value


class KnownBody(RequestBody):
    """A request for how well the figures of a case are known."""

    case: Case
    measured: dict[str, list[float]] = Field(
        default_factory=dict,
        description="Lowest and highest modulus [MPa] by path of a material that was measured.",
        examples=[{"upper.layers[0].material": [3.1, 3.6]}],
    )

    @field_validator("measured")
    @classmethod
    def _are_bands(cls, measured: dict[str, list[float]]) -> dict[str, list[float]]:
        if any(len(one) != 2 or not 0.0 < one[0] <= one[1] < inf for one in measured.values()):
            raise ValueError("must hold two moduli, the lower one first")
        return measured


class CrownBody(RequestBody):
    """A request for the crown that evens out the load along a face."""

    case: Case
    roller: Side = "upper"
    within: float = Field(
        0.1, gt=0.0, lt=1.0, description="Largest departure of the line load from its mean."
    )


class RunawayBody(RequestBody):
    """A request for the steady states of a warm nip over its speed or load."""

    case: Case
    parameter: Literal["speed", "load"] = "speed"


class ImpressionOf(RequestBody):
    """Nip widths of one impression."""

    y: list[float] = Field(min_length=1, max_length=200, description="From the middle [mm].")
    width: list[float] = Field(min_length=1, max_length=200, description="Nip width there [mm].")
    load: float | None = Field(
        None, description="Mean line load [N/mm] under which it was made; none: that of the case."
    )


class ImpressionBody(RequestBody):
    """A request for what measured nip widths along a face tell."""

    case: Case
    roller: Side = "upper"
    unknowns: list[Literal["load", "tilt", "crown", "modulus"]] = Field(
        ["crown", "tilt"], min_length=1, max_length=4
    )
    scatter: float = Field(0.2, gt=0.0, description="Standard deviation of a width [mm].")
    impressions: list[ImpressionOf] = Field(min_length=1, max_length=10)


class TomlBody(RequestBody):
    """The text of a case file."""

    text: str


class QuantityBody(RequestBody):
    """A number with its unit as a person types it."""

    text: str = Field(max_length=200, examples=["2 in", '1/2"', "65A"])
    dimension: Dimension
    unit: str = Field("", max_length=20, description="Of a number that stands alone.")
    hardness: bool = Field(False, description="Whether it is a Shore A hardness.")


class NumberInBaseUnit(BaseModel):
    """A number in its base unit."""

    value: float
    unit: str


class Version(BaseModel):
    """The version of rollnip."""

    version: str


class Detail(BaseModel):
    """The error at one key."""

    path: str
    message: str


class Refusal(BaseModel):
    """The body of every answer that is an error."""

    error: str
    details: list[Detail]
