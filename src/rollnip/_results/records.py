"""Records of a solution besides its figures: zones, profiles, surfaces, solver information."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from rollnip._sealed import Sealed
from rollnip.contact import ContactZone, State

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Zone:
    """A part of the contact that sticks or slips.

    Attributes
    ----------
    start, stop : trailing and leading end [mm].
    state : "stick" or "slip".
    direction : sign of the slip velocity of the upper surface relative to the lower one, along +x;
        None in stick.
    """

    start: float
    stop: float
    state: Literal["stick", "slip"]
    direction: int | None = None

    @classmethod
    def of(cls, zones: Iterable[ContactZone]) -> tuple[Zone, ...]:
        """Return zones as records."""
        # q = -mu p sign(slip velocity): shear along +x resists slip of the upper surface along -x.
        kinds: dict[State, tuple[Literal["stick", "slip"], int | None]] = {
            State.STICK: ("stick", None),
            State.SLIP_PLUS: ("slip", -1),
            State.SLIP_MINUS: ("slip", 1),
        }
        return tuple(cls(zone.start, zone.stop, *kinds[zone.state]) for zone in zones)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Profiles(Sealed):
    """Distributions over x, from trailing to leading, up to one nip width outside the contact.

    Attributes
    ----------
    x : (n,) places [mm], towards the leading edge.
    pressure, shear : (n,) [MPa]; shear stress on the upper roller, along +x.
    gap : (n,) distance of the surfaces [mm].
    slip_velocity : (n,) velocity of the upper surface relative to the lower one, along +x [mm/s];
        nan outside the contact; None without speed or creepage.
    strain_upper, strain_lower : (n,) du_x/dx of each surface; in geometries with rings, stretch
        less 1.
    speed_upper, speed_lower : (n,) V_roller (1 + strain) [mm/s]; None without speed or creepage.
    """

    x: Array
    pressure: Array
    shear: Array
    gap: Array
    slip_velocity: Array | None
    strain_upper: Array
    strain_lower: Array
    speed_upper: Array | None
    speed_lower: Array | None


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class DeformedSurfaces(Sealed):
    """Both deformed surfaces in one frame: lower roller below, heights from its undeformed top.

    Attributes
    ----------
    x : (n,) places [mm], towards the leading edge.
    upper, lower : (n,) heights of the surfaces [mm] above the top of the undeformed lower roller;
        their difference is the gap.
    """

    x: Array
    upper: Array
    lower: Array


@dataclass(frozen=True, slots=True)
class SolverInfo:
    """How the solution was reached.

    Attributes
    ----------
    elements : number of elements of the last mesh.
    iterations : number of linear systems solved in all.
    residual : largest relative violation of the contact conditions, evaluated at more points than
        they were solved at.
    geometry_change : last relative change of the geometry correction, or of the traction for a
        prescribed torque; 0 for "linear" without a torque.
    seconds : wall time.
    version : version of rollnip.
    """

    elements: int
    iterations: int
    residual: float
    geometry_change: float
    seconds: float
    version: str
