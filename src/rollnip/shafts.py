"""Rollers along their face: the shaft that carries a core, and how a face is loaded."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf, pi, sqrt
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import (
    InvalidInputError,
    require_finite,
    require_not_negative,
    require_positive,
    with_hints,
)
from rollnip.crowns import CoveringTable, Crown, CrownTable

__all__ = [
    "LARGEST_SKEW",
    "STEEL",
    "CoveringTable",
    "Crown",
    "CrownTable",
    "Face",
    "JournalStep",
    "PivotArm",
    "Shaft",
    "bending_stiffness",
    "shear_stiffness",
    "skew_of_crown",
]

Array = NDArray[np.float64]
AnyCrown = Crown | CrownTable
Across = Literal["free", "one-speed"]
Ends = Literal["plane", "edge", "covering", "covering-upper", "covering-lower"]

_LONGEST = 1e7  # mm; beyond it a unit was mistaken
LARGEST_SKEW = 0.1
"""Largest angle between the axes [rad]; beyond, the gap is no parabola."""
STEEL = 206e3
"""Young's modulus of steel [MPa], the default of a shaft."""


@dataclass(frozen=True, slots=True)
class JournalStep:
    """A part of a journal of one diameter.

    Parameters
    ----------
    diameter : [mm].
    length : along the axis [mm]; inf, as far as the bearing, for the last one.
    """

    diameter: float
    length: float = inf

    def __post_init__(self) -> None:
        object.__setattr__(self, "diameter", require_positive("diameter", self.diameter))
        if self.length != inf:
            object.__setattr__(self, "length", require_positive("length", self.length))


@with_hints()
@dataclass(frozen=True, slots=True, kw_only=True)
class Shaft:
    """Shaft of a roller: a core over the face, journals to two bearings.

    The core is what is under the coverings: its diameter is 2 (radius - coverings).

    Parameters
    ----------
    bearing_distance :
        between the centres of the bearings [mm]; they hold the shaft without clamping it.
    bearing_middle :
        where the middle between the bearings lies, from the middle of the face [mm].
    bore :
        diameter of the hole through the core [mm]; 0 is solid.
    journal_diameter :
        between face and bearing [mm]; None: journals that do not bend.
    journals :
        steps of both journals instead, from the face to the bearing; the last goes on to the
        bearing.
    modulus, poisson :
        of core and journals; steel by default [MPa, 1].
    density :
        of core [kg/m3]; None where weight does not count.
    crown :
        Crown or CrownTable, or a height on the diameter [mm], parabolic; 0 is straight.
    profiles :
        further changes of the diameter, which add to the crown: wear, thermal growth.
    covering :
        thickness and stiffness of the covering over the face; None: the same everywhere.

    Raises
    ------
    InvalidInputError
        where a value lies outside its range.
    """

    bearing_distance: float
    bearing_middle: float = 0.0
    bore: float = 0.0
    journal_diameter: float | None = None
    journals: tuple[JournalStep, ...] = ()
    modulus: float = STEEL
    poisson: float = 0.3
    density: float | None = None
    crown: AnyCrown | float = 0.0
    profiles: tuple[AnyCrown, ...] = ()
    covering: CoveringTable | None = None

    def __post_init__(self) -> None:
        for name in ("bearing_distance", "modulus"):
            object.__setattr__(self, name, require_positive(name, getattr(self, name)))
        if self.bearing_distance > _LONGEST:
            raise InvalidInputError(
                f"`bearing_distance` must be at most 1e7 mm, got {self.bearing_distance!r}."
            )
        object.__setattr__(self, "bore", require_not_negative("bore", self.bore))
        middle = require_finite("bearing_middle", self.bearing_middle)
        object.__setattr__(self, "bearing_middle", middle)
        for name in ("journal_diameter", "density"):
            value = getattr(self, name)
            if value is not None:
                object.__setattr__(self, name, require_positive(name, value))
        poisson = require_finite("poisson", self.poisson)
        if not -1.0 < poisson <= 0.5:
            raise InvalidInputError(f"`poisson` must lie in (-1, 0.5], got {poisson!r}.")
        object.__setattr__(self, "poisson", poisson)
        if not isinstance(self.crown, Crown | CrownTable):
            object.__setattr__(self, "crown", Crown(require_finite("crown", self.crown)))
        if self.covering is not None and not isinstance(self.covering, CoveringTable):
            raise InvalidInputError(f"`covering` must be a CoveringTable, got {self.covering!r}.")
        object.__setattr__(self, "profiles", _all_of("profiles", self.profiles, Crown, CrownTable))
        object.__setattr__(self, "journals", _all_of("journals", self.journals, JournalStep))
        if self.journals and self.journal_diameter is not None:
            raise InvalidInputError("`journals` must be left out beside `journal_diameter`.")

    @property
    def journal_steps(self) -> tuple[JournalStep, ...]:
        """Steps of a journal from the face to the bearing; none: it does not bend."""
        if self.journal_diameter is not None:
            return (JournalStep(self.journal_diameter),)
        return self.journals

    @property
    def bearings(self) -> tuple[float, float]:
        """Places of the two bearings along the face, from its middle [mm]."""
        half = 0.5 * self.bearing_distance
        return self.bearing_middle - half, self.bearing_middle + half

    def radial_crown(self, y: Array, length: float) -> Array:
        """Return the radius at ``y`` over the nominal one, all profiles together, (n,) [mm]."""
        assert isinstance(self.crown, Crown | CrownTable)
        parts = [one.radial(y, length) for one in (self.crown, *self.profiles)]
        return np.asarray(np.sum(parts, axis=0))


@dataclass(frozen=True, slots=True)
class PivotArm:
    """An arm on a pivot that presses one bearing of the upper roller onto the lower roller.

    Parameters
    ----------
    bearing_lever :
        distance of the line through the bearing, along which the nip is pressed, from the
        pivot [mm].
    forces :
        pairs of a force [N] and the distance of its line from the pivot [mm]: dead weights, the
        arm's own weight, a cylinder. A force that lifts the roller is negative.
    """

    bearing_lever: float
    forces: tuple[tuple[float, float], ...]

    def __post_init__(self) -> None:
        lever = require_positive("bearing_lever", self.bearing_lever)
        object.__setattr__(self, "bearing_lever", lever)
        forces = tuple(self.forces)
        if not forces:
            raise InvalidInputError("`forces` must hold at least one force and its lever.")
        checked = tuple(
            (require_finite("force", force), require_not_negative("lever", lever))
            for force, lever in forces
        )
        object.__setattr__(self, "forces", checked)

    @property
    def end_load(self) -> float:
        """Force on the bearing towards the lower roller [N]: moments about the pivot vanish."""
        return sum(force * lever for force, lever in self.forces) / self.bearing_lever


@with_hints()
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
        [N]; None: the nip's own control holds, its mean load or its approach in the middle.
    bearing_offset :
        how much further the upper roller's bearing at y > 0 comes towards the lower roller than
        the one at y < 0 [mm]; with the nip's mean load or approach. None: with a mean load both
        bearings of the upper roller carry the same, with an approach it is 0.
    nip_angle :
        angle of the line from the lower to the upper axis against the vertical [rad]; 0: the
        upper roller lies on the lower one. It counts only where a shaft has a density.
    sheet_across :
        how a sheet in the nip runs: "free", each part of its width at its own speed under the
        tensions given, or "one-speed", as a web that holds together, with the tension at the
        inlet that this asks for at each place and a mean that is given.
    ends :
        "plane": the nip is plane up to both ends of the face; "edge": there the face of one roller
        ends on the longer covering of the other, which carries more or less than in a plane nip;
        "covering": there every covering ends, free of stress, and rubber gives way sideways;
        "covering-upper" and "covering-lower": that roller's alone ends, the other one's goes on.
    end_radius :
        with which the shorter face is rounded at its ends [mm], at most half of the length; 0: a
        sharp edge.

    Raises
    ------
    InvalidInputError
        where a value lies outside its range, or end loads and an offset are given both.
    """

    length: float
    skew: float = 0.0
    end_loads: tuple[float, float] | None = None
    bearing_offset: float | None = None
    nip_angle: float = 0.0
    sheet_across: Across = "free"
    ends: Ends = "plane"
    end_radius: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "length", require_positive("length", self.length))
        object.__setattr__(self, "nip_angle", require_finite("nip_angle", self.nip_angle))
        skew = require_finite("skew", self.skew)
        if abs(skew) > LARGEST_SKEW:
            raise InvalidInputError(f"`skew` must lie between -0.1 and 0.1 rad, got {self.skew!r}.")
        object.__setattr__(self, "skew", skew)
        if self.end_loads is not None:
            object.__setattr__(self, "end_loads", _checked_ends(self.end_loads))
        if self.bearing_offset is not None:
            if self.end_loads is not None:
                raise InvalidInputError(
                    "`bearing_offset` must be left out beside `end_loads`, from which it follows."
                )
            offset = require_finite("bearing_offset", self.bearing_offset)
            object.__setattr__(self, "bearing_offset", offset)
        object.__setattr__(self, "end_radius", require_not_negative("end_radius", self.end_radius))
        if self.ends not in get_args(Ends):
            *first, last = (f'"{one}"' for one in get_args(Ends))
            raise InvalidInputError(
                f'`ends` must be {", ".join(first)} or {last}, got "{self.ends}".'
            )
        if self.ends != "edge" and self.end_radius > 0.0:
            raise InvalidInputError('`end_radius` needs `ends` = "edge".')
        if self.end_radius > 0.5 * self.length:
            raise InvalidInputError(
                f"`end_radius` must be at most half of the length of the face, "
                f"{0.5 * self.length:g} mm, got {self.end_radius:g} mm."
            )
        if self.sheet_across not in ("free", "one-speed"):
            raise InvalidInputError(
                f'`sheet_across` must be "free" or "one-speed", got "{self.sheet_across}".'
            )


def _all_of(name: str, values: object, *kinds: type) -> tuple[object, ...]:
    """Return a tuple of objects of some kinds."""
    if not isinstance(values, Sequence) or not all(isinstance(one, kinds) for one in values):
        wanted = " or ".join(kind.__name__ for kind in kinds)
        raise InvalidInputError(f"`{name}` must be a list of {wanted} objects, got {values!r}.")
    return tuple(values)


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
