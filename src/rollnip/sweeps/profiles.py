"""The profiles of all cases in one netCDF file, through the extra ``rollnip[netcdf]``.

Cases have different numbers of points, so every profile is a (case, point) array padded with nan.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rollnip._errors import RollnipError
from rollnip._files import check_target, write_whole
from rollnip.figures import PROFILES
from rollnip.io.netcdf import require_netcdf
from rollnip.sweeps.store import About, Store

_ALL = tuple(PROFILES)
_POINT_BYTES = 8 * len(_ALL)


def check_profiles_target(path: Path) -> None:
    """Raise RollnipError where profiles could not be written to ``path``."""
    check_target(path, (".nc",))
    require_netcdf()


def write_profiles(store: Store, path: Path) -> None:
    """Write the profiles of a sweep to a file, completely or not at all, one case at a time.

    Memory use therefore does not depend on the number of cases. The dimensions are ``case``, all
    cases
    of the study in its order, and ``point``. ``x`` is a variable like the others, since every nip
    has
    its own; numeric parameters are variables over ``case``.

    Raises
    ------
    RollnipError
        where the name does not end in .nc, the extra is missing, the database holds no profiles, or
        the file cannot be written.
    """
    check_profiles_target(path)
    if next(store.profiles(), None) is None:
        raise RollnipError(
            f"{store.name}: holds no profiles to write to {path}; they are kept where `profiles` "
            "or --profiles asks for them."
        )
    write_whole(path, lambda file: _write(store, file))


def _write(store: Store, file: Path) -> None:
    import h5netcdf

    about = store.about
    names = ("x", *(name for name in about.profiles or _ALL if name != "x"))
    points = max(len(data) for _, data in store.profiles()) // _POINT_BYTES
    with h5netcdf.File(file, "w") as target:
        target.dimensions = {"case": about.count, "point": points}
        target.attrs.update({"title": about.title, "rollnip": about.version})
        _write_parameters(store, target, about)
        variables = {name: _variable(target, name, points) for name in names}
        for position, data in store.profiles():
            profiles = np.frombuffer(data).reshape(len(_ALL), -1)
            for name, variable in variables.items():
                one = profiles[_ALL.index(name)]
                variable[position, : one.size] = one


def _variable(target: Any, name: str, points: int) -> Any:
    variable = target.create_variable(
        name,
        ("case", "point"),
        "f8",
        fillvalue=np.nan,
        chunks=(1, points),
        compression="gzip",
        compression_opts=1,
    )
    variable.attrs["units"] = PROFILES[name].unit
    return variable


def _write_parameters(store: Store, target: Any, about: About) -> None:
    """Write each numeric parameter over all cases."""
    numbers = {path: i for i, path in enumerate(about.paths) if about.units[i]}
    columns: dict[str, NDArray[np.float64]] = {
        path: np.full(about.count, np.nan) for path in numbers
    }
    for position, parameters in store.rows(("position", "parameters")):
        values = json.loads(parameters)
        for path, index in numbers.items():
            columns[path][position] = values[index]
    for path, index in numbers.items():
        variable = target.create_variable(path, ("case",), data=columns[path])
        variable.attrs["units"] = about.units[index]
