"""Piecewise-linear tractions on one interface, and the sheet's response to them at other places."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import sqrt

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lapack

from rollnip.rolling.surfaces import Mesh
from rollnip.sheet.local_deformation import face_shift, thickness_loss
from rollnip.sheet.local_stretch import LONG_WAVES, stretch_integral
from rollnip.sheet.plate.bending import Plate, exponential_weights
from rollnip.sheets import Sheet

Array = NDArray[np.float64]

_GAUSS = 0.5 - sqrt(1.0 / 12.0), 0.5 + sqrt(1.0 / 12.0)  # Gauss points of an interval of length 1
# Three Gauss points of an interval of length 1, and their weights for the linear functions that are
# 1 at either end: exact for the moments of linear tractions.
_PLACES, _SHARES = 0.5 + sqrt(0.15) * np.array([-1.0, 0.0, 1.0]), np.array([5.0, 8.0, 5.0]) / 18.0
_OF_ENDS = np.stack([_SHARES * (1.0 - _PLACES), _SHARES * _PLACES])
_FEEBLE = 33.0  # over the mesh's length: a larger L hardly straightens the sheet within the mesh


@dataclass(frozen=True, slots=True)
class PiecewiseLoads:
    """Piecewise-linear tractions in one or more sets, whose effect on the sheet can be evaluated.

    Attributes
    ----------
    sheet, plate : on which they act.
    nodes : (M + 1,) between which they are linear [mm].
    lines : (M + 1, n) nodal values of n sets.
    tail_moments : (4, M + 1, n) int_x^inf s^k/k! t ds from each node to infinity [mm^(k + 1)].
    """

    sheet: Sheet
    plate: Plate
    nodes: Array
    lines: Array
    tail_moments: Array

    @classmethod
    def on(
        cls, mesh: Mesh, sheet: Sheet, plate: Plate, along: Array | None = None
    ) -> PiecewiseLoads:
        """Return the unit tractions of all nodes of a mesh.

        ``along``: factors at its fine nodes, such as ds/dx; None: all 1.
        """
        nodes, acting = mesh.fine.nodes, mesh.fine.acting
        assert acting is not None
        lines = np.zeros((nodes.size, mesh.inner.size))
        lines[1:-1] = acting[1:-1, 1:-1]
        lines = lines if along is None else lines * along[:, None]
        return cls.of_lines(nodes, lines, sheet, plate)

    @classmethod
    def of_lines(cls, nodes: Array, lines: Array, sheet: Sheet, plate: Plate) -> PiecewiseLoads:
        """Return tractions given by nodal values, (M + 1, n)."""
        first, last = _moments(nodes[:-1], np.diff(nodes))[..., None]
        pieces = first * lines[:-1] + last * lines[1:]
        tail_moments = np.zeros((4, *lines.shape))
        np.cumsum(pieces[:, ::-1], axis=1, out=tail_moments[:, -2::-1])
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

    def tail_moments_at(self, x: Array) -> Array:
        """Return the integrals ``tail_moments`` from given places on, (4, m, n); exact."""
        inside = np.clip(x, self.nodes[0], self.nodes[-1])
        at = np.clip(np.searchsorted(self.nodes, inside, side="right") - 1, 0, self.nodes.size - 2)
        length = self.nodes[at + 1] - inside
        share = length / (self.nodes[at + 1] - self.nodes[at])
        first, last = _moments(inside, length)
        out = (first * share)[..., None] * self.lines[at]
        out += (first * (1.0 - share) + last)[..., None] * self.lines[at + 1]
        return np.asarray(out + self.tail_moments[:, at + 1])

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
        # |x - s|^3/6 and its derivatives: twice the part ahead, less the signed total
        whole = self.tail_moments[:, :1]
        ahead = 2.0 * tail_moments - whole
        distances = moments_about(x, ahead, 1)
        sheared = -0.5 * self.plate.shear * distances
        length, yielding = self.plate.length, 0.5 / self.plate.stiffness
        if length > _FEEBLE * float(np.ptp(self.nodes)):
            height = yielding * moments_about(x, ahead, 3) + sheared
            slope, bend = -yielding * moments_about(x, ahead, 2), yielding * distances
            if self.plate.tension > 0.0:
                places, forces = self._points
                less = self.plate.reduction_by_tension(x[:, None] - places)
                height, slope, bend = (
                    out - one @ forces for out, one in zip((height, slope, bend), less, strict=True)
                )
            return height, slope, bend
        # K is L/(2 D) (x^2/2 - L |x| + L^2 (1 - exp(-|x|/L))), all of it exact
        before, after = self._decayed(x)
        yielding *= length
        near = whole[0] - before - after
        height = moments_about(x, whole, 2) - length * distances + length**2 * near
        slope = -moments_about(x, whole, 1) + length * (ahead[0] + before - after)
        return yielding * height + sheared, yielding * slope, yielding * near

    def _decayed(self, x: Array) -> tuple[Array, Array]:
        """Return int exp(-|x - s|/L) t ds behind and ahead of given places, each (m, n)."""
        nodes, lines, length = self.nodes, self.lines, self.plate.length
        inside = np.clip(x, nodes[0], nodes[-1])
        at = np.clip(np.searchsorted(nodes, inside, side="right") - 1, 0, nodes.size - 2)
        left, right = inside - nodes[at], nodes[at + 1] - inside
        lengths = np.concatenate([np.diff(nodes), left, right])
        ends = nodes.size - 1, nodes.size - 1 + x.size
        near, far = (np.split(one[:, None], ends) for one in exponential_weights(lengths, length))
        decays = np.split(np.exp(-lengths / length)[:, None], ends)
        pieces = np.zeros((2, *lines.shape))
        pieces[0, 1:] = far[0] * lines[:-1] + near[0] * lines[1:]
        pieces[1, :-1] = near[0] * lines[:-1] + far[0] * lines[1:]
        less, none, one = -decays[0][:, 0], np.zeros(nodes.size - 1), np.ones(nodes.size)
        behind = lapack.dgtsv(less, one, none, pieces[0])[3]
        ahead = lapack.dgtsv(none, one, less, pieces[1])[3]
        share = (left / (left + right))[:, None]
        here = (1.0 - share) * lines[at] + share * lines[at + 1]
        outside = np.exp(-np.abs(x - inside) / length)[:, None]
        out = []
        for way, end, total in ((1, at, behind), (2, at + 1, ahead)):
            passed = decays[way] * total[end] + near[way] * here + far[way] * lines[end]
            out.append(outside * passed)
        return out[0], out[1]

    def face_indentation(self, x: Array, far: NDArray[np.bool_]) -> Array:
        """Return the displacement of a face towards the middle under pressures, (m, n) [mm/MPa].

        ``far``: where it is the face opposite to that under the pressures, otherwise that face
        itself.
        """
        nodes, lines = self.nodes, self.lines[1:-1]
        return thickness_loss(self.sheet, x, nodes, lines, (0.25, 0.25), opposite=far)

    def face_shift(self, x: Array, far: NDArray[np.bool_]) -> Array:
        """Return the tangential displacement of a face under shears, (m, n) [mm/MPa].

        It excludes the displacement due to tension and bending. ``far``: see `face_indentation`.
        """
        return face_shift(self.sheet, x, self.nodes, self.lines[1:-1], far)

    def stretch_integral(self, x: Array, far: NDArray[np.bool_], tail_moments: Array) -> Array:
        """Return int g t ds from given places on, (m, n) [mm]; see `rollnip.sheet.local_stretch`.

        g t is the stretch of the face under pressures t, without bending; ``tail_moments``:
        `tail_moments_at` of the places; ``far``: see `face_indentation`.
        """
        sheet, alike = self.sheet, np.where(far, 0.0, self.sheet.stretch_by_pressure)
        signs = np.where(far, -1.0, 1.0)
        less = sheet.sheared / sheet.thickness
        long = alike - 0.5 * less * (LONG_WAVES[0] + signs * LONG_WAVES[1])
        short = stretch_integral(sheet.thickness, x, self.nodes, self.lines, far)
        return np.asarray(long[:, None] * tail_moments[0] - less * short)

    @property
    def _points(self) -> tuple[Array, Array]:
        """Return Gauss points (2 M,) [mm], and the tractions there times their weights (2 M, n)."""
        length, lines = np.diff(self.nodes), self.lines
        places = [self.nodes[:-1] + share * length for share in _GAUSS]
        forces = [
            0.5 * length[:, None] * ((1.0 - share) * lines[:-1] + share * lines[1:])
            for share in _GAUSS
        ]
        return np.concatenate(places), np.concatenate(forces)


def moments_about(x: Array, moments: Array, order: int) -> Array:
    """Return int (s - x)^k/k! t ds, (m, n), from the moments int s^j/j! t ds, (4, m or 1, n).

    k is the ``order``; moments up to that order are used.
    """
    out, back = moments[order], -x[:, None]
    power = np.ones(back.shape)
    for k in range(order - 1, -1, -1):
        power = power * back / (order - k)
        out = out + power * moments[k]
    return np.asarray(out)


def _moments(starts: Array, lengths: Array) -> Array:
    """Return int s^k/k! t ds over intervals per end value of a linear t, (2, 4, m)."""
    s = starts + _PLACES[:, None] * lengths
    square = 0.5 * s * s
    powers = np.stack([np.ones(s.shape), s, square, s * square / 3.0])
    return np.asarray((_OF_ENDS[:, None, None] @ powers)[:, :, 0] * lengths)
