"""How rubber stiffens with stretch: strain energies that depend on I1 alone.

With I = I1 - 3 the energy is  W = G/2 w(I),  w'(0) = 1: at small strains G is the shear modulus.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from rollnip._errors import InvalidInputError, require_positive
from rollnip.finite.strip import Array


class Energy(Protocol):
    """A strain energy over half the shear modulus, as a function of I = I1 - 3."""

    def slopes(self, excess: Array) -> tuple[Array, Array]:
        """Return the first and the second derivative by I; nan where there is no such stretch."""
        ...


@dataclass(frozen=True)
class NeoHookean:
    """w = I: the stress in simple shear is in proportion to the shear."""

    def slopes(self, excess: Array) -> tuple[Array, Array]:
        """Return 1 and 0."""
        return np.ones_like(excess), np.zeros_like(excess)


@dataclass(frozen=True)
class Yeoh:
    """w = I + b I^2 + c I^3 (Yeoh 1993, Rubber Chem. Technol. 66, 754-771).

    Parameters
    ----------
    second, third :
        b = C20/C10 and c = C30/C10 of the usual constants; G = 2 C10.

    Raises
    ------
    InvalidInputError
        where a parameter is not finite.
    """

    second: float
    third: float

    def __post_init__(self) -> None:
        for name in ("second", "third"):
            if not np.isfinite(getattr(self, name)):
                raise InvalidInputError(f"`{name}` must be finite, got {getattr(self, name)!r}.")

    def slopes(self, excess: Array) -> tuple[Array, Array]:
        """Return 1 + 2 b I + 3 c I^2 and 2 b + 6 c I."""
        b, c = self.second, self.third
        return 1.0 + 2.0 * b * excess + 3.0 * c * excess**2, 2.0 * b + 6.0 * c * excess


@dataclass(frozen=True)
class Gent:
    """w = -m ln(1 - I/m): chains are straight at I = m.

    Gent 1996, Rubber Chem. Technol. 69, 59-61.

    Parameters
    ----------
    limit :
        m, the largest I1 - 3; positive.

    Raises
    ------
    InvalidInputError
        where the limit is not positive and finite.
    """

    limit: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "limit", require_positive("limit", self.limit))

    def slopes(self, excess: Array) -> tuple[Array, Array]:
        """Return m/(m - I) and m/(m - I)^2; nan from I = m on."""
        left = np.where(excess < self.limit, self.limit - excess, np.nan)
        return self.limit / left, self.limit / left**2
