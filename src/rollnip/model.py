"""How a nip is computed: the geometry model and the accuracy wanted."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

from rollnip._errors import InvalidInputError, require_positive, with_hints

Geometry = Literal["linear", "corrected", "curved", "finite", "full"]
FINITE: tuple[Geometry, ...] = ("finite", "full")
"""Geometries of finite strain: tractions and displacements belong to present places."""
RINGS: tuple[Geometry, ...] = ("curved", *FINITE)
"""Geometries that bend the layers to rings."""

_FINEST = 1e-6
_COARSEST = 0.1


@with_hints(speed="it belongs to the nip: `rn.Nip(..., speed=100)`.")
@dataclass(frozen=True, slots=True, kw_only=True)
class Model:
    """Geometry model and accuracy.

    Parameters
    ----------
    geometry :
        "linear": flat layers, parabolic gap. "corrected": flat layers, true distance of the
        deformed surfaces. "curved": ring layers and stretch to second order. "finite": ring
        layers of finite strain, to second order throughout. "full": finite strain of all orders,
        for layers on rigid cores (docs/geometry.md).
    tolerance :
        wanted relative accuracy of creepage, nip width, peak pressure, approach or load; between
        1e-6 and 0.1. "finite" gives approach and load to 0.001, the peak pressure to 0.0015, the
        nip width to 0.002 and the creepage to 0.01, which counts as met by a tolerance of 0.001 or
        more; a finer one it cannot meet, and the solution says so. "full" gives approach and load
        to 0.0003, the peak pressure to 0.003, the nip width to 0.001 and the creepage to 0.005,
        which counts likewise; where a surface is stretched far beside a slipping edge less well, by
        what the solution's status says.

    Raises
    ------
    InvalidInputError
        for another geometry or a tolerance outside its range.
    """

    geometry: Geometry = "finite"
    tolerance: float = 1e-3

    def __post_init__(self) -> None:
        if self.geometry not in get_args(Geometry):
            known = ", ".join(f'"{name}"' for name in get_args(Geometry))
            raise InvalidInputError(f"`geometry` must be one of {known}, got {self.geometry!r}.")
        object.__setattr__(self, "tolerance", require_positive("tolerance", self.tolerance))
        if not _FINEST <= self.tolerance <= _COARSEST:
            raise InvalidInputError(
                f"`tolerance` must lie between {_FINEST:g} and {_COARSEST:g}, "
                f"got {self.tolerance!r}."
            )
