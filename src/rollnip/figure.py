"""One figure of a result: the record from which all registries of figures are made.

Units and digits are defined here alone. The registries are `rollnip.figures` (the nip, its curves
and its interfaces), `rollnip.sheet_figures`, and `figures` of `rollnip.face`, `rollnip.heat` and
`rollnip.patch`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass, field, replace
from math import inf, isfinite, pi
from typing import Any, Literal, NamedTuple, Self, TypeVar, cast, get_args

from rollnip._errors import InvalidInputError
from rollnip._units import Dimension as InputDimension
from rollnip._units import conversions, format_quantity

__all__ = [
    "LARGE",
    "LOST",
    "ROUNDING",
    "US",
    "US_NAMES",
    "US_TOTALS",
    "Dimension",
    "FaceTotal",
    "Figure",
    "Section",
    "Shown",
    "Units",
    "axis_label",
    "by_key",
    "checked_units",
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
Units = Literal["metric", "us"]

# Newton's method leaves the ends of zones off by some 1e-9 of the nip width, and not by the same on
# both sides; a loss of 1e-8 of load times speed, on the other hand, is a result.
ROUNDING = 5e-9
"""Share of its size below which a figure is a rounding error.

In free rolling, torques, traction and friction losses are exactly 0, and the computed values are at
most 4e-13 of their size. The smallest figures that are results (losses of a viscoelastic covering
at low speed) are 1e-8 of their size and more.
"""


LOST = 0.05
"""Share of its own estimated error below which nothing is left of a figure: readers see 0.

Such a figure says nothing beside its error. A figure that is never negative is exempt: losses at
low speed are right to 0.1 % where their claimed errors are many times the losses.
"""


class _Units(NamedTuple):
    base: str
    shown: str
    factor: float


# Base unit, the unit that a reader sees, and the factor from the base unit to it.
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
    "duration": _Units("s", "s", 1.0),  # of tests and records; dwell times ("time") are in ms
    "compliance": _Units("1/MPa", "1/MPa", 1.0),
}


def checked_units(name: str, units: object) -> Units:
    """Return the system of units that a reader asked for, or raise InvalidInputError."""
    if units not in get_args(Units):
        raise InvalidInputError(f'`{name}` must be "metric" or "us", got {units!r}.')
    return cast("Units", units)


def axis_label(name: str, unit: str) -> str:
    """Return the label of an axis or a column: a name, with its unit in brackets if it has one."""
    return name if unit in ("", "1") else f"{name} [{unit}]"


class Shown(NamedTuple):
    """A unit that a reader sees: value in this unit = value in the base unit * factor + offset."""

    unit: str
    factor: float
    offset: float = 0.0


US_NAMES: Mapping[InputDimension, str] = {
    "length": "in",
    "line load": "pli",
    "force": "lbf in/in",
    "pressure": "psi",
    "speed": "fpm",
    "temperature": "degF",
    "turn per length": "1/in",
}
"""US customary units of the dimensions that cases and results share, as a case file spells them."""


def _us(dimension: InputDimension) -> Shown:
    """Return the US unit of a dimension that case files have, too."""
    name = US_NAMES[dimension]
    scale, offset = conversions(dimension)[name]
    return Shown(name.replace("deg", "°"), 1.0 / scale, -offset / scale)


_INCH = conversions("length")["in"][0]  # mm
_POUND_FORCE = conversions("force")["lbf"][0]  # N
_HORSEPOWER = 550.0 * 12.0 * _INCH * _POUND_FORCE  # mW; 550 ft lbf/s, by which drives are sized
_BY_LENGTH = Shown("hp/ft", 12.0 * _INCH / _HORSEPOWER)

US: Mapping[Dimension, Shown] = {
    "length": _us("length"),
    "line load": _us("line load"),
    "force": _us("force"),
    "pressure": _us("pressure"),
    "speed": _us("speed"),
    "temperature": _us("temperature"),
    "turn per length": _us("turn per length"),
    "roller force": Shown("lbf", 1.0 / _POUND_FORCE),
    "moment": Shown("lbf·in", 1.0 / (_POUND_FORCE * _INCH)),
    "area": Shown("in²", 1.0 / _INCH**2),
    "feed per metre": Shown("in/100 ft", 1.2),
    "power": Shown("hp", 1.0 / _HORSEPOWER),
    "power per length": _BY_LENGTH,
    "heat per length": _BY_LENGTH,
    "power per volume": Shown("hp/in³", _INCH**3 / _HORSEPOWER),
}
"""The US customary unit of each dimension; dimensions that are not listed keep the metric one."""
US_TOTALS: Mapping[str, Shown] = {
    "N": Shown("lbf", 1.0 / _POUND_FORCE),
    "N m": Shown("lbf·in", 1e3 / (_POUND_FORCE * _INCH)),
    "W": Shown("hp", 1e3 / _HORSEPOWER),
}
"""The US customary units of figures of the whole face, by their metric ones."""
LARGE: Mapping[Dimension, tuple[float, Shown]] = {"duration": (180.0, Shown("min", 1.0 / 60.0))}
"""The size [base unit] from which on a dimension is shown in a larger unit, and that unit."""


class FaceTotal(NamedTuple):
    """The total over the face: value times face width [mm] times ``factor``, in ``unit``."""

    unit: str
    factor: float

    def in_units(self, units: Units) -> FaceTotal:
        """Return the total in metric or US units."""
        if units == "metric":
            return self
        shown = US_TOTALS[self.unit]
        return FaceTotal(shown.unit, self.factor * shown.factor)


@dataclass(frozen=True, slots=True)
class Figure:
    """One figure of a result.

    Attributes
    ----------
    key : its path in the result JSON, such as "dissipation.friction".
    label : its name, in lower case.
    dimension : the kind of quantity, which decides the units.
    sentence : what it is, in one sentence.
    symbol : its symbol in the theory, in TeX; empty where the theory has none.
    sign : what a positive value means; empty where it is never negative.
    undefined : why it may be null; empty where it never is.
    section : the section of summaries in which it stands.
    digits : significant digits that a reader is shown.
    size : figures, with their powers, whose product is the natural size of this one. Below
        `ROUNDING` times that size the figure is a rounding error. Empty: the size is 1.
    claimed : whether `Solution.error` has an estimate of its error.
    total : how the figure of the whole face follows; None where there is none.
    units : the system of units that a reader is shown.
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
    units: Units = "metric"

    def in_units(self, units: Units) -> Self:
        """Return the same figure, to be shown in metric or US units."""
        return self if units == self.units else replace(self, units=units)

    @property
    def shown(self) -> Shown:
        """The unit that a reader is shown."""
        metric = _UNITS[self.dimension]
        known = US if self.units == "us" else {}
        return known.get(self.dimension, Shown(metric.shown, metric.factor))

    @property
    def name(self) -> str:
        """Its name as an attribute of the solution, and as a key among errors and totals."""
        return self.key.replace(".", "_")

    @property
    def unit(self) -> str:
        """Base unit, used in files; "1" for a plain number."""
        return _UNITS[self.dimension].base

    @property
    def shown_unit(self) -> str:
        """The unit that a reader is shown; empty for a plain number."""
        return self.shown.unit

    @property
    def factor(self) -> float:
        """Factor from the base unit to the unit shown, which holds for differences."""
        return self.shown.factor

    def converted(self, value: float) -> float:
        """Return a value, given in the base unit, in the unit shown."""
        return value * self.shown.factor + self.shown.offset

    def value(self, solution: Any) -> float | None:
        """Return the figure of a solution, in its base unit; None where not finite or undefined."""
        return _finite(getattr(solution, self.name))

    def values(self, solution: Any) -> list[float | None] | None:
        """Return an array of a solution as a list in the base unit; None where it is undefined."""
        found = getattr(solution, self.name)
        return None if found is None else [_finite(one) for one in found.tolist()]

    def cleaned(self, solution: Any) -> float | None:
        """Return the value of the figure, or 0 where it is nothing but rounding or error."""
        value = self.value(solution)
        if value is None:
            return None
        return 0.0 if self.is_nothing(value, self.error(solution) or 0.0, solution) else value

    @property
    def has_sign(self) -> bool:
        """Whether it can be negative."""
        return bool(self.sign)

    def is_nothing(self, value: float, error: float, result: Any) -> bool:
        """Return whether a value is nothing but rounding or error, by `ROUNDING` and `LOST`.

        ``result`` is as in `noise`; ``error`` is the estimated error of the value, 0 if unknown.
        """
        lost = LOST * error if self.has_sign else 0.0
        return abs(value) <= max(self.noise(result), lost)

    def noise(self, result: Any) -> float:
        """Return the size below which the figure is a rounding error, in its base unit.

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
        """Return the estimated error of the figure in its base unit; None where none is claimed."""
        return _finite(solution.error.get(self.name)) if self.claimed else None

    def shown_for(self, largest: float) -> Shown:
        """Return the unit for values up to ``largest`` [base unit]; long times are in minutes."""
        least, large = LARGE.get(self.dimension, (inf, None))
        if large is None or abs(largest) < least:
            return self.shown
        return large

    def number(self, value: float) -> str:
        """Return a value, given in the base unit, as text in the unit shown, without the unit."""
        return format_quantity(self.converted(value), digits=self.digits)

    def text(self, value: float, digits: int | None = None) -> str:
        """Return a value, given in the base unit, as text in the unit that suits its size.

        ``digits``: significant digits; None: those of the figure.
        """
        unit, factor, offset = self.shown_for(value)
        digits = self.digits if digits is None else digits
        number = format_quantity(value * factor + offset, digits=digits)
        return f"{number} {unit}".rstrip()

    @property
    def axis(self) -> str:
        """Label of a plot axis: the label and the unit shown."""
        return self.axis_for(self.label)

    def axis_for(self, name: str) -> str:
        """Return the label of an axis shared by several curves of this dimension."""
        return axis_label(name, self.shown_unit)

    @property
    def described(self) -> dict[str, str]:
        """Attributes of this figure as a variable of a data set: units, long_name and comment."""
        comment = f"{self.sentence} {self.sign}".rstrip()
        return {"units": self.unit, "long_name": self.label, "comment": comment}


def curve(
    key: str, symbol: str, label: str, dimension: Dimension, sentence: str, sign: str = ""
) -> Figure:
    """Return the figure for a curve over x or for a field, as the registries list them."""
    return Figure(key, label, dimension, sentence, symbol=symbol, sign=sign)


_AnyFigure = TypeVar("_AnyFigure", bound=Figure)


def by_key(*figures: _AnyFigure) -> Mapping[str, _AnyFigure]:
    """Return a mapping from keys to figures, in the order given."""
    return {one.key: one for one in figures}


def _finite(value: float | None) -> float | None:
    return float(value) if value is not None and isfinite(value) else None
