"""Wave numbers of the inverse transform: panels that resolve the oscillation and the layers.

(1/pi) int_0^W Re[f(w) e^{iwx}] dw by Gauss-Legendre panels: in octaves from w_0 up, where the
layers and their memory change over each octave, and of widths P, 2P and 4P above, where w (x - s)
of the farthest point x and traction s turns by not more than the nodes of a panel can follow. The
wave numbers are non-equidistant as in the paper (Braat & Kalker 1993, figure 2); a long memory
V tau or a half-space, which an equidistant mesh pays with its window, costs a few panels at the
low end.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import ceil, log2, pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_HALF_TURN = 20.0
"""Half the width P times the reach: the phase y from the middle to the end of a panel."""
# Numbers of nodes are even: none lies in the middle of its panel.
_NODES_LOW = 16
_NODES = 66
"""On panels of at most P/2, and of P, 2P and 4P: (e y/(4 m))^(2m) < 1e-11 for m nodes on 4P."""
_OCTAVES = 5
"""Octaves of panels below P that make a block; below it no phase exceeds `SMALL_PHASE`."""
SMALL_PHASE = _HALF_TURN * 0.5**_OCTAVES
"""Phase of half the reach at the end of the first block."""
_MOST_AT_ONCE = 24
"""Panels of 4P in a block at most."""
_MOST_OCTAVES = 60


@lru_cache(maxsize=4)
def _gauss(nodes: int) -> tuple[Array, Array]:
    t, weight = np.polynomial.legendre.leggauss(nodes)
    return np.asarray(t), np.asarray(weight)


@dataclass(frozen=True, slots=True)
class Block:
    """Some panels in a row that are evaluated together.

    Attributes
    ----------
    start : lower end of the first panel [1/mm].
    middles, halves : (m,) of the panels [1/mm].
    nodes : on each panel.
    """

    start: float
    middles: Array
    halves: Array
    nodes: int

    @property
    def k(self) -> Array:
        """Wave numbers, (n,) [1/mm]."""
        return np.asarray(
            (self.middles[:, None] + np.multiply.outer(self.halves, _gauss(self.nodes)[0])).ravel()
        )

    @property
    def weights(self) -> Array:
        """Quadrature weights over pi, (n,) [1/mm]."""
        return np.multiply.outer(self.halves, _gauss(self.nodes)[1] / pi).ravel()

    @property
    def is_even(self) -> bool:
        """Return whether all panels have the same width."""
        return bool(np.ptp(self.halves) == 0.0)


class Phases:
    """e^{-ikx} at some places x, block after block.

    Each is the phase of the middle of its panel times the phase from there to the node. Sines take
    most of the time. So phases to the nodes below a middle are taken as the conjugates of those
    above, phases on a panel as the squares of those on one of half its width; both are kept for
    further blocks.

    Parameters
    ----------
    x : (m,) [mm].
    """

    def __init__(self, x: Array) -> None:
        self.x = x
        self._within: dict[tuple[float, int], ComplexArray] = {}

    def on(self, block: Block) -> ComplexArray:
        """Return the phases, (m, n)."""
        if block.start == 0.0:  # squares of squares over many octaves would leave no digit
            return self._at(block.k)
        both = self._at(block.middles)[:, :, None] * self._from_middles(block)
        return np.asarray(both.reshape(self.x.size, -1))

    def sums(self, block: Block, weights: Array) -> ComplexArray:
        """Return sums over x of ``weights`` (rows, m) times the phases, (rows, n)."""
        if not block.is_even:
            return np.asarray(weights @ self.on(block))
        turned = weights[:, None, :] * self._at(block.middles).T
        return np.asarray(turned @ self._from_middles(block)[:, 0]).reshape(len(weights), -1)

    def _from_middles(self, block: Block) -> ComplexArray:
        """Return phases from middles to nodes, (m, panels, nodes); those of one panel if even."""
        halves = block.halves[:1] if block.is_even else block.halves
        return np.stack([self._from_middle(half, block.nodes) for half in halves.tolist()], axis=1)

    def _from_middle(self, half: float, nodes: int) -> ComplexArray:
        if (half, nodes) not in self._within:
            narrower = self._within.get((0.5 * half, nodes))
            if narrower is None:
                above = self._at(half * _gauss(nodes)[0][nodes // 2 :])
                made = np.concatenate([above[:, ::-1].conj(), above], axis=1)
            else:
                made = narrower * narrower
            self._within[half, nodes] = made
        return self._within[half, nodes]

    def _at(self, k: Array) -> ComplexArray:
        return np.asarray(np.exp(-1j * np.multiply.outer(self.x, k)))


@dataclass(frozen=True, slots=True)
class Waves:
    """Panels for points at most ``reach`` away from any traction.

    Attributes
    ----------
    width : P, of the narrowest panel above the octaves [1/mm].
    lowest : w_0, the first panel is [0, w_0] [1/mm].
    """

    width: float
    lowest: float

    @classmethod
    def resolving(cls, reach: float, slowest: float) -> Waves:
        """Return panels for distances up to ``reach`` [mm], features as fine as 1/``slowest``."""
        width = 2.0 * _HALF_TURN / reach
        octaves = ceil(log2(max(2.0**_OCTAVES, width * slowest)))
        return cls(width, width * 2.0 ** -min(octaves, _MOST_OCTAVES))

    def blocks(self, last: float) -> list[Block]:
        """Return panels from 0 to ``last`` [1/mm] or a little above, in blocks that grow."""
        octaves = round(log2(self.width / self.lowest))
        edges = np.zeros(octaves + 2)
        edges[1:] = np.ldexp(self.lowest, np.arange(octaves + 1))
        blocks = [_block(edges[:-_OCTAVES], _NODES_LOW), _block(edges[-1 - _OCTAVES :], _NODES_LOW)]
        for width in self.width * 2.0 ** np.arange(3):
            if last > width:
                blocks.append(_block(width * np.array([1.0, 2.0]), _NODES, width))
        wide, done = 4.0 * self.width, 2
        count = ceil(last / wide)
        while done < count:
            size = min(done, _MOST_AT_ONCE, count - done)
            blocks.append(_block(wide * np.arange(done, done + size + 1), _NODES, wide))
            done += size
        return blocks

    def logarithm(self) -> float:
        """Return the correction of the sum, per c, where the integrand has a part c/k.

        That is the finite part of int_0 dk/k, for which only wave numbers above 1/mm count, less
        the sum over the nodes of the lowest panel; over pi.
        """
        first = self.blocks(0.0)[0]
        inside = slice(0, _NODES_LOW)
        return float(np.log(self.lowest) / pi - np.sum(first.weights[inside] / first.k[inside]))


def _block(edges: NDArray[Any], nodes: int, width: float | None = None) -> Block:
    """Return panels between ``edges``; all of one ``width`` where it is given."""
    halves = 0.5 * np.diff(edges) if width is None else np.full(edges.size - 1, 0.5 * width)
    return Block(float(edges[0]), 0.5 * (edges[1:] + edges[:-1]), halves, nodes)
