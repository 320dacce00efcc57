"""How rollers lose their heat: to the air, through the core, to a sheet; data without physics."""

from __future__ import annotations

from dataclasses import dataclass

from rollnip._errors import InvalidInputError, require_not_negative, require_positive, with_hints
from rollnip.materials import Thermal
from rollnip.materials.shift import checked_temperature

__all__ = [
    "Coolant",
    "Cooling",
    "Core",
    "HeatBalance",
    "Held",
    "Insulated",
    "PassingSheet",
    "Shell",
]


@dataclass(frozen=True, slots=True)
class Insulated:
    """No heat passes to the core."""


@dataclass(frozen=True, slots=True)
class Held:
    """A core whose surface is held at a temperature [degC]."""

    temperature: float

    def __post_init__(self) -> None:
        checked = checked_temperature("temperature", self.temperature)
        object.__setattr__(self, "temperature", checked)


@dataclass(frozen=True, slots=True)
class Coolant:
    """A fluid behind the core.

    Parameters
    ----------
    temperature :
        of the fluid [degC].
    film :
        film coefficient on the wall that it wets [W/(m2 K)], positive.
    """

    temperature: float
    film: float

    def __post_init__(self) -> None:
        checked = checked_temperature("temperature", self.temperature)
        object.__setattr__(self, "temperature", checked)
        object.__setattr__(self, "film", require_positive("film", self.film))


Core = Insulated | Held | Coolant


@with_hints()
@dataclass(frozen=True, slots=True, kw_only=True)
class Shell:
    """The wall of the core under the coverings, through which heat passes to the inside.

    Parameters
    ----------
    thickness :
        of the wall [mm], positive, smaller than the radius of the core.
    thermal :
        of its metal; see `rollnip.materials.TYPICAL`.
    """

    thickness: float
    thermal: Thermal

    def __post_init__(self) -> None:
        object.__setattr__(self, "thickness", require_positive("thickness", self.thickness))
        if not isinstance(self.thermal, Thermal):
            raise InvalidInputError(f"`thermal` must be Thermal, got {self.thermal!r}.")


@with_hints(
    coolant="give `core=rn.Coolant(15.0, film=500.0)`.",
    h="give `film` in W/(m2 K).",
)
@dataclass(frozen=True, slots=True, kw_only=True)
class Cooling:
    """The ways in which one roller loses heat.

    Parameters
    ----------
    film :
        film coefficient between the surface and the ambient air [W/(m2 K)]; 0: none.
    core :
        Insulated, Held or Coolant; it acts on the inside of ``shell``, or of the coverings where
        there is none.
    shell :
        wall between the coverings and the core's boundary; None: no resistance, no heat stored.

    Raises
    ------
    InvalidInputError
        where a value lies outside its range.
    """

    film: float
    core: Core = Insulated()
    shell: Shell | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "film", require_not_negative("film", self.film))
        if not isinstance(self.core, Insulated | Held | Coolant):
            raise InvalidInputError(
                f"`core` must be Insulated, Held or Coolant, got {self.core!r}."
            )
        if self.shell is not None and not isinstance(self.shell, Shell):
            raise InvalidInputError(f"`shell` must be Shell or None, got {self.shell!r}.")

    @property
    def is_closed(self) -> bool:
        """Return whether no heat leaves to air or core."""
        return self.film == 0.0 and isinstance(self.core, Insulated)


@with_hints()
@dataclass(frozen=True, slots=True, kw_only=True)
class PassingSheet:
    """A sheet that runs through the nip and takes heat along.

    Where the nip has a `rollnip.Sheet`, this is what that sheet does with heat; otherwise a sheet
    that changes no stress.

    Parameters
    ----------
    thickness :
        [mm], positive; None: that of the sheet of the nip.
    thermal :
        conductivity across the thickness, density, heat capacity.
    temperature :
        where it enters the nip [degC].
    """

    thermal: Thermal
    temperature: float
    thickness: float | None = None

    def __post_init__(self) -> None:
        if self.thickness is not None:
            object.__setattr__(self, "thickness", require_positive("thickness", self.thickness))
        if not isinstance(self.thermal, Thermal):
            raise InvalidInputError(f"`thermal` must be Thermal, got {self.thermal!r}.")
        checked = checked_temperature("temperature", self.temperature)
        object.__setattr__(self, "temperature", checked)


@with_hints(
    temperature="give `ambient` [degC].",
    film="it belongs to each roller: `upper=rn.Cooling(film=30.0)`.",
)
@dataclass(frozen=True, slots=True, kw_only=True)
class HeatBalance:
    """The surroundings that take the heat of a nip.

    Parameters
    ----------
    ambient :
        temperature of the air [degC].
    upper, lower :
        how each roller is cooled. A plane (radius inf) arrives at the nip with the temperature at
        which its core is held, or else with the ambient one; its film does not count.
    start :
        temperature of everything when a warm-up begins [degC]; None: the ambient one.
    sheet :
        a sheet between the rollers; None: they touch. A nip with a sheet needs it.

    Raises
    ------
    InvalidInputError
        where a value lies outside its range.
    """

    ambient: float
    upper: Cooling
    lower: Cooling
    start: float | None = None
    sheet: PassingSheet | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "ambient", checked_temperature("ambient", self.ambient))
        for name in ("upper", "lower"):
            if not isinstance(getattr(self, name), Cooling):
                raise InvalidInputError(f"`{name}` must be Cooling, got {getattr(self, name)!r}.")
        if self.start is not None:
            object.__setattr__(self, "start", checked_temperature("start", self.start))
        if self.sheet is not None and not isinstance(self.sheet, PassingSheet):
            raise InvalidInputError(f"`sheet` must be PassingSheet or None, got {self.sheet!r}.")

    def of(self, side: str) -> Cooling:
        """Return the cooling of the "upper" or "lower" roller."""
        return self.upper if side == "upper" else self.lower
