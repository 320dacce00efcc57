"""Coverings whose thickness or hardness varies along the face.

Where a single layer on a rigid core is all that deforms, a factor on its moduli is exactly a factor
on load and traction. Every other variation needs cross-sections of its own. They are solved for a
few thicknesses (or stiffnesses), and the logarithms of their figures are interpolated by a
polynomial in the logarithm of the thickness.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import product
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError
from rollnip.materials import with_stiffness
from rollnip.nip import Nip
from rollnip.rollers import SIDES, Layer, Roller, Side

Array = NDArray[np.float64]
What = Literal["thickness", "stiffness"]
Key = tuple[Side, What]

_NODES = 3  # initial number of nodes of an axis
_MOST_NODES = 9


@dataclass(frozen=True, slots=True)
class Coverings:
    """The coverings at the places of a face.

    Attributes
    ----------
    values : (n,) thickness [mm] or stiffness of the outermost layer, by roller; only what varies.
    scale : (n,) factor on all moduli together.
    """

    values: Mapping[Key, Array]
    scale: Array

    @property
    def ranges(self) -> dict[Key, tuple[float, float]]:
        """Smallest and largest value of each quantity."""
        return {key: (float(v.min()), float(v.max())) for key, v in self.values.items()}


def coverings_of(nip: Nip, y: Array, length: float, stiffness: float = 1.0) -> Coverings:
    """Return the coverings of both rollers at places of a face.

    ``stiffness`` is a factor on all moduli of both.

    Raises
    ------
    InvalidInputError
        where a roller without layers has a covering, or its table does not cover the face.
    """
    values: dict[Key, Array] = {}
    scale = np.full(y.size, stiffness)
    for name in SIDES:
        roller: Roller = getattr(nip, name)
        table = None if roller.shaft is None else roller.shaft.covering
        if table is None:
            continue
        if not roller.layers:
            raise InvalidInputError(f"`covering` needs layers, and the {name} roller has none.")
        thickness = table.at("thickness", y, length)
        if thickness is not None:
            values[name, "thickness"] = thickness
        factor = table.at("stiffness", y, length)
        if factor is not None and _is_all_that_deforms(nip, roller):
            scale = scale * factor
        elif factor is not None:
            values[name, "stiffness"] = factor
    return Coverings(values, scale)


def _is_all_that_deforms(nip: Nip, roller: Roller) -> bool:
    other = nip.lower if roller is nip.upper else nip.upper
    return len(roller.layers) == 1 and roller.core is None and other.is_rigid


def thinnest(roller: Roller) -> float:
    """Return the smallest total thickness of a roller's layers over its face [mm]."""
    table = None if roller.shaft is None else roller.shaft.covering
    if table is None or table.thickness is None or not roller.layers:
        return roller.coating_thickness
    least = float(np.min(np.asarray(table.thickness)))
    return roller.coating_thickness - roller.layers[0].thickness + least


@dataclass(frozen=True, slots=True)
class CoveringAxis:
    """Thicknesses or stiffnesses for which cross-sections are solved.

    Attributes
    ----------
    key : the roller, and the quantity.
    nodes : increasing values.
    """

    key: Key
    nodes: tuple[float, ...]

    @classmethod
    def between(cls, key: Key, low: float, high: float, count: int = _NODES) -> CoveringAxis:
        """Return Chebyshev extreme points in the logarithm; a single node where nothing varies."""
        if high <= low * (1.0 + 1e-9):
            return cls(key, (low,))
        share = 0.5 * (1.0 - np.cos(np.pi * np.arange(count) / (count - 1)))
        nodes = low * (high / low) ** share
        return cls(key, tuple(float(one) for one in nodes))

    @property
    def name(self) -> str:
        """Name of its interpolation error: "upper_thickness"."""
        return "_".join(self.key)

    @property
    def can_be_finer(self) -> bool:
        """Whether more nodes are allowed."""
        return 1 < len(self.nodes) < _MOST_NODES

    @property
    def finer(self) -> CoveringAxis:
        """The axis with nodes between these (on the nodes of twice as many intervals)."""
        return CoveringAxis.between(
            self.key, self.nodes[0], self.nodes[-1], 2 * len(self.nodes) - 1
        )

    @property
    def between_nodes(self) -> float:
        """A value as far from all nodes as possible."""
        return self.finer.nodes[1]

    def weights(self, values: Array) -> Array:
        """Return the weight of each node in the interpolated figure, (n, nodes)."""
        x, at = np.log(np.array(self.nodes)), np.log(values)
        out = np.ones((values.size, x.size))
        for i, own in enumerate(x):
            for j, other in enumerate(x):
                if i != j:
                    out[:, i] *= (at - other) / (own - other)
        return out


def axes_of(coverings: Coverings) -> tuple[CoveringAxis, ...]:
    """Return the axes that cover all values, with the initial number of nodes."""
    return tuple(
        CoveringAxis.between(key, low, high) for key, (low, high) in coverings.ranges.items()
    )


def covers(axes: tuple[CoveringAxis, ...], coverings: Coverings) -> bool:
    """Return whether axes cover the values of a face."""
    ranges = coverings.ranges
    return {axis.key for axis in axes} == set(ranges) and all(
        axis.nodes[0] <= ranges[axis.key][0] * (1.0 + 1e-9)
        and ranges[axis.key][1] <= axis.nodes[-1] * (1.0 + 1e-9)
        for axis in axes
    )


def nips_of(nip: Nip, axes: tuple[CoveringAxis, ...]) -> list[Nip]:
    """Return the nip for each combination of nodes; the last axis runs fastest."""
    keys = [axis.key for axis in axes]
    states = product(*(axis.nodes for axis in axes))
    return [with_covering(nip, dict(zip(keys, state, strict=True))) for state in states]


def weights_of(axes: tuple[CoveringAxis, ...], coverings: Coverings) -> Array:
    """Return the weight of each of the `nips_of` at the places of a face, (n, nips)."""
    out = np.ones((coverings.scale.size, 1))
    for axis in axes:
        own = axis.weights(coverings.values[axis.key])
        out = (out[:, :, None] * own[:, None, :]).reshape(out.shape[0], -1)
    return out


def with_covering(nip: Nip, state: Mapping[Key, float]) -> Nip:
    """Return the nip with other outermost layers."""
    for (name, what), value in state.items():
        roller: Roller = getattr(nip, name)
        first, *others = roller.layers
        layer = (
            Layer(value, first.material)
            if what == "thickness"
            else Layer(first.thickness, with_stiffness(first.material, value))
        )
        changed = replace(roller, layers=(layer, *others))
        nip = replace(nip, upper=changed) if name == "upper" else replace(nip, lower=changed)
    return nip
