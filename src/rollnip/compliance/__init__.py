"""Compliance of layered coatings in the Fourier domain: pure functions of arrays."""

from rollnip.compliance._flat import flat_compliance, half_space_limit
from rollnip.compliance._ring import ring_compliance
from rollnip.compliance._types import SurfaceCompliance

__all__ = ["SurfaceCompliance", "flat_compliance", "half_space_limit", "ring_compliance"]
