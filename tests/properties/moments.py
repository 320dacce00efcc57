"""Torques from the tractions on the deformed interface, which know no stretch and no loss."""

import numpy as np

from rollnip.rolling import surface_depths
from rollnip.rolling.surfaces import hoop_curvature


def moments(solution):
    """Driving torques that hold the pressure and the shear on the deformed interface.

    With heights eta over the tangent at first touch and the slope eta', the interface pushes the
    upper roller by (q - p eta', p + q eta') per dx; each torque is the moment about its axle.
    """
    of, mesh = solution.nip, solution.final.mesh
    x = mesh.fine.nodes[1:]
    u = mesh.finer(solution.final.displacements)
    depths = surface_depths(x, of, solution.model.geometry, u)
    slopes = 0.5 * np.diff(depths[0] - depths[1]) / np.diff(x)
    p, q = (middle(np.append(t, 0.0)) for t in (solution.pressure, solution.shear))
    along, across = (q - p * slopes) * np.diff(x), (p + q * slopes) * np.diff(x)
    arm = of.lower.radius - middle(depths[1])
    lower = float(np.sum(middle(x) * across - arm * along))
    axles = of.upper.radius + of.lower.radius - solution.approach
    return lower + axles * float(np.sum(along)), lower


def middle(values):
    return 0.5 * (values[1:] + values[:-1])


def power_by_moments(solution):
    """Power that both axles put in, by these torques [N/s]."""
    of, half = solution.nip, 0.5 * solution.creepage
    upper, lower = moments(solution)
    turning = upper * (1.0 + half) / of.upper.radius + lower * (1.0 - half) / of.lower.radius
    return of.speed * turning


def moment_of_linear_fields(roller, geometry, x, displacements, tractions):
    """Driving torque over the radius that holds the tractions on a roller of linear fields.

    The layers are in equilibrium in their undeformed shape, x being the arc along it. The first
    part knows neither stretch nor loss; the second is how far "curved" goes beyond it, by the
    stretch that goes with the rotation of the surface.

    Parameters
    ----------
    x : (n,) places [mm].
    displacements : u_x and u_z of the surface, (n,) each [mm].
    tractions : pressure, and shear on this roller along x, (n,) each [MPa].

    Returns
    -------
    Both parts [N/mm].
    """
    curvature, dx = hoop_curvature(roller, geometry), np.diff(x)
    (u_x, u_z), (p, q) = displacements, (middle(one) for one in tractions)
    slope = np.diff(u_z) / dx
    first = float((q * (1.0 - curvature * middle(u_z)) - p * slope) @ dx)
    rotation = slope + curvature * middle(u_x) if geometry == "curved" else np.zeros(dx.size)
    return first, float((0.5 * q * rotation**2) @ dx)
