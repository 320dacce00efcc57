"""Compliance of layered coatings in the Fourier domain; pure functions of arrays."""

from rollnip.compliance._across import shear_compliance, shear_fields
from rollnip.compliance._flat import flat_compliance, half_space_limit
from rollnip.compliance._ring import ring_compliance
from rollnip.compliance._transfer import (
    flat_amplitudes,
    flat_fields,
    flat_transfer,
    ring_amplitudes,
    ring_fields,
    ring_transfer,
)
from rollnip.compliance._types import DepthTransfer, LayerFields, SurfaceCompliance

__all__ = [
    "DepthTransfer",
    "LayerFields",
    "SurfaceCompliance",
    "flat_amplitudes",
    "flat_compliance",
    "flat_fields",
    "flat_transfer",
    "half_space_limit",
    "ring_amplitudes",
    "ring_compliance",
    "ring_fields",
    "ring_transfer",
    "shear_compliance",
    "shear_fields",
]
