"""The result tree as an xarray dataset: a variable for each figure and each profile."""

from __future__ import annotations

import json
from typing import Any

from rollnip.figure import Figure
from rollnip.figures import CLAIMED, FIGURES, INTERFACE_FIGURES, PLACES, PROFILES
from rollnip.sheet_figures import BENDING_LENGTH, PULL_FIGURES, SHEET_FIGURES, SHEET_PROFILES

_NAN = float("nan")
_Variables = dict[str, tuple[Any, ...]]


def result_dataset(tree: dict[str, Any]) -> Any:
    """Return the xarray dataset of a result tree: None becomes NaN, texts become attributes.

    Raises ModuleNotFoundError where xarray is not installed.
    """
    import xarray as xr

    profiles = tree["profiles"]
    size = len(profiles["x"])
    variables: _Variables = {
        name: ("x", _floats(profiles[name], size), curve.described)
        for name, curve in PROFILES.items()
    }
    place = variables.pop("x")
    variables |= _scalars(tree) | _contact(tree["contact"]) | _zones(tree["zones"])
    if "sheet" in tree:
        variables |= _sheet(tree["sheet"], size)
    variables |= _interfaces(tree.get("interfaces", []))
    return xr.Dataset(
        variables,
        coords={
            "x": place,
            "edge": ("edge", ["trailing", "leading"], {"long_name": "edge of the contact"}),
        },
        attrs=_attributes(tree),
    )


def _floats(values: list[float | None] | None, size: int) -> list[float]:
    if values is None:
        return [_NAN] * size
    return [_NAN if value is None else value for value in values]


def _scalar(value: float | None, attributes: dict[str, str]) -> tuple[Any, ...]:
    return ((), _NAN if value is None else value, attributes)


def _value(tree: dict[str, Any], figure: Figure) -> float | None:
    table, _, key = figure.key.rpartition(".")
    value: float | None = (tree[table] if table else tree)[key]
    return value


def _scalars(tree: dict[str, Any]) -> _Variables:
    variables = {one.name: _scalar(_value(tree, one), one.described) for one in FIGURES.values()}
    for one in CLAIMED.values():
        about = {"units": one.unit, "long_name": f"estimated error of the {one.label}"}
        variables[f"error_{one.name}"] = _scalar(tree["error"][one.name], about)
    if "totals" in tree:
        variables |= _totals(tree["totals"])
    return variables


def _totals(totals: dict[str, float | None]) -> _Variables:
    width = PLACES["face_width"].described
    variables = {"total_face_width": _scalar(totals["face_width"], width)}
    for one in FIGURES.values():
        if one.total is not None:
            about = {"units": one.total.unit, "long_name": f"{one.label}, whole face"}
            variables[f"total_{one.name}"] = _scalar(totals[one.name], about)
    return variables


def _contact(intervals: list[list[float]]) -> _Variables:
    import numpy as np

    return {
        "contact": (
            ("interval", "edge"),
            np.asarray(intervals, dtype=float).reshape(-1, 2),
            PLACES["contact"].described,
        )
    }


def _zones(zones: list[dict[str, Any]]) -> _Variables:
    import numpy as np

    return {
        **{
            f"zone_{end}": (
                "zone",
                np.asarray([zone[end] for zone in zones], float),
                PLACES[f"zone_{end}"].described,
            )
            for end in ("from", "to")
        },
        "zone_state": (
            "zone",
            np.asarray([z["state"] for z in zones], dtype=object),
            {"long_name": "stick or slip"},
        ),
        "zone_direction": (
            "zone",
            np.asarray([z.get("direction", 0) for z in zones], dtype="int8"),
            {"units": "1", "long_name": "sign of the slip velocity, 0 in stick"},
        ),
    }


def _sheet(sheet: dict[str, Any], size: int) -> _Variables:
    found: _Variables = {}
    for key, figure in SHEET_FIGURES.items():
        name = key.partition(".")[2]
        found[figure.name] = _scalar(sheet[name], figure.described)
        if figure.claimed:
            about = {"units": figure.unit, "long_name": f"estimated error of the {figure.label}"}
            found[f"error_{figure.name}"] = _scalar(sheet["error"][name], about)
    for name, curve in SHEET_PROFILES.items():
        if name != "x":
            values = _floats(sheet["profiles"][name], size)
            found[f"sheet_{name}"] = ("x", values, curve.described)
    found |= _grip(sheet["grip"])
    bends = {"units": "1", "long_name": "1 where the bending stiffness is included, else 0"}
    found["sheet_bending_length"] = _scalar(sheet["bending_length"], BENDING_LENGTH.described)
    found["sheet_bends"] = ((), int(sheet["bends"]), bends)
    lower = _zones(sheet["zones_lower"])
    return found | {
        f"lower_{name}": (f"lower_{dims[0]}", *rest) for name, (dims, *rest) in _tupled(lower)
    }


def _grip(grip: dict[str, Any]) -> _Variables:
    """Return the pull, its limits, the side that slides first, and how much of the grip is used."""
    pull = {"units": PULL_FIGURES["largest"].unit, "long_name": "pull on the sheet"}
    found: _Variables = {"sheet_pull": _scalar(grip["pull"], pull)}
    for key, figure in PULL_FIGURES.items():
        found[f"sheet_pull_{key}"] = _scalar(grip[key], figure.described)
    for side in ("upper", "lower"):
        about = {"units": "1", "long_name": f"traction over what friction carries, {side} side"}
        found[f"sheet_grip_use_{side}"] = _scalar(grip[f"use_{side}"], about)
    first = {"long_name": "side that slides first where the sheet is pulled"}
    return found | {"sheet_slides_first": ((), grip["first"], first)}


def _tupled(variables: _Variables) -> list[tuple[str, tuple[Any, ...]]]:
    """Return variables of one dimension, with that dimension as a tuple."""
    return [(name, ((one[0],), *one[1:])) for name, one in variables.items()]


def _interfaces(interfaces: list[dict[str, Any]]) -> _Variables:
    if not interfaces:
        return {}
    found: _Variables = {
        "interface_roller": (
            "interface",
            [one["roller"] for one in interfaces],
            {"long_name": "roller of the interface"},
        ),
        "interface_bond": (
            "interface",
            [int(one["bond"]) for one in interfaces],
            {"units": "1", "long_name": "1 for a bond to the core, 0 between layers"},
        ),
    }
    for name, figure in INTERFACE_FIGURES.items():
        values = [one[name] for one in interfaces]
        found[f"interface_{name}"] = ("interface", _floats(values, 0), figure.described)
    return found


def _attributes(tree: dict[str, Any]) -> dict[str, Any]:
    solver = {f"solver_{name}": value for name, value in tree["solver"].items()}
    return {
        "schema": tree["schema"],
        "title": tree["title"],
        "converged": int(tree["converged"]),
        **{name: tree[name] for name in ("geometry", "tolerance", "version", "case_hash")},
        "case": json.dumps(tree["case"]),
        "warnings": "\n".join(tree["warnings"]),
    } | {name: _NAN if value is None else value for name, value in solver.items()}
