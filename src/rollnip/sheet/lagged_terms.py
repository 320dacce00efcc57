"""Lagged terms and residuals, as far as membranes and plates have them in common."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rollnip._largest import largest
from rollnip.contact import State, States
from rollnip.model import Geometry
from rollnip.nip import Nip, Torque, Traction
from rollnip.rolling.assemble import within_friction
from rollnip.rolling.surface_work import loss_inside
from rollnip.rolling.surfaces import Mesh
from rollnip.sheet.iterate import InterfaceProblem, InterfaceSolution

Array = NDArray[np.float64]


def has_no_terms(nip: Nip, geometry: Geometry) -> bool:
    """Return whether the problem is linear, without any term that depends on the solution."""
    return geometry == "linear" and not isinstance(nip.tangential, Torque)


def initial_traction(nip: Nip) -> float | None:
    """Return the prescribed T_l, zero for a prescribed torque, None for a creepage [N/mm]."""
    if isinstance(nip.tangential, Traction):
        return nip.tangential.traction
    return 0.0 if isinstance(nip.tangential, Torque) else None


def traction_for_torque(
    problem: InterfaceProblem, geometry: Geometry, state: InterfaceSolution, pull: float
) -> float:
    """Return T_l for which the lower torque R_l (w_l - int q_l lambda_l ds) is as prescribed.

    ``pull``: int q_l lambda_l ds with all short waves [N/mm].
    """
    nip, mesh, lower = problem.nip, problem.meshes[1], state.side(1)
    assert isinstance(nip.tangential, Torque)
    lost = loss_inside("lower", nip, geometry, mesh, lower)
    wanted = nip.tangential.torque_lower * nip.lower.curvature
    return lost - wanted - (pull - float(mesh.weights @ lower.shear))


def traction_within_friction(
    problem: InterfaceProblem, state: InterfaceSolution, asked: float | None
) -> float | None:
    """Return the T_l to solve with next, where a torque asks for ``asked``; None: it is no torque.

    Both interfaces must carry it, see `rollnip.rolling.assemble.within_friction` [N/mm].
    """
    sheet, lower = problem.nip.sheet, state.side(1)
    if asked is None or sheet is None:
        return asked
    weights, pull = problem.meshes[1].weights, sheet.tension_in - sheet.tension_out
    above, below = (mu * float(weights @ lower.pressure) for mu in problem.frictions)
    carried = max(-below, -above - pull), min(below, above - pull)
    return within_friction(asked, float(weights @ lower.shear), carried)


def interpolated(old: Mesh, new: Mesh, clearance: Array, offset: Array) -> tuple[Array, Array]:
    """Return the lagged terms of one interface on another mesh, each (n,) [mm].

    ``clearance``: of the gap at the nodes; ``offset``: of the creep of the intervals.
    """
    middles, places = (mesh.inner + 0.5 * mesh.dx for mesh in (old, new))
    rate = np.interp(places, middles, offset / old.dx)
    return np.interp(new.inner, old.inner, clearance), new.dx * rate


def pressed_gap(gap: Array, pressure: Array) -> float:
    """Return the largest gap under pressure, weighted by pressure over peak pressure [mm]."""
    peak = float(np.abs(pressure).max())
    return 0.0 if peak == 0.0 else float(np.abs(gap * pressure).max()) / peak


def over_load(force: float, load: float) -> float:
    """Return a force over the load; 0 where nothing is pressed: the residual shows that."""
    return 0.0 if load <= 0.0 else force / load


def creep_in_stick(creep: Array, states: States) -> float:
    """Return the largest distance that surfaces creep within a run of sticking nodes [mm].

    ``creep``, ``states``: of the intervals, and of the nodes at which they begin.
    """
    sticks = states == State.STICK
    along = np.concatenate([[0.0], np.cumsum(np.where(sticks, creep, 0.0))])
    begins = np.flatnonzero(sticks & ~np.append(False, sticks[:-1]))
    ends = np.flatnonzero(sticks & ~np.append(sticks[1:], False)) + 1
    runs = (along[begin : end + 1] for begin, end in zip(begins, ends, strict=True))
    return largest(0.0, *(float(np.ptp(run)) for run in runs))


def sheet_rate(creepage_upper: float, creepage_lower: float) -> float:
    """Return V_s/V."""
    return 1.0 + 0.5 * (creepage_lower - creepage_upper)
