"""The result for a nip with measured profiles: a `Solution` from a uniform grid."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from math import nan

import numpy as np
from numpy.typing import NDArray

from rollnip._results.records import DeformedSurfaces, Profiles, Zone
from rollnip._sealed import sealed
from rollnip.interior import InterfaceStress, SurfaceTractions, interface_stresses
from rollnip.nip import Approach
from rollnip.rollers import Roller
from rollnip.rolling import Powers, hoop_curvature
from rollnip.rough.contact import RoughContact
from rollnip.rough.fields import SurfaceFields, outside, surface_fields, thinned
from rollnip.solution import Solution

Array = NDArray[np.float64]

_MOST_INSIDE = 2000  # most nodes from whose pressures the stresses inside are computed


@dataclass(frozen=True, eq=False, repr=False)
class RoughSolution(Solution):
    """A snapshot of rough rollers, elastic and without friction.

    It differs from other solutions as follows. There is no shear, no creepage and no zone.
    ``torque_upper``, ``torque_lower`` and ``power_in`` are None: those of an uneven snapshot differ
    from their mean over a turn, which is 0. ``contact`` has an interval for each piece that
    touches.

    Attributes
    ----------
    rough : the solved contact.
    """

    rough: RoughContact = field(kw_only=True, repr=False, compare=False)

    @property
    def load(self) -> float:
        """Line load F [N/mm]."""
        return self.rough.figures[1]

    @property
    def approach(self) -> float | None:
        """Approach of the axles from first touch of the smooth rollers [mm].

        None with a half-space core. It may be negative: asperities carry a small load before the
        smooth rollers would touch.
        """
        return None if self.nip.has_half_space else self.rough.state.approach

    @property
    def creepage(self) -> float | None:
        """Creepage: None, since it is not defined without friction."""
        return None

    @property
    def traction(self) -> float:
        """Traction [N/mm]: 0 without friction."""
        return 0.0

    @cached_property
    def contact(self) -> tuple[tuple[float, float], ...]:
        """Contact intervals (trailing, leading) [mm], one for each piece that touches."""
        return self.rough.intervals

    @property
    def contact_length(self) -> float:
        """Length of all contact intervals together, the real contact [mm]."""
        return sum(leading - trailing for trailing, leading in self.contact)

    @property
    def nip_width(self) -> float:
        """Nip width, from the outermost trailing to the outermost leading edge [mm]."""
        return self.rough.figures[2]

    @property
    def peak_pressure(self) -> float:
        """Highest nodal pressure [MPa]."""
        return self.rough.figures[3]

    @property
    def peak_pressure_x(self) -> float:
        """Place of the highest pressure [mm]."""
        return float(self.nodes[np.argmax(self.pressure)])

    @cached_property
    def zones(self) -> tuple[Zone, ...]:
        """Stick and slip zones: none without friction."""
        return ()

    @property
    def torque_upper(self) -> float | None:
        """Torque on the upper axle: None, since it is not defined for a snapshot."""
        return None

    @property
    def torque_lower(self) -> float | None:
        """Torque on the lower axle: None, since it is not defined for a snapshot."""
        return None

    @property
    def power_in(self) -> float | None:
        """Power of both axles: None, since it is not defined for a snapshot."""
        return None

    def _claimed_errors(self) -> dict[str, float]:
        """Return the changes where every second sample is left out, absolute."""
        approach, load, width, peak = self.rough.errors
        if self.nip.has_half_space:
            approach = nan
        if isinstance(self.nip.normal, Approach):
            approach = 0.0
        else:
            load = abs(self.load - self.nip.normal.load)
        return {
            "approach": approach,
            "load": load,
            "creepage": nan,
            "nip_width": width,
            "peak_pressure": peak,
        }

    @cached_property
    def profiles(self) -> Profiles:
        """Pressure, gap and strains in the nip and beside it; smooth beyond the measured part."""
        x, upper, lower = self._surfaces
        depths = self._depths(x, upper, lower)
        pressure = np.interp(x, self.nodes, self.pressure, left=0.0, right=0.0)
        gap = np.maximum(depths[0] + depths[1] - self.rough.state.approach, 0.0)
        zero = np.zeros(x.size)
        return Profiles(
            x=x,
            pressure=pressure,
            shear=zero,
            gap=np.where(pressure > 0.0, 0.0, gap),
            slip_velocity=None,
            strain_upper=self._strain(self.nip.upper, upper),
            strain_lower=self._strain(self.nip.lower, lower),
            speed_upper=None,
            speed_lower=None,
        )

    @cached_property
    def deformed_surfaces(self) -> DeformedSurfaces:
        """Heights of both deformed surfaces with their roughness, in the nip and beside it."""
        x, upper, lower = self._surfaces
        depths = self._depths(x, upper, lower)
        return DeformedSurfaces(x, depths[0] - self.rough.state.approach, -depths[1])

    @property
    def nodes(self) -> Array:
        """Nodes of the grid, from trailing to leading, (n,) [mm]."""
        return sealed(self.rough.x)

    @property
    def pressure(self) -> Array:
        """Pressure at the nodes, linear between them, (n,) [MPa]."""
        return sealed(self.rough.pressure)

    @property
    def shear(self) -> Array:
        """Shear at the nodes, (n,) [MPa]: 0 without friction."""
        return np.zeros(self.nodes.size)

    @property
    def inside_from(self) -> float:
        """Depth from which on stresses inside are resolved [mm]; 0: everywhere.

        Stresses inside are computed from at most 2000 pressures, each the mean of its
        neighbourhood. Closer to the surface than two of their distances, details are missing.
        """
        nodes, _ = self._thin
        wider = float(nodes[1] - nodes[0])
        return 0.0 if wider < 1.5 * self.rough.sampling.spacing else 2.0 * wider

    @cached_property
    def interfaces(self) -> tuple[InterfaceStress, ...]:
        """Stresses on every interface and bond of the upper, then of the lower roller."""
        x = np.union1d(self._section, self._thin[0][1:-1])
        model = (self.model.geometry, self.nip.speed)
        tractions = self._tractions_on("upper")
        upper = interface_stresses("upper", self.nip.upper, tractions, x, model)
        lower = interface_stresses("lower", self.nip.lower, tractions, x, model)
        return upper + lower

    @cached_property
    def _thin(self) -> tuple[Array, Array]:
        return thinned(self.nodes, self.pressure, _MOST_INSIDE)

    def _tractions_on(self, roller: str) -> SurfaceTractions:  # noqa: ARG002
        """Return the tractions on either surface in its own frame: the same pressure on both."""
        nodes, pressure = self._thin
        return SurfaceTractions(nodes, np.zeros(nodes.size), pressure)

    @cached_property
    def _surfaces(self) -> tuple[Array, SurfaceFields, SurfaceFields]:
        """Places, and the fields of the upper and the lower surface there."""
        beyond = outside(self.rough, self.nip_width)
        both = self.rough.kernels
        x = np.concatenate([beyond[0], self.nodes, beyond[1]])
        upper = surface_fields(both.upper, self.rough, beyond)
        return x, upper, surface_fields(both.lower, self.rough, beyond)

    def _depths(self, x: Array, upper: SurfaceFields, lower: SurfaceFields) -> tuple[Array, Array]:
        """Return the distance of each surface from the tangent at first touch [mm].

        The approach is not included.
        """
        return _depth(x, self.nip.upper, upper.u_z), _depth(x, self.nip.lower, lower.u_z)

    def _strain(self, roller: Roller, fields: SurfaceFields) -> Array:
        """Return du_x/dx, in rings the stretch less 1, as for smooth rollers."""
        if self.model.geometry == "linear":
            return fields.strain
        hoop = hoop_curvature(roller, self.model.geometry)
        rotation = fields.slope + hoop * fields.u_x
        return np.asarray(fields.strain - hoop * fields.u_z + 0.5 * rotation**2)

    @cached_property
    def _powers(self) -> Powers:
        """Powers of an elastic contact without friction: all zero; torques are not reported."""
        return Powers(0.0, 0.0, 0.0, 0.0, 0.0)


def _depth(x: Array, roller: Roller, u_z: Array) -> Array:
    height = 0.0 if roller.profile is None else roller.profile.at(x)
    return np.asarray(0.5 * roller.curvature * x * x - height + u_z)
