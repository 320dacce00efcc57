"""Carry what is known at the nodes and in the elements of one mesh to another one."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import RegularGridInterpolator

from finite_elements.mesh import Array, Ring


def nodal(old: Ring, displacement: Array, new: Ring) -> Array:
    """Interpolate displacements between the nodes of a mesh."""
    values = np.append(displacement, 0.0)[old.dofs].reshape(old.columns, old.rows, 2)
    arcs, free = old.arc, new.unknowns // (2 * new.columns)  # rows that move
    if old.columns < 2 * old.arc_ends.size - 1:  # closed
        arcs = np.append(arcs, arcs[0] + 2.0 * np.pi * old.roller.radius)
        values = np.concatenate((values, values[:1]))
    at = np.meshgrid(new.arc, new.depth[:free], indexing="ij")
    found = RegularGridInterpolator((arcs, old.depth), values)(np.stack(at, axis=-1))
    return np.asarray(found).reshape(-1)


def by_element(old: Ring, values: Array, new: Ring) -> Array:
    """Carry what is linear in each element (mean, and halves of the changes) to other elements."""
    rows = old.depth_ends.size - 1
    place, to = [], []
    for mesh in (old, new):
        at = np.meshgrid(mesh.arc[1::2], mesh.depth[1::2], indexing="ij")
        half = np.meshgrid(
            0.5 * np.diff(mesh.arc_ends), 0.5 * np.diff(mesh.depth_ends), indexing="ij"
        )
        (place if mesh is old else to).extend([*at, *half])
    i = np.clip(np.searchsorted(old.arc_ends, to[0], side="right") - 1, 0, old.arc_ends.size - 2)
    j = np.clip(np.searchsorted(old.depth_ends, to[1], side="right") - 1, 0, rows - 1)
    own = values.reshape(-1, rows, 3)[i, j]
    along = (to[0] - place[0][i, j]) / place[2][i, j]
    down = (to[1] - place[1][i, j]) / place[3][i, j]
    mean = own[..., 0] + own[..., 1] * along + own[..., 2] * down
    ratio = (to[2] / place[2][i, j], to[3] / place[3][i, j])
    parts = (mean, own[..., 1] * ratio[0], own[..., 2] * ratio[1])
    return np.stack(parts, axis=-1).reshape(-1, 3)
