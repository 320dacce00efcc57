"""The registry of figures: what a solution reports, with symbol, unit, label and meaning.

JSON, netCDF, tables, summaries, pictures, the web page and the documentation read it, so that a
figure is described once. A figure of a result is added here and as an attribute of `Solution`; an
error claim for it is the word ``claimed=True`` here and a key of `Solution.error`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import isfinite
from typing import Any, Literal, NamedTuple

from rollnip._units import format_quantity

__all__ = [
    "CLAIMED",
    "FIGURES",
    "INTERFACE_FIGURES",
    "PROFILES",
    "ROUNDING",
    "Dimension",
    "Figure",
    "Section",
    "Total",
]

Dimension = Literal[
    "length",
    "line load",
    "pressure",
    "force",
    "time",
    "speed",
    "ratio",
    "share",
    "power per length",
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
    "force": _Units("N", "N mm/mm", 1.0),
    "time": _Units("s", "ms", 1e3),
    "speed": _Units("mm/s", "mm/s", 1.0),
    "ratio": _Units("1", "", 1.0),
    "share": _Units("1", "%", 100.0),
    "power per length": _Units("N/s", "mW/mm", 1.0),
}


class Total(NamedTuple):
    """The figure of the whole face: value times face width [mm] times ``factor``, in ``unit``."""

    unit: str
    factor: float


_NEWTON, _NEWTON_METRE, _WATT = Total("N", 1.0), Total("N m", 1e-3), Total("W", 1e-3)


@dataclass(frozen=True, slots=True, kw_only=True)
class Figure:
    """One figure of a result.

    Attributes
    ----------
    key : its path in the result JSON, such as "dissipation.friction".
    symbol : as in the theory, in TeX.
    label : its name, in lower case.
    dimension : what kind of number it is; decides the units.
    sentence : what it is, in one sentence.
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
    symbol: str
    label: str
    dimension: Dimension
    sentence: str
    sign: str = ""
    undefined: str = ""
    section: Section = "nip"
    digits: int = 4
    size: Mapping[str, int] = field(default_factory=dict)
    claimed: bool = False
    total: Total | None = None

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

    def number(self, value: float) -> str:
        """Write a value of the base unit in the unit shown, without the unit."""
        return format_quantity(value * self.factor, digits=self.digits)


def _finite(value: float | None) -> float | None:
    return float(value) if value is not None and isfinite(value) else None


_UPPER_DRIVES = "Positive where the upper roller drives."
_AXLE = "Positive where the axle puts power in."
_SPEED = "needs `speed`"
_MOMENT = {"load": 1, "nip_width": 1}
_POWER = {"load": 1, "nip_width": 1, "dwell_time": -1}

_SCALARS: tuple[Figure, ...] = (
    Figure(
        key="load",
        symbol="F",
        label="line load",
        dimension="line load",
        sentence="Force that presses the rollers together, per width of the face.",
        claimed=True,
        total=_NEWTON,
    ),
    Figure(
        key="approach",
        symbol=r"\delta",
        label="approach",
        dimension="length",
        sentence="How far the axles come together after first touch.",
        sign="Positive where the rollers are pressed together.",
        undefined="not defined with a half-space core",
        claimed=True,
    ),
    Figure(
        key="traction",
        symbol="T",
        label="traction",
        dimension="line load",
        sentence="Force along the surface that the upper roller puts on the lower one, per width.",
        sign=_UPPER_DRIVES,
        section="drive",
        size={"load": 1},
        claimed=True,
        total=_NEWTON,
    ),
    Figure(
        key="creepage",
        symbol=r"\xi",
        label="creepage",
        dimension="share",
        sentence="Difference of the circumferential speeds of the rollers over their mean.",
        sign="Positive where the upper roller is the faster one.",
        undefined="not defined without friction",
        section="drive",
        claimed=True,
    ),
    Figure(
        key="speed_ratio",
        symbol="V_u/V_l",
        label="speed ratio",
        dimension="ratio",
        sentence="Circumferential speed of the upper roller over that of the lower one.",
        undefined="not defined without friction",
        section="drive",
        digits=5,
        claimed=True,
    ),
    Figure(
        key="nip_width",
        symbol="2a",
        label="nip width",
        dimension="length",
        sentence="Length of the contact along the circumference, from the outermost trailing to "
        "the outermost leading edge.",
        claimed=True,
    ),
    Figure(
        key="dwell_time",
        symbol="2a/V",
        label="dwell time",
        dimension="time",
        sentence="How long a point of the surface is in the nip.",
        undefined=_SPEED,
        claimed=True,
    ),
    Figure(
        key="peak_pressure",
        symbol=r"p_\mathrm{max}",
        label="peak pressure",
        dimension="pressure",
        sentence="The highest pressure in the nip.",
        claimed=True,
    ),
    Figure(
        key="peak_pressure_x",
        symbol=r"x(p_\mathrm{max})",
        label="peak pressure at x",
        dimension="length",
        sentence="Where the pressure is highest, from the line of centres.",
        sign="Positive towards the leading edge (inlet).",
        size={"nip_width": 1},
        claimed=True,
    ),
    Figure(
        key="mean_pressure",
        symbol=r"\bar p",
        label="mean pressure",
        dimension="pressure",
        sentence="Line load over the length that touches.",
        claimed=True,
    ),
    Figure(
        key="torque_upper",
        symbol="M_u",
        label="torque, upper axle",
        dimension="force",
        sentence="Driving torque on the upper axle, per width of the face.",
        sign=_AXLE,
        undefined="not defined for a plane or a measured profile",
        section="drive",
        size=_MOMENT,
        claimed=True,
        total=_NEWTON_METRE,
    ),
    Figure(
        key="torque_lower",
        symbol="M_l",
        label="torque, lower axle",
        dimension="force",
        sentence="Driving torque on the lower axle, per width of the face.",
        sign=_AXLE,
        undefined="not defined for a plane or a measured profile",
        section="drive",
        size=_MOMENT,
        claimed=True,
        total=_NEWTON_METRE,
    ),
    Figure(
        key="rolling_resistance",
        symbol=r"f_r",
        label="rolling resistance",
        dimension="ratio",
        sentence="Viscous loss over line load times speed.",
        section="losses",
        claimed=True,
    ),
    Figure(
        key="dissipation.friction",
        symbol=r"D_\mu",
        label="friction loss",
        dimension="power per length",
        sentence="Heat made where the surfaces slip on each other, per width of the face.",
        undefined=_SPEED,
        section="losses",
        size=_POWER,
        claimed=True,
        total=_WATT,
    ),
    Figure(
        key="dissipation.viscous",
        symbol=r"D_v",
        label="viscous loss",
        dimension="power per length",
        sentence="Heat made inside viscoelastic layers, per width of the face.",
        undefined=_SPEED,
        section="losses",
        size=_POWER,
        claimed=True,
        total=_WATT,
    ),
    Figure(
        key="max_surface_strain",
        symbol=r"\varepsilon_\mathrm{max}",
        label="largest surface strain",
        dimension="share",
        sentence="Most that either surface is stretched or compressed along the nip, as a mean "
        "over one element.",
        undefined="not looked for",
    ),
)


def _curve(key: str, symbol: str, label: str, dimension: Dimension, sentence: str) -> Figure:
    return Figure(key=key, symbol=symbol, label=label, dimension=dimension, sentence=sentence)


_CURVES: tuple[Figure, ...] = (
    _curve("x", "x", "x", "length", "Place along the nip, towards the leading edge (inlet)."),
    _curve("pressure", "p", "pressure", "pressure", "Pressure, positive in compression."),
    _curve("shear", "q", "shear", "pressure", "Shear on the upper roller, along +x."),
    _curve("gap", "g", "gap", "length", "Distance of the surfaces."),
    _curve(
        "slip_velocity",
        "s",
        "slip velocity",
        "speed",
        "Velocity of the upper surface relative to the lower one, along +x.",
    ),
    _curve(
        "strain_upper",
        r"\varepsilon_u",
        "strain, upper surface",
        "share",
        "Strain of the upper surface along the nip, positive where it is stretched.",
    ),
    _curve(
        "strain_lower",
        r"\varepsilon_l",
        "strain, lower surface",
        "share",
        "Strain of the lower surface along the nip, positive where it is stretched.",
    ),
    _curve("speed_upper", "v_u", "speed, upper surface", "speed", "Speed of the upper surface."),
    _curve("speed_lower", "v_l", "speed, lower surface", "speed", "Speed of the lower surface."),
)

FIGURES: Mapping[str, Figure] = {one.key: one for one in _SCALARS}
"""The scalar figures of a result by key, in the order of the JSON."""

CLAIMED: Mapping[str, Figure] = {one.name: one for one in _SCALARS if one.claimed}
"""Those whose error is estimated, by name."""

PROFILES: Mapping[str, Figure] = {one.key: one for one in _CURVES}
"""The distributions over x of a result by key, in the order of the JSON."""

INTERFACE_FIGURES = (
    "depth", "shear_min", "shear_min_x", "shear_max", "shear_max_x", "peel_min", "peel_min_x",
    "peel_max", "peel_max_x", "shear_range", "peel_range", "von_mises_max",
)  # fmt: skip
"""The numbers of an ``InterfaceStress`` that stand in files."""
