"""A velocity profile, and its average over the measuring volume."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr

from rollnip._errors import InvalidInputError

Array = NDArray[np.float64]

REACH = 5.0  # standard deviations, beyond which lie 6e-7 of the weight


@dataclass(frozen=True, slots=True)
class SpeedProfile:
    """Surface speed over x, linear between points; it may hold a strain instead.

    Attributes
    ----------
    x : (n,) increasing [mm], towards the leading edge.
    speed : (n,) in the direction of motion, -x [mm/s].
    """

    x: Array
    speed: Array

    def __post_init__(self) -> None:
        if self.x.ndim != 1 or self.x.size < 2 or self.x.shape != self.speed.shape:
            raise InvalidInputError("`x` and `speed` must be two lists of equal length, 2 or more.")
        if not np.all(np.diff(self.x) > 0.0):
            raise InvalidInputError("`x` must increase.")

    def at(self, x: Array) -> Array:
        """Return the speed at ``x``."""
        return np.asarray(np.interp(x, self.x, self.speed))

    def averaged(self, x: Array, width: float) -> Array:
        """Return the exact mean of the profile under a Gaussian around each of ``x``.

        With the kink k_j at x_j the profile is v_0 + slope_0 (x - x_0) + sum k_j max(x - x_j, 0).
        The mean of max(X, 0) over a Gaussian of mean m and standard deviation s is m Phi(m/s) + s
        phi(m/s). Beyond its ends the profile continues with its last slope.

        Parameters
        ----------
        x : (m,) centres [mm].
        width : standard deviation of the weight [mm]; 0: no averaging.

        Returns
        -------
        (m,) in the unit of the profile.
        """
        if width == 0.0:
            return self.at(x)
        slopes = np.diff(self.speed) / np.diff(self.x)
        kinks = np.diff(slopes)
        mean = (x[:, None] - self.x[None, 1:-1]) / width
        ramp = mean * ndtr(mean) + np.exp(-0.5 * mean**2) / np.sqrt(2.0 * np.pi)
        line = self.speed[0] + slopes[0] * (x - self.x[0])
        return np.asarray(line + width * (ramp @ kinks))

    def span(self, width: float) -> tuple[float, float]:
        """Return the interval of x whose measuring volume lies inside the profile [mm]."""
        return float(self.x[0] + REACH * width), float(self.x[-1] - REACH * width)

    def check_inside(self, x: Array, width: float) -> None:
        """Raise InvalidInputError where a place, with the volume around it, is not inside."""
        first, last = self.span(width)
        outside = x[(x < first) | (x > last)]
        if outside.size:
            raise InvalidInputError(
                f"`x` must lie inside the solution, between {first:.4g} and {last:.4g} mm, "
                f"got {outside[0]:.6g} mm."
            )
