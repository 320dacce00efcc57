"""What is rolled: rollers, coverings and what is prescribed. Units mm, N, MPa."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Layer:
    """A layer of a covering; a Poisson ratio of 0.5 means exactly incompressible.

    ``volumetric`` chooses the law of the change of volume of a compressible layer: "log" is
    lambda/2 (ln J)^2, "square" is lambda/2 (J - 1)^2.
    """

    thickness: float
    modulus: float
    poisson: float
    volumetric: str = "log"

    @property
    def shear_modulus(self) -> float:
        return self.modulus / (2.0 * (1.0 + self.poisson))

    @property
    def incompressible(self) -> bool:
        return self.poisson == 0.5

    @property
    def lame(self) -> float:
        """Lame's first constant; meaningless (0) where the layer is incompressible."""
        if self.incompressible:
            return 0.0
        nu = self.poisson
        return self.modulus * nu / ((1.0 + nu) * (1.0 - 2.0 * nu))


@dataclass(frozen=True)
class Roller:
    """A rigid core with layers bonded to it, outermost first; without layers it is rigid."""

    radius: float
    layers: tuple[Layer, ...] = ()

    @property
    def covering(self) -> float:
        return sum(layer.thickness for layer in self.layers)


@dataclass(frozen=True)
class Sheet:
    """A membrane between the rollers; of its thickness nothing counts but the stiffness.

    ``stiffness``: tension per strain along it, E h/(1 - nu^2) [N/mm]; ``friction`` on the upper and
    on the lower roller; tensions at the inlet (x > 0) and at the outlet [N/mm]. ``wraps``: whether
    the pressures on its faces differ by tension times curvature, as they must; False: they do not.
    """

    stiffness: float
    friction: tuple[float, float]
    tension_in: float = 0.0
    tension_out: float = 0.0
    wraps: bool = True


@dataclass(frozen=True)
class Plate:
    """A sheet of elements of its own, isotropic, neo-Hookean with the volumetric law "log".

    ``length``: of the strip that is meshed, from the middle to either end [mm]; ``friction`` on the
    upper and on the lower roller; tensions at the inlet (x > 0) and at the outlet [N/mm].
    """

    thickness: float
    modulus: float
    poisson: float
    length: float
    friction: tuple[float, float] = (0.0, 0.0)
    tension_in: float = 0.0
    tension_out: float = 0.0


@dataclass(frozen=True)
class Nip:
    """Two rollers under a load; the upper one is coated. T > 0: the upper roller drives.

    ``load`` is the vertical force per length, ``traction`` the integral of the shear over the
    deformed interface. With a sheet the load is the mean of both rollers' (they differ by what the
    tensions outside pull across), ``traction`` the force along x that the lower roller takes, and
    ``friction`` is not used.
    """

    upper: Roller
    lower: Roller
    load: float
    friction: float = 0.0
    traction: float = 0.0
    sheet: Sheet | None = None

    def __post_init__(self) -> None:
        if not self.upper.layers:
            raise ValueError("the upper roller must be the coated one")


def nip_of(case: Mapping[str, Any]) -> Nip:
    """Read the nip of one entry of tests/data/finite_strain_*.json."""

    def roller(entry: Mapping[str, Any]) -> Roller:
        return Roller(
            float(entry["radius"]), tuple(Layer(**layer) for layer in entry.get("layers", ()))
        )

    sheet = case.get("sheet")
    if sheet:
        sheet = Sheet(**{**sheet, "friction": tuple(sheet["friction"])})
    return Nip(
        upper=roller(case["upper"]),
        lower=roller(case["lower"]),
        load=float(case["load"]),
        friction=float(case.get("friction", 0.0)),
        traction=float(case.get("traction", 0.0)),
        sheet=sheet,
    )


def plate_of(case: Mapping[str, Any]) -> Plate:
    """Read the sheet of one entry of tests/data/plate_finite_elements.json."""
    return Plate(**{**case, "friction": tuple(case["friction"])})
