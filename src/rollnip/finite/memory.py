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
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rollnip.finite.strip import Array, Indices, Strip
from rollnip.materials import Material, memory_integral


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
    def _layers(self) -> list[tuple[Indices, Array]]:
        """The rows of elements of every viscoelastic material, and its `_weights`."""
        rows: dict[Material, list[int]] = {}
        depths = self.strip.depths
        for row, layer in enumerate(depths.row_layers):
            material = depths.roller.layers[layer].material
            if not material.is_elastic:
                rows.setdefault(material, []).append(row)
        arcs = self.strip.by_column(self.strip.points[0])[:, 0, 0]
        given = arcs, self.strip.ends[[0, -1]], self.speed
        return [(np.array(where), _weights(one, *given)) for one, where in rows.items()]

    def history_integral(self, values: Array) -> Array:
        """Return int g(t - t') df/dt' dt' of values f at Gauss points, (elements, 9, parts)."""
        return self._summed(values, [weights for _, weights in self._layers])

    def far_integral(self, values: Array) -> Array:
        """Return the same without the values of the own element and of the next one in its row."""
        return self._summed(values, self._far)

    def _summed(self, values: Array, all_weights: list[Array]) -> Array:
        parts = values.shape[-1]
        rows = self.strip.depths.row_layers.size
        by_row = self.strip.by_column(values)
        out = np.zeros(by_row.shape)
        for (where, _), weights in zip(self._layers, all_weights, strict=True):
            chosen = by_row[:, where].reshape(weights.shape[0], -1)
            out[:, where] = (weights @ chosen).reshape(-1, where.size, 3 * parts)
        back = out.reshape(-1, 3, rows, 3, parts).transpose(0, 2, 1, 3, 4)
        return np.ascontiguousarray(back).reshape(-1, 9, parts)

    @cached_property
    def _far(self) -> list[Array]:
        """Weights without those of the own element and of the next one in its row, upstream.

        Points downstream have a weight only where a layer has a constant loss factor.
        """
        column = np.arange(3 * self.strip.columns) // 3
        ahead = column - column[:, None]
        is_far = (ahead != 0) & (ahead != 1)
        return [weights * is_far for _, weights in self._layers]

    @cached_property
    def near_weights(self) -> tuple[Array, Array]:
        """Weights of the Gauss points of the own element, and of those of the next one in its row.

        Each (elements, 3, 3), by points along the arc. The weights of a point on itself are
        `own_weights`, and 0 here.
        """
        columns, rows = self.strip.columns, self.strip.depths.row_layers.size
        out = np.zeros((2, columns, rows, 3, 3))
        here = np.arange(columns)
        for where, weights in self._layers:
            blocks = weights.reshape(columns, 3, columns, 3)
            out[0][:, where] = (blocks[here, :, here] * (1.0 - np.eye(3)))[:, None]
            out[1][:-1, where] = blocks[here[:-1], :, here[1:]][:, None]
        return out[0].reshape(-1, 3, 3), out[1].reshape(-1, 3, 3)

    @cached_property
    def own_weights(self) -> Array:
        """Weight of the value at each Gauss point on itself, (elements, 9)."""
        rows = self.strip.depths.row_layers.size
        out = np.zeros((3 * self.strip.columns, rows))
        for where, weights in self._layers:
            out[:, where] = np.diagonal(weights)[:, None]
        back = out.reshape(-1, 3, rows).transpose(0, 2, 1).reshape(-1, 3)
        return np.repeat(back, 3, axis=1)

    @cached_property
    def is_compressible(self) -> bool:
        """Whether a viscoelastic layer is compressible."""
        materials = [layer.material for layer in self.strip.depths.roller.layers]
        return any(not one.is_elastic and one.poisson < 0.5 for one in materials)


def _weights(material: Material, arcs: Array, ends: Array, speed: float) -> Array:
    """Return the weights of the values at ``arcs`` in the history integrals there, (n, n).

    Values are zero at both ``ends`` and beyond. Material comes from larger arcs.
    """
    times = np.concatenate([[ends[0]], arcs, [ends[1]]])[::-1] / -speed
    area = memory_integral(material, times[1:-1, None] - times)
    ramps = (area[:, :-1] - area[:, 1:]) / np.diff(times)
    return (ramps[:, :-1] - ramps[:, 1:])[::-1, ::-1]
