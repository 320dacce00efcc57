"""Tractions on one interface as the sheet feels them at other places."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import factorial

import numpy as np
from numpy.typing import NDArray

from rollnip.rolling.surfaces import Mesh
from rollnip.sheet.layer_response import displacements
from rollnip.sheet.plate.bending import Plate, exponential_weights
from rollnip.sheet.squeeze import pressed_response, sheared_response
from rollnip.sheet.warp import LONG_WAVES, warped_response
from rollnip.sheets import Sheet

Array = NDArray[np.float64]

_POINTS = np.polynomial.legendre.leggauss(5)
# Gauss points of a piece, over its length, and the integrals by them of what goes with the value at
# either end: exact for the moments of straight lines.
_PLACES, _SHARES = 0.5 + 0.5 * _POINTS[0], 0.5 * _POINTS[1]
_OF_ENDS = np.stack([_SHARES * (1.0 - _PLACES), _SHARES * _PLACES])
_BOTH_FACES = (0.25, 0.25)  # of pressures on one face: half of them alike on both, half opposite
_MOMENTS = 4  # that a sheet without tension needs
_FEEBLE = 33.0  # of the mesh: length from which tension hardly straightens the sheet within it
_TERMS = 5  # of the series for such tensions: what is left out is below 1e-10


@dataclass(frozen=True, slots=True)
class Spread:
    """Tractions as the sheet feels them at other places, per value of each of their sets.

    Attributes
    ----------
    sheet, plate : what they act on.
    nodes : (M + 1,) between which they are straight lines [mm].
    lines : (M + 1, n) their values at the nodes.
    beyond : (moments, M + 1, n) int_x^inf s^k/k! t ds from the nodes on [mm^(k + 1)].
    """

    sheet: Sheet
    plate: Plate
    nodes: Array
    lines: Array
    beyond: Array

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
        is_feeble = plate.tension > 0.0 and plate.length > _FEEBLE * float(np.ptp(nodes))
        count = _MOMENTS + _TERMS - 1 if is_feeble else _MOMENTS
        first, last = _moments(nodes[:-1], np.diff(nodes), count)[..., None]
        beyond = np.zeros((count, *lines.shape))
        for moment, one, other in zip(beyond, first, last, strict=True):  # each fits a fast memory
            pieces = one * lines[:-1] + other * lines[1:]
            np.cumsum(pieces[::-1], axis=0, out=moment[-2::-1])
        return cls(sheet, plate, nodes, lines, beyond)

    def of(self, values: Array) -> Spread:
        """Return the spread of one set of tractions, of nodal values (n,), or of s sets (n, s)."""
        sets = values.reshape(values.shape[0], -1)
        return replace(self, lines=self.lines @ sets, beyond=self.beyond @ sets)

    @property
    def whole(self) -> Array:
        """Return int t dx of each set, (n,) [mm]."""
        return np.asarray(self.beyond[0, 0])

    @property
    def moment(self) -> Array:
        """Return int x t dx of each set, (n,) [mm^2]."""
        return np.asarray(self.beyond[1, 0])

    def moments_beyond(self, x: Array) -> Array:
        """Return ``beyond`` from some places on, (moments, m, n); exact."""
        inside = np.clip(x, self.nodes[0], self.nodes[-1])
        at = np.clip(np.searchsorted(self.nodes, inside, side="right") - 1, 0, self.nodes.size - 2)
        length = self.nodes[at + 1] - inside
        share = length / (self.nodes[at + 1] - self.nodes[at])
        first, last = _moments(inside, length, self.beyond.shape[0])[..., None]
        share = share[:, None]
        here, there = self.lines[at], self.lines[at + 1]
        out = self.beyond[:, at + 1]
        for moment, one, other in zip(out, first, last, strict=True):
            moment += share * one * here
            moment += ((1.0 - share) * one + other) * there
        return np.asarray(out)

    def bent(self, x: Array, beyond: Array) -> tuple[Array, Array, Array]:
        """Return what loads do to the plate at some places, each (m, n).

        Parameters
        ----------
        x : (m,) places [mm].
        beyond : what `moments_beyond` says of them.

        Returns
        -------
        Height of the middle [mm/MPa], rotation of the sections [1/MPa], curvature [1/mm/MPa].
        """
        # |x - s| and its odd powers: twice what lies ahead, less all of it with its sign
        whole = self.beyond[:, :1]
        ahead = 2.0 * beyond - whole
        distances = about(x, ahead, 1)
        sheared = -0.5 * self.plate.shear * distances
        length, yielding = self.plate.length, 0.5 / self.plate.stiffness
        if length > _FEEBLE * float(np.ptp(self.nodes)):
            height, slope, bend = self._bent_by_series(x, ahead)
            return height + sheared, slope, bend
        # K is L/(2 D) (x^2/2 - L |x| + L^2 (1 - exp(-|x|/L))), all of it exact
        before, after = self._decayed(x)
        yielding *= length
        near = whole[0] - before - after
        height = about(x, whole, 2) - length * distances + length**2 * near
        slope = -about(x, whole, 1) + length * (ahead[0] + before - after)
        return yielding * height + sheared, yielding * slope, yielding * near

    def _bent_by_series(self, x: Array, ahead: Array) -> tuple[Array, ...]:
        """Return height, rotation and curvature where tension straightens little or nothing.

        K is the sum of (-1)^(k + 1) L^3/(2 D) (|x|/L)^k/k! from k = 3 on; without tension only its
        first term is left. Even powers are polynomials. So are odd ones on either side of x, with
        opposite signs: they take ``ahead``, the moments of what lies ahead less what lies behind.
        """
        powers = np.arange(3, 4 + self.beyond.shape[0] - _MOMENTS)
        factors = 0.5 / self.plate.stiffness * (-1.0 / self.plate.length) ** (powers - 3)
        out = []
        for order in range(3):
            signed = (-1.0) ** order * factors
            odd, even = (
                _expanded(x, powers[first::2] - order, signed[first::2], self.beyond.shape[0])
                for first in (0, 1)
            )
            made = np.einsum("km,kmn->mn", odd, ahead)
            if powers.size > 1:
                made += even.T @ self.beyond[:, 0]
            out.append(made)
        return tuple(out)

    def _decayed(self, x: Array) -> tuple[Array, Array]:
        """Return int exp(-|x - s|/L) t ds of what lies behind and ahead of some places, (m, n)."""
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
        along = decays[0][:, 0].tolist()
        behind = _decaying(pieces[0], along)
        ahead = _decaying(pieces[1, ::-1], along[::-1])[::-1]
        share = (left / (left + right))[:, None]
        here = (1.0 - share) * lines[at] + share * lines[at + 1]
        outside = np.exp(-np.abs(x - inside) / length)[:, None]
        out = []
        for way, end, total in ((1, at, behind), (2, at + 1, ahead)):
            passed = decays[way] * total[end] + near[way] * here + far[way] * lines[end]
            out.append(outside * passed)
        return out[0], out[1]

    def squeezed(self, x: Array, far: NDArray[np.bool_]) -> Array:
        """Return how far a face gives way to the pressures towards the middle, (m, n) [mm/MPa].

        ``far``: where it is the face opposite to that under the pressures; else that face itself.
        """
        response = pressed_response(_BOTH_FACES)
        (made,) = displacements((response,), self.sheet.thickness, x, self.nodes, self.lines, far)
        return self.sheet.squeeze * made

    def warped(self, x: Array, far: NDArray[np.bool_], beyond: Array) -> Array:
        """Return int g t ds from some places on, (m, n) [mm]; see `rollnip.sheet.warp`.

        g t is the stretch of the face by pressures t, beside bending; ``beyond``: what
        `moments_beyond` says of the places; ``far``: see `squeezed`.
        """
        response, thickness = warped_response(), self.sheet.thickness
        (short,) = displacements((response,), thickness, x, self.nodes, self.lines, far)
        return self._warped(short, far, beyond)

    def _warped(self, short: Array, far: NDArray[np.bool_], beyond: Array) -> Array:
        sheet, alike = self.sheet, np.where(far, 0.0, self.sheet.stretch_by_pressure)
        signs = np.where(far, -1.0, 1.0)
        less = sheet.sheared / sheet.thickness
        long = alike - 0.5 * less * (LONG_WAVES[0] + signs * LONG_WAVES[1])
        return np.asarray(long[:, None] * beyond[0] - sheet.sheared * short)

    def faces_moved(
        self, x: Array, far: NDArray[np.bool_], beyond: Array
    ) -> tuple[Array, Array, Array]:
        """Return how far a face moves by unit tractions, each (m, n).

        By pressures towards the middle, see `squeezed` [mm/MPa]; by shears along, beside tension
        and bending [mm/MPa]; and along by pressures, see `warped` [mm].
        """
        responses = pressed_response(_BOTH_FACES), sheared_response(), warped_response()
        squeezed, sheared, short = displacements(
            responses, self.sheet.thickness, x, self.nodes, self.lines, far
        )
        warped = self._warped(short, far, beyond)
        return self.sheet.squeeze * squeezed, self.sheet.sheared * sheared, warped


def _decaying(pieces: Array, decays: list[float]) -> Array:
    """Return sums of rows, each of which has decayed from row to row, (m, n); changes ``pieces``.

    ``decays``: (m - 1,) factors from one row to the next.
    """
    for before, row, decay in zip(pieces[:-1], pieces[1:], decays, strict=True):
        row += decay * before
    return pieces


def about(x: Array, moments: Array, order: int) -> Array:
    """Return int (s - x)^k/k! t ds, (m, n), from the moments int s^j/j! t ds, (4, m or 1, n).

    k is the ``order``; moments count up to it.
    """
    out, back = moments[order], -x[:, None]
    power = np.ones(back.shape)
    for k in range(order - 1, -1, -1):
        power = power * back / (order - k)
        out = out + power * moments[k]
    return np.asarray(out)


def _expanded(x: Array, powers: NDArray[np.intp], factors: Array, count: int) -> Array:
    """Return the weights of int s^j/j! t ds, j < ``count``, in a sum of int (s - x)^k/k! t ds.

    (count, m); ``powers``, ``factors``: k and its factor, of each term.
    """
    out = np.zeros((count, x.size))
    for power, factor in zip(powers.tolist(), factors.tolist(), strict=True):
        for j in range(power + 1):
            out[j] += factor / factorial(power - j) * (-x) ** (power - j)
    return out


def _moments(starts: Array, lengths: Array, count: int) -> Array:
    """Return int s^k/k! t ds, k < ``count``, per value of straight lines at either end of pieces.

    (2, count, m).
    """
    s = starts + _PLACES[:, None] * lengths
    powers = np.ones((count, *s.shape))
    for k in range(1, count):
        np.multiply(powers[k - 1], s / k, out=powers[k])
    return np.asarray(np.tensordot(_OF_ENDS, powers, axes=(1, 1)) * lengths)
