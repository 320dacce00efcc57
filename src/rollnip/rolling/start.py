"""The first estimate of the half-width of the contact."""

from __future__ import annotations

import numpy as np

from rollnip._errors import InvalidInputError
from rollnip.nip import LineLoad, Nip
from rollnip.rolling.surfaces import PairKernels


def half_width_guess(nip: Nip, kernels: PairKernels) -> float:
    """Return the half-width [mm] of the elliptic pressure that closes the gap at centre and edge.

    It is exact for half-spaces (Hertz), and within some tens of per cent for layers.

    Raises
    ------
    InvalidInputError
        where the load or approach leads to a contact as wide as the smaller roller.
    """
    half_widths, centre = kernels.pressed.half_width, kernels.pressed.centre
    drop = np.maximum(centre - kernels.pressed.edge, np.finfo(float).tiny)
    peak = 0.5 * nip.curvature * half_widths**2 / drop
    if isinstance(nip.normal, LineLoad):
        name, wanted, unit = "load", nip.normal.load, "N/mm"
        reached = 0.5 * np.pi * half_widths * peak
    else:
        name, wanted, unit = "approach", nip.normal.approach, "mm"
        reached = peak * centre
    reached = np.maximum.accumulate(reached)
    if wanted > reached[-1]:
        raise InvalidInputError(
            f"`{name}` must be small enough for a nip narrower than the smaller roller; "
            f"got {wanted:g} {unit}, about {reached[-1]:.3g} {unit} flattens it whole."
        )
    return float(np.exp(np.interp(np.log(wanted), np.log(reached), np.log(half_widths))))
