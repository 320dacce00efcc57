"""Displacements and strains of the surfaces in a rough contact, on its grid and beyond."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import NDArray

from rollnip.influence import (
    SurfaceKernels,
    displacement_matrix,
    grid_displacements,
    grid_strains,
    strain_matrix,
)
from rollnip.rough.contact import RoughContact
from rollnip.rough.grid import Convolution

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class SurfaceFields:
    """Fields of one surface in its own frame: u_x, u_z [mm], du_x/dx and du_z/dx."""

    u_x: Array
    u_z: Array
    strain: Array
    slope: Array


def outside(contact: RoughContact, width: float) -> tuple[Array, Array]:
    """Return places beyond the grid on both sides, up to 1.1 nip widths from the contact [mm]."""
    x = contact.x
    first = contact.intervals[0][0] - 1.1 * width
    last = contact.intervals[-1][1] + 1.1 * width
    trailing = np.linspace(first, x[0], 26)[:-1] if first < x[0] else np.empty(0)
    leading = np.linspace(x[-1], last, 26)[1:] if last > x[-1] else np.empty(0)
    return trailing, leading


def surface_fields(
    kernels: SurfaceKernels | None, contact: RoughContact, beyond: tuple[Array, Array]
) -> SurfaceFields:
    """Return the fields of one surface beyond the grid and at its nodes, in order of x.

    Far from the pressure its details have no effect: beyond the grid a thinned pressure is used.
    """
    trailing, leading = beyond
    count = contact.x.size
    if kernels is None:
        zero = np.zeros(trailing.size + count + leading.size)
        return SurfaceFields(zero, zero, zero, zero)
    spacing, pressure = contact.sampling.spacing, contact.pressure
    on_grid = [
        Convolution(make(kernel, spacing, count)).of(pressure)
        for make in (grid_displacements, grid_strains)
        for kernel in (kernels.xz, kernels.zz)
    ]
    away = np.concatenate([trailing, leading])
    if away.size == 0:  # the grid covers all that is wanted
        return SurfaceFields(*on_grid)
    nodes, thin = thinned(contact.x, pressure, 1024)
    off_grid = [
        matrix(kernel, away, nodes) @ thin[1:-1]
        for matrix in (displacement_matrix, strain_matrix)
        for kernel in (kernels.xz, kernels.zz)
    ]
    u_x, u_z, strain, slope = (
        np.concatenate([far[: trailing.size], near, far[trailing.size :]])
        for near, far in zip(on_grid, off_grid, strict=True)
    )
    return SurfaceFields(u_x, u_z, strain, slope)


def thinned(x: Array, pressure: Array, most: int) -> tuple[Array, Array]:
    """Return the pressure on fewer nodes over the contact, zero at both ends.

    Parameters
    ----------
    x, pressure : (n,) on a uniform grid; zero at its ends.
    most : approximate number of nodes.

    Returns
    -------
    Nodes [mm] and pressures [MPa], both (m,). Each nodal load is divided between hats of the wider
    spacing, which keeps the load and its moment.
    """
    touching = np.flatnonzero(pressure > 0.0)
    first, last = int(touching[0]), int(touching[-1])
    stride = max(1, ceil((last - first) / most))
    spacing = float(x[1] - x[0])
    place = (touching - first) / stride + 1.0
    below = place.astype(int)
    share = place - below
    count = int(np.max(below)) + 3
    thin = np.bincount(below, (1.0 - share) * pressure[touching], count)
    thin += np.bincount(below + 1, share * pressure[touching], count)
    nodes = x[first] + stride * spacing * (np.arange(count) - 1.0)
    return nodes, thin / stride
