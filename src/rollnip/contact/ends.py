"""By how much the end of a zone is misplaced, from the tractions at the nodes beside it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import copysign, inf, sqrt
from typing import TypeVar

from rollnip.contact.problem import Array, ContactState

# Discrete form of the inverse square root that a misplaced end leaves: the change of a square-root
# traction, relative to it, at the first three nodes inside a zone of many cubic elements
# (`subdivided`), per first element by which the zone is too wide. Measured on a parabola pressed on
# a half-plane (tests).
RESPONSE = (-0.6831, -0.1132, -0.0597)

Three = Sequence[float]
_Number = TypeVar("_Number", float, complex)


@dataclass(frozen=True, slots=True)
class ZoneEnd:
    """The end of a zone, seen from inside it, with the tractions of a solution.

    Attributes
    ----------
    x, state : nodes [mm] and a solution.
    node : index of the node at the end.
    inwards : 1 or -1, step of the index into the zone.
    kappa : see `edge_exponents`. The factor (s/s_1)^kappa is taken out of p + i q at the distances
        s_1, s_2, ... of the nodes inside. What is left vanishes at the end as a square root.
    """

    x: Array
    state: ContactState
    node: int
    inwards: int
    kappa: complex = 0j

    @property
    def leads(self) -> bool:
        """Whether it is the leading end of the zone."""
        return self.inwards < 0

    @property
    def place(self) -> float:
        """Place of the end [mm]."""
        return float(self.x.item(self.node))

    def roots(self, apart: int = 1) -> tuple[list[float], list[complex]]:
        """Return the distances of three nodes, and p + i q there over their square roots.

        ``apart``: elements from each of these nodes to the next.
        """
        # Plain numbers: NumPy would be slower for three values.
        beside = [self.node + self.inwards * apart * count for count in (1, 2, 3)]
        distance = [abs(self.x.item(node) - self.place) for node in beside]
        pressure, shear = self.state.pressure, self.state.shear
        tractions = [complex(pressure.item(node), shear.item(node)) for node in beside]
        roots = [t / sqrt(s) for t, s in zip(tractions, distance, strict=True)]
        if self.kappa:
            turned = zip(roots, distance, strict=True)
            roots = [r * (s / distance[0]) ** -self.kappa for r, s in turned]
        return distance, roots

    def move(self, weight: complex, apart: int, *, smooth: bool) -> float:
        """Return how far outwards the end should move, by three nodes; see `outward_move` [mm].

        ``weight`` : of p + i q, of which the real part vanishes at the end.
        """
        distance, roots = self.roots(apart)
        return outward_move(distance, [(weight * root).real for root in roots], smooth=smooth)

    def proposed_move(self, weight: complex, furthest: int) -> float:
        """Return how far outwards the end should move [mm], by nodes near enough to tell.

        Parameters
        ----------
        weight : as for `move`.
        furthest :
            0 at an end with a square root. At a smooth end, the most elements between the nodes
            used: values at the first nodes may be no larger than their errors, and if they propose
            a place beyond their own reach, nodes further inside are tried.
        """
        move, reach, apart = inf, 0.0, 1
        while abs(move) > reach and apart <= max(furthest, 1):
            move = self.move(weight, apart, smooth=furthest > 0)
            reach = abs(self.x.item(self.node + 3 * self.inwards * apart) - self.place)
            apart *= 2
        return move

    def singular_part(self) -> float:
        """Return the inverse square root in the pressure, times the first distance."""
        distance, roots = self.roots()
        misplaced = determinant((1.0, 1.0, 1.0), distance, [root.real for root in roots])
        return misplaced / determinant((1.0, 1.0, 1.0), distance, RESPONSE) * distance[0]


def outward_move(distance: Three, roots: Three, *, smooth: bool) -> float:
    """Return how far outwards the end of a zone should move, from values at three nodes inside it.

    The values, here over the square roots of the distances from the end, are fitted by s, s^3 and a
    third function, s being that square root: the inverse square root of a misplaced end
    (`RESPONSE`), or s^5 at a smooth end. Where the fit does not rise inwards as it should, the
    result is infinite; its sign still tells which way to move.
    """
    third = [d * d for d in distance] if smooth else RESPONSE
    whole = determinant((1.0, 1.0, 1.0), distance, third)
    root = determinant(roots, distance, third)
    if smooth:
        bend = determinant((1.0, 1.0, 1.0), roots, third)
        return root / (1.5 * bend) if bend * whole > 0.0 else copysign(inf, root * whole)
    misplaced = determinant((1.0, 1.0, 1.0), distance, roots)
    if root * whole > 0.0:
        return -misplaced / root * distance[0]
    return copysign(inf, -misplaced * whole)


def root_at(distance: Three, roots: Sequence[complex]) -> complex:
    """Return the factor of the square root at an edge, from `ZoneEnd.roots`."""
    return determinant(roots, distance, RESPONSE) / determinant((1.0, 1.0, 1.0), distance, RESPONSE)


def determinant(a: Sequence[_Number], b: Three, c: Three) -> _Number:
    """Return the determinant of the matrix with these three columns."""
    return (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )
