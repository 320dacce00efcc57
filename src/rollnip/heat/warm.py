"""The nip of warm rollers, in which each sub-layer has the moduli of its own temperature.

A layer whose moduli follow the temperature is divided where they vary. A sub-layer has its mean
temperature; the error is of the order of the square of the change inside it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import pi

import numpy as np
from numpy.typing import NDArray

from rollnip.heat.conduction import Conduction
from rollnip.heat.grid import RadialGrid
from rollnip.heat.growth import core_growth, radial_growth
from rollnip.materials import Material, Viscoelastic
from rollnip.nip import Approach, Nip
from rollnip.rollers import Layer, Roller

Array = NDArray[np.float64]
Bounds = tuple[tuple[int, ...], ...]
"""For each layer the cells at which its sub-layers begin, and the one after its last."""

_MOST = 24  # most sub-layers of a layer
_LOWEST = 1e-6  # loss modulus over the magnitude of the modulus, below which it is not resolved


def follows(material: Material) -> bool:
    """Return whether the moduli of a material follow the temperature."""
    return isinstance(material, Viscoelastic) and material.shift is not None


def at_temperature(material: Material, temperature: float) -> Material:
    """Return the material at a temperature [degC]; unchanged where it has no shift."""
    if isinstance(material, Viscoelastic) and material.shift is not None:
        return replace(material, temperature=temperature)
    return material


@dataclass(frozen=True, slots=True)
class Divided:
    """The division of both rollers into sub-layers.

    Attributes
    ----------
    upper, lower : bounds of the sub-layers of each roller.
    """

    upper: Bounds
    lower: Bounds

    def of(self, side: int) -> Bounds:
        """Return the bounds for the upper (0) or the lower roller (1)."""
        return self.upper if side == 0 else self.lower

    @property
    def count(self) -> int:
        """Number of all sub-layers."""
        return sum(len(one) - 1 for one in (*self.upper, *self.lower))


def undivided(conduction: Conduction) -> Divided:
    """Return the division in which every layer is one sub-layer."""
    return Divided(*(_whole(grid) for grid in conduction.grids))


def divided(
    conduction: Conduction, temperatures: Array, nip: Nip, width: float, allowed: float
) -> Divided:
    """Return sub-layers inside which the complex modulus changes by no more than ``allowed``.

    Parameters
    ----------
    temperatures : (n+2,) of cells and surfaces [degC].
    nip, width : the speed of the nip over its width [mm] determines the frequency.
    allowed : largest change of ln E* inside a sub-layer, for storage and loss part.
    """
    speed = nip.speed or 0.0
    parts = (
        tuple(
            _bounds(grid, conduction.part(temperatures, side), index, pi * speed / width, allowed)
            for index in _indices(grid)
        )
        for side, grid in enumerate(conduction.grids)
    )
    return Divided(*parts)


def _indices(grid: RadialGrid) -> range:
    return range(0 if grid.size == 0 else len(grid.roller.materials))


def _whole(grid: RadialGrid) -> Bounds:
    return tuple(_span(grid, index) for index in _indices(grid))


def _span(grid: RadialGrid, index: int) -> tuple[int, int]:
    cells = np.flatnonzero(grid.layer == index)
    return int(cells[0]), int(cells[-1]) + 1


def _bounds(
    grid: RadialGrid, temperatures: Array, index: int, frequency: float, allowed: float
) -> tuple[int, ...]:
    first, stop = _span(grid, index)
    material = grid.roller.materials[index]
    if not follows(material) or index == len(grid.roller.layers):
        return first, stop
    inside = temperatures[first:stop]
    moduli = np.array(
        [at_temperature(material, float(t)).modulus_at(1j * frequency) for t in inside]
    )
    lost = np.maximum(moduli.imag, _LOWEST * np.abs(moduli))
    change = np.abs(np.diff(np.log(np.abs(moduli)))) + np.abs(np.diff(np.log(lost)))
    passed = np.concatenate([[0.0], np.cumsum(change)])
    count = int(np.clip(np.ceil(passed[-1] / allowed), 1, min(_MOST, stop - first)))
    if count == 1:
        return first, stop
    wanted = passed[-1] * np.arange(1, count) / count
    cuts = np.unique(np.searchsorted(passed, wanted))
    cuts = cuts[(cuts > 0) & (cuts < stop - first)]
    return (first, *(first + int(cut) for cut in cuts), stop)


@dataclass(frozen=True, slots=True)
class Growth:
    """Radial growth of one roller.

    Attributes
    ----------
    total : of its radius [mm].
    core : of the core under its coverings [mm].
    """

    total: float
    core: float

    def thicker(self, roller: Roller) -> float:
        """Return warm over cold thicknesses; 1 without layers and on a half-space core."""
        if not roller.layers or roller.core is not None:
            return 1.0
        return 1.0 + (self.total - self.core) / roller.coating_thickness


def growths(conduction: Conduction, temperatures: Array, reference: float) -> tuple[Growth, Growth]:
    """Return the radial growth of both rollers."""
    upper, lower = (
        Growth(
            radial_growth(grid, conduction.part(temperatures, side), reference),
            core_growth(grid, conduction.part(temperatures, side), reference),
        )
        for side, grid in enumerate(conduction.grids)
    )
    return upper, lower


def warm_nip(
    nip: Nip,
    conduction: Conduction,
    temperatures: Array,
    cut: Divided,
    grown: tuple[Growth, Growth],
) -> Nip:
    """Return the nip of rollers at given temperatures.

    Parameters
    ----------
    nip : cold.
    temperatures : (n+2,) of cells and surfaces [degC].
    cut : its sub-layers.
    grown : growth of both rollers.

    Returns
    -------
    Nip; a prescribed approach is that of the cold rollers, so that it grows with them.
    """
    rollers = [
        _warm_roller(grid, conduction.part(temperatures, side), cut.of(side), grown[side])
        for side, grid in enumerate(conduction.grids)
    ]
    normal = nip.normal
    if isinstance(normal, Approach):
        normal = Approach(normal.approach + grown[0].total + grown[1].total)
    return replace(nip, upper=rollers[0], lower=rollers[1], normal=normal)


def _warm_roller(grid: RadialGrid, temperatures: Array, cut: Bounds, grown: Growth) -> Roller:
    roller = grid.roller
    radius = roller.radius + grown.total
    if grid.size == 0 or not roller.materials:
        return roller if grown.total == 0.0 else _with(roller, radius, roller.layers, roller.core)
    thicker = grown.thicker(roller)
    layers = []
    for index, layer in enumerate(roller.layers):
        whole = float(np.diff(grid.depth[[cut[index][0], cut[index][-1]]])[0])
        for first, stop in pairwise(cut[index]):
            share = float(grid.depth[stop] - grid.depth[first]) / whole
            material = at_temperature(layer.material, _mean(grid, temperatures, first, stop))
            layers.append(Layer(thicker * share * layer.thickness, material))
    core = roller.core
    if core is not None:
        core = at_temperature(core, _mean(grid, temperatures, cut[-1][0], cut[-1][1]))
    return _with(roller, radius, layers, core)


def _with(roller: Roller, radius: float, layers: Sequence[Layer], core: Material | None) -> Roller:
    """Return a roller with the same profile and shaft."""
    return Roller(
        radius=radius, layers=layers, core=core, profile=roller.profile, shaft=roller.shaft
    )


def _mean(grid: RadialGrid, temperatures: Array, first: int, stop: int) -> float:
    weights = grid.volumes[first:stop]
    return float(weights @ temperatures[first:stop] / weights.sum())
