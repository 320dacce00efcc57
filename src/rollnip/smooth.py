"""The result for two smooth rollers that touch each other: every figure from the last mesh."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from math import isnan

import numpy as np
from numpy.typing import NDArray

from rollnip._results.profiles import fine_points, slip_velocity, surface_strain
from rollnip._results.records import DeformedSurfaces, Profiles, Zone
from rollnip._sealed import sealed
from rollnip.contact import contact_intervals
from rollnip.interior import SurfaceTractions
from rollnip.rolling import (
    MeshSolution,
    Powers,
    claims,
    fields_at,
    peak_pressure,
    powers,
    secondary_claims,
    surface_depths,
)
from rollnip.solution import Solution

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False, repr=False)
class SmoothSolution(Solution):
    """A solved nip of two smooth rollers; see `Solution`.

    Attributes
    ----------
    final : the contact on the last mesh, with its error estimates.
    """

    final: MeshSolution = field(repr=False, kw_only=True)

    @property
    def load(self) -> float:
        """Line load F [N/mm]."""
        return self.final.figures.load

    @property
    def approach(self) -> float | None:
        """Approach delta of the axles [mm]; None with a half-space core, where it is infinite."""
        return None if self.nip.has_half_space else self.final.state.approach

    @property
    def creepage(self) -> float | None:
        """Creepage xi = (V_u - V_l)/V; None without friction, unless it was prescribed."""
        creepage = self.final.state.creepage
        return None if isnan(creepage) else creepage

    @property
    def traction(self) -> float:
        """Traction T = int q dx [N/mm]; T > 0: the upper roller drives the lower one.

        In the geometries "curved" and "corrected" q is taken per undeformed arc, as the mean of
        both rollers.
        """
        return float(self.final.problem.weights @ self.final.state.shear)

    @cached_property
    def contact(self) -> tuple[tuple[float, float], ...]:
        """Contact intervals (trailing, leading) [mm], trailing first."""
        return contact_intervals(self.final.zones)

    @property
    def nip_width(self) -> float:
        """Nip width, from the outermost trailing to the outermost leading edge [mm]."""
        return self.final.figures.nip_width

    @property
    def peak_pressure(self) -> float:
        """Highest pressure [MPa]."""
        return self.final.figures.peak_pressure

    @property
    def peak_pressure_x(self) -> float:
        """Place of the highest pressure [mm]; of several equally high peaks, the leading one."""
        return peak_pressure(self.final.x, self.final.pressure)[1]

    @cached_property
    def zones(self) -> tuple[Zone, ...]:
        """Stick and slip zones from trailing to leading edge; empty without friction."""
        return () if self.nip.friction == 0.0 else Zone.of(self.final.zones)

    def _claimed_errors(self) -> dict[str, float]:
        return claims(self.final) | secondary_claims(self.final, self._powers)

    @cached_property
    def profiles(self) -> Profiles:
        """Pressure, shear, gap, slip velocity, strains and speeds, in the nip and beside it."""
        x = fine_points(self.final)
        fields = fields_at(x, self.final)
        strains = [surface_strain(x, self.final, side=side) for side in ("upper", "lower")]
        speeds = self._roller_speeds
        slip = None
        if speeds is not None and self.nip.friction > 0.0:
            slip = slip_velocity(fields, self.final.zones, 0.5 * sum(speeds))
        return Profiles(
            x=x,
            pressure=fields.pressure,
            shear=fields.shear,
            gap=np.where(fields.pressure > 0.0, 0.0, np.maximum(fields.gap, 0.0)),
            slip_velocity=slip,
            strain_upper=strains[0],
            strain_lower=strains[1],
            speed_upper=None if speeds is None else speeds[0] * (1.0 + strains[0]),
            speed_lower=None if speeds is None else speeds[1] * (1.0 + strains[1]),
        )

    @cached_property
    def deformed_surfaces(self) -> DeformedSurfaces:
        """Heights of both surfaces in the nip and beside it, with the gap of the geometry model.

        With a half-space core the approach is infinite; heights are then relative to a displacement
        that is left out.
        """
        x = fine_points(self.final)
        fields = fields_at(x, self.final)
        depths = surface_depths(x, self.nip, self.model.geometry, fields.displacements)
        return DeformedSurfaces(x, depths[0] - self.final.state.approach, -depths[1])

    @property
    def nodes(self) -> Array:
        """Nodes of the mesh that carry tractions, from trailing to leading edge, (n,) [mm]."""
        return sealed(self.final.x)

    @property
    def pressure(self) -> Array:
        """Pressure at the nodes, linear between them, (n,) [MPa]; it integrates to the load.

        The mean over each element is right, so that a nodal value may exceed ``peak_pressure`` by a
        few 1e-4 of it.
        """
        return sealed(self.final.pressure)

    @property
    def shear(self) -> Array:
        """Shear stress on the upper roller along +x, linear between the nodes, (n,) [MPa].

        At nodes in stick beside a transition to slip it may exceed friction times pressure, within
        the tolerance.
        """
        return sealed(self.final.shear)

    def _tractions_on(self, roller: str) -> SurfaceTractions:
        """Return the tractions on one surface in its own frame: upper (q, p), lower (-q, p)."""
        shear = self.shear if roller == "upper" else -self.shear
        return SurfaceTractions.on_inner(self.final.nodes, shear, self.pressure)

    @cached_property
    def _powers(self) -> Powers:
        return powers(self.final)

    @property
    def _heat_beyond(self) -> tuple[float, float]:
        return self.final.mesh.kernels.heat_beyond
