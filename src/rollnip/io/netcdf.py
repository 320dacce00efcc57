"""The result tree as a netCDF file, through the extra ``rollnip[netcdf]``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rollnip._extras import require_extra
from rollnip._results.dataset import result_dataset
from rollnip.face.report import face_variables

_UNITS = {
    "r": ("mm", "radius"),
    "temperature": ("degC", "temperature"),
    "time": ("s", "time"),
    "hot_spot": ("degC", "highest temperature"),
    "surface": ("degC", "temperature of the surface"),
    "bond": ("degC", "temperature of the bond"),
    "power": ("mW mm-1", "heat of the nip"),
    "rise": ("K", "highest rise over the temperatures without heat"),
}
_SIDES = ("upper", "lower")


def require_netcdf() -> None:
    """Raise RollnipError where the extra is not installed."""
    require_extra("netcdf", "writing netCDF", "write .json")


def write_netcdf(tree: dict[str, Any], path: Path) -> None:
    """Write a result tree; None becomes NaN, lists become variables, texts attributes.

    The root holds the nip and its face; temperatures of both rollers, a warm-up and a branch of
    steady states are groups.
    """
    dataset = result_dataset(tree)
    if "face" in tree:
        variables, attributes = face_variables(tree["face"])
        dataset = dataset.assign(variables).set_coords("y").assign_attrs(attributes)
    dataset.to_netcdf(path, engine="h5netcdf")
    if "heat" in tree:
        _write_heat(tree["heat"], path)
    if "warm_up" in tree:
        _write_warm_up(tree["warm_up"], path)
    if "branch" in tree:
        _write_branch(tree["branch"], path)


def _write_heat(heat: dict[str, Any], path: Path) -> None:
    for side in _SIDES:
        one = heat[side]
        attributes = {key: value for key, value in one.items() if isinstance(value, float)}
        _write_group(
            path, side, "r", {name: one[name] for name in ("r", "temperature")}, attributes
        )


def _write_warm_up(rows: dict[str, Any], path: Path) -> None:
    columns = {"time": rows["time"], "power": rows["power"]}
    for side in _SIDES:
        parts = rows[side].items()
        columns |= {f"{name}_{side}": value for name, value in parts if value is not None}
    _write_group(path, "warm_up", "time", columns, {"status": rows["status"]})


def _write_branch(branch: dict[str, Any], path: Path) -> None:
    points, unit = branch["points"], branch["unit"]
    names = ("value", "hot_spot", "rise", "power")
    columns = {name: [point[name] for point in points] for name in names}
    columns["stable"] = [int(point["stable"]) for point in points]
    said: dict[str, Any] = {name: branch[name] for name in ("parameter", "unit", "status")}
    if branch["turning"] is not None:
        said["turning"] = branch["turning"]["value"]
    units = {"value": (unit.replace("/mm", " mm-1").replace("/s", " s-1"), branch["parameter"])}
    _write_group(path, "branch", "value", columns, said, units)


def _write_group(
    path: Path,
    name: str,
    along: str,
    columns: dict[str, Any],
    attributes: dict[str, Any],
    units: dict[str, tuple[str, str]] | None = None,
) -> None:
    import xarray as xr

    def described(key: str) -> dict[str, str]:
        plain = key.removesuffix("_upper").removesuffix("_lower")
        unit, text = (_UNITS | (units or {})).get(plain, ("1", plain.replace("_", " ")))
        return {"units": unit, "long_name": text}

    rows = {
        key: [float("nan") if one is None else one for one in values]
        for key, values in columns.items()
    }
    variables = {key: (along, values, described(key)) for key, values in rows.items()}
    place = variables.pop(along)
    dataset = xr.Dataset(variables, coords={along: place}, attrs=attributes)
    dataset.to_netcdf(path, mode="a", group=name, engine="h5netcdf")
