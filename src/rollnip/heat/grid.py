"""Cells of a roller from its surface inwards, in which heat is generated, stored and conducted.

Heat flows along the radius only. Between the middles of neighbouring cells the conductance per
length of roller is 2 pi k/ln(r1/r2), which is exact where no heat is generated in between.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isinf

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError
from rollnip.cooling import Cooling, Held, Insulated
from rollnip.materials import TYPICAL, Thermal
from rollnip.rollers import Roller

Array = NDArray[np.float64]
IntArray = NDArray[np.intp]

_LAYER_CELLS = 48
_CORE_CELLS = 96
_CORE_GROWTH = 4.0  # logarithm of the largest over the smallest cell of a half-space core
SHELL = -1  # layer number of the cells of a shell


@dataclass(frozen=True)
class RadialGrid:
    """One roller as a thermal conductor.

    Attributes
    ----------
    roller, cooling : the roller, and how it is cooled.
    depth : (n+1,) of the faces of the cells, from 0 at the surface [mm].
    layer : (n,) index of the layer; the number of layers stands for a half-space core, SHELL for
        the shell.
    conductivity : (n,) [mW/(mm K)].
    capacity : (n,) heat capacity of each cell per length [mJ/(mm K)].
    effusivity : of the surface [mW s^0.5/(mm2 K)].
    plane : temperature at which a plane arrives [degC]; None for a roller.
    """

    roller: Roller
    cooling: Cooling
    depth: Array
    layer: IntArray
    conductivity: Array
    capacity: Array
    effusivity: float
    plane: float | None = None

    @property
    def size(self) -> int:
        """Number of cells; 0 for a plane and for a bare core without a shell."""
        return int(self.layer.size)

    @property
    def radii(self) -> Array:
        """Radii of the faces, (n+1,) [mm]."""
        return self.roller.radius - self.depth

    @property
    def middles(self) -> Array:
        """Radii of the middles of the cells, (n,) [mm]."""
        return 0.5 * (self.radii[1:] + self.radii[:-1])

    @property
    def volumes(self) -> Array:
        """Volume of each cell per length, (n,) [mm2]."""
        return np.asarray(np.pi * (self.radii[:-1] ** 2 - self.radii[1:] ** 2))

    @property
    def covering(self) -> NDArray[np.bool_]:
        """Whether a cell deforms, (n,): all cells but those of the shell."""
        return np.asarray(self.layer != SHELL)

    @property
    def conductances(self) -> Array:
        """From the surface to the first middle, between middles, and to the inside, (n+1,)."""
        outer, inner = self.radii[:-1], self.radii[1:]
        middles = self.middles
        above = np.log(outer / middles) / self.conductivity
        with np.errstate(divide="ignore"):
            below = np.log(middles / inner) / self.conductivity
        resistance = np.concatenate([above[:1], above[1:] + below[:-1], below[-1:]])
        return np.asarray(2.0 * np.pi / resistance)

    @property
    def film_conductance(self) -> float:
        """Conductance of the film around the surface [mW/(mm K)]; 0 for a plane."""
        if self.plane is not None:
            return 0.0
        return 2e-3 * np.pi * self.roller.radius * self.cooling.film

    @property
    def inner_radius(self) -> float:
        """Radius of the boundary with the core [mm]."""
        return float(self.radii[-1])


def roller_grid(name: str, roller: Roller, cooling: Cooling, ambient: float) -> RadialGrid:
    """Return the cells of a roller.

    Parameters
    ----------
    name : "upper" or "lower", for messages.
    roller, cooling : of that side.
    ambient : temperature of the air [degC], at which a plane arrives unless another one is given.

    Raises
    ------
    InvalidInputError
        where a material has no thermal properties, the shell is thicker than the core, or a solid
        roller is cooled from inside.
    """
    shell = cooling.shell
    if isinf(roller.radius):
        held = cooling.core.temperature if isinstance(cooling.core, Held) else ambient
        return _bare(roller, cooling, _top(name, roller, cooling), held)
    _check_inside(name, roller, cooling)
    parts: list[tuple[Array, int, Thermal]] = []
    at = 0.0
    for i, layer in enumerate(roller.layers):
        faces = np.linspace(at, at + layer.thickness, _LAYER_CELLS + 1)
        parts.append((faces, i, _thermal(name, roller, i)))
        at += layer.thickness
    if roller.core is not None:
        bore = 0.0 if roller.shaft is None else 0.5 * roller.shaft.bore
        count = np.linspace(0.0, 1.0, _CORE_CELLS + 1)
        share = np.expm1(_CORE_GROWTH * count) / np.expm1(_CORE_GROWTH)
        faces = at + (roller.radius - bore - at) * share
        parts.append((faces, len(roller.layers), _thermal(name, roller, len(roller.layers))))
    elif shell is not None:
        faces = np.linspace(at, at + shell.thickness, _LAYER_CELLS + 1)
        parts.append((faces, SHELL, shell.thermal))
    top = _top(name, roller, cooling)
    if not parts:
        return _bare(roller, cooling, top, None)
    return _joined(roller, cooling, top, parts)


def _joined(
    roller: Roller, cooling: Cooling, top: Thermal, parts: list[tuple[Array, int, Thermal]]
) -> RadialGrid:
    counts = [faces.size - 1 for faces, _, _ in parts]
    depth = np.concatenate([parts[0][0][:1], *(faces[1:] for faces, _, _ in parts)])
    if depth[-1] > roller.radius * (1.0 - 1e-12):
        depth[-1] = roller.radius
    conductivity = np.repeat([thermal.conductivity for _, _, thermal in parts], counts)
    stored = np.repeat([thermal.volume_capacity for _, _, thermal in parts], counts)
    radii = roller.radius - depth
    volumes = np.pi * (radii[:-1] ** 2 - radii[1:] ** 2)
    layer = np.repeat([number for _, number, _ in parts], counts)
    return RadialGrid(roller, cooling, depth, layer, conductivity, stored * volumes, top.effusivity)


def _bare(roller: Roller, cooling: Cooling, top: Thermal, plane: float | None) -> RadialGrid:
    none = np.zeros(0)
    layer = np.zeros(0, dtype=np.intp)
    return RadialGrid(roller, cooling, np.zeros(1), layer, none, none, top.effusivity, plane)


def _check_inside(name: str, roller: Roller, cooling: Cooling) -> None:
    core = roller.radius - roller.coating_thickness
    if roller.core is not None:
        if cooling.shell is not None:
            raise InvalidInputError(
                f"`shell` must be left out for the {name} roller: its core is a body of its own."
            )
        solid = roller.shaft is None or roller.shaft.bore == 0.0
        if solid and not isinstance(cooling.core, Insulated):
            raise InvalidInputError(
                f"`core` must be insulated for the {name} roller, which is solid to its axis; give "
                "its shaft a bore, or cool its surface."
            )
    elif cooling.shell is not None and cooling.shell.thickness >= core:
        raise InvalidInputError(
            f"`shell` must be thinner than the core of the {name} roller, {core:g} mm in radius, "
            f"got {cooling.shell.thickness:g} mm."
        )


def _top(name: str, roller: Roller, cooling: Cooling) -> Thermal:
    """Return the thermal properties of the surface; a bare rigid core without a shell is steel."""
    if roller.materials:
        return _thermal(name, roller, 0)
    return TYPICAL["steel"] if cooling.shell is None else cooling.shell.thermal


def _thermal(name: str, roller: Roller, index: int) -> Thermal:
    material = roller.materials[index]
    if material.thermal is None:
        place = "core" if index == len(roller.layers) else f"layers[{index}].material"
        raise InvalidInputError(
            f"`{name}.{place}` must have `conductivity`, `density` and `heat_capacity` for a heat "
            'balance, got none; give them, or typical ones such as `thermal = "natural-rubber"`.'
        )
    return material.thermal
