"""What varies along the face of a roller: its diameter, and its covering."""

from __future__ import annotations

from dataclasses import dataclass
from hashlib import sha256
from math import cos, radians
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rollnip._errors import InvalidInputError, require_finite

__all__ = ["CoveringTable", "Crown", "CrownTable"]

Array = NDArray[np.float64]
Shape = Literal["parabolic", "cosine", "circular"]

_COSINE = radians(70.0)  # half the angle of the cosine that grinders use


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
        y = _places(self.y)
        object.__setattr__(self, "y", y)
        object.__setattr__(self, "diameter", _along("diameter", self.diameter, y))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, CrownTable):
            return NotImplemented
        return np.array_equal(self.y, other.y) and np.array_equal(self.diameter, other.diameter)

    def __hash__(self) -> int:
        return hash((np.asarray(self.y).tobytes(), np.asarray(self.diameter).tobytes()))

    def __repr__(self) -> str:
        return _digest("CrownTable", np.asarray(self.y), np.asarray(self.diameter))

    def radial(self, y: Array, length: float) -> Array:
        """Return the radius at ``y`` over the nominal one, (n,) [mm]; raise beyond the table."""
        _require_whole("crown", np.asarray(self.y), length)
        return np.asarray(0.5 * np.interp(y, np.asarray(self.y), np.asarray(self.diameter)))


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class CoveringTable:
    """The covering of a roller at places along its face: how thick and how stiff it is.

    The surface stays where radius and crown put it; below it the core begins where the covering
    ends. The outermost layer is meant: wear, grinding and hardening change that one.

    Parameters
    ----------
    y :
        (n,) increasing places from the middle of the face [mm], n >= 2.
    thickness :
        (n,) thickness of the outermost layer there [mm]; None: the same as in the nip.
    stiffness :
        (n,) its modulus over that of its material, all relaxation strengths in proportion; None: 1.
        Straight lines between, constant beyond.

    Raises
    ------
    InvalidInputError
        where lengths differ, a value is not positive, places do not increase, or neither
        thickness nor stiffness is given.
    """

    y: ArrayLike
    thickness: ArrayLike | None = None
    stiffness: ArrayLike | None = None

    def __post_init__(self) -> None:
        y = _places(self.y)
        object.__setattr__(self, "y", y)
        if self.thickness is None and self.stiffness is None:
            raise InvalidInputError("`covering` must hold thickness or stiffness, got neither.")
        for name in ("thickness", "stiffness"):
            given = getattr(self, name)
            if given is not None:
                values = _along(name, given, y)
                if values.min() <= 0.0:
                    raise InvalidInputError(
                        f"`{name}` must be positive everywhere, got {values.min():g}."
                    )
                object.__setattr__(self, name, values)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, CoveringTable):
            return NotImplemented
        return repr(self) == repr(other)

    def __hash__(self) -> int:
        return hash(repr(self))

    def __repr__(self) -> str:
        nothing = np.zeros(0)
        columns = (
            nothing if v is None else np.asarray(v) for v in (self.thickness, self.stiffness)
        )
        return _digest("CoveringTable", np.asarray(self.y), *columns)

    def at(self, name: Literal["thickness", "stiffness"], y: Array, length: float) -> Array | None:
        """Return thickness [mm] or stiffness at ``y``, (n,); None where not given.

        Raises InvalidInputError where the table does not cover the face.
        """
        given = getattr(self, name)
        if given is None:
            return None
        _require_whole("covering", np.asarray(self.y), length)
        return np.asarray(np.interp(y, np.asarray(self.y), np.asarray(given)))


def _places(values: ArrayLike) -> Array:
    """Return places along the face as a row that increases."""
    y = _row("y", values)
    if y.size < 2:
        raise InvalidInputError(f"`y` must hold at least 2 places, got {y.size}.")
    if np.any(np.diff(y) <= 0.0):
        raise InvalidInputError("`y` must increase from place to place.")
    return y


def _along(name: str, values: ArrayLike, y: Array) -> Array:
    """Return a row with one value for each place."""
    row = _row(name, values)
    if row.size != y.size:
        raise InvalidInputError(
            f"`{name}` must have one value for each of the {y.size} places, got {row.size}."
        )
    return row


def _require_whole(name: str, places: Array, length: float) -> None:
    """Raise unless a table goes from one end of the face to the other."""
    slack = 1e-6 * length
    if places[0] > -0.5 * length + slack or places[-1] < 0.5 * length - slack:
        raise InvalidInputError(
            f"`{name}` must cover the whole face, from {-0.5 * length:g} to {0.5 * length:g} "
            f"mm; its table goes from {places[0]:g} to {places[-1]:g} mm."
        )


def _digest(name: str, y: Array, *columns: Array) -> str:
    """Return a digest of a table: problems are compared by their texts, which hold it."""
    sign = sha256(b"".join(part.tobytes() for part in (y, *columns))).hexdigest()[:16]
    return f"{name}({y.size} places, {y[0]:.6g} to {y[-1]:.6g} mm, {sign})"


def _row(name: str, values: ArrayLike) -> Array:
    out = np.array(values, dtype=float)
    if out.ndim != 1 or not np.all(np.isfinite(out)):
        raise InvalidInputError(f"`{name}` must be a list of finite numbers.")
    out.setflags(write=False)
    return out
