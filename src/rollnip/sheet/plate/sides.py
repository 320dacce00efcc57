"""One interface of a plate: its mesh, and what tractions on it do to the sheet at some places."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from math import copysign, factorial, nan, sqrt
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from rollnip.contact import Subdivision
from rollnip.influence import load_weights
from rollnip.nip import Nip
from rollnip.rolling import PairKernels
from rollnip.rolling.displacements import Displacements
from rollnip.rolling.round import peaks_alike
from rollnip.rolling.surfaces import Mesh
from rollnip.sheet.plate.bending import Plate
from rollnip.sheet.squeeze import squeezed
from rollnip.sheets import Sheet

Array = NDArray[np.float64]
SIGNS = (1.0, -1.0)
"""Of the shear on each roller, and of the creep of its surface."""
_PIECES = tuple(
    (1.0 / factorial(k + 1) - (k + 1.0) / factorial(k + 2), (k + 1.0) / factorial(k + 2))
    for k in range(4)
)
"""Integrals of s^k/k! over a piece of length 1, times 1 - s and s."""
_WITHIN = 0.25  # of the mesh: length over which Gauss points would not do
_CUBIC = np.linalg.inv(np.vander(np.arange(4.0), increasing=True))
"""Coefficients of a cubic, from the constant on, by its values at 0, 1, 2 and 3."""
_GAUSS = 0.5 - sqrt(1.0 / 12.0), 0.5 + sqrt(1.0 / 12.0)  # points of a piece, over its length


@dataclass(frozen=True, slots=True)
class SideMesh(Mesh):
    """A mesh on one interface, where one roller alone has displacements.

    ``influence`` is empty: that of a contact with a plate is `PlateProblem.matrix`.
    """

    is_bare: ClassVar[bool] = False


def side_mesh(nodes: Array, fine: Subdivision, kernels: PairKernels, side: int) -> SideMesh:
    """Return a mesh on which one roller alone has displacements; none where it is rigid."""
    surface = (kernels.upper, kernels.lower)[side]
    if surface is None:
        return _rigid_mesh(nodes, fine, kernels)
    hoops = tuple(hoop if number == side else 0.0 for number, hoop in enumerate(kernels.hoops))
    alone = replace(
        kernels,
        upper=kernels.upper if side == 0 else None,
        lower=kernels.lower if side == 1 else None,
        second_upper=kernels.second_upper if side == 0 else None,
        second_lower=kernels.second_lower if side == 1 else None,
        held=None if kernels.held is None else kernels.held.of_side(side),
        together=surface.together,
        hoops=(hoops[0], hoops[1]),
    )
    return SideMesh.on(nodes, alone, fine)


def _rigid_mesh(nodes: Array, fine: Subdivision, kernels: PairKernels) -> SideMesh:
    inner, acting = nodes[1:-1], fine.acting
    assert acting is not None
    alone = replace(kernels, second_upper=None, second_lower=None, held=None, hoops=(0.0, 0.0))
    return SideMesh(
        nodes=nodes,
        fine=fine,
        inner=inner,
        dx=np.diff(nodes[1:]),
        weights=load_weights(fine.nodes) @ acting[1:-1, 1:-1],
        per_traction=np.zeros((6, inner.size + 1, inner.size)),
        influence=np.zeros((0, 0)),
        kernels=alone,
        held=None,
    )


def own_displacements(mesh: Mesh, side: int, pressure: Array, shear: Array) -> Displacements:
    """Return the linear displacements of one roller at nodes[1:]; the other one's are zero.

    ``shear`` is q_u on the upper roller, and q_l, which acts as -q_l, on the lower one.
    """
    xx, zz, xz = mesh.per_traction[3 * side : 3 * side + 3]
    t = SIGNS[side] * shear
    four = np.zeros((4, mesh.inner.size + 1))
    four[2 * side] = xz @ pressure + xx @ t
    four[2 * side + 1] = zz @ pressure - xz @ t
    return Displacements(four)


def stretch_by(mesh: Mesh, side: int, u_x: Array, u_z: Array) -> Array:
    """Return int (du_x/dx - u_z/R) dx over the intervals, of displacements at nodes[1:]."""
    out = u_x[1:] - u_x[:-1]
    hoop = mesh.kernels.hoops[side]
    if hoop:
        means = mesh.fine.means
        assert means is not None
        dx = np.diff(mesh.fine.nodes[1:])[:, None]
        out = out - hoop * (mesh.sums(dx * means) @ u_z)
    return np.asarray(out)


@dataclass(frozen=True, slots=True)
class Spread:
    """Tractions as the sheet feels them at other places, per value of each of their sets.

    Attributes
    ----------
    sheet, plate : what they act on.
    nodes : (M + 1,) between which they are straight lines [mm].
    lines : (M + 1, n) their values at the nodes.
    tails : (4, M + 1, n) int_x^inf t ds at the nodes, its integral from each node on, and so on:
        the k-th is int (s - x)^k/k! t ds from x on [mm^(k + 1)].
    """

    sheet: Sheet
    plate: Plate
    nodes: Array
    lines: Array
    tails: Array

    @classmethod
    def on(cls, mesh: Mesh, sheet: Sheet, plate: Plate, along: Array | None = None) -> Spread:
        """Return the spread of nodal tractions on a mesh.

        ``along``: factors at its finer nodes, such as ds/dx; None: all 1.
        """
        nodes, acting = mesh.fine.nodes, mesh.fine.acting
        assert acting is not None
        lines = np.zeros((nodes.size, mesh.inner.size))
        lines[1:-1] = acting[1:-1, 1:-1]
        lines = lines if along is None else lines * along[:, None]
        return cls.of_lines(nodes, lines, sheet, plate)

    @classmethod
    def of_lines(cls, nodes: Array, lines: Array, sheet: Sheet, plate: Plate) -> Spread:
        """Return the spread of tractions given at nodes, (M + 1, n)."""
        length, (first, last) = np.diff(nodes)[:, None], (lines[:-1], lines[1:])
        tails = np.zeros((4, *lines.shape))
        for k, (one, two) in enumerate(_PIECES):
            piece = length ** (k + 1) * (one * first + two * last)
            for j in range(k):
                piece += length ** (k - j) / factorial(k - j) * tails[j, 1:]
            tails[k, :-1] = np.cumsum(piece[::-1], axis=0)[::-1]
        return cls(sheet, plate, nodes, lines, tails)

    def of(self, values: Array) -> Spread:
        """Return the spread of one set of tractions, of nodal values (n,), or of s sets (n, s)."""
        sets = values.reshape(values.shape[0], -1)
        return replace(self, lines=self.lines @ sets, tails=self.tails @ sets)

    @property
    def whole(self) -> Array:
        """Return int t dx of each set, (n,) [mm]."""
        return np.asarray(self.tails[0, 0])

    @property
    def moment(self) -> Array:
        """Return int x t dx of each set, (n,) [mm^2]."""
        return np.asarray(self.tails[1, 0] + self.nodes[0] * self.tails[0, 0])

    def beyond(self, x: Array) -> Array:
        """Return ``tails`` from some places on, (4, m, n); exact."""
        nodes = self.nodes
        at = np.clip(np.searchsorted(nodes, x, side="right") - 1, 0, nodes.size - 2)
        own = at + (x == nodes[-1])
        if np.array_equal(nodes[own], x):
            return np.asarray(self.tails[:, own])
        step = (nodes[at] - np.minimum(x, nodes[-1]))[:, None]  # negative but before the first node
        t = self.lines[at]
        rise = (self.lines[at + 1] - t) / (nodes[at + 1] - nodes[at])[:, None]
        inside = np.minimum(step, 0.0)
        out = np.empty((4, x.size, t.shape[1]))
        for k in range(4):
            out[k] = self.tails[k, at] + inside ** (k + 1) / factorial(k + 1) * t
            out[k] -= inside ** (k + 2) / factorial(k + 2) * rise
            for j in range(k):
                out[k] += step ** (k - j) / factorial(k - j) * self.tails[j, at]
        return out

    def bent(self, x: Array, beyond: Array) -> tuple[Array, Array, Array]:
        """Return what loads do to the plate at some places, each (m, n).

        Parameters
        ----------
        x : (m,) places [mm].
        beyond : what `beyond` says of them.

        Returns
        -------
        Height of the middle [mm/MPa], rotation of the sections [1/MPa], curvature [1/mm/MPa].
        """
        # |x - s|^3/6 and its derivatives: twice what lies ahead, less all of it with its sign
        step = (self.nodes[0] - x)[:, None]
        whole = [
            sum(step ** (k - j) / factorial(k - j) * self.tails[j, :1] for j in range(k + 1))
            for k in (1, 2, 3)
        ]
        kinked = 2.0 * beyond[1] - whole[0]
        sheared = -0.5 * self.plate.shear * kinked
        if self.plate.length < _WITHIN * float(np.ptp(self.nodes)):
            height, slope, bend = self._drawn(x, beyond, whole[1], whole[0])
            return height + sheared, slope, bend
        yielding = 0.5 / self.plate.stiffness
        height = yielding * (2.0 * beyond[3] - whole[2]) + sheared
        slope, bend = yielding * (whole[1] - 2.0 * beyond[2]), yielding * kinked
        if self.plate.tension > 0.0:
            places, forces = self._points
            for out, less in zip(
                (height, slope, bend),
                self.plate.straightened(x[:, None] - places),
                strict=True,
            ):
                out -= less @ forces
        return height, slope, bend

    def _drawn(
        self, x: Array, beyond: Array, squares: Array, firsts: Array
    ) -> tuple[Array, Array, Array]:
        """Return what loads do to a plate that its tension straightens within the nip.

        K is then L/(2 D) (x^2/2 - L |x| + L^2 (1 - exp(-|x|/L))), all of it exact: for straight
        lines that turn by a_i at nodes x_i, int exp(-|x - s|/L) t ds is
        2 L t + L^2 sum a_i exp(-|x - x_i|/L).

        ``squares``, ``firsts``: int (s - x)^2/2 t ds and int (s - x) t ds. The shear of sections is
        left out.
        """
        length, yielding = self.plate.length, 0.5 * self.plate.length / self.plate.stiffness
        slopes = np.zeros((self.nodes.size + 1, self.lines.shape[1]))
        slopes[1:-1] = np.diff(self.lines, axis=0) / np.diff(self.nodes)[:, None]
        turns = np.diff(slopes, axis=0)
        away = (x[:, None] - self.nodes) / length
        decay = np.exp(-np.abs(away))
        before, after = (np.searchsorted(self.nodes, x, side=side) for side in ("left", "right"))
        at = np.clip(after - 1, 0, self.nodes.size - 1)
        inside = np.clip(x, self.nodes[0], self.nodes[-1])
        values = self.lines[at] + slopes[after] * (inside - self.nodes[at])[:, None]
        rises = 0.5 * (slopes[before] + slopes[after])
        near = 2.0 * length * values + length**2 * (decay @ turns)
        nears = 2.0 * length * rises - length * ((np.sign(away) * decay) @ turns)
        whole = self.tails[0, :1]
        distances = 2.0 * beyond[1] - firsts
        height = yielding * (squares - length * distances + length**2 * (whole - near))
        slope = -yielding * (firsts + length * (whole - 2.0 * beyond[0]) + length**2 * nears)
        return height, slope, yielding * (whole - near)

    @property
    def _points(self) -> tuple[Array, Array]:
        """Return Gauss points (2 M,) [mm], and tractions there times their lengths (2 M, n)."""
        length, lines = np.diff(self.nodes), self.lines
        places = [self.nodes[:-1] + share * length for share in _GAUSS]
        forces = [
            0.5 * length[:, None] * ((1.0 - share) * lines[:-1] + share * lines[1:])
            for share in _GAUSS
        ]
        return np.concatenate(places), np.concatenate(forces)

    def squeezed(self, x: Array, *, far: bool) -> Array:
        """Return how far a face gives way to the pressures towards the middle, (m, n) [mm/MPa].

        ``far``: the face opposite to that under the pressures; else that face itself.
        """
        shares = (0.25, -0.25) if far else (0.25, 0.25)
        return squeezed(self.sheet, x, self.nodes, self.lines[1:-1], shares)


def values_at(mesh: Mesh, x: Array) -> Array:
    """Return nodal tractions interpolated to some places, (m, n); 0 beyond the mesh."""
    fine = mesh.fine
    assert fine.values is not None
    padded = np.zeros((fine.nodes.size, mesh.inner.size))
    padded[1:-1] = fine.values[1:-1, 1:-1]
    at = np.clip(np.searchsorted(fine.nodes, x, side="right") - 1, 0, fine.nodes.size - 2)
    share = (x - fine.nodes[at]) / (fine.nodes[at + 1] - fine.nodes[at])
    inside = ((share >= 0.0) & (share <= 1.0)).astype(float)
    before, after = (inside * (1.0 - share))[:, None], (inside * share)[:, None]
    return np.asarray(before * padded[at] + after * padded[at + 1])


def highest(mesh: Mesh, pressure: Array) -> tuple[float, float]:
    """Return the highest pressure on one interface, between nodes too, and its place.

    Within a zone pressures and places are cubics in the number of the node (`Subdivision`). A
    parabola through three of the finer nodes is a thousandth off where the pressure rises over some
    ten elements, as beside an edge on a rigid roller.
    """
    fence = np.concatenate([[-np.inf], pressure, [-np.inf]])
    tops = np.flatnonzero((pressure >= fence[:-2]) & (pressure >= fence[2:]))
    if not tops.size:  # no numbers: the search has failed
        return nan, nan
    found = np.array([_highest_about(mesh, pressure, top) for top in tops.tolist()])
    parted = np.stack([found[:, 0], np.zeros(tops.size)], axis=1).ravel()
    height, place = found[peaks_alike(parted)[-1] // 2]
    return float(height), float(place)


def _highest_about(mesh: Mesh, pressure: Array, top: int) -> tuple[float, float]:
    """Return the highest pressure between the neighbours of a node, and its place."""
    best = float(pressure[top]), float(mesh.inner[top])
    ends = np.concatenate([[0], np.cumsum(mesh.fine.elements)])
    for first, last in pairwise(ends.tolist()):
        if not first <= top <= last:
            continue
        rises = top == first or (top < last and pressure[top + 1] > pressure[top - 1])
        start = max(min(top - (1 if rises else 2), last - 3), first)
        both = np.stack([pressure[start : start + 4], mesh.inner[start : start + 4]])
        heights, places = both @ _CUBIC.T
        for turn in _turns(heights.tolist()):
            if max(first, top - 1) <= start + turn <= min(last, top + 1):
                powers = turn ** np.arange(4)
                best = max(best, (float(heights @ powers), float(places @ powers)))
    return best


def _turns(cubic: list[float]) -> list[float]:
    """Return where a cubic, given by its coefficients from the constant on, turns."""
    _, slope, half_bend, third = cubic
    inside = half_bend**2 - 3.0 * third * slope
    if inside < 0.0:
        return []
    far = -half_bend - copysign(sqrt(inside), half_bend)
    return [top / bottom for top, bottom in ((far, 3.0 * third), (slope, far)) if bottom]


def curvatures(nip: Nip) -> tuple[float, float]:
    """Return the curvatures of the upper and the lower roller [1/mm]."""
    return nip.upper.curvature, nip.lower.curvature


def path_ratio(x: Array, nip: Nip, side: int, u: Displacements) -> Array:
    """Return ds/dx of the surface of one roller in each interval, (n - 1,)."""
    inward = (u.z_upper, u.z_lower)[side]
    slope = 0.5 * curvatures(nip)[side] * (x[1:] + x[:-1]) + np.diff(inward) / np.diff(x)
    return np.asarray(np.sqrt(1.0 + slope**2))
