"""A solved face: figures over y, evenness, totals, and their errors."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rollnip._extras import require_extra
from rollnip._results.summary import one_line
from rollnip._sealed import sealed
from rollnip.face.figures import FACE_PROFILES
from rollnip.face.law import NipLaw
from rollnip.face.problem import FaceProblem
from rollnip.face.sheet_law import SheetLaw
from rollnip.face.solve import Balance, plane_load, torque
from rollnip.model import Model
from rollnip.nip import Nip
from rollnip.reservation import Reservation, texts
from rollnip.shafts import Face

Array = NDArray[np.float64]

_EVEN = 0.1  # departure over the mean load, up to which a place counts as even
_ROUNDING = 1e-7  # error of a traction that iterations leave, over the largest load
_FINE = 2001  # places of an evenly spaced grid for computing shares of the face


@dataclass(frozen=True, slots=True)
class Bearings:
    """Forces of the two bearings on a roller, towards the other roller [N].

    Attributes
    ----------
    first, second : at y < 0 and at y > 0.
    """

    first: float
    second: float


@dataclass(frozen=True, eq=False, repr=False)
class FaceSolution:
    """A nip along its face. Units mm, N, MPa, s; y from one end of the face to the other.

    Attributes
    ----------
    nip, face, model : the problem.
    converged : whether the balance settled and every claimed error is within what the tolerance
        allows.
    status : a sentence that says so, or what is wrong.
    reservations : where the nip is open or slides, and what its plane nips leave out.
    error : relative errors: of approach, nip width and peak pressure by interpolation between plane
        nips, of the load by the number of places along the face ("places"), and of the total load
        by ends that are not plane ("ends").
    law : the table of cross-sections.
    """

    nip: Nip
    face: Face
    model: Model
    converged: bool
    status: str
    reservations: tuple[Reservation, ...]
    error: dict[str, float]
    law: NipLaw | SheetLaw = field(repr=False)
    problem: FaceProblem = field(repr=False)
    balance: Balance = field(repr=False)

    def __repr__(self) -> str:
        shown = [
            f"{one.label} {one.text(values.min())} to {one.text(values.max())}"
            for one, values in (
                (FACE_PROFILES["load"], self.load),
                (FACE_PROFILES["nip_width"], self.nip_width),
                (FACE_PROFILES["peak_pressure"], self.peak_pressure),
            )
        ]
        return one_line(self, self.nip.title, f", geometry {self.model.geometry}", *shown)

    @property
    def warnings(self) -> tuple[str, ...]:
        """The sentences of the reservations."""
        return texts(self.reservations)

    @property
    def y(self) -> Array:
        """Places along the face, (n,), from -length/2 to length/2 [mm]."""
        return sealed(self.problem.grid.y)

    @property
    def load(self) -> Array:
        """Line load, (n,) [N/mm]; 0 where the nip is open."""
        return sealed(self.balance.section.load)

    @property
    def approach(self) -> Array:
        """Approach of the surfaces, (n,) [mm]; where the nip is open, minus the gap."""
        return sealed(self.balance.approach)

    @property
    def traction(self) -> Array:
        """Traction, (n,) [N/mm]; the upper roller drives where it is positive."""
        return sealed(self.balance.section.traction)

    @property
    def creepage(self) -> float:
        """Creepage of both rollers as wholes, by their nominal radii."""
        return self.balance.creepage

    @property
    def local_creepage(self) -> Array:
        """Creepage with the local radii, (n,)."""
        return self.creepage + self.problem.local

    @cached_property
    def nip_width(self) -> Array:
        """Nip width, (n,) [mm]."""
        return self._of_law("nip_width")

    @cached_property
    def peak_pressure(self) -> Array:
        """Peak pressure, (n,) [MPa]."""
        relief = self.problem.relief
        if relief is None:
            return self._of_law("peak_pressure")
        load, peak = relief.ratios(self.problem.grid)
        safe = np.where(load > 0.0, load, 1.0)
        return sealed(self._of_law("peak_pressure") * np.where(load > 0.0, peak / safe, 0.0))

    @cached_property
    def slip_width(self) -> Array:
        """Part of the nip width over which the surfaces slip, (n,) [mm]; 0 without friction."""
        return sealed(np.clip(self._of_law("slip_width"), 0.0, self.nip_width))

    @cached_property
    def torque_upper(self) -> Array | None:
        """Driving torque on the upper axle per length, (n,) [N]; None for a plane."""
        return self._torque("upper")

    @cached_property
    def torque_lower(self) -> Array | None:
        """Driving torque on the lower axle per length, (n,) [N]; None for a plane."""
        return self._torque("lower")

    @cached_property
    def friction_loss(self) -> Array | None:
        """Friction loss, (n,) [N/s = mW/mm]; None without speed."""
        return None if self.nip.speed is None else self._of_law("friction_loss")

    @cached_property
    def viscous_loss(self) -> Array | None:
        """Viscous loss, (n,) [N/s = mW/mm]; None without speed."""
        return None if self.nip.speed is None else self._of_law("viscous_loss")

    @property
    def deflection_upper(self) -> Array:
        """Deflection of the upper axis away from the lower roller, from its bearings, (n,) [mm]."""
        return self.problem.upper @ (self.load - self.problem.weights[0])

    @property
    def deflection_lower(self) -> Array:
        """Deflection of the lower axis away from the upper roller, from its bearings, (n,) [mm]."""
        return self.problem.lower @ (self.load + self.problem.weights[1])

    @property
    def total_load(self) -> float:
        """Force of the whole nip [N]."""
        return float(self.problem.grid.weights @ self.load)

    @property
    def total_traction(self) -> float:
        """Tangential force of the whole nip [N]."""
        return float(self.problem.grid.weights @ self.traction)

    @property
    def mean_load(self) -> float:
        """Mean line load [N/mm]."""
        return self.total_load / self.face.length

    @property
    def total_torque_upper(self) -> float | None:
        """Driving torque on the upper axle [N mm]; None for a plane."""
        return self._total(self.torque_upper)

    @property
    def total_torque_lower(self) -> float | None:
        """Driving torque on the lower axle [N mm]; None for a plane."""
        return self._total(self.torque_lower)

    @property
    def total_friction_loss(self) -> float | None:
        """Heat generated where surfaces slip, whole face [N mm/s = mW]; None without speed."""
        return self._total(self.friction_loss)

    @property
    def total_viscous_loss(self) -> float | None:
        """Heat generated inside the layers, whole face [N mm/s = mW]; None without speed."""
        return self._total(self.viscous_loss)

    @property
    def power_upper(self) -> float | None:
        """Power supplied by the upper axle [N mm/s = mW]; None without speed, and for a plane."""
        return self._power(self.total_torque_upper, self.nip.upper.curvature, 1.0)

    @property
    def power_lower(self) -> float | None:
        """Power supplied by the lower axle [N mm/s = mW]; None without speed, and for a plane."""
        return self._power(self.total_torque_lower, self.nip.lower.curvature, -1.0)

    @property
    def bearing_offset(self) -> float | None:
        """Travel of the upper bearing at y > 0 minus that of the other [mm].

        None without a shaft of the upper roller.
        """
        shaft = self.nip.upper.shaft
        return None if shaft is None else self.balance.tilt * shaft.bearing_distance

    @property
    def plane_load(self) -> Array:
        """Line load of plane nips at the approaches of the face, (n,) [N/mm].

        It is `load` without the effect of the ends of the face.
        """
        return sealed(plane_load(self.problem, self.balance))

    @property
    def added_length(self) -> float | None:
        """Length of face that both ends add to the load [mm]; negative where they carry less.

        None where the nip is taken as plane up to the ends.
        """
        relief = self.problem.relief
        return None if relief is None else relief.added_length

    @property
    def evenness(self) -> float:
        """Smallest over largest line load; 0 where the nip is open somewhere.

        This and the other figures of evenness take the nip as plane up to both ends of the face.
        """
        return float(self.plane_load.min() / self.plane_load.max())

    @property
    def largest_departure(self) -> float:
        """Largest departure of the line load from its mean, over the mean."""
        load = self.plane_load
        return float(np.max(np.abs(load / self._mean(load) - 1.0)))

    @property
    def even_share(self) -> float:
        """Share of the face whose line load is within 10 % of the mean."""
        return self.share_within(_EVEN)

    def share_within(self, share: float) -> float:
        """Return the share of the face whose line load is within ``share`` of the mean."""
        y = np.linspace(self.y[0], self.y[-1], _FINE)
        load = self.plane_load
        off = np.abs(np.interp(y, self.y, load) / self._mean(load) - 1.0)
        return float(np.mean(off <= share))

    @property
    def largest_scrub(self) -> float:
        """Largest departure of the traction from its mean [N/mm], a measure of scrubbing."""
        mean = self.total_traction / self.face.length
        scrub = float(np.max(np.abs(self.traction - mean)))
        return scrub if scrub > _ROUNDING * float(np.max(self.load)) else 0.0

    def to_xarray(self) -> Any:
        """Return the face as an xarray Dataset over y, with the contents of a result's netCDF file.

        Raises
        ------
        RollnipError
            where xarray is not installed.
        """
        from rollnip.face.report import face_dict, face_variables

        require_extra("netcdf", "to_xarray")
        import xarray as xr

        variables, attributes = face_variables(face_dict(self))
        return xr.Dataset(variables, attrs=attributes).set_coords("y")

    def bearings(self, roller: str) -> Bearings | None:
        """Return the bearing forces of the "upper" or "lower" roller; None without its shaft."""
        one = self.nip.upper if roller == "upper" else self.nip.lower
        if one.shaft is None:
            return None
        weight = self.problem.weights[0 if roller == "upper" else 1]
        pushed = self.load - weight if roller == "upper" else self.load + weight
        weights, middle = self.problem.grid.weights, one.shaft.bearing_middle
        moment = float(weights @ (pushed * (self.y - middle))) / one.shaft.bearing_distance
        half = 0.5 * float(weights @ pushed)
        return Bearings(half - moment, half + moment)

    def _torque(self, roller: str) -> Array | None:
        found = self.balance
        assert isinstance(self.law, NipLaw)
        values = torque(self.problem, self.law, found.section, found.places, roller)
        return None if np.isnan(values).any() else sealed(values)

    def _power(self, torque: float | None, curvature: float, sign: float) -> float | None:
        """Return torque times angular speed; both rollers turn as wholes, by nominal radii."""
        speed = self.nip.speed
        if torque is None or speed is None:
            return None
        return torque * curvature * speed * (1.0 + sign * 0.5 * self.creepage)

    def _mean(self, values: Array) -> float:
        return float(self.problem.grid.weights @ values) / self.face.length

    def _total(self, values: Array | None) -> float | None:
        return None if values is None else float(self.problem.grid.weights @ values)

    def _of_law(self, name: str) -> Array:
        found = self.balance
        assert isinstance(self.law, NipLaw)
        values = self.law.figure(name, found.section.log_load, found.section.s, found.places)
        return sealed(np.where(self.load > 0.0, values, 0.0))
