"""Coverings pressed in far: what a result of small strains then says of itself."""

from __future__ import annotations

from rollnip.no_nip import MOST_PRESSED_IN
from rollnip.reservation import Reservation
from rollnip.rollers import Roller

_DEEP = 0.15  # approach over the thickness of the coverings, above which there is a reservation


def too_deep(upper: Roller, lower: Roller, approach: float) -> str:
    """Return the sentence on coverings that are pressed in too far; "" where they are not.

    Parameters
    ----------
    upper, lower : both rollers.
    approach : of the axles [mm].
    """
    thickness = _covering(upper, lower)
    if thickness == 0.0 or approach < MOST_PRESSED_IN * thickness:
        return ""
    return (
        f"The coverings, {thickness:g} mm thick, are pressed in by "
        f"{100.0 * approach / thickness:.0f} % of that; beyond {100.0 * MOST_PRESSED_IN:.0f} % "
        "small strain does not hold. Lower the load or the approach, or take a thicker or harder "
        "covering."
    )


def deep_patch(upper: Roller, lower: Roller, approach: float) -> Reservation | None:
    """Return the reservation on deeply indented coverings; None within the limit.

    Parameters are those of `too_deep`.
    """
    thickness = _covering(upper, lower)
    if thickness == 0.0 or approach <= _DEEP * thickness:
        return None
    return Reservation(
        "deep_patch",
        "The approach is more than {limit:g} % of the coverings' thickness; strains count as "
        "small, and approach and load are then off by more than 5 %.",
        {"limit": 100.0 * _DEEP},
        excess=approach / (_DEEP * thickness),
    )


def _covering(upper: Roller, lower: Roller) -> float:
    """Return the thickness of both coverings [mm]; 0 where a core gives way as well."""
    if upper.core is not None or lower.core is not None:
        return 0.0
    return upper.coating_thickness + lower.coating_thickness
