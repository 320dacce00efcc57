"""The registry of the figures of a face: scalars, and lists over y.

JSON, netCDF, tables of sweeps and the documentation read it. A figure of a face is added here and
as an attribute of `FaceSolution`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite
from typing import Any

from rollnip._units import format_quantity


@dataclass(frozen=True, slots=True)
class FaceFigure:
    """One figure of a face.

    Attributes
    ----------
    key : attribute of `FaceSolution`, and key of the JSON.
    label : its name, in lower case.
    unit : base unit, in files; "1" for a plain number.
    sentence : what it is, in one sentence.
    shown_unit : the unit that a reader is shown; empty: the base unit.
    factor : from the base unit to the unit shown.
    """

    key: str
    label: str
    unit: str
    sentence: str
    shown_unit: str = ""
    factor: float = 1.0

    def value(self, solution: Any) -> float | None:
        """Return the figure of a face; None where not finite or not defined."""
        found = getattr(solution, self.key)
        return float(found) if found is not None and isfinite(found) else None

    def values(self, solution: Any) -> list[float | None] | None:
        """Return the list of a face over y; None where it is not defined."""
        found = getattr(solution, self.key)
        if found is None:
            return None
        return [one if isfinite(one) else None for one in found.tolist()]

    def text(self, value: float) -> str:
        """Write a value of the base unit in the unit shown, with it."""
        unit = self.shown_unit or ("" if self.unit == "1" else self.unit)
        return format_quantity(value * self.factor, unit, digits=4)


def _of(*figures: FaceFigure) -> Mapping[str, FaceFigure]:
    return {one.key: one for one in figures}


_F = FaceFigure

FACE_FIGURES: Mapping[str, FaceFigure] = _of(
    _F("mean_load", "mean line load", "N/mm", "Load of the whole nip over the length of the face."),
    _F("total_load", "total load", "N", "Load of the whole nip."),
    _F("creepage", "creepage of the face", "1", "Creepage of both rollers as wholes.", "%", 100.0),
    _F("total_traction", "total traction", "N", "Tangential force of the whole nip."),
    _F(
        "total_torque_upper", "torque, upper axle", "N mm",
        "Driving torque on the upper axle, positive where it puts power in.", "N m", 1e-3,
    ),
    _F(
        "total_torque_lower", "torque, lower axle", "N mm",
        "Driving torque on the lower axle, positive where it puts power in.", "N m", 1e-3,
    ),
    _F("power_upper", "power, upper axle", "N mm/s", "Power of the upper axle.", "W", 1e-3),
    _F("power_lower", "power, lower axle", "N mm/s", "Power of the lower axle.", "W", 1e-3),
    _F(
        "total_friction_loss", "friction loss", "N mm/s",
        "Heat made where the surfaces slip, over the whole face.", "W", 1e-3,
    ),
    _F(
        "total_viscous_loss", "viscous loss", "N mm/s",
        "Heat made inside the layers, over the whole face.", "W", 1e-3,
    ),
    _F("evenness", "smallest/largest load", "1", "Smallest line load over the largest."),
    _F(
        "largest_departure", "departs from the mean by", "1",
        "Largest departure of the line load from its mean, over the mean.", "%", 100.0,
    ),
    _F(
        "even_share", "within 10 % of mean", "1",
        "Share of the face whose line load is within 10 % of the mean.", "% of the face", 100.0,
    ),
    _F(
        "largest_scrub", "largest scrub", "N/mm",
        "Largest departure of the traction from its mean: there the surfaces rub each other.",
    ),
    _F(
        "added_length", "both ends add", "mm",
        "Length of face that both ends add to the load; negative where they carry less.",
    ),
    _F(
        "bearing_offset", "bearing offset", "mm",
        "How much further the upper bearing at y > 0 has come than the other.",
    ),
)  # fmt: skip
"""The scalar figures of a face by key."""

FACE_PROFILES: Mapping[str, FaceFigure] = _of(
    _F("y", "y", "mm", "Place along the face, from its middle."),
    _F("load", "line load", "N/mm", "Line load; 0 where the nip is open."),
    _F("approach", "approach", "mm", "Approach of the surfaces; negative where the nip is open."),
    _F("nip_width", "nip width", "mm", "Length of the contact along the circumference."),
    _F("peak_pressure", "peak pressure", "MPa", "The highest pressure of the cross-section."),
    _F("traction", "traction", "N/mm", "Traction, positive where the upper roller drives."),
    _F("local_creepage", "local creepage", "1", "Creepage with the local radii."),
    _F("slip_width", "slip", "mm", "Part of the nip width over which the surfaces slip."),
    _F("torque_upper", "torque, upper axle", "N", "Driving torque on the upper axle per length."),
    _F("torque_lower", "torque, lower axle", "N", "Driving torque on the lower axle per length."),
    _F("friction_loss", "friction loss", "N/s", "Heat made where the surfaces slip, per length."),
    _F("viscous_loss", "viscous loss", "N/s", "Heat made inside the layers, per length."),
    _F(
        "deflection_upper", "deflection, upper axis", "mm",
        "Deflection of the upper axis from its bearings, away from the lower roller.",
    ),
    _F(
        "deflection_lower", "deflection, lower axis", "mm",
        "Deflection of the lower axis from its bearings, away from the upper roller.",
    ),
)  # fmt: skip
"""The lists of a face over y by key."""

SHEET_FACE_FIGURES: Mapping[str, FaceFigure] = _of(
    _F(
        "mean_feed", "mean feed, upper", "1",
        "Speed of the sheet free of tension over that of the upper roller, less 1, in the mean.",
        "%", 100.0,
    ),
    _F(
        "feed_difference", "ends feed more by", "mm/m",
        "How much more both ends of the face feed than the middle, per metre of sheet.",
    ),
    _F(
        "least_tension_in", "least tension, inlet", "N/mm",
        "Smallest tension of the sheet at the inlet; negative where the nip pushes it back.",
    ),
    _F(
        "taut_tension", "taut from a tension of", "N/mm",
        "Mean inlet tension below which a sheet that runs at one speed goes slack somewhere.",
    ),
)  # fmt: skip
"""The scalar figures that a sheet adds, by key."""

SHEET_FACE_PROFILES: Mapping[str, FaceFigure] = _of(
    _F("feed_upper", "feed, upper", "1", "V_s/V_u - 1, by the upper roller's nominal radius."),
    _F("feed_lower", "feed, lower", "1", "V_s/V_l - 1, by the lower roller's nominal radius."),
    _F("traction_upper", "traction, upper", "N/mm", "What the upper roller gives to the sheet."),
    _F("tension_in", "tension, inlet", "N/mm", "Tension of the sheet at the inlet."),
)
"""The lists over y that a sheet adds, by key."""


def figures_of(solution: Any) -> Mapping[str, FaceFigure]:
    """Return the scalar figures that a face has."""
    return FACE_FIGURES if solution.nip.sheet is None else {**FACE_FIGURES, **SHEET_FACE_FIGURES}


def profiles_of(solution: Any) -> Mapping[str, FaceFigure]:
    """Return the lists over y that a face has."""
    if solution.nip.sheet is None:
        return FACE_PROFILES
    return {**FACE_PROFILES, **SHEET_FACE_PROFILES}
