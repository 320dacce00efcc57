"""The result tree as a netCDF file, through the extra ``rollnip[netcdf]``."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import Any

from rollnip._errors import RollnipError

UNITS = {
    "load": "N/mm",
    "approach": "mm",
    "traction": "N/mm",
    "creepage": "1",
    "speed_ratio": "1",
    "nip_width": "mm",
    "dwell_time": "s",
    "peak_pressure": "MPa",
    "peak_pressure_x": "mm",
    "mean_pressure": "MPa",
    "torque_upper": "N",
    "torque_lower": "N",
    "rolling_resistance": "1",
}
PROFILE_UNITS = {
    "x": "mm",
    "pressure": "MPa",
    "shear": "MPa",
    "gap": "mm",
    "slip_velocity": "mm/s",
    "strain_upper": "1",
    "strain_lower": "1",
    "speed_upper": "mm/s",
    "speed_lower": "mm/s",
}
_TOTAL_UNITS = {
    "face_width": "mm",
    "load": "N",
    "traction": "N",
    "torque_upper": "N m",
    "torque_lower": "N m",
    "dissipation_friction": "W",
    "dissipation_viscous": "W",
}
_NAN = float("nan")
_Variables = dict[str, tuple[Any, ...]]


def require_netcdf() -> None:
    """Raise RollnipError where the extra is not installed."""
    if any(find_spec(name) is None for name in ("xarray", "h5netcdf", "h5py")):
        raise RollnipError(
            "writing netCDF needs the extra: pip install 'rollnip[netcdf]' (or write .json)."
        )


def write_netcdf(tree: dict[str, Any], path: Path) -> None:
    """Write a result tree; None becomes NaN, lists become variables, texts attributes."""
    import xarray as xr

    profiles = tree["profiles"]
    size = len(profiles["x"])
    variables: _Variables = {
        name: ("x", _floats(profiles[name], size), {"units": unit})
        for name, unit in PROFILE_UNITS.items()
        if name != "x"
    }
    variables |= _scalars(tree) | _contact(tree["contact"]) | _zones(tree["zones"])
    dataset = xr.Dataset(
        variables,
        coords={
            "x": ("x", _floats(profiles["x"], size), {"units": "mm"}),
            "edge": ("edge", ["trailing", "leading"]),
        },
        attrs=_attributes(tree),
    )
    dataset.to_netcdf(path, engine="h5netcdf")


def _floats(values: list[float | None] | None, size: int) -> list[float]:
    if values is None:
        return [_NAN] * size
    return [_NAN if value is None else value for value in values]


def _scalar(value: float | None, unit: str) -> tuple[Any, ...]:
    return ((), _NAN if value is None else value, {"units": unit})


def _scalars(tree: dict[str, Any]) -> _Variables:
    variables = {name: _scalar(tree[name], unit) for name, unit in UNITS.items()}
    for name, value in tree["dissipation"].items():
        variables[f"dissipation_{name}"] = _scalar(value, "N/s")
    for name, value in tree["error"].items():
        variables[f"error_{name}"] = _scalar(value, UNITS[name])
    for name, value in tree.get("totals", {}).items():
        variables[f"total_{name}"] = _scalar(value, _TOTAL_UNITS[name])
    return variables


def _contact(intervals: list[list[float]]) -> _Variables:
    import numpy as np

    return {
        "contact": (
            ("interval", "edge"),
            np.asarray(intervals, dtype=float).reshape(-1, 2),
            {"units": "mm"},
        )
    }


def _zones(zones: list[dict[str, Any]]) -> _Variables:
    import numpy as np

    return {
        "zone_from": ("zone", np.asarray([z["from"] for z in zones], float), {"units": "mm"}),
        "zone_to": ("zone", np.asarray([z["to"] for z in zones], float), {"units": "mm"}),
        "zone_state": ("zone", np.asarray([z["state"] for z in zones], dtype=object)),
        "zone_direction": (
            "zone",
            np.asarray([z.get("direction", 0) for z in zones], dtype="int8"),
            {"comment": "sign of the slip velocity; 0 in stick"},
        ),
    }


def _attributes(tree: dict[str, Any]) -> dict[str, Any]:
    solver = {f"solver_{name}": value for name, value in tree["solver"].items()}
    return {
        "schema": tree["schema"],
        "title": tree["title"],
        "converged": int(tree["converged"]),
        "geometry": tree["geometry"],
        "warnings": "\n".join(tree["warnings"]),
    } | {name: _NAN if value is None else value for name, value in solver.items()}
