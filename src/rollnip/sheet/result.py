"""Results of the sheet: feed, tractions, tension, strain, slip on the lower side and grip."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from rollnip._results.records import Zone
from rollnip._sealed import Sealed
from rollnip.contact import State
from rollnip.rollers import Side
from rollnip.rolling import MeshSolution

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class SheetProfiles(Sealed):
    """Distributions along the sheet, at the same places as those of the solution.

    Attributes
    ----------
    x : (n,) [mm], towards the leading edge.
    shear_lower : (n,) q_l on the sheet's underside along +x; on the lower roller it is -q_l [MPa].
    tension : (n,) per width [N/mm]; outside the nip the prescribed tensions.
    strain : (n,) of the sheet's middle along the nip.
    slip_velocity_lower : (n,) of the sheet relative to the lower surface, along +x [mm/s]; nan
        outside the contact; None without speed.
    pressure_lower : (n,) on the lower interface [MPa]; for a membrane the same as on the upper one.
    height : (n,) height of the sheet's path above the top of the undeformed lower roller, without
        the sheet's thickness [mm]; for a membrane halfway between the surfaces.
    """

    x: Array
    shear_lower: Array
    tension: Array
    strain: Array
    slip_velocity_lower: Array | None
    pressure_lower: Array
    height: Array


@dataclass(frozen=True, slots=True)
class Grip:
    """The pull that the sheet can take before it slips through the nip.

    The pull is the tension on the inlet side less that on the outlet side, which in "linear" is the
    force of the rollers on the sheet, T_u - T_l. Otherwise it differs from that by h/2R of the
    tractions, R being the radius of the path, because the shears act at the faces, h/2 from the
    middle of the sheet; at finite strain also because the path is longer than its extent along x.
    In full sliding each roller contributes its friction coefficient times int p dx; the roller
    inside the curve h/2R of that less, the other one h/2R more. That integral is the load; at
    finite strain the shears carry part of the load along the curved path, a few hundredths at most,
    which is taken at its present value.

    Attributes
    ----------
    pull : present [N/mm].
    largest, smallest : limits of the pull between which the nip holds the sheet [N/mm]; with a
        prescribed traction or torque the share of the lower roller is held constant.
    first : the side that first slides as a whole when the pull is raised. With geared rollers the
        sheet is lost only when the other side slides too.
    use_upper, use_lower : size of the traction of each interface over friction times int p dx.
    """

    pull: float
    largest: float
    smallest: float
    first: Side
    use_upper: float
    use_lower: float

    @property
    def reserve(self) -> float:
        """Change of the pull, up or down, at which the sheet slips through [N/mm]."""
        return min(self.largest - self.pull, self.pull - self.smallest)


@dataclass(frozen=True, slots=True, eq=False)
class SheetResult:
    """The sheet of a solved nip. Units mm, N, MPa, s.

    Attributes
    ----------
    creepage_upper, creepage_lower : (V_u - V_s)/V and (V_s - V_l)/V, with the speed V_s of the
        sheet free of tension.
    feed_upper, feed_lower : V_s/V_u - 1 and V_s/V_l - 1: relative excess of the length of sheet
        fed, free of tension, over the length that rolled off each roller.
    speed : V_s [mm/s]; None without speed.
    traction_upper, traction_lower : T_u and T_l [N/mm].
    tension_max, tension_min : in the nip [N/mm].
    strain_max : strain of largest size, with its sign.
    friction_upper, friction_lower : losses by slip on each interface [N/s]; None without speed.
    power : power into the sheet: work against its tensions and the elastic energy that it carries
        away [N/s]; None without speed.
    slip_share_upper, slip_share_lower : share of the nip width over which each interface slips.
    zones_lower : stick and slip zones on the lower interface; their directions are those of the
        slip velocity of the sheet relative to the lower surface.
    bending_length : length over which bending stiffness acts on these rollers, (D d/E)^(1/4) [mm].
    bends : whether the bending stiffness is included; otherwise the sheet is a membrane.
    nip_width_lower : width of the lower interface [mm]; the nip width is that of the upper one.
    peak_pressure_lower : peak pressure on the lower interface [MPa].
    grip : the pull that the sheet can take.
    profiles : distributions along the sheet.
    error : estimated absolute errors by name.
    """

    creepage_upper: float
    creepage_lower: float
    feed_upper: float
    feed_lower: float
    speed: float | None
    traction_upper: float
    traction_lower: float
    tension_max: float
    tension_min: float
    strain_max: float
    friction_upper: float | None
    friction_lower: float | None
    power: float | None
    slip_share_upper: float
    slip_share_lower: float
    zones_lower: tuple[Zone, ...]
    bending_length: float
    bends: bool
    nip_width_lower: float
    peak_pressure_lower: float
    grip: Grip
    profiles: SheetProfiles = field(repr=False)
    error: Mapping[str, float] = field(repr=False)

    @property
    def grip_reserve(self) -> float:
        """Change of the pull at which the sheet slips through [N/mm]; see `Grip`."""
        return self.grip.reserve


def slip_share_of(zones: tuple[Zone, ...]) -> float:
    """Return the share of the nip width that slips."""
    slipping = sum(zone.stop - zone.start for zone in zones if zone.state == "slip")
    return slipping / (zones[-1].stop - zones[0].start)


def traction_in_slip(one: MeshSolution) -> float:
    """Return int |q| dx over the slip zones of an interface [N/mm]."""
    slips = one.state.states > State.STICK
    return float(one.mesh.weights[slips] @ np.abs(one.state.shear[slips]))
