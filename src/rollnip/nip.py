"""The problem: two rollers, their load and drive, friction and speed, perhaps a sheet."""

from __future__ import annotations

from dataclasses import dataclass
from types import NoneType

from rollnip._errors import (
    InvalidInputError,
    require_finite,
    require_friction,
    require_positive,
    require_speed,
    with_hints,
)
from rollnip.rollers import Roller
from rollnip.sheets import Sheet

_WIDEST = 1e7  # mm; ten kilometres, the limit of radii, too
_LEFT_OUT = float("nan")  # stands for friction that was not given
_SMALLEST = 1e-15  # mm or N/mm: far below what can be measured, far above what underflows


@dataclass(frozen=True, slots=True)
class LineLoad:
    """Prescribed line load F = int p dx [N/mm], positive, at least 1e-15."""

    load: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "load", _measurable("load", self.load, "N/mm"))


@dataclass(frozen=True, slots=True)
class Approach:
    """Prescribed approach of the axles from first touch [mm], positive, at least 1e-15."""

    approach: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "approach", _measurable("approach", self.approach, "mm"))


@dataclass(frozen=True, slots=True)
class Traction:
    """Prescribed traction T = int q dx [N/mm]; T > 0: the upper roller drives the lower one."""

    traction: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "traction", require_finite("traction", self.traction))


@dataclass(frozen=True, slots=True)
class Creepage:
    """Prescribed creepage xi = (V_u - V_l)/V, between -2 and 2."""

    creepage: float

    def __post_init__(self) -> None:
        creepage = require_finite("creepage", self.creepage)
        if not -2.0 < creepage < 2.0:
            raise InvalidInputError(f"`creepage` must lie between -2 and 2, got {self.creepage!r}.")
        object.__setattr__(self, "creepage", creepage)


@dataclass(frozen=True, slots=True)
class Torque:
    """Prescribed driving torque on the lower axle per axial length [N]; 0: an idler."""

    torque_lower: float = 0.0

    def __post_init__(self) -> None:
        torque = require_finite("torque_lower", self.torque_lower)
        object.__setattr__(self, "torque_lower", torque)


@with_hints(
    load="give `normal=rn.LineLoad(1.78)`.",
    line_load="give `normal=rn.LineLoad(1.78)`.",
    approach="give `normal=rn.Approach(0.3)`.",
    traction="give `tangential=rn.Traction(0.5)`.",
    creepage="give `tangential=rn.Creepage(0.01)`.",
    torque="give `tangential=rn.Torque(0.0)`, the torque on the lower axle.",
    torque_lower="give `tangential=rn.Torque(0.0)`.",
    width="give `face_width`.",
    geometry="it belongs to the model: `rn.solve(nip, rn.Model(geometry=...))`.",
    tolerance="it belongs to the model: `rn.solve(nip, rn.Model(tolerance=...))`.",
)
@dataclass(frozen=True, slots=True, kw_only=True)
class Nip:
    """Two rollers pressed together in steady rolling.

    Parameters
    ----------
    upper, lower :
        the rollers.
    normal :
        LineLoad or Approach.
    friction :
        Coulomb coefficient mu >= 0; 0 is frictionless. It may be left out where the sheet has a
        coefficient of its own on both rollers; it is then that on the upper one.
    tangential :
        Traction, Creepage or Torque; free rolling (traction 0) by default.
    speed :
        rolling speed V [mm/s], positive, at most 1e11; needed only where a material is
        viscoelastic.
    face_width :
        axial length [mm], positive, at most 1e7, for totals; None: all figures are per axial
        length.
    title :
        free text, carried into the result; without null characters.
    sheet :
        the sheet that runs between the rollers; None: none. The traction is then the one on the
        lower roller, and the creepage the relative difference of the rollers' speeds.

    Raises
    ------
    InvalidInputError
        where a value lies outside its range, or the parts do not make a nip: both rollers rigid or
        flat; no speed for a viscoelastic material; an approach prescribed on a half-space core; a
        traction beyond mu F; a measured profile with friction, viscoelastic materials or a
        prescribed creepage.
    """

    upper: Roller
    lower: Roller
    normal: LineLoad | Approach
    friction: float = _LEFT_OUT
    tangential: Traction | Creepage | Torque = Traction(0.0)
    speed: float | None = None
    face_width: float | None = None
    title: str = ""
    sheet: Sheet | None = None

    def __post_init__(self) -> None:
        self._check_types()
        _check_title(self.title)
        friction = require_friction("friction", self._given_friction())
        object.__setattr__(self, "friction", friction)
        if self.speed is not None:
            object.__setattr__(self, "speed", require_speed("speed", self.speed))
        if self.face_width is not None:
            object.__setattr__(self, "face_width", _checked_width(self.face_width))
        self._check_rollers()
        self._check_controls()
        if self.has_profile:
            self._check_snapshot()
        if self.sheet is not None:
            self._check_sheet(self.sheet)

    @property
    def curvature(self) -> float:
        """1/R_upper + 1/R_lower [1/mm]."""
        return self.upper.curvature + self.lower.curvature

    @property
    def is_viscoelastic(self) -> bool:
        """Whether any material of either roller is viscoelastic."""
        return self.upper.is_viscoelastic or self.lower.is_viscoelastic

    def friction_on(self, side: str) -> float:
        """Return the friction coefficient on the "upper" or the "lower" roller."""
        own = None if self.sheet is None else getattr(self.sheet, f"friction_{side}")
        return self.friction if own is None else float(own)

    @property
    def has_half_space(self) -> bool:
        """Whether a core is a half-space; the approach is then not defined."""
        return self.upper.core is not None or self.lower.core is not None

    @property
    def has_profile(self) -> bool:
        """Whether either roller has a measured profile: the nip is then a frictionless snapshot."""
        return self.upper.profile is not None or self.lower.profile is not None

    def _check_types(self) -> None:
        wanted = {
            "upper": (Roller,),
            "lower": (Roller,),
            "normal": (LineLoad, Approach),
            "tangential": (Traction, Creepage, Torque),
            "sheet": (Sheet, NoneType),
        }
        for name, types in wanted.items():
            value = getattr(self, name)
            if not isinstance(value, types):
                names = " or ".join(kind.__name__.removesuffix("Type") for kind in types)
                raise InvalidInputError(f"`{name}` must be {names}, got {value!r}.")

    def _check_rollers(self) -> None:
        if self.upper.is_rigid and self.lower.is_rigid:
            if self.sheet is not None:
                raise InvalidInputError(
                    "`upper` and `lower` must not both be bare rigid cores, with a sheet either: "
                    "give one of them a `core` with its own modulus, such as 206e3 MPa of steel; "
                    "the sheet then yields nearly alone."
                )
            raise InvalidInputError(
                "`upper` and `lower` must not both be bare rigid cores: nothing would deform."
            )
        if self.curvature == 0.0:
            raise InvalidInputError(
                "`radius` must be finite for at least one roller, got two planes."
            )
        if self.is_viscoelastic and self.speed is None:
            raise InvalidInputError("`speed` must be given: a material is viscoelastic.")

    def _given_friction(self) -> float:
        """Return the friction; where it was left out, that of the sheet on the upper roller."""
        if self.friction is not _LEFT_OUT:
            return self.friction
        sheet = self.sheet
        if sheet is None or sheet.friction_upper is None or sheet.friction_lower is None:
            raise InvalidInputError(
                "`friction` must be given, the coefficient between both surfaces, such as 0.5 "
                "(0: frictionless); only a sheet with `friction_upper` and `friction_lower` of "
                "its own does without."
            )
        return sheet.friction_upper

    def _check_snapshot(self) -> None:
        """Refuse what does not go with a measured profile.

        Roughness that rolls through the nip is not a steady state. Without friction, elastic layers
        have no memory of it, so that a snapshot is a solution.
        """
        if self.friction > 0.0:
            raise InvalidInputError(
                f"`friction` must be 0 with a measured profile, got {self.friction!r}: roughness "
                "that passes through the nip is no steady state; take traction and creepage from "
                "the same nip without the profile."
            )
        if isinstance(self.tangential, Creepage):
            raise InvalidInputError(
                "`creepage` must not be prescribed with a measured profile: it is a snapshot "
                "without friction; leave it out."
            )
        if self.is_viscoelastic:
            raise InvalidInputError(
                "`profile` must go with elastic materials alone: what a viscoelastic layer answers "
                "depends on the roughness that passed before; take elastic materials with the "
                "modulus at the time that an asperity spends in the nip."
            )

    def _check_sheet(self, sheet: Sheet) -> None:
        if self.has_profile:
            raise InvalidInputError(
                "`sheet` must not go with a measured profile, which is a snapshot without "
                "friction; leave one of them out."
            )
        for side in ("upper", "lower"):
            if getattr(sheet, f"friction_{side}") is None and self.friction == 0.0:
                raise InvalidInputError(
                    f"`friction_{side}` of the sheet must be given and positive where the "
                    "`friction` of the nip is 0: without friction nothing feeds the sheet."
                )
        covering = self.upper.coating_thickness + self.lower.coating_thickness
        if not self.has_half_space and sheet.thickness >= covering:
            raise InvalidInputError(
                "`thickness` of the sheet must be smaller than the coverings are thick, "
                f"{covering:g} mm in all, got {sheet.thickness!r}; take a thinner one, or count "
                "the belt or blanket as a layer of the roller that it lies on."
            )
        if isinstance(self.normal, LineLoad):
            self._check_pull(self.normal.load)

    def _check_pull(self, load: float) -> None:
        given = self.tangential.traction if isinstance(self.tangential, Traction) else None
        for side, (pull, limit) in asked_of_friction(self, load, given).items():
            if abs(pull) < limit:
                continue
            if side == "both":
                raise InvalidInputError(
                    "`tension_in` less `tension_out` must be smaller in size than the friction of "
                    f"both rollers carries, (mu_upper + mu_lower) * load = {limit:.6g} N/mm, got "
                    f"{pull:.6g}: the sheet slips through; lower the difference, or raise "
                    "the load or the friction."
                )
            if side == "lower":
                raise InvalidInputError(
                    f"`traction` must be smaller than the lower friction * load = {limit:.6g} N/mm "
                    f"in size (beyond it the sheet slides on the lower roller), got {given!r}; "
                    "lower it, or raise the load or the friction."
                )
            raise InvalidInputError(
                "`traction` must, added to the pull on the sheet (`tension_in` - `tension_out`), "
                f"stay below the upper friction * load = {limit:.6g} N/mm in size (beyond it the "
                f"sheet slides on the upper roller), got {pull:.6g} in all; lower "
                "the pull or the traction, or raise the load or the friction."
            )

    def _check_controls(self) -> None:
        if isinstance(self.normal, Approach):
            self._check_approach(self.normal.approach)
        self._check_tangential()
        if (
            self.sheet is None
            and isinstance(self.normal, LineLoad)
            and isinstance(self.tangential, Traction)
        ):
            limit = self.friction * self.normal.load
            if self.friction > 0.0 and abs(self.tangential.traction) >= limit:
                raise InvalidInputError(
                    f"`traction` must be smaller than friction * load = {limit:.6g} N/mm "
                    f"in size (beyond it the nip slides), got {self.tangential.traction!r}."
                )

    def _check_tangential(self) -> None:
        tangential = self.tangential
        if isinstance(tangential, Torque) and self.lower.curvature == 0.0:
            raise InvalidInputError(
                "`torque_lower` must not be prescribed on a plane (radius inf); "
                "prescribe `traction` or `creepage`."
            )
        if self.friction > 0.0 or isinstance(tangential, Creepage) or self.sheet is not None:
            return
        name = "traction" if isinstance(tangential, Traction) else "torque_lower"
        value = getattr(tangential, name)
        if value != 0.0:
            raise InvalidInputError(
                f"`{name}` must be 0 without friction, got {value!r} with `friction` 0."
            )

    def _check_approach(self, approach: float) -> None:
        if self.has_half_space:
            raise InvalidInputError(
                "`approach` must not be prescribed with a half-space core (it is infinite in "
                "plane strain); prescribe `load`."
            )
        require_approach(self.upper, self.lower, approach)


def asked_of_friction(
    nip: Nip, load: float, traction: float | None
) -> dict[str, tuple[float, float]]:
    """Return what a sheet asks friction for, and what friction carries there, by place [N/mm].

    "both" rollers hold the difference of the tensions; "lower" and "upper" are each roller's share,
    where it is known. On a path of radius R shears change the tension by 1 -+ h/2R of themselves
    (`rollnip.sheet.tension`): that is left out, for only its bound is known, `lever_ratio`.

    Parameters
    ----------
    nip : with a sheet.
    load : line load [N/mm].
    traction : T_l on the lower roller [N/mm]; None where it is not known.
    """
    assert nip.sheet is not None
    upper, lower = (nip.friction_on(side) * load for side in ("upper", "lower"))
    pull = nip.sheet.tension_in - nip.sheet.tension_out
    out = {"both": (pull, upper + lower)}
    if traction is not None:
        out |= {"lower": (traction, lower), "upper": (traction + pull, upper)}
    return out


def lever_ratio(nip: Nip) -> float:
    """Return the largest h/2R of the path of a sheet, R being that of the smaller roller."""
    assert nip.sheet is not None
    return 0.5 * nip.sheet.thickness * max(nip.upper.curvature, nip.lower.curvature)


def _measurable(name: str, value: float, unit: str) -> float:
    number = require_positive(name, value)
    if number < _SMALLEST:
        raise InvalidInputError(f"`{name}` must be at least {_SMALLEST:g} {unit}, got {value!r}.")
    return number


def _checked_width(width: float) -> float:
    checked = require_positive("face_width", width)
    if checked > _WIDEST:
        raise InvalidInputError(f"`face_width` must be at most 1e7 mm, got {width!r}.")
    return checked


def _check_title(title: object) -> None:
    """Refuse titles that result files cannot hold: null characters and unpaired surrogates."""
    if not isinstance(title, str):
        raise InvalidInputError(f"`title` must be a text, got {title!r}.")
    if "\0" in title or any("\ud800" <= letter <= "\udfff" for letter in title):
        raise InvalidInputError(
            f"`title` must hold neither zero characters nor halves of one, got {title!r}."
        )


def require_approach(upper: Roller, lower: Roller, approach: float) -> None:
    """Raise InvalidInputError where rigid cores would touch, or a roller would reach an axle."""
    smallest = min(upper.radius, lower.radius)
    if approach >= smallest:
        raise InvalidInputError(
            f"`approach` must be smaller than the radius {smallest:g} mm, got {approach!r}."
        )
    covering = upper.coating_thickness + lower.coating_thickness
    if upper.core is None and lower.core is None and approach >= covering:
        raise InvalidInputError(
            f"`approach` must be smaller than the coverings are thick, {covering:g} mm in all "
            f"(there the rigid cores would touch), got {approach!r}."
        )
