"""Column heads of tables of measurements, in English and German: their meaning and their units."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal

from rollnip._errors import InvalidInputError
from rollnip._units import Dimension, parse_quantity

MeasuredQuantity = Literal[
    "frequency",
    "temperature",
    "storage",
    "loss",
    "absolute",
    "tan delta",
    "phase",
    "time",
    "relaxation",
    "compliance",
]
Modulus = Literal["E", "G"]

DIMENSIONS: dict[MeasuredQuantity, Dimension] = {
    "frequency": "frequency",
    "temperature": "temperature",
    "storage": "pressure",
    "loss": "pressure",
    "absolute": "pressure",
    "tan delta": "ratio",
    "phase": "angle",
    "time": "time",
    "relaxation": "pressure",
    "compliance": "pressure",  # its reciprocal
}
SHOWN: dict[MeasuredQuantity, str] = {
    "frequency": "frequency",
    "temperature": "temperature",
    "storage": "storage modulus",
    "loss": "loss modulus",
    "absolute": "size of the complex modulus",
    "tan delta": "tan delta",
    "phase": "phase angle",
    "time": "time",
    "relaxation": "relaxation modulus",
    "compliance": "creep compliance",
}
ANGULAR = "angular "

_NAMES: dict[MeasuredQuantity, tuple[str, ...]] = {
    "frequency": ("frequency", "freq", "freq.", "f", "frequenz", "messfrequenz", "prüffrequenz"),
    "temperature": (
        *("temperature", "temp", "temp.", "temperatur", "sample temperature"),
        *("probentemperatur", "messtemperatur", "prüftemperatur"),
    ),
    "storage": ("storage modulus", "speichermodul", "stor", "storage", "mod. storage"),
    "loss": ("loss modulus", "verlustmodul", "loss", "mod. loss"),
    "absolute": (
        *("complex modulus", "komplexer modul", "dynamic modulus", "dynamischer modul", "comp"),
        *("betrag des komplexen moduls", "absolute modulus", "magnitude of complex modulus"),
    ),
    "tan delta": (
        *("tan delta", "tan(delta)", "tan d", "tan_delta", "tand", "tandelta", "tan del", "tan"),
        *("tan δ", "tanδ", "tan(δ)", "loss factor", "verlustfaktor", "loss tangent"),
        *("e''/e'", "g''/g'", "e'' / e'", "g'' / g'"),
        *("damping factor", "dämpfungsfaktor", "verlusttangens"),
    ),
    "phase": (
        *("phase angle", "phase", "phasenwinkel", "phasenverschiebung", "delta", "δ"),
        *("loss angle", "verlustwinkel", "phase shift", "raw phase"),
    ),
    "time": ("step time", "time", "zeit", "messzeit", "test time", "schrittzeit", "elapsed time"),
    "relaxation": ("relaxation modulus", "relaxationsmodul", "relax", "stress relaxation modulus"),
    "compliance": ("creep compliance", "kriechnachgiebigkeit", "compliance", "nachgiebigkeit"),
}
_ANGULAR_NAMES = (
    *("angular frequency", "ang. frequency", "ang frequency", "omega", "ω", "w"),
    *("kreisfrequenz", "winkelfrequenz", "angular freq", "angular freq."),
)
_SYMBOLS: dict[str, tuple[MeasuredQuantity, Modulus | None]] = {
    "e'": ("storage", "E"),
    "g'": ("storage", "G"),
    "e''": ("loss", "E"),
    "g''": ("loss", "G"),
    **dict.fromkeys(("|e*|", "e*", "|e|"), ("absolute", "E")),
    **dict.fromkeys(("|g*|", "g*", "|g|"), ("absolute", "G")),
    **dict.fromkeys(("e(t)", "er(t)", "e(t) relaxation", "et"), ("relaxation", "E")),
    **dict.fromkeys(("g(t)", "gr(t)", "gt"), ("relaxation", "G")),
    **dict.fromkeys(("d(t)",), ("compliance", "E")),
    **dict.fromkeys(("j(t)", "j", "jt"), ("compliance", None)),
}
_KINDS = {
    **dict.fromkeys(("e", "tensile", "young's", "youngs", "elastic", "zug", "e-modul"), "E"),
    **dict.fromkeys(("g", "shear", "schub", "scher", "torsion"), "G"),
}
_LETTERS: dict[str, Dimension] = {
    "f": "frequency",
    "w": "frequency",
    "delta": "angle",
    "δ": "angle",
}
_QUANTITIES = {name: quantity for quantity, names in _NAMES.items() for name in names}
_PRIMES = str.maketrans({"″": "''", "′": "'", '"': "''", "’": "'", "´": "'", "`": "'", "_": " "})
_BRACKETS = re.compile(r"(.*?)\s*[\[(]([^\[\]()]*)[\])]", re.DOTALL)
_SLASH = re.compile(r"(.*?)\s*/\s*(\S.*)", re.DOTALL)
_IN = re.compile(r"(.*?)\s+in\s+(\S.*)", re.DOTALL)
_COMMA = re.compile(r"(.*?)\s*,\s*(\S.*)", re.DOTALL)
_SPELLED = {
    **dict.fromkeys(
        ("°C", "ºC", "C", "deg C", "deg. C", "Grad C", "Grad Celsius", "Celsius"), "degC"
    ),
    **dict.fromkeys(("°F", "ºF", "F", "deg F"), "degF"),
    **dict.fromkeys(("°K", "Kelvin"), "K"),
}
_ANGLES = dict.fromkeys(("°", "º", "deg", "degree", "degrees", "Grad"), "deg")
_TIMES = {"sec": "s", "sec.": "s", "seconds": "s", "Sek": "s", "Sek.": "s", "minutes": "min"}
_ANGULAR_UNITS = dict.fromkeys(
    ("rad/s", "1/s", "s-1", "s^-1", "s⁻¹", "rad/sec", "rad s-1", "rad·s⁻¹", "rad/ s"), "rad/s"
)
_RATIOS = dict.fromkeys(("-", "", "[]", "1", "[-]", "none"), "")
_RECIPROCAL = re.compile(r"1\s*/\s*(\S+)|(\S+?)\s*(?:\^-1|-1|⁻¹)")
_UNITS = {
    *("Hz", "mHz", "kHz", "MHz", "rad/s", "1/s", "s", "ms", "min", "h", "Pa", "kPa", "MPa", "GPa"),
    *("N/mm2", "N/mm²", "psi", "degC", "K", "degF", "rad", "deg", "%", "-", "°", "N", "mN", "mm"),
    *("um", "µm", "Pa·s", "Pa.s", "Pa s", "1/Pa", "1/MPa", "N/m", "bar", "hPa", "dyn/cm2", "N.m"),
    *("µN.m", "Nm", "µN·m", "mNm", "g", "g/min", "cm", "°C/min", "K/min", "N/m2", "N/m²"),
    *_SPELLED,
    *_ANGLES,
    *_TIMES,
    *_ANGULAR_UNITS,
}


@dataclass(frozen=True, slots=True)
class Head:
    """The meaning of a column head.

    Attributes
    ----------
    text : the head as written.
    quantity : the quantity measured; None where it is not one that is used.
    kind : E or G, where the head says which modulus.
    unit : the unit as written; None where there is none.
    angular : whether its name denotes an angular frequency.
    """

    text: str
    quantity: MeasuredQuantity | None
    kind: Modulus | None = None
    unit: str | None = None
    angular: bool = False


def read_head(text: str, below: str | None = None) -> Head:
    """Read a head such as ``E' / MPa``, ``Speichermodul [Pa]`` or ``Angular frequency (rad/s)``.

    ``below`` is the unit that stands under it in a row of units, if there is one.
    """
    shown = " ".join(text.split())
    for pattern in (None, _BRACKETS, _SLASH, _IN, _COMMA):
        match = None if pattern is None else pattern.fullmatch(shown)
        if pattern is not None and match is None:
            continue
        name, unit = (shown, below) if match is None else (match[1], match[2].strip())
        found = _meaning(name, unit)
        if found is not None:
            quantity, kind, angular = found
            return Head(shown, quantity, kind, unit, angular)
    match = _BRACKETS.fullmatch(shown)
    return Head(shown, None, unit=below if match is None else match[2].strip())


def is_unit(text: str) -> bool:
    """Return whether a cell may stand in a row of units: a unit, perhaps in brackets, or empty."""
    bare = text.strip().strip("[]()").strip()
    return bare in _UNITS or bare in _RATIOS


def bare_unit(text: str) -> str:
    """Return a cell of a row of units without its brackets."""
    return text.strip().strip("[]()").strip()


def scale_of(head: Head, unit: str | None, where: str) -> tuple[float, float]:
    """Return scale and offset from a column's unit to the base unit (Hz, degC, MPa, rad, s, 1/MPa).

    Raises
    ------
    InvalidInputError
        where the unit is missing, unknown or of another dimension; the message says what to write.
    """
    quantity = head.quantity
    assert quantity is not None
    dimension = DIMENSIONS[quantity]
    written = None if unit is None else _spelled(head, unit)
    if written is None or (written == "" and dimension != "ratio"):
        if dimension == "ratio":
            return 1.0, 0.0
        raise InvalidInputError(
            f'{where}: column "{head.text}" must say its unit; write "{_bare(head.text)} '
            f'[{_example(head)}]", or the unit into a row of its own below the heads.'
        )
    if head.angular and written == "Hz":
        raise InvalidInputError(
            f'{where}: column "{head.text}" must be in rad/s, got "{unit}"; if it is in Hz, call '
            'it "frequency".'
        )
    if quantity == "compliance":
        return 1.0 / _converted(_reciprocal(head, written, where), dimension, head, where)[0], 0.0
    return _converted(written, dimension, head, where)


def _converted(unit: str, dimension: Dimension, head: Head, where: str) -> tuple[float, float]:
    try:
        one, zero = (parse_quantity(f"{n} {unit}", dimension) for n in (1, 0))
    except InvalidInputError as problem:
        raise InvalidInputError(f'{where}: unit of column "{head.text}" {problem}') from None
    return one - zero, zero


def _reciprocal(head: Head, unit: str, where: str) -> str:
    match = _RECIPROCAL.fullmatch(unit)
    if match is None:
        raise InvalidInputError(
            f'{where}: column "{head.text}" is a compliance and must be in 1/Pa or 1/MPa, got '
            f'"{unit}".'
        )
    return match[1] or match[2]


def _spelled(head: Head, unit: str) -> str:
    """Return the unit as the parser of quantities spells it.

    Spellings such as C, F or Grad are unambiguous once the quantity is known.
    """
    quantity = head.quantity
    if quantity == "temperature":
        return _SPELLED.get(unit, unit)
    if quantity == "phase":
        return _ANGLES.get(unit, unit)
    if quantity == "time":
        return _TIMES.get(unit, unit)
    if quantity == "tan delta":
        return _RATIOS.get(unit, unit)
    if quantity == "frequency" and head.angular:
        return _ANGULAR_UNITS.get(unit, unit)
    return unit


def _example(head: Head) -> str:
    if head.quantity == "frequency":
        return "rad/s" if head.angular else "Hz"
    if head.quantity == "compliance":
        return "1/MPa"
    return {"temperature": "degC", "phase": "deg", "time": "s"}.get(str(head.quantity), "MPa")


def _bare(text: str) -> str:
    match = _BRACKETS.fullmatch(text)
    return text if match is None else match[1]


def _meaning(name: str, unit: str | None) -> tuple[MeasuredQuantity, Modulus | None, bool] | None:
    plain = " ".join(name.strip().translate(_PRIMES).lower().split())
    if plain == "t":  # temperature or time: the unit decides, else upper or lower case
        is_time = unit in {"s", "ms", "min", "h", *_TIMES} or (not unit and name.strip() == "t")
        return ("time" if is_time else "temperature"), None, False
    if plain in _LETTERS and unit and not _fits(unit, _LETTERS[plain]):
        return None  # f [N] is a force, delta [mm] a displacement
    if plain in _ANGULAR_NAMES:
        return "frequency", None, True
    if plain in _QUANTITIES:
        return _QUANTITIES[plain], None, False
    if plain in _SYMBOLS:
        return *_SYMBOLS[plain], False
    return _composed(plain)


def _fits(unit: str, dimension: Dimension) -> bool:
    if unit in _ANGLES or unit in _ANGULAR_UNITS or unit in {"C", "°C"}:
        return True
    try:
        parse_quantity(f"1 {unit}", dimension)
    except InvalidInputError:
        return False
    return True


def _unbracketed(part: str) -> str:
    """Return a part of a head without enclosing brackets and adjacent dashes or commas."""
    trimmed = part.strip(" ,-")
    closed = trimmed[:1] + trimmed[-1:] in {"()", "[]"} and trimmed.count("(") < 2
    return trimmed[1:-1].strip() if closed else trimmed


def _composed(plain: str) -> tuple[MeasuredQuantity, Modulus | None, bool] | None:
    """Interpret heads of two names, such as ``shear storage modulus`` or ``speichermodul e'``.

    Also ``e stor`` and ``verlustfaktor tan delta``.
    """
    words = plain.split()
    for cut in range(1, len(words)):
        first, rest = " ".join(words[:cut]), " ".join(words[cut:])
        for one, other in ((first, rest), (rest, first)):
            one, other = _unbracketed(one), _unbracketed(other)
            quantity = _QUANTITIES.get(one)
            if one in _ANGULAR_NAMES and other in _ANGULAR_NAMES:
                return "frequency", None, True
            if quantity is None:
                continue
            if other in _KINDS:
                return quantity, "E" if _KINDS[other] == "E" else "G", False
            if other in _SYMBOLS and _SYMBOLS[other][0] == quantity:
                return quantity, _SYMBOLS[other][1], False
            if _QUANTITIES.get(other) == quantity:
                return quantity, None, False
            if other in _ANGULAR_NAMES and quantity == "frequency":
                return quantity, None, True
            if one == "complex modulus" and other.rstrip("*") in _KINDS:
                return quantity, "E" if _KINDS[other.rstrip("*")] == "E" else "G", False
    return None
