"""Nip impressions: widths at places along the face, as measurements of a case with a face."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from rollnip._errors import InvalidInputError
from rollnip.face import FaceSolution
from rollnip.face.impression import require_on_face
from rollnip.identification.costs import Array, Measurements, entry_of

__all__ = ["Impressions"]


@dataclass(frozen=True, eq=False, kw_only=True)
class Impressions(Measurements):
    """Nip widths [mm] at places along the face, under one or more loads.

    The case must have a face. Unknowns may be any of its numbers: ``upper.shaft.crown``,
    ``face.end_loads[1]``, ``face.bearing_offset``, ``materials.cover.modulus``.

    Parameters
    ----------
    y :
        (n,) places from the middle of the face [mm].
    at, measured, standard_error, weight, name :
        see `Measurements`; widths with the same conditions belong to one face.
    """

    quantity, unit = "nip width", "mm"
    along_face: ClassVar[bool] = True
    y: ArrayLike = field(default_factory=list)
    at: Any = field(default_factory=dict)

    def __post_init__(self) -> None:
        super().__post_init__()
        y = np.atleast_1d(np.asarray(self.y, dtype=float))
        if y.shape != self.values.shape or not np.all(np.isfinite(y)):
            raise InvalidInputError(
                f"`y` must hold one place for each of the {self.values.size} widths, got {y.size}."
            )
        object.__setattr__(self, "y", y)

    @property
    def places(self) -> Array:
        """Places from the middle of the face, (n,) [mm]."""
        return np.asarray(self.y, dtype=float)

    @property
    def conditions(self) -> list[dict[str, Any]]:
        """The changes of the case for each face that has to be solved."""
        return self._faces[0]

    @property
    def abscissa(self) -> tuple[str, Array]:
        """The places."""
        return "y", self.places

    def predict(self, solutions: Sequence[Any]) -> Array:
        """Return the widths (n,) from the faces of ``conditions``.

        Raises
        ------
        InvalidInputError
            where a place lies outside the face.
        """
        faces: Sequence[FaceSolution] = solutions
        require_on_face(self.places, faces[0].face)
        curves = [np.interp(self.places, one.y, one.nip_width) for one in faces]
        return np.asarray(np.array(curves)[self._faces[1], np.arange(self.places.size)])

    @property
    def _faces(self) -> tuple[list[dict[str, Any]], list[int]]:
        """Conditions of each face, and the index of the face of each width."""
        found: list[dict[str, Any]] = []
        which = []
        for index in range(self.values.size):
            row = {path: entry_of(value, index) for path, value in self.at.items()}
            if row not in found:
                found.append(row)
            which.append(found.index(row))
        return found, which
