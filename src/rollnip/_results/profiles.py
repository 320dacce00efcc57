"""Distributions along the surfaces: points at which to show them, slip velocity and strain."""

from __future__ import annotations

import numpy as np

from rollnip.contact import ContactZone, State
from rollnip.contact.problem import Array
from rollnip.influence import displacement_matrix, strain_matrix
from rollnip.model import RINGS
from rollnip.rolling import MeshSolution, PairFields, hoop_curvature


def fine_points(final: MeshSolution) -> Array:
    """Return the nodes from edge to edge, and points to just over a nip width on either side."""
    is_cubic = final.mesh.fine.values is not None
    inside = final.nodes[1:-1] if is_cubic else final.nodes[2:-2]
    width = final.figures.nip_width
    away = np.concatenate([np.geomspace(1e-3, 0.1, 20), np.linspace(0.12, 1.1, 50)]) * width
    edges = final.zones[0].start, final.zones[-1].stop
    trailing = edges[0] - away[::-1]
    leading = edges[1] + away
    return np.concatenate([trailing[trailing < inside[0]], inside, leading[leading > inside[-1]]])


def slip_velocity(fields: PairFields, zones: tuple[ContactZone, ...], speed: float) -> Array:
    """Return the slip velocity of the upper surface relative to the lower, nan outside contact."""
    return slip_in_zones(fields.x, -speed * fields.creep / np.diff(fields.x), zones)


def slip_in_zones(x: Array, rates: Array, zones: tuple[ContactZone, ...]) -> Array:
    """Return the slip velocity at places: 0 in stick, nan outside contact.

    ``rates``: difference of the velocities in the intervals between them.
    """
    out, middle = np.full(x.size, np.nan), 0.5 * (x[1:] + x[:-1])
    for zone in zones:
        inside = (x >= zone.start) & (x <= zone.stop)
        out[inside] = 0.0 if zone.state == State.STICK else np.interp(x[inside], middle, rates)
    return out


def surface_strain(x: Array, final: MeshSolution, *, side: str) -> Array:
    """Return the strain of one surface at ``x``: du_x/dx, or in rings the stretch less 1."""
    nip, kernels, upper = final.nip, final.contact.kernels, side == "upper"
    roller, surface = (nip.upper, kernels.upper) if upper else (nip.lower, kernels.lower)
    if surface is None:
        return np.zeros(x.size)
    p, q = final.pressure, final.shear if upper else -final.shear
    strain, slope = _of_surface(strain_matrix(surface.together, x, final.nodes), p, q)
    if final.geometry not in RINGS:
        return strain
    hoop = hoop_curvature(roller, final.geometry)
    u_x, u_z = _of_surface(displacement_matrix(surface.together, x, final.nodes), p, q)
    held, second = kernels.held, kernels.second_upper if upper else kernels.second_lower
    if held is None and second is None:
        return strain - hoop * u_z + 0.5 * (slope + hoop * u_x) ** 2
    if held is None:
        held = kernels.second_fields(final.nodes, final.pressure, final.shear)
    beyond = held.at(x, 1).four
    along, inward = beyond[:2] if upper else beyond[2:]
    present = np.hypot(1.0, hoop * x + slope + inward)
    return np.asarray(present / (1.0 - strain - along) - 1.0)


def _of_surface(per_traction: Array, pressure: Array, shear: Array) -> tuple[Array, Array]:
    """Return u_x and u_z of a surface, or their slopes.

    ``per_traction`` holds the influence of xx, zz and xz, (3, n, N-1).
    """
    xx, zz, xz = per_traction
    return xz @ pressure + xx @ shear, zz @ pressure - xz @ shear
