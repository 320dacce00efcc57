"""Checks for results that no nip can have, however well its equations are solved."""

from __future__ import annotations

from math import isnan

import numpy as np

from rollnip.contact.problem import Array
from rollnip.interior import SurfaceTractions, beyond_linear, interior_field
from rollnip.materials import NeoHookean
from rollnip.model import Geometry
from rollnip.rollers import Roller
from rollnip.rolling import MeshSolution, rates_of

MOST_PRESSED_IN = 0.5
"""Compression of a layer or a sheet over its thickness, at most.

Small-strain kinematics count u/d where the material sees -ln(1 - u/d): at one half these are 40 %
apart, and at 1 the surface has reached the core. Finite strain counts it right, but was compared up
to 16 % only. Coverings in use stay below a fifth.
"""
MOST_CREEPAGE = 2.0
"""Creepage at which one roller stands still; beyond, it would rotate backwards."""


def impossible(final: MeshSolution) -> str:
    """Return why the result is no nip, in a sentence; "" where nothing speaks against it."""
    creepage = final.figures.creepage
    if not isnan(creepage) and abs(creepage) >= MOST_CREEPAGE:
        return (
            f"The creepage comes out as {creepage:.2g}: beyond -2 and 2 one roller would "
            "rotate backwards. Strains are far too large for this nip; lower the traction or the "
            "load."
        )
    deep = _pressed_in_by(MOST_PRESSED_IN, final, final.geometry)
    return _sheet_too_thin(final) if deep is None else _too_deep(*deep)


def is_too_deep(found: MeshSolution, *, is_rough: bool) -> bool:
    """Return whether a layer is pressed in too far for a finer mesh or finite strain to be tried.

    In a solution that ``is_rough``, before finite strain or on a first mesh, that is by its whole
    thickness; else by `MOST_PRESSED_IN` of it, as in `impossible`. `finite` presses a covering in
    by 0.57 of its thickness and more where `curved` does so by all of it (Poisson ratios of 0.3 to
    0.5, thicknesses of 0.002 to 0.3 of the radius).
    """
    share, geometry = MOST_PRESSED_IN, found.geometry
    if is_rough:
        share, geometry = 1.0, ("curved" if geometry == "finite" else geometry)
    return _pressed_in_by(share, found, geometry) is not None


def _pressed_in_by(
    share: float, found: MeshSolution, geometry: Geometry
) -> tuple[str, Roller, Array] | None:
    """Return a roller with a layer pressed in by such a share of its thickness, and its layers'.

    None where there is none.
    """
    for side, roller in (("upper", found.nip.upper), ("lower", found.nip.lower)):
        pressed = _pressed_in(side, roller, found, geometry)
        if np.any(pressed >= share):
            return side, roller, pressed
    return None


def _too_deep(side: str, roller: Roller, pressed: Array) -> str:
    """Return the sentence on a layer that is pressed in too far."""
    number = int(np.argmax(pressed))
    many = len(roller.layers) > 1
    what = f"Layer {number + 1} (from the surface)" if many else "The covering"
    return (
        f"{what} of the {side} roller, {roller.layers[number].thickness:g} mm thick, is pressed in "
        f"by {100.0 * pressed[number]:.0f} % of its thickness; beyond "
        f"{100.0 * MOST_PRESSED_IN:.0f} % none of the models here holds. Lower the load or the "
        "approach, or take a thicker or harder covering."
    )


def _sheet_too_thin(final: MeshSolution) -> str:
    """Return the sentence on a sheet that loses too much of its thickness; "" if it does not."""
    sheet = final.nip.sheet
    if sheet is None:
        return ""
    lost = final.figures.peak_pressure * sheet.squeeze / sheet.thickness
    if lost < MOST_PRESSED_IN:
        return ""
    return (
        f"The sheet, {sheet.thickness:g} mm thick, is pressed together by {100.0 * lost:.0f} % "
        f"of its thickness; beyond {100.0 * MOST_PRESSED_IN:.0f} % none of the models here holds. "
        "Lower the load, or take a larger `modulus_thickness`."
    )


def _pressed_in(side: str, roller: Roller, final: MeshSolution, geometry: Geometry) -> Array:
    """Return the compression of each layer over its thickness, under the deepest surface point.

    Nothing is returned where no layer can be pressed in too far: none is compressed by more than
    the surface moves, nor by more than a free column under the peak is, the ratio of pressure and
    modulus, for what lies beside holds a layer (of 181 random layers none was compressed by 1.04
    times that ratio). A strain energy may yield more.

    Finite strain is seen inside by finite elements. Otherwise layers share what the surface moves
    as in linear theory, so that plies of one layer together count as that layer does.
    """
    most, peak = MOST_PRESSED_IN, final.figures.peak_pressure
    soft = [
        one.thickness
        for one in roller.layers
        if peak >= most * one.material.relaxed_modulus
        or not isinstance(one.material.energy, NeoHookean | None)
    ]
    if not soft:
        return np.zeros(0)
    u = final.displacements
    inward, sign = (u.z_upper, 1.0) if side == "upper" else (u.z_lower, -1.0)
    deepest = int(np.argmax(np.where(final.state.pressure > 0.0, inward[:-1], -np.inf)))
    moved = float(inward[deepest])
    if roller.core is None and moved < most * min(soft):
        return np.zeros(0)
    if len(roller.layers) == 1 and roller.core is None:
        return np.array([moved / roller.layers[0].thickness])
    tractions = SurfaceTractions.on_inner(final.nodes, sign * final.shear, final.pressure)
    depths, place = np.array([0.0, *roller.interfaces]), final.mesh.inner[[deepest]]
    speed, speeds = final.nip.speed, None
    if speed is not None:
        rate = rates_of(geometry, final.figures.creepage)[0 if side == "upper" else 1]
        speeds = (speed, rate * speed)
    beyond = beyond_linear(roller, geometry, tractions, speeds)
    field = interior_field(
        roller, tractions, depths, place, geometry=geometry, speed=speed, beyond=beyond
    )
    shares = -np.diff(field.u_z[:, 0]) / np.diff(depths)
    return np.asarray(shares if roller.core else shares * (moved / float(field.u_z[0, 0])))
