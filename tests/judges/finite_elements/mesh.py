"""Graded meshes of closed rings: quadratic elements of nine nodes in arc and depth.

A point of a covering is named by the arc s along the undeformed outer surface (0 below the axle)
and the depth z. Its undeformed place, in a frame whose y axis points from the contact into the
roller, is exactly  X = (r sin(s/R), R - r cos(s/R)),  r = R - z: the geometry is not interpolated.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from finite_elements.case import Roller

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Grading:
    """Sizes of elements in units of the half-width; growth per unit of distance.

    ``edge`` at the ends of the contact, ``kink`` where slip begins, ``inside`` at most within the
    contact, ``surface`` the height of the uppermost elements, ``plies`` at least so many
    elements through each layer.
    """

    edge: float = 0.01
    kink: float = 0.03
    inside: float = 0.08
    surface: float = 0.02
    growth: float = 0.25
    growth_depth: float = 0.35
    plies: int = 2

    def refined(self, factor: float) -> Grading:
        """Return the same grading with all elements smaller by a factor."""
        return Grading(
            self.edge / factor,
            self.kink / factor,
            self.inside / factor,
            self.surface / factor,
            self.growth / factor,
            self.growth_depth / factor,
            max(2, round(self.plies * factor)),
        )


def _spaced(size: Array, at: Array, parts: int | None = None) -> Array:
    """Divide [at[0], at[-1]] into elements as long as ``size`` says (tabulated on ``at``)."""
    count = np.concatenate(([0.0], np.cumsum(np.diff(at) * 0.5 * (1 / size[1:] + 1 / size[:-1]))))
    number = parts or max(1, int(np.ceil(count[-1])))
    return np.interp(np.linspace(0.0, count[-1], number + 1), count, at)


@dataclass(frozen=True)
class Places:
    """Arcs that the mesh is graded towards: both ends of the contact, and kinks between them."""

    trailing: float
    leading: float
    kinks: tuple[float, ...] = ()

    @property
    def half_width(self) -> float:
        return 0.5 * (self.leading - self.trailing)


def arcs(
    radius: float, places: Places, grading: Grading, counts: tuple[int, ...] | None = None
) -> tuple[Array, tuple[int, ...]]:
    """Ends of the elements along the closed circumference, and their number per stretch.

    Both ends of the contact are ends of elements. With ``counts`` as an earlier mesh had them, the
    same elements are moved with the contact.
    """
    end, half = np.pi * radius, places.half_width
    near = half * np.geomspace(1e-5, 2.0 * end / half, 2500)
    marks = np.array([places.trailing, places.leading, *places.kinks])
    bounds = (-end, places.trailing, places.leading, end)
    every = np.unique(np.concatenate([m + sign * near for m in marks for sign in (-1.0, 1.0)]))
    sections = []
    for number, (low, high) in enumerate(pairwise(bounds)):
        at = np.concatenate(([low], every[(every > low) & (every < high)], [high]))
        ends = np.min(np.abs(at[:, None] - marks[None, :2]), axis=1)
        size = half * grading.edge + grading.growth * ends
        for kink in places.kinks:
            size = np.minimum(size, half * grading.kink + grading.growth * np.abs(at - kink))
        size = np.minimum(size, half * grading.inside if number == 1 else 0.3 * radius)
        sections.append(_spaced(size, at, counts[number] if counts else None))
    joined = np.concatenate((sections[0], sections[1][1:], sections[2][1:]))
    return joined, tuple(section.size - 1 for section in sections)


def depths(roller: Roller, half_width: float, grading: Grading) -> tuple[Array, NDArray[np.int_]]:
    """Ends of the elements over the depth, and the layer that each element belongs to."""
    ends, layer_of, top = [0.0], [], 0.0
    for number, layer in enumerate(roller.layers):
        at = np.linspace(top, top + layer.thickness, 2001)
        parts = _spaced(half_width * grading.surface + grading.growth_depth * at, at)
        if parts.size - 1 < grading.plies:
            parts = np.linspace(at[0], at[-1], grading.plies + 1)
        ends.extend(parts[1:])
        layer_of.extend([number] * (parts.size - 1))
        top = at[-1]
    return np.array(ends), np.array(layer_of)


def with_middles(ends: Array) -> Array:
    out = np.empty(2 * ends.size - 1)
    out[::2] = ends
    out[1::2] = 0.5 * (ends[1:] + ends[:-1])
    return out


@dataclass(frozen=True)
class Ring:
    """A covering, meshed. Node (column, row) has the number column*rows + row; row 0 is outside.

    Columns go round: the last element ends at the first column again. The nodes of the last row
    are bonded to the core and have no unknowns.
    """

    roller: Roller
    arc_ends: Array
    counts: tuple[int, ...]
    depth_ends: Array
    layer_of: NDArray[np.int_]

    @cached_property
    def arc(self) -> Array:
        """Arc of every column of nodes."""
        return with_middles(self.arc_ends)[:-1]

    @cached_property
    def depth(self) -> Array:
        """Depth of every row of nodes."""
        return with_middles(self.depth_ends)

    @property
    def columns(self) -> int:
        return int(self.arc.size)

    @property
    def rows(self) -> int:
        return int(self.depth.size)

    @property
    def unknowns(self) -> int:
        return 2 * self.columns * (self.rows - 1)

    @cached_property
    def nodes(self) -> NDArray[np.int_]:
        """Nodes of every element, shape (elements, 9), arc counted slower than depth."""
        along, down = np.meshgrid(
            np.arange(self.arc_ends.size - 1), np.arange(self.layer_of.size), indexing="ij"
        )
        columns = (
            2 * along.ravel()[:, None] + np.array([0, 0, 0, 1, 1, 1, 2, 2, 2])
        ) % self.columns
        rows = 2 * down.ravel()[:, None] + np.array([0, 1, 2, 0, 1, 2, 0, 1, 2])
        return columns * self.rows + rows

    @cached_property
    def dofs(self) -> NDArray[np.int_]:
        """Number of the unknown of every node and direction, -1 at the core; (nodes, 2)."""
        out = np.full((self.columns, self.rows, 2), -1)
        out[:, :-1] = np.arange(self.unknowns).reshape(self.columns, self.rows - 1, 2)
        return out.reshape(-1, 2)

    @cached_property
    def surface_dofs(self) -> NDArray[np.int_]:
        """Unknowns of the outer surface, shape (columns, 2)."""
        return self.dofs.reshape(self.columns, self.rows, 2)[:, 0]

    def outline(self, arc: Array) -> tuple[Array, Array, Array, Array]:
        """Undeformed outer surface: x and height, and their derivatives by the arc."""
        radius = self.roller.radius
        along, up = np.cos(arc / radius), np.sin(arc / radius)
        return radius * up, radius * (1.0 - along), along, up

    def surface(self, displacement: Array) -> Array:
        """Displacement of the columns of the outer surface, shape (columns, 2)."""
        return displacement[self.surface_dofs]


def ring(
    roller: Roller,
    places: Places,
    grading: Grading,
    like: Ring | None = None,
) -> Ring:
    """Mesh a covering, graded towards its surface and the given places.

    With ``like``, an earlier mesh of it, the same elements are moved.
    """
    ends, counts = arcs(roller.radius, places, grading, like.counts if like else None)
    down = (like.depth_ends, like.layer_of) if like else depths(roller, places.half_width, grading)
    return Ring(roller, ends, counts, *down)
