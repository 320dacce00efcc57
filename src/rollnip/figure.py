"""One figure of a result: what every registry of figures is made of.

Units and digits stand here alone. The registries are `rollnip.figures` (the nip, its curves and
interfaces), `rollnip.sheet_figures`, and `figures` of `rollnip.face`, `rollnip.heat` and
`rollnip.patch`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass, field
from math import inf, isfinite, pi
from typing import Any, Literal, NamedTuple, TypeVar

from rollnip._units import format_quantity

__all__ = [
    "LARGE",
    "ROUNDING",
    "Dimension",
    "FaceTotal",
    "Figure",
    "Section",
    "Shown",
    "axis_label",
    "by_key",
    "curve",
]

Dimension = Literal[
    "length",
    "line load",
    "pressure",
    "force",
    "roller force",
    "moment",
    "time",
    "speed",
    "ratio",
    "share",
    "power per length",
    "heat per length",
    "power",
    "area",
    "turn per length",
    "feed per metre",
    "temperature",
    "temperature difference",
    "angle",
    "energy per volume",
    "power per volume",
    "power per area",
    "frequency",
    "duration",
    "compliance",
]
Section = Literal["nip", "drive", "losses", "sheet"]

# Newton's method leaves the ends of zones some 1e-9 of the width from where they belong, and not
# equally far on both sides; a loss of 1e-8 of load times speed is meant.
ROUNDING = 5e-9
"""Share of its size below which a figure is a rounding error.

In free rolling, where torques, traction and friction losses are exactly 0, what is computed is at
most 4e-13 of their size; the smallest figures that are meant (losses of a viscoelastic cover in
slow motion) are 1e-8 of it and more.
"""


class _Units(NamedTuple):
    base: str
    shown: str
    factor: float


# Base unit, the unit a reader sees, and the factor from the one to the other.
_UNITS: Mapping[Dimension, _Units] = {
    "length": _Units("mm", "mm", 1.0),
    "line load": _Units("N/mm", "N/mm", 1.0),
    "pressure": _Units("MPa", "MPa", 1.0),
    "force": _Units("N", "N mm/mm", 1.0),  # a moment per length of the nip
    "roller force": _Units("N", "N", 1.0),
    "moment": _Units("N mm", "N m", 1e-3),
    "time": _Units("s", "ms", 1e3),
    "speed": _Units("mm/s", "mm/s", 1.0),
    "ratio": _Units("1", "", 1.0),
    "share": _Units("1", "%", 100.0),
    "power per length": _Units("N/s", "mW/mm", 1.0),
    "heat per length": _Units("mW/mm", "W/m", 1.0),
    "power": _Units("mW", "W", 1e-3),
    "area": _Units("mm2", "mm²", 1.0),
    "turn per length": _Units("1/mm", "1/mm", 1.0),
    "feed per metre": _Units("mm/m", "mm/m", 1.0),
    "temperature": _Units("degC", "°C", 1.0),
    "temperature difference": _Units("K", "K", 1.0),
    "angle": _Units("rad", "°", 180.0 / pi),
    "energy per volume": _Units("mJ/mm3", "mJ/mm³", 1.0),
    "power per volume": _Units("mW/mm3", "mW/mm³", 1.0),
    "power per area": _Units("mW/mm2", "mW/mm²", 1.0),
    "frequency": _Units("Hz", "Hz", 1.0),
    "duration": _Units("s", "s", 1.0),  # of tests and records; dwell times are shown in ms
    "compliance": _Units("1/MPa", "1/MPa", 1.0),
}


def axis_label(name: str, unit: str) -> str:
    """Return the label of an axis or a column: a name, and its unit where it has one."""
    return name if unit in ("", "1") else f"{name} [{unit}]"


class Shown(NamedTuple):
    """A unit that a reader sees, and the factor from the base unit to it."""

    unit: str
    factor: float


LARGE: Mapping[Dimension, tuple[float, Shown]] = {"duration": (180.0, Shown("min", 1.0 / 60.0))}
"""From which size on (in base units) a dimension is shown in a larger unit, and that unit."""


class FaceTotal(NamedTuple):
    """The figure of the whole face: value times face width [mm] times ``factor``, in ``unit``."""

    unit: str
    factor: float


@dataclass(frozen=True, slots=True)
class Figure:
    """One figure of a result.

    Attributes
    ----------
    key : its path in the result JSON, such as "dissipation.friction".
    label : its name, in lower case.
    dimension : what kind of number it is; decides the units.
    sentence : what it is, in one sentence.
    symbol : as in the theory, in TeX; empty where the theory has none.
    sign : what a positive value means; empty where it is never negative.
    undefined : why it may be null; empty where it never is.
    section : of summaries.
    digits : significant digits that a reader is shown.
    size : figures whose product, with these powers, is the size it is compared with; the figure
        is a rounding error below `ROUNDING` times it. Empty: 1.
    claimed : whether `Solution.error` has an estimate of its error.
    total : how the figure of the whole face follows; None where there is none.
    """

    key: str
    label: str
    dimension: Dimension
    sentence: str
    _: KW_ONLY
    symbol: str = ""
    sign: str = ""
    undefined: str = ""
    section: Section = "nip"
    digits: int = 4
    size: Mapping[str, int] = field(default_factory=dict)
    claimed: bool = False
    total: FaceTotal | None = None

    @property
    def name(self) -> str:
        """Attribute of the solution, and key among errors and totals."""
        return self.key.replace(".", "_")

    @property
    def unit(self) -> str:
        """Base unit, in files; "1" for a plain number."""
        return _UNITS[self.dimension].base

    @property
    def shown_unit(self) -> str:
        """The unit that a reader is shown; empty for a plain number."""
        return _UNITS[self.dimension].shown

    @property
    def factor(self) -> float:
        """Factor from the base unit to the unit shown."""
        return _UNITS[self.dimension].factor

    def value(self, solution: Any) -> float | None:
        """The figure of a solution, in its base unit; None where not finite or not defined."""
        return _finite(getattr(solution, self.name))

    def values(self, solution: Any) -> list[float | None] | None:
        """The list of a solution, in its base unit; None where it is not defined."""
        found = getattr(solution, self.name)
        return None if found is None else [_finite(one) for one in found.tolist()]

    def cleaned(self, solution: Any) -> float | None:
        """Return the value of the figure, but 0 where it is a rounding error."""
        value = self.value(solution)
        return value if value is None or abs(value) > self.noise(solution) else 0.0

    def noise(self, result: Any) -> float:
        """Size below which the figure is a rounding error, in its base unit.

        ``result`` is a solution, or a mapping from keys to values.
        """
        level = ROUNDING
        for key, power in self.size.items():
            value = result.get(key) if isinstance(result, Mapping) else getattr(result, key)
            if not value:
                return 0.0
            level *= abs(value) ** power
        return level

    def error(self, solution: Any) -> float | None:
        """Estimated error of the figure, in its base unit; None where none is claimed."""
        return _finite(solution.error.get(self.name)) if self.claimed else None

    def shown_for(self, largest: float) -> Shown:
        """Return the unit for values up to ``largest`` [base unit]: minutes for a long time."""
        least, large = LARGE.get(self.dimension, (inf, None))
        if large is None or abs(largest) < least:
            return Shown(self.shown_unit, self.factor)
        return large

    def number(self, value: float) -> str:
        """Write a value of the base unit in the unit shown, without the unit."""
        return format_quantity(value * self.factor, digits=self.digits)

    def text(self, value: float, digits: int | None = None) -> str:
        """Write a value of the base unit in the unit for its size, with the unit.

        ``digits``: significant digits; None: those of the figure.
        """
        unit, factor = self.shown_for(value)
        number = format_quantity(value * factor, digits=self.digits if digits is None else digits)
        return f"{number} {unit}".rstrip()

    @property
    def axis(self) -> str:
        """Label of an axis in a picture: the label and the unit shown."""
        return self.axis_for(self.label)

    def axis_for(self, name: str) -> str:
        """Return the label of an axis that several curves of this dimension share."""
        return axis_label(name, self.shown_unit)

    @property
    def described(self) -> dict[str, str]:
        """Attributes of a variable of a data set: units, long_name and comment."""
        comment = f"{self.sentence} {self.sign}".rstrip()
        return {"units": self.unit, "long_name": self.label, "comment": comment}


def curve(
    key: str, symbol: str, label: str, dimension: Dimension, sentence: str, sign: str = ""
) -> Figure:
    """Return a curve over x or a field, as the registries list them."""
    return Figure(key, label, dimension, sentence, symbol=symbol, sign=sign)


_AnyFigure = TypeVar("_AnyFigure", bound=Figure)


def by_key(*figures: _AnyFigure) -> Mapping[str, _AnyFigure]:
    """Return figures by their keys, in the order given."""
    return {one.key: one for one in figures}


def _finite(value: float | None) -> float | None:
    return float(value) if value is not None and isfinite(value) else None
