"""A first guess of the half-width of the contact."""

from __future__ import annotations

import numpy as np

from rollnip._errors import InvalidInputError
from rollnip.influence import Kernel
from rollnip.nip import LineLoad, Nip
from rollnip.rolling.surfaces import Array, PairKernels

_CANDIDATES = np.geomspace(1e-9, 1.0, 40)  # half-widths, of the smaller radius
# An elliptic pressure of half-width 1 on some nodes, by its changes of slope there; how far the
# nodes are from the centre and from an edge.
_ANGLES = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 25)
_SLOPES = np.pad(np.diff(np.cos(_ANGLES)) / np.diff(np.sin(_ANGLES)), 1)
_KINKS = np.diff(_SLOPES)
_DISTANCES = np.array([0.0, 1.0])[:, None] - np.sin(_ANGLES)


def half_width_guess(nip: Nip, kernels: PairKernels) -> float:
    """Half-width [mm] of an elliptic pressure that closes the gap at its centre and its edge.

    Exact for half-spaces (Hertz), within some tens of per cent for layers.

    Raises
    ------
    InvalidInputError
        where the load or approach asks for a contact as wide as the smaller roller.
    """
    radius = min(nip.upper.radius, nip.lower.radius)
    half_widths = radius * _CANDIDATES
    centre, edge = _elliptic_displacements(_normal_kernel(kernels), half_widths)
    drop = np.maximum(centre - edge, np.finfo(float).tiny)
    peak = 0.5 * nip.curvature * half_widths**2 / drop
    if isinstance(nip.normal, LineLoad):
        name, wanted = "load", nip.normal.load
        reached = 0.5 * np.pi * half_widths * peak
    else:
        name, wanted = "approach", nip.normal.approach
        reached = peak * centre
    reached = np.maximum.accumulate(reached)
    if wanted > reached[-1]:
        raise InvalidInputError(
            f"`{name}` must be small enough for a nip narrower than the smaller roller; "
            f"got {wanted:g}, about {reached[-1]:.3g} flattens it whole."
        )
    return float(np.exp(np.interp(np.log(wanted), np.log(reached), np.log(half_widths))))


def _normal_kernel(kernels: PairKernels) -> Kernel:
    parts = [k.zz for k in (kernels.upper, kernels.lower) if k is not None]
    return parts[0] if len(parts) == 1 else parts[0] + parts[1]


def _elliptic_displacements(kernel: Kernel, half_widths: Array) -> tuple[Array, Array]:
    """u_z at the centre and the edge under p = sqrt(1 - x^2/a^2), for each a [mm/MPa]."""
    values = kernel.double_integral(np.multiply.outer(half_widths, _DISTANCES))
    centre, edge = (values @ _KINKS).T / half_widths
    return centre, edge
