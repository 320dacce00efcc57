"""The elastic material."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rollnip._errors import with_hints
from rollnip.materials.base import (
    Material,
    checked_energy,
    checked_modulus,
    checked_poisson,
    checked_thermal,
)
from rollnip.materials.energy import Energy
from rollnip.materials.shore import shore_a_modulus
from rollnip.materials.thermal import Thermal


@with_hints(
    shore_a="write `rn.Elastic.from_shore_a(60)`.",
    hardness="write `rn.Elastic.from_shore_a(60)`.",
    shear_modulus="write `rn.Elastic.from_shear_modulus(0.3, 0.5)`.",
    nu="give `poisson`.",
)
@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Elastic(Material):
    """An elastic material.

    Parameters
    ----------
    modulus :
        Young's modulus E [MPa], from 1e-9 to 1e12.
    poisson :
        Poisson ratio, in (-1, 0.5].
    thermal :
        thermal properties; used only for a `HeatBalance`.
    energy :
        strain energy, such as `Yeoh`; None: `NeoHookean`. It describes how the material stiffens
        with stretch, with ``modulus`` at rest, and is used only in geometry "finite".

    Raises
    ------
    InvalidInputError
        where a parameter lies outside its range.
    """

    modulus: float
    poisson: float
    thermal: Thermal | None = field(default=None, repr=False)
    energy: Energy | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "modulus", checked_modulus("modulus", self.modulus))
        object.__setattr__(self, "poisson", checked_poisson(self.poisson))
        checked_thermal(self.thermal)
        checked_energy(self.energy)

    def __repr__(self) -> str:
        """Return how the material is made; the strain energy only where one was given."""
        further = "" if self.energy is None else f", energy={self.energy!r}"
        return f"Elastic(modulus={self.modulus!r}, poisson={self.poisson!r}{further})"

    @classmethod
    def from_shear_modulus(cls, shear_modulus: float, poisson: float) -> Elastic:
        """Return the elastic material with the shear modulus G [MPa]: E = 2 G (1 + nu).

        Raises InvalidInputError where a parameter lies outside its range.
        """
        shear = checked_modulus("shear_modulus", shear_modulus)
        ratio = checked_poisson(poisson)
        return cls(modulus=2.0 * shear * (1.0 + ratio), poisson=ratio)

    @classmethod
    def from_shore_a(cls, shore_a: float, poisson: float = 0.5) -> Elastic:
        """Return the elastic material of a Shore A hardness, by Gent's formula.

        It is only an estimate: `rollnip.materials.shore_a_band` says how far it may be off (a
        factor of 2). Raises InvalidInputError for a hardness outside 20 to 95.
        """
        return cls(modulus=shore_a_modulus(shore_a), poisson=poisson)

    def modulus_at(self, s: ArrayLike) -> NDArray[np.complex128]:
        """Return E*(s) = E [MPa], a complex array of the shape of ``s``."""
        return np.full(np.shape(s), self.modulus, dtype=np.complex128)

    @property
    def is_elastic(self) -> bool:
        """True: the modulus does not depend on s."""
        return True

    @property
    def relaxed_modulus(self) -> float:
        """E [MPa]."""
        return self.modulus

    @property
    def glassy_modulus(self) -> float:
        """E [MPa]."""
        return self.modulus

    @property
    def relaxation_times(self) -> tuple[float, ...]:
        """Empty: an elastic material has no memory."""
        return ()
