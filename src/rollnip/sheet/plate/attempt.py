"""A solution between given ends of zones, how badly it violates its conditions, and its terms."""

from __future__ import annotations

from dataclasses import replace
from math import inf

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import State
from rollnip.influence import displacement_under
from rollnip.rolling import PairKernels
from rollnip.rolling.surfaces import Mesh
from rollnip.sheet.attempt import Attempt
from rollnip.sheet.plate.system import LaggedPlate, PlateProblem, PlateState
from rollnip.sheet.plate.zones import PlateZones
from rollnip.sheet.search import longest_run
from rollnip.sheet.system import SIGNS as SIGNS_OF_STATES

Array = NDArray[np.float64]

_OUTSIDE = np.array([0.003, 0.01, 0.03, 0.1, 0.3])  # over the width, where overlap is looked for


PlateAttempt = Attempt[PlateZones, PlateProblem, PlateState, LaggedPlate]


def violation(stand: PlateAttempt) -> float:
    """Return how badly a solution violates the conditions of friction, relative.

    As without bending: shear beyond the traction bound over its largest value, and slip with its
    own shear over a twentieth of the nip's slope times its width or the creepage times it.
    """
    state, problem = stand.state, stand.problem
    slope = 0.5 * stand.zones.width * problem.nip.curvature
    parts = [0.0]
    for side, friction in enumerate(problem.frictions):
        creep = problem.gaps_and_creeps(state, stand.lagged)[side][1]
        pressure, states = state.pressure[side], state.states[side]
        peak, width = float(pressure.max()), float(np.ptp(problem.meshes[side].inner))
        if not peak > 0.0:
            return inf
        over = (np.abs(state.shear[side]) - friction * np.maximum(pressure, 0.0))[
            states == State.STICK
        ]
        parts.append(float(np.max(over, initial=0.0)) / (friction * peak))
        signs = SIGNS_OF_STATES.take(states)
        slips = (signs[:-1] != 0.0) & (signs[:-1] == signs[1:])
        wrong = np.where(slips, np.maximum(-signs[:-1] * creep[:-1], 0.0), 0.0)
        allowed = width * max(0.05 * slope, abs(state.creepage))
        parts.append(longest_run(wrong) / allowed)
    return max(parts)


def overlap(stand: PlateAttempt, kernels: PairKernels) -> float:
    """Return how far surfaces and sheet overlap outside the contacts, and tension, relative.

    Over the approach, or the depth of the gap at the edge; over the highest pressure.
    """
    problem, state, nip = stand.problem, stand.state, stand.problem.nip
    width = stand.zones.width
    depth = 0.125 * nip.curvature * width**2
    if not nip.has_half_space:
        depth = max(depth, abs(state.approach))
    parts = [0.0]
    for side, mesh in enumerate(problem.meshes):
        away = stand.zones.sides[side].width * _OUTSIDE
        x = np.concatenate([mesh.inner[0] - away, mesh.inner[-1] + away])
        gap = gap_at(problem, state, kernels, side, x)
        gap += np.interp(x, mesh.inner, stand.lagged.clearance[side])
        parts.append(float(np.max(-gap)) / depth)
        pressure = state.pressure[side]
        peak = float(pressure.max())
        parts.append(float(np.max(-pressure)) / peak if peak > 0.0 else inf)
    return max(parts)


def gap_at(
    problem: PlateProblem, state: PlateState, kernels: PairKernels, side: int, x: Array
) -> Array:
    """Return the gap between one roller and the sheet at some places, linear, (m,) [mm]."""
    sign, nip = (1.0, -1.0)[side], problem.nip
    curvature = (nip.upper.curvature, nip.lower.curvature)[side]
    gap = 0.5 * curvature * x**2 + problem.thinned_at(state, x)[side]
    gap -= sign * problem.height_at(state, x)
    gap += inward_at(problem.meshes[side], state, kernels, side, x)
    return np.asarray(gap - (state.approach if side == 0 else 0.0))


def inward_at(mesh: Mesh, state: PlateState, kernels: PairKernels, side: int, x: Array) -> Array:
    """Return the linear displacement of one roller inwards at some places, (m,) [mm]."""
    surface = (kernels.upper, kernels.lower)[side]
    if surface is None:
        return np.zeros(x.size)
    acting = mesh.acting(state.pressure[side]), (1.0, -1.0)[side] * mesh.acting(state.shear[side])
    made = displacement_under(surface.together, x, mesh.fine.nodes, np.stack(acting, axis=1))
    return np.asarray(made[1, :, 0] - made[2, :, 1])


def carried(stand: PlateAttempt, problem: PlateProblem) -> LaggedPlate:
    """Return the lagged terms of a solution on other meshes."""
    clearance, offsets, lagged = [], [], stand.lagged
    for side, (old, new) in enumerate(zip(stand.problem.meshes, problem.meshes, strict=True)):
        clearance.append(np.interp(new.inner, old.inner, lagged.clearance[side]))
        middles, places = (mesh.inner + 0.5 * mesh.dx for mesh in (old, new))
        rate = lagged.offsets[side] / old.dx
        offsets.append(new.dx * np.interp(places, middles, rate))
    return replace(lagged, clearance=(clearance[0], clearance[1]), offsets=(offsets[0], offsets[1]))
