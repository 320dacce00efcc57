"""The sheet that runs between two rollers: elastic constants, thickness, tensions and friction."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from rollnip._errors import (
    InvalidInputError,
    require_finite,
    require_friction,
    require_not_negative,
    require_positive,
    with_hints,
)
from rollnip.materials.base import checked_modulus


@with_hints(
    tension="give `tension_in` and `tension_out`, on the inlet and the outlet side.",
    friction="give `friction_upper` and `friction_lower`; both are the nip's by default.",
    grammage="give `thickness`; `rn.Sheet.usual` knows the usual ones.",
)
@dataclass(frozen=True, slots=True, kw_only=True)
class Sheet:
    """An elastic sheet in the nip: paper, film, foil, board or a belt.

    Parameters
    ----------
    thickness :
        h [mm], positive.
    modulus :
        in-plane Young's modulus E along the direction of travel [MPa], positive.
    poisson :
        Poisson's ratio, in (-1, 0.5].
    modulus_thickness :
        modulus E_z across the thickness [MPa], positive; None: equal to ``modulus``. For paper it
        is about a hundredth of the in-plane modulus.
    tension_in, tension_out :
        tension per width on the inlet side (x > 0) and on the outlet side [N/mm], not negative.
    friction_upper, friction_lower :
        Coulomb friction coefficients between the sheet and each roller, positive; None: that of
        the nip.
    bending :
        whether the sheet's bending stiffness is included. False: it is neglected. None: it is
        included where it acts over more than a twentieth of the nip width, provided that this
        solution can be verified.

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
    bending: bool | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "thickness", require_positive("thickness", self.thickness))
        object.__setattr__(self, "modulus", checked_modulus("modulus", self.modulus))
        if self.modulus_thickness is not None:
            across = checked_modulus("modulus_thickness", self.modulus_thickness)
            object.__setattr__(self, "modulus_thickness", across)
        for name in ("friction_upper", "friction_lower"):
            value = getattr(self, name)
            if value is not None:
                friction = require_friction(name, require_positive(name, value))
                object.__setattr__(self, name, friction)
        if self.bending is not None and not isinstance(self.bending, bool):
            raise InvalidInputError(
                f"`bending` must be true or false, or be left out, got {self.bending!r}."
            )
        for name in ("tension_in", "tension_out"):
            value = getattr(self, name)
            object.__setattr__(self, name, require_not_negative(name, value))
        poisson = require_finite("poisson", self.poisson)
        if not -1.0 < poisson <= 0.5:
            raise InvalidInputError(f"`poisson` must lie in (-1, 0.5], got {self.poisson!r}.")
        object.__setattr__(self, "poisson", poisson)

    @classmethod
    def usual(cls, name: str) -> Sheet:
        """Return a typical sheet from `SHEETS`, such as "office paper", without tension.

        Raises
        ------
        InvalidInputError
            where `SHEETS` has no sheet of this name.
        """
        if name not in SHEETS:
            known = ", ".join(SHEETS)
            raise InvalidInputError(f"`name` must be one of {known}, got {name!r}.")
        return SHEETS[name]

    @property
    def stretch_by_tension(self) -> float:
        """Strain per tension at constant width (plane strain), (1 - nu^2)/(E h) [mm/N]."""
        return (1.0 - self.poisson**2) / (self.modulus * self.thickness)

    @property
    def stretch_by_pressure(self) -> float:
        """Strain along the nip per pressure, nu (1 + nu)/E [1/MPa].

        By Maxwell-Betti reciprocity it is also the loss of thickness per tension [mm/(N/mm)].
        """
        return self.poisson * (1.0 + self.poisson) / self.modulus

    @property
    def squeeze(self) -> float:
        """Loss of thickness per pressure on both faces, h (1 - nu^2)/E_z [mm/MPa]."""
        across = self.modulus if self.modulus_thickness is None else self.modulus_thickness
        return self.thickness * (1.0 - self.poisson**2) / across

    @property
    def shear_by_thickness(self) -> float:
        """Thickness over the shear modulus, h/G with G = E/(2 (1 + nu)) [mm/MPa].

        Shears q_u and q_l on the faces displace them by (q_u/3 + q_l/6) and (q_u/6 + q_l/3) times
        this value relative to the mean of the section, because the shear stress varies linearly
        across the thickness. This applies to a membrane, whose two faces lie on the rollers over
        the same contact.
        """
        return 2.0 * (1.0 + self.poisson) * self.thickness / self.modulus

    @property
    def sheared(self) -> float:
        """Tangential displacement of a face per shear, h (1 - nu^2)/E; cf. `squeeze` [mm/MPa]."""
        return self.thickness * (1.0 - self.poisson**2) / self.modulus

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
    "PET film": Sheet(thickness=0.05, modulus=4500.0, poisson=0.38),
    "BOPP film": Sheet(thickness=0.02, modulus=2500.0, poisson=0.4),
    "PE film": Sheet(thickness=0.05, modulus=200.0, poisson=0.45),
    "aluminium foil": Sheet(thickness=0.012, modulus=70e3, poisson=0.3),
    "steel belt": Sheet(thickness=0.2, modulus=200e3, poisson=0.3),
}
"""Typical sheets along their machine direction, without tension; a start where none is measured.

Vary them with `dataclasses.replace`. `SHEET_SOURCES` gives the source of each value, the values
that are typical but have no source, and the usual ranges.
"""


@dataclass(frozen=True, slots=True)
class SheetSource:
    """Sources of the values of a typical sheet, and the usual ranges.

    Attributes
    ----------
    thickness, modulus : lowest and highest usual value [mm, MPa]; the modulus is that along the
        machine direction.
    modulus_thickness : the same for the modulus across the thickness; None where the in-plane
        modulus is used.
    text : what the sources state.
    typical : quantities whose values are typical of such a sheet but are stated by none of the
        sources; an "end" is one end of the usual range.
    """

    thickness: tuple[float, float]
    modulus: tuple[float, float]
    modulus_thickness: tuple[float, float] | None
    text: str
    typical: tuple[str, ...]


_PAPER_MODULUS = (
    "modulus of paper from newsprint to kraft: 3 to 8.9 GPa (Ashby, Materials and the "
    "Environment, paper and cardboard)"
)
_PAPER_TYPICAL = (
    "modulus of the grade",
    "modulus across the thickness (some hundredth of that along the machine)",
    "Poisson's ratio",
)
SHEET_SOURCES: Mapping[str, SheetSource] = {
    "office paper": SheetSource(
        (0.095, 0.115),
        (4000.0, 8900.0),
        (20.0, 80.0),
        _PAPER_MODULUS,
        ("thickness (of 80 g/m2)", *_PAPER_TYPICAL),
    ),
    "newsprint": SheetSource(
        (0.055, 0.088),
        (3000.0, 5000.0),
        (15.0, 50.0),
        "thickness at 45 g/m2: 0.075 mm, 0.013 mm more or less allowed (United States "
        f"government paper specification JCP A10, 1999); {_PAPER_MODULUS}",
        ("lower end of the thickness", *_PAPER_TYPICAL),
    ),
    "board": SheetSource(
        (0.3, 0.6),
        (3000.0, 8000.0),
        (20.0, 60.0),
        _PAPER_MODULUS,
        ("thickness (folding boxboard, some 250 g/m2)", *_PAPER_TYPICAL),
    ),
    "PET film": SheetSource(
        (0.001, 0.5),
        (3790.0, 4800.0),
        None,
        "biaxially drawn: thickness 1 to 500 um, modulus 4.5 GPa by ISO 527 (Mitsubishi Polyester "
        "Film, Comparative data for plastic films); 4.8 GPa by ASTM D 882, Poisson's ratio 0.38 "
        "before yield (DuPont Teijin Films, Mylar physical-thermal properties, H-37232-3); "
        "3.79 GPa by ASTM D 882 (data sheet of Mylar LBT, 12 um)",
        (),
    ),
    "BOPP film": SheetSource(
        (0.004, 0.08),
        (1700.0, 2500.0),
        None,
        "thickness 4 to 80 um, modulus 2.5 GPa along and 4.5 GPa across the machine by ISO 527 "
        "(Mitsubishi Polyester Film, Comparative data for plastic films)",
        ("lower end of the modulus", "Poisson's ratio"),
    ),
    "PE film": SheetSource(
        (0.01, 0.2),
        (120.0, 282.0),
        None,
        "modulus of low density: 0.172 to 0.282 GPa, of high density 1.08 GPa (Callister's "
        "textbook of materials science, table B.2); 0.12 GPa by ISO 527 for a soft copolymer "
        "(LyondellBasell, technical data sheet Lucalen A2540D, 2016)",
        ("thickness", "Poisson's ratio"),
    ),
    "aluminium foil": SheetSource(
        (0.006, 0.2),
        (69e3, 72e3),
        None,
        "thickness of foil: 6 to 200 um (EN 546-1); modulus 70 GPa and Poisson's ratio 0.3 for "
        "design (EN 1999-1-1), 69 to 72 GPa among wrought alloys",
        ("thickness of household foil",),
    ),
    "steel belt": SheetSource(
        (0.1, 1.2),
        (190e3, 210e3),
        None,
        "modulus of austenitic stainless steels 1.4301 and 1.4401: 200 GPa at 20 degC (EN 10088-1)",
        ("thickness", "ends of the modulus", "Poisson's ratio"),
    ),
}
"""Sources, usual ranges and typical values of `SHEETS`, by name.

Friction is not a property of the sheet alone. TAPPI T 549 measures paper against itself, ISO 15359
paper and board, ISO 8295 and ASTM D 1894 film against itself or another material; measure the sheet
against the surface of the roller.
"""
