"""The result tree as a netCDF file, through the extra ``rollnip[netcdf]``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rollnip._extras import require_extra
from rollnip._results.dataset import result_dataset
from rollnip.face.report import face_variables


def require_netcdf() -> None:
    """Raise RollnipError where the extra is not installed."""
    require_extra("netcdf", "writing netCDF", "write .json")


def write_netcdf(tree: dict[str, Any], path: Path) -> None:
    """Write a result tree; None becomes NaN, lists become variables, texts attributes."""
    dataset = result_dataset(tree)
    if "face" in tree:
        variables, attributes = face_variables(tree["face"])
        dataset = dataset.assign(variables).set_coords("y").assign_attrs(attributes)
    dataset.to_netcdf(path, engine="h5netcdf")
