"""The problem in three dimensions: two rollers that touch in a patch, and what drives them."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import hypot, inf

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import (
    InvalidInputError,
    require_finite,
    require_friction,
    require_not_negative,
    require_positive,
    require_speed,
    with_hints,
)
from rollnip.nip import Approach, Creepage, require_approach
from rollnip.rollers import Profile, Roller

Array = NDArray[np.float64]

PATCH_TOLERANCE = 5e-3
"""Relative accuracy where none is wanted."""

_FREE = Creepage(0.0)
_LARGEST_LOAD = 1e12  # N; beyond it a unit was mistaken
_LARGEST_SLOPE = 0.999
"""An end radius is followed to where it is this steep, short of upright."""


@dataclass(frozen=True, slots=True)
class Force:
    """Prescribed force [N]; as a load it must be positive, as a traction it has a sign."""

    force: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "force", require_finite("force", self.force))


@with_hints(
    width="give `face`, the length of the face along the axis.",
    crown="give `radius`, of the crown across the rolling direction.",
)
@dataclass(frozen=True, slots=True, kw_only=True)
class Across:
    """Shape of a roller across the rolling direction, along its axis.

    Parameters
    ----------
    radius :
        of the crown in the middle of the face [mm], positive where convex, negative where hollow;
        ``inf`` is straight.
    face :
        length of the face [mm]; None: so long that it does not end.
    end_radius :
        with which the face is rounded at both ends [mm]; 0 is a sharp edge.
    profile :
        None, or measured heights over that shape, with y, the distance from the middle of the
        face, as its places.

    Raises
    ------
    InvalidInputError
        where a value lies outside its range, or an end radius has no face to end or is larger
        than half of it.
    """

    radius: float = inf
    face: float | None = None
    end_radius: float = 0.0
    profile: Profile | None = None

    def __post_init__(self) -> None:
        if self.radius != inf and require_finite("lateral_radius", self.radius) == 0.0:
            raise InvalidInputError("`lateral_radius` must not be 0; `inf` is straight.")
        object.__setattr__(self, "end_radius", require_not_negative("end_radius", self.end_radius))
        if self.face is not None:
            object.__setattr__(self, "face", require_positive("face", self.face))
        if self.end_radius > 0.0 and (self.face is None or self.end_radius > 0.5 * self.face):
            raise InvalidInputError(
                f"`end_radius` must have a `face` at least twice as long, got {self.end_radius!r} "
                f"with `face` {self.face!r}."
            )

    @property
    def curvature(self) -> float:
        """1/radius [1/mm]; 0 where straight."""
        return 1.0 / self.radius

    @property
    def half_face(self) -> float:
        """Half the length of the face [mm]; inf where it does not end."""
        return inf if self.face is None else 0.5 * self.face

    def depth(self, y: Array) -> Array:
        """Return how far the surface lies below its highest line, (n,) [mm]; inf beyond the face.

        Parameters
        ----------
        y : (n,) distances from the middle of the face [mm].
        """
        depth = 0.5 * self.curvature * y**2
        if self.profile is not None:
            depth = depth - self.profile.at(y)
        if self.face is None:
            return np.asarray(depth)
        into = np.maximum(np.abs(y) - (self.half_face - self.end_radius), 0.0)
        if self.end_radius > 0.0:
            share = np.minimum(into / self.end_radius, _LARGEST_SLOPE)
            depth = depth + self.end_radius * (1.0 - np.sqrt(1.0 - share**2))
            return np.where(into < _LARGEST_SLOPE * self.end_radius, depth, inf)
        return np.where(into <= 0.0, depth, inf)


@with_hints(
    load="give `normal=rn.Force(500)`.",
    force="give `normal=rn.Force(500)`.",
    approach="give `normal=rn.Approach(0.3)`.",
    creepage="give `along=rn.Creepage(0.01)`.",
    traction="give `along=rn.Force(20)`.",
    lateral_radius="give `across_upper=rn.Across(radius=200)`.",
    tolerance="it belongs to the call: `rn.solve_patch(patch, tolerance=...)`.",
)
@dataclass(frozen=True, slots=True, kw_only=True)
class Patch:
    """Two rollers that are pressed together, touch in a patch and roll steadily.

    x points to the leading edge, y along the axes. Shear acts on the upper roller along +x and +y;
    creepages are positive where the upper roller drives.

    Parameters
    ----------
    upper, lower :
        the rollers, elastic or viscoelastic; layers count as flat.
    normal :
        Force [N] that presses, or Approach.
    friction :
        Coulomb coefficient mu >= 0; 0 is frictionless.
    along, across :
        Creepage, or Force [N] on the upper roller, along x and along y; free rolling by default.
    spin :
        rolling with spin: relative rotation about the normal per length rolled [1/mm]. The rigid
        creepage at (x, y) is (along - spin y, across + spin x).
    across_upper, across_lower :
        shapes of the rollers along y.
    speed :
        rolling speed [mm/s], positive, at most 1e11; needed where a material is viscoelastic.
        None: no powers.
    title :
        free text, carried into the result.

    Raises
    ------
    InvalidInputError
        where a value lies outside its range, or the parts do not touch in a patch.
    """

    upper: Roller
    lower: Roller
    normal: Force | Approach
    friction: float
    along: Creepage | Force = Force(0.0)
    across: Creepage | Force = _FREE
    spin: float = 0.0
    across_upper: Across = field(default_factory=Across)
    across_lower: Across = field(default_factory=Across)
    speed: float | None = None
    title: str = ""

    def __post_init__(self) -> None:
        self._check_types()
        object.__setattr__(self, "friction", require_friction("friction", self.friction))
        object.__setattr__(self, "spin", require_finite("spin", self.spin))
        if self.speed is not None:
            object.__setattr__(self, "speed", require_speed("speed", self.speed))
        self._check_rollers()
        self._check_forces()

    @property
    def is_viscoelastic(self) -> bool:
        """True where any material is viscoelastic."""
        return self.upper.is_viscoelastic or self.lower.is_viscoelastic

    @property
    def curvature(self) -> float:
        """1/R_upper + 1/R_lower along x [1/mm]."""
        return self.upper.curvature + self.lower.curvature

    @property
    def curvature_across(self) -> float:
        """Sum of the curvatures of both crowns [1/mm]."""
        return self.across_upper.curvature + self.across_lower.curvature

    @property
    def half_face(self) -> float:
        """Half the length over which both faces run [mm]; inf where neither ends."""
        return min(self.across_upper.half_face, self.across_lower.half_face)

    def clearance(self, x: Array, y: Array) -> Array:
        """Return the gap of the undeformed surfaces in touch, (ny, nx) [mm]; inf beyond a face."""
        across = self.across_upper.depth(y) + self.across_lower.depth(y)
        return np.asarray(across[:, None] + 0.5 * self.curvature * x[None, :] ** 2)

    def _check_types(self) -> None:
        wanted: dict[str, tuple[type, ...]] = {
            "upper": (Roller,),
            "lower": (Roller,),
            "normal": (Force, Approach),
            "along": (Creepage, Force),
            "across": (Creepage, Force),
            "across_upper": (Across,),
            "across_lower": (Across,),
        }
        for name, types in wanted.items():
            value = getattr(self, name)
            if not isinstance(value, types):
                names = " or ".join(kind.__name__ for kind in types)
                raise InvalidInputError(f"`{name}` must be {names}, got {value!r}.")

    def _check_rollers(self) -> None:
        for roller in (self.upper, self.lower):
            if roller.profile is not None:
                raise InvalidInputError(
                    "`profile` along x cannot be part of a patch; a profile along y belongs to "
                    "`across_upper` or `across_lower`."
                )
        if self.is_viscoelastic and self.speed is None:
            raise InvalidInputError("`speed` must be given where a material is viscoelastic.")
        if self.upper.is_rigid and self.lower.is_rigid:
            raise InvalidInputError(
                "`upper` and `lower` must not both be bare rigid cores: nothing would deform."
            )
        if self.curvature == 0.0:
            raise InvalidInputError(
                "`radius` must be finite for at least one roller, got two planes."
            )
        if self.curvature_across < 0.0 or (self.curvature_across == 0.0 and self.half_face == inf):
            raise InvalidInputError(
                "`lateral_radius` or `face` must bound the patch along the axes: the crowns must "
                f"touch in the middle, got the sum of curvatures {self.curvature_across:g} 1/mm."
            )

    def _check_forces(self) -> None:
        if isinstance(self.normal, Force):
            if require_positive("load", self.normal.force) > _LARGEST_LOAD:
                raise InvalidInputError(
                    f"`load` must be at most 1e12 N, got {self.normal.force:g} N."
                )
        else:
            require_approach(self.upper, self.lower, self.normal.approach)
        given = [f.force for f in (self.along, self.across) if isinstance(f, Force)]
        size = hypot(*given) if given else 0.0
        if self.friction == 0.0 and size > 0.0:
            raise InvalidInputError(f"`force` must be 0 without friction, got {size:g} N.")
        if isinstance(self.normal, Force) and size > 0.0:
            limit = self.friction * self.normal.force
            if size >= limit:
                raise InvalidInputError(
                    f"`force` along the surface must be smaller than friction * load = {limit:.6g} "
                    f"N (beyond it the patch slides), got {size:.6g} N."
                )
