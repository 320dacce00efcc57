"""One result as a function of one parameter: samples, brackets, crossings; numbers only."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from math import exp, log
from typing import Any

from scipy.optimize import brentq, minimize_scalar

_GEOMETRIC = 10.0  # ratio of positive limits from which the interval is divided by ratios
_SHARPEST = 1e-6  # share of the interval; a change over a shorter distance is a jump
_MOST_STEPS = 60
_TURN_STEPS = 8
_REACH_STEPS = 6


@dataclass(frozen=True, slots=True)
class Point:
    """One case: the parameter, the result (None if not solved), all results, and the message."""

    x: float
    y: float | None
    row: Mapping[str, Any]
    message: str


@dataclass(frozen=True, slots=True)
class Jump:
    """Two neighbouring cases whose results lie on either side of the wanted value."""

    left: Point
    right: Point


class _Stopped(Exception):
    """A case was not solved, or what was looked for has been found."""


class Curve:
    """The result as a function of the parameter between two limits; each case is solved once.

    Parameters
    ----------
    solve : function that returns the case at a parameter.
    low, high : limits of the parameter, low < high.
    """

    def __init__(self, solve: Callable[[float], Point], low: float, high: float) -> None:
        self._solve = solve
        self._low, self._high = low, high
        self._is_geometric = low > 0.0 and high >= _GEOMETRIC * low
        self._points: dict[float, Point] = {}  # keys: share of the interval, 0 to 1

    @property
    def points(self) -> tuple[Point, ...]:
        """All cases so far, in the order of the parameter."""
        return tuple(self._points[share] for share in sorted(self._points))

    @property
    def solved(self) -> tuple[Point, ...]:
        """The cases that were solved, in the order of the parameter."""
        return tuple(point for point in self.points if point.y is not None)

    def scan(self, count: int) -> None:
        """Solve ``count`` cases from limit to limit."""
        for index in range(count):
            self._at(index / (count - 1))

    def turn(self, wanted: float) -> None:
        """Follow inner extremes towards the wanted value until it is crossed, or to their end.

        This finds two crossings between neighbouring samples where the samples show the bend.
        """
        points = self.solved
        for left, middle, right in zip(points, points[1:], points[2:], strict=False):
            near, here, far = (_off(point, wanted) for point in (left, middle, right))
            sign = 1.0 if here > 0.0 else -1.0
            if 0.0 < sign * here <= min(sign * near, sign * far):
                self._descend(left, right, wanted, sign)

    def reach(self, wanted: float) -> None:
        """Approach neighbours that were not solved from solved cases, to pass the wanted value.

        It bisects, and finds a solution that lies next to cases that cannot be solved.
        """
        for left, right in pairwise(self.points):
            if (left.y is None) == (right.y is None):
                continue
            good, bad = (left, right) if right.y is None else (right, left)
            sign = _off(good, wanted)
            for _ in range(_REACH_STEPS):
                middle = self._at(0.5 * (self._share(good) + self._share(bad)))
                if middle.y is None:
                    bad = middle
                    continue
                good = middle
                if sign * _off(good, wanted) <= 0.0:
                    return

    def crossings(self, wanted: float, near: float) -> tuple[tuple[Point, ...], tuple[Jump, ...]]:
        """Return the cases whose result is ``wanted`` within ``near``, and the jumps across it.

        Both are ordered by the parameter.
        """
        points, found, jumps = self.solved, [], []
        for left, right in pairwise(points):
            a, b = _off(left, wanted), _off(right, wanted)
            if abs(a) <= near:
                found.append(left)
            elif abs(b) > near and a * b < 0.0:
                root = self._root(left, right, wanted, near)
                if isinstance(root, Jump):
                    jumps.append(root)
                elif root is not None:
                    found.append(root)
        if points and abs(_off(points[-1], wanted)) <= near:
            found.append(points[-1])
        return tuple(found), tuple(jumps)

    def _root(self, left: Point, right: Point, wanted: float, near: float) -> Point | Jump | None:
        """Return the crossing by Brent's method; None where a case on the way was not solved."""

        def off(share: float) -> float:
            distance = self._off_at(share, wanted)
            return 0.0 if abs(distance) <= near else distance

        try:
            brentq(off, self._share(left), self._share(right), xtol=_SHARPEST, maxiter=_MOST_STEPS)
        except _Stopped:
            return None
        inner = [point for point in self.solved if left.x <= point.x <= right.x]
        best = min(inner, key=lambda point: abs(_off(point, wanted)))
        if abs(_off(best, wanted)) <= near:
            return best
        pairs = pairwise(inner)
        return next(Jump(a, b) for a, b in pairs if _off(a, wanted) * _off(b, wanted) < 0.0)

    def _descend(self, left: Point, right: Point, wanted: float, sign: float) -> None:
        def off(share: float) -> float:
            distance = sign * self._off_at(share, wanted)
            if distance <= 0.0:
                raise _Stopped
            return distance

        try:
            minimize_scalar(
                off,
                bounds=(self._share(left), self._share(right)),
                method="bounded",
                options={"maxiter": _TURN_STEPS},
            )
        except _Stopped:
            return

    def _at(self, share: float) -> Point:
        if share not in self._points:
            self._points[share] = self._solve(self._place(share))
        return self._points[share]

    def _off_at(self, share: float, wanted: float) -> float:
        point = self._at(share)
        if point.y is None:
            raise _Stopped
        return point.y - wanted

    def _place(self, share: float) -> float:
        """Return the parameter at a share, 0 to 1, of the interval."""
        if share in (0.0, 1.0):
            return self._high if share else self._low
        if self._is_geometric:
            return exp(log(self._low) + share * log(self._high / self._low))
        return self._low + share * (self._high - self._low)

    def _share(self, point: Point) -> float:
        return next(share for share, one in self._points.items() if one is point)


def slope_at(points: tuple[Point, ...], at: Point, noise: float) -> float | None:
    """Return the derivative at ``at``, of the parabola through it and a neighbour on either side.

    The neighbour is the nearest case whose result differs by more than ``noise``. With one
    neighbour it is the secant; with none, or where the derivative is 0, it is None.
    """
    secants, gaps = [], []
    for side in (-1.0, 1.0):
        others = [p for p in points if side * (p.x - at.x) > 0.0 and _far(p, at, noise)]
        if others:
            other = min(others, key=lambda p: abs(p.x - at.x))
            secants.append(_off(other, at.y or 0.0) / (other.x - at.x))
            gaps.append(abs(other.x - at.x))
    if not secants:
        return None
    if len(secants) == 1:
        return secants[0]
    return (secants[0] * gaps[1] + secants[1] * gaps[0]) / sum(gaps) or None


def _far(point: Point, at: Point, noise: float) -> bool:
    return point.y is not None and at.y is not None and abs(point.y - at.y) > noise


def _off(point: Point, wanted: float) -> float:
    assert point.y is not None
    return point.y - wanted
