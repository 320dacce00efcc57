"""A sheet that runs between two rollers: what it is made of, its tensions and its friction."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from rollnip._errors import (
    InvalidInputError,
    require_finite,
    require_not_negative,
    require_positive,
    with_hints,
)


@with_hints(
    tension="give `tension_in` and `tension_out`, on the inlet and the outlet side.",
    friction="give `friction_upper` and `friction_lower`; both are the nip's by default.",
    grammage="give `thickness`; `rn.Sheet.usual` knows the usual ones.",
)
@dataclass(frozen=True, slots=True, kw_only=True)
class Sheet:
    """A sheet in the nip: paper, film, foil, board or belt; elastic.

    Parameters
    ----------
    thickness :
        h [mm], positive.
    modulus :
        Young's modulus E in the plane of the sheet, along the nip [MPa], positive.
    poisson :
        Poisson's ratio, in (-1, 0.5].
    modulus_thickness :
        modulus E_z across the thickness [MPa], positive; None: that in the plane. That of paper
        is about a hundredth of it.
    tension_in, tension_out :
        tension per width on the inlet side (x > 0) and on the outlet side [N/mm], not negative.
    friction_upper, friction_lower :
        Coulomb coefficient of the sheet on either roller, positive; None: that of the nip.

    Raises
    ------
    InvalidInputError
        where a value lies outside its range.
    """

    thickness: float
    modulus: float
    poisson: float = 0.3
    modulus_thickness: float | None = None
    tension_in: float = 0.0
    tension_out: float = 0.0
    friction_upper: float | None = None
    friction_lower: float | None = None

    def __post_init__(self) -> None:
        for name in ("thickness", "modulus"):
            object.__setattr__(self, name, require_positive(name, getattr(self, name)))
        for name in ("modulus_thickness", "friction_upper", "friction_lower"):
            value = getattr(self, name)
            if value is not None:
                object.__setattr__(self, name, require_positive(name, value))
        for name in ("tension_in", "tension_out"):
            value = getattr(self, name)
            object.__setattr__(self, name, require_not_negative(name, value))
        poisson = require_finite("poisson", self.poisson)
        if not -1.0 < poisson <= 0.5:
            raise InvalidInputError(f"`poisson` must lie in (-1, 0.5], got {self.poisson!r}.")
        object.__setattr__(self, "poisson", poisson)

    @classmethod
    def usual(cls, name: str) -> Sheet:
        """Return a usual sheet of `SHEETS`, such as "office paper", without tension.

        Raises
        ------
        InvalidInputError
            where there is none of this name.
        """
        if name not in SHEETS:
            known = ", ".join(SHEETS)
            raise InvalidInputError(f"`name` must be one of {known}, got {name!r}.")
        return SHEETS[name]

    @property
    def stretch_by_tension(self) -> float:
        """Strain per tension at constant width, (1 - nu^2)/(E h) [mm/N]."""
        return (1.0 - self.poisson**2) / (self.modulus * self.thickness)

    @property
    def stretch_by_pressure(self) -> float:
        """Strain along the nip per pressure, nu (1 + nu)/E [1/MPa].

        The sheet becomes thinner by as much per tension [mm/(N/mm)], as Maxwell and Betti's
        theorem of reciprocity demands.
        """
        return self.poisson * (1.0 + self.poisson) / self.modulus

    @property
    def squeeze(self) -> float:
        """Loss of thickness per pressure, h (1 - nu^2)/E_z [mm/MPa]."""
        across = self.modulus if self.modulus_thickness is None else self.modulus_thickness
        return self.thickness * (1.0 - self.poisson**2) / across

    @property
    def shear_by_thickness(self) -> float:
        """Thickness over the shear modulus E/(2 (1 + nu)) [mm/MPa].

        Under shears q_u and q_l its faces lie (q_u/3 + q_l/6) and (q_u/6 + q_l/3) times this from
        the mean of the section: the shear stress goes linearly from face to face.
        """
        return 2.0 * (1.0 + self.poisson) * self.thickness / self.modulus

    @property
    def bending_stiffness(self) -> float:
        """Bending stiffness per width, E h^3/(12 (1 - nu^2)) [N mm]."""
        return self.modulus * self.thickness**3 / (12.0 * (1.0 - self.poisson**2))


def _paper(thickness: float, modulus: float, across: float) -> Sheet:
    return Sheet(thickness=thickness, modulus=modulus, poisson=0.3, modulus_thickness=across)


SHEETS: Mapping[str, Sheet] = {
    "office paper": _paper(0.104, 6000.0, 40.0),
    "newsprint": _paper(0.068, 4000.0, 25.0),
    "board": _paper(0.40, 4500.0, 30.0),
    "PET film": Sheet(thickness=0.05, modulus=4000.0, poisson=0.38),
    "PE film": Sheet(thickness=0.05, modulus=200.0, poisson=0.45),
    "aluminium foil": Sheet(thickness=0.012, modulus=70e3, poisson=0.33),
}
"""Usual sheets along their machine direction, without tension: a start where nothing is measured.

Vary with `dataclasses.replace`; `SHEET_SOURCES` says which range is usual.
"""

_PAPER_SOURCE = (
    "typical values, some +-30 % between grades; the modulus is that of the machine direction, "
    "across the thickness about a hundredth of it (Mann, Baum and Habeger, Tappi 63 (1980) 163, "
    "measured all constants of one board)"
)
SHEET_SOURCES: Mapping[str, str] = {
    "office paper": f"of 80 g/m2; {_PAPER_SOURCE}",
    "newsprint": f"of 45 g/m2; {_PAPER_SOURCE}",
    "board": f"folding boxboard of 250 g/m2; {_PAPER_SOURCE}",
    "PET film": "typical value of biaxially drawn film, 50 um; 3.5 to 5 GPa are usual",
    "PE film": "typical value of low-density film, 50 um; 0.1 to 0.3 GPa are usual",
    "aluminium foil": "household foil of 12 um, typical; the metal's own modulus, 69 to 72 GPa",
}
"""What the numbers of `SHEETS` are, by name: typical values and the range that is usual."""
