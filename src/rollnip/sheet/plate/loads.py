"""Piecewise-linear tractions on one interface, and the sheet's response to them at other places."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from rollnip.rolling.surfaces import Mesh
from rollnip.sheet.layer_response import displacements
from rollnip.sheet.local_deformation import pressed_response, sheared_response
from rollnip.sheet.local_stretch import LONG_WAVES, stretch_integral_response
from rollnip.sheet.plate.bending import Plate, exponential_weights
from rollnip.sheets import Sheet

Array = NDArray[np.float64]

_POINTS = np.polynomial.legendre.leggauss(5)
# Gauss points of an interval of length 1, and their weights for the linear functions that are 1 at
# either end: exact for the moments of linear tractions.
_PLACES, _SHARES = 0.5 + 0.5 * _POINTS[0], 0.5 * _POINTS[1]
_OF_ENDS = np.stack([_SHARES * (1.0 - _PLACES), _SHARES * _PLACES])
_ONE_FACE = (0.25, 0.25)  # pressures on one face: half of them equal on both, half opposite
_MOMENTS = 4  # that a sheet without tension needs; one less with a tension that straightens it
_FEEBLE = 33.0  # over the mesh's length: a larger L hardly straightens the sheet within the mesh
_STRETCH = 300.0  # its exponential is far from overflowing
_TERMS = 5  # of the series in 1/L for such tensions; the terms left out are below 1e-10


@dataclass(frozen=True, slots=True)
class PiecewiseLoads:
    """Piecewise-linear tractions in one or more sets, whose effect on the sheet can be evaluated.

    Attributes
    ----------
    sheet, plate : on which they act.
    nodes : (M + 1,) between which they are linear [mm].
    lines : (M + 1, n) nodal values of n sets.
    tail_moments : (moments, M + 1, n) int_x^inf s^k/k! t ds from each node on [mm^(k + 1)].
    """

    sheet: Sheet
    plate: Plate
    nodes: Array
    lines: Array
    tail_moments: Array

    @classmethod
    def on(cls, mesh: Mesh, sheet: Sheet, plate: Plate) -> PiecewiseLoads:
        """Return the unit tractions of all nodes of a mesh."""
        nodes, acting = mesh.fine.nodes, mesh.fine.acting
        assert acting is not None
        lines = np.zeros((nodes.size, mesh.inner.size))
        lines[1:-1] = acting[1:-1, 1:-1]
        return cls.of_lines(nodes, lines, sheet, plate)

    @classmethod
    def of_lines(cls, nodes: Array, lines: Array, sheet: Sheet, plate: Plate) -> PiecewiseLoads:
        """Return tractions given by nodal values, (M + 1, n)."""
        count = _count_of_moments(plate, float(np.ptp(nodes)))
        first, last = _moments(nodes[:-1], np.diff(nodes), count)[..., None]
        tail_moments = np.zeros((count, *lines.shape))
        for moment, one, other in zip(tail_moments, first, last, strict=True):  # fits the cache
            pieces = one * lines[:-1] + other * lines[1:]
            np.cumsum(pieces[::-1], axis=0, out=moment[-2::-1])
        return cls(sheet, plate, nodes, lines, tail_moments)

    def of(self, values: Array) -> PiecewiseLoads:
        """Return tractions for nodal values of the mesh, one set (n,) or s sets (n, s)."""
        sets = values.reshape(values.shape[0], -1)
        return replace(self, lines=self.lines @ sets, tail_moments=self.tail_moments @ sets)

    @property
    def total(self) -> Array:
        """Return int t dx of each set, (n,) [mm]."""
        return np.asarray(self.tail_moments[0, 0])

    @property
    def moment(self) -> Array:
        """Return int x t dx of each set, (n,) [mm^2]."""
        return np.asarray(self.tail_moments[1, 0])

    def forces_beyond(self, x: Array, values: Array) -> Array:
        """Return int t ds from given places on, (m,) [N/mm], for nodal values of the mesh, (n,).

        (s, m) for s sets of values, (n, s).
        """
        line, tails = (self.lines @ values).T, (self.tail_moments[0] @ values).T
        inside, at = self._inside(x)
        length = self.nodes[at + 1] - inside
        share = 0.5 * length / (self.nodes[at + 1] - self.nodes[at])
        means = share * line[..., at] + (1.0 - share) * line[..., at + 1]
        return np.asarray(tails[..., at + 1] + length * means)

    def _inside(self, x: Array) -> tuple[Array, NDArray[np.intp]]:
        """Return the nearest places on the mesh, and the numbers of the nodes before them."""
        inside = np.minimum(np.maximum(x, self.nodes[0]), self.nodes[-1])
        at = self.nodes.searchsorted(inside, side="right") - 1
        return inside, np.minimum(at, self.nodes.size - 2)

    def tail_moments_at(self, x: Array) -> Array:
        """Return the integrals ``tail_moments`` from given places on, (moments, m, n); exact."""
        inside, at = self._inside(x)
        length = self.nodes[at + 1] - inside
        share = length / (self.nodes[at + 1] - self.nodes[at])
        first, last = _moments(inside, length, self.tail_moments.shape[0])
        here, there = self.lines[at], self.lines[at + 1]
        out = self.tail_moments[:, at + 1]
        shares = zip(out, share * first, (1.0 - share) * first + last, strict=True)
        for moment, one, other in shares:
            moment += one[:, None] * here
            moment += other[:, None] * there
        return np.asarray(out)

    def deflection(self, x: Array, tail_moments: Array) -> tuple[Array, Array, Array]:
        """Return the bending of the plate at given places, with the tractions as loads.

        Parameters
        ----------
        x : (m,) places [mm].
        tail_moments : `tail_moments_at` of these places.

        Returns
        -------
        Height of the middle [mm/MPa], rotation of the sections [1/MPa], curvature [1/mm/MPa], each
        (m, n).
        """
        length, yielding = self.plate.length, 0.5 / self.plate.stiffness
        if length > _FEEBLE * float(np.ptp(self.nodes)):
            # odd powers of |x - s|: twice the part ahead, less the signed total
            ahead = 2.0 * tail_moments - self.tail_moments[:, :1]
            height, slope, bend = self._deflection_by_series(x, ahead)
            return height - 0.5 * self.plate.shear * moments_about(x, ahead, 1), slope, bend
        # K is L/(2 D) (x^2/2 - L |x| + L^2 (1 - exp(-|x|/L))), all of it exact; what takes all
        # tractions alike is one product of few terms
        yielding *= length
        by_distance = yielding * length + 0.5 * self.plate.shear
        one, whole = np.ones(x.size), self.tail_moments[:3, 0]
        powers = np.stack([0.5 * x**2 + length**2, -x, one], axis=1) * yielding
        powers[:, :2] += by_distance * np.stack([-x, one], axis=1)
        turns = yielding * np.stack([x - length, -one], axis=1)
        before, after = self._decayed(x)
        far = before + after
        height = powers @ whole - 2.0 * by_distance * moments_about(x, tail_moments, 1)
        height -= yielding * length**2 * far
        slope = 2.0 * tail_moments[0] + before - after
        slope *= yielding * length
        slope += turns @ whole[:2]
        return height, slope, yielding * (whole[0] - far)

    def _deflection_by_series(self, x: Array, ahead: Array) -> tuple[Array, ...]:
        """Return height, rotation and curvature where tension straightens little or nothing.

        K is the sum of (-1)^(k + 1) L^3/(2 D) (|x|/L)^k/k! from k = 3 on; without tension only its
        first term is left. Even powers are polynomials. So are odd ones on either side of x, with
        opposite signs: they take ``ahead``, the moments ahead of x less those behind.
        """
        count = self.tail_moments.shape[0]
        powers = np.arange(3, 4 + count - _MOMENTS)
        factors = np.zeros((2, 2 * count + 1))  # of odd and of even powers
        share = (-1.0 / self.plate.length) ** (powers - 3)
        factors[1 - powers % 2, powers] = 0.5 / self.plate.stiffness * share
        terms, places = _taylor_terms(-x, count), np.add.outer(np.arange(count), np.arange(count))
        out = []
        for order in range(3):
            # (s - x)^k/k! is the sum of (-x)^i/i! s^j/j! with i + j = k
            odd, even = factors[:, places + order] @ terms
            made = np.einsum("km,kmn->mn", odd, ahead)
            if powers.size > 1:
                made += even.T @ self.tail_moments[:, 0]
            out.append(-made if order == 1 else made)
        return tuple(out)

    def _decayed(self, x: Array) -> tuple[Array, Array]:
        """Return int exp(-|x - s|/L) t ds behind and ahead of given places, each (m, n)."""
        nodes, lines, length = self.nodes, self.lines, self.plate.length
        inside, at = self._inside(x)
        left, right = inside - nodes[at], nodes[at + 1] - inside
        pieces = np.zeros((2, *lines.shape))
        near, far = exponential_weights(nodes[1:] - nodes[:-1], length)[..., None]
        pieces[0, 1:] = far * lines[:-1] + near * lines[1:]
        pieces[1, :-1] = near * lines[:-1] + far * lines[1:]
        behind = _decaying_sums(pieces[0], (nodes - nodes[0]) / length)
        ahead = _decaying_sums(pieces[1, ::-1], (nodes[-1] - nodes[::-1]) / length)[::-1]
        share = (left / (left + right))[:, None]
        here = (1.0 - share) * lines[at] + share * lines[at + 1]
        outside = np.exp(-np.abs(x - inside) / length)
        out: list[Array] = []
        for way, end, total in ((left, at, behind), (right, at + 1, ahead)):
            near, far = (outside * exponential_weights(way, length))[..., None]
            passed = (outside * np.exp(-way / length))[:, None] * total[end]
            out.append(passed + near * here + far * lines[end])
        return out[0], out[1]

    def face_displacements(
        self, x: Array, far: NDArray[np.bool_], tail_moments: Array
    ) -> tuple[Array, Array, Array]:
        """Return the displacements of a face by the tractions, each (m, n).

        Towards the middle by pressures [mm/MPa]; tangential by shears, without tension and bending,
        with the sign of the shear on the roller at that face [mm/MPa]; and int g t ds from given
        places on, where g t is the stretch of the face by pressures t without bending [mm], see
        `rollnip.sheet.local_stretch`.

        Parameters
        ----------
        x : (m,) places [mm].
        far : where the face is the one opposite to the tractions, otherwise it is under them.
        tail_moments : `tail_moments_at` of the places.
        """
        responses = pressed_response(_ONE_FACE), sheared_response(), stretch_integral_response()
        sheet = self.sheet
        indented, shifted, short = displacements(
            responses, sheet.thickness, x, self.nodes, self.lines, far
        )
        less = 0.5 * sheet.sheared / sheet.thickness
        near = sheet.stretch_by_pressure - less * (LONG_WAVES[0] + LONG_WAVES[1])
        long = np.where(far, -less * (LONG_WAVES[0] - LONG_WAVES[1]), near)
        stretched = long[:, None] * tail_moments[0] - sheet.sheared * short
        return sheet.squeeze * indented, sheet.sheared * shifted, stretched


def _count_of_moments(plate: Plate, length: float) -> int:
    """Return how many moments the bending under tractions on a mesh of this length needs."""
    if plate.length <= _FEEBLE * length:
        return _MOMENTS - 1
    return _MOMENTS + _TERMS - 1 if plate.tension > 0.0 else _MOMENTS


def _decaying_sums(pieces: Array, places: Array) -> Array:
    """Return int exp(s - x) t ds up to given places, (m, n), from pieces up to each of them.

    They are cumulative sums of exp(s) t, which keep their accuracy as exp(s) grows, but overflow:
    each stretch of ``places`` has its own origin. Changes ``pieces``.
    """
    stretches = places // _STRETCH
    starts = (stretches[1:] > stretches[:-1]).nonzero()[0] + 1
    for first, last in pairwise([0, *starts.tolist(), places.size]):
        if first > 0:
            pieces[first] += np.exp(places[first - 1] - places[first]) * pieces[first - 1]
        grown, some = np.exp(places[first:last] - places[first])[:, None], pieces[first:last]
        some *= grown
        np.cumsum(some, axis=0, out=some)
        some /= grown
    return pieces


def moments_about(x: Array, moments: Array, order: int) -> Array:
    """Return int (s - x)^k/k! t ds, (m, n), from the moments int s^j/j! t ds.

    k is the ``order``; moments up to that order are used.
    """
    out, back = moments[order], -x[:, None]
    power = np.ones(back.shape)
    for k in range(order - 1, -1, -1):
        power = power * back / (order - k)
        out = out + power * moments[k]
    return np.asarray(out)


def _taylor_terms(values: Array, count: int) -> Array:
    """Return v^k/k!, k < ``count``, (count, m)."""
    terms = np.ones((count, values.size))
    for k in range(1, count):
        np.multiply(terms[k - 1], values / k, out=terms[k])
    return terms


def _moments(starts: Array, lengths: Array, count: int) -> Array:
    """Return int s^k/k! t ds, k < ``count``, over intervals per end value of a linear t.

    (2, count, m).
    """
    s = starts + _PLACES[:, None] * lengths
    powers = _taylor_terms(s.ravel(), count).reshape(count, *s.shape)
    return np.asarray(np.moveaxis(_OF_ENDS @ powers, 1, 0) * lengths)
