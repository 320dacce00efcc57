"""Displacement and strain of a surface under tractions that are linear between nodes.

A traction is a sum of hat functions on nodes x_0 < ... < x_N, zero at both ends: hat j (1 ... N-1)
is 1 at x_j and 0 at the other nodes. Two integrations by parts turn int G(x - s) hat(s) ds into
differences of the double integral of G at the nodes, exact for any spacing.
"""

from __future__ import annotations

from math import inf, sqrt

import numpy as np
from numpy.typing import NDArray

from rollnip.influence.kernel import TOLERANCE, Kernel

Array = NDArray[np.float64]


def displacement_matrix(kernel: Kernel, x: Array, nodes: Array) -> Array:
    """Displacement at ``x`` (m,) per hat on ``nodes`` (N+1,); (m, N-1) [mm/MPa].

    A kernel with channels gives (channels, m, N-1).
    """
    lengths = nodes[1:] - nodes[:-1]
    steps = _under_slopes(kernel, x, nodes, _most(kernel, lengths))
    steps /= lengths.reshape(-1, *[1] * (steps.ndim - 1))
    hats = np.moveaxis(steps[:-1] - steps[1:], 0, 1)
    if kernel.coefficients.ndim == 3:
        hats = np.moveaxis(hats, -1, 0)[: kernel.count]
    return np.ascontiguousarray(hats)


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
    lengths = nodes[1:] - nodes[:-1]
    ends = np.zeros((1, tractions.shape[1]))
    slopes = np.diff(tractions, axis=0, prepend=ends, append=ends) / lengths[:, None]
    most = _most(kernel, lengths)
    # Some elements at a time: their values stay in the processor's cache, and sets that are each of
    # a few neighbours make a band.
    channels = kernel.coefficients[0, 0].size
    out = np.zeros((slopes.shape[1], x.size * channels))
    block = max(2**15 // out.shape[1], 1)
    for start in range(0, lengths.size, block):
        rows = slice(start, start + block)
        sets = np.flatnonzero(np.any(slopes[rows], axis=0))
        if sets.size:
            columns = slice(int(sets[0]), int(sets[-1]) + 1)
            here = nodes[start : start + block + 1]
            values = _under_slopes(kernel, x, here, most[rows])
            out[columns] += slopes[rows, columns].T @ values.reshape(-1, out.shape[1])
    made = out.reshape(-1, x.size, channels).T[: kernel.count]
    return np.ascontiguousarray(made[0] if kernel.coefficients.ndim == 2 else made)


def _under_slopes(kernel: Kernel, x: Array, nodes: Array, most: Array) -> Array:
    """Displacement at ``x`` (m,) per slope of the traction over each element; (N, m) [mm^2/MPa].

    That is the difference of the double integral at both ends of the element, which is the integral
    of the single one over it. Where the double integral exceeds ``most`` (N,), rounding would be
    seen: two Gauss points of the single integral take its place. They miss h^4/4320 of the third
    derivative of G, h the length of the element.

    A kernel with channels gives (N, m, channels).
    """
    values = kernel.double_integral(x - nodes[:, None])
    out = values[:-1] - values[1:]
    rows = np.flatnonzero(np.abs(values[:-1]).reshape(most.size, -1).max(axis=1) > most)
    if rows.size:
        largest = np.abs(values[rows]).reshape(rows.size, x.size, -1).max(axis=2)
        row, place = np.nonzero(largest > most[rows, None])
        element = rows[row]
        length = nodes[element + 1] - nodes[element]
        middle = x[place] - nodes[element] - 0.5 * length
        apart = length / sqrt(12.0)
        mean = 0.5 * (kernel.integral(middle - apart) + kernel.integral(middle + apart))
        out[element, place] = mean * length.reshape(-1, *[1] * (mean.ndim - 1))
    return out


def _most(kernel: Kernel, lengths: Array) -> Array:
    """Return the double integral from which on its rounding would be seen in tractions, (N,).

    It grows as the square of the distance, and its rounding with it. An element resists as its own
    deflection tells, which goes as the square of its length h and is small under a stiff skin:
    there noise of 1e-16 is some 1e-3 of the pressure, with h = 2e-4 mm in a contact of 7 mm. It may
    be as much of it as a table leaves out. The first and the last element only end the mesh.
    """
    own = np.abs(kernel.double_integral(lengths)).reshape(lengths.size, -1).max(axis=1)
    own[[0, -1]] = inf
    return np.asarray(own * (TOLERANCE / np.finfo(float).eps))


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
