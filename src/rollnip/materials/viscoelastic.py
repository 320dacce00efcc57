"""Viscoelastic materials: standard linear solid, Prony series, fractional Zener, loss factor."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rollnip._errors import InvalidInputError, require_not_negative, require_positive, with_hints
from rollnip.materials.base import (
    Material,
    checked_energy,
    checked_modulus,
    checked_poisson,
    checked_stiffening,
    checked_thermal,
    checked_time,
)
from rollnip.materials.energy import Energy
from rollnip.materials.shift import WLF, Arrhenius, Shift, TabulatedShift, checked_temperature
from rollnip.materials.thermal import Thermal

_FAR = 1e150  # |tau s| above which a Maxwell element is glassy to the last bit
_FAR_EXPONENT = 700.0  # exponent whose exp is still finite
_HINTS = with_hints(
    shore_a="a hardness gives an elastic modulus alone: `rn.Elastic.from_shore_a(60)`.",
    tau="give `relaxation_time`.",
    nu="give `poisson`.",
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Viscoelastic(Material):
    """Base class of the viscoelastic materials, with their Poisson ratio and temperature.

    Times and moduli are given at the reference temperature of ``shift``; at ``temperature`` times
    are longer by the factor a_T and moduli higher by the factor b_T. Give either both or neither.
    The Poisson ratio does not relax.

    Parameters
    ----------
    poisson :
        Poisson ratio, in (-1, 0.5].
    temperature :
        temperature of the material [degC].
    shift :
        its time-temperature shift.
    thermal :
        its thermal properties; used only for a `HeatBalance`.
    energy :
        strain energy of the relaxed material, such as `Yeoh`; None: `NeoHookean`. Its stress
        relaxes as the modulus does. It is used only in geometry "finite".
    """

    poisson: float
    temperature: float | None = None
    shift: Shift | None = None
    thermal: Thermal | None = field(default=None, repr=False)
    energy: Energy | None = None

    @property
    def is_elastic(self) -> bool:
        """False: the modulus depends on s."""
        return False

    @property
    def shift_factor(self) -> float:
        """a_T, the ratio of relaxation times to those at the reference; 1 without shift."""
        if self.shift is None or self.temperature is None:
            return 1.0
        return self.shift.factor(self.temperature)

    @property
    def level(self) -> float:
        """b_T, the ratio of moduli to those at the reference; 1 without shift."""
        if self.shift is None or self.temperature is None:
            return 1.0
        return self.shift.level(self.temperature)


@dataclass(frozen=True, slots=True, kw_only=True)
class _ZenerSolid(Viscoelastic):
    """A solid that relaxes from one modulus to another with one relaxation time."""

    modulus: float
    stiffening: float
    relaxation_time: float

    def __post_init__(self) -> None:
        _check_shared(self)
        object.__setattr__(self, "modulus", checked_modulus("modulus", self.modulus))
        stiffening = checked_stiffening("stiffening", self.stiffening)
        object.__setattr__(self, "stiffening", stiffening)
        time = checked_time("relaxation_time", self.relaxation_time)
        object.__setattr__(self, "relaxation_time", time)

    @property
    def relaxed_modulus(self) -> float:
        """E0 at the material's temperature [MPa]."""
        return self.level * self.modulus

    @property
    def glassy_modulus(self) -> float:
        """E0 + k at the material's temperature [MPa]."""
        return self.level * (self.modulus + self.stiffening)

    @property
    def relaxation_times(self) -> tuple[float, ...]:
        """The time tau [s] at the material's temperature."""
        return (self.shift_factor * self.relaxation_time,)


@_HINTS
@dataclass(frozen=True, slots=True, kw_only=True)
class StandardLinearSolid(_ZenerSolid):
    """The standard linear solid: sigma + tau dsigma/dt = E0 eps + (E0 + k) tau deps/dt.

    E*(s) = E0 + k tau s/(1 + tau s). Under constant strain the stress relaxes with the time tau;
    under constant stress the strain creeps with the time tau (E0 + k)/E0.

    Parameters
    ----------
    modulus :
        relaxed modulus E0 [MPa], from 1e-9 to 1e12.
    stiffening :
        k [MPa], >= 0: glassy modulus minus relaxed modulus.
    relaxation_time :
        tau [s], positive.
    poisson, temperature, shift, thermal, energy :
        see `Viscoelastic`.

    Raises
    ------
    InvalidInputError
        where a parameter lies outside its range, or only one of temperature and shift is given.

    References
    ----------
    Braat & Kalker (1993), Trans. Eng. Sci. 1, 119-126, eq. 1.
    """

    def modulus_at(self, s: ArrayLike) -> NDArray[np.complex128]:
        """Return E*(s) [MPa], a complex array of the shape of ``s`` [1/s]."""
        return np.asarray(
            self.level * (self.modulus + self.stiffening * _maxwell(s, self.relaxation_times[0]))
        )


@_HINTS
@dataclass(frozen=True, slots=True, kw_only=True)
class Prony(Viscoelastic):
    """A generalised Maxwell solid: E*(s) = E_inf + sum_i E_i tau_i s/(1 + tau_i s).

    Parameters
    ----------
    modulus :
        relaxed modulus E_inf [MPa], from 1e-9 to 1e12.
    terms :
        pairs (E_i [MPa], tau_i [s]), at least one; E_i >= 0, tau_i positive. Kept as a tuple.
    poisson, temperature, shift, thermal, energy :
        see `Viscoelastic`.

    Raises
    ------
    InvalidInputError
        where a parameter lies outside its range (a negative E_i is not passive), or only one of
        temperature and shift is given.

    References
    ----------
    Ferry (1980), Viscoelastic Properties of Polymers, 3rd ed., chapter 3.
    """

    modulus: float
    terms: Sequence[Sequence[float]]

    def __post_init__(self) -> None:
        _check_shared(self)
        object.__setattr__(self, "modulus", checked_modulus("modulus", self.modulus))
        object.__setattr__(self, "terms", _checked_terms(self.terms))

    def modulus_at(self, s: ArrayLike) -> NDArray[np.complex128]:
        """Return E*(s) [MPa], a complex array of the shape of ``s`` [1/s]."""
        total = np.full(np.shape(s), self.modulus, dtype=np.complex128)
        for (modulus, _), time in zip(self.terms, self.relaxation_times, strict=True):
            total = total + modulus * _maxwell(s, time)
        return np.asarray(self.level * total)

    @property
    def relaxed_modulus(self) -> float:
        """E_inf at the material's temperature [MPa]."""
        return self.level * self.modulus

    @property
    def glassy_modulus(self) -> float:
        """Sum of E_inf and all E_i at the material's temperature [MPa]."""
        return self.level * (self.modulus + sum(modulus for modulus, _ in self.terms))

    @property
    def relaxation_times(self) -> tuple[float, ...]:
        """The times tau_i [s] at the material's temperature, in the order of the terms."""
        factor = self.shift_factor
        return tuple(factor * time for _, time in self.terms)


@_HINTS
@dataclass(frozen=True, slots=True, kw_only=True)
class FractionalZener(_ZenerSolid):
    """The fractional Zener solid: E*(s) = E0 + k (tau s)^m/(1 + (tau s)^m), m the order.

    With m = 1 it is the standard linear solid; a smaller m spreads the loss over more decades.

    Parameters
    ----------
    modulus :
        relaxed modulus E0 [MPa], from 1e-9 to 1e12.
    stiffening :
        k [MPa], >= 0: glassy modulus minus relaxed modulus.
    relaxation_time :
        tau [s], positive.
    order :
        m, in (0, 1].
    poisson, temperature, shift, thermal, energy :
        see `Viscoelastic`.

    Raises
    ------
    InvalidInputError
        where a parameter lies outside its range, or only one of temperature and shift is given.

    References
    ----------
    Bagley & Torvik (1983), AIAA J. 21, 741-748.
    """

    order: float

    def __post_init__(self) -> None:
        _ZenerSolid.__post_init__(self)
        require_positive("order", self.order)
        if self.order > 1.0:
            raise InvalidInputError(f"`order` must lie in (0, 1], got {self.order!r}.")
        object.__setattr__(self, "order", float(self.order))

    def modulus_at(self, s: ArrayLike) -> NDArray[np.complex128]:
        """Return E*(s) [MPa], a complex array of the shape of ``s`` [1/s]."""
        fraction = _fractional_maxwell(s, self.relaxation_times[0], self.order)
        return np.asarray(self.level * (self.modulus + self.stiffening * fraction))


@_HINTS
@dataclass(frozen=True, slots=True, kw_only=True)
class LossFactor(Viscoelastic):
    """A constant loss factor: E* = E (1 + i eta sign(w)) at the frequency w, E at w = 0.

    It is not causal (a real material with constant loss stiffens slowly with frequency), so that it
    has no response in time. In steady states, where only frequencies matter, it can be used. Since
    it has no time scale, a_T has no effect on it; b_T scales its modulus.

    Parameters
    ----------
    modulus :
        E [MPa], from 1e-9 to 1e12: the storage modulus at every frequency.
    loss_factor :
        eta = tan delta, >= 0 and at most 10.
    poisson, temperature, shift, thermal, energy :
        see `Viscoelastic`.

    Raises
    ------
    InvalidInputError
        where a parameter lies outside its range, or only one of temperature and shift is given.
    """

    modulus: float
    loss_factor: float

    def __post_init__(self) -> None:
        _check_shared(self)
        object.__setattr__(self, "modulus", checked_modulus("modulus", self.modulus))
        require_not_negative("loss_factor", self.loss_factor)
        if self.loss_factor > 10.0:
            raise InvalidInputError(f"`loss_factor` must be at most 10, got {self.loss_factor!r}.")
        object.__setattr__(self, "loss_factor", float(self.loss_factor))

    def modulus_at(self, s: ArrayLike) -> NDArray[np.complex128]:
        """Return E*(s) [MPa], a complex array of the shape of ``s`` [1/s]; w = Im s."""
        sign = np.sign(np.asarray(s, dtype=np.complex128).imag)
        return np.asarray(self.level * self.modulus * (1.0 + 1j * self.loss_factor * sign))

    @property
    def relaxed_modulus(self) -> float:
        """E at the material's temperature [MPa], the value at zero frequency."""
        return self.level * self.modulus

    @property
    def glassy_modulus(self) -> float:
        """E at the material's temperature [MPa]; the limit of E* is E (1 + i eta sign(w))."""
        return self.level * self.modulus

    @property
    def relaxation_times(self) -> tuple[float, ...]:
        """Empty: E* depends on the sign of the frequency only."""
        return ()


def _maxwell(s: ArrayLike, time: float) -> NDArray[np.complex128]:
    """Return tau s/(1 + tau s) without overflow: 0 at s = 0, 1 at infinity."""
    factor = np.asarray(s, dtype=np.complex128)
    limit = _FAR / time
    scaled = np.empty_like(factor)
    scaled.real = np.clip(factor.real, -limit, limit) * time
    scaled.imag = np.clip(factor.imag, -limit, limit) * time
    return np.asarray(scaled / (1.0 + scaled))


def _fractional_maxwell(s: ArrayLike, time: float, order: float) -> NDArray[np.complex128]:
    """Return (tau s)^m/(1 + (tau s)^m) through logarithms, principal branch, without overflow."""
    factor = np.asarray(s, dtype=np.complex128)
    at_rest = factor == 0.0
    size = np.abs(np.where(at_rest, 1.0, factor))
    exponent = np.clip(order * (np.log(size) + np.log(time)), -_FAR_EXPONENT, _FAR_EXPONENT)
    inverse = np.exp(-exponent) * np.exp(-1j * order * np.angle(factor))
    return np.asarray(np.where(at_rest, 0.0, 1.0 / (1.0 + inverse)))


def _check_shared(material: Viscoelastic) -> None:
    object.__setattr__(material, "poisson", checked_poisson(material.poisson))
    checked_thermal(material.thermal)
    checked_energy(material.energy)
    if (material.temperature is None) != (material.shift is None):
        missing, given = (
            ("shift", "temperature")
            if material.shift is None
            else (
                "temperature",
                "shift",
            )
        )
        raise InvalidInputError(f"`{missing}` must be given together with `{given}`, got None.")
    if material.shift is None or material.temperature is None:
        return
    if not isinstance(material.shift, WLF | Arrhenius | TabulatedShift):
        raise InvalidInputError(
            f"`shift` must be WLF, Arrhenius or TabulatedShift, got {material.shift!r}."
        )
    temperature = checked_temperature("temperature", material.temperature)
    object.__setattr__(material, "temperature", temperature)
    material.shift.factor(temperature)
    material.shift.level(temperature)


def _checked_terms(terms: object) -> tuple[tuple[float, float], ...]:
    try:
        pairs = [tuple(pair) for pair in cast("Iterable[Iterable[float]]", terms)]
    except TypeError:
        raise InvalidInputError(
            f"`terms` must hold pairs (modulus, relaxation time), got {terms!r}."
        ) from None
    if not pairs:
        raise InvalidInputError("`terms` must hold at least one pair (or use Elastic), got none.")
    checked = []
    for index, pair in enumerate(pairs):
        if len(pair) != 2:
            raise InvalidInputError(
                f"`terms[{index}]` must be a pair (modulus, relaxation time), got {pair!r}."
            )
        modulus = checked_stiffening(f"terms[{index}][0]", pair[0])
        checked.append((modulus, checked_time(f"terms[{index}][1]", pair[1])))
    return tuple(checked)
