"""The library of the page: examples and materials, each with its source, and units."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.resources import files
from math import radians
from pathlib import Path
from typing import Any, get_args

from rollnip._units import Dimension, base_unit, conversions
from rollnip.face.figures import (
    FACE_FIGURES,
    FACE_PROFILES,
    SHEET_FACE_FIGURES,
    SHEET_FACE_PROFILES,
)
from rollnip.figure import LARGE, LOST, ROUNDING, US, US_NAMES, US_TOTALS, Figure, Shown
from rollnip.figure import Dimension as FigureDimension
from rollnip.figures import FIELDS, FIGURES, INTERFACE_FIGURES, PROFILES, PULL
from rollnip.heat.figures import (
    BALANCE_FIGURES,
    COURSES,
    PARAMETERS,
    ROLLER_FIGURES,
    WARM_UP_FIGURES,
)
from rollnip.materials import SOURCES as THERMAL_SOURCES
from rollnip.materials import TYPICAL, shore_a_band, shore_a_modulus
from rollnip.patch.figures import PATCH_FIELDS, PATCH_FIGURES
from rollnip.sheet_figures import PULL_FIGURES, SHEET_FIGURES, SHEET_PROFILES
from rollnip.sheets import SHEETS, Sheet
from rollnip.web.answers import as_json

_DATA = Path(str(files("rollnip.web"))) / "data"
_HARDNESSES = (30, 40, 50, 60, 70, 80, 90)
# What the metric and the US page show; US units of results are those of the registry.
_SHOWN: dict[Dimension, tuple[str, str]] = {
    "length": ("mm", US_NAMES["length"]),
    "line load": ("N/mm", US_NAMES["line load"]),
    "force": ("N m/m", US_NAMES["force"]),
    "pressure": ("MPa", US_NAMES["pressure"]),
    "speed": ("m/min", US_NAMES["speed"]),
    "time": ("ms", "ms"),
    "temperature": ("degC", US_NAMES["temperature"]),
    "temperature difference": ("K", "K"),
    "ratio": ("", ""),
    "molar energy": ("kJ/mol", "kcal/mol"),
    "frequency": ("Hz", "Hz"),
    "angle": ("deg", "deg"),
    "density": ("kg/m3", "lb/in3"),
    "thermal conductivity": ("W/(m K)", "BTU/(h ft degF)"),
    "heat capacity": ("J/(kg K)", "BTU/(lb degF)"),
    "film coefficient": ("W/(m2 K)", "BTU/(h ft2 degF)"),
    "thermal expansion": ("ppm/K", "1/degF"),
    "turn per length": ("1/m", US_NAMES["turn per length"]),
}


def _metric(dimension: FigureDimension) -> list[Any]:
    """Return the unit that summaries show and its size in base units."""
    figure = Figure("", "", dimension, "")
    return [figure.shown_unit, 1.0 / figure.factor]


def _page(dimension: FigureDimension, metric: FigureDimension | None = None) -> dict[str, Any]:
    """Return unit and size of a dimension of results on the metric and the US page."""
    shown = _metric(dimension if metric is None else metric)
    return {"metric": shown, "us": _size(US[dimension]) if dimension in US else shown}


def _size(shown: Shown) -> list[Any]:
    """Return a unit and its size in base units."""
    return [shown.unit, 1.0 / shown.factor]


# Dimensions and totals of results alone: [unit, scale] of the metric and the US page.
_DEGREE = ["°", 1.0]
_SHOWN_RESULTS = {
    "power per length": _page("power per length", "heat per length"),
    "heat per length": _page("heat per length"),
    "power per volume": _page("power per volume"),
    "share": _page("share"),
    "duration": _page("duration"),
    "angle": {"metric": _DEGREE, "us": _DEGREE},
    "angle of axes": {"metric": ["deg", radians(1.0)], "us": ["deg", radians(1.0)]},
    "roller force": _page("roller force"),
    "feed per metre": _page("feed per metre"),
    "area": _page("area"),
    "moment": _page("moment"),
    "power": _page("power"),
    "air pressure": {"metric": ["bar", 0.1], "us": _size(US["pressure"])},
}
_INSIDE = ("von_mises", "max_shear", "s_zz", "s_xx", "s_xz", "u_x", "u_z", "loss_density")
_BOND = ("depth", "shear_max", "shear_range")
# Registries of the curves and of the other views, by the word that their German names begin with.
MORE_FIGURES: Mapping[str, Mapping[str, Figure]] = {
    "face": {**FACE_FIGURES, **SHEET_FACE_FIGURES},
    "curve": {**FACE_PROFILES, **SHEET_FACE_PROFILES},
    "heat": {**BALANCE_FIGURES, **ROLLER_FIGURES},
    "patch": PATCH_FIGURES,
    "field": PATCH_FIELDS,
    "profile": PROFILES,
    "web": SHEET_PROFILES,
    "inside": {key: FIELDS[key] for key in _INSIDE},
    "course": {**{key: COURSES[key] for key in ("temperature", "time")}, **PARAMETERS},
    "warm": WARM_UP_FIGURES,
    "pulls": PULL_FIGURES,
    "bond": {**{key: INTERFACE_FIGURES[key] for key in _BOND}, "pull": PULL},
}
# In the order of the page: what is read first stands first.
_FIRST = ("nip_width", "approach", "load", "peak_pressure", "mean_pressure", "dwell_time")
_NOT_SHOWN = ("peak_pressure_x",)


@dataclass(frozen=True, slots=True)
class Library:
    """Examples and materials, as the API gives them.

    Attributes
    ----------
    examples : {"name", "title", "group", "description", "case"} of each;
        "group" is "typical", "more" or "paper".
    materials : {"name", "title", "description", "source", "material", "range"} of each; with
        "family" a kind of covering that comes in any hardness.
    hardness : moduli over Shore A: {"shore_a", "low", "likely", "high"}, lists.
    """

    examples: list[dict[str, Any]]
    materials: list[dict[str, Any]]
    hardness: dict[str, list[float]]

    @classmethod
    def read(cls) -> Library:
        """Read it from the files of the package."""
        typical = [_example(path, "typical") for path in sorted((_DATA / "nips").glob("*.toml"))]
        others = [_example(path, _group(path)) for path in sorted(_cases_folder().glob("*.toml"))]
        cases = [example for example in others if not _names_a_file(example["case"])]
        kinds = tomllib.loads((_DATA / "materials.toml").read_text(encoding="utf-8"))["material"]
        rubbers = [_rubber(hardness) for hardness in _HARDNESSES]
        coverings = tomllib.loads((_DATA / "coverings.toml").read_text(encoding="utf-8"))
        families = [_family(table) for table in coverings["covering"]]
        return cls(
            typical + cases,
            families + rubbers + [_material(table) for table in kinds],
            _hardness_table(),
        )


def units() -> dict[str, Any]:
    """Units of every dimension: base, what the metric and the US page show, [scale, offset]."""
    return {
        dimension: {
            "base": base_unit(dimension),
            "metric": _shown(dimension)[0],
            "us": _shown(dimension)[1],
            "units": {name: list(pair) for name, pair in conversions(dimension).items()},
        }
        for dimension in get_args(Dimension)
    }


def _shown(dimension: Dimension) -> tuple[str, str]:
    """Return the units of a dimension on the metric and the US page; else the base unit twice."""
    base = base_unit(dimension)
    return _SHOWN.get(dimension, (base, base))


def figures_module() -> str:
    """The registry of figures as the JavaScript module that the page imports."""
    keys = [*_FIRST, *(key for key in FIGURES if key not in (*_FIRST, *_NOT_SHOWN))]
    parts = {
        "ROUNDING": ROUNDING,
        "LOST": LOST,
        "FIGURES": [_figure(FIGURES[key]) for key in keys],
        "SHEET_FIGURES": [_figure(figure) for figure in SHEET_FIGURES.values()],
        "MORE_FIGURES": {
            kind: {key: _figure(figure) for key, figure in registry.items()}
            for kind, registry in MORE_FIGURES.items()
        },
        "SHEETS": [{"name": name, "sheet": _sheet(sheet)} for name, sheet in SHEETS.items()],
        "THERMALS": [{"name": name, "source": THERMAL_SOURCES[name]} for name in TYPICAL],
        "TOTALS": [
            {"key": one.name, "label": f"{_capital(one.label)}, whole face"}
            | {"units": {"metric": [one.total.unit, 1.0], "us": _size(US_TOTALS[one.total.unit])}}
            for one in FIGURES.values()
            if one.total is not None
        ],
        "RESULT_UNITS": _SHOWN_RESULTS,
        "LARGE": {
            dimension: {"from": least, "unit": unit, "scale": 1.0 / factor}
            for dimension, (least, (unit, factor, _)) in LARGE.items()
        },
    }
    lines = (f"export const {name} = {json.dumps(part)};\n" for name, part in parts.items())
    return "".join(lines)


def _sheet(sheet: Sheet) -> dict[str, float]:
    """Return what a usual sheet is made of."""
    names = ("thickness", "modulus", "poisson", "modulus_thickness")
    values = {name: getattr(sheet, name) for name in names}
    return {name: value for name, value in values.items() if value is not None}


def _figure(figure: Figure) -> dict[str, Any]:
    return {
        "key": figure.name,
        "label": _capital(figure.label),
        "dimension": figure.dimension,
        "digits": figure.digits,
        "hint": f"{figure.sentence} {figure.sign}".rstrip(),
        "size": dict(figure.size),
        "has_sign": figure.has_sign,
    }


def _capital(label: str) -> str:
    return label[0].upper() + label[1:]


def _group(path: Path) -> str:
    """Return "paper" for a case of the paper, "more" for any other."""
    return "paper" if path.stem.startswith(("configuration-", "figure-")) else "more"


def _names_a_file(case: dict[str, Any]) -> bool:
    """Return whether a roller has a measured profile, which the server does not read."""
    return any("profile" in case[roller] for roller in ("upper", "lower"))


def _example(path: Path, group: str) -> dict[str, Any]:
    """A case file; the comment lines at its head are the description."""
    text = path.read_text(encoding="utf-8")
    head = []
    for line in text.splitlines():
        if not line.startswith("#"):
            break
        head.append(line.removeprefix("#").strip())
    case = as_json(tomllib.loads(text))
    return {
        "name": path.stem.lstrip("0123456789-") if group == "typical" else path.stem,
        "title": case["title"],
        "group": group,
        "description": " ".join(head),
        "case": case,
    }


def _cases_folder() -> Path:
    """Inside the package in a wheel, at the root of a source tree."""
    package = Path(str(files("rollnip")))
    inside = package / "examples"
    return inside if inside.is_dir() else package.parents[1] / "examples"


def _family(table: dict[str, Any]) -> dict[str, Any]:
    """A kind of covering, at the hardness it is offered in most often."""
    kept = {name: table[name] for name in ("name", "title", "description", "source")}
    material = {"model": "elastic", "shore_a": table["shore_a"], "poisson": 0.5}
    band = {"modulus": _range(*shore_a_band(table["shore_a"]))}
    return kept | {"family": True, "material": material, "range": band}


def _hardness_table() -> dict[str, list[float]]:
    """Moduli [MPa] at every half point of Shore A."""
    points = [20.0 + 0.5 * i for i in range(151)]
    found = [shore_a_band(point) for point in points]
    columns = {name: [getattr(band, name) for band in found] for name in ("low", "likely", "high")}
    return {"shore_a": points, **columns}


def _rubber(hardness: int) -> dict[str, Any]:
    band = shore_a_band(hardness)
    return {
        "name": f"rubber-{hardness}-shore-a",
        "title": f"Rubber, {hardness} Shore A",
        "description": (
            f"Modulus {shore_a_modulus(hardness):.2g} MPa from the hardness alone, which leaves "
            f"{band.low:.2g} to {band.high:.2g} MPa open (two relations, reading within 4 points)."
            " At rest and at small strain; a rubber in a fast nip is stiffer. Poisson's ratio 0.5:"
            " rubber hardly changes its volume. Where it matters, fit it to a measured nip width."
        ),
        "source": "Gent (1958), Rubber Chem. Technol. 31, 896-906; band: also the one of Ruess",
        "material": {"model": "elastic", "shore_a": hardness, "poisson": 0.5},
        "range": {"modulus": _range(*band)},
    }


def _material(table: dict[str, Any]) -> dict[str, Any]:
    modulus = table["material"]["modulus"]
    known = "low" in table
    band = _range(table["low"], modulus, table["high"]) if known else None
    kept = {name: table[name] for name in ("name", "title", "description", "source", "material")}
    return kept | {"range": {"modulus": band} if band else {}}


def _range(low: float, likely: float, high: float) -> dict[str, Any]:
    return {"low": low, "likely": likely, "high": high, "unit": "MPa"}
