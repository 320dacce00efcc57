"""The registry of the figures of a patch: scalars, and fields over the grid.

Summaries, JSON, netCDF, ParaView, tables of sweeps and the documentation all read it. To add a
figure, add it here and as an attribute of `PatchSolution`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass
from typing import Any, Literal

from rollnip.figure import Figure, by_key

When = Literal["always", "friction", "losses", "speed"]


@dataclass(frozen=True, slots=True)
class PatchFigure(Figure):
    """One figure or field of a patch.

    Attributes
    ----------
    when : in which summaries it stands: in all, or in those of patches with friction, with
        viscoelastic layers (losses), or with a speed.
    """

    _: KW_ONLY
    when: When = "always"


_F = PatchFigure

PATCH_FIGURES: Mapping[str, PatchFigure] = by_key(
    _F(
        "load",
        "load",
        "roller force",
        "Force that presses the rollers together.",
        symbol="F",
        claimed=True,
    ),
    _F(
        "approach",
        "approach",
        "length",
        "How far the axles come together after touch.",
        symbol=r"\delta",
        claimed=True,
    ),
    _F(
        "length",
        "length along rolling",
        "length",
        "Length of the patch along the rolling direction.",
        symbol="2a",
        claimed=True,
    ),
    _F(
        "width",
        "width along the axes",
        "length",
        "Width of the patch along the axes.",
        symbol="2b",
        claimed=True,
    ),
    _F("area", "area", "area", "Area that touches.", symbol="A", claimed=True),
    _F(
        "peak_pressure",
        "peak pressure",
        "pressure",
        "The highest pressure.",
        symbol=r"p_\mathrm{max}",
        claimed=True,
    ),
    _F(
        "traction_x",
        "traction along x",
        "roller force",
        "Force on the upper roller along +x.",
        symbol="F_x",
        claimed=True,
        when="friction",
    ),
    _F(
        "traction_y",
        "traction along y",
        "roller force",
        "Force on the upper roller along +y.",
        symbol="F_y",
        claimed=True,
        when="friction",
    ),
    _F(
        "spin_moment",
        "spin moment",
        "moment",
        "Moment of the shear on the upper roller about the normal, from +x to +y.",
        symbol="M",
        claimed=True,
        when="friction",
    ),
    _F(
        "creepage",
        "creepage",
        "share",
        "Speed of the upper roller less that of the lower along x, over the rolling speed.",
        symbol=r"\xi",
        claimed=True,
        when="friction",
    ),
    _F(
        "lateral_creepage",
        "lateral creepage",
        "share",
        "Speed of the upper roller less that of the lower along y, over the rolling speed.",
        symbol=r"\eta",
        claimed=True,
        when="friction",
    ),
    _F(
        "spin",
        "spin",
        "turn per length",
        "Rotation about the normal per length rolled.",
        symbol=r"\varphi",
        when="friction",
    ),
    _F(
        "load_centre",
        "load centre",
        "length",
        "Place of the load's resultant along x, from the line of centres.",
        symbol="x_F",
        claimed=True,
        when="losses",
    ),
    _F(
        "slip_share",
        "slipping share",
        "share",
        "Share of the patch that slips.",
        symbol="A_s/A",
        when="friction",
    ),
    _F(
        "viscous_resistance",
        "viscous resistance",
        "roller force",
        "Power lost inside viscoelastic layers over the rolling speed.",
        symbol="W_v",
        claimed=True,
        when="losses",
    ),
    _F(
        "friction_resistance",
        "friction resistance",
        "roller force",
        "Power that slip turns into heat over the rolling speed.",
        symbol=r"W_\mu",
        claimed=True,
        when="friction",
    ),
    _F(
        "rolling_resistance",
        "rolling resistance",
        "roller force",
        "All power that is lost over the rolling speed.",
        symbol="W",
        claimed=True,
        when="losses",
    ),
    _F(
        "dissipation_friction",
        "friction loss",
        "power",
        "Power that slip turns into heat.",
        symbol=r"D_\mu",
        when="speed",
    ),
    _F(
        "dissipation_viscous",
        "viscous loss",
        "power",
        "Power lost inside viscoelastic layers.",
        symbol="D_v",
        when="speed",
    ),
    _F(
        "torque_upper",
        "torque, upper axle",
        "moment",
        "Driving torque on the upper axle, positive where it puts power in.",
        symbol="M_u",
        when="losses",
    ),
    _F(
        "torque_lower",
        "torque, lower axle",
        "moment",
        "Driving torque on the lower axle, positive where it puts power in.",
        symbol="M_l",
        when="losses",
    ),
)
"""The scalar figures of a patch by key, in the order of the JSON."""

CLAIMED: Mapping[str, PatchFigure] = {k: one for k, one in PATCH_FIGURES.items() if one.claimed}
"""The scalar figures whose error is estimated."""

PATCH_FIELDS: Mapping[str, PatchFigure] = by_key(
    _F("pressure", "pressure", "pressure", "Pressure, positive in compression.", symbol="p"),
    _F(
        "shear_x",
        "shear along x",
        "pressure",
        "Shear traction on the upper roller along x.",
        symbol="q_x",
    ),
    _F(
        "shear_y",
        "shear along y",
        "pressure",
        "Shear traction on the upper roller along y.",
        symbol="q_y",
    ),
    _F(
        "slip_x",
        "slip along x",
        "ratio",
        "Slip velocity over rolling speed, along x.",
        symbol="s_x/V",
    ),
    _F(
        "slip_y",
        "slip along y",
        "ratio",
        "Slip velocity over rolling speed, along y.",
        symbol="s_y/V",
    ),
    _F("gap", "gap", "length", "Gap of the deformed surfaces.", symbol="g"),
    _F("state", "state", "ratio", "0 apart, 1 stick, 2 slip."),
)
"""The fields of a patch over its grid by key, in the order of the JSON."""

PATCH_PLACES: Mapping[str, PatchFigure] = by_key(
    _F("x", "x", "length", "Place along rolling, towards the leading edge (inlet)."),
    _F("y", "y", "length", "Place along the axis."),
)
"""The coordinates of a patch by key."""


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
