"""Quantities as people type them: fractions of an inch, units in any case, "65A", "68 F".

Case files know one spelling of each unit (`rollnip._units`); a box on a page is more patient. What
is not in the table here goes to the reader of case files as it is, and is refused in its words.
"""

from __future__ import annotations

import re
from fractions import Fraction

from rollnip._errors import InvalidInputError
from rollnip._units import Dimension, parse_quantity

_SIGNS = str.maketrans(
    {"½": " 1/2", "¼": " 1/4", "¾": " 3/4", "”": '"', "“": '"', "″": '"', "\u2212": "-"}
)
_FRACTION = re.compile(
    r"\s*([+-]?)(?:(\d{1,9})(?:\s+|\s*-\s*))?(\d{1,9})\s*/\s*(\d{1,9})(?!\d)(.*)"
)
_NUMBER = re.compile(r"\s*([+-]?[0-9.,]*[0-9][0-9.,]*(?:[eE][+-]?[0-9]+)?)\s*(.*?)\s*")
_SPELLINGS: dict[Dimension, dict[str, str]] = {
    "length": {
        "in": "in inch inches \" ''",
        "ft": "ft foot feet",
        "mil": "mil mils thou",
        "mm": "mm millimeter millimeters millimetre millimetres",
        "cm": "cm centimeter centimeters centimetre centimetres",
        "m": "m meter meters metre metres",
    },
    "line load": {
        "pli": "pli lb/in lbs/in lbf/in lb/inch lbs/inch lbf/inch lb/in. ppi pounds/inch",
        "lbf/ft": "lb/ft lbs/ft lbf/ft plf",
        "N/mm": "n/mm",
        "N/cm": "n/cm",
        "N/m": "n/m",
        "kN/m": "kn/m",
        "kgf/cm": "kg/cm kgf/cm kp/cm",
    },
    "force": {
        "lbf": "lb lbs lbf pound pounds",
        "N": "n newton newtons",
        "kN": "kn",
        "daN": "dan",
        "kgf": "kg kgf kp",
    },
    "pressure": {"psi": "psi lb/in2 lbs/in2", "MPa": "mpa n/mm2", "kPa": "kpa", "bar": "bar bars"},
    "speed": {
        "fpm": "fpm ft/min feet/min",
        "m/min": "m/min mpm",
        "mm/s": "mm/s",
        "m/s": "m/s mps",
        "ft/s": "ft/s fps",
    },
    "temperature": {
        "degC": "c °c degc celsius centigrade",
        "degF": "f °f degf fahrenheit",
        "K": "k kelvin",
    },
    "time": {"s": "s sec secs second seconds", "ms": "ms msec", "min": "min mins minutes"},
    "ratio": {"%": "% percent pct"},
}
_UNITS = {
    dimension: {word: unit for unit, words in table.items() for word in words.split()}
    for dimension, table in _SPELLINGS.items()
}
_SHORE_A = {"", "a", "sha", "shorea", "°a", "°sha", "°shorea", "durometer", "duro", "shore"}
_FORCES = {"n", "kn", "dan", "lb", "lbs", "lbf", "kg", "kgf", "kp", "ton", "t"}
_SHORE_D = "Shore D is a scale for harder materials; give the modulus instead"
_SHORE_00 = "Shore 00 is a scale for foams; give the modulus instead"
_PJ = "P&J runs the other way round, in hundredths of a millimetre; give Shore A or the modulus"
_OTHER_SCALES = {
    "d": _SHORE_D,
    "shored": _SHORE_D,
    "irhd": "IRHD is another scale, close to Shore A for rubber; type the number alone to use it",
    "00": _SHORE_00,
    "shore00": _SHORE_00,
    "p&j": _PJ,
    "pj": _PJ,
}


def read(text: str, dimension: Dimension, unit: str = "", *, is_hardness: bool = False) -> float:
    """Read what a person typed into a box.

    Parameters
    ----------
    text :
        such as ``1/2"``, ``8 IN``, ``0.5 in.``, ``40 lb/in``, ``68 F``, ``65A``.
    dimension :
        dimension of the quantity.
    unit :
        unit of a number that stands alone.
    is_hardness :
        whether it is a Shore A hardness, which is a plain number.

    Returns
    -------
    float
        in the base unit.

    Raises
    ------
    InvalidInputError
        where it cannot be read beyond doubt; says what to type instead.
    """
    number, written = _parted(text)
    if number is None:
        return _hardness(text, "?") if is_hardness else parse_quantity(text, dimension)
    if is_hardness:
        return _hardness(number, written)
    spelled = _UNITS.get(dimension, {}).get(_folded(written)) or _UNITS.get(dimension, {}).get(
        _folded(written).rstrip(".")
    )
    if dimension == "line load" and _folded(written) in _FORCES:
        raise InvalidInputError(
            f'must be a force per width of the face such as "20 pli" or "4 N/mm", got "{text}": '
            "for a force on the whole roller choose Force."
        )
    return parse_quantity(f"{number} {spelled or written or unit}".rstrip(), dimension)


def _parted(text: str) -> tuple[str | None, str]:
    """The number, a fraction as a decimal one, and the unit as typed; None where there is none."""
    plain = text.translate(_SIGNS)
    if match := _FRACTION.fullmatch(plain):
        sign, whole, above, below, rest = match.groups()
        if int(below) > 0:
            value = int(whole or 0) + Fraction(int(above), int(below))
            return f"{sign}{float(value)!r}", rest.strip()
    match = _NUMBER.fullmatch(plain)
    return (match[1], match[2]) if match else (None, "")


def _folded(written: str) -> str:
    """A unit without blanks and capitals; "degrees" is a sign."""
    folded = "".join(written.split()).lower().replace("²", "2").replace("^2", "2")
    return re.sub(r"^deg(?:rees?)?\.?(?=[cf])", "°", folded)


def _hardness(number: str, written: str) -> float:
    scale = _folded(written).replace(".", "")
    if scale in _SHORE_A:
        return parse_quantity(number, "ratio")
    got = f"{number} {written}".removesuffix(" ?")
    why = _OTHER_SCALES.get(scale, "a hardness is a plain number or Shore A")
    raise InvalidInputError(f'must be a hardness such as "65" or "65 Shore A", got "{got}": {why}.')
