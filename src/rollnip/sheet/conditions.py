"""Residuals of the contact conditions on the interfaces of a membrane or a plate."""

from __future__ import annotations

from math import inf

import numpy as np
from numpy.typing import NDArray

from rollnip._largest import largest
from rollnip.contact import ContactState, State
from rollnip.contact.problem import shear_signs
from rollnip.nip import Nip
from rollnip.rolling.check import depth_scale
from rollnip.rolling.surfaces import Mesh
from rollnip.sheet.figures import scale_of_creepages
from rollnip.sheet.iterate import AnyIterate

Array = NDArray[np.float64]

OUTSIDE = np.array([0.003, 0.01, 0.03, 0.1, 0.3])
"""Distances beyond an edge at which overlap is checked, over the width."""


def violation(iterate: AnyIterate) -> float:
    """Return the residual of the friction conditions, relative; the larger of both interfaces.

    Slip is measured against the larger of both creepages, see `scale_of_creepages`: those of geared
    rollers may be opposite, and their sum far smaller.
    """
    problem, state = iterate.problem, iterate.state
    slope = 0.5 * iterate.zones.width * problem.nip.curvature
    scale = scale_of_creepages(state.creepages, slope)
    sides = zip(problem.meshes, iterate.creeps, problem.frictions, strict=True)
    return largest(
        *(
            _violation_on(mesh, state.side(side), creep, friction, scale)
            for side, (mesh, creep, friction) in enumerate(sides)
        )
    )


def _violation_on(
    mesh: Mesh, state: ContactState, creep: Array, friction: float, creepage: float
) -> float:
    """Return the residual of the friction conditions on one interface, relative.

    It is the larger of two parts: the traction that a run of sticking nodes carries beyond its
    bound, over the largest traction that friction carries; and the distance slipped along its own
    shear in a run, over the width times ``creepage``. ``creep``: of the intervals, (n,) [mm].
    """
    load = float(mesh.weights @ state.pressure)
    if not load > 0.0:
        return inf
    bound = friction * np.maximum(state.pressure, 0.0)
    beyond = np.maximum(np.abs(state.shear) - bound, 0.0) * mesh.weights
    carried = _longest_run(np.where(state.states == State.STICK, beyond, 0.0))
    signs = shear_signs(state.states)
    slips = (signs[:-1] != 0.0) & (signs[:-1] == signs[1:])
    wrong = np.where(slips, np.maximum(-signs[:-1] * creep[:-1], 0.0), 0.0)
    allowed = float(np.ptp(mesh.inner)) * creepage
    return largest(carried / (friction * load), _longest_run(wrong) / allowed)


def violation_outside(
    nip: Nip, gap: Array, pressure: Array, width: float, approach: float
) -> float:
    """Return the overlap of surfaces and sheet beside an interface, or tensile pressure, relative.

    Overlap is relative to `depth_scale`, tensile pressure to the peak pressure.
    """
    depth = depth_scale(nip, width, approach)
    peak = float(np.max(pressure))
    tensile = float(np.max(-pressure)) / peak if peak > 0.0 else inf
    return largest(0.0, float(np.max(-gap)) / depth, tensile)


def _longest_run(values: Array) -> float:
    """Return the largest sum over a run of consecutive positive values."""
    if not values.any():
        return 0.0
    total = np.concatenate([[0.0], np.cumsum(values)])
    rest = np.maximum.accumulate(np.where(np.append(values, 0.0) > 0.0, 0.0, total))
    return float(np.max(total - np.concatenate([[0.0], rest[:-1]])))
