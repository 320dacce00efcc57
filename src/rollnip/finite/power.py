"""Heat generated in a covering in steady rolling, from the work of the tractions on its surface.

The core drives the covering with the torque M that balances the tractions, while the surface moves
under them. Per rolled distance of the undeformed surface the heat is

    w = M/R - int f . dx/ds ds,    M = int (f_y x + f_x (R - y)) ds,

with the force f per undeformed arc ds at the present place (x, y). Energy that the material still
stores where it leaves the mesh is counted as heat, because it is lost later.
"""

from __future__ import annotations

import numpy as np

from rollnip.finite.equilibrium import Body
from rollnip.finite.follower_load import Tractions
from rollnip.finite.strip import Array, on_circle


def heat_inside(body: Body, displacement: Array, tractions: Tractions) -> float:
    """Return w of an equilibrium [N/mm]; about 0 for elastic layers."""
    surface, curvature = body.strip.surface, body.strip.depths.roller.curvature
    moved, rate = surface.moved(displacement)
    x, y = np.stack(on_circle(surface.arcs, curvature)) + moved
    angle = curvature * surface.arcs
    along, up = np.stack([np.cos(angle), np.sin(angle)]) + rate
    p, q = tractions(x)[:2]
    f_x, f_y = q * along - p * up, p * along + q * up
    torque = f_x + curvature * (f_y * x - f_x * y)
    return float((surface.weights * (torque - f_x * along - f_y * up)).sum())


def linear_heat_inside(body: Body, displacement: Array, tractions: Tractions) -> float:
    """Return w = -int (q du_x/ds + p du_z/ds) ds of linear theory [N/mm]."""
    surface, curvature = body.strip.surface, body.strip.depths.roller.curvature
    (u_x, u_y), (x_rate, y_rate) = surface.moved(displacement)
    cos, sin = np.cos(curvature * surface.arcs), np.sin(curvature * surface.arcs)
    p, q = tractions(surface.arcs)[:2]
    along, into = u_x * cos + u_y * sin, u_y * cos - u_x * sin
    work = q * (x_rate * cos + y_rate * sin + curvature * into)
    work += p * (y_rate * cos - x_rate * sin - curvature * along)
    return -float((surface.weights * work).sum())
