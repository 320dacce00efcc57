"""Rollers: layers of coating on a core. Data and its validation, no mechanics."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from hashlib import sha256
from itertools import pairwise
from math import inf, pi, sqrt
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rollnip._errors import InvalidInputError, require_positive, with_hints
from rollnip.materials import Material
from rollnip.shafts import Shaft

Side = Literal["upper", "lower"]
"""One of the two rollers of a nip."""
SIDES: tuple[Side, Side] = ("upper", "lower")
"""Both of them."""

_MOST_SAMPLES = 2**18
_ROUNDING = 1e-9  # of the length of a profile
_LARGEST_LENGTH = 1e7  # mm; ten kilometres: beyond it a unit was mistaken
_SMALLEST_THICKNESS = 1e-9  # mm; a hundredth of an atom
_GRAVITY = 9.80665e-9  # N per (kg/m3) mm3
_LEAST_CORE = 1e-3  # of the radius: on a thinner one the ring is lost in rounding


@with_hints(
    shore_a="give `material=rn.Elastic.from_shore_a(60)`.",
    modulus="give `material=rn.Elastic(modulus=..., poisson=0.5)`.",
)
@dataclass(frozen=True, slots=True)
class Layer:
    """One layer of a coating.

    Parameters
    ----------
    thickness :
        radial thickness [mm], from 1e-9 to 1e7.
    material :
        what it is made of.

    Raises
    ------
    InvalidInputError
        where the thickness is outside its range, or the material is not one.
    """

    thickness: float
    material: Material

    def __post_init__(self) -> None:
        thickness = require_positive("thickness", self.thickness)
        if thickness > _LARGEST_LENGTH:
            raise InvalidInputError(f"`thickness` must be at most 1e7 mm, got {self.thickness!r}.")
        if thickness < _SMALLEST_THICKNESS:
            raise InvalidInputError(f"`thickness` must be at least 1e-9 mm, got {thickness!r}.")
        object.__setattr__(self, "thickness", thickness)
        _require_material("material", self.material)


@with_hints()
@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class Profile:
    """Measured height of a surface over the smooth roller, along the nip at one instant.

    Between the samples the surface is straight. Curvature of the roller must have been taken off.

    Parameters
    ----------
    x :
        (n,) places [mm], increasing, in the frame of the nip: 0 on the line of centres, positive
        towards the leading edge; 2 to 262144 of them, at equal distances or not.
    height :
        (n,) heights [mm], positive out of the roller: towards the other one.

    Raises
    ------
    InvalidInputError
        where lengths differ, samples are too few or too many, a value is not finite, or places do
        not increase.
    """

    x: NDArray[np.float64]
    height: NDArray[np.float64]

    def __init__(self, *, x: ArrayLike, height: ArrayLike) -> None:
        x, height = _samples("x", x), _samples("height", height)
        if x.size != height.size:
            raise InvalidInputError(
                f"`height` must have one value for each of the {x.size} places, got {height.size}."
            )
        if not 2 <= x.size <= _MOST_SAMPLES:
            raise InvalidInputError(
                f"`x` must hold 2 to {_MOST_SAMPLES} samples, got {x.size}; "
                "give the part around the nip, or every second sample."
            )
        wrong = np.flatnonzero(np.diff(x) <= 0.0)
        if wrong.size:
            raise InvalidInputError(
                f"`x` must increase from sample to sample, got {x[wrong[0]]:.9g} mm and then "
                f"{x[wrong[0] + 1]:.9g} mm."
            )
        object.__setattr__(self, "x", x)
        object.__setattr__(self, "height", height)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Profile):
            return NotImplemented
        return np.array_equal(self.x, other.x) and np.array_equal(self.height, other.height)

    def __hash__(self) -> int:
        return hash((self.x.tobytes(), self.height.tobytes()))

    def __repr__(self) -> str:
        # Whole problems are told apart by their texts: this one holds a digest of all samples.
        digest = sha256(self.x.tobytes() + self.height.tobytes()).hexdigest()[:16]
        return f"Profile({self.x.size} samples, {self.x[0]:.6g} to {self.x[-1]:.6g} mm, {digest})"

    def at(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """Heights at some places, (n,) [mm]; 0, the smooth surface, outside the samples."""
        slack = _ROUNDING * (self.x[-1] - self.x[0])
        inside = (x >= self.x[0] - slack) & (x <= self.x[-1] + slack)
        return np.where(inside, np.interp(x, self.x, self.height), 0.0)


@with_hints(
    diameter="give `radius`, half of the diameter.",
    layer="give `layers`, a list: [rn.Layer(2.0, rubber)].",
    material="give `layers`, a list: [rn.Layer(2.0, rubber)].",
)
@dataclass(frozen=True, slots=True, init=False)
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
    profile :
        None for a smooth surface, or its measured height over the smooth one.
    shaft :
        what carries the core along the face; it counts only for a `Face`.

    Raises
    ------
    InvalidInputError
        where the radius is not positive, the coating is not thinner than the radius, it leaves a
        rigid core of less than a thousandth of the radius, or a height of the profile is larger
        than the radius.
    """

    radius: float
    layers: tuple[Layer, ...] = ()
    core: Material | None = None
    profile: Profile | None = None
    shaft: Shaft | None = None

    def __init__(
        self,
        *,
        radius: float,
        layers: Sequence[Layer] = (),
        core: Material | None = None,
        profile: Profile | None = None,
        shaft: Shaft | None = None,
    ) -> None:
        object.__setattr__(self, "radius", _checked_radius(radius))
        if not isinstance(layers, Sequence) or isinstance(layers, str | bytes):
            raise InvalidInputError(f"`layers` must be a list of Layer objects, got {layers!r}.")
        object.__setattr__(self, "layers", tuple(layers))
        object.__setattr__(self, "core", core)
        object.__setattr__(self, "shaft", shaft)
        object.__setattr__(self, "profile", profile)
        self._check()

    def _check_profile(self) -> None:
        """Raise InvalidInputError where a height is larger than the radius."""
        if self.profile is None:
            return
        if not isinstance(self.profile, Profile):
            raise InvalidInputError(f"`profile` must be a Profile, got {self.profile!r}.")
        height = self.profile.height
        highest = int(np.argmax(np.abs(height)))
        if abs(height[highest]) > self.radius:
            raise InvalidInputError(
                "`profile` must have heights of at most the radius "
                f"{self.radius:g} mm, got {height[highest]:g} mm at x = "
                f"{self.profile.x[highest]:.6g} mm; are its heights in the right unit?"
            )

    def _check(self) -> None:
        """Raise InvalidInputError unless the parts make a roller."""
        for layer in self.layers:
            if not isinstance(layer, Layer):
                raise InvalidInputError(f"`layers` must hold Layer objects, got {layer!r}.")
        if self.core is not None:
            _require_material("core", self.core)
        self._check_profile()
        if self.shaft is not None and not isinstance(self.shaft, Shaft):
            raise InvalidInputError(f"`shaft` must be a Shaft, got {self.shaft!r}.")
        if self.coating_thickness >= self.radius:
            raise InvalidInputError(
                f"`layers` must be thinner in all than the radius {self.radius:g} mm, "
                f"got {self.coating_thickness:g} mm."
            )
        core, least = self.radius - self.coating_thickness, _LEAST_CORE * self.radius
        if self.layers and self.core is None and core < least:
            digits = (f"{core:.{count}g}" for count in range(3, 18))
            got = next(text for text in digits if float(text) < least)
            raise InvalidInputError(
                f"`layers` must leave a rigid core with a radius of at least {least:g} mm, a "
                f"thousandth of that of the roller, got {got} mm; give thinner layers."
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
    def core_weight(self) -> float:
        """Weight of the core per length [N/mm]; 0 where its shaft has no density."""
        if self.shaft is None or self.shaft.density is None or self.radius == inf:
            return 0.0
        core = 2.0 * (self.radius - self.coating_thickness)
        return _GRAVITY * self.shaft.density * pi / 4.0 * (core**2 - self.shaft.bore**2)

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


def shear_lags(roller: Roller) -> tuple[float, ...]:
    """Return the shear lag of each layer, from the surface down [mm].

    It is the length sqrt(E' h sum(t/G)) over which a layer of thickness h that is stretched passes
    its force on to the core, through the layers below, of thicknesses t. E' = E/(1 - nu^2) is that
    of its glassy modulus, G are their relaxed shear moduli. The lowest layer has none.
    """
    lags, below = [], 0.0
    for layer in reversed(roller.layers):
        material = layer.material
        stretched = material.glassy_modulus / (1.0 - material.poisson**2) * layer.thickness
        lags.append(sqrt(stretched * below))
        below += 2.0 * (1.0 + material.poisson) * layer.thickness / material.relaxed_modulus
    return tuple(reversed(lags))


def _checked_radius(radius: float) -> float:
    """A positive length [mm] as a float, or inf, a plane."""
    if isinstance(radius, float | np.floating) and radius == inf:
        return inf
    checked = require_positive("radius", radius)
    if checked > _LARGEST_LENGTH:
        raise InvalidInputError(
            f"`radius` must be at most 1e7 mm (or inf, a plane), got {radius!r}."
        )
    return checked


def _require_material(name: str, value: object) -> None:
    if not isinstance(value, Material):
        raise InvalidInputError(f"`{name}` must be a material such as Elastic, got {value!r}.")


def _samples(name: str, values: ArrayLike) -> NDArray[np.float64]:
    """A copy of finite numbers that cannot be changed."""
    try:
        out = np.array(values, dtype=float)
    except (TypeError, ValueError):
        raise InvalidInputError(f"`{name}` must hold numbers.") from None
    if out.ndim != 1:
        raise InvalidInputError(f"`{name}` must be one-dimensional, got the shape {out.shape}.")
    wrong = np.flatnonzero(~(np.abs(out) <= _LARGEST_LENGTH))
    if wrong.size:
        raise InvalidInputError(
            f"`{name}` must be finite and at most 1e7 mm in size everywhere, got {out[wrong[0]]} "
            f"as sample {wrong[0] + 1}."
        )
    out.setflags(write=False)
    return out
