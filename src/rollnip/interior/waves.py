"""Wave numbers of the inverse transform: panels that resolve the oscillation and the layers.

(1/pi) int_0^W Re[f(w) e^{iwx}] dw is computed on Gauss-Legendre panels. From w_0 up, panels are
octaves, over each of which the response of the layers and their memory changes. Above these, panels
have the widths P, 2P and 4P, over which the phase w (x - s) between the farthest point x and
traction s turns by no more than the nodes of a panel can resolve. The wave numbers are
non-equidistant as in the paper (Braat & Kalker 1993, figure 2). For a long memory V tau or a
half-space, an equidistant mesh needs a long window; here they cost a few panels at the low end.
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
"""Phase from the middle to the end of a panel of width P at the reach: half of P times the reach.
"""
# Numbers of nodes are even, so that none lies in the middle of its panel.
_NODES_LOW = 16
_NODES = 66
"""Nodes on panels of width P, 2P and 4P (`_NODES_LOW`: on narrower ones, at most P/2). For m nodes
on 4P the error is (e y/(4 m))^(2m) < 1e-11, y the phase at the end of the panel.
"""
_OCTAVES = 5
"""Octaves of panels below P that make a block; below that block no phase exceeds `SMALL_PHASE`."""
SMALL_PHASE = _HALF_TURN * 0.5**_OCTAVES
"""Phase at half the reach at the end of the first block."""
_MOST_AT_ONCE = 24
"""Largest number of panels of width 4P in a block."""
_MOST_OCTAVES = 60


@lru_cache(maxsize=4)
def _gauss(nodes: int) -> tuple[Array, Array]:
    t, weight = np.polynomial.legendre.leggauss(nodes)
    return np.asarray(t), np.asarray(weight)


@dataclass(frozen=True, slots=True)
class Block:
    """Consecutive panels that are evaluated together.

    Attributes
    ----------
    start : lower end of the first panel [1/mm].
    middles, halves : (m,) middles and half-widths of the panels [1/mm].
    nodes : number of nodes on each panel.
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
        """Whether all panels have the same width."""
        return bool(np.ptp(self.halves) == 0.0)


class Phases:
    """The phases e^{-ikx} at given places x, for one block of wave numbers after the other.

    Each is the phase at the middle of its panel times the phase from there to the node. Most time
    goes into sines. Therefore phases at nodes below a middle are the conjugates of those above it,
    and phases on a panel are the squares of those on a panel of half its width. Both are kept for
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
        if block.start == 0.0:  # repeated squaring over many octaves would lose all digits
            return self._at(block.k)
        both = self._at(block.middles)[:, :, None] * self._from_middles(block)
        return np.asarray(both.reshape(self.x.size, -1))

    def sums(self, block: Block, weights: Array) -> ComplexArray:
        """Return the sums over x of ``weights`` (rows, m) times the phases, (rows, n)."""
        if not block.is_even:
            return np.asarray(weights @ self.on(block))
        turned = weights[:, None, :] * self._at(block.middles).T
        return np.asarray(turned @ self._from_middles(block)[:, 0]).reshape(len(weights), -1)

    def _from_middles(self, block: Block) -> ComplexArray:
        """Return phases from middles to nodes, (m, panels, nodes); one panel if all are equal."""
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
    width : P, the width of the narrowest panel above the octaves [1/mm].
    lowest : w_0; the first panel is [0, w_0] [1/mm].
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
        """Return the correction of the sum per unit of c, where the integrand has a part c/k.

        It is the finite part of int_0 dk/k, to which only wave numbers above 1/mm contribute, minus
        the sum over the nodes of the lowest panel; all over pi.
        """
        first = self.blocks(0.0)[0]
        inside = slice(0, _NODES_LOW)
        return float(np.log(self.lowest) / pi - np.sum(first.weights[inside] / first.k[inside]))


def _block(edges: NDArray[Any], nodes: int, width: float | None = None) -> Block:
    """Return the panels between ``edges``, all of one ``width`` if it is given."""
    halves = 0.5 * np.diff(edges) if width is None else np.full(edges.size - 1, 0.5 * width)
    return Block(float(edges[0]), 0.5 * (edges[1:] + edges[:-1]), halves, nodes)
