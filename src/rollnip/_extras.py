"""The extras: packages that rollnip works without, and what is missing where they are not there."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.util import find_spec
from typing import Literal

from rollnip._errors import RollnipError

Extra = Literal["netcdf", "tables", "cluster", "web"]

_MODULES: Mapping[Extra, tuple[str, ...]] = {
    "netcdf": ("xarray", "h5netcdf", "h5py"),
    "tables": ("polars", "python_calamine"),
    "cluster": ("distributed",),
    "web": ("fastapi", "uvicorn", "plotly"),
}


def require_extra(extra: Extra, what: str, instead: str = "") -> None:
    """Raise RollnipError unless the packages of an extra are installed; costs next to nothing.

    Parameters
    ----------
    extra : which one.
    what : needs it: the beginning of the sentence.
    instead : what works without it; empty where nothing does.
    """
    missing = [name for name in _MODULES[extra] if find_spec(name) is None]
    if missing:
        remedy = f"; or {instead}" if instead else ""
        raise RollnipError(
            f"{what} needs {', '.join(missing)}, of the extra `{extra}`: install it with "
            f"`pip install '.[{extra}]'` in the folder of the source, or with `[{extra}]` behind "
            f"the name of the wheel{remedy}."
        )
