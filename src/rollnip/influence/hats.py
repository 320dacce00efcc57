"""Displacement and strain of a surface under tractions that are linear between nodes.

A traction is a sum of hat functions on nodes x_0 < ... < x_N, zero at both ends: hat j (1 ... N-1)
is 1 at x_j and 0 at the other nodes. Two integrations by parts turn int G(x - s) hat(s) ds into
differences of the double integral of G at the nodes, exact for any spacing.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rollnip.influence.kernel import Kernel

Array = NDArray[np.float64]


def displacement_matrix(kernel: Kernel, x: Array, nodes: Array) -> Array:
    """Displacement at ``x`` (m,) per hat on ``nodes`` (N+1,); (m, N-1) [mm/MPa].

    A kernel with channels gives (channels, m, N-1).
    """
    return _kinks(kernel.double_integral(x[:, None] - nodes[None, :]), nodes, kernel.count)


def strain_matrix(kernel: Kernel, x: Array, nodes: Array) -> Array:
    """Derivative of the displacement at ``x`` (m,) per hat; (m, N-1) [1/MPa].

    A kernel with channels gives (channels, m, N-1).
    """
    return _kinks(kernel.integral(x[:, None] - nodes[None, :]), nodes, kernel.count)


def displacement_under(kernel: Kernel, x: Array, nodes: Array, tractions: Array) -> Array:
    """Displacement at ``x`` (m,) under ``tractions`` (N-1, s), s sets of values at nodes[1:-1].

    What `displacement_matrix` times the tractions gives, without the matrix: (m, s) [mm]; of a
    kernel with channels (channels, m, s).
    """
    # Slopes of the tractions: those before the first and behind the last node are zero.
    slopes = np.zeros((nodes.size + 1, tractions.shape[1]))
    slopes[1:-2] = tractions
    slopes[2:-1] -= tractions
    slopes[1:-1] /= (nodes[1:] - nodes[:-1])[:, None]
    kinks = slopes[1:] - slopes[:-1]
    # Some nodes at a time: their values stay in the processor's cache, and sets that are each of a
    # few neighbours make a band.
    channels = kernel.coefficients[0, 0].size
    out = np.zeros((kinks.shape[1], x.size * channels))
    block = max(2**15 // out.shape[1], 1)
    for start in range(0, nodes.size, block):
        rows = slice(start, start + block)
        sets = np.flatnonzero(np.any(kinks[rows], axis=0))
        if sets.size:
            columns = slice(int(sets[0]), int(sets[-1]) + 1)
            values = kernel.double_integral(x[None, :] - nodes[rows, None])
            out[columns] += kinks[rows, columns].T @ values.reshape(-1, out.shape[1])
    made = out.reshape(-1, x.size, channels).T[: kernel.count]
    return np.ascontiguousarray(made[0] if kernel.coefficients.ndim == 2 else made)


def load_weights(nodes: Array) -> Array:
    """Load of each hat, int hat dx, shape (N-1,) [mm]."""
    return 0.5 * (nodes[2:] - nodes[:-2])


def _kinks(values: Array, nodes: Array, count: int) -> Array:
    """Combine values at the nodes (m, N+1, ...) into hats: a hat is three changes of slope.

    A last axis of channels becomes the first, of ``count``.
    """
    channels = values[0, 0].size
    inverse = np.append(1.0 / np.diff(nodes), 0.0)
    # Differences of all rows as of one long row are three times faster than row by row; those
    # from the end of a row to the start of the next are left out at last.
    steps = np.zeros(values.shape)
    _differences(values.reshape(-1), channels, steps.reshape(-1))
    steps.reshape(values.shape[0], -1)[:] *= np.repeat(inverse, channels)
    _differences(steps.reshape(-1), channels, steps.reshape(-1))
    hats = steps[:, :-2]
    return np.ascontiguousarray(hats if values.ndim == 2 else np.moveaxis(hats, -1, 0)[:count])


def _differences(row: Array, distance: int, out: Array) -> None:
    """Write the values ``distance`` ahead less those here into the start of ``out``."""
    np.subtract(row[distance:], row[:-distance], out=out[:-distance])
