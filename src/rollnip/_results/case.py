"""The case of a solution: problem and model as the tree of a case file, in base units."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass, replace
from hashlib import sha256
from math import isinf
from typing import Any

from rollnip.cooling import Coolant, Cooling, HeatBalance, Held
from rollnip.materials import (
    WLF,
    Arrhenius,
    Elastic,
    FractionalZener,
    Gent,
    LossFactor,
    NeoHookean,
    Ogden,
    Prony,
    StandardLinearSolid,
    Yeoh,
)
from rollnip.model import Model
from rollnip.nip import Approach, Creepage, Nip
from rollnip.patches import Across, Force, Patch
from rollnip.rollers import Roller
from rollnip.shafts import Crown, CrownTable, Face, Shaft

# The value of the key `model` in a case file, by class.
_NAMES: Mapping[type, str] = {
    Elastic: "elastic",
    StandardLinearSolid: "standard-linear-solid",
    Prony: "prony",
    FractionalZener: "fractional-zener",
    LossFactor: "loss-factor",
    NeoHookean: "neo-hookean",
    Yeoh: "yeoh",
    Gent: "gent",
    Ogden: "ogden",
    WLF: "wlf",
    Arrhenius: "arrhenius",
}


def case_tree(nip: Nip, model: Model) -> dict[str, Any]:
    """Return a problem and its model as the tree of a case file.

    Every quantity is a number in its base unit, and an infinite radius is the text "inf". Defaults
    are written out; what is not given is left out. A hardness appears as the modulus that it stands
    for. A measured profile is described by a text (number of samples, range, digest), since a
    result does not know the name of its file.
    """
    tree: dict[str, Any] = {"title": nip.title} if nip.title else {}
    tree["nip"] = _without_none(
        _plain(nip.normal)
        | _plain(nip.tangential)
        | {"friction": nip.friction, "speed": nip.speed, "face_width": nip.face_width}
    )
    tree["model"] = {"geometry": model.geometry}
    tree["solver"] = {"tolerance": model.tolerance}
    tree["upper"], tree["lower"] = _roller(nip.upper), _roller(nip.lower)
    if nip.sheet is not None:
        tree["sheet"] = _without_none(_plain(nip.sheet))
    return tree


def problem_hash(
    nip: Nip, model: Model, face: Face | None = None, heat: HeatBalance | None = None
) -> str:
    """Return 16 hexadecimal digits that identify problem and model; the title does not count."""
    problem = replace(nip, title="") if nip.title else nip
    parts: tuple[object, ...] = (problem, model) if face is None else (problem, model, face)
    if heat is not None:
        materials = (*nip.upper.materials, *nip.lower.materials)
        parts = (*parts, heat, tuple(material.thermal for material in materials))
    return sha256(repr(parts).encode()).hexdigest()[:16]


def patch_case_tree(
    patch: Patch, tolerance: float, grid: tuple[int, int] | None = None
) -> dict[str, Any]:
    """Return a problem in three dimensions as the tree of a case file, in the form of `case_tree`.

    Parameters
    ----------
    patch : the problem.
    tolerance : wanted relative accuracy.
    grid : the prescribed numbers of rectangles along x and y; None where they were not prescribed.
    """
    tree: dict[str, Any] = {"title": patch.title} if patch.title else {}
    tree["nip"] = _without_none(
        _driven("load", "approach", patch.normal)
        | _driven("traction", "creepage", patch.along)
        | _driven("lateral_traction", "lateral_creepage", patch.across)
        | {"spin": patch.spin, "friction": patch.friction, "speed": patch.speed}
    )
    tree["patch"] = {} if grid is None else {"grid": list(grid)}
    tree["solver"] = {"tolerance": tolerance}
    tree["upper"] = _roller(patch.upper) | _across(patch.across_upper)
    tree["lower"] = _roller(patch.lower) | _across(patch.across_lower)
    return tree


def patch_problem_hash(patch: Patch, tolerance: float, grid: tuple[int, int] | None = None) -> str:
    """Return 16 hexadecimal digits that identify a patch problem; the title does not count."""
    parts = (replace(patch, title=""), tolerance, grid)
    return sha256(repr(parts).encode()).hexdigest()[:16]


def _driven(force: str, motion: str, given: Force | Approach | Creepage) -> dict[str, float]:
    """Return a prescribed force or motion under its key."""
    if isinstance(given, Force):
        return {force: given.force}
    return {motion: given.approach if isinstance(given, Approach) else given.creepage}


def _across(shape: Across) -> dict[str, Any]:
    """Return the keys that describe the shape of a roller along its axis."""
    return _without_none(
        {
            "lateral_radius": "inf" if isinf(shape.radius) else shape.radius,
            "face": shape.face,
            "end_radius": shape.end_radius,
            "lateral_profile": None if shape.profile is None else repr(shape.profile),
        }
    )


def heat_tree(heat: HeatBalance) -> dict[str, Any]:
    """Return the tables of a heat balance: "heat", and "upper" and "lower" for the rollers."""
    whole = _without_none({"ambient": heat.ambient, "start": heat.start})
    if heat.sheet is not None:
        whole["sheet"] = _flat(heat.sheet)
    return {"heat": whole, "upper": _cooling(heat.upper), "lower": _cooling(heat.lower)}


def _cooling(cooling: Cooling) -> dict[str, Any]:
    tree: dict[str, Any] = {"film": cooling.film, "core": "insulated"}
    if isinstance(cooling.core, Held):
        tree["core"] = cooling.core.temperature
    elif isinstance(cooling.core, Coolant):
        tree["core"] = {"coolant": cooling.core.temperature, "film": cooling.core.film}
    if cooling.shell is not None:
        tree["shell"] = _flat(cooling.shell)
    return tree


def _flat(part: Any) -> dict[str, Any]:
    """Return the fields of a part and of its thermal properties in one table."""
    tree = {one.name: getattr(part, one.name) for one in fields(part) if one.name != "thermal"}
    return _without_none(tree) | _plain(part.thermal)


def _roller(roller: Roller) -> dict[str, Any]:
    tree: dict[str, Any] = {"radius": "inf" if isinf(roller.radius) else roller.radius}
    tree["core"] = "rigid" if roller.core is None else _named(roller.core)
    if roller.layers:
        tree["layers"] = [
            {"thickness": layer.thickness, "material": _named(layer.material)}
            for layer in roller.layers
        ]
    if roller.profile is not None:
        tree["profile"] = repr(roller.profile)
    if roller.shaft is not None:
        tree["shaft"] = _shaft(roller.shaft)
    return tree


def _shaft(shaft: Shaft) -> dict[str, Any]:
    tree = _without_none({one.name: getattr(shaft, one.name) for one in fields(shaft)})
    tree["crown"] = _crown(shaft.crown)
    tree["profiles"] = [_crown(one) for one in shaft.profiles]
    tree["journals"] = [
        {"diameter": one.diameter} | ({} if isinf(one.length) else {"length": one.length})
        for one in shaft.journals
    ]
    if shaft.covering is not None:
        tree["covering"] = _rows(shaft.covering)
    return tree


def _crown(crown: Crown | CrownTable | float) -> dict[str, Any]:
    if isinstance(crown, Crown):
        return {"height": crown.height, "shape": crown.shape}
    return _rows(crown)


def _rows(table: Any) -> dict[str, Any]:
    """Return the lists of a table over y."""
    rows = _without_none({one.name: getattr(table, one.name) for one in fields(table)})
    return {name: values.tolist() for name, values in rows.items()}


def _named(part: Any) -> dict[str, Any]:
    """Return a material or a shift as a table that begins with the name of its model."""
    kind = type(part)
    return {"model": _NAMES.get(kind, kind.__name__)} | _without_none(_plain(part))


def _plain(part: Any) -> dict[str, Any]:
    if not is_dataclass(part):
        return {"description": repr(part)}
    tree: dict[str, Any] = {one.name: _value(getattr(part, one.name)) for one in fields(part)}
    thermal = getattr(part, "thermal", None)
    if thermal is not None:
        del tree["thermal"]
        tree |= _plain(thermal)
    if isinstance(part, Prony):
        tree["terms"] = [{"modulus": e, "relaxation_time": tau} for e, tau in part.terms]
    if isinstance(part, Ogden):
        tree["terms"] = [{"weight": weight, "exponent": a} for weight, a in part.terms]
    return tree


def _value(value: Any) -> Any:
    if is_dataclass(value):
        return _named(value)
    return list(value) if isinstance(value, tuple) else value


def _without_none(tree: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in tree.items() if value is not None}
