"""Rollers: layers of coating on a core. Data and its validation, no mechanics."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import inf, isinf

from rollnip._errors import InvalidInputError, require_positive
from rollnip.materials import Material

_LARGEST_LENGTH = 1e7  # mm; ten kilometres: beyond it a unit was mistaken


@dataclass(frozen=True, slots=True)
class Layer:
    """One layer of a coating.

    Parameters
    ----------
    thickness :
        radial thickness [mm], positive and finite.
    material :
        what it is made of.

    Raises
    ------
    InvalidInputError
        where the thickness is not positive and finite, or the material is not one.
    """

    thickness: float
    material: Material

    def __post_init__(self) -> None:
        require_positive("thickness", self.thickness)
        if self.thickness > _LARGEST_LENGTH:
            raise InvalidInputError(f"`thickness` must be at most 1e7 mm, got {self.thickness!r}.")
        _require_material("material", self.material)


@dataclass(frozen=True, slots=True, kw_only=True)
class Roller:
    """A cylinder with its coating.

    Parameters
    ----------
    radius :
        undeformed outer radius [mm], positive; ``inf`` is a plane.
    layers :
        coating from the surface to the core; empty: a bare core.
    core :
        None for a rigid core, or the material of an elastic or viscoelastic half-space.

    Raises
    ------
    InvalidInputError
        where the radius is not positive or the coating is not thinner than the radius.
    """

    radius: float
    layers: tuple[Layer, ...] = ()
    core: Material | None = None

    def __post_init__(self) -> None:
        if not (isinstance(self.radius, float | int) and isinf(self.radius) and self.radius > 0):
            require_positive("radius", self.radius)
            if self.radius > _LARGEST_LENGTH:
                raise InvalidInputError(
                    f"`radius` must be at most 1e7 mm (or inf, a plane), got {self.radius!r}."
                )
        if not isinstance(self.layers, list | tuple):
            raise InvalidInputError(
                f"`layers` must be a list of Layer objects, got {self.layers!r}."
            )
        object.__setattr__(self, "layers", tuple(self.layers))
        for layer in self.layers:
            if not isinstance(layer, Layer):
                raise InvalidInputError(f"`layers` must hold Layer objects, got {layer!r}.")
        if self.core is not None:
            _require_material("core", self.core)
        if self.coating_thickness >= self.radius:
            raise InvalidInputError(
                f"`layers` must be thinner in all than the radius {self.radius:g} mm, "
                f"got {self.coating_thickness:g} mm."
            )

    @property
    def coating_thickness(self) -> float:
        """Thickness of all layers together [mm]."""
        return float(sum(layer.thickness for layer in self.layers))

    @property
    def curvature(self) -> float:
        """1/radius [1/mm]; 0 for a plane."""
        return 0.0 if self.radius == inf else 1.0 / self.radius

    @property
    def is_rigid(self) -> bool:
        """True for a bare rigid core: a surface that does not deform."""
        return not self.layers and self.core is None

    @property
    def materials(self) -> tuple[Material, ...]:
        """Materials from the surface to the core."""
        core = () if self.core is None else (self.core,)
        return tuple(layer.material for layer in self.layers) + core

    @property
    def is_viscoelastic(self) -> bool:
        """True where any of its materials is viscoelastic."""
        return any(not material.is_elastic for material in self.materials)

    @property
    def interfaces(self) -> tuple[float, ...]:
        """Depths [mm] of the lower face of each layer, from the surface."""
        depths = [0.0]
        for layer in self.layers:
            depths.append(depths[-1] + layer.thickness)
        return tuple(below for _, below in pairwise(depths))


def _require_material(name: str, value: object) -> None:
    if not isinstance(value, Material):
        raise InvalidInputError(f"`{name}` must be a material such as Elastic, got {value!r}.")
