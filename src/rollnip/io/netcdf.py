"""The result tree as a netCDF file, through the extra ``rollnip[netcdf]``."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import Any

from rollnip._errors import RollnipError
from rollnip._results.dataset import result_dataset


def require_netcdf() -> None:
    """Raise RollnipError where the extra is not installed."""
    if any(find_spec(name) is None for name in ("xarray", "h5netcdf", "h5py")):
        raise RollnipError(
            "writing netCDF needs the extra: pip install 'rollnip[netcdf]' (or write .json)."
        )


def write_netcdf(tree: dict[str, Any], path: Path) -> None:
    """Write a result tree; None becomes NaN, lists become variables, texts attributes."""
    result_dataset(tree).to_netcdf(path, engine="h5netcdf")
