"""Files of a solved patch and of the stresses under it: JSON, netCDF, ParaView."""

from __future__ import annotations

from collections.abc import Sequence
from json import dumps
from math import nan
from pathlib import Path
from typing import Any

import numpy as np

from rollnip._errors import require_instance
from rollnip._files import check_target, write_whole
from rollnip._json import json_text
from rollnip.figure import Figure
from rollnip.figures import FIELDS, FIGURES, INTERFACE_FIGURES, PLACES
from rollnip.io.netcdf import require_netcdf, write_netcdf
from rollnip.io.paraview import rectilinear
from rollnip.patch.depth import STRESSES, PatchStress
from rollnip.patch.figures import PATCH_FIELDS, PATCH_FIGURES, PATCH_PLACES
from rollnip.patch.report import PLANE_KEYS, fields_of, origin_of, patch_dict
from rollnip.patch.solution import PatchSolution
from rollnip.rollers import Side

SUFFIXES = (".json", ".nc", ".vtr")
STRESS_SUFFIXES = (".nc", ".vtr")


def check_patch_target(path: Path, suffixes: tuple[str, ...] = SUFFIXES) -> None:
    """Raise RollnipError where a patch could not be written to ``path``; costs next to nothing."""
    check_target(path, suffixes)
    if path.suffix.lower() == ".nc":
        require_netcdf()


def write_patch(solution: PatchSolution, path: str | Path) -> None:
    """Write a solved patch with its fields to a file, all or nothing.

    ``.json``: the tree of `rollnip patch solve --fields`. ``.nc``: netCDF by the extra
    ``rollnip[netcdf]``: fields over y and x with units, figures and their errors as scalars, the
    case, version and tolerance as attributes. ``.vtr``: the fields over the plane of contact for
    ParaView, shear and slip as vectors; the gap beyond the end of a face is NaN.

    Parameters
    ----------
    solution : what `solve_patch` returned.
    path : ends in .json, .nc or .vtr.

    Raises
    ------
    RollnipError
        where the ending is another, the extra is missing, or the file cannot be written; a file
        of that name stays as it was.
    """
    require_instance("solution", solution, PatchSolution, "; give what `solve_patch` returned")
    target = Path(path)
    check_patch_target(target)
    if target.suffix.lower() == ".json":
        text = json_text(patch_dict(solution, fields=True), indent=None) + "\n"
        write_whole(target, lambda file: file.write_text(text, encoding="utf-8", newline="\n"))
    elif target.suffix.lower() == ".vtr":
        surface = _surface(solution)
        write_whole(target, lambda file: file.write_text(surface, "ascii", newline="\n"))
    else:
        write_netcdf({"/": _dataset(solution)}, target)


def write_stress(solution: PatchSolution, side: Side, z: Sequence[float], path: str | Path) -> None:
    """Write the stresses in one roller at some depths to a file, all or nothing.

    ``.nc``: netCDF by the extra ``rollnip[netcdf]``, over z, y and x in the roller's own frame, z
    into its body. ``.vtr``: a grid for ParaView with z upwards: the lower roller's depths are
    negative there, and the signs of its s_xz and s_yz turned.

    Parameters
    ----------
    solution : what `solve_patch` returned.
    side : "upper" or "lower".
    z : increasing depths [mm].
    path : ends in .nc or .vtr.

    Raises
    ------
    RollnipError
        as `write_patch`, and where a depth is none of that roller.
    """
    target = Path(path)
    check_patch_target(target, STRESS_SUFFIXES)
    field = solution.stress(side, z)
    if target.suffix.lower() == ".vtr":
        text = _body(solution.patch.title, side, field)
        write_whole(target, lambda file: file.write_text(text, "ascii", newline="\n"))
    else:
        write_netcdf({"/": _stress_dataset(solution, side, field)}, target)


def _surface(solution: PatchSolution) -> str:
    """Return the fields of the plane of contact as the text of a .vtr file."""
    flat = np.zeros_like(solution.pressure)
    gap = np.where(np.isfinite(solution.gap), solution.gap, nan)
    data = {
        "pressure": solution.pressure,
        "gap": gap,
        "state": solution.state.astype(np.int32),
        "shear": np.stack([solution.shear_x, solution.shear_y, flat], axis=-1),
        "slip": np.stack([solution.slip_x, solution.slip_y, flat], axis=-1),
    }
    places = (solution.x, solution.y, np.zeros(1))
    title = solution.patch.title
    return rectilinear(title, places, data, scalars="pressure", vectors="shear")


def _body(title: str, side: Side, field: PatchStress) -> str:
    """Return the stresses of a roller as the text of a .vtr file, z upwards."""
    is_upper = side == "upper"
    rows = slice(None) if is_upper else slice(None, None, -1)
    data = {}
    for name in STRESSES:
        turned = -1.0 if name in ("s_xz", "s_yz") and not is_upper else 1.0
        data[name] = turned * getattr(field, name)[rows]
    heights = field.z if is_upper else -field.z[::-1]
    places = (field.x, field.y, np.asarray(heights))
    return rectilinear(title, places, data, scalars="von_mises")


def _stress_dataset(solution: PatchSolution, side: Side, field: PatchStress) -> Any:
    """Return the stresses in one roller as an xarray dataset."""
    import xarray

    depth = INTERFACE_FIGURES["depth"].described | {"positive": "down"}
    return xarray.Dataset(
        {
            name: (("z", "y", "x"), getattr(field, name), FIELDS[name].described)
            for name in STRESSES
        },
        coords={
            "x": ("x", field.x, PATCH_PLACES["x"].described),
            "y": ("y", field.y, PATCH_PLACES["y"].described),
            "z": ("z", field.z, depth),
        },
        attrs={"roller": side, **_attributes(solution)},
    )


def _dataset(solution: PatchSolution) -> Any:
    """Return the fields and figures of a patch as an xarray dataset.

    Figures that a nip has, too, have its names; those of the key "patch" begin with patch.
    """
    import xarray

    tree = patch_dict(solution)
    values = {}
    for name, field in fields_of(solution).items():
        values[name] = (("y", "x"), field, PATCH_FIELDS[name].described)
    for one in FIGURES.values():
        (table, _, key), name = one.key.rpartition("."), one.name
        described = PATCH_FIGURES[PLANE_KEYS[name]] if name in PLANE_KEYS else one
        values[name] = _scalar((tree[table] if table else tree)[key], described.described)
        if name in tree["error"]:
            values[f"error_{name}"] = _scalar(tree["error"][name], _error_of(described))
    for key, figure in PATCH_FIGURES.items():
        values[f"patch_{key}"] = _scalar(tree["patch"][key], figure.described)
        if key in tree["patch"]["error"]:
            error = tree["patch"]["error"][key]
            values[f"patch_error_{key}"] = _scalar(error, _error_of(figure))
    values["contact"] = (("interval", "edge"), tree["contact"], PLACES["contact"].described)
    edges = ("edge", ["trailing", "leading"], {"long_name": "edge of the contact"})
    return xarray.Dataset(
        values,
        coords={
            key: (key, getattr(solution, key), one.described) for key, one in PATCH_PLACES.items()
        }
        | {"edge": edges},
        attrs=_attributes(solution),
    )


def _scalar(value: float | None, about: dict[str, str]) -> tuple[Any, ...]:
    return ((), nan if value is None else value, about)


def _error_of(figure: Figure) -> dict[str, str]:
    return {"units": figure.unit, "long_name": f"estimated error of the {figure.label}"}


def _attributes(solution: PatchSolution) -> dict[str, Any]:
    """Return what a netCDF file says of its solution as a whole; the case is a text of JSON."""
    origin, tree = origin_of(solution), patch_dict(solution)
    return {
        "schema": tree["schema"],
        "geometry": tree["geometry"],
        "title": solution.patch.title,
        "status": solution.status,
        "converged": int(solution.converged),
        **origin,
        "case": dumps(origin["case"]),
        "warnings": "\n".join(solution.warnings),
    } | {
        f"solver_{name}": nan if value is None else value for name, value in tree["solver"].items()
    }
