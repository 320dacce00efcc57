"""Growth of a covering that warms up: plane strain, bonded to its core, free at its surface.

With u the radial displacement and S = r s_rr, in a layer with the free expansion e = alpha dT,

    r u' = a S - b u + c e r,     r S' = b S + g (u - (1 + nu) e r),

a = (1-2nu)(1+nu)/(E(1-nu)), b = nu/(1-nu), g = E/((1+nu)(1-nu)), c = (1+nu)/(1-nu). These are the
ring equations of the theory for the harmonic 0, with e added along all three directions. Since b^2
+ a g = 1, the matrix of the homogeneous solution over a length L in log r is cosh L + M sinh L; a
layer that expands freely has u = (1 + nu) e r, S = 0. A thin covering grows by (1+nu)/(1-nu) alpha
dT of its thickness, which is 3 alpha dT where it is incompressible, because it can only grow
outwards.
"""

from __future__ import annotations

from math import cosh, log, sinh

import numpy as np
from numpy.typing import NDArray

from rollnip.heat.grid import SHELL, RadialGrid

Array = NDArray[np.float64]

_PINHOLE = 1e-3  # radius of the hole assumed in a solid roller, over that of the innermost cell


def radial_growth(grid: RadialGrid, temperature: Array, reference: float) -> float:
    """Return how much the radius of a roller grows [mm].

    Parameters
    ----------
    grid : of the roller.
    temperature : (n,) of its cells [degC].
    reference : temperature at which the radius is the given one [degC].

    Returns
    -------
    0 for a plane and for a roller without cells. The shell grows freely, by its own expansion;
    coverings have their relaxed moduli.
    """
    covering = np.flatnonzero(grid.covering)
    if covering.size == 0 or grid.plane is not None:
        return core_growth(grid, temperature, reference)
    radii = grid.radii
    solid = grid.roller.core is not None
    inner = radii[covering[-1] + 1]
    if solid:
        inner = max(inner, _PINHOLE * radii[covering[-1]])
        start = np.array([[0.0, 1.0], [0.0, 0.0]])  # S = 0 at the bore; u is the unknown
    else:
        start = np.array([[core_growth(grid, temperature, reference), 0.0], [0.0, 1.0]])
    for cell in covering[::-1]:
        start = _across(grid, int(cell), inner, float(temperature[cell]) - reference, start)
        inner = radii[cell]
    # S = 0 at the surface
    unknown = -start[1, 0] / start[1, 1]
    return float(start[0, 0] + unknown * start[0, 1])


def _across(grid: RadialGrid, cell: int, inner: float, warmer: float, state: Array) -> Array:
    """Return (u, S) and its derivative by the unknown, (2, 2), carried outwards over a cell."""
    material = grid.roller.materials[grid.layer[cell]]
    modulus, nu = material.relaxed_modulus, material.poisson
    assert material.thermal is not None
    free = (1.0 + nu) * material.thermal.expansion * warmer
    outer = float(grid.radii[cell])
    length = log(outer / inner)
    matrix = np.array(
        [
            [-nu / (1.0 - nu), (1.0 - 2.0 * nu) * (1.0 + nu) / (modulus * (1.0 - nu))],
            [modulus / ((1.0 + nu) * (1.0 - nu)), nu / (1.0 - nu)],
        ]
    )
    carry = cosh(length) * np.eye(2) + sinh(length) * matrix
    relative = state.copy()
    relative[0, 0] -= free * inner
    out = carry @ relative
    out[0, 0] += free * outer
    return np.asarray(out)


def core_growth(grid: RadialGrid, temperature: Array, reference: float) -> float:
    """Return how much the outer radius of the shell grows [mm]; 0 without a shell."""
    shell = grid.cooling.shell
    inside = np.flatnonzero(grid.layer == SHELL)
    if shell is None or inside.size == 0:
        return 0.0
    weights = grid.volumes[inside]
    mean = float(weights @ temperature[inside] / weights.sum())
    return shell.thermal.expansion * (mean - reference) * float(grid.radii[inside[0]])
