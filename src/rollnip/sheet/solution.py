"""The solution of a nip with a sheet, as `Solution` but with two interfaces."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from math import isinf, nan
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rollnip._largest import largest
from rollnip._results.profiles import fine_points, slip_in_zones, surface_strain
from rollnip._results.records import DeformedSurfaces, Profiles, Zone
from rollnip.interior import SurfaceTractions
from rollnip.model import FINITE
from rollnip.nip import Creepage, Torque, Traction
from rollnip.rollers import SIDES
from rollnip.rolling import Displacements, MeshSolution, Powers, claims
from rollnip.rolling.claimed_errors import SHARE_OF_CUT, power_left, scaled
from rollnip.rolling.kinematics import stretch_excess, surface_depths
from rollnip.rolling.power_balance import rates_of
from rollnip.sheet.bending import bending_length
from rollnip.sheet.checks import not_prescribed
from rollnip.sheet.figures import NAMES, SheetFigures, scales, shares_of_model
from rollnip.sheet.friction import SIDE_SIGNS, frictions_of
from rollnip.sheet.grip import grip_error, grip_of
from rollnip.sheet.lagged_terms import sheet_rate
from rollnip.sheet.local_deformation import thickness_loss
from rollnip.sheet.membrane.lagged_terms import face_levers
from rollnip.sheet.membrane.linear_system import FactorisedMembrane
from rollnip.sheet.membrane.search import MembraneIterate
from rollnip.sheet.membrane.system import MembraneState
from rollnip.sheet.neglected_bending import neglected_bending_errors, wrapped_length
from rollnip.sheet.refine import Refined
from rollnip.sheet.result import (
    SheetProfiles,
    SheetResult,
    slip_share_of,
    traction_in_slip,
)
from rollnip.sheet.tension import FaceLevers
from rollnip.smooth import SmoothSolution

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False, repr=False)
class SheetSolution(SmoothSolution):
    """A solved nip with a sheet.

    It offers what `Solution` does, with these differences: ``creepage`` is the difference of the
    rollers' speeds, ``traction`` is that on the lower roller (T_l); ``shear``, ``zones`` and the
    slip velocity are those of the upper interface, and ``gap`` is the gap less the sheet.

    Attributes
    ----------
    refined : the solution on the finest mesh and the estimated errors.
    """

    refined: Refined[MembraneIterate] = field(kw_only=True, repr=False, compare=False)

    @property
    def sheet(self) -> SheetResult:
        """Results for the sheet."""
        return self._sheet

    @property
    def creepage(self) -> float:
        """Creepage xi = (V_u - V_l)/V, the sum of those of both interfaces."""
        return sum(self._state.creepages)

    @property
    def traction(self) -> float:
        """Traction T_l on the lower roller [N/mm]; T_u is ``sheet.traction_upper``."""
        return self.refined.figures.traction_lower

    @property
    def peak_pressure_x(self) -> float:
        """Place of the peak pressure [mm]."""
        return self.refined.figures.peak_pressure_x

    @property
    def power_in(self) -> float | None:
        """Power of both axles, M_u V_u/R_u + M_l V_l/R_l [N/s]; None without speed.

        It is the sum of the friction loss, the viscous loss and the power into the sheet.
        """
        if self.nip.speed is None:
            return None
        axles, upper, lower = self._powers, self.refined.figures.traction_upper, self.traction
        rate = rates_of(self.model.geometry, self.creepage)
        creep = 0.5 * self.creepage if self.model.geometry == "linear" else 0.0
        work = rate[0] * axles.driving_upper + rate[1] * axles.driving_lower
        return self.nip.speed * (work + creep * (upper + lower))

    def _claimed_errors(self) -> dict[str, float]:
        nip, out, mine = self.nip, claims(self.final), self._errors
        speed = nan if nip.speed is None else nip.speed
        load, length = self.load, self.nip_width
        lost, resistance = mine["lost_upper"] + mine["lost_lower"], self.rolling_resistance
        out |= {name: largest(out[name], mine[name]) for name in not_prescribed(nip)}
        for side, roller in (("upper", nip.upper), ("lower", nip.lower)):
            off = mine[f"pull_{side}"] + mine[f"lost_{side}"]
            out[f"torque_{side}"] = nan if isinf(roller.radius) else roller.radius * off
        half, traction = 0.5 * self.creepage, mine["traction_lower"]
        if isinstance(nip.tangential, Traction):
            traction = abs(self.traction - nip.tangential.traction)
        return out | {
            "traction": traction,
            "dissipation_friction": speed * (mine["friction_upper"] + mine["friction_lower"]),
            "dissipation_viscous": speed * lost,
            "rolling_resistance": (lost + scaled(resistance, out["load"])) / load,
            "peak_pressure_x": mine["peak_pressure_x"],
            "mean_pressure": load / length * (out["nip_width"] / length + out["load"] / load),
            "dwell_time": out["nip_width"] / speed,
            "speed_ratio": out["creepage"] / (1.0 - half) ** 2,
        }

    @cached_property
    def profiles(self) -> Profiles:
        """Distributions in and outside the nip."""
        x, _ = self._points
        speeds = self._roller_speeds
        strains = [self._strain(x, side) for side in (0, 1)]
        pressure = self._at(x, self.final.pressure)
        gap = self._gap
        return Profiles(
            x=x,
            pressure=pressure,
            shear=self._at(x, self.final.shear),
            gap=np.where(pressure > 0.0, 0.0, np.maximum(gap, 0.0)),
            slip_velocity=self._slip(0),
            strain_upper=strains[0],
            strain_lower=strains[1],
            speed_upper=None if speeds is None else speeds[0] * (1.0 + strains[0]),
            speed_lower=None if speeds is None else speeds[1] * (1.0 + strains[1]),
        )

    @property
    def _gap(self) -> Array:
        """Gap between the surfaces less the sheet, negative where they are pressed into it [mm]."""
        surfaces = self.deformed_surfaces
        return surfaces.upper - surfaces.lower + self._thinned(surfaces.x)

    @cached_property
    def deformed_surfaces(self) -> DeformedSurfaces:
        """Heights of both surfaces; the sheet between them is taken without its thickness."""
        x, u = self._points
        upper, lower = surface_depths(x, self.nip, self.model.geometry, u)
        return DeformedSurfaces(x, upper - self.final.state.approach, -lower)

    @cached_property
    def _sheet(self) -> SheetResult:
        (upper, lower), speed, half = self._state.creepages, self.nip.speed, 0.5 * self.creepage
        figures = self.refined.figures

        def power(value: float) -> float | None:
            return None if speed is None else speed * value

        tractions = figures.traction_upper, figures.traction_lower
        pressed = self.load + self.refined.iterate.lagged.lean
        return SheetResult(
            creepage_upper=upper,
            creepage_lower=lower,
            feed_upper=-upper / (1.0 + half),
            feed_lower=lower / (1.0 - half),
            speed=power(sheet_rate(upper, lower)),
            traction_upper=tractions[0],
            traction_lower=tractions[1],
            tension_max=figures.tension_max,
            tension_min=figures.tension_min,
            strain_max=figures.strain_max,
            friction_upper=power(figures.friction_upper),
            friction_lower=power(figures.friction_lower),
            power=power(figures.into_sheet),
            slip_share_upper=slip_share_of(self._zones(0)),
            slip_share_lower=slip_share_of(self._zones(1)),
            zones_lower=self._zones(1),
            bending_length=bending_length(self.nip),
            bends=self.bends,
            nip_width_lower=self.on_lower_side[0],
            peak_pressure_lower=self.on_lower_side[1],
            grip=grip_of(self.nip, pressed, tractions, self._sliding(), self._levers),
            profiles=self._sheet_profiles(),
            error=self.sheet_errors(),
        )

    def _sheet_profiles(self) -> SheetProfiles:
        x, _ = self._points
        below = self._of_side(1)
        return SheetProfiles(
            x,
            shear_lower=self._at(x, below.shear, 1),
            tension=self._tension(x),
            strain=self._strain_of_sheet(x),
            slip_velocity_lower=self._slip(1),
            pressure_lower=self._at(x, below.pressure, 1),
            height=self._height,
        )

    @property
    def _height(self) -> Array:
        """Height of the sheet's path at ``_points``, without its thickness [mm]."""
        surfaces = self.deformed_surfaces
        return np.asarray(0.5 * (surfaces.upper + surfaces.lower))

    @property
    def bends(self) -> bool:
        """Whether the sheet's bending stiffness is included."""
        return False

    @property
    def on_lower_side(self) -> tuple[float, float]:
        """Width of the lower interface [mm], and the peak pressure on it [MPa]."""
        figures = self.refined.lower
        return figures.nip_width, figures.peak_pressure

    @property
    def _lower_errors(self) -> tuple[float, float]:
        """Estimated errors of ``on_lower_side``."""
        mine = self._claimed(self.refined.lower, self.refined.lower_errors)
        return mine["nip_width"], mine["peak_pressure"]

    def sheet_errors(self) -> dict[str, float]:
        """Return the errors of the figures of the sheet by name."""
        mine, creepages, half = self._errors, self._state.creepages, 0.5 * self.creepage
        speed = nan if self.nip.speed is None else self.nip.speed
        names = ("creepage_upper", "creepage_lower", "traction_upper", "traction_lower")
        out = {name: mine[name] for name in (*names, "tension_max", "tension_min", "strain_max")}
        out |= {name: speed * mine[name] for name in ("friction_upper", "friction_lower")}
        out["nip_width_lower"], out["peak_pressure_lower"] = self._lower_errors
        both = mine["creepage_upper"] + mine["creepage_lower"]
        out |= {"speed": 0.5 * speed * both, "power": speed * mine["into_sheet"]}
        out["grip_reserve"] = grip_error(self.nip, mine)
        for side, rate, creepage in zip(SIDES, (1.0 + half, 1.0 - half), creepages, strict=True):
            out[f"feed_{side}"] = mine[f"creepage_{side}"] / rate + 0.5 * abs(creepage) * both
        return out

    @cached_property
    def _errors(self) -> dict[str, float]:
        """Errors of all figures of the refinement, at least those of the model itself."""
        figures = self.refined.figures
        mine = self._claimed(figures, self.refined.errors)
        if isinstance(self.nip.tangential, Creepage) and self.model.geometry in FINITE:
            passed = mine["creepage"] * self._traction_slope()
            sides = ("traction_upper", "traction_lower")
            mine |= {name: largest(mine[name], passed) for name in sides}
        if isinstance(self.nip.tangential, Creepage | Torque):
            return mine
        mine["traction_lower"] = abs(self.traction - self.nip.tangential.traction)
        if self.model.geometry != "linear":  # levers and length of the path are lagged
            return mine
        sheet = self.refined.iterate.problem.sheet
        wanted = self.nip.tangential.traction + sheet.tension_in - sheet.tension_out
        mine["traction_upper"] = abs(figures.traction_upper - wanted)
        return mine

    @property
    def _system(self) -> Any:
        """The factorised linear system of the solution."""
        iterate = self.refined.iterate
        return FactorisedMembrane.of(iterate.problem, iterate.state.both_states)

    def _traction_slope(self) -> float:
        """Return the derivative of both tractions by the creepage, for given nodal states [N/mm].

        It turns an error of the creepage at a given traction into one of the traction at a given
        creepage, as without a sheet.
        """
        system, lagged, tractions = self._system, self.refined.iterate.lagged, []
        for creepage in (0.0, 1.0):  # the tractions are linear in it
            nip = replace(self.nip, tangential=Creepage(creepage))
            one = replace(system, problem=replace(system.problem, nip=nip))
            shear = one.solved(lagged).side(1).shear
            tractions.append(float(system.problem.meshes[1].weights @ shear))
        return abs(tractions[1] - tractions[0])

    def _claimed(self, figures: SheetFigures, errors: SheetFigures) -> dict[str, float]:
        """Return errors by name, at least the uncertainty that the model's own order leaves."""
        sides, cut = self.refined.figures_by_side, self.final.cut
        shares = shares_of_model(self.nip, self.model.geometry, sides, cut, bends=self.bends)
        least = shares * scales(self.nip, figures)
        sheet = self.nip.sheet
        if sheet is not None and sheet.bending is None and not self.bends:
            edges = self.refined.iterate.zones.edges
            wrapped = wrapped_length(self.nip, self.deformed_surfaces, edges)
            least += neglected_bending_errors(self.nip, figures, wrapped)
        out = dict(zip(NAMES, np.maximum(errors.values, least).tolist(), strict=True))
        if self.model.geometry not in FINITE:
            return out
        for number, (side, loss) in enumerate(zip(SIDES, self.refined.cut_losses, strict=True)):
            # An error of the creepage changes the slip velocity, and so the power of the shears
            # in slip, which may cancel in the traction.
            in_slip = traction_in_slip(self._of_side(number))
            traction = largest(abs(getattr(figures, f"traction_{side}")), in_slip)
            passed = power_left(out[f"creepage_{side}"], traction, self.final)
            for name in (f"friction_{side}", f"pull_{side}"):
                out[name] = largest(out[name], SHARE_OF_CUT * loss, passed)
        return out

    @cached_property
    def zones(self) -> tuple[Zone, ...]:
        """Stick and slip zones of the upper interface from trailing to leading edge."""
        return self._zones(0)

    def _zones(self, side: int) -> tuple[Zone, ...]:
        return Zone.of(self.refined.iterate.zones.sides[side].zones)

    @property
    def _state(self) -> MembraneState:
        return self.refined.iterate.state

    @cached_property
    def _powers(self) -> Powers:
        return self.refined.figures.powers.as_bare

    def _tractions_on(self, roller: str) -> SurfaceTractions:
        """Return the tractions on one surface in its own frame: (q_u, p) above, (-q_l, p) below."""
        side = 0 if roller == "upper" else 1
        one = self._of_side(side)
        return SurfaceTractions.on_inner(one.nodes, SIDE_SIGNS[side] * one.shear, one.pressure)

    def _of_side(self, side: int) -> MeshSolution:
        """Return the solution in the form of one interface."""
        return self.final if side == 0 else replace(self.final, state=self._state.side(side))

    def _at(self, x: Array, traction: Array, side: int = 0) -> Array:
        return np.interp(x, self._of_side(side).x, traction, left=0.0, right=0.0)

    def _strain(self, x: Array, side: int) -> Array:
        return surface_strain(x, self._of_side(side), side=SIDES[side])

    def _tension(self, x: Array) -> Array:
        """Return the tension of the sheet, exact at the nodes between which shears are linear."""
        iterate, state = self.refined.iterate, self._state
        nodes, problem = self.final.nodes, iterate.problem
        shear = np.zeros(nodes.size)
        shear[1:-1] = problem.mesh.acting(state.shear - state.shear_lower)
        pieces = 0.5 * problem.arcs * np.diff(nodes) * (shear[1:] + shear[:-1])
        beyond = np.append(np.cumsum(pieces[::-1])[::-1], 0.0)
        return np.asarray(iterate.lagged.known.at(x) - np.interp(x, nodes, beyond))

    def _strain_of_sheet(self, x: Array) -> Array:
        """Return the strain of the sheet due to its tension and the pressure on it."""
        sheet = self.refined.iterate.problem.sheet
        pressure = self._at(x, self.final.pressure)
        return sheet.stretch_by_tension * self._tension(x) + sheet.stretch_by_pressure * pressure

    def _thinned(self, x: Array) -> Array:
        """Return the loss of the sheet's thickness under load [mm]."""
        sheet, acting = self.refined.iterate.problem.sheet, self.final.pressure
        thinner = thickness_loss(sheet, x, self.final.nodes, acting[:, None])[:, 0]
        return thinner + sheet.stretch_by_pressure * self._tension(x)

    @cached_property
    def _points(self) -> tuple[Array, Displacements]:
        """Places in and outside the nip, and the displacements of both surfaces there."""
        x, kernels = fine_points(self.final), self.final.contact.kernels
        mesh, state = self.refined.iterate.problem.mesh, self._state
        u = mesh.linear_displacements_at(x, state)
        if kernels.is_linear:
            return x, u
        held = kernels.held or mesh.second_fields(state)
        return x, u + held.at(x)

    @property
    def _levers(self) -> tuple[FaceLevers, FaceLevers] | None:
        """Forces on both faces of the sheet, and their levers; None where these are neglected."""
        problem, state = self.refined.iterate.problem, self._state
        is_linear = self.model.geometry == "linear"
        return None if is_linear else face_levers(problem, state, problem.mesh.displacements(state))

    def _sliding(self) -> tuple[Array, Array]:
        """Return creeps per length in full sliding, see `grip.first_to_slide`."""
        iterate, state = self.refined.iterate, self._state
        mu_u, mu_l = frictions_of(self.nip)
        above, below = mu_u * state.pressure, -mu_l * state.pressure
        slid = replace(state, shear=above, shear_lower=below, creepage=0.0, creepage_lower=0.0)
        _, upper, lower = iterate.problem.gap_and_creeps(slid, iterate.lagged)[:, :-1]
        length = iterate.problem.dx[:-1]
        return upper / length, lower / length

    def _slip(self, side: int) -> Array | None:
        """Return the slip velocity of the upper relative to the lower surface of an interface."""
        speed = self.nip.speed
        if speed is None:
            return None
        x, u = self._points
        stretch = stretch_excess(x, self.nip, self.model.geometry, u)[side] / np.diff(x)
        strain = self._strain_of_sheet(x)
        excess = stretch - 0.5 * (strain[1:] + strain[:-1])
        rate = self._state.creepages[side] + SIDE_SIGNS[side] * excess + self._bent(x)
        return slip_in_zones(x, -speed * rate, self.refined.iterate.zones.sides[side].zones)

    def _bent(self, _: Array) -> Array:
        """Return the strain of the lower face by bending, in the intervals between given places."""
        return np.zeros(1)
