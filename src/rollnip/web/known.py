"""Uncertainty of a figure besides its numerical error: from the model, and from the material.

The model: how far the figures of a geometry were from finite elements at finite strain, on nips of
the kind that was compared (docs/geometry.md): coverings without a stiff skin, rolling freely or
driven with up to a tenth of the load, and no warning (docs/validity.md); with a sheet, on those of
decision 118. The material: Young's moduli known only within a band are put to their soft ends all
together, and to their stiff ends; nip width, approach and pressures of an elastic nip lie between,
as they go one way with every modulus.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from rollnip.materials import shore_a_band
from rollnip.model import Geometry
from rollnip.rollers import Roller
from rollnip.solution import Solution

JUDGED: Mapping[Geometry, Mapping[str, float]] = {
    "finite": {"nip_width": 0.0032, "approach": 0.0005, "peak_pressure": 0.001},
    "second": {"nip_width": 0.008, "approach": 0.01, "peak_pressure": 0.01},
    "curved": {"nip_width": 0.046, "approach": 0.066, "peak_pressure": 0.049},
    "corrected": {"nip_width": 0.038, "approach": 0.135, "peak_pressure": 0.045},
    "linear": {"nip_width": 0.038, "approach": 0.135, "peak_pressure": 0.045},
}
"""Largest relative deviation from finite elements of a geometry, by figure."""
JUDGED_SHEETS: Mapping[Geometry, Mapping[str, float]] = {
    "finite": {"nip_width": 0.004, "approach": 0.001, "peak_pressure": 0.008},
}
"""The same with a sheet of up to half the width of its narrower contact, between two coverings
(decision 118).

Figures of the upper side. Thicker sheets are warned of; other geometries were not compared.
"""
BANDED = ("nip_width", "approach", "load", "peak_pressure", "mean_pressure", "dwell_time")
"""Figures that are given a band: those that go one way with every modulus."""
_GENTLE = 0.1  # traction over load up to which JUDGED holds
_STIFF = 10.0  # modulus of a top layer over the next from which it is a stiff skin
_LIBRARY_KEYS = {"model", "modulus", "poisson"}


class Band(NamedTuple):
    """Young's modulus [MPa] of the material at a path of a case: lowest, likely, highest."""

    path: str
    low: float
    likely: float
    high: float


def accuracy(solution: Solution) -> Mapping[str, float]:
    """Return the row of `JUDGED`, or with a sheet of `JUDGED_SHEETS`; empty where there is none."""
    judged = JUDGED if solution.nip.sheet is None else JUDGED_SHEETS
    return judged.get(solution.model.geometry, {})


def is_judged(solution: Solution) -> bool:
    """Return whether a nip is of the kind that its row of `accuracy` speaks of."""
    if not accuracy(solution):
        return False
    rollers = (solution.nip.upper, solution.nip.lower)
    if solution.nip.sheet is not None and any(one.is_rigid for one in rollers):
        return False  # the lower width and peak on steel are further off
    gentle = abs(solution.traction) <= _GENTLE * solution.load
    return gentle and not solution.warnings and not any(_has_stiff_skin(one) for one in rollers)


def _has_stiff_skin(roller: Roller) -> bool:
    moduli = [layer.material.glassy_modulus for layer in roller.layers[:2]]
    return len(moduli) == 2 and moduli[0] >= _STIFF * moduli[1]


def bands(
    tree: Mapping[str, Any], library: list[dict[str, Any]], measured: Mapping[str, Any]
) -> list[Band]:
    """The elastic materials of a case whose modulus is known only within a band.

    Parameters
    ----------
    tree :
        a case in base units (`rollnip.io.base_tree`).
    library :
        materials with a "range", as `rollnip.web.library` has them.
    measured :
        (low, high) [MPa] by path, of moduli that were measured.
    """
    found = []
    for path, material in _materials(tree):
        if material.get("model", "elastic") != "elastic":
            continue
        modulus = material.get("modulus")
        if path in measured and modulus is not None:
            low, high = measured[path]
            found.append(Band(path, low, modulus, high))
        elif material.get("shore_a") is not None:
            found.append(Band(path, *shore_a_band(material["shore_a"])))
        elif modulus is not None:
            found += [Band(path, *one) for one in _ranges(material, library)]
    return found


def at_end(tree: Mapping[str, Any], found: list[Band], end: str) -> dict[str, Any]:
    """A copy of the case with the moduli at one end of their bands, "low" or "high"."""
    moduli = {band.path: float(getattr(band, end)) for band in found}
    copy: dict[str, Any] = {**tree}
    for side in ("upper", "lower"):
        roller = {**tree[side]}
        layers = [{**layer} for layer in roller.get("layers", [])]
        for i, layer in enumerate(layers):
            path = f"{side}.layers[{i}].material"
            if path in moduli:
                layer["material"] = _elastic(_named(tree, layer["material"]), moduli[path])
        path = f"{side}.core"
        if path in moduli:
            roller["core"] = _elastic(_named(tree, roller["core"]), moduli[path])
        copy[side] = roller | ({"layers": layers} if layers else {})
    return copy


def spread(likely: Mapping[str, Any], *ends: Mapping[str, Any]) -> dict[str, list[float]]:
    """[lowest, highest] of each figure that all results have."""
    results = (likely, *ends)
    return {
        key: [min(one[key] for one in results), max(one[key] for one in results)]
        for key in BANDED
        if all(one.get(key) is not None for one in results)
    }


def _materials(tree: Mapping[str, Any]) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Path and table of every material."""
    for side in ("upper", "lower"):
        roller = tree[side]
        for i, layer in enumerate(roller.get("layers", [])):
            yield f"{side}.layers[{i}].material", _named(tree, layer["material"])
        if roller.get("core") not in (None, "rigid"):
            yield f"{side}.core", _named(tree, roller["core"])


def _named(tree: Mapping[str, Any], material: Any) -> Mapping[str, Any]:
    table: Mapping[str, Any] = (
        tree["materials"][material] if isinstance(material, str) else material
    )
    return table


def _elastic(material: Mapping[str, Any], modulus: float) -> dict[str, Any]:
    kept = {key: value for key, value in material.items() if key != "shore_a"}
    return kept | {"modulus": modulus}


def _ranges(
    material: Mapping[str, Any], library: list[dict[str, Any]]
) -> list[tuple[float, float, float]]:
    """Band of the entry of the library that a material is, if any."""
    own = {key: value for key, value in material.items() if key in _LIBRARY_KEYS}
    return [
        (band["low"], band["likely"], band["high"])
        for entry in library
        if (band := entry.get("range", {}).get("modulus")) and entry["material"] == own
    ][:1]
