"""Time-temperature superposition: relaxation times scale with a_T, moduli with b_T.

E*(s, T) = b_T E*(a_T s, T_ref). The vertical shift b_T is 1 unless a law says otherwise.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise
from math import exp, log
from typing import Literal, cast

from rollnip._errors import InvalidInputError, require_finite, require_positive

Points = tuple[tuple[float, float], ...]
Vertical = Literal["none", "entropic"] | Points

_ABSOLUTE_ZERO = -273.15  # degC
_HOTTEST = 1e4  # degC, far above where any material is solid
_GAS_CONSTANT = 8.31446261815324e-3  # kJ/(mol K), exact since 2019
_LARGEST_EXPONENT = 100.0  # of ten; above it the law is used far outside its range


@dataclass(frozen=True, slots=True)
class WLF:
    """Williams-Landel-Ferry shift: log10 a_T = -c1 (T - T_ref)/(c2 + T - T_ref).

    Intended for temperatures between the glass transition and about 100 K above it.

    Parameters
    ----------
    c1 :
        first constant, positive (17.44 with T_ref at the glass transition).
    c2 :
        second constant [K], positive (51.6 with T_ref at the glass transition).
    reference :
        T_ref [degC], the temperature at which the relaxation times were measured.
    vertical :
        the shift b_T of the moduli: "none"; "entropic", b_T = T/T_ref in kelvin; or a table of
        pairs (temperature [degC], b_T).

    Raises
    ------
    InvalidInputError
        where a parameter lies outside its range.

    References
    ----------
    Williams, Landel & Ferry (1955), J. Am. Chem. Soc. 77, 3701-3707.
    """

    c1: float
    c2: float
    reference: float
    vertical: Vertical = "none"

    def __post_init__(self) -> None:
        for name in ("c1", "c2"):
            object.__setattr__(self, name, require_positive(name, getattr(self, name)))
        object.__setattr__(self, "reference", checked_temperature("reference", self.reference))
        object.__setattr__(self, "vertical", _checked_vertical(self.vertical, self.reference))

    def factor(self, temperature: float) -> float:
        """Return the shift factor a_T at ``temperature`` [degC]: tau(T) = a_T tau(T_ref).

        Raises InvalidInputError at or below the pole T_ref - c2, and where a_T leaves 1e-100 to
        1e100.
        """
        checked = checked_temperature("temperature", temperature)
        pole = self.reference - self.c2
        if checked <= pole:
            raise InvalidInputError(
                f"`temperature` must be above the pole of the WLF law, reference - c2 = "
                f"{pole:g} degC, got {checked:.10g}."
            )
        difference = checked - self.reference
        return _power_of_ten(-self.c1 * difference / (checked - pole), temperature)

    def level(self, temperature: float) -> float:
        """Return b_T at ``temperature`` [degC], by which E(T) = b_T E(T_ref) at equal a_T s."""
        return _level(self.vertical, self.reference, temperature)


@dataclass(frozen=True, slots=True)
class Arrhenius:
    """Arrhenius shift: ln a_T = (E_a/R) (1/T - 1/T_ref), absolute temperatures.

    Parameters
    ----------
    activation_energy :
        E_a [kJ/mol], positive.
    reference :
        T_ref [degC], the temperature at which the relaxation times were measured.
    vertical :
        the shift b_T of the moduli, see `WLF`.

    Raises
    ------
    InvalidInputError
        where a parameter lies outside its range.

    References
    ----------
    Ferry (1980), Viscoelastic Properties of Polymers, 3rd ed., chapter 11.
    """

    activation_energy: float
    reference: float
    vertical: Vertical = "none"

    def __post_init__(self) -> None:
        energy = require_positive("activation_energy", self.activation_energy)
        object.__setattr__(self, "activation_energy", energy)
        object.__setattr__(self, "reference", checked_temperature("reference", self.reference))
        object.__setattr__(self, "vertical", _checked_vertical(self.vertical, self.reference))

    def factor(self, temperature: float) -> float:
        """Return the shift factor a_T at ``temperature`` [degC]: tau(T) = a_T tau(T_ref).

        Raises InvalidInputError where a_T leaves 1e-100 to 1e100.
        """
        kelvin = checked_temperature("temperature", temperature) - _ABSOLUTE_ZERO
        reference = self.reference - _ABSOLUTE_ZERO
        difference = (reference - kelvin) / (reference * kelvin)
        exponent = self.activation_energy / _GAS_CONSTANT * difference
        return _power_of_ten(exponent / log(10.0), temperature)

    def level(self, temperature: float) -> float:
        """Return b_T at ``temperature`` [degC], by which E(T) = b_T E(T_ref) at equal a_T s."""
        return _level(self.vertical, self.reference, temperature)


@dataclass(frozen=True, slots=True)
class TabulatedShift:
    """Shift factors measured at given temperatures; ln a_T is linear in T between them.

    Only ratios are used: a_T is divided by its value at the reference, so that the table may refer
    to any temperature.

    Parameters
    ----------
    points :
        pairs (temperature [degC], a_T), two or more; a_T positive and falling with temperature.
    reference :
        T_ref [degC], the temperature at which the relaxation times were measured; within the table.
    vertical :
        the shift b_T of the moduli, see `WLF`.

    Raises
    ------
    InvalidInputError
        where a parameter lies outside its range.
    """

    points: Points
    reference: float
    vertical: Vertical = "none"

    def __post_init__(self) -> None:
        points = _checked_points("points", self.points)
        for (cold, slow), (warm, fast) in pairwise(points):
            if fast > slow:
                raise InvalidInputError(
                    "`points` must hold factors that fall with temperature, got "
                    f"{slow:g} at {cold:g} degC and {fast:g} at {warm:g} degC."
                )
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "reference", checked_temperature("reference", self.reference))
        object.__setattr__(self, "vertical", _checked_vertical(self.vertical, self.reference))
        _interpolated("reference", points, self.reference)

    def factor(self, temperature: float) -> float:
        """Return the shift factor a_T at ``temperature`` [degC]: tau(T) = a_T tau(T_ref).

        Raises InvalidInputError outside the table, and where a_T leaves 1e-100 to 1e100.
        """
        checked = checked_temperature("temperature", temperature)
        here = _interpolated("temperature", self.points, checked)
        there = _interpolated("reference", self.points, self.reference)
        return _power_of_ten((here - there) / log(10.0), temperature)

    def level(self, temperature: float) -> float:
        """Return b_T at ``temperature`` [degC], by which E(T) = b_T E(T_ref) at equal a_T s."""
        return _level(self.vertical, self.reference, temperature)


Shift = WLF | Arrhenius | TabulatedShift


def _level(vertical: Vertical, reference: float, temperature: float) -> float:
    if vertical == "none":
        return 1.0
    checked = checked_temperature("temperature", temperature)
    if vertical == "entropic":
        return (checked - _ABSOLUTE_ZERO) / (reference - _ABSOLUTE_ZERO)
    here = _interpolated("temperature", vertical, checked)
    return exp(here - _interpolated("reference", vertical, reference))


def _interpolated(name: str, points: Points, temperature: float) -> float:
    """Return the logarithm of the value at a temperature, linear between the points."""
    if not points[0][0] <= temperature <= points[-1][0]:
        raise InvalidInputError(
            f"`{name}` must lie within the table of shifts, {points[0][0]:g} to "
            f"{points[-1][0]:g} degC, got {temperature!r}."
        )
    for (cold, low), (warm, high) in pairwise(points):
        if temperature <= warm:
            part = (temperature - cold) / (warm - cold)
            return (1.0 - part) * log(low) + part * log(high)
    return log(points[-1][1])


def _checked_vertical(vertical: object, reference: float) -> Vertical:
    if vertical in ("none", "entropic"):
        return cast("Vertical", vertical)
    if isinstance(vertical, str):
        raise InvalidInputError(
            f'`vertical` must be "none", "entropic" or a table of pairs, got "{vertical}".'
        )
    points = _checked_points("vertical", vertical)
    _interpolated("reference", points, reference)
    return points


def _checked_points(name: str, points: object) -> Points:
    """Return pairs (temperature, positive value), ordered by temperature."""
    try:
        pairs = [tuple(pair) for pair in cast("Iterable[Iterable[float]]", points)]
    except TypeError:
        raise InvalidInputError(
            f"`{name}` must hold pairs (temperature, factor), got {points!r}."
        ) from None
    if len(pairs) < 2 or any(len(pair) != 2 for pair in pairs):
        raise InvalidInputError(
            f"`{name}` must hold two or more pairs (temperature, factor), got {points!r}."
        )
    checked = sorted(
        (
            checked_temperature(f"{name}[{index}][0]", pair[0]),
            require_positive(f"{name}[{index}][1]", pair[1]),
        )
        for index, pair in enumerate(pairs)
    )
    twice = next((a[0] for a, b in pairwise(checked) if a[0] == b[0]), None)
    if twice is not None:
        raise InvalidInputError(f"`{name}` must hold each temperature once, got {twice!r} twice.")
    return tuple(checked)


def checked_temperature(name: str, value: float) -> float:
    """Return a temperature [degC]; raise InvalidInputError where no solid can have it."""
    checked = require_finite(name, value)
    if checked <= _ABSOLUTE_ZERO:
        raise InvalidInputError(
            f"`{name}` must be above absolute zero, -273.15 degC, got {value!r}."
        )
    if checked > _HOTTEST:
        raise InvalidInputError(f"`{name}` must be at most {_HOTTEST:g} degC, got {value!r}.")
    return checked


def _power_of_ten(exponent: float, temperature: float) -> float:
    if not abs(exponent) <= _LARGEST_EXPONENT:
        raise InvalidInputError(
            "`temperature` must keep the shift factor between 1e-100 and 1e100, "
            f"got {temperature!r} with a factor of 10^{exponent:.4g}."
        )
    return float(10.0**exponent)
