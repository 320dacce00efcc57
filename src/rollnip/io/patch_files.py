"""Files of a solved patch: JSON with its fields, or netCDF."""

from __future__ import annotations

from json import dumps
from pathlib import Path

from rollnip._files import check_target, write_whole
from rollnip.io.netcdf import require_netcdf
from rollnip.patch.report import FIELDS, UNITS, fields_of, patch_dict
from rollnip.patch.solution import PatchSolution

SUFFIXES = (".json", ".nc")


def check_patch_target(path: Path) -> None:
    """Raise RollnipError where a patch could not be written to ``path``; costs next to nothing."""
    check_target(path, SUFFIXES)
    if path.suffix.lower() == ".nc":
        require_netcdf()


def write_patch(solution: PatchSolution, path: str | Path) -> None:
    """Write a solved patch with its fields to a file, all or nothing.

    ``.json``: the tree of `rollnip patch solve --fields`. ``.nc``: netCDF by the extra
    ``rollnip[netcdf]``: fields over y and x with units, figures and their errors as scalars.

    Parameters
    ----------
    solution : what `solve_patch` returned.
    path : ends in .json or .nc.

    Raises
    ------
    RollnipError
        where the ending is another, the extra is missing, or the file cannot be written; a file
        of that name stays as it was.
    """
    target = Path(path)
    check_patch_target(target)
    if target.suffix.lower() == ".json":
        text = dumps(patch_dict(solution, fields=True), allow_nan=False) + "\n"
        write_whole(target, lambda file: file.write_text(text, encoding="utf-8", newline="\n"))
    else:
        write_whole(target, lambda file: _write_netcdf(solution, file))


def _write_netcdf(solution: PatchSolution, path: Path) -> None:
    import xarray

    values = {}
    for name, field in fields_of(solution).items():
        unit, text = FIELDS[name]
        values[name] = (("y", "x"), field, {"units": unit, "long_name": text})
    scalars = {}
    for name, value in solution.figures.items():
        of = {"units": UNITS[name] or "1"}
        scalars[name] = ((), value, of)
        scalars[f"{name}_error"] = ((), solution.error[name], of)
    places = {"units": "mm"}
    dataset = xarray.Dataset(
        values | scalars,
        coords={"x": ("x", solution.x, places), "y": ("y", solution.y, places)},
        attrs={
            "title": solution.patch.title,
            "status": solution.status,
            "converged": int(solution.converged),
        },
    )
    dataset.to_netcdf(path, engine="h5netcdf")
