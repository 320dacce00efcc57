"""Strain energies of rubber: how it stiffens with stretch, and how it resists volume change.

An energy is given in units of the shear modulus G of its material,

    psi/G = w(l1, l2, l3) - r ln J + U(J)/G,    J = l1 l2 l3,

where l are the principal stretches, and r is the slope of w at rest, so that the material at rest
is free of stress. Each w has the initial shear modulus 1: the constants of an energy describe only
the shape of a curve; modulus and Poisson ratio of the material describe the rest. lambda follows
from E and nu.

    U = lambda/2 (ln J)^2   ("log")    or    lambda/2 (J - 1)^2   ("square")

An incompressible material has J = 1 instead of U.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Literal, NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import InvalidInputError, require_finite, require_positive

Array = NDArray[np.float64]
Volumetric = Literal["log", "square"]

_LARGEST_EXPONENT = 100.0  # of a stretch; above it the material would be like a rigid wall
_NEAR = 1e-4  # t - 1 up to which a series is more accurate than the closed form


class Slopes(NamedTuple):
    """Derivatives of w with respect to I = l1^2 + l2^2 and J, in the plane with l3 = 1.

    Each has the shape of the input.
    """

    i: Array
    j: Array
    ii: Array
    ij: Array
    jj: Array


@dataclass(frozen=True)
class Energy(ABC):
    """Base class of the strain energies; frozen, hashable and comparable.

    Parameters
    ----------
    volumetric :
        law U of the volume change of a compressible material, "log" or "square". They agree for
        small changes; at a Poisson ratio of 0.3 a layer compressed by a third is a fifth stiffer
        with "log".
    """

    volumetric: Volumetric = field(default="log", kw_only=True)

    def __post_init__(self) -> None:
        if self.volumetric not in ("log", "square"):
            raise InvalidInputError(
                f'`volumetric` must be "log" or "square", got {self.volumetric!r}.'
            )

    @property
    def rest(self) -> float:
        """Slope of w with respect to each stretch at rest."""
        return 1.0

    @abstractmethod
    def slopes(self, volume: Array, spread: Array) -> Slopes:
        """Return the derivatives of w in plane strain; not finite where a stretch is impossible.

        Parameters
        ----------
        volume : J.
        spread : (l1 - l2)^2 = I - 2 J, which the caller knows without rounding.
        """

    @abstractmethod
    def principal(self, stretches: Array) -> Array:
        """Return dw/dl_i at principal stretches, both (3, ...); nan where one is impossible."""

    @abstractmethod
    def value(self, volume: Array, spread: Array) -> Array:
        """Return w in plane strain, as a function of J and the spread of stretches as in `slopes`.

        It is accurate even where it is as small as the square of a rounding error, so that it can
        be compared with the energy of linear theory.
        """

    def volume_measure(self, volume: Array) -> tuple[Array, Array, Array]:
        """Return m, m' and m'' at J, with U = lambda/2 m^2."""
        if self.volumetric == "square":
            return volume - 1.0, np.ones_like(volume), np.zeros_like(volume)
        return np.log(volume), 1.0 / volume, -1.0 / volume**2

    def volume_energy(self, volume: Array, lame: Array) -> Array:
        """Return U at J for a compressible material with lambda."""
        return np.asarray(0.5 * lame * self.volume_measure(volume)[0] ** 2)

    def volume_slopes(self, volume: Array, lame: Array) -> tuple[Array, Array]:
        """Return U' and U'' at J for a compressible material with lambda."""
        if self.volumetric == "square":
            return lame * (volume - 1.0), lame * np.ones_like(volume)
        log = np.log(volume)
        return lame * log / volume, lame * (1.0 - log) / volume**2


class _OfFirstInvariant(Energy):
    """An energy w = f(I1 - 3 - 2 ln J)/2 + ln J with f'(0) = 1.

    The argument has no term of first order in the strain. With I1 - 3 alone, a change of volume
    would meet the curvature of f, and 2 f''(0) G would be added to lambda at rest.
    """

    @abstractmethod
    def _by_excess(self, excess: Array) -> tuple[Array, Array]:
        """Return f' and f'' at I1 - 3 - 2 ln J."""

    @abstractmethod
    def _at(self, excess: Array) -> Array:
        """Return f at I1 - 3 - 2 ln J."""

    def value(self, volume: Array, spread: Array) -> Array:
        """Return w = f/2 + ln J."""
        log = np.log1p(volume - 1.0)
        return np.asarray(0.5 * self._at(spread + 2.0 * (volume - 1.0 - log)) + log)

    def slopes(self, volume: Array, spread: Array) -> Slopes:
        """Return the derivatives of w with respect to I and J in plane strain."""
        first, second = self._by_excess(spread + 2.0 * (volume - 1.0 - np.log(volume)))
        j = (1.0 - first) / volume
        jj = (2.0 * second - 1.0 + first) / volume**2
        return Slopes(0.5 * first, j, 0.5 * second, -second / volume, jj)

    def principal(self, stretches: Array) -> Array:
        """Return dw/dl_i = f' (l_i - 1/l_i) + 1/l_i."""
        log = np.log(np.prod(stretches, axis=0))
        first, _ = self._by_excess((stretches**2).sum(axis=0) - 3.0 - 2.0 * log)
        return np.asarray(first * (stretches - 1.0 / stretches) + 1.0 / stretches)


@dataclass(frozen=True)
class NeoHookean(_OfFirstInvariant):
    """w = (I1 - 3)/2: the stress in simple shear is proportional to the shear.

    Raises
    ------
    InvalidInputError
        where the law of volume change is unknown.
    """

    def _by_excess(self, excess: Array) -> tuple[Array, Array]:
        return np.ones_like(excess), np.zeros_like(excess)

    def _at(self, excess: Array) -> Array:
        return excess


@dataclass(frozen=True)
class Yeoh(_OfFirstInvariant):
    """2 w = I + b I^2 + c I^3 + 2 ln J with I = I1 - 3 - 2 ln J.

    Where the volume stays as it is, J = 1, this is the energy of Yeoh 1993, Rubber Chem. Technol.
    66, 754-771.

    Parameters
    ----------
    second, third :
        b = C20/C10 and c = C30/C10 of the usual constants; G = 2 C10.

    Raises
    ------
    InvalidInputError
        where a parameter is not finite, or the law of volume change is unknown.
    """

    second: float
    third: float = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        for name in ("second", "third"):
            object.__setattr__(self, name, require_finite(name, getattr(self, name)))

    def _by_excess(self, excess: Array) -> tuple[Array, Array]:
        b, c = self.second, self.third
        return 1.0 + 2.0 * b * excess + 3.0 * c * excess**2, 2.0 * b + 6.0 * c * excess

    def _at(self, excess: Array) -> Array:
        return np.asarray(excess * (1.0 + excess * (self.second + excess * self.third)))


@dataclass(frozen=True)
class Gent(_OfFirstInvariant):
    """2 w = -m ln(1 - I/m) + 2 ln J with I = I1 - 3 - 2 ln J: chains are fully extended at I = m.

    Gent 1996, Rubber Chem. Technol. 69, 59-61.

    Parameters
    ----------
    limit :
        m, the limit of I; positive.

    Raises
    ------
    InvalidInputError
        where the limit is not positive and finite, or the law of volume change is unknown.
    """

    limit: float

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "limit", require_positive("limit", self.limit))

    def _by_excess(self, excess: Array) -> tuple[Array, Array]:
        left = np.where(excess < self.limit, self.limit - excess, np.nan)
        return self.limit / left, self.limit / left**2

    def _at(self, excess: Array) -> Array:
        inside = np.where(excess < self.limit, excess, np.nan)
        return np.asarray(-self.limit * np.log1p(-inside / self.limit))


@dataclass(frozen=True)
class Ogden(Energy):
    """w = sum (m_n/a_n) (l1^a_n + l2^a_n + l3^a_n - 3), sum m_n a_n = 2.

    Ogden 1972, Proc. R. Soc. Lond. A 326, 565-584. A single term with a_n = 2 is neo-Hookean.

    Parameters
    ----------
    terms :
        pairs (mu_n, a_n) of the usual constants and exponents. Only the ratios of the mu_n are
        used, since G = sum mu_n a_n/2 is that of the material; this sum must be positive.

    Raises
    ------
    InvalidInputError
        where there is no term, a number is not finite, an exponent is 0 or beyond +-100, the sum of
        mu_n a_n is not positive, or the law of volume change is unknown.
    """

    terms: tuple[tuple[float, float], ...]

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "terms", _checked_terms(self.terms))

    @property
    def rest(self) -> float:
        """Sum of the m_n."""
        return sum(m for m, _ in self._scaled)

    @property
    def _scaled(self) -> list[tuple[float, float]]:
        total = sum(m * a for m, a in self.terms)
        return [(2.0 * m / total, a) for m, a in self.terms]

    def principal(self, stretches: Array) -> Array:
        """Return dw/dl_i = sum m_n l_i^(a_n - 1)."""
        return np.asarray(sum(m * stretches ** (a - 1.0) for m, a in self._scaled))

    def value(self, volume: Array, spread: Array) -> Array:
        """Return w, with J^n T_n(t) - 1 written as J^n (T_n(t) - 1) + (J^n - 1)."""
        angle, swell = _angle(spread / (2.0 * volume)), np.log1p(volume - 1.0)
        out = np.zeros_like(angle)
        for m, a in self._scaled:
            apart = 2.0 * np.exp(0.5 * a * swell) * np.sinh(0.25 * a * angle) ** 2
            out += 2.0 * m / a * (apart + np.expm1(0.5 * a * swell))
        return out

    def slopes(self, volume: Array, spread: Array) -> Slopes:
        """Return the derivatives of w by I and J in plane strain, also at equal stretches.

        With n = a/2 and t = I/(2 J) = cosh(ln(l1/l2)) a term is l1^a + l2^a = 2 J^n T_n(t). T_n is
        the Chebyshev function cosh(n arcosh t) of real order, which is smooth at t = 1.
        """
        excess = spread / (2.0 * volume)
        t = 1.0 + excess
        found = [np.zeros_like(t) for _ in Slopes._fields]
        for m, a in self._scaled:
            n = 0.5 * a
            value, first, second = _chebyshev(n, excess)
            bent = n * value - t * first  # 2 J^(n - 1) times this is the slope by J
            turned = (n - 1.0) * first - t * second
            scale = m / a * volume ** (n - 2.0)
            found[0] += scale * volume * first
            found[1] += 2.0 * scale * volume * bent
            found[2] += 0.5 * scale * second
            found[3] += scale * turned
            found[4] += 2.0 * scale * ((n - 1.0) * bent - t * turned)
        return Slopes(*found)


def _checked_terms(terms: object) -> tuple[tuple[float, float], ...]:
    try:
        pairs = [tuple(one) for one in cast(Iterable[Iterable[float]], terms)]
    except TypeError:
        raise InvalidInputError(f"`terms` must hold pairs of numbers, got {terms!r}.") from None
    if not pairs or any(len(one) != 2 for one in pairs):
        raise InvalidInputError(f"`terms` must hold one pair of numbers or more, got {terms!r}.")
    checked = []
    for place, (m, a) in enumerate(pairs):
        weight, exponent = (require_finite(f"terms[{place}]", one) for one in (m, a))
        if exponent == 0.0 or abs(exponent) > _LARGEST_EXPONENT:
            raise InvalidInputError(
                f"`terms[{place}]` must have an exponent from -100 to 100 and not 0, got {a!r}."
            )
        checked.append((weight, exponent))
    total = sum(m * a for m, a in checked)
    if not total > 0.0:
        raise InvalidInputError(
            "`terms` must have a positive sum of weights times exponents (twice the shear "
            f"modulus), got {total:g}."
        )
    return tuple(checked)


def _angle(excess: Array) -> Array:
    """Return arcosh(1 + excess), accurate where the excess is small."""
    return np.asarray(2.0 * np.arcsinh(np.sqrt(0.5 * excess)))


def _chebyshev(n: float, excess: Array) -> tuple[Array, Array, Array]:
    """Return T_n, T_n' and T_n'' at t = 1 + excess, excess >= 0.

    T'(1) = n^2, and from Chebyshev's equation (1 - t^2) T'' - t T' + n^2 T = 0 each further
    derivative at 1 is (n^2 - k^2)/(2 k + 1) times the one before.
    """
    angle = _angle(excess)
    near = excess <= _NEAR
    safe = np.where(near, 1.0, angle)
    sinh, cosh = np.sinh(safe), np.cosh(safe)
    value = np.cosh(n * angle)
    first = n * np.sinh(n * safe) / sinh
    second = (n * n * np.cosh(n * safe) - cosh * first) / sinh**2
    square = n * n
    at = [square]  # derivatives at 1
    for k in (1, 2, 3, 4):
        at.append(at[-1] * (square - k * k) / (2 * k + 1))
    slope = at[0] + excess * (at[1] + excess * (at[2] / 2.0 + excess * at[3] / 6.0))
    curve = at[1] + excess * (at[2] + excess * (at[3] / 2.0 + excess * at[4] / 6.0))
    return value, np.where(near, slope, first), np.where(near, curve, second)
