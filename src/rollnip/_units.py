"""Quantities with their units, as industry writes them, into mm, N, MPa, s.

A whitelist: what is not in the table is refused, never guessed. Conversions are exact fractions
rounded once, so ``"0.1 in"`` is the float nearest to 2.54.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from math import floor, inf, isfinite, log10, pi, tau
from typing import Literal

from rollnip._errors import InvalidInputError
from rollnip._heat_units import CONDUCTIVITY, EXPANSION, FILM, HEAT_CAPACITY

Dimension = Literal[
    "length",
    "line load",
    "force",
    "pressure",
    "speed",
    "time",
    "temperature",
    "temperature difference",
    "ratio",
    "molar energy",
    "frequency",
    "angle",
    "density",
    "turn per length",
    "thermal conductivity",
    "heat capacity",
    "film coefficient",
    "thermal expansion",
]


@dataclass(frozen=True, slots=True)
class _DimensionUnits:
    """A dimension: how it is called, its base unit, an example, its units as (scale, offset)."""

    called: str
    base: str
    example: str
    units: dict[str, tuple[Fraction, Fraction]]


_IN = Fraction("25.4")  # mm
_LBF = Fraction("4.4482216152605")  # N
_KGF = Fraction("9.80665")  # N
_SPACED = re.compile(r"\s*([/*·⋅])\s*")
_QUANTITY = re.compile(r"\s*([+-]?)([0-9.,]*[0-9][0-9.,]*)([eE][+-]?[0-9]+)?\s*(.*?)\s*", re.DOTALL)
_NUMBER = re.compile(r"[0-9]+(?:[.,][0-9]+)?|[0-9]+\.|[.,][0-9]+")
_GROUPED = re.compile(r"[1-9][0-9]{0,2},[0-9]{3}")
_SAME = str.maketrans({"µ": "u", "μ": "u", "²": "2", "°": "deg", "*": " ", "·": " ", "⋅": " "})
_MINUS = str.maketrans({"\u2212": "-"})
_LONGEST = 60


def _units(table: dict[str, Fraction | int | str]) -> dict[str, tuple[Fraction, Fraction]]:
    return {name: (Fraction(scale), Fraction(0)) for name, scale in table.items()}


_LENGTH = _units(
    {
        "mm": 1,
        "um": "1e-3",
        "micron": "1e-3",
        "nm": "1e-6",
        "cm": 10,
        "dm": 100,
        "m": 1000,
        "in": _IN,
        "inch": _IN,
        '"': _IN,
        "″": _IN,
        "ft": 12 * _IN,
        "'": 12 * _IN,
        "′": 12 * _IN,
        "mil": _IN / 1000,
        "thou": _IN / 1000,
    }
)
_LINE_LOAD = _units(
    {
        "N/mm": 1,
        "N/cm": "0.1",
        "N/m": "1e-3",
        "kN/mm": 1000,
        "kN/cm": 100,
        "kN/m": 1,
        "daN/cm": 1,
        "daN/mm": 10,
        "kgf/mm": _KGF,
        "kgf/cm": _KGF / 10,
        "kgf/m": _KGF / 1000,
        "kp/cm": _KGF / 10,
        "lbf/in": _LBF / _IN,
        "lbf/ft": _LBF / (12 * _IN),
        "pli": _LBF / _IN,
        "PLI": _LBF / _IN,
    }
)
_FORCE = _units(
    {
        "N": 1,
        "mN": "1e-3",
        "daN": 10,
        "kN": 1000,
        "kgf": _KGF,
        "kp": _KGF,
        "lbf": _LBF,
        "N mm/mm": 1,
        "Nmm/mm": 1,
        "N mm/m": "1e-3",
        "Nmm/m": "1e-3",
        "N m/m": 1,
        "Nm/m": 1,
        "N m/mm": 1000,
        "Nm/mm": 1000,
        "kN m/m": 1000,
        "kNm/m": 1000,
        "lbf in/in": _LBF,
        "lbf ft/ft": _LBF,
    }
)
_PRESSURE = _units(
    {
        "MPa": 1,
        "N/mm2": 1,
        "Pa": "1e-6",
        "N/m2": "1e-6",
        "hPa": "1e-4",
        "kPa": "1e-3",
        "GPa": 1000,
        "N/cm2": "1e-2",
        "kN/mm2": 1000,
        "kN/m2": "1e-3",
        "bar": "0.1",
        "mbar": "1e-4",
        "psi": _LBF / _IN**2,
        "ksi": 1000 * _LBF / _IN**2,
        "lbf/in2": _LBF / _IN**2,
        "kgf/cm2": _KGF / 100,
        "kgf/mm2": _KGF,
    }
)
_SPEED = _units(
    {
        "mm/s": 1,
        "cm/s": 10,
        "m/s": 1000,
        "mm/min": Fraction(1, 60),
        "m/min": Fraction(1000, 60),
        "m/h": Fraction(1000, 3600),
        "km/h": Fraction(1000000, 3600),
        "in/s": _IN,
        "in/min": _IN / 60,
        "ft/s": 12 * _IN,
        "ft/min": _IN / 5,
        "fpm": _IN / 5,
    }
)
_TIME = _units({"s": 1, "ms": "1e-3", "us": "1e-6", "ns": "1e-9", "min": 60, "h": 3600})
_TEMPERATURE = {
    "degC": (Fraction(1), Fraction(0)),
    "K": (Fraction(1), Fraction("-273.15")),
    "degF": (Fraction(5, 9), Fraction(-160, 9)),
}
_RATIO = _units({"": 1, "1": 1, "%": "1e-2"})
# A radian a second is 1/(2 pi) Hz, a degree pi/180: no fractions, so the nearest floats stand.
_FREQUENCY = _units(
    {"Hz": 1, "mHz": "1e-3", "kHz": 1000, "MHz": 1_000_000, "GHz": 10**9, "1/min": Fraction(1, 60)}
) | {"rad/s": (Fraction(1.0 / tau), Fraction(0))}
_ANGLE = _units({"rad": 1, "mrad": "1e-3"}) | {"deg": (Fraction(pi / 180.0), Fraction(0))}
_POUND = Fraction("0.45359237")  # kg
_DENSITY = _units(
    {
        "kg/m3": 1,
        "g/cm3": 1000,
        "kg/dm3": 1000,
        "lb/in3": _POUND / (_IN / 1000) ** 3,
        "lb/ft3": _POUND / (12 * _IN / 1000) ** 3,
    }
)
_TURN = _units({"1/mm": 1, "1/m": "1e-3", "rad/mm": 1, "rad/m": "1e-3", "1/in": 1 / _IN})
_MOLAR = _units({"kJ/mol": 1, "J/mol": "1e-3", "kcal/mol": "4.184", "cal/mol": "4.184e-3"})

_KINDS: dict[Dimension, _DimensionUnits] = {
    "length": _DimensionUnits("a length", "mm", "4.5 mm", _LENGTH),
    "line load": _DimensionUnits("a force per length", "N/mm", "1.78 N/mm", _LINE_LOAD),
    "force": _DimensionUnits("a force (or torque per length)", "N", "27.8 N", _FORCE),
    "pressure": _DimensionUnits("a pressure or modulus", "MPa", "0.91 MPa", _PRESSURE),
    "speed": _DimensionUnits("a speed", "mm/s", "20 m/min", _SPEED),
    "time": _DimensionUnits("a time", "s", "7 ms", _TIME),
    "temperature": _DimensionUnits("a temperature", "degC", "23 degC", _TEMPERATURE),
    "temperature difference": _DimensionUnits(
        "a temperature difference", "K", "51.6 K", _units({"K": 1})
    ),
    "ratio": _DimensionUnits("a plain number", "", "0.5 %", _RATIO),
    "frequency": _DimensionUnits("a frequency", "Hz", "10 Hz", _FREQUENCY),
    "angle": _DimensionUnits("an angle", "rad", "10 deg", _ANGLE),
    "density": _DimensionUnits("a density", "kg/m3", "7850 kg/m3", _DENSITY),
    "turn per length": _DimensionUnits("an angle per length", "1/mm", "0.1 1/m", _TURN),
    "thermal conductivity": _DimensionUnits(
        "a thermal conductivity", "W/(m K)", "0.25 W/(m K)", _units(CONDUCTIVITY)
    ),
    "heat capacity": _DimensionUnits(
        "a heat capacity per mass", "J/(kg K)", "1900 J/(kg K)", _units(HEAT_CAPACITY)
    ),
    "film coefficient": _DimensionUnits(
        "a film coefficient", "W/(m2 K)", "30 W/(m2 K)", _units(FILM)
    ),
    "thermal expansion": _DimensionUnits(
        "a thermal expansion", "1/K", "2e-4 1/K", _units(EXPANSION)
    ),
    "molar energy": _DimensionUnits("an energy per mole", "kJ/mol", "60 kJ/mol", _MOLAR),
}

_MASS_OR_FORCE = 'may be a mass or a force; write "lbf", "pli" (= lbf/in), "kgf" or newtons'
_REFUSED = {
    "C": 'is the coulomb; write "degC"',
    "F": 'is the farad; write "degF"',
    "rpm": "is not a surface speed; give the circumferential speed, such as 20 m/min",
    "kn/m": 'is not a unit; kilonewtons are written "kN/m"',
    "1/s": 'may be turns or radians a second; write "Hz" or "rad/s"',
    **dict.fromkeys(("ShoreA", "Shore A"), "is no pressure; give `shore_a` instead of `modulus`"),
} | dict.fromkeys(
    ("lb", "lbs", "lb/in", "lbs/in", "lb/ft", "kg", "kg/cm", "kg/m", "kg/mm", "kg/cm2", "g"),
    _MASS_OR_FORCE,
)


def parse_quantity(value: object, dimension: Dimension, *, infinite: bool = False) -> float:
    """Read a number in base units, or a text that carries its unit.

    Parameters
    ----------
    value : number in the base unit, or text: ``"2 in"``, ``"1.78 kN/m"``, ``"4,5 mm"``.
    dimension : what it must be: ``"length"``, ``"pressure"``, ...
    infinite : whether ``inf`` is a value (the radius of a plane).

    Returns
    -------
    float
        in mm, N/mm, N, MPa, mm/s, s, degC, 1, kJ/mol, Hz or rad.

    Raises
    ------
    InvalidInputError
        where the number or the unit cannot be read beyond doubt, or is of another dimension.
    """
    if isinstance(value, int | float) and not isinstance(value, bool):
        return _checked(_rounded(value), value, infinite)
    if not isinstance(value, str):
        raise _refusal(dimension, value, "it is neither a number nor a text")
    if infinite and value.strip() in ("inf", "+inf"):
        return inf
    return _read(value, dimension)


@lru_cache(maxsize=1024)  # the cases of a sweep hold the same few texts, over and over
def _read(value: str, dimension: Dimension) -> float:
    if len(value) > _LONGEST:
        raise _refusal(dimension, value[:20] + "...", f"it is longer than {_LONGEST} characters")
    match = _QUANTITY.fullmatch(value.translate(_MINUS))
    if match is None:
        sought = "no number with a unit" if base_unit(dimension) else "no number"
        raise _refusal(dimension, value, f"{sought} can be read from it")
    sign, digits, exponent, written = match.groups()
    scale, offset = _unit(_spelled(written), written, value, dimension)
    number = _number(sign, digits, exponent or "", value, dimension)
    return _checked(_rounded(number * scale + offset), value, infinite=False)


def base_unit(dimension: Dimension) -> str:
    """The unit a plain number of this dimension is in; empty for a ratio."""
    return _KINDS[dimension].base


def known_units(dimension: Dimension) -> tuple[str, ...]:
    """Spellings accepted for this dimension; the plain form of each (um, N/mm2, degC)."""
    return tuple(name for name in _KINDS[dimension].units if name)


def conversions(dimension: Dimension) -> dict[str, tuple[float, float]]:
    """Scale and offset of each unit: value in the base unit = number * scale + offset."""
    return {
        name: (float(scale), float(offset))
        for name, (scale, offset) in _KINDS[dimension].units.items()
    }


def example(dimension: Dimension) -> str:
    """A quantity of this dimension as one may write it."""
    return _KINDS[dimension].example


def format_quantity(value: float, unit: str = "", *, digits: int | None = None) -> str:
    """Write a number with its unit.

    Parameters
    ----------
    value :
        in that unit.
    unit :
        written after the number; empty for a ratio.
    digits :
        significant digits; None writes every digit, so that reading gives the same float back.

    Returns
    -------
    str
        such as ``"0.2940 mm"``.
    """
    number = repr(float(value)) if digits is None else _significant(value, digits)
    return f"{number} {unit}".rstrip()


def _significant(value: float, digits: int) -> str:
    if not isfinite(value):
        return str(value)
    if value == 0.0:
        return "0"
    power = floor(log10(abs(value)))
    if -4 <= power < digits + 2:
        return f"{value:.{max(digits - 1 - power, 0)}f}"
    return f"{value:.{digits - 1}e}"


def _number(sign: str, digits: str, exponent: str, value: str, dimension: Dimension) -> Fraction:
    if _NUMBER.fullmatch(digits) is None:
        raise _refusal(dimension, value, "the number is not written in one clear way")
    if _GROUPED.fullmatch(digits):
        plain, pointed = digits.replace(",", ""), digits.replace(",", ".")
        raise _refusal(dimension, value, f"the comma may mean {plain} or {pointed}; write a point")
    text = sign + digits.replace(",", ".") + exponent
    size = float(text)
    if not isfinite(size) or (size == 0.0 and digits.strip("0.,")):
        raise _refusal(dimension, value, "the number is beyond what can be computed with")
    return Fraction(text) if size else Fraction(0)


def _rounded(number: Fraction | float) -> float:
    try:
        return float(number)
    except OverflowError:
        return inf if number > 0 else -inf


def _spelled(written: str) -> str:
    joined = " ".join(_SPACED.sub(r"\1", written.replace("**", "^")).translate(_SAME).split())
    return joined.replace("^2", "2")


def _unit(unit: str, written: str, value: str, dimension: Dimension) -> tuple[Fraction, Fraction]:
    kind = _KINDS[dimension]
    if unit in kind.units:
        return kind.units[unit]
    if not unit:
        # 10 without a unit is seldom 10 rad; the example of the refusal, in degrees, is enough.
        written = "" if dimension == "angle" else f', as in "{value.strip()} {kind.base}"'
        raise _refusal(dimension, value, f"it needs a unit{written}")
    if unit[:3].isdigit():  # "1 780 N/m", and no "1/s"
        raise _refusal(dimension, value, "there is a space within the number")
    if unit in _REFUSED:
        raise _refusal(dimension, value, f'"{written}" {_REFUSED[unit]}')
    for other in _KINDS.values():
        if unit in other.units:
            raise _refusal(dimension, value, f"that is {other.called}")
    raise _refusal(dimension, value, f'"{written}" is not a known unit' + _nearest(unit, kind))


def _nearest(unit: str, kind: _DimensionUnits) -> str:
    if unit.partition("/")[2][:1].isdigit():
        return "; write a fraction as a decimal number"
    folded = [name for name in kind.units if name.casefold() == unit.casefold()]
    if not folded:
        from difflib import get_close_matches

        folded = get_close_matches(unit, kind.units, n=1, cutoff=0.5)
    return f'; did you mean "{folded[0]}"?' if folded else ""


def _checked(number: float, value: object, infinite: bool) -> float:
    if isfinite(number) or (infinite and number == inf):
        return number
    shown = text if len(text := str(value)) <= _LONGEST else f"{text[:20]}..."
    raise InvalidInputError(f"must be a finite number, got {shown}.")


def _refusal(dimension: Dimension, value: object, why: str) -> InvalidInputError:
    kind = _KINDS[dimension]
    shown = f'"{value}"' if isinstance(value, str) else repr(value)
    end = why if why.endswith("?") else f"{why}."
    return InvalidInputError(f'must be {kind.called} such as "{kind.example}", got {shown}: {end}')
