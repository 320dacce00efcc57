"""The model: how a nip is computed (geometry), and how accurately (tolerance)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, get_args

from rollnip._errors import InvalidInputError, require_positive, with_hints

Geometry = Literal["linear", "corrected", "curved", "second", "finite"]
_SYNONYMS: Mapping[object, Geometry] = {"full": "finite"}
"""Names used in cases of earlier versions."""
FINITE: tuple[Geometry, ...] = ("second", "finite")
"""Geometries of finite strain: tractions and displacements refer to the deformed configuration."""
RINGS: tuple[Geometry, ...] = ("curved", *FINITE)
"""Geometries in which layers on rigid cores are rings, not flat strips."""
SIMPLER: Mapping[Geometry, Geometry] = {"finite": "second", "second": "curved"}
"""The simpler geometry that takes the place of one that has no solution."""
BEYOND: Mapping[Geometry, str] = {
    "finite": "terms beyond the linear ones",
    "second": "second-order terms",
}
"""Words for what the geometries of finite strain add to linear elasticity."""

_FINEST = 1e-6
COARSEST = 0.1
"""The coarsest tolerance: a figure with a larger error does not count as known."""


@with_hints(speed="it belongs to the nip: `rn.Nip(..., speed=100)`.")
@dataclass(frozen=True, slots=True, kw_only=True)
class Model:
    """Geometry model and accuracy.

    Parameters
    ----------
    geometry :
        "linear": flat layers and a parabolic gap. "corrected": flat layers and the true distance of
        the deformed surfaces. "curved": layers as rings, stretch to second order. "second": layers
        as rings at finite strain, to second order throughout. "finite", the default: finite strain
        to all orders (docs/geometry.md). It does not cover half-space cores: "second" is solved
        there in its place, and the result says which geometry it is. "full" is accepted for
        "finite".
    tolerance :
        wanted relative accuracy of creepage, nip width, peak pressure, approach or load; between
        1e-6 and 0.1. The error of the model "finite" itself is 0.0003 in approach and load, 0.003
        in peak pressure, 0.001 in nip width and 0.005 in creepage. It counts as within any
        tolerance of 0.001 or more; a finer tolerance cannot be met, and the solution says so. Where
        a surface is stretched far beside a slipping edge the error is larger, and the solution's
        status says by how much. For "second" the error is 0.001 in approach and load, 0.0015 in
        peak pressure, 0.002 in nip width and 0.01 in creepage, and counts in the same way. Where
        the pressure peaks within one layer thickness of the edge of a stiff top layer, the error of
        the peak pressure is 0.02 for "finite", 0.07 with friction, and 0.22 for "second".

    Raises
    ------
    InvalidInputError
        for an unknown geometry, or a tolerance outside its range.
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
