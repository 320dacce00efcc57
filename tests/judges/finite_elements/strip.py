"""The mesh of a sheet: a straight strip of elements of nine nodes, with two free faces."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from finite_elements.case import Layer, Plate, Roller
from finite_elements.mesh import Array, Grading, Places, Ring, arcs, with_middles

_PLIES = 2  # elements through the thickness of the sheet; twice as many on a rigid roller


@dataclass(frozen=True)
class Strip(Ring):
    """The sheet: rows from the lower face (depth 0) to the upper one; all nodes are free."""

    top: bool = False  # which of the two faces `surface_dofs` are

    @cached_property
    def arc(self) -> Array:
        return with_middles(self.arc_ends)

    @property
    def unknowns(self) -> int:
        return 2 * self.columns * self.rows

    @cached_property
    def dofs(self) -> NDArray[np.int_]:
        return np.arange(self.unknowns).reshape(-1, 2)

    @cached_property
    def surface_dofs(self) -> NDArray[np.int_]:
        return self.dofs.reshape(self.columns, self.rows, 2)[:, -1 if self.top else 0]

    def outline(self, arc: Array) -> tuple[Array, Array, Array, Array]:
        return arc, np.zeros_like(arc), np.ones_like(arc), np.zeros_like(arc)

    @property
    def held(self) -> int:
        """Number of the unknown that says how far the sheet has moved along x."""
        column = int(np.argmin(np.abs(self.arc)))
        return int(self.dofs[column * self.rows + self.rows // 2, 0])


def strip(
    plate: Plate,
    places: tuple[Places, Places],
    grading: Grading,
    rigid: bool,
    like: Strip | None = None,
) -> Strip:
    """Mesh the sheet, graded towards the ends of both contacts.

    On a rigid roller those of the lower contact are ends of elements. With ``like``, an earlier
    mesh of it, the same elements are moved.
    """
    upper, lower = places
    marks = replace(lower, kinks=(upper.trailing, upper.leading))
    size = replace(grading, kink=grading.edge)
    ends, counts = arcs(plate.length / np.pi, marks, size, like.counts if like else None)
    parts = _PLIES if not rigid else 2 * _PLIES
    depth = np.linspace(0.0, plate.thickness, parts + 1)
    layer = Layer(plate.thickness, plate.modulus, plate.poisson)
    return Strip(Roller(np.inf, (layer,)), ends, counts, depth, np.zeros(parts, dtype=int))
