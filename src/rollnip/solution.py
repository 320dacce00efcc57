"""The result of a solve: frozen data and the figures derived from it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from functools import cached_property
from math import isinf, nan
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rollnip._blas import one_blas_thread
from rollnip._errors import InvalidInputError
from rollnip._results.presented import Presented
from rollnip._results.records import DeformedSurfaces, Profiles, SolverInfo, Zone
from rollnip.interior import (
    FiniteFields,
    InterfaceStress,
    InteriorField,
    SurfaceTractions,
    beyond_linear,
    interface_stresses,
    interior_field,
    loss_below,
)
from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.reservation import Reservation, texts
from rollnip.rollers import Side
from rollnip.rolling import Powers, peak_at, peaks_alike, rates_of

__all__ = ["DeformedSurfaces", "Profiles", "Solution", "SolverInfo", "Zone"]

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False, repr=False)
class Solution(Presented, ABC):
    """A solved nip. Units mm, N, MPa, s; x points to the leading edge (the inlet).

    This class holds what every solution has. `solve` returns a `rollnip.smooth.SmoothSolution`;
    with a sheet in the nip, a `rollnip.sheet.SheetSolution`; with a measured profile, a
    `rollnip.rough.RoughSolution`.

    Attributes
    ----------
    nip, model : the problem that was solved, and the model (geometry and tolerance) used.
    converged : whether the contact conditions, checked again at more points, and the estimated
        errors are within the tolerance.
    status : a sentence that says so, or what is wrong and what helps.
    reservations : records of what the user should know about the result; `warnings` has their
        sentences.
    solver : size of the mesh, iterations, residual and time.
    max_surface_strain : largest strain of either surface in the contact, each a mean over one
        element; None where it was not computed.
    """

    nip: Nip
    model: Model
    converged: bool
    status: str
    reservations: tuple[Reservation, ...]
    solver: SolverInfo
    max_surface_strain: float | None = field(default=None, kw_only=True, repr=False)

    @property
    def warnings(self) -> tuple[str, ...]:
        """The sentences of `reservations`."""
        return texts(self.reservations)

    @property
    def sheet(self) -> Any:
        """Results for the sheet in the nip, a `rollnip.sheet.SheetResult`; None without a sheet."""
        return None

    @property
    @abstractmethod
    def load(self) -> float:
        """Line load F [N/mm]."""

    @property
    @abstractmethod
    def approach(self) -> float | None:
        """Approach delta of the axles [mm]; None with a half-space core, where it is infinite."""

    @property
    @abstractmethod
    def creepage(self) -> float | None:
        """Creepage xi = (V_u - V_l)/V; None without friction, unless it was prescribed."""

    @property
    @abstractmethod
    def traction(self) -> float:
        """Traction T = int q dx [N/mm]; T > 0: the upper roller drives the lower one.

        In the geometries "curved" and "corrected" q is taken per undeformed arc, as the mean of
        both rollers.
        """

    @property
    def speed_ratio(self) -> float | None:
        """V_u/V_l; None where the creepage is."""
        xi = self.creepage
        return None if xi is None else (1.0 + 0.5 * xi) / (1.0 - 0.5 * xi)

    @property
    @abstractmethod
    def contact(self) -> tuple[tuple[float, float], ...]:
        """Contact intervals (trailing, leading) [mm], trailing first."""

    @property
    @abstractmethod
    def nip_width(self) -> float:
        """Nip width, from the outermost trailing to the outermost leading edge [mm]."""

    @property
    def dwell_time(self) -> float | None:
        """Nip width over speed [s]; None without speed."""
        return None if self.nip.speed is None else self.nip_width / self.nip.speed

    @property
    @abstractmethod
    def peak_pressure(self) -> float:
        """Highest pressure [MPa]."""

    @property
    @abstractmethod
    def peak_pressure_x(self) -> float:
        """Place of the highest pressure [mm]; of several equally high peaks, the leading one."""

    @property
    def peaks_alike_x(self) -> tuple[float, ...]:
        """Places of further peaks that are as high as the highest to four digits [mm]."""
        x, p = self.nodes, self.pressure
        return tuple(peak_at(x, p, i)[1] for i in peaks_alike(p)[:-1])

    @property
    def mean_pressure(self) -> float:
        """Line load over the total length of the contact intervals [MPa]."""
        return self.load / sum(leading - trailing for trailing, leading in self.contact)

    @property
    @abstractmethod
    def zones(self) -> tuple[Zone, ...]:
        """Stick and slip zones from trailing to leading edge; empty without friction."""

    @property
    def torque_upper(self) -> float | None:
        """Driving torque on the upper axle per axial length [N]; None for a plane."""
        radius = self.nip.upper.radius
        return None if isinf(radius) else radius * self._powers.driving_upper

    @property
    def torque_lower(self) -> float | None:
        """Driving torque on the lower axle per axial length [N]; None for a plane."""
        radius = self.nip.lower.radius
        return None if isinf(radius) else radius * self._powers.driving_lower

    @property
    def dissipation_friction(self) -> float | None:
        """Power lost by slip, -int q s dx over the slip zones [N/s = mW/mm]; None without speed."""
        return None if self.nip.speed is None else self.nip.speed * self._powers.friction

    @property
    def dissipation_viscous(self) -> float | None:
        """Power lost inside the layers [N/s = mW/mm]; 0 for elastic layers, None without speed.

        It is computed from the loss part of their compliance, and so is never negative.
        """
        return None if self.nip.speed is None else self.nip.speed * self._lost_inside

    @property
    def rolling_resistance(self) -> float:
        """Viscous dissipation over line load times speed, D/(F V)."""
        return self._lost_inside / self.load

    @property
    def power_in(self) -> float | None:
        """Power supplied by both axles, M_u V_u/R_u + M_l V_l/R_l [N/s]; None without speed.

        The geometries "linear" and "corrected" leave out products of creepage and strain. There
        only the part T R of a torque is multiplied by the speed of its own roller, the rest by V.
        """
        if self.nip.speed is None:
            return None
        driving, traction = self._powers, self.traction
        rates = self._rates
        upper = rates[0] * (driving.driving_upper - traction)
        lower = rates[1] * (driving.driving_lower + traction)
        return self.nip.speed * (traction * (self.creepage or 0.0) + upper + lower)

    @property
    def error(self) -> dict[str, float]:
        """Estimated absolute errors, each in the unit of its figure; nan where it is undefined.

        They are what the mesh leaves, and in geometry "second" at least what the second order
        leaves out. `converged` and `status` follow from the errors of those figures that
        `Model.tolerance` is for. The error of a prescribed figure is its distance from the
        prescribed value.
        """
        return dict(self._claims)

    @cached_property
    @one_blas_thread()
    def _claims(self) -> dict[str, float]:
        return self._claimed_errors()

    @abstractmethod
    def _claimed_errors(self) -> dict[str, float]:
        """Return the mapping for `error`."""

    @property
    @abstractmethod
    def profiles(self) -> Profiles:
        """Pressure, shear, gap, slip velocity, strains and speeds, in the nip and beside it."""

    @property
    @abstractmethod
    def deformed_surfaces(self) -> DeformedSurfaces:
        """Heights of both surfaces in the nip and beside it, with the gap of the geometry model.

        With a half-space core the approach is infinite; heights are then relative to a displacement
        that is left out.
        """

    @property
    @abstractmethod
    def nodes(self) -> Array:
        """Nodes of the mesh that carry tractions, from trailing to leading edge, (n,) [mm]."""

    @property
    @abstractmethod
    def pressure(self) -> Array:
        """Pressure at the nodes, linear between them, (n,) [MPa]; it integrates to the load.

        The mean over each element is right, so that a nodal value may exceed ``peak_pressure`` by a
        few 1e-4 of it.
        """

    @property
    @abstractmethod
    def shear(self) -> Array:
        """Shear stress on the upper roller along +x, linear between the nodes, (n,) [MPa].

        At nodes in stick beside a transition to slip it may exceed friction times pressure, within
        the tolerance.
        """

    @one_blas_thread()
    def interior(
        self,
        roller: Side,
        z: ArrayLike,
        x: ArrayLike | None = None,
        *,
        side: Literal["above", "below"] = "above",
    ) -> InteriorField:
        """Return displacements, stresses and strains inside a roller, in its own frame.

        The fields are those of finite strain in geometry "finite" inside layers on rigid cores, and
        those of linear theory otherwise.

        Parameters
        ----------
        roller : "upper" or "lower".
        z : (nz,) or scalar depths [mm], 0 at the surface; any depth on a half-space core.
        x :
            (nx,) or scalar places [mm], up to half a turn of the smaller roller to either side;
            None: 401 places up to one nip width outside the contact.
        side : the layer that a depth on an interface belongs to: the one "above" or the one "below"
            it.

        Returns
        -------
        InteriorField; arrays of shape (nz, nx), stresses [MPa] negative in compression,
        displacements in mm.

        Raises
        ------
        InvalidInputError
            where the roller is unknown or a bare rigid core, a depth lies outside the layers, a
            place lies beyond half a turn, a value is not finite, or an array is empty.
        """
        if roller not in ("upper", "lower"):
            raise InvalidInputError(f'`roller` must be "upper" or "lower", got {roller!r}.')
        return interior_field(
            self.nip.upper if roller == "upper" else self.nip.lower,
            self._tractions_on(roller),
            z,
            self._section if x is None else x,
            geometry=self.model.geometry,
            speed=self.nip.speed,
            side=side,
            window=float(np.pi) * min(self.nip.upper.radius, self.nip.lower.radius),
            beyond=self._beyond(roller),
        )

    @one_blas_thread()
    def heat_below(self, roller: Side, z: ArrayLike) -> Array | None:
        """Return the power lost inside a roller below given depths; None without speed.

        Parameters
        ----------
        roller : "upper" or "lower".
        z : (nz,) depths [mm], from 0 at the surface to the bottom of the layers.

        Returns
        -------
        (nz,) powers [N/s = mW/mm]. At depth 0 it is all that the roller loses (0 for an elastic
        one); the sum for both rollers is then ``dissipation_viscous``. In geometry "finite" it is
        the loss at finite strain, distributed over the depth as in linear theory.
        """
        if self.nip.speed is None:
            return None
        upper = roller == "upper"
        one, rate = (self.nip.upper, self._rates[0]) if upper else (self.nip.lower, self._rates[1])
        depths = np.append(0.0, np.atleast_1d(np.asarray(z, dtype=float)))
        given = self.model.geometry, self.nip.speed
        lost = loss_below(one, self._tractions_on(roller), depths, *given)
        further = self._heat_beyond[0 if upper else 1]
        share = 1.0 + further / lost[0] if lost[0] > 0.0 else 1.0
        return np.asarray(self.nip.speed * rate * share * lost[1:])

    @cached_property
    @one_blas_thread()
    def interfaces(self) -> tuple[InterfaceStress, ...]:
        """Stresses on every interface of layers and every bond to a core, upper roller first."""
        x = np.union1d(self._section, self.nodes)
        model = (self.model.geometry, self.nip.speed)
        found: tuple[InterfaceStress, ...] = ()
        for name, roller in (("upper", self.nip.upper), ("lower", self.nip.lower)):
            given = self._tractions_on(name), x, model, self._beyond(name)
            found += interface_stresses(name, roller, *given)
        return found

    def is_finite_inside(self, roller: Side) -> bool:
        """Return whether the fields of `interior` are of finite strain, not of linear theory."""
        return self._beyond(roller) is not None

    def _beyond(self, roller: str) -> FiniteFields | None:
        """Return what finite strain adds to the linear fields inside a roller; None if nothing."""
        if roller not in self._found_inside:
            upper, speed = roller == "upper", self.nip.speed
            one, rate = (self.nip.upper if upper else self.nip.lower), self._rates[not upper]
            given = self._tractions_on(roller), None if speed is None else (speed, rate * speed)
            self._found_inside[roller] = beyond_linear(one, self.model.geometry, *given)
        return self._found_inside[roller]

    @cached_property
    def _found_inside(self) -> dict[str, FiniteFields | None]:
        return {}

    @property
    def _heat_beyond(self) -> tuple[float, float]:
        """Heat of the upper and lower roller beyond linear theory, over V [N/mm]."""
        return 0.0, 0.0

    @property
    def _section(self) -> Array:
        """401 places, up to one nip width beyond either edge of the contact [mm]."""
        trailing, leading = self.contact[0][0], self.contact[-1][1]
        return np.linspace(trailing - self.nip_width, leading + self.nip_width, 401)

    @abstractmethod
    def _tractions_on(self, roller: str) -> SurfaceTractions:
        """Return the tractions on one surface in its own frame: upper (q, p), lower (-q, p)."""

    @property
    def _roller_speeds(self) -> tuple[float, float] | None:
        """Circumferential speeds V_u, V_l [mm/s]; None without speed or creepage."""
        if self.nip.speed is None or self.creepage is None:
            return None
        half = 0.5 * self.creepage
        return self.nip.speed * (1.0 + half), self.nip.speed * (1.0 - half)

    @property
    @abstractmethod
    def _powers(self) -> Powers:
        """Torques and losses of the contact, over V."""

    @property
    def _rates(self) -> tuple[float, float]:
        return rates_of(self.model.geometry, nan if self.creepage is None else self.creepage)

    @property
    def _lost_inside(self) -> float:
        """Viscous loss of both rollers over V [N/mm]."""
        rates, lost = self._rates, self._powers
        return rates[0] * lost.lost_upper + rates[1] * lost.lost_lower
