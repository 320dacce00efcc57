"""Measurements along the surface of a roller: strains and velocities in one nip."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike

from rollnip._errors import InvalidInputError
from rollnip.identification.costs import Array, Measurements, check_roller
from rollnip.lda import SpeedProfile, VelocityProfile, compare
from rollnip.rollers import Side
from rollnip.solution import Solution


@dataclass(frozen=True, eq=False, kw_only=True)
class SurfaceMeasurements(Measurements):
    """Measurements at places along the surface of one roller, all in one nip.

    Parameters
    ----------
    roller :
        "upper" or "lower", the roller whose surface was measured.
    width :
        standard deviation of the averaging along x by the instrument [mm].
    at :
        single values only, since all places are in one nip.
    measured, standard_error, weight, name :
        see `Measurements`.
    """

    roller: Side = "upper"
    width: float = 0.0

    def __post_init__(self) -> None:
        check_roller(self.roller)
        super().__post_init__()

    @property
    def conditions(self) -> list[dict[str, Any]]:
        """The one nip, without changes."""
        return [dict(self.at)]

    def _check_conditions(self) -> None:
        for path, value in self.at.items():
            if isinstance(value, np.ndarray):
                raise InvalidInputError(
                    f"`{path}` must be a single value: all places are in one nip, got a list."
                )


@dataclass(frozen=True, eq=False, kw_only=True)
class Strains(SurfaceMeasurements):
    """Surface strains at places x [mm] in the frame of the nip (towards the leading edge).

    Parameters
    ----------
    x :
        (n,) places [mm].
    at, measured, standard_error, weight, name, roller, width :
        see `SurfaceMeasurements`.
    """

    quantity, unit = "surface strain", ""
    x: ArrayLike = field(default_factory=list)
    at: Any = field(default_factory=dict)

    def __post_init__(self) -> None:
        super().__post_init__()
        x = np.atleast_1d(np.asarray(self.x, dtype=float))
        if x.shape != self.values.shape or not np.all(np.isfinite(x)):
            raise InvalidInputError(
                f"`x` must hold one place for each of the {self.values.size} strains, got {x.size}."
            )
        object.__setattr__(self, "x", x)

    @property
    def abscissa(self) -> tuple[str, Array]:
        """The places."""
        return "x", np.asarray(self.x, dtype=float)

    def predict(self, solutions: Sequence[Solution]) -> Array:
        """Return the strain of the solution at the places.

        Raises InvalidInputError where a place lies outside the solution.
        """
        profiles = solutions[0].profiles
        strain = profiles.strain_upper if self.roller == "upper" else profiles.strain_lower
        curve = SpeedProfile(profiles.x, strain)
        x = np.asarray(self.x, dtype=float)
        curve.check_inside(x, self.width)
        return curve.averaged(x, self.width)


@dataclass(frozen=True, eq=False, kw_only=True)
class Velocities(SurfaceMeasurements):
    """A velocity profile by laser-Doppler anemometry; shift and roller speed are fitted with it.

    Parameters
    ----------
    profile :
        from `rollnip.lda.estimate_profile` or `rollnip.lda.profile_from_means`; its velocities and
        their standard errors are the measurements.
    at, weight, name, roller, width :
        see `SurfaceMeasurements`; ``measured`` and ``standard_error`` come from the profile.
    """

    quantity, unit = "surface velocity", "mm/s"
    nuisances: ClassVar[int] = 2
    profile: VelocityProfile
    at: Any = field(default_factory=dict)
    measured: ArrayLike = field(init=False, default=0.0)
    standard_error: ArrayLike | None = field(init=False, default=None)

    def __post_init__(self) -> None:
        object.__setattr__(self, "measured", self.profile.velocity)
        object.__setattr__(self, "standard_error", np.sqrt(self.profile.variance))
        super().__post_init__()

    def with_values(self, measured: ArrayLike) -> Self:
        """Return the same places with other measured velocities."""
        return replace(self, profile=replace(self.profile, velocity=np.asarray(measured, float)))

    @property
    def abscissa(self) -> tuple[str, Array]:
        """The measured places."""
        return "x", self.profile.x

    def predict(self, solutions: Sequence[Solution]) -> Array:
        """Return V (1 + strain) at the places, with shift and V by least squares.

        Raises InvalidInputError where the profile cannot be aligned with the solution.
        """
        found = compare(self.profile, solutions[0], side=self.roller, width=self.width)
        return found.speed.value * (1.0 + found.computed)
