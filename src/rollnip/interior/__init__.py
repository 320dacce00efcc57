"""Fields inside the layers of a roller under given surface tractions."""

from rollnip.interior.bonds import InterfaceStress, interface_stresses
from rollnip.interior.evaluate import interior_field
from rollnip.interior.field import InteriorField, StressRanges
from rollnip.interior.finite import FiniteFields, beyond_linear
from rollnip.interior.losses import loss_below, loss_per_distance
from rollnip.interior.tractions import SurfaceTractions

__all__ = [
    "FiniteFields",
    "InterfaceStress",
    "InteriorField",
    "StressRanges",
    "SurfaceTractions",
    "beyond_linear",
    "interface_stresses",
    "interior_field",
    "loss_below",
    "loss_per_distance",
]
