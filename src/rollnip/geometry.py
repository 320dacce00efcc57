"""Second-order geometry of deformed surfaces: distance, stretch and rotation (theory, section 6).

Functions take and return arrays. Displacements are those of a roller's surface in its own frame:
u_x along the nip, u_z into the roller.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def sagitta(x: Array, curvature: float, u_x: Array, u_z: Array) -> Array:
    """Return the depth of a deformed surface below the tangent at first touch, at deformed x.

    The point at the angle theta of a roller of radius R moves to (R - u_z) e_r + u_x e_theta, that
    is to the radius rho = sqrt((R - u_z)^2 + u_x^2). At the deformed abscissa x it is therefore R -
    sqrt(rho^2 - x^2) below the tangent. For a plane this is u_z.

    Parameters
    ----------
    x, u_x, u_z : (n,) [mm].
    curvature : 1/R [1/mm].

    Returns
    -------
    (n,) [mm]; its flat, linear approximation is x^2/(2R) + u_z.
    """
    # With sqrt(rho^2 - x^2) = R sqrt(1 - t) this form loses no digits where R is large.
    twice = 2.0 * u_z + curvature * (x * x - u_z * u_z - u_x * u_x)  # R t
    return np.asarray(twice / (1.0 + np.sqrt(np.maximum(1.0 - curvature * twice, 0.0))))


def mean_of_neighbours(values: Array) -> Array:
    """Return the mean over each interval of values given at its ends, along the last axis."""
    return 0.5 * (values[..., 1:] + values[..., :-1])


def linear_stretch(dx: Array, curvature: float | Array, u_x: Array, u_z: Array) -> Array:
    """Return the first-order stretch of an arc over each interval, int (du_x/dx - u_z/R) dx [mm].

    It applies to one surface, or to several in rows; then ``curvature`` is a column.
    """
    return _steps(u_x) - curvature * dx * mean_of_neighbours(u_z)


def second_stretch(x: Array, curvature: float | Array, u_x: Array, u_z: Array) -> Array:
    """Return the stretch less 1, integrated over each interval [mm], where x is the deformed place.

    The material that is at x now was at x - u_x. The integral is int [sqrt(1 + slope^2)/(1 -
    du_x/dx) - 1] dx: present length over undeformed arc, less 1. It applies to one surface or to
    several, as in `linear_stretch`.
    """
    dx = _steps(x)
    slope = curvature * mean_of_neighbours(x) + _steps(u_z) / dx
    along = _steps(u_x) / dx
    return np.asarray(dx * (np.sqrt(1.0 + slope**2) / (1.0 - along) - 1.0))


def rotation_stretch(dx: Array, curvature: float | Array, u_x: Array, u_z: Array) -> Array:
    """Return the stretch by rotation over each interval, int (du_z/dx + u_x/R)^2/2 dx [mm].

    It applies to one surface or to several, as in `linear_stretch`.
    """
    rotation = _steps(u_z) / dx + curvature * mean_of_neighbours(u_x)
    return 0.5 * rotation**2 * dx


def _steps(values: Array) -> Array:
    """Return the change over each interval of values given at its ends, along the last axis."""
    return values[..., 1:] - values[..., :-1]
