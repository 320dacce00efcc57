"""Rollers along their face: the shaft that carries a core, its crown, and how a face is loaded."""

from __future__ import annotations

from dataclasses import dataclass
from hashlib import sha256
from math import cos, pi, radians, sqrt
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rollnip._errors import (
    InvalidInputError,
    require_finite,
    require_not_negative,
    require_positive,
)

Array = NDArray[np.float64]
Shape = Literal["parabolic", "cosine", "circular"]

_LARGEST_SKEW = 0.1  # rad; the gap of crossed axes is then no parabola
_COSINE = radians(70.0)  # half the angle of the cosine that grinders use
STEEL = 206e3
"""Young's modulus of steel [MPa], the default of a shaft."""


@dataclass(frozen=True, slots=True)
class Crown:
    """A crown, measured on the diameter as drawings give it.

    Parameters
    ----------
    height :
        diameter in the middle less diameter at the ends [mm]; negative: a hollow (concave) roller.
    shape :
        "parabolic"; "cosine", of 70 degrees to either side, flatter in the middle by a little;
        "circular", an arc through the middle and both ends.

    Raises
    ------
    InvalidInputError
        where the height is not finite or the shape is not one of the three.
    """

    height: float
    shape: Shape = "parabolic"

    def __post_init__(self) -> None:
        object.__setattr__(self, "height", require_finite("crown", self.height))
        if self.shape not in ("parabolic", "cosine", "circular"):
            raise InvalidInputError(
                f'`shape` must be "parabolic", "cosine" or "circular", got {self.shape!r}.'
            )

    def radial(self, y: Array, length: float) -> Array:
        """Return the radius at ``y`` less the radius at the ends of the face, (n,) [mm].

        Parameters
        ----------
        y : (n,) places from the middle of the face [mm].
        length : of the face [mm].
        """
        share = np.asarray(2.0 * y / length)
        half = 0.5 * self.height
        if self.shape == "cosine":
            fall = (np.cos(_COSINE * share) - cos(_COSINE)) / (1.0 - cos(_COSINE))
            return np.asarray(half * fall)
        if self.shape == "circular" and half != 0.0:
            # Arc through (0, half) and (+-length/2, 0): radius of the arc from its rise.
            rise, reach = abs(half), 0.5 * length
            arc = (reach**2 + rise**2) / (2.0 * rise)
            depth = arc - np.sqrt(arc**2 - (share * reach) ** 2)
            return np.asarray(np.sign(half) * (rise - depth))
        return np.asarray(half * (1.0 - share**2))


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class CrownTable:
    """A measured or freely chosen crown: diameters at places along the face.

    Parameters
    ----------
    y :
        (n,) increasing places from the middle of the face [mm], n >= 2.
    diameter :
        (n,) diameter there over the nominal one [mm]; straight lines between, constant beyond.

    Raises
    ------
    InvalidInputError
        where lengths differ, a value is not finite, or places do not increase.
    """

    y: ArrayLike
    diameter: ArrayLike

    def __post_init__(self) -> None:
        y, diameter = (_row(name, getattr(self, name)) for name in ("y", "diameter"))
        if y.size != diameter.size or y.size < 2:
            raise InvalidInputError(
                f"`diameter` must have one value for each of at least 2 places, got {y.size} "
                f"places and {diameter.size} diameters."
            )
        if np.any(np.diff(y) <= 0.0):
            raise InvalidInputError("`y` must increase from place to place.")
        object.__setattr__(self, "y", y)
        object.__setattr__(self, "diameter", diameter)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, CrownTable):
            return NotImplemented
        return np.array_equal(self.y, other.y) and np.array_equal(self.diameter, other.diameter)

    def __hash__(self) -> int:
        return hash((np.asarray(self.y).tobytes(), np.asarray(self.diameter).tobytes()))

    def __repr__(self) -> str:
        # Whole problems are told apart by their texts: this one holds a digest of all places.
        y, diameter = np.asarray(self.y), np.asarray(self.diameter)
        digest = sha256(y.tobytes() + diameter.tobytes()).hexdigest()[:16]
        return f"CrownTable({y.size} places, {y[0]:.6g} to {y[-1]:.6g} mm, {digest})"

    def radial(self, y: Array, length: float) -> Array:
        """Return the radius at ``y`` over the nominal one, (n,) [mm]; raise beyond the table."""
        places = np.asarray(self.y)
        slack = 1e-6 * length
        if places[0] > -0.5 * length + slack or places[-1] < 0.5 * length - slack:
            raise InvalidInputError(
                f"`crown` must cover the whole face, from {-0.5 * length:g} to {0.5 * length:g} "
                f"mm; its table goes from {places[0]:g} to {places[-1]:g} mm."
            )
        return np.asarray(0.5 * np.interp(y, places, np.asarray(self.diameter)))


@dataclass(frozen=True, slots=True, kw_only=True)
class Shaft:
    """Shaft of a roller: a core over the face, journals to two bearings.

    The core is what is under the coverings: its diameter is 2 (radius - coverings).

    Parameters
    ----------
    bearing_distance :
        between the centres of the bearings [mm]; they hold the shaft without clamping it.
    bore :
        diameter of the hole through the core [mm]; 0 is solid.
    journal_diameter :
        between face and bearing [mm]; None: journals that do not bend.
    modulus, poisson :
        of core and journals; steel by default [MPa, 1].
    density :
        of core [kg/m3]; None where weight does not count.
    crown :
        Crown or CrownTable, or a height on the diameter [mm], parabolic; 0 is straight.

    Raises
    ------
    InvalidInputError
        where a value lies outside its range.
    """

    bearing_distance: float
    bore: float = 0.0
    journal_diameter: float | None = None
    modulus: float = STEEL
    poisson: float = 0.3
    density: float | None = None
    crown: Crown | CrownTable | float = 0.0

    def __post_init__(self) -> None:
        for name in ("bearing_distance", "modulus"):
            object.__setattr__(self, name, require_positive(name, getattr(self, name)))
        object.__setattr__(self, "bore", require_not_negative("bore", self.bore))
        for name in ("journal_diameter", "density"):
            value = getattr(self, name)
            if value is not None:
                object.__setattr__(self, name, require_positive(name, value))
        poisson = require_finite("poisson", self.poisson)
        if not -1.0 < poisson <= 0.5:
            raise InvalidInputError(f"`poisson` must lie in (-1, 0.5], got {self.poisson!r}.")
        object.__setattr__(self, "poisson", poisson)
        if not isinstance(self.crown, Crown | CrownTable):
            object.__setattr__(self, "crown", Crown(require_finite("crown", self.crown)))

    def radial_crown(self, y: Array, length: float) -> Array:
        """Return the radius at ``y`` over the nominal one, (n,) [mm]."""
        assert isinstance(self.crown, Crown | CrownTable)
        return self.crown.radial(y, length)


@dataclass(frozen=True, slots=True, kw_only=True)
class Face:
    """A nip along its rollers.

    Parameters
    ----------
    length :
        of the face, over which the rollers can touch [mm].
    skew :
        angle between the axes, in the plane of contact [rad].
    end_loads :
        forces on the bearings of the upper roller towards the lower one, at y < 0 and at y > 0
        [N]; None: the nip's own control holds, its load or its approach in the middle.
    nip_angle :
        angle of the line from the lower to the upper axis against the vertical [rad]; 0: the
        upper roller lies on the lower one. It counts only where a shaft has a density.

    Raises
    ------
    InvalidInputError
        where a value lies outside its range.
    """

    length: float
    skew: float = 0.0
    end_loads: tuple[float, float] | None = None
    nip_angle: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "length", require_positive("length", self.length))
        object.__setattr__(self, "nip_angle", require_finite("nip_angle", self.nip_angle))
        skew = require_finite("skew", self.skew)
        if abs(skew) > _LARGEST_SKEW:
            raise InvalidInputError(f"`skew` must lie between -0.1 and 0.1 rad, got {self.skew!r}.")
        object.__setattr__(self, "skew", skew)
        if self.end_loads is not None:
            object.__setattr__(self, "end_loads", _checked_ends(self.end_loads))


def _checked_ends(ends: tuple[float, float]) -> tuple[float, float]:
    if not isinstance(ends, tuple | list) or len(ends) != 2:
        raise InvalidInputError(f"`end_loads` must be two forces in N, got {ends!r}.")
    first, second = (require_finite("end_loads", value) for value in ends)
    if first + second <= 0.0:
        raise InvalidInputError(
            f"`end_loads` must press the rollers together, got {first:g} and {second:g} N."
        )
    return first, second


def bending_stiffness(outer: float, bore: float, modulus: float) -> float:
    """Return E I of a round tube [N mm2]; diameters in mm, modulus in MPa."""
    return modulus * pi / 64.0 * (outer**4 - bore**4)


def shear_stiffness(outer: float, bore: float, modulus: float, poisson: float) -> float:
    """Return kappa G A of a round tube [N]; kappa of Cowper (1966), J. Appl. Mech. 33, 335-340.

    With m = bore/outer: kappa = 6 (1 + nu)(1 + m^2)^2/[(7 + 6 nu)(1 + m^2)^2 + (20 + 12 nu) m^2].
    """
    m = bore / outer
    ring = (1.0 + m**2) ** 2
    kappa = 6.0 * (1.0 + poisson) * ring
    kappa /= (7.0 + 6.0 * poisson) * ring + (20.0 + 12.0 * poisson) * m**2
    area = pi / 4.0 * (outer**2 - bore**2)
    return kappa * modulus / (2.0 * (1.0 + poisson)) * area


def skew_of_crown(height: float, length: float, radii: tuple[float, float]) -> float:
    """Return the angle between the axes [rad] that opens the ends as a crown of ``height`` does.

    The gap of two crossed cylinders, (y theta)^2/(2 (R_u + R_l)), at the ends of the face is half
    of the crown on the diameter.
    """
    return 2.0 / length * sqrt(abs(height) * (radii[0] + radii[1]))


def _row(name: str, values: ArrayLike) -> Array:
    out = np.array(values, dtype=float)
    if out.ndim != 1 or not np.all(np.isfinite(out)):
        raise InvalidInputError(f"`{name}` must be a list of finite numbers.")
    out.setflags(write=False)
    return out
