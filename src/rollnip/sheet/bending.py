"""The length over which a sheet's stiffness against bending acts."""

from __future__ import annotations

from math import inf

from rollnip.nip import Nip
from rollnip.rollers import Roller


def bending_length(nip: Nip) -> float:
    """Return (D d/E)^(1/4) on the softer covering, over which bending stiffness counts [mm].

    D is the bending stiffness of the sheet, d and E thickness and relaxed modulus of the covering.
    A half-space core takes the length (D/E)^(1/3).
    """
    assert nip.sheet is not None
    stiffness = nip.sheet.bending_stiffness
    lengths = [_on_covering(roller, stiffness) for roller in (nip.upper, nip.lower)]
    return max(length for length in lengths if length < inf)


def _on_covering(roller: Roller, stiffness: float) -> float:
    if roller.is_rigid:
        return inf
    if not roller.layers:
        assert roller.core is not None
        return float((stiffness / roller.core.relaxed_modulus) ** (1.0 / 3.0))
    yielding = sum(layer.thickness / layer.material.relaxed_modulus for layer in roller.layers)
    return float((stiffness * yielding) ** 0.25)
