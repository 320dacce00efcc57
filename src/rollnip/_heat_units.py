"""Units of conduction, heat capacity, films and thermal expansion, as factors of the base units."""

from __future__ import annotations

from fractions import Fraction

Units = dict[str, Fraction | int | str]

_BTU = Fraction("1055.05585262")  # J, of the International Table
_FOOT = Fraction("0.3048")  # m
_POUND = Fraction("0.45359237")  # kg
_PER_DEGF = Fraction(9, 5)  # of 1/degF in 1/K
CONDUCTIVITY: Units = {
    "W/(m K)": 1,
    "W/mK": 1,
    "W/m/K": 1,
    "mW/(m K)": "1e-3",
    "BTU/(h ft degF)": _BTU / 3600 / _FOOT * _PER_DEGF,
    "BTU in/(h ft2 degF)": _BTU / 3600 / _FOOT / 12 * _PER_DEGF,
}
HEAT_CAPACITY: Units = {
    "J/(kg K)": 1,
    "J/kgK": 1,
    "J/kg/K": 1,
    "kJ/(kg K)": 1000,
    "kJ/kgK": 1000,
    "J/(g K)": 1000,
    "BTU/(lb degF)": _BTU / _POUND * _PER_DEGF,
}
FILM: Units = {
    "W/(m2 K)": 1,
    "W/m2K": 1,
    "W/m2/K": 1,
    "kW/(m2 K)": 1000,
    "BTU/(h ft2 degF)": _BTU / 3600 / _FOOT**2 * _PER_DEGF,
}
EXPANSION: Units = {"1/K": 1, "ppm/K": "1e-6", "um/(m K)": "1e-6", "1/degF": _PER_DEGF}
