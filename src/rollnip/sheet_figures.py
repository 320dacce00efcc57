"""Registry of the figures of a sheet in the nip, in addition to those of `rollnip.figures`.

A result lists them in its table "sheet" where the nip has a sheet.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite
from typing import Any

from rollnip.figure import Dimension, Figure, by_key, curve

__all__ = ["BENDING_LENGTH", "PULL_FIGURES", "SHEET_FIGURES", "SHEET_PROFILES", "SheetFigure"]


class SheetFigure(Figure):
    """A figure of the sheet, read from an attribute of ``solution.sheet``; None without a sheet."""

    __slots__ = ()

    @property
    def attribute(self) -> str:
        """Name of the attribute of the sheet's result."""
        return self.key.rpartition(".")[2]

    def value(self, solution: Any) -> float | None:
        """Return the value of the figure in its base unit; None where there is no sheet."""
        sheet = solution.sheet
        return None if sheet is None else _finite(getattr(sheet, self.attribute))

    def error(self, solution: Any) -> float | None:
        """Return the estimated error of the figure in its base unit; None where none is claimed."""
        sheet = solution.sheet
        return None if sheet is None else _finite(sheet.error.get(self.attribute))


def _finite(value: float | None) -> float | None:
    return float(value) if value is not None and isfinite(value) else None


_NO_SPEED = "needs `speed`"


def _sheet(
    key: str, symbol: str, label: str, dimension: Dimension, sentence: str, sign: str = ""
) -> SheetFigure:
    undefined = _NO_SPEED if dimension in ("speed", "power per length") else ""
    return SheetFigure(
        key=f"sheet.{key}",
        symbol=symbol,
        label=label,
        dimension=dimension,
        sentence=sentence,
        sign=sign,
        undefined=undefined,
        section="sheet",
        claimed=key in _SHEET_CLAIMED,
    )


_SHEET_CLAIMED = (
    *("creepage_upper", "creepage_lower", "feed_upper", "feed_lower"),
    *("traction_upper", "traction_lower", "tension_max", "tension_min", "strain_max"),
    *("friction_upper", "friction_lower", "nip_width_lower", "peak_pressure_lower"),
    *("speed", "power", "grip_reserve"),
)
_FED = "Positive where the sheet is longer than what rolled off the roller."
_SHEET = (
    _sheet(
        "feed_upper",
        "V_s/V_u - 1",
        "feed over the upper roller",
        "share",
        "Speed of the sheet, free of tension, over that of the upper roller, less 1.",
        _FED,
    ),
    _sheet(
        "feed_lower",
        "V_s/V_l - 1",
        "feed over the lower roller",
        "share",
        "Speed of the sheet, free of tension, over that of the lower roller, less 1.",
        _FED,
    ),
    _sheet("speed", "V_s", "speed of the sheet", "speed", "Speed of the sheet, free of tension."),
    _sheet(
        "creepage_upper",
        r"\xi_u",
        "creepage, upper interface",
        "share",
        "Speed of the upper roller less that of the sheet, over the mean speed of the rollers.",
        "Positive where the roller is faster.",
    ),
    _sheet(
        "creepage_lower",
        r"\xi_l",
        "creepage, lower interface",
        "share",
        "Speed of the sheet less that of the lower roller, over the mean speed of the rollers.",
        "Positive where the sheet is faster.",
    ),
    _sheet(
        "traction_upper",
        "T_u",
        "traction, upper roller",
        "line load",
        "Force along the surface that the upper roller puts on the sheet, per width.",
        "Positive where the roller drives.",
    ),
    _sheet(
        "traction_lower",
        "T_l",
        "traction, lower roller",
        "line load",
        "Force along the surface that the sheet puts on the lower roller, per width.",
        "Positive where the sheet drives.",
    ),
    _sheet(
        "tension_max",
        r"N_\mathrm{max}",
        "largest tension",
        "line load",
        "The largest tension of the sheet in the nip, per width.",
    ),
    _sheet(
        "tension_min",
        r"N_\mathrm{min}",
        "smallest tension",
        "line load",
        "The smallest tension of the sheet in the nip, per width.",
        "Negative where the sheet is pushed.",
    ),
    _sheet(
        "strain_max",
        r"e_\mathrm{max}",
        "largest strain of the sheet",
        "share",
        "The largest strain of the sheet along the nip, in size.",
        "Positive where it is stretched.",
    ),
    _sheet(
        "friction_upper",
        r"D_{\mu u}",
        "friction loss, upper side",
        "power per length",
        "Heat generated where the upper roller slips on the sheet, per width of the face.",
    ),
    _sheet(
        "friction_lower",
        r"D_{\mu l}",
        "friction loss, lower side",
        "power per length",
        "Heat generated where the sheet slips on the lower roller, per width of the face.",
    ),
    _sheet(
        "power",
        "P_s",
        "power into the sheet",
        "power per length",
        "Work against the tensions of the sheet, and the elastic energy that it carries away.",
        "Positive where the rollers put power in.",
    ),
    _sheet(
        "slip_share_upper",
        "s_u",
        "slip share, upper side",
        "share",
        "Share of the nip width over which the upper roller slips on the sheet.",
    ),
    _sheet(
        "slip_share_lower",
        "s_l",
        "slip share, lower side",
        "share",
        "Share of the nip width over which the sheet slips on the lower roller.",
    ),
    _sheet(
        "nip_width_lower",
        "w_l",
        "nip width, lower side",
        "length",
        "Width of the contact of sheet and lower roller; the nip width is that of the upper one.",
    ),
    _sheet(
        "peak_pressure_lower",
        r"p_{0l}",
        "peak pressure, lower side",
        "pressure",
        "Highest pressure between the sheet and the lower roller.",
    ),
    _sheet(
        "grip_reserve",
        r"\Delta T",
        "grip reserve",
        "line load",
        "Change of the pull on the sheet that makes it slip through the nip, per width.",
    ),
)

SHEET_FIGURES: Mapping[str, Figure] = {one.key: one for one in _SHEET}
"""Figures of a sheet by key; a result has them where the nip has a sheet."""

PULL_FIGURES: Mapping[str, Figure] = by_key(
    Figure(
        "smallest", "smallest pull that holds", "line load", "Pull below which the sheet slips."
    ),
    Figure("largest", "largest pull that holds", "line load", "Pull above which the sheet slips."),
)
"""Limits of the pull on the sheet between which it does not slip through the nip, by key."""

BENDING_LENGTH = Figure(
    "bending_length",
    "reach of the bending stiffness",
    "length",
    "Length over which the bending stiffness of the sheet acts.",
)
"""How far along the nip the bending stiffness of a sheet acts; files hold it."""

SHEET_PROFILES: Mapping[str, Figure] = {
    one.key: one
    for one in (
        curve("x", "x", "x", "length", "Place along the nip, towards the leading edge (inlet)."),
        curve(
            "shear_lower", "q_l", "shear, lower side", "pressure", "Shear on the sheet's underside."
        ),
        curve("tension", "N", "tension", "line load", "Tension of the sheet, per width."),
        curve("strain", "e", "strain of the sheet", "share", "Strain of the sheet's middle."),
        curve(
            "slip_velocity_lower",
            "s_l",
            "slip velocity, lower side",
            "speed",
            "Velocity of the sheet relative to the lower surface, along +x.",
        ),
        curve(
            "pressure_lower",
            "p_l",
            "pressure, lower side",
            "pressure",
            "Pressure between the sheet and the lower roller.",
        ),
        curve(
            "height",
            "y",
            "height of the sheet",
            "length",
            "Height of the sheet, its thickness left out.",
        ),
    )
}
"""Distributions of the sheet's quantities over x, by key."""
