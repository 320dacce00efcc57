"""Relaxation and creep functions, and the relaxed modulus that follows from a durometer reading."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rollnip._errors import InvalidInputError, require_positive
from rollnip._laplace import inverse_laplace
from rollnip.materials.base import Material
from rollnip.materials.shore import shore_a_modulus
from rollnip.materials.viscoelastic import (
    FractionalZener,
    LossFactor,
    Prony,
    StandardLinearSolid,
)

_PER_FOLD = 20.0  # points of an interpolated function in a factor e of time

Solid = TypeVar("Solid", StandardLinearSolid, Prony, FractionalZener, LossFactor)

READING_TIME = 3.0  # s after contact, vulcanised rubber (ISO 48-4:2018, 9.2)
LABORATORY = 23.0  # degC, at which hardness is measured (ISO 23529)


def relaxation_modulus(material: Material, time: ArrayLike) -> NDArray[np.float64]:
    """Return the relaxation modulus E(t) [MPa]: stress per strain, at t after a step of strain.

    It is the inverse Laplace transform of E*(s)/s, by quadrature along Talbot's contour.

    Parameters
    ----------
    material :
        any except a `LossFactor`, which has no response in time.
    time :
        t [s], any shape, positive.

    Returns
    -------
    array of the shape of ``time`` [MPa].

    Raises
    ------
    InvalidInputError
        where a time is not positive and finite, or the material has a constant loss factor.
    """
    return _inverse(material, time, 1)


def memory_integral(material: Material, time: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the integral of E(t)/E(inf) - 1 from 0 to each time [s].

    It is 0 before t = 0. A constant loss factor eta is not causal: its response to a step varies as
    -(eta/pi) ln|t| on both sides of t = 0, up to a constant that has no effect on a closed cycle.
    """
    if material.is_elastic:
        return np.zeros(time.shape)
    if isinstance(material, LossFactor):
        log = np.log(np.where(time == 0.0, 1.0, np.abs(time)))
        return np.asarray(material.loss_factor / np.pi * time * (1.0 - log))
    later = np.maximum(time, 0.0)
    terms = exponential_terms(material)
    if terms:
        return np.asarray(sum(-share * own * np.expm1(-later / own) for share, own in terms))
    return _interpolated(lambda t: _excess_area(material, t), later)


def exponential_terms(material: Material) -> list[tuple[float, float]]:
    """Return pairs (g_i, tau_i [s]) with E(t)/E(inf) - 1 = sum_i g_i exp(-t/tau_i).

    Empty where E(t) is no finite sum of exponentials, or the material is elastic.
    """
    if isinstance(material, Prony):
        moduli = [modulus for modulus, _ in material.terms]
    elif isinstance(material, StandardLinearSolid):
        moduli = [material.stiffening]
    else:
        return []
    shares = [modulus / material.modulus for modulus in moduli]
    return list(zip(shares, material.relaxation_times, strict=True))


def _excess_area(material: Material, time: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the integral of E(t)/E(inf) - 1 from 0 to positive times by Talbot's contour."""
    relaxed = material.relaxed_modulus
    return inverse_laplace(lambda s: (material.modulus_at(s) / relaxed - 1.0) / s**2, time)


def _interpolated(
    area: Callable[[NDArray[np.float64]], NDArray[np.float64]], time: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return a smooth, increasing function of time, interpolated on an even grid of log time."""
    from scipy.interpolate import CubicSpline  # a plain nip does not need it

    positive = time[time > 0.0]
    out = np.zeros(time.shape)
    if positive.size == 0:
        return out
    ends = np.log(positive.min()) - 1e-3, np.log(positive.max()) + 1e-3
    marks = np.linspace(*ends, 8 + int(_PER_FOLD * (ends[1] - ends[0])))
    values = area(np.exp(marks))
    if not values.all():
        return out
    out[time > 0.0] = np.exp(CubicSpline(marks, np.log(values))(np.log(positive)))
    return out


def _inverse(material: Material, time: ArrayLike, power: int) -> NDArray[np.float64]:
    """Return the inverse Laplace transform of E*(s)^power/s."""
    if isinstance(material, LossFactor):
        raise InvalidInputError(
            "`material` must have an answer in time: a constant loss factor is not causal."
        )
    t = np.asarray(time, dtype=np.float64)
    if not np.all(np.isfinite(t) & (t > 0.0)):
        raise InvalidInputError(f"`time` must be positive and finite, got {time!r}.")
    return inverse_laplace(lambda at: material.modulus_at(at) ** power / at, t)


def creep_compliance(material: Material, time: ArrayLike) -> NDArray[np.float64]:
    """Return the creep compliance J(t) [1/MPa]: strain per stress, at t after a step of stress.

    It is the inverse Laplace transform of 1/(s E*(s)); parameters and errors as for
    `relaxation_modulus`.
    """
    return _inverse(material, time, -1)


def with_shore_a(material: Solid, shore_a: float, *, reading_time: float = READING_TIME) -> Solid:
    """Return the solid with the relaxed modulus that gives it a Shore A hardness.

    A durometer is read some seconds after contact, at 23 degC; it measures the stress that is left
    then. The relaxed modulus is chosen such that E(reading time) at 23 degC is the modulus of the
    hardness (Gent's formula); the relaxing part stays as it is. For rubber whose relaxation times
    are much shorter than the reading time, this is the relaxed modulus itself. For a `LossFactor`,
    which has no time scale, it is the storage modulus.

    Parameters
    ----------
    material :
        the solid whose ``modulus`` is replaced.
    shore_a :
        hardness, from 20 to 95.
    reading_time :
        [s]; 3 s for vulcanised rubber, 15 s for thermoplastic rubber (ISO 48-4:2018).

    Raises
    ------
    InvalidInputError
        where the relaxing part alone is still stiffer than the hardness at the reading time.
    """
    wanted = shore_a_modulus(shore_a)
    after = require_positive("reading_time", reading_time)
    cold = material if material.shift is None else replace(material, temperature=LABORATORY)
    if isinstance(material, LossFactor):
        return replace(material, modulus=wanted / cold.level)
    left = float(relaxation_modulus(cold, after)) / cold.level - material.modulus
    relaxed = wanted / cold.level - left
    if relaxed <= 0.0:
        raise InvalidInputError(
            f"`shore_a` must be higher: after {after:g} s the material still holds {left:.3g} MPa "
            f"beyond its relaxed modulus, and a hardness of {shore_a:g} is {wanted:.3g} MPa."
        )
    return replace(material, modulus=relaxed)


def stiffness_of_hardness(material: Material, shore_a: float) -> float:
    """Return the factor on all moduli that gives a material a Shore A hardness.

    The modulus that a durometer reads, `READING_TIME` after contact at 23 degC, becomes that of the
    hardness (Gent's formula). Readings along a face thus determine how its stiffness varies. The
    relaxing part, which `with_shore_a` leaves as it is, is scaled in proportion here.

    Raises
    ------
    InvalidInputError
        for a hardness outside 20 to 95.
    """
    wanted = shore_a_modulus(shore_a)
    if material.is_elastic or isinstance(material, LossFactor):
        return wanted / material.relaxed_modulus
    shift = getattr(material, "shift", None)
    cold = material if shift is None else replace(material, temperature=LABORATORY)  # type: ignore[type-var]
    return wanted / float(relaxation_modulus(cold, READING_TIME))
