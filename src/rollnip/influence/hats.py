"""Displacement and strain of a surface under tractions that are linear between nodes.

A traction is a sum of hat functions on nodes x_0 < ... < x_N, zero at both ends: hat j (1 ... N-1)
is 1 at x_j and 0 at the other nodes. Two integrations by parts turn int G(x - s) hat(s) ds into
differences of the double integral of G at the nodes. They are exact for any spacing, up to
rounding. For short elements far away, two Gauss points of the single integral replace the
differences.
"""

from __future__ import annotations

from math import inf, sqrt

import numpy as np
from numpy.typing import NDArray

from rollnip.influence.kernel import Kernel

Array = NDArray[np.float64]


def displacement_matrix(kernel: Kernel, x: Array, nodes: Array) -> Array:
    """Return the displacement at ``x`` (m,) per hat on ``nodes`` (N+1,); (m, N-1) [mm/MPa].

    A kernel with channels gives (channels, m, N-1).
    """
    lengths = nodes[1:] - nodes[:-1]
    steps = _under_slopes(kernel, x, nodes, kernel.reach_of_differences * lengths)
    steps /= lengths[:, None]
    return np.ascontiguousarray((steps[..., :-1, :] - steps[..., 1:, :]).swapaxes(-1, -2))


def strain_matrix(kernel: Kernel, x: Array, nodes: Array) -> Array:
    """Return the derivative of the displacement at ``x`` (m,) per hat; (m, N-1) [1/MPa].

    A kernel with channels gives (channels, m, N-1).
    """
    return np.diff(np.diff(kernel.integral(x[:, None] - nodes)) / np.diff(nodes))


def displacement_under(kernel: Kernel, x: Array, nodes: Array, tractions: Array | None) -> Array:
    """Return the displacement at ``x`` (m,) under tractions (N-1, s) at nodes[1:-1], (m, s) [mm].

    The s columns are independent sets of tractions. The result is `displacement_matrix` times the
    tractions, without forming the matrix; where there are none, it is that matrix. A kernel with
    channels gives (channels, m, s).
    """
    if tractions is None:
        return displacement_matrix(kernel, x, nodes)
    lengths = nodes[1:] - nodes[:-1]
    slopes = _steps(tractions) / lengths[:, None]
    furthest = kernel.reach_of_differences * lengths
    furthest[[0, -1]] = inf  # the outermost elements only end the mesh
    # Where no element is far from any place, changes of slope at the nodes save one difference.
    is_near = _reach(x, nodes) <= furthest.min()
    parts = _steps(slopes) if is_near else slopes
    # In blocks, whose values fit the processor's cache. Where each set of tractions has few nonzero
    # neighbours, a block needs a few of the columns only.
    out = np.zeros((*kernel.coefficients.shape[1:-1], x.size, slopes.shape[1]))
    block = max(2**15 // (x.size * kernel.count), 1)
    for start in range(0, len(parts), block):
        rows = slice(start, start + block)
        sets = np.flatnonzero(np.any(parts[rows], axis=0))
        if sets.size:
            columns = slice(int(sets[0]), int(sets[-1]) + 1)
            if is_near:
                values = kernel.double_integral(x - nodes[rows, None])
            else:
                here = nodes[start : start + block + 1]
                values = _under_slopes(kernel, x, here, furthest[rows])
            out[..., columns] += values.swapaxes(-1, -2) @ parts[rows, columns]
    return out


def _under_slopes(kernel: Kernel, x: Array, nodes: Array, furthest: Array) -> Array:
    """Return the displacement at ``x`` (m,) per slope of the traction over each element [mm^2/MPa].

    It is the difference of the double integral at both ends of the element, that is, the integral
    of the single one over it. For places farther away than ``furthest`` (N,), two Gauss points of
    the single integral are used instead.

    For nodes (N+1,) the result is (N, m); a kernel with channels gives (channels, N, m).
    """
    values = kernel.double_integral(x - nodes[:, None])
    out = values[..., :-1, :] - values[..., 1:, :]
    if _reach(x, nodes) > furthest.min():
        lengths = nodes[1:] - nodes[:-1]
        distance = x - (nodes[:-1] + 0.5 * lengths)[:, None]
        element, place = np.nonzero(np.abs(distance) > furthest[:, None])
        length, middle = lengths[element], distance[element, place]
        apart = length / sqrt(12.0)
        mean = 0.5 * (kernel.integral(middle - apart) + kernel.integral(middle + apart))
        out[..., element, place] = mean * length
    return out


def _steps(values: Array) -> Array:
    """Return the differences from row to row, with zeros before the first and after the last."""
    padded = np.zeros((len(values) + 2, values.shape[1]))
    padded[1:-1] = values
    return np.asarray(padded[1:] - padded[:-1])


def _reach(x: Array, nodes: Array) -> float:
    """Return the largest distance of a place from a node."""
    return float(max(x.max() - nodes[0], nodes[-1] - x.min()))


def load_weights(nodes: Array) -> Array:
    """Return the load of each hat, int hat dx, (N-1,) [mm]."""
    return 0.5 * (nodes[2:] - nodes[:-2])
