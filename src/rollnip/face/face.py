"""The face of a nip: how long it is, how its rollers are loaded and set."""

from __future__ import annotations

from dataclasses import dataclass

from rollnip._errors import InvalidInputError, require_finite, require_positive

_LARGEST_SKEW = 0.1  # rad; the gap of crossed axes is then no parabola


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
