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
    return _kinks(kernel.double_integral(x[:, None] - nodes[None, :]), nodes)


def strain_matrix(kernel: Kernel, x: Array, nodes: Array) -> Array:
    """Derivative of the displacement at ``x`` (m,) per hat; (m, N-1) [1/MPa].

    A kernel with channels gives (channels, m, N-1).
    """
    return _kinks(kernel.integral(x[:, None] - nodes[None, :]), nodes)


def load_weights(nodes: Array) -> Array:
    """Load of each hat, int hat dx, shape (N-1,) [mm]."""
    return 0.5 * (nodes[2:] - nodes[:-2])


def _kinks(values: Array, nodes: Array) -> Array:
    """Combine values at the nodes (columns) into hats: a hat is three changes of slope."""
    inverse = 1.0 / np.diff(nodes)
    steps = (values[..., 1:] - values[..., :-1]) * inverse
    return np.asarray(steps[..., 1:] - steps[..., :-1])
