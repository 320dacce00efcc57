"""Lagged terms of a plate's contact: finite stretch, curved path, prescribed torque."""

from __future__ import annotations

from math import sqrt

import numpy as np
from numpy.typing import NDArray

from rollnip._largest import largest
from rollnip.geometry import linear_stretch
from rollnip.model import FINITE, Geometry
from rollnip.nip import Torque
from rollnip.rolling import Displacements, stretch_excess, surface_depths
from rollnip.rolling.surface_work import mean_shear
from rollnip.sheet.figures import scale_of_creepages
from rollnip.sheet.friction import SIDE_SIGNS
from rollnip.sheet.lagged_terms import (
    creep_in_stick,
    has_no_terms,
    initial_traction,
    over_load,
    pressed_gap,
    sheet_rate,
    traction_for_torque,
)
from rollnip.sheet.plate.curved_path import (
    CurvedLoad,
    curved_load,
    direction_of,
    is_stiff,
    places_along,
    tension_left_out,
)
from rollnip.sheet.plate.interface import path_ratio
from rollnip.sheet.plate.system import PlateProblem, PlateState, PlateTerms
from rollnip.sheet.tension import FaceLevers, KnownTension

Array = NDArray[np.float64]


def initial_terms(problem: PlateProblem) -> PlateTerms:
    """Return zero terms and the prescribed traction; zero traction where a torque is prescribed."""
    n, m = (mesh.inner.size for mesh in problem.meshes)
    clearance, offsets = (np.zeros(n), np.zeros(m)), (np.zeros(n), np.zeros(m))
    known = KnownTension.on_straight_path(problem.sheet)
    return PlateTerms(clearance, offsets, initial_traction(problem.nip), known)


def lagged_terms(
    problem: PlateProblem,
    geometry: Geometry,
    state: PlateState,
    before: PlateTerms | None = None,
) -> PlateTerms:
    """Return the lagged terms that follow from a solution.

    ``before``: the terms that it was solved with; None: none.
    """
    first = initial_terms(problem)
    if has_no_terms(problem.nip, geometry):
        return first
    clearance, offsets, leans = [], [], []
    old = None if before is None else before.curved
    path, known = places_along(problem), first.known
    slopes = None
    if geometry != "linear":
        rotations = problem.rotations(state, old)
        faces = _face_levers(problem, state, old, rotations)
        known = KnownTension.after(problem.sheet, faces, bends=True)
        left_out = tension_left_out(problem, state, known, path)
        if geometry in FINITE and is_stiff(problem, path, left_out):
            slopes = rotations
    bent = (0.0, 0.0) if slopes is None or old is None else _turned(old, problem)
    for side in (0, 1):
        mesh = problem.meshes[side]
        flat = mesh.linear_displacements(state.side(side))
        u = mesh.with_second(flat, state.side(side))
        clearance.append(_clearance(problem, geometry, side, flat, u))
        offsets.append(_offsets(problem, geometry, (state, known), side, (flat, u)))
        leans.append(_lean(problem, state, side, u) if geometry in FINITE else 0.0)
        if slopes is None:
            continue
        here, half = slopes[side], 0.5 * problem.sheet.thickness
        clearance[side] -= 0.5 * half * here[:-1] ** 2
        # the linear system includes the rotation itself; the whole face runs at V_s
        turned, rate = here / np.sqrt(1.0 + here**2) - here, sheet_rate(*state.creepages)
        turned += (1.0 - 1.0 / rate) * bent[side]
        offsets[side] += rate * half * np.diff(turned)
    traction = first.traction
    if isinstance(problem.nip.tangential, Torque):
        uncut = problem.meshes[1].uncut(problem.displacements(state, 1))
        pull = pull_of(problem, geometry, state, 1, uncut)
        traction = traction_for_torque(problem, geometry, state, pull)
    both = (clearance[0], clearance[1]), (offsets[0], offsets[1])
    if slopes is None:
        return PlateTerms(*both, traction, known, 0.5 * sum(leans))
    slope = np.concatenate(slopes)[np.unique(problem.places, return_index=True)[1]]
    curved = curved_load(problem, state, path, slope, left_out)
    return PlateTerms(*both, traction, known, 0.5 * (sum(leans) + curved.total), curved)


def _turned(curved: CurvedLoad, problem: PlateProblem) -> tuple[Array, Array]:
    """Return the rotation due to the curved path at nodes[1:] of both meshes."""
    both = (curved.deflection_at(mesh.nodes[1:])[1] for mesh in problem.meshes)
    upper, lower = both
    return upper, lower


def change_of_terms(
    new: PlateTerms, old: PlateTerms, problem: PlateProblem, state: PlateState
) -> float:
    """Return the largest change of the terms, relative to the first-order quantities."""
    nip = problem.nip
    half = 0.5 * max(float(np.ptp(mesh.inner)) for mesh in problem.meshes)
    strain = nip.curvature * half
    approach = max(abs(state.approach), 0.5 * nip.curvature * half**2)
    scale = scale_of_creepages(state.creepages, strain)
    changes = []
    for side, mesh in enumerate(problem.meshes):
        drift = new.offsets[side] - old.offsets[side]
        changes.append(sqrt(float(drift @ (drift / mesh.dx)) / (2.0 * half)) / scale)
        moved = np.abs(new.clearance[side] - old.clearance[side])
        changes.append(float(moved.max()) / approach)
    if new.traction is not None and old.traction is not None:
        load = float(problem.meshes[0].weights @ state.pressure[0])
        changes.append(over_load(abs(new.traction - old.traction), strain * load))
    changes.append(_curved_change(new, old, problem, state))
    return largest(*changes)


def _curved_change(
    new: PlateTerms, old: PlateTerms, problem: PlateProblem, state: PlateState
) -> float:
    """Return the change of tension, couples and forces due to the curved path, over the load."""
    load = float(problem.meshes[0].weights @ state.pressure[0])
    change = new.known.change_from(old.known)
    if new.curved is not None and old.curved is not None:
        change = largest(change, new.curved.change_from(old.curved))
    return over_load(change, load)


def residual_with_terms(
    new: PlateTerms, old: PlateTerms, problem: PlateProblem, state: PlateState
) -> float:
    """Return the relative residual of a solution under other lagged terms.

    See `rollnip.sheet.membrane.lagged_terms.residual_with_terms`.
    """
    nip, parts = problem.nip, [0.0]
    for side, mesh in enumerate(problem.meshes):
        half = 0.5 * float(np.ptp(mesh.inner))
        approach = max(abs(state.approach), 0.5 * nip.curvature * half**2)
        gap = pressed_gap(new.clearance[side] - old.clearance[side], state.pressure[side])
        drift = creep_in_stick(new.offsets[side] - old.offsets[side], state.states[side])
        scale = scale_of_creepages(state.creepages, nip.curvature * half)
        parts += [gap / approach, drift / (2.0 * half * scale)]
    return largest(*parts, _curved_change(new, old, problem, state))


def pull_of(
    problem: PlateProblem, geometry: Geometry, state: PlateState, side: int, u: Displacements
) -> float:
    """Return int q lambda ds of one roller [N/mm]; ``u`` at nodes[1:].

    See `rollnip.sheet.membrane.lagged_terms.pulls_of`.
    """
    nip, mesh = problem.nip, problem.meshes[side]
    x, fine = mesh.fine.nodes[1:], mesh.finer(u)
    lengths = x[1:] - x[:-1] + stretch_excess(x, nip, geometry, fine)[side]
    if geometry in FINITE:
        lengths = lengths * path_ratio(x, nip, side, fine)
    return float(lengths @ mean_shear(mesh, state.side(side)))


def _clearance(
    problem: PlateProblem, geometry: Geometry, side: int, flat: Displacements, u: Displacements
) -> Array:
    """Return the contribution of finite strain to the gap of one interface [mm]."""
    mesh = problem.meshes[side]
    if geometry not in FINITE:
        return np.zeros(mesh.inner.size)
    depth = surface_depths(mesh.inner, problem.nip, geometry, u.but_last())[side]
    moved = (flat.z_upper, flat.z_lower)[side][:-1]
    return np.asarray(depth - 0.5 * problem.curvatures[side] * mesh.inner**2 - moved)


def face_levers(
    problem: PlateProblem, state: PlateState, curved: CurvedLoad | None
) -> tuple[FaceLevers, FaceLevers]:
    """Return the forces on both faces, and the levers of the shears.

    ``curved``: the load due to its path that the solution was found with.
    """
    return _face_levers(problem, state, curved, problem.rotations(state, curved))


def _face_levers(
    problem: PlateProblem,
    state: PlateState,
    curved: CurvedLoad | None,
    rotations: tuple[Array, Array],
) -> tuple[FaceLevers, FaceLevers]:
    """Return `face_levers` for known rotations of the sections at nodes[1:] of both meshes."""
    out, half = [], 0.5 * problem.sheet.thickness
    for side, turned in enumerate(rotations):
        mesh = problem.meshes[side]
        ratios = half * np.diff(direction_of(turned[:-1], curved)) / mesh.dx[:-1]
        both = np.stack([state.shear[side], state.pressure[side]], axis=1)
        pushed, pressed = problem.forces(both, side)
        out.append(FaceLevers(mesh.inner, pushed, pressed, ratios))
    return out[0], out[1]


def _offsets(
    problem: PlateProblem,
    geometry: Geometry,
    found: tuple[PlateState, KnownTension],
    side: int,
    displacements: tuple[Displacements, Displacements],
) -> Array:
    """Return the nonlinear part of one creep: stretch, and products of creepage and strain.

    The creep is (V_u/V) stretch_u - (V_s/V) (1 + e - h y''/2) on the upper interface, and
    (V_s/V) (1 + e + h y''/2) - (V_l/V) stretch_l on the lower one.
    """
    nip, mesh = problem.nip, problem.meshes[side]
    if geometry == "linear":
        return np.zeros(mesh.inner.size)
    (state, known), (flat, u) = found, displacements
    x = mesh.fine.nodes[1:]
    hoops = np.array(mesh.kernels.hoops)[:, None]
    excess = stretch_excess(x, nip, geometry, mesh.finer(u))[side]
    linear = linear_stretch(x[1:] - x[:-1], hoops, *mesh.finer(flat).rows)[side]
    sign, half = SIDE_SIGNS[side], 0.5 * state.creepage
    rate = sheet_rate(*state.creepages)
    strained = (rate - 1.0) * problem.creep_by_sheet(state, known, side, flat)
    return np.asarray(sign * mesh.sums((1.0 + sign * half) * excess - linear) + strained)


def _lean(problem: PlateProblem, state: PlateState, side: int, u: Displacements) -> float:
    """Return int q slope dx of one surface [N/mm]."""
    mesh, sign = problem.meshes[side], SIDE_SIGNS[side]
    shear = state.shear[side]
    levers = float(mesh.weights @ (shear * mesh.inner))
    inward = (u.z_upper, u.z_lower)[side]
    return -sign * (problem.curvatures[side] * levers + mesh.work(shear, inward))
