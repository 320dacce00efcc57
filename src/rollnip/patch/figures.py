"""The registry of the figures of a patch: scalars, and fields over the grid.

Summaries, JSON, netCDF, ParaView, tables of sweeps and the documentation read it. A figure is added
here and as an attribute of `PatchSolution`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite
from typing import Any, Literal

When = Literal["always", "friction", "losses", "speed"]


@dataclass(frozen=True, slots=True)
class PatchFigure:
    """One figure or field of a patch.

    Attributes
    ----------
    key : attribute of `PatchSolution`, and key of the JSON.
    symbol : as in the theory, in TeX.
    label : its name, in lower case.
    unit : base unit, in files; "1" for a plain number.
    sentence : what it is, in one sentence.
    when : in which summaries it stands: always, or of patches with friction, with viscoelastic
        layers (losses), or with a speed.
    claimed : whether its error is estimated.
    shown_unit : the unit that a reader is shown; empty: the base unit.
    factor : from the base unit to the unit shown.
    """

    key: str
    symbol: str
    label: str
    unit: str
    sentence: str
    when: When = "always"
    claimed: bool = True
    shown_unit: str = ""
    factor: float = 1.0

    def value(self, solution: Any) -> float | None:
        """Return the figure of a patch; None where not finite or not defined."""
        return _finite(getattr(solution, self.key))

    def error(self, solution: Any) -> float | None:
        """Return its estimated error in the base unit; None where none is claimed."""
        return _finite(solution.error.get(self.key)) if self.claimed else None


def _finite(value: float | None) -> float | None:
    return float(value) if value is not None and isfinite(value) else None


def _of(*figures: PatchFigure) -> Mapping[str, PatchFigure]:
    return {one.key: one for one in figures}


_F = PatchFigure

PATCH_FIGURES: Mapping[str, PatchFigure] = _of(
    _F("load", "F", "load", "N", "Force that presses the rollers together."),
    _F("approach", r"\delta", "approach", "mm", "How far the axles come together after touch."),
    _F("length", "2a", "length", "mm", "Length of the patch along the rolling direction."),
    _F("width", "2b", "width", "mm", "Width of the patch along the axes."),
    _F("area", "A", "area", "mm2", "Area that touches."),
    _F("peak_pressure", r"p_\mathrm{max}", "peak pressure", "MPa", "The highest pressure."),
    _F("traction_x", "F_x", "traction along x", "N", "Force on the upper roller along +x.",
       "friction"),
    _F("traction_y", "F_y", "traction along y", "N", "Force on the upper roller along +y.",
       "friction"),
    _F("spin_moment", "M", "spin moment", "N mm",
       "Moment of the shear on the upper roller about the normal, from +x to +y.", "friction"),
    _F("creepage", r"\xi", "creepage", "1",
       "Speed of the upper roller less that of the lower along x, over the rolling speed.",
       "friction", shown_unit="%", factor=100.0),
    _F("lateral_creepage", r"\eta", "lateral creepage", "1",
       "Speed of the upper roller less that of the lower along y, over the rolling speed.",
       "friction", shown_unit="%", factor=100.0),
    _F("spin", r"\varphi", "spin", "1/mm", "Rotation about the normal per length rolled.",
       "friction", claimed=False),
    _F("load_centre", "x_F", "load centre", "mm",
       "Place of the load's resultant along x, from the line of centres.", "losses"),
    _F("slip_share", "A_s/A", "slipping share", "1", "Share of the patch that slips.", "friction",
       claimed=False, shown_unit="%", factor=100.0),
    _F("viscous_resistance", "W_v", "viscous resistance", "N",
       "Power lost inside viscoelastic layers over the rolling speed.", "losses"),
    _F("friction_resistance", r"W_\mu", "friction resistance", "N",
       "Power that slip turns into heat over the rolling speed.", "friction"),
    _F("rolling_resistance", "W", "rolling resistance", "N",
       "All power that is lost over the rolling speed.", "losses"),
    _F("dissipation_friction", r"D_\mu", "friction loss", "mW", "Power that slip turns into heat.",
       "speed", claimed=False, shown_unit="W", factor=1e-3),
    _F("dissipation_viscous", "D_v", "viscous loss", "mW",
       "Power lost inside viscoelastic layers.", "speed", claimed=False, shown_unit="W",
       factor=1e-3),
    _F("torque_upper", "M_u", "torque, upper axle", "N mm",
       "Driving torque on the upper axle, positive where it puts power in.", "losses",
       claimed=False, shown_unit="N m", factor=1e-3),
    _F("torque_lower", "M_l", "torque, lower axle", "N mm",
       "Driving torque on the lower axle, positive where it puts power in.", "losses",
       claimed=False, shown_unit="N m", factor=1e-3),
)  # fmt: skip
"""The scalar figures of a patch by key, in the order of the JSON."""

CLAIMED: Mapping[str, PatchFigure] = {k: one for k, one in PATCH_FIGURES.items() if one.claimed}
"""Those whose error is estimated."""

PATCH_FIELDS: Mapping[str, PatchFigure] = _of(
    _F("pressure", "p", "contact pressure", "MPa", "Pressure, positive in compression."),
    _F("shear_x", "q_x", "shear along x", "MPa", "Shear traction on the upper roller along x."),
    _F("shear_y", "q_y", "shear along y", "MPa", "Shear traction on the upper roller along y."),
    _F("slip_x", "s_x/V", "slip along x", "1", "Slip velocity over rolling speed, along x."),
    _F("slip_y", "s_y/V", "slip along y", "1", "Slip velocity over rolling speed, along y."),
    _F("gap", "g", "gap", "mm", "Gap of the deformed surfaces."),
    _F("state", "", "state", "1", "0 apart, 1 stick, 2 slip."),
)
"""The fields of a patch over its grid by key, in the order of the JSON."""


def is_shown(figure: PatchFigure, solution: Any) -> bool:
    """Return whether a figure stands in the summary of a patch."""
    patch, value = solution.patch, figure.value(solution)
    meant = {
        "always": True,
        "friction": patch.friction > 0.0,
        "losses": patch.is_viscoelastic,
        "speed": bool(value),
    }
    return value is not None and bool(meant[figure.when])
