"""Values along an axis of a study: ranges, and joint samples of several ranges."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Range:
    """A range from start to stop in base units, with equal steps or, if "log", equal ratios."""

    start: float
    stop: float
    spacing: Literal["linear", "log"] = "linear"

    def __post_init__(self) -> None:
        if self.spacing == "log" and not (self.start > 0.0 and self.stop > 0.0):
            raise InvalidInputError(
                '`start` and `stop` must be positive where `spacing` is "log", '
                f"got {self.start:g} and {self.stop:g}."
            )
        if self.start == self.stop:
            raise InvalidInputError(f"`stop` must differ from `start`, got {self.stop:g} for both.")

    def steps(self, count: int) -> Array:
        """Return ``count`` values that include both ends, (count,)."""
        space = np.geomspace if self.spacing == "log" else np.linspace
        return np.asarray(space(self.start, self.stop, count), dtype=np.float64)

    def at(self, share: Array) -> Array:
        """Return the values at fractions between 0 and 1 of the range, of the same shape."""
        if self.spacing == "log":
            return np.asarray(self.start * (self.stop / self.start) ** share)
        return np.asarray(self.start + (self.stop - self.start) * share)


def samples(
    ranges: list[Range], method: Literal["latin-hypercube", "sobol"], count: int, seed: int
) -> tuple[Array, ...]:
    """Sample all ranges jointly; the same seed gives the same samples.

    Parameters
    ----------
    ranges :
        one for each parameter.
    method :
        "latin-hypercube", or "sobol" (scrambled), which needs a power of 2 as ``count``.
    count :
        number of samples.
    seed :
        seed of the random numbers.

    Returns
    -------
    The (count,) values of each range.

    Raises
    ------
    InvalidInputError
        where the method cannot use this count.
    """
    if count < 1:
        raise InvalidInputError(f"`count` must be 1 or more, got {count}.")
    if method == "sobol" and count & (count - 1):
        below = 1 << (count.bit_length() - 1)
        raise InvalidInputError(
            f'`count` must be a power of 2 where `method` is "sobol": {below} or {2 * below}, '
            f"got {count}."
        )
    from scipy.stats import qmc  # takes longer to import than everything else in a worker

    generator = np.random.default_rng(seed)
    sampler = qmc.Sobol if method == "sobol" else qmc.LatinHypercube
    shares = sampler(len(ranges), seed=generator).random(count)
    return tuple(one.at(shares[:, index]) for index, one in enumerate(ranges))
