"""Lagged terms of a membrane's contact: finite stretch, path of the sheet, prescribed torque.

They depend on the solution and are evaluated from the previous iterate, so that each iterate is
the solution of a linear system.
"""

from __future__ import annotations

from math import sqrt

import numpy as np
from numpy.typing import NDArray

from rollnip._largest import largest
from rollnip.geometry import linear_stretch
from rollnip.model import FINITE, Geometry
from rollnip.nip import Torque
from rollnip.rolling import Displacements, stretch_excess, surface_depths
from rollnip.rolling.kinematics import arc_ratio
from rollnip.rolling.surface_work import mean_shear
from rollnip.sheet.figures import scale_of_creepages
from rollnip.sheet.lagged_terms import (
    creep_in_stick,
    has_no_terms,
    initial_traction,
    over_load,
    pressed_gap,
    sheet_rate,
    traction_for_torque,
)
from rollnip.sheet.membrane.system import MembraneProblem, MembraneState, MembraneTerms
from rollnip.sheet.tension import FaceLevers, KnownTension

Array = NDArray[np.float64]


def initial_terms(problem: MembraneProblem) -> MembraneTerms:
    """Return zero terms and the prescribed traction; zero traction where a torque is prescribed."""
    n, known = problem.mesh.inner.size, KnownTension.on_straight_path(problem.sheet)
    return MembraneTerms(np.zeros(n), np.zeros((2, n)), initial_traction(problem.nip), known)


def lagged_terms(
    problem: MembraneProblem, geometry: Geometry, state: MembraneState
) -> MembraneTerms:
    """Return the lagged terms that follow from a solution."""
    first = initial_terms(problem)
    if has_no_terms(problem.nip, geometry):
        return first
    nip, mesh = problem.nip, problem.mesh
    flat = mesh.linear_displacements(state)
    u = mesh.with_second(flat, state)
    clearance, lean, offsets, known = first.clearance, 0.0, first.offsets, first.known
    if geometry in FINITE:
        depth = sum(surface_depths(mesh.inner, nip, geometry, u.but_last()))
        approximate = 0.5 * nip.curvature * mesh.inner**2 + (flat.z_upper + flat.z_lower)[:-1]
        clearance = depth - approximate
        lean = _lean(problem, state, u)
    if geometry != "linear":
        if problem.knows_path:
            faces = face_levers(problem, state, u)
            known = KnownTension.after(problem.sheet, faces, bends=False)
        offsets = _offsets(problem, geometry, state, known, (flat, u))
    traction = first.traction
    if isinstance(nip.tangential, Torque):
        _, pull = pulls_of(problem, geometry, state, mesh.uncut(u))
        traction = traction_for_torque(problem, geometry, state, pull)
    return MembraneTerms(clearance, offsets, traction, known, lean)


def change_of_terms(
    new: MembraneTerms, old: MembraneTerms, problem: MembraneProblem, state: MembraneState
) -> float:
    """Return the largest change of the terms, relative to the first-order quantities."""
    nip, mesh = problem.nip, problem.mesh
    half = 0.5 * float(mesh.nodes[-1] - mesh.nodes[0])
    strain = nip.curvature * half
    approach = max(abs(state.approach), 0.5 * nip.curvature * half**2)
    drift = new.offsets - old.offsets
    scale = scale_of_creepages(state.creepages, strain)
    changes = [sqrt(float(row @ (row / mesh.dx)) / (2.0 * half)) / scale for row in drift]
    changes.append(float(np.abs(new.clearance - old.clearance).max()) / approach)
    changes.append(_known_change(new, old, problem, state))
    if new.traction is not None and old.traction is not None:
        load = float(mesh.weights @ state.pressure)
        changes.append(over_load(abs(new.traction - old.traction), strain * load))
    return largest(*changes)


def residual_with_terms(
    new: MembraneTerms, old: MembraneTerms, problem: MembraneProblem, state: MembraneState
) -> float:
    """Return the relative residual of a solution under other lagged terms.

    ``old``: the terms that it was solved with; ``new``: those it is checked with. The residual is
    the largest of the gap under pressure, over the approach and weighted by the pressure over its
    peak, of the distances that sticking surfaces creep, over the width and the scale of a creepage,
    and of the change of the tension due to the path, over the load.
    """
    nip, mesh = problem.nip, problem.mesh
    half = 0.5 * float(mesh.nodes[-1] - mesh.nodes[0])
    approach = max(abs(state.approach), 0.5 * nip.curvature * half**2)
    scale = scale_of_creepages(state.creepages, nip.curvature * half)
    parts = [pressed_gap(new.clearance - old.clearance, state.pressure) / approach]
    for states, drift in zip(state.both_states, new.offsets - old.offsets, strict=True):
        parts.append(creep_in_stick(drift, states) / (2.0 * half * scale))
    return largest(*parts, _known_change(new, old, problem, state))


def _known_change(
    new: MembraneTerms, old: MembraneTerms, problem: MembraneProblem, state: MembraneState
) -> float:
    """Return the change of tension due to the curved path, over the load."""
    load = float(problem.mesh.weights @ state.pressure)
    return over_load(new.known.change_from(old.known), load)


def path_slope_changes(problem: MembraneProblem, u: Displacements) -> Array:
    """Return the change of slope of the sheet's middle over each interval of nodes[1:], (n,).

    The middle lies halfway between both surfaces: y = [(1/R_u - 1/R_l) x^2/2 + u_z,u - u_z,l]/2.
    Its curvature d^2y/dx^2 is positive where the centre of curvature is on the upper side. On a
    bare rigid roller the middle lies half a thickness outside that roller, with a radius of R +
    h/2. ``u``: displacements at nodes[1:].
    """
    nip, mesh = problem.nip, problem.mesh
    if nip.upper.is_rigid or nip.lower.is_rigid:
        own = nip.upper.curvature if nip.upper.is_rigid else -nip.lower.curvature
        own /= 1.0 + 0.5 * problem.sheet.thickness * abs(own)
        return np.asarray(own * mesh.dx)
    bent = problem.path.slope_changes(u.z_upper - u.z_lower)
    return np.asarray(0.5 * ((nip.upper.curvature - nip.lower.curvature) * mesh.dx + bent))


def face_levers(
    problem: MembraneProblem, state: MembraneState, u: Displacements
) -> tuple[FaceLevers, FaceLevers]:
    """Return the forces on both faces, and the levers of the shears; ``u`` at nodes[1:]."""
    mesh = problem.mesh
    turn = path_slope_changes(problem, u)[:-1] / mesh.dx[:-1]
    ratios, pressed = 0.5 * problem.sheet.thickness * turn, problem.forces(state.pressure)
    upper, lower = (
        FaceLevers(mesh.inner, problem.shear_forces(state, side), pressed, ratios)
        for side in (0, 1)
    )
    return upper, lower


def _offsets(
    problem: MembraneProblem,
    geometry: Geometry,
    state: MembraneState,
    known: KnownTension,
    displacements: tuple[Displacements, Displacements],
) -> Array:
    """Return the nonlinear part of both creeps: stretch, path, and products of creepage and strain.

    The creep of the upper interface is (V_u/V) stretch_u - (V_s/V) (1 + e - h kappa/2), that of the
    lower one (V_s/V) (1 + e + h kappa/2) - (V_l/V) stretch_l.
    """
    nip, mesh, (flat, u) = problem.nip, problem.mesh, displacements
    x = mesh.fine.nodes[1:]
    hoops = np.array(mesh.kernels.hoops)[:, None]
    excess = stretch_excess(x, nip, geometry, mesh.finer(u))
    linear = linear_stretch(x[1:] - x[:-1], hoops, *mesh.finer(flat).rows)
    half = 0.5 * (state.creepage + state.creepage_lower)
    rate = sheet_rate(state.creepage, state.creepage_lower)
    turn = rate * path_slope_changes(problem, u)
    if problem.has_path:  # the matrix includes the path by linear displacements
        turn -= 0.5 * problem.path.slope_changes(flat.z_upper - flat.z_lower)
    bend = 0.5 * problem.sheet.thickness * turn
    strained = (rate - 1.0) * problem.strain_over(state, known)
    upper = mesh.sums((1.0 + half) * excess[0] - linear[0])
    lower = mesh.sums((1.0 - half) * excess[1] - linear[1])
    return np.stack([upper - strained + bend, strained + bend - lower])


def _lean(problem: MembraneProblem, state: MembraneState, u: Displacements) -> float:
    """Return int q slope dx, with the mean shear and slope of both surfaces [N/mm]."""
    nip, mesh = problem.nip, problem.mesh
    shear = 0.5 * (state.shear + state.shear_lower)
    levers = mesh.weights @ (shear * mesh.inner)
    undeformed = (nip.lower.curvature - nip.upper.curvature) * levers
    return 0.5 * float(undeformed + mesh.work(shear, u.z_lower - u.z_upper))


def pulls_of(
    problem: MembraneProblem, geometry: Geometry, state: MembraneState, u: Displacements
) -> tuple[float, float]:
    """Return int q lambda ds of the upper and the lower surface [N/mm]; ``u`` at nodes[1:].

    Together with the internal loss it equals the torque over the radius only in equilibrium under
    these very tractions. Hence ``u`` must include the short waves that the contact conditions in
    stick do not follow.
    """
    mesh = problem.mesh
    x, fine = mesh.fine.nodes[1:], mesh.finer(u)
    excess = stretch_excess(x, problem.nip, geometry, fine)
    lengths = (x[1:] - x[:-1] + excess) * arc_ratio(x, problem.nip, geometry, fine)
    upper, lower = (mean_shear(mesh, state.side(number)) for number in (0, 1))
    return float(lengths[0] @ upper), float(lengths[1] @ lower)
