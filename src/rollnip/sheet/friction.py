"""Friction on the interfaces of a sheet: its coefficients, and the directions of the shears."""

from __future__ import annotations

from rollnip.nip import Nip

SIDE_SIGNS = 1.0, -1.0
"""Signs of the shear on the upper and lower roller, and of the creep of its surface."""


def frictions_of(nip: Nip) -> tuple[float, float]:
    """Return the friction coefficients of the sheet on the upper and on the lower roller."""
    return nip.friction_on("upper"), nip.friction_on("lower")
