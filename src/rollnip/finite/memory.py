"""Hereditary stresses of viscoelastic layers in steady rolling at finite strain.

To the elastic stress S of a layer, the second Piola-Kirchhoff stress of its strain energy with the
relaxed modulus, a relaxing stress is added, with the relaxation of linear theory,
g(t) = E(t)/E(inf) - 1:

    S_total = S + g * dT/dt + J m'(J) [g * d(lambda m)/dt] C^-1,    U = lambda/2 m(J)^2,

    T = 2 G w_I 1 + G (w_J - r/J) J C^-1,    (g * f)(t) = int g(t - t') f(t') dt',

with components along the undeformed arc and into the undeformed roller, which rotate with the
material. An incompressible layer has no second integral, because its pressure is free. At small
strains T and lambda m together are the linear stress: E*(s) with a constant Poisson ratio. Slow
rolling is elastic with the relaxed modulus, fast rolling with the glassy one. The neo-Hookean
T = G (1 - C^-1) is that of a network whose strands break and form again free of stress (Green &
Tobolsky 1946, J. Chem. Phys. 14, 80-92; Lodge 1956, Trans. Faraday Soc. 52, 120-130), which never
returns more energy than it took.

In steady rolling a material point moves along its row of elements towards smaller arcs s with the
speed V, so that its history is a function of the arc. Stresses are taken as linear between the
Gauss points of a row; the integrals are then exact sums, relaxing = weights @ stresses of the row.

Where g = sum_i g_i exp(-t/tau_i), what lies upstream of a place is remembered there as one number
for each i, which decays downstream: h_i(t + d) = exp(-d/tau_i) h_i(t). A row is then summed piece
by piece, each with the weights of its own stresses and with these states of memory.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rollnip.finite.strip import Array, Indices, Strip
from rollnip.materials import Material, exponential_terms, memory_integral

_PIECE = 32


@dataclass(frozen=True)
class Memory:
    """The history integrals g * df/dt along the rows of a mesh.

    Attributes
    ----------
    strip : the mesh; at least one layer is viscoelastic.
    speed : V at which material passes undeformed arcs [mm/s].
    """

    strip: Strip
    speed: float

    @cached_property
    def _layers(self) -> list[tuple[Indices, list[_RowPiece]]]:
        """The rows of elements of every viscoelastic material, and its pieces, upstream first."""
        rows: dict[Material, list[int]] = {}
        depths = self.strip.depths
        for row, layer in enumerate(depths.row_layers):
            material = depths.roller.layers[layer].material
            if not material.is_elastic:
                rows.setdefault(material, []).append(row)
        arcs = self.strip.by_column(self.strip.points[0])[:, 0, 0]
        times = np.concatenate([self.strip.ends[:1], arcs, self.strip.ends[-1:]]) / self.speed
        return [(np.array(where), _pieces(one, times)) for one, where in rows.items()]

    def history_integral(self, values: Array) -> Array:
        """Return int g(t - t') df/dt' dt' of values f at Gauss points, (elements, 9, parts)."""
        return self._summed(values, is_far=False)

    def far_integral(self, values: Array) -> Array:
        """Return the same without the values of the own element and of the next one in its row."""
        return self._summed(values, is_far=True)

    def _summed(self, values: Array, *, is_far: bool) -> Array:
        parts = values.shape[-1]
        rows = self.strip.depths.row_layers.size
        by_row = self.strip.by_column(values)
        out = np.zeros(by_row.shape)
        for where, pieces in self._layers:
            chosen = by_row[:, where].reshape(by_row.shape[0], -1)
            made, state = np.empty(chosen.shape), np.zeros((len(pieces[0].kept), chosen.shape[1]))
            for piece in pieces:
                given = chosen[piece.points]
                weights = piece.far_weights if is_far else piece.weights
                made[piece.own] = weights @ given + piece.remembered @ state
                state = piece.passed_on @ given[3:] + piece.kept * state
            out[:, where] = made.reshape(-1, where.size, 3 * parts)
        back = out.reshape(-1, 3, rows, 3, parts).transpose(0, 2, 1, 3, 4)
        return np.ascontiguousarray(back).reshape(-1, 9, parts)

    @cached_property
    def near_weights(self) -> tuple[Array, Array]:
        """Weights of the Gauss points of the own element, and of those of the next one in its row.

        Each (elements, 3, 3), by points along the arc. The weights of a point on itself are
        `own_weights`, and 0 here.
        """
        columns, rows = self.strip.columns, self.strip.depths.row_layers.size
        out = np.zeros((2, columns, rows, 3, 3))
        for where, pieces in self._layers:
            for piece in pieces:
                own, following = out[:, piece.own.start // 3 : piece.own.stop // 3]
                blocks = piece.weights.reshape(own.shape[0], 3, -1, 3)
                here, ahead = np.arange(own.shape[0]), np.arange(blocks.shape[2] - 1)
                own[:, where] = (blocks[here, :, here] * (1.0 - np.eye(3)))[:, None]
                following[ahead[:, None], where] = blocks[ahead, :, ahead + 1][:, None]
        return out[0].reshape(-1, 3, 3), out[1].reshape(-1, 3, 3)

    @cached_property
    def own_weights(self) -> Array:
        """Weight of the value at each Gauss point on itself, (elements, 9)."""
        rows = self.strip.depths.row_layers.size
        out = np.zeros((3 * self.strip.columns, rows))
        for where, pieces in self._layers:
            for piece in pieces:
                out[piece.own, where] = np.diagonal(piece.weights)[:, None]
        back = out.reshape(-1, 3, rows).transpose(0, 2, 1).reshape(-1, 3)
        return np.repeat(back, 3, axis=1)

    @cached_property
    def is_compressible(self) -> bool:
        """Whether a viscoelastic layer is compressible."""
        materials = [layer.material for layer in self.strip.depths.roller.layers]
        return any(not one.is_elastic and one.poisson < 0.5 for one in materials)


@dataclass(frozen=True)
class _RowPiece:
    """How history integrals in neighbouring columns follow from what lies there and upstream.

    Attributes
    ----------
    own : the Gauss points of these columns, along a row.
    points : these and those of the next column upstream; there is none at the end of the mesh.
    weights : (own, points) of the values in the integrals.
    remembered : (own, exponentials) share that is left there of the states of memory, which are
        those at the last one of ``points`` by values further upstream.
    passed_on : (exponentials, points - 3) weights of all but the first three values in the states
        with which the next piece, downstream, begins.
    kept : (exponentials, 1) share of its own states that is left in these.
    """

    own: slice
    points: slice
    weights: Array
    remembered: Array
    passed_on: Array
    kept: Array

    @cached_property
    def far_weights(self) -> Array:
        """Weights without those of the own element and of the next one in its row, upstream.

        Points downstream have a weight only where a layer has a constant loss factor.
        """
        column = np.arange(self.weights.shape[1]) // 3
        ahead = column - column[: self.weights.shape[0], None]
        return np.asarray(self.weights * ((ahead != 0) & (ahead != 1)))


def _pieces(material: Material, times: Array) -> list[_RowPiece]:
    """Return the pieces of rows of a material, upstream first; one if E(t) has no exponentials.

    ``times``, (points + 2,) [s], are those at which material is on its way upstream of arc 0: at
    the Gauss points of a row and at both ends of the mesh, where values are zero, as beyond.
    """
    terms = np.array(exponential_terms(material)).reshape(-1, 2, 1)
    size, step = times.size - 2, 3 * _PIECE if terms.size else times.size
    return [
        _piece(material, terms, times, slice(first, min(first + step, size)))
        for first in reversed(range(0, size, step))
    ]


def _piece(material: Material, terms: Array, times: Array, own: slice) -> _RowPiece:
    """Return the piece of some Gauss points; ``terms``: (exponentials, 2, 1) g_i and tau_i."""
    points = slice(own.start, min(own.stop + 3, times.size - 2))
    around = times[points.start : points.stop + 2]  # with the neighbours on either side
    here, last, next_last = around[1 : own.stop - own.start + 1], around[-2], around[3]
    share, own_time = terms[:, 0], terms[:, 1]
    area = -share * own_time * np.expm1(-np.maximum(around - next_last, 0.0) / own_time)
    return _RowPiece(
        own=own,
        points=points,
        weights=_weights(memory_integral(material, around - here[:, None]), around),
        remembered=np.exp((here - last) / own_time).T,
        passed_on=_weights(area, around)[:, 3:],
        kept=np.exp((next_last - last) / own_time),
    )


def _weights(area: Array, times: Array) -> Array:
    """Return the weights of values at all but the outer ``times`` in history integrals.

    ``area``: the integral of g over the time that has passed since each of them, (integrals, n).
    """
    return np.diff(np.diff(area) / np.diff(times))
