"""Checks for results that no nip can have, however well its equations are solved."""

from __future__ import annotations

from math import isnan

import numpy as np

from rollnip.interior import SurfaceTractions, interior_field
from rollnip.model import Geometry
from rollnip.nip import Nip
from rollnip.rollers import Roller
from rollnip.rolling.mesh_solution import MeshSolution
from rollnip.rolling.surfaces import Array

MOST_PRESSED_IN = 0.5
"""Compression of a layer over its thickness, at most.

Small-strain kinematics count u/d where the material sees -ln(1 - u/d): at one half these are 40 %
apart, and at 1 the surface has reached the core. Finite strain counts it right, but was compared up
to a sixth only. Coverings in use stay below a fifth.
"""
MOST_CREEPAGE = 2.0
"""Creepage at which one roller stands still; beyond, it would rotate backwards."""


def impossible(nip: Nip, geometry: Geometry, final: MeshSolution) -> str:
    """Return why the result is no nip, in a sentence; "" where nothing speaks against it."""
    creepage = final.state.creepage
    if not isnan(creepage) and abs(creepage) >= MOST_CREEPAGE:
        return (
            f"The creepage comes out as {creepage:.2g}: beyond -2 and 2 one roller would "
            "rotate backwards. Strains are far too large for this nip; lower the traction or the "
            "load."
        )
    for side, roller in (("upper", nip.upper), ("lower", nip.lower)):
        pressed = _pressed_in(side, roller, nip, geometry, final)
        if pressed.size and np.max(pressed) >= MOST_PRESSED_IN:
            return too_deep(side, int(np.argmax(pressed)), pressed, roller)
    return ""


def is_too_deep(nip: Nip, geometry: Geometry, found: MeshSolution, *, is_rough: bool) -> bool:
    """Return whether a layer is pressed in too far for a finer mesh or finite strain to be tried.

    In a solution that ``is_rough``, before finite strain or on a first mesh, that is by its whole
    thickness; else by `MOST_PRESSED_IN` of it, as in `impossible`. `finite` presses a covering in
    by 0.57 of its thickness and more where `curved` does so by all of it (Poisson ratios of 0.3 to
    0.5, thicknesses of 0.002 to 0.3 of the radius).
    """
    most = 1.0 if is_rough else MOST_PRESSED_IN
    both = (("upper", nip.upper), ("lower", nip.lower))
    return any(
        bool(np.any(_pressed_in(side, roller, nip, geometry, found) >= most))
        for side, roller in both
    )


def too_deep(side: str, number: int, pressed: Array, roller: Roller) -> str:
    """Return the sentence on a layer that is pressed in too far."""
    many = len(roller.layers) > 1
    what = f"Layer {number + 1} (from the surface)" if many else "The covering"
    return (
        f"{what} of the {side} roller, {roller.layers[number].thickness:g} mm thick, is pressed in "
        f"by {100.0 * pressed[number]:.0f} % of its thickness; beyond "
        f"{100.0 * MOST_PRESSED_IN:.0f} % none of the models here holds. Lower the load or the "
        "approach, or take a thicker or harder covering."
    )


def _pressed_in(
    side: str, roller: Roller, nip: Nip, geometry: Geometry, final: MeshSolution
) -> Array:
    """Return the compression of each layer over its thickness, under the deepest surface point.

    Nothing is returned where no layer can be pressed in too far. A free column under the peak is
    compressed by the ratio of pressure and modulus, and what lies beside holds a layer (of 181
    random layers none was compressed by 1.04 times that ratio); nor is a layer compressed by more
    than the surface moves.
    """
    most, peak = MOST_PRESSED_IN, final.figures.peak_pressure
    soft = [one.thickness for one in roller.layers if peak >= most * one.material.relaxed_modulus]
    if not soft:
        return np.zeros(0)
    u = final.displacements
    inward, sign = (u.z_upper, 1.0) if side == "upper" else (u.z_lower, -1.0)
    deepest = int(np.argmax(np.where(final.state.pressure > 0.0, inward[:-1], -np.inf)))
    if len(roller.layers) == 1 and roller.core is None:
        return np.array([inward[deepest] / roller.layers[0].thickness])
    if roller.core is None and inward[deepest] < most * min(soft):
        return np.zeros(0)
    tractions = SurfaceTractions.on_inner(final.nodes, sign * final.shear, final.pressure)
    depths = np.array([0.0, *roller.interfaces])
    place = final.mesh.inner[[deepest]]
    field = interior_field(roller, tractions, depths, place, geometry=geometry, speed=nip.speed)
    return np.asarray(-np.diff(field.u_z[:, 0]) / np.diff(depths))
