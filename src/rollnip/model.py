"""How a nip is computed: the geometry model and the accuracy wanted."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, get_args

from rollnip._errors import InvalidInputError, require_positive, with_hints

Geometry = Literal["linear", "corrected", "curved", "second", "finite"]
_SYNONYMS: Mapping[object, Geometry] = {"full": "finite"}
"""Names that cases of earlier versions hold."""
FINITE: tuple[Geometry, ...] = ("second", "finite")
"""Geometries of finite strain: tractions and displacements belong to present places."""
RINGS: tuple[Geometry, ...] = ("curved", *FINITE)
"""Geometries that bend the layers to rings."""
SIMPLER: Mapping[Geometry, Geometry] = {"finite": "second", "second": "curved"}
"""The geometry that is solved where there is no solution of another one."""
BEYOND: Mapping[Geometry, str] = {
    "finite": "terms beyond the linear ones",
    "second": "second-order terms",
}
"""Words for what geometries of finite strain add to linear elasticity."""

_FINEST = 1e-6
COARSEST = 0.1
"""The coarsest tolerance; no figure counts as known whose error is larger."""


@with_hints(speed="it belongs to the nip: `rn.Nip(..., speed=100)`.")
@dataclass(frozen=True, slots=True, kw_only=True)
class Model:
    """Geometry model and accuracy.

    Parameters
    ----------
    geometry :
        "linear": flat layers, parabolic gap. "corrected": flat layers, true distance of the
        deformed surfaces. "curved": ring layers and stretch to second order. "second": ring
        layers at finite strain, to second order throughout. "finite", the default: finite strain
        of all orders (docs/geometry.md). On half-space cores there is none of all orders: "second"
        is solved there in place of "finite", and a result says which it is.
        "full" is another word for "finite".
    tolerance :
        wanted relative accuracy of creepage, nip width, peak pressure, approach or load; between
        1e-6 and 0.1. "finite" gives approach and load to 0.0003, the peak pressure to 0.003, the
        nip width to 0.001 and the creepage to 0.005, which counts as met by a tolerance of 0.001 or
        more; a finer one it cannot meet, and the solution says so. Where a surface is stretched far
        beside a slipping edge it is less accurate, by what the solution's status says. "second"
        gives approach and load to 0.001, the peak pressure to 0.0015, the nip width to 0.002 and
        the creepage to 0.01, which counts in the same way. Where the pressure peaks beside the
        edge of a stiff top layer, nearer than that layer is thick, "finite" gives the peak to 0.02,
        with friction to 0.07, and "second" to 0.15.

    Raises
    ------
    InvalidInputError
        for another geometry or a tolerance outside its range.
    """

    geometry: Geometry = "finite"
    tolerance: float = 1e-3

    def __post_init__(self) -> None:
        if isinstance(self.geometry, str):
            object.__setattr__(self, "geometry", _SYNONYMS.get(self.geometry, self.geometry))
        if not isinstance(self.geometry, str) or self.geometry not in get_args(Geometry):
            known = ", ".join(f'"{name}"' for name in get_args(Geometry))
            raise InvalidInputError(f"`geometry` must be one of {known}, got {self.geometry!r}.")
        object.__setattr__(self, "tolerance", require_positive("tolerance", self.tolerance))
        if not _FINEST <= self.tolerance <= COARSEST:
            raise InvalidInputError(
                f"`tolerance` must lie between {_FINEST:g} and {COARSEST:g}, "
                f"got {self.tolerance!r}."
            )
