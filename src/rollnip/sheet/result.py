"""What a solution says of its sheet: feed, tractions, tension, strain, slip below, grip."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from rollnip._results.records import Zone
from rollnip._sealed import Sealed
from rollnip.contact import ContactZone, Layout, State
from rollnip.rollers import Side
from rollnip.rolling import MeshSolution

Array = NDArray[np.float64]
_KINDS: dict[State, tuple[Literal["stick", "slip"], int | None]] = {
    State.STICK: ("stick", None),
    State.SLIP_PLUS: ("slip", -1),
    State.SLIP_MINUS: ("slip", 1),
}


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class SheetProfiles(Sealed):
    """Distributions along the sheet, at the same places as those of the solution.

    Attributes
    ----------
    x : (n,) [mm], towards the leading edge.
    shear_lower : (n,) q_l on the sheet's underside along +x; on the lower roller it is -q_l [MPa].
    tension : (n,) per width [N/mm]; outside the nip those that are prescribed.
    strain : (n,) of the sheet's middle along the nip.
    slip_velocity_lower : (n,) of the sheet relative to the lower surface, along +x [mm/s]; nan
        outside the contact; None without speed.
    pressure_lower : (n,) on the lower interface [MPa]; of a sheet that bends freely it is that on
        the upper one.
    height : (n,) of the sheet over the top of the undeformed lower roller, its thickness left out:
        its path [mm]; of a sheet that bends freely it lies halfway between the surfaces.
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
    """How hard the sheet can be pulled before it slips through the nip.

    The pull is the tension on the inlet side less that on the outlet side: what the rollers give
    to the sheet, T_u - T_l (at finite strain up to a hundredth more, for tension grows along the
    path of the sheet). In full sliding each roller gives its friction times int p dx. That is the
    load; at finite strain the shears carry part of it along the bent path, some hundredths of it at
    most, which is taken as it is now.

    Attributes
    ----------
    pull : present [N/mm].
    largest, smallest : pulls between which the nip holds the sheet [N/mm]; with a prescribed
        traction or torque the lower roller's share stays as it is.
    first : the side that slides all over first where the pull is raised. With geared rollers the
        sheet is lost when the other one does, too.
    use_upper, use_lower : traction of each interface over friction times int p dx, in size.
    """

    pull: float
    largest: float
    smallest: float
    first: Side
    use_upper: float
    use_lower: float

    @property
    def reserve(self) -> float:
        """Change of the pull, up or down, that makes the sheet slip through [N/mm]."""
        return min(self.largest - self.pull, self.pull - self.smallest)


@dataclass(frozen=True, slots=True, eq=False)
class SheetResult:
    """The sheet of a solved nip. Units mm, N, MPa, s.

    Attributes
    ----------
    creepage_upper, creepage_lower : (V_u - V_s)/V and (V_s - V_l)/V, V_s the speed of the sheet
        free of tension.
    feed_upper, feed_lower : V_s/V_u - 1 and V_s/V_l - 1: how much longer the fed sheet is than
        what rolled off that roller, free of tension.
    speed : V_s [mm/s]; None without speed.
    traction_upper, traction_lower : T_u and T_l [N/mm].
    tension_max, tension_min : in the nip [N/mm].
    strain_max : the largest in size, with its sign.
    friction_upper, friction_lower : losses by slip on either interface [N/s]; None without speed.
    power : what the sheet takes: work against its tensions and the elastic energy that it carries
        away [N/s]; None without speed.
    slip_share_upper, slip_share_lower : share of the nip width over which either interface slips.
    zones_lower : stick and slip on the lower interface; directions are those of the slip velocity
        of the sheet relative to the lower surface.
    bending_length : over which its bending stiffness counts on these rollers, (D d/E)^(1/4) [mm].
    bends : whether its bending stiffness was counted; where not, it bends freely.
    nip_width_lower : width of the lower interface [mm]; the nip width is that of the upper one.
    peak_pressure_lower : highest pressure on the lower interface [MPa].
    grip : how hard it can be pulled.
    profiles : along the sheet.
    error : estimated errors by name, absolute.
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
        """Change of the pull that makes the sheet slip through [N/mm]; see `Grip`."""
        return self.grip.reserve


def slip_share_of(zones: tuple[Zone, ...]) -> float:
    """Return the share of the nip width that slips."""
    slipping = sum(zone.stop - zone.start for zone in zones if zone.state == "slip")
    return slipping / (zones[-1].stop - zones[0].start)


def pull_in_slip(one: MeshSolution) -> float:
    """Return int |q| dx of an interface where it slips [N/mm]."""
    slips = one.state.states > State.STICK
    return float(one.mesh.weights[slips] @ np.abs(one.state.shear[slips]))


def inside_zone(x: Array, zone: ContactZone) -> NDArray[np.bool_]:
    """Return which places lie in a zone."""
    return np.asarray((x >= zone.start) & (x <= zone.stop))


def zones_of(layout: Layout) -> tuple[Zone, ...]:
    """Return the zones of one interface from the trailing to the leading edge."""
    return tuple(Zone(z.start, z.stop, *_KINDS[z.state]) for z in layout.zones)
