"""Depth, stretch and creep of the deformed surfaces, in each geometry."""

from __future__ import annotations

import numpy as np

from rollnip.contact.problem import Array
from rollnip.geometry import linear_stretch, rotation_stretch, sagitta, second_stretch
from rollnip.model import FINITE, RINGS, Geometry
from rollnip.nip import Nip
from rollnip.rolling.displacements import Displacements
from rollnip.rolling.rolling_contact import RollingContact
from rollnip.rolling.surfaces import hoop_curvature


def surface_depths(x: Array, nip: Nip, geometry: Geometry, u: Displacements) -> tuple[Array, Array]:
    """Return the depth of each deformed surface below the tangent at first touch, (n,) each [mm].

    The approach is left out. At finite strain u_z belongs to the material that is at x after
    deformation: the radius there is R - u_z.
    """
    sides = (nip.upper, u.x_upper, u.z_upper), (nip.lower, u.x_lower, u.z_lower)

    depths = []
    for roller, u_x, u_z in sides:
        if geometry == "corrected":
            depths.append(sagitta(x, roller.curvature, u_x, u_z))
        elif geometry in FINITE and roller.core is None:
            depths.append(sagitta(x, roller.curvature, np.zeros_like(x), u_z))
        else:
            depths.append(0.5 * roller.curvature * x * x + u_z)
    return depths[0], depths[1]


def stretch_excess(x: Array, nip: Nip, geometry: Geometry, u: Displacements) -> Array:
    """Return int (stretch - 1) dx of the upper and lower surface per interval, (2, n - 1) [mm].

    It is 0 for a rigid roller.
    """
    rollers = (nip.upper, nip.lower)
    hoops = np.array([[hoop_curvature(roller, geometry)] for roller in rollers])
    is_whole = [roller.core is None and not roller.is_rigid for roller in rollers]
    if geometry in FINITE and all(is_whole):
        return second_stretch(x, hoops, *u.rows)
    excess = linear_stretch(x[1:] - x[:-1], hoops, *u.rows)
    if geometry in RINGS:
        excess += rotation_stretch(x[1:] - x[:-1], hoops, *u.rows)
    if geometry in FINITE:
        for out, whole, hoop, u_x, u_z in zip(excess, is_whole, hoops, *u.rows, strict=True):
            if whole:
                out[:] = second_stretch(x, hoop, u_x, u_z)
    return excess


def stretch_parts(
    x: Array, contact: RollingContact, u_linear: Displacements, u: Displacements
) -> tuple[Array, Array]:
    """Return `stretch_excess` split into its linear part and the rest.

    If the contact holds a stretch, the rest is that one. ``u_linear``: the linear part of ``u``.
    """
    kernels = contact.kernels
    dx, hoops = x[1:] - x[:-1], np.array(kernels.hoops)[:, None]
    linear, beyond = linear_stretch(dx, hoops, *u_linear.rows), kernels.held_stretch(x)
    if beyond is not None:
        return linear, beyond
    if contact.geometry == "curved":
        return linear, rotation_stretch(dx, hoops, *u.rows)
    return linear, stretch_excess(x, contact.nip, contact.geometry, u) - linear


def creep_of(dx: Array, geometry: Geometry, excess: Array, creepage: float) -> Array:
    """Return the creep over intervals of lengths ``dx`` (n,), from `stretch_excess` (2, n) [mm].

    It is int (1 + xi/2) stretch_u - (1 - xi/2) stretch_l dx.
    """
    upper, lower = excess
    if geometry in ("linear", "corrected"):
        # At small strain the product of creepage and strain is neglected.
        return np.asarray(creepage * dx + upper - lower)
    half = 0.5 * creepage
    return np.asarray(creepage * dx + (1.0 + half) * upper - (1.0 - half) * lower)


def arc_ratio(x: Array, nip: Nip, geometry: Geometry, u: Displacements) -> Array | float:
    """Return the length of the deformed interface over dx in each interval, (n - 1,).

    It is 1 unless the strain is finite. Only then is x a place in the deformed state, and the shear
    a force per length of interface; otherwise the shear is a force per dx.
    """
    if geometry not in FINITE:
        return 1.0
    middle, dx = 0.5 * (x[1:] + x[:-1]), x[1:] - x[:-1]
    tilt = u.z_lower - u.z_upper
    slope = (nip.lower.curvature - nip.upper.curvature) * middle + (tilt[1:] - tilt[:-1]) / dx
    return np.asarray(np.sqrt(1.0 + 0.25 * slope**2))
