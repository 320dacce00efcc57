"""The base class of all materials, and the checks that their parameters share."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rollnip._errors import (
    InvalidInputError,
    require_finite,
    require_not_negative,
    require_positive,
)
from rollnip.materials.energy import Energy
from rollnip.materials.thermal import Thermal

_SMALLEST_MODULUS = 1e-9  # MPa; outside these two limits a unit was mistaken
_LARGEST_MODULUS = 1e12  # MPa
_SHORTEST_TIME = 1e-30  # s
_LONGEST_TIME = 1e30  # s


class Material(ABC):
    """An isotropic, linear solid: a complex modulus and a constant Poisson ratio.

    Materials are frozen, hashable and comparable. Moduli are in MPa, times in s.

    Attributes
    ----------
    poisson :
        Poisson ratio, in (-1, 0.5]; 0.5 exactly is incompressible.
    thermal :
        thermal properties; None where they are not known.
    energy :
        strain energy, for geometry "finite"; None: neo-Hookean.
    """

    __slots__ = ()

    poisson: float
    thermal: Thermal | None = None
    energy: Energy | None = None

    @abstractmethod
    def modulus_at(self, s: ArrayLike) -> NDArray[np.complex128]:
        """Return the complex modulus E*(s).

        Parameters
        ----------
        s :
            time factor [1/s] of fields that vary as e^{s t}, any shape; s = i w_t for harmonic
            fields, s = -i w V for the wave number w in steady rolling with the speed V.

        Returns
        -------
        complex array of the shape of ``s`` [MPa]. E*(conj s) = conj E*(s); finite for every s with
        a real part >= 0, from 0 to infinity.
        """

    @property
    @abstractmethod
    def is_elastic(self) -> bool:
        """Whether E* is independent of s."""

    @property
    @abstractmethod
    def relaxed_modulus(self) -> float:
        """E* at s = 0 [MPa]."""

    @property
    @abstractmethod
    def glassy_modulus(self) -> float:
        """Limit of the real part of E* for |s| -> infinity [MPa]."""

    @property
    @abstractmethod
    def relaxation_times(self) -> tuple[float, ...]:
        """Relaxation times [s] at the material's temperature; empty where E* has no time scale."""


def checked_poisson(poisson: float) -> float:
    """Return ``poisson`` as a float, or raise InvalidInputError unless it lies in (-1, 0.5]."""
    checked = require_finite("poisson", poisson)
    if not -1.0 < checked <= 0.5:
        raise InvalidInputError(f"`poisson` must lie in (-1, 0.5], got {poisson!r}.")
    return checked


def checked_modulus(name: str, value: float) -> float:
    """Return a modulus as a float, or raise InvalidInputError unless 1e-9 <= value <= 1e12 MPa."""
    checked = require_positive(name, value)
    if not _SMALLEST_MODULUS <= checked <= _LARGEST_MODULUS:
        raise InvalidInputError(f"`{name}` must lie between 1e-9 and 1e12 MPa, got {value!r}.")
    return checked


def checked_stiffening(name: str, value: float) -> float:
    """Return a relaxing modulus as a float, or raise unless 0 <= value <= 1e12 MPa.

    A negative one would make the material release energy in a cycle.
    """
    checked = require_not_negative(name, value)
    if checked > _LARGEST_MODULUS:
        raise InvalidInputError(f"`{name}` must be at most 1e12 MPa, got {value!r}.")
    return checked


def checked_time(name: str, value: float) -> float:
    """Return a relaxation time as a float, or raise unless 1e-30 <= value <= 1e30 s."""
    checked = require_positive(name, value)
    if not _SHORTEST_TIME <= checked <= _LONGEST_TIME:
        raise InvalidInputError(f"`{name}` must lie between 1e-30 and 1e30 s, got {value!r}.")
    return checked


def checked_energy(energy: object) -> None:
    """Raise InvalidInputError unless ``energy`` is None or a strain energy."""
    if energy is not None and not isinstance(energy, Energy):
        raise InvalidInputError(
            f"`energy` must be NeoHookean, Yeoh, Gent or Ogden, or None, got {energy!r}."
        )


def checked_thermal(thermal: object) -> None:
    """Raise InvalidInputError unless ``thermal`` is None or thermal properties."""
    if thermal is not None and not isinstance(thermal, Thermal):
        raise InvalidInputError(f"`thermal` must be Thermal or None, got {thermal!r}.")
