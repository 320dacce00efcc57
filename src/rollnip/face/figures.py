"""The registry of the figures of a face: scalars, and lists over y.

JSON, netCDF, tables of sweeps and the documentation all read it. To add a figure, add it here and
as an attribute of `FaceSolution`.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rollnip.figure import Figure, by_key

_F = Figure

FACE_FIGURES: Mapping[str, Figure] = by_key(
    _F(
        "mean_load",
        "mean line load",
        "line load",
        "Load of the whole nip over the length of the face.",
    ),
    _F(
        "total_load",
        "total load",
        "roller force",
        "Load of the whole nip, the weight of the rollers included where it counts.",
    ),
    _F("creepage", "creepage of the face", "share", "Creepage of both rollers as wholes."),
    _F("total_traction", "total traction", "roller force", "Tangential force of the whole nip."),
    _F(
        "total_torque_upper",
        "torque, upper axle",
        "moment",
        "Driving torque on the upper axle, positive where it puts power in.",
    ),
    _F(
        "total_torque_lower",
        "torque, lower axle",
        "moment",
        "Driving torque on the lower axle, positive where it puts power in.",
    ),
    _F("power_upper", "power, upper axle", "power", "Power of the upper axle."),
    _F("power_lower", "power, lower axle", "power", "Power of the lower axle."),
    _F(
        "total_friction_loss",
        "friction loss",
        "power",
        "Heat generated where the surfaces slip, over the whole face.",
    ),
    _F(
        "total_viscous_loss",
        "viscous loss",
        "power",
        "Heat generated inside the layers, over the whole face.",
    ),
    _F(
        "evenness",
        "smallest over largest line load",
        "share",
        "Smallest line load over the largest: 100 % is an even nip.",
        digits=3,
    ),
    _F(
        "largest_departure",
        "departs from the mean by",
        "share",
        "Largest departure of the line load from its mean, over the mean.",
    ),
    _F(
        "even_share",
        "face within 10 % of mean",
        "share",
        "Share of the face whose line load is within 10 % of the mean.",
        digits=3,
    ),
    _F(
        "largest_scrub",
        "largest scrub",
        "line load",
        "Largest departure of the traction from its mean: there the surfaces rub each other.",
        digits=3,
    ),
    _F(
        "added_length",
        "both ends add",
        "length",
        "Length of face that carries as much as both ends do beside the plane nip.",
        sign="Negative where they carry less.",
        digits=3,
    ),
    _F(
        "bearing_offset",
        "bearing offset",
        "length",
        "How much further the upper bearing at y > 0 has come than the other.",
    ),
)
"""The scalar figures of a face by key."""

BEARING_FORCES: Mapping[str, Figure] = {
    side: _F(
        f"bearing_forces_{side}",
        f"bearings, {side}",
        "roller force",
        f"Forces on both bearings of the {side} roller.",
    )
    for side in ("upper", "lower")
}
"""The figures of the forces on the bearings, by roller."""

IMPRESSION_FIGURES: Mapping[str, Figure] = by_key(
    _F("load", "load", "line load", "Mean line load."),
    _F("tilt", "difference of end loads", "roller force", "End load at y > 0 less that at y < 0."),
    _F("crown", "crown on the diameter", "length", "Middle less ends, on the diameter."),
    _F("modulus", "modulus over the assumed one", "ratio", "By what all moduli are multiplied."),
)
"""What an impression determines, by the name of the unknown."""

ADDED_CROWN = _F(
    "needed_crown", "crown to be added", "length", "Crown on the diameter to add for an even load."
)
"""The crown that a measured face lacks, from the impression and by the shop formula."""

FACE_PROFILES: Mapping[str, Figure] = by_key(
    _F("y", "y", "length", "Place along the face, from its middle."),
    _F("load", "line load", "line load", "Line load; 0 where the nip is open."),
    _F(
        "approach",
        "approach",
        "length",
        "Approach of the surfaces; negative where the nip is open.",
    ),
    _F("nip_width", "nip width", "length", "Length of the contact along the circumference."),
    _F("peak_pressure", "peak pressure", "pressure", "The highest pressure of the cross-section."),
    _F("traction", "traction", "line load", "Traction, positive where the upper roller drives."),
    _F("local_creepage", "local creepage", "share", "Creepage with the local radii."),
    _F("slip_width", "slip", "length", "Part of the nip width over which the surfaces slip."),
    _F(
        "torque_upper",
        "torque, upper axle",
        "force",
        "Driving torque on the upper axle per length.",
    ),
    _F(
        "torque_lower",
        "torque, lower axle",
        "force",
        "Driving torque on the lower axle per length.",
    ),
    _F(
        "friction_loss",
        "friction loss",
        "power per length",
        "Heat generated where the surfaces slip, per length.",
    ),
    _F(
        "viscous_loss",
        "viscous loss",
        "power per length",
        "Heat generated inside the layers, per length.",
    ),
    _F(
        "deflection_upper",
        "deflection, upper axis",
        "length",
        "Deflection of the upper axis from its bearings, away from the lower roller.",
    ),
    _F(
        "deflection_lower",
        "deflection, lower axis",
        "length",
        "Deflection of the lower axis from its bearings, away from the upper roller.",
    ),
)
"""The lists of a face over y by key."""

SHEET_FACE_FIGURES: Mapping[str, Figure] = by_key(
    _F(
        "mean_feed",
        "mean feed, upper roller",
        "share",
        "Speed of the sheet free of tension over that of the upper roller, less 1, in the mean.",
    ),
    _F(
        "feed_difference",
        "ends feed more by",
        "feed per metre",
        "How much more both ends feed than the middle, per metre of sheet.",
        sign="Negative where they feed less. Wrinkles begin with it.",
        digits=3,
    ),
    _F(
        "least_tension_in",
        "least tension at the inlet",
        "line load",
        "Smallest tension of the sheet at the inlet.",
        sign="Negative where the nip pushes it back: there it goes slack.",
        digits=3,
    ),
    _F(
        "taut_tension",
        "taut everywhere from",
        "line load",
        "Mean inlet tension below which a sheet that runs at one speed goes slack somewhere.",
        digits=3,
    ),
)
"""The scalar figures of a face with a sheet, besides the others, by key."""

SHEET_FACE_PROFILES: Mapping[str, Figure] = by_key(
    _F(
        "feed_upper",
        "feed over the upper roller",
        "share",
        "V_s/V_u - 1, by the upper roller's nominal radius.",
    ),
    _F(
        "feed_lower",
        "feed over the lower roller",
        "share",
        "V_s/V_l - 1, by the lower roller's nominal radius.",
    ),
    _F(
        "traction_upper",
        "traction, upper roller",
        "line load",
        "Traction of the lower roller plus the pull; the levers of the shears are left out.",
    ),
    _F("tension_in", "tension at the inlet", "line load", "Tension of the sheet at the inlet."),
)
"""The lists over y of a face with a sheet, besides the others, by key."""


def figures_of(solution: Any) -> Mapping[str, Figure]:
    """Return the scalar figures of a face."""
    return FACE_FIGURES if solution.nip.sheet is None else {**FACE_FIGURES, **SHEET_FACE_FIGURES}


def profiles_of(solution: Any) -> Mapping[str, Figure]:
    """Return the lists over y of a face."""
    if solution.nip.sheet is None:
        return FACE_PROFILES
    return {**FACE_PROFILES, **SHEET_FACE_PROFILES}
