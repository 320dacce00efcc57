"""The registry of figures: what a solution reports, with symbol, unit, label and meaning.

JSON, netCDF, tables, summaries, plots, the web page and the documentation all read it, so that each
figure is described once. To add a figure, add it here and as an attribute of `Solution`. If its
error is estimated, set ``claimed=True`` here and add a key to `Solution.error`.
"""

from __future__ import annotations

from collections.abc import Mapping

from rollnip.figure import FaceTotal, Figure, by_key, curve

__all__ = ["CLAIMED", "FIELDS", "FIGURES", "INTERFACE_FIGURES", "PLACES", "PROFILES", "PULL"]

_NEWTON, _NEWTON_METRE, _WATT = FaceTotal("N", 1.0), FaceTotal("N m", 1e-3), FaceTotal("W", 1e-3)
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
        sentence="Where the pressure is highest, of equal peaks the leading one, from the line of "
        "centres.",
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
        sentence="Heat generated where the surfaces slip on each other, per width of the face.",
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
        sentence="Heat generated inside viscoelastic layers, per width of the face.",
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
        "over one element; beside a slipping edge it depends on the length of that element.",
        undefined="not looked for",
    ),
)


_CURVES: tuple[Figure, ...] = (
    curve("x", "x", "x", "length", "Place along the nip, towards the leading edge (inlet)."),
    curve("pressure", "p", "pressure", "pressure", "Pressure, positive in compression."),
    curve("shear", "q", "shear", "pressure", "Shear on the upper roller, along +x."),
    curve("gap", "g", "gap", "length", "Distance of the surfaces."),
    curve(
        "slip_velocity",
        "s",
        "slip velocity",
        "speed",
        "Velocity of the upper surface relative to the lower one, along +x.",
    ),
    curve(
        "strain_upper",
        r"\varepsilon_u",
        "strain, upper surface",
        "share",
        "Strain of the upper surface along the nip, positive where it is stretched.",
    ),
    curve(
        "strain_lower",
        r"\varepsilon_l",
        "strain, lower surface",
        "share",
        "Strain of the lower surface along the nip, positive where it is stretched.",
    ),
    curve("speed_upper", "v_u", "speed, upper surface", "speed", "Speed of the upper surface."),
    curve("speed_lower", "v_l", "speed, lower surface", "speed", "Speed of the lower surface."),
)

FIGURES: Mapping[str, Figure] = by_key(*_SCALARS)
"""The scalar figures of a result by key, in the order of the JSON."""

CLAIMED: Mapping[str, Figure] = {one.name: one for one in _SCALARS if one.claimed}
"""The scalar figures whose error is estimated, by name."""

PROFILES: Mapping[str, Figure] = by_key(*_CURVES)
"""The distributions over x of a result by key, in the order of the JSON."""

_AT = "Where it is, along x."
_PULL = "Positive in tension."
_CYCLE = "Largest less smallest of one revolution, 0 far from the nip included."
INTERFACE_FIGURES: Mapping[str, Figure] = by_key(
    Figure("depth", "depth", "length", "Depth below the surface.", symbol="z"),
    Figure("shear_min", "smallest shear", "pressure", "Smallest shear stress along x."),
    Figure("shear_min_x", "place of the smallest shear", "length", _AT),
    Figure("shear_max", "largest shear", "pressure", "Largest shear stress along x."),
    Figure("shear_max_x", "place of the largest shear", "length", _AT),
    Figure("peel_min", "smallest peel stress", "pressure", "Smallest normal stress.", sign=_PULL),
    Figure("peel_min_x", "place of the smallest peel stress", "length", _AT),
    Figure("peel_max", "largest peel stress", "pressure", "Largest normal stress.", sign=_PULL),
    Figure("peel_max_x", "place of the largest peel stress", "length", _AT),
    Figure("shear_range", "shear range", "pressure", _CYCLE),
    Figure("peel_range", "peel range", "pressure", _CYCLE),
    Figure(
        "von_mises_max", "largest von Mises stress", "pressure", "Of the layers on either side."
    ),
)
"""The figures of an `InterfaceStress` (an interface or a bond), by key, in the order of files."""

PLACES: Mapping[str, Figure] = by_key(
    Figure("face_width", "face width", "length", "Width of the face that totals are for."),
    Figure("contact", "edges of the contact", "length", "Trailing and leading edge, along x."),
    Figure("zone_from", "start of the zone", "length", "Trailing end of a zone of stick or slip."),
    Figure("zone_to", "end of the zone", "length", "Leading end of a zone of stick or slip."),
)
"""The ends of the contact and of its zones, and the width of the face, by key."""

PULL = Figure("pull", "largest pull", "pressure", "Largest tension across the interface, or 0.")
"""The tension across an interface, for summaries and plots; files have the peel stress."""


_TENSION = "Positive in tension."
_STRETCH = "Positive where it is stretched."
FIELDS: Mapping[str, Figure] = by_key(
    curve("u_x", "u_x", "displacement along x", "length", "Displacement along the nip."),
    curve("u_z", "u_z", "displacement along z", "length", "Displacement into the roller."),
    curve("s_xx", "s_{xx}", "stress along x", "pressure", "Stress along the nip.", _TENSION),
    curve("s_yy", "s_{yy}", "axial stress", "pressure", "Stress along the axes.", _TENSION),
    curve("s_zz", "s_{zz}", "normal stress", "pressure", "Stress along the depth.", _TENSION),
    curve("s_xy", "s_{xy}", "shear stress in the surface", "pressure", "Shear stress of x and y."),
    curve("s_xz", "s_{xz}", "shear stress", "pressure", "Shear stress of x and z."),
    curve("s_yz", "s_{yz}", "shear stress along y", "pressure", "Shear stress of y and z."),
    curve(
        "s_1",
        "s_1",
        "larger principal stress",
        "pressure",
        "Larger principal stress in the plane of x and z.",
        _TENSION,
    ),
    curve(
        "s_2",
        "s_2",
        "smaller principal stress",
        "pressure",
        "Smaller principal stress in the plane of x and z.",
        _TENSION,
    ),
    curve(
        "principal_angle", "", "direction of s_1", "angle", "Direction of s_1, from x towards z."
    ),
    curve(
        "max_shear",
        "",
        "largest shear stress",
        "pressure",
        "Half of the largest less the smallest principal stress, the axial one included.",
    ),
    curve(
        "von_mises",
        "",
        "von Mises stress",
        "pressure",
        "Equivalent stress of von Mises, the axial stress included.",
    ),
    curve(
        "pressure",
        "",
        "hydrostatic pressure",
        "pressure",
        "Mean of the three normal stresses, its sign turned.",
        "Positive in compression.",
    ),
    curve("e_xx", "e_{xx}", "strain along x", "share", "Strain along the nip.", _STRETCH),
    curve("e_zz", "e_{zz}", "strain along z", "share", "Strain along the depth.", _STRETCH),
    curve(
        "e_xz",
        "e_{xz}",
        "shear strain",
        "share",
        "Half the change of the right angle between x and z.",
    ),
    curve(
        "energy_density",
        "",
        "strain energy density",
        "energy per volume",
        "Half of stress times strain; at finite strain the strain energy.",
    ),
    curve(
        "loss_density",
        "",
        "stress power, loss density",
        "power per volume",
        "Power that linear stress puts into the passing material; its integral along x is heat.",
    ),
    curve(
        "loss_per_depth",
        "",
        "heat per depth",
        "power per area",
        "Heat of linear theory made per depth and per width of the face.",
    ),
)
"""The fields inside a roller by key; z points from the surface into the body of the roller."""

MEASURED: Mapping[str, Figure] = by_key(
    Figure("frequency", "frequency", "frequency", "Frequency of a dynamic test."),
    Figure("duration", "time", "duration", "Time since a step of strain or stress."),
    Figure("temperature", "temperature", "temperature", "Temperature of the sample."),
    Figure("young_modulus", "Young's modulus", "pressure", "Storage or loss modulus in tension."),
    Figure("complex_modulus", "|E*|", "pressure", "Absolute value of the complex modulus."),
    Figure("phase", "phase", "angle", "Phase of the complex modulus."),
    Figure("relaxation_modulus", "relaxation modulus", "pressure", "Stress over a step of strain."),
    Figure("creep_compliance", "creep compliance", "compliance", "Strain over a step of stress."),
    Figure("deviation", "deviation", "share", "Of what was measured from the fit."),
    Figure("strain", "strain, or amount of shear", "ratio", "Stretch less 1, or angle of shear."),
    Figure("nominal_stress", "nominal stress", "pressure", "Force over the undeformed section."),
    Figure("velocity", "velocity", "speed", "Velocity of the surface, by velocimetry.", symbol="v"),
    Figure("record_time", "time", "time", "Time within a record of velocimetry."),
    Figure("cumulative", "cumulative", "share", "Share of all cases up to a value."),
)
"""Quantities of material tests and measured records, which plots of them show."""
