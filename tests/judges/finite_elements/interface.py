"""The interface of two rollers: where they face each other, the forces, gaps and transit times.

Frame: x to the leading edge; every roller has its own y axis into itself, so that the lower one is
seen in a mirror and both are treated alike. The upper roller stands closer by the approach delta.
The ends of its elements carry the pressure p and the shear q (along +x on the upper roller) per
*deformed* length, linear within each element: half as many values as there are columns of nodes,
so that no traction is without a displacement that feels it. With (x', y') the derivative of the
deformed upper surface by its arc s, the force on the upper roller per ds is

    (q x' - p y',  p x' + q y'),

that on the lower one its opposite, at the arc of the lower roller which lies at the same x.

An end that touches has the gap  y_u + y_l - delta = 0  against the deformed lower surface.
Two neighbours stick if both rollers take the same time from one to the other:
(s_l,1 - s_l,0)/V_l = (s_u,1 - s_u,0)/V_u, s_l the arcs of the lower roller at their places.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from finite_elements.mesh import Array, Ring
from finite_elements.solid import quadratics

_GAUSS = np.polynomial.legendre.leggauss(6)


@dataclass(frozen=True)
class Facing:
    """What of the lower roller lies at given abscissae, all of shape (points,).

    ``arc`` s_l, ``height`` y_l, their derivatives by s_l, and the shape functions (and their
    derivatives by s_l) of the surface ``nodes`` there, shape (points, 3).
    """

    arc: Array
    height: Array
    along: Array  # dx/ds
    up: Array  # dy/ds
    nodes: NDArray[np.int_]
    shape: Array
    slope: Array


class Surface(Protocol):
    """The outer surface of a lower roller."""

    @property
    def unknowns(self) -> int: ...

    def facing(self, displacement: Array, x: Array) -> Facing: ...


@dataclass(frozen=True)
class RigidSurface:
    """A bare roller."""

    radius: float

    @property
    def unknowns(self) -> int:
        return 0

    def facing(self, displacement: Array, x: Array) -> Facing:
        angle = np.arcsin(np.clip(x / self.radius, -0.999, 0.999))
        none = np.zeros((x.size, 0))
        return Facing(
            arc=self.radius * angle,
            height=self.radius * (1.0 - np.cos(angle)),
            along=np.cos(angle),
            up=np.sin(angle),
            nodes=none.astype(int),
            shape=none,
            slope=none,
        )


@dataclass(frozen=True)
class CoatedSurface:
    """The deformed outer surface of a ring."""

    ring: Ring

    @property
    def unknowns(self) -> int:
        return self.ring.unknowns

    def at(self, displacement: Array, element: NDArray[np.int_], local: Array) -> Facing:
        """Return the surface at local coordinates in [-1, 1] of its elements."""
        ring = self.ring
        nodes = (2 * element[:, None] + np.arange(3)) % ring.columns
        half = 0.5 * np.diff(ring.arc_ends)[element]
        shape, slope = quadratics(local)
        slope = slope / half[:, None]
        arc = 0.5 * (ring.arc_ends[element] + ring.arc_ends[element + 1]) + half * local
        moved = ring.surface(displacement)[nodes]
        _, height, along, up = ring.outline(arc)
        place = np.einsum("pa,pai->pi", shape, moved)
        rate = np.einsum("pa,pai->pi", slope, moved)
        return Facing(
            arc=arc,
            height=height + place[:, 1],
            along=along + rate[:, 0],
            up=up + rate[:, 1],
            nodes=nodes,
            shape=shape,
            slope=slope,
        )

    def abscissa(self, displacement: Array, facing: Facing) -> Array:
        moved = self.ring.surface(displacement)[facing.nodes][..., 0]
        return self.ring.outline(facing.arc)[0] + np.einsum("pa,pa->p", facing.shape, moved)

    def facing(self, displacement: Array, x: Array) -> Facing:
        """Return the surface at the abscissae: search the element, then Newton within it."""
        ring = self.ring
        ends = ring.arc_ends
        front = np.flatnonzero(np.abs(ends) < 1.2 * ring.roller.radius)
        columns = (2 * front) % ring.columns
        places = ring.outline(ends[front])[0] + ring.surface(displacement)[columns, 0]
        element = front[0] + np.clip(np.searchsorted(places, x) - 1, 0, front.size - 2)
        local = np.zeros_like(x)
        half = 0.5 * np.diff(ends)[element]
        for _ in range(30):
            found = self.at(displacement, element, local)
            step = (x - self.abscissa(displacement, found)) / (found.along * half)
            local = local + step
            if np.max(np.abs(step), initial=0.0) < 1e-13:
                break
        return self.at(displacement, element, local)


@dataclass(frozen=True)
class Points:
    """Quadrature points of the interface; ``element``: the one of the upper roller they lie in."""

    element: NDArray[np.int_]
    hats: Array  # (points, 2): of the element's ends
    weight: Array
    upper: Facing
    x: Array


@dataclass(frozen=True)
class Interface:
    """The facing surfaces of one nip."""

    ring: Ring
    lower: Surface

    @cached_property
    def upper(self) -> CoatedSurface:
        return CoatedSurface(self.ring)

    @property
    def ends(self) -> Array:
        """Arcs of the ends of the upper elements, once round."""
        return self.ring.arc_ends[:-1]

    def points(self, displacement: Array, elements: NDArray[np.int_]) -> Points:
        """Return the points of Gauss of the given elements of the upper roller."""
        at, weight = _GAUSS
        element, local = np.repeat(elements, at.size), np.tile(at, elements.size)
        facing = self.upper.at(displacement, element, local)
        half = 0.5 * np.diff(self.ring.arc_ends)[element]
        return Points(
            element=element,
            hats=np.stack((0.5 * (1.0 - local), 0.5 * (1.0 + local)), axis=-1),
            weight=np.tile(weight, elements.size) * half,
            upper=facing,
            x=self.upper.abscissa(displacement, facing),
        )

    def places(self, displacement: Array) -> tuple[Array, Array]:
        """Return x and y (without approach) of all ends of the upper elements."""
        x, height, _, _ = self.ring.outline(self.ends)
        moved = self.ring.surface(displacement)[::2][: x.size]
        return x + moved[:, 0], height + moved[:, 1]
