"""Time-temperature superposition: every relaxation time scales with one factor a_T."""

from __future__ import annotations

from dataclasses import dataclass
from math import log

from rollnip._errors import InvalidInputError, require_finite, require_positive

_ABSOLUTE_ZERO = -273.15  # degC
_GAS_CONSTANT = 8.31446261815324e-3  # kJ/(mol K), exact since 2019
_LARGEST_EXPONENT = 100.0  # of ten; beyond it the law is used far outside its range


@dataclass(frozen=True, slots=True)
class WLF:
    """Williams-Landel-Ferry shift: log10 a_T = -c1 (T - T_ref)/(c2 + T - T_ref).

    Meant for temperatures between the glass transition and about 100 K above it.

    Parameters
    ----------
    c1 :
        first constant, positive (17.44 with T_ref at the glass transition).
    c2 :
        second constant [K], positive (51.6 with T_ref at the glass transition).
    reference :
        T_ref [degC], the temperature the relaxation times were measured at.

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

    def __post_init__(self) -> None:
        for name in ("c1", "c2"):
            object.__setattr__(self, name, require_positive(name, getattr(self, name)))
        object.__setattr__(self, "reference", checked_temperature("reference", self.reference))

    def factor(self, temperature: float) -> float:
        """Shift factor a_T at ``temperature`` [degC]: tau(T) = a_T tau(T_ref).

        Raises InvalidInputError at or below the pole T_ref - c2 and where a_T leaves
        1e-100 to 1e100.
        """
        checked = checked_temperature("temperature", temperature)
        pole = self.reference - self.c2
        if checked <= pole:
            raise InvalidInputError(
                f"`temperature` must be above the pole of the WLF law, reference - c2 = "
                f"{pole:g} degC, got {temperature!r}."
            )
        difference = checked - self.reference
        return _power_of_ten(-self.c1 * difference / (checked - pole), temperature)


@dataclass(frozen=True, slots=True)
class Arrhenius:
    """Arrhenius shift: ln a_T = (E_a/R) (1/T - 1/T_ref), absolute temperatures.

    Parameters
    ----------
    activation_energy :
        E_a [kJ/mol], positive.
    reference :
        T_ref [degC], the temperature the relaxation times were measured at.

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

    def __post_init__(self) -> None:
        energy = require_positive("activation_energy", self.activation_energy)
        object.__setattr__(self, "activation_energy", energy)
        object.__setattr__(self, "reference", checked_temperature("reference", self.reference))

    def factor(self, temperature: float) -> float:
        """Shift factor a_T at ``temperature`` [degC]: tau(T) = a_T tau(T_ref).

        Raises InvalidInputError where a_T leaves 1e-100 to 1e100.
        """
        kelvin = checked_temperature("temperature", temperature) - _ABSOLUTE_ZERO
        reference = self.reference - _ABSOLUTE_ZERO
        difference = (reference - kelvin) / (reference * kelvin)
        exponent = self.activation_energy / _GAS_CONSTANT * difference
        return _power_of_ten(exponent / log(10.0), temperature)


def checked_temperature(name: str, value: float) -> float:
    """Return a temperature [degC], or raise InvalidInputError at or below absolute zero."""
    checked = require_finite(name, value)
    if checked <= _ABSOLUTE_ZERO:
        raise InvalidInputError(
            f"`{name}` must be above absolute zero, -273.15 degC, got {value!r}."
        )
    return checked


def _power_of_ten(exponent: float, temperature: float) -> float:
    if not abs(exponent) <= _LARGEST_EXPONENT:
        raise InvalidInputError(
            "`temperature` must keep the shift factor between 1e-100 and 1e100, "
            f"got {temperature!r} with a factor of 10^{exponent:.4g}."
        )
    return float(10.0**exponent)
