"""Assembly of the discrete contact problem of a nip on a mesh, with the terms that lag behind."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import isfinite, isnan, nan, sqrt

import numpy as np

from rollnip._largest import largest
from rollnip.contact import (
    ContactProblem,
    ContactState,
    Control,
    carry,
    contact_zones,
)
from rollnip.contact.problem import Array
from rollnip.model import FINITE, RINGS
from rollnip.nip import Approach, Creepage, LineLoad, Nip, Torque, Traction
from rollnip.rolling.changes import scale_of_creepage
from rollnip.rolling.displacements import Displacements
from rollnip.rolling.kinematics import stretch_parts, surface_depths
from rollnip.rolling.rolling_contact import RollingContact
from rollnip.rolling.surface_work import loss_inside, slip_intervals, transmitted
from rollnip.rolling.surfaces import Mesh


@dataclass(frozen=True, slots=True)
class LaggedTerms:
    """Terms of the contact conditions that depend on the solution, taken from the last iterate.

    Attributes
    ----------
    clearance : (n,) added to the gap [mm].
    creep_length : (n,) added to the interval lengths that multiply xi [mm].
    creep_offset : (n,) added to the creep [mm].
    traction : traction that gives the prescribed torque [N/mm]; None where no torque is prescribed.
        Where friction cannot carry it, half way from the last one to what friction carries.
    beyond : what the prescribed torque asks for in addition [N/mm].
    lean : line load that the shear takes off that of the pressure, as the interface is tilted:
        int q slope dx [N/mm].
    """

    clearance: Array
    creep_length: Array
    creep_offset: Array
    traction: float | None
    lean: float = 0.0
    beyond: float = 0.0

    @property
    def wanted_traction(self) -> float | None:
        """Traction that the prescribed torque asks for; None if there is none [N/mm]."""
        return None if self.traction is None else self.traction + self.beyond

    def nearer_to(self, reached: float) -> LaggedTerms:
        """Return these terms with a traction half way from one that friction carries [N/mm]."""
        if self.traction is None:
            return self
        half = 0.5 * (self.traction + reached)
        return replace(self, traction=half, beyond=self.traction + self.beyond - half)

    def carried(self, old: Mesh, new: Mesh) -> LaggedTerms:
        """Return these terms interpolated to another mesh, zone by zone if both have like zones."""
        matrices = carry(old.fine, new.fine)
        rates = self.creep_length / old.dx, self.creep_offset / old.dx
        if matrices is not None:
            nodes, intervals = matrices
            clearance = nodes @ self.clearance
            length, offset = (intervals @ rate for rate in rates)
        else:
            clearance = np.interp(new.inner, old.inner, self.clearance)
            middles, places = (0.5 * (x[1:-1] + x[2:]) for x in (old.nodes, new.nodes))
            length, offset = (np.interp(places, middles, rate) for rate in rates)
        length, offset = new.dx * length, new.dx * offset
        return LaggedTerms(clearance, length, offset, self.traction, self.lean, self.beyond)

    def change_from(
        self, before: LaggedTerms, contact: RollingContact, mesh: Mesh, state: ContactState
    ) -> float:
        """Return the largest change from ``before``, relative to the first-order terms.

        The change of the gap is relative to the approach, that of the creep to the creepage, that
        of the traction to the load on the slope of the gap at an edge. The change of the creep is
        a root mean square, as the strain right at an edge varies from mesh to mesh.
        """
        curvature, half_nip = contact.nip.curvature, 0.5 * float(mesh.nodes[-1] - mesh.nodes[0])
        slope = curvature * half_nip
        approach = max(abs(state.approach), 0.5 * curvature * half_nip**2)
        creep = self.creep_offset - before.creep_offset
        if not isnan(state.creepage):
            creep = creep + state.creepage * (self.creep_length - before.creep_length)
        strain = sqrt(float(creep @ (creep / mesh.dx)) / float(mesh.dx.sum()))
        changes = [
            float(np.abs(self.clearance - before.clearance).max()) / approach,
            strain / scale_of_creepage(state.creepage, slope),
        ]
        wanted = self.wanted_traction
        if wanted is not None and before.traction is not None:
            load = float(mesh.weights @ state.pressure)
            changes.append(abs(wanted - before.traction) / (slope * load))
        return largest(*changes)


def contact_problem(contact: RollingContact, mesh: Mesh, lagged: LaggedTerms) -> ContactProblem:
    """Return the contact problem of theory sections 5 and 6, linear in the tractions."""
    nip, tangential = contact.nip, contact.nip.tangential
    return ContactProblem(
        x=mesh.inner,
        weights=mesh.weights,
        clearance=0.5 * nip.curvature * mesh.inner**2 + lagged.clearance,
        influence=mesh.influence,
        creep_length=mesh.dx + lagged.creep_length,
        creep_offset=lagged.creep_offset,
        friction=nip.friction,
        control=Control(
            load=nip.normal.load + lagged.lean if isinstance(nip.normal, LineLoad) else None,
            approach=nip.normal.approach if isinstance(nip.normal, Approach) else None,
            traction=tangential.traction if isinstance(tangential, Traction) else lagged.traction,
            creepage=tangential.creepage if isinstance(tangential, Creepage) else None,
        ),
    )


def initial_terms(contact: RollingContact, mesh: Mesh) -> LaggedTerms:
    """Return lagged terms of zero, the traction too where a torque is prescribed."""
    zero = np.zeros(mesh.inner.size)
    has_torque = isinstance(contact.nip.tangential, Torque)
    return LaggedTerms(zero, zero, zero, 0.0 if has_torque else None)


def lagged_terms(contact: RollingContact, mesh: Mesh, state: ContactState) -> LaggedTerms:
    """Return the lagged terms that follow from a solution on a mesh (theory section 6)."""
    if contact.has_no_lagged_terms:
        return initial_terms(contact, mesh)
    nip, geometry = contact.nip, contact.geometry
    u_linear = mesh.linear_displacements(state)
    u = mesh.with_second(u_linear, state)
    clearance = length = offset = np.zeros(mesh.inner.size)
    lean, traction, beyond = 0.0, None, 0.0
    if geometry in ("corrected", *FINITE):
        depth = sum(surface_depths(mesh.inner, nip, geometry, u.but_last()))
        approximate = (
            0.5 * nip.curvature * mesh.inner**2 + (u_linear.z_upper + u_linear.z_lower)[:-1]
        )
        clearance = depth - approximate
    if geometry in RINGS and nip.friction > 0.0:
        length, offset = _stretch_terms(contact, mesh, u_linear, u)
    if contact.has_finite_strain:
        lean = _lean(nip, mesh, state, u)
    if isinstance(nip.tangential, Torque):
        asked = _traction_for_torque(contact, mesh, state, u)
        most = nip.friction * float(mesh.weights @ state.pressure)
        traction = within_friction(asked, float(mesh.weights @ state.shear), (-most, most))
        beyond = asked - traction
    return LaggedTerms(clearance, length, offset, traction, lean, beyond)


def _stretch_terms(
    contact: RollingContact, mesh: Mesh, u_linear: Displacements, u: Displacements
) -> tuple[Array, Array]:
    """Return ``creep_length`` and ``creep_offset`` of `LaggedTerms` due to stretch [mm].

    The creep is the integral of (1 + xi/2) stretch_u - (1 - xi/2) stretch_l over an interval. The
    first term is the factor of xi minus the length of the interval; the second is the part
    independent of xi minus its linear part.
    """
    finer = mesh.finer(u)
    u_linear = finer if u_linear is u else mesh.finer(u_linear)
    linear, beyond = stretch_parts(mesh.fine.nodes[1:], contact, u_linear, finer)
    excess = linear + beyond
    return mesh.sums(0.5 * (excess[0] + excess[1])), mesh.sums(beyond[0] - beyond[1])


def _lean(nip: Nip, mesh: Mesh, state: ContactState, u: Displacements) -> float:
    """Return int q slope dx, with the mean slope of both surfaces as that of the interface."""
    levers = mesh.weights @ (state.shear * mesh.inner)
    undeformed = (nip.lower.curvature - nip.upper.curvature) * levers
    return 0.5 * float(undeformed + mesh.work(state.shear, u.z_lower - u.z_upper))


def _traction_for_torque(
    contact: RollingContact, mesh: Mesh, state: ContactState, u: Displacements
) -> float:
    """Return T for which the lower torque R_l (w_l - int q lambda_l ds) is as prescribed [N/mm].

    It is nan where the lagged terms have diverged; such a solution is not verified.
    """
    nip = contact.nip
    assert isinstance(nip.tangential, Torque)
    zones = contact_zones(mesh.inner, state, nip.friction)
    slips = slip_intervals(mesh.fine.nodes[1:], zones)
    pull = float(transmitted(contact, mesh, state, u, slips)[0][1])
    if not isfinite(pull):
        return nan
    lost = loss_inside("lower", nip, contact.geometry, mesh, state)
    wanted = nip.tangential.torque_lower * nip.lower.curvature
    return lost - wanted - (pull - float(mesh.weights @ state.shear))


def within_friction(asked: float, last: float, carried: tuple[float, float]) -> float:
    """Return the traction to solve with next, where a torque asks for ``asked`` [N/mm].

    What it asks for while the shear is still small may exceed what friction carries, as the moment
    of the pressure falls when the shear grows. Beyond friction there is no solution to go on from;
    the next traction is then half way from the ``last`` one to what friction carries.

    ``carried``: the least and the largest traction that friction carries [N/mm].
    """
    least, most = carried
    return asked if least < asked < most else 0.5 * (last + min(max(asked, least), most))
