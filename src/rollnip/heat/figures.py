"""The registry of the figures of heat: of each roller, of the balance, and of the nip.

JSON, tables of sweeps, summaries and the web page all read it. To add a figure, add it here and as
an attribute of `RollerHeat` or `HeatSolution`.
"""

from __future__ import annotations

from collections.abc import Mapping

from rollnip.figure import Figure, by_key
from rollnip.figures import FIGURES

_F = Figure

ROLLER_FIGURES: Mapping[str, Figure] = by_key(
    _F(
        "surface_temperature",
        "surface",
        "temperature",
        "Temperature of the surface, in the mean over a turn.",
    ),
    _F(
        "bond_temperature",
        "bond to the core",
        "temperature",
        "Temperature at the bond of the coverings to a rigid core.",
    ),
    _F("hot_spot", "hot spot", "temperature", "Highest temperature of the coverings."),
    _F(
        "hot_spot_depth",
        "depth of the hot spot",
        "length",
        "How deep the highest temperature is below the surface.",
        digits=3,
    ),
    _F(
        "power",
        "all heat that arises",
        "heat per length",
        "All heat that arises in the roller.",
        digits=3,
    ),
    _F(
        "viscous",
        "viscous loss",
        "heat per length",
        "Heat generated inside viscoelastic layers.",
        digits=3,
    ),
    _F(
        "friction",
        "friction",
        "heat per length",
        "The roller's part of the heat of slip.",
        digits=3,
    ),
    _F("to_air", "to the air", "heat per length", "Heat that goes into the air.", digits=3),
    _F(
        "to_core",
        "to the core",
        "heat per length",
        "Heat that goes into what cools the core.",
        digits=3,
    ),
    _F(
        "to_nip",
        "over the nip",
        "heat per length",
        "Heat that goes over the nip, into the other roller or a sheet.",
        sign="Positive where it leaves the roller.",
        digits=3,
    ),
    _F(
        "carried",
        "with the belt or rail",
        "heat per length",
        "Heat that a plane (a belt or rail) carries away; 0 for a roller, which comes round again.",
        digits=3,
    ),
    _F(
        "growth",
        "growth of the radius",
        "length",
        "How much the radius has grown by the heat.",
        digits=3,
    ),
)
"""The figures of each roller by key, in the order of the JSON."""

BALANCE_FIGURES: Mapping[str, Figure] = by_key(
    _F(
        "power",
        "all heat that arises",
        "heat per length",
        "All heat that arises in the nip.",
        digits=3,
    ),
    _F(
        "to_sheet",
        "taken by the sheet",
        "heat per length",
        "Heat that the sheet carries away.",
        digits=3,
    ),
)
"""The figures of both rollers together by key."""

NIP_FIGURES: Mapping[str, Figure] = {
    key: FIGURES[key]
    for key in (
        *("nip_width", "peak_pressure", "load", "approach"),
        *("creepage", "rolling_resistance"),
    )
}
"""The figures of the nip that are shown both cold and warm, by key."""

COURSES: Mapping[str, Figure] = by_key(
    _F("r", "radius", "length", "Distance from the axis."),
    _F("temperature", "temperature", "temperature", "Temperature at this radius."),
    _F("time", "time", "duration", "Time since the start.", digits=3),
    _F("hot_spot", "highest temperature", "temperature", "Highest temperature of the coverings."),
    _F("surface", "temperature of the surface", "temperature", "In the mean over a turn."),
    _F("bond", "temperature of the bond", "temperature", "At the bond to a rigid core."),
    _F("power", "heat of the nip", "heat per length", "All heat that arises."),
    _F("rise", "highest rise", "temperature difference", "Over the temperatures without heat."),
)
"""Temperatures over the radius, warm-up over time, and steady states over a parameter, by key."""

WARM_UP_FIGURES: Mapping[str, Figure] = by_key(
    _F(
        "half_time",
        "half of the rise after",
        "duration",
        "Time at which the hottest place has half of its final rise.",
        undefined="not reached",
        digits=3,
    ),
    _F(
        "error",
        "change of the last sweep",
        "temperature difference",
        "How much the temperatures changed when path and heat were computed for the last time.",
        digits=2,
    ),
)
"""The figures of a warm-up by key."""

PARAMETERS: Mapping[str, Figure] = by_key(
    _F("speed", "speed", "speed", "Circumferential speed of the rollers.", symbol="V"),
    FIGURES["load"],
)
"""Parameters over which steady states are followed, by name."""

TEMPERATURE, RISE = ROLLER_FIGURES["hot_spot"], COURSES["rise"]
"""A temperature and a temperature difference, for messages."""
