"""Results as netCDF files, through the extra ``rollnip[netcdf]``.

A file is made in memory and written as one piece: where the disk is full, a plain write says so,
while HDF5 would end the process when it cannot write what it still holds.
"""

from __future__ import annotations

from collections.abc import Mapping
from io import BytesIO
from pathlib import Path
from typing import Any

from rollnip._extras import require_extra
from rollnip._files import write_whole
from rollnip._results.dataset import result_dataset
from rollnip.figure import Figure

_SIDES = ("upper", "lower")


def require_netcdf() -> None:
    """Raise RollnipError where the extra is not installed."""
    require_extra("netcdf", "writing netCDF", "write .json")


def write_netcdf(groups: Mapping[str, Any], path: Path) -> None:
    """Write xarray datasets to one file, all or nothing: each a group, "/" the root.

    The file follows the CF conventions: coordinates have no value for what is missing.

    Raises RollnipError where the file cannot be written; a file of that name stays as it was.
    """
    from h5netcdf import File
    from xarray.backends import H5NetCDFStore

    memory = BytesIO()
    with File(memory, "w") as file:
        for name, dataset in groups.items():
            is_root = name == "/"
            written = dataset.assign_attrs(Conventions="CF-1.11") if is_root else dataset
            written.dump_to_store(
                H5NetCDFStore(file if is_root else file.create_group(name)),
                encoding={key: {"_FillValue": None} for key in dataset.coords},
            )
    write_whole(path, lambda target: target.write_bytes(memory.getbuffer()))


def result_groups(tree: dict[str, Any]) -> dict[str, Any]:
    """Return a result tree as datasets; None becomes NaN, lists become variables, texts attributes.

    The root "/" holds the nip, its face and the balance of heat; temperatures of both rollers, a
    warm-up and a branch of steady states are groups.
    """
    root = result_dataset(tree)
    if "face" in tree:
        from rollnip.face.report import face_variables  # it loads all that solves a face

        variables, attributes = face_variables(tree["face"])
        root = root.assign(variables).set_coords("y").assign_attrs(attributes)
    groups = {"/": root}
    if "heat" in tree:
        groups["/"] = _with_balance(root, tree["heat"])
        groups |= {side: _temperatures(tree["heat"][side]) for side in _SIDES}
    if "warm_up" in tree:
        groups["warm_up"] = _warm_up(tree["warm_up"])
    if "branch" in tree:
        groups["branch"] = _branch(tree["branch"])
    return groups


def _with_balance(root: Any, heat: dict[str, Any]) -> Any:
    """Return the dataset of a nip with what both rollers have together; names begin with heat."""
    from rollnip.heat.figures import BALANCE_FIGURES, COURSES, NIP_FIGURES

    variables = _scalars({f"heat_{key}": (one, heat[key]) for key, one in BALANCE_FIGURES.items()})
    for state in ("cold", "warm"):
        variables |= _scalars(
            {f"heat_{state}_{key}": (one, heat[state][key]) for key, one in NIP_FIGURES.items()}
        )
    kelvin = COURSES["rise"].unit
    for name, value, unit, text in (
        ("balance", heat["balance"], "1", "heat generated less heat that leaves, over all heat"),
        ("stable", heat["stable"], "1", "1 where a small disturbance dies out, else 0"),
        ("error_temperature", heat["error"]["temperature"], kelvin, "error of temperatures"),
    ):
        about = {"units": unit, "long_name": text}
        variables[f"heat_{name}"] = ((), float("nan") if value is None else float(value), about)
    said = {
        "heat_converged": int(heat["converged"]),
        "heat_status": heat["status"],
        "heat_solves": heat["solves"],
        "heat_sublayers": heat["sublayers"],
        "heat_warnings": "\n".join(heat["warnings"]),
    }
    return root.assign(variables).assign_attrs(said)


def _temperatures(roller: dict[str, Any]) -> Any:
    from rollnip.heat.figures import ROLLER_FIGURES

    rows = _rows("r", {name: roller[name] for name in ("r", "temperature")}, {})
    figures = {key: (one, roller[key]) for key, one in ROLLER_FIGURES.items()}
    return rows.assign(_scalars(figures))


def _scalars(figures: dict[str, tuple[Figure, float | None]]) -> dict[str, Any]:
    """Return figures and their values as variables without a dimension; None becomes NaN."""
    return {
        key: ((), float("nan") if value is None else value, figure.described)
        for key, (figure, value) in figures.items()
    }


def _warm_up(rows: dict[str, Any]) -> Any:
    columns = {"time": rows["time"], "power": rows["power"]}
    for side in _SIDES:
        parts = rows[side].items()
        columns |= {f"{name}_{side}": value for name, value in parts if value is not None}
    said = _numbers(rows, "converged", "half_time", "error")
    return _rows("time", columns, {"status": rows["status"], **said})


def _branch(branch: dict[str, Any]) -> Any:
    from rollnip.heat.figures import PARAMETERS

    points = branch["points"]
    names = ("value", "hot_spot", "rise", "power", "bond_upper", "bond_lower")
    columns = {name: [point[name] for point in points] for name in names}
    columns["stable"] = [int(point["stable"]) for point in points]
    said: dict[str, Any] = {name: branch[name] for name in ("parameter", "unit", "status")}
    said |= _numbers(branch, "reached", "solves")
    if branch["turning"] is not None:
        said["turning"] = branch["turning"]["value"]
        said |= {f"turning_{key}": value for key, value in _numbers(branch["turning"]).items()}
    return _rows("value", columns, said, PARAMETERS[branch["parameter"]].described)


def _numbers(tree: dict[str, Any], *names: str) -> dict[str, float | int]:
    """Return values of a tree as attributes, all of them without names; None becomes NaN."""
    found = {name: tree[name] for name in names or tree}
    return {
        name: float("nan") if one is None else int(one) if isinstance(one, bool) else one
        for name, one in found.items()
    }


def _rows(
    along: str,
    columns: dict[str, Any],
    attributes: dict[str, Any],
    about: dict[str, str] | None = None,
) -> Any:
    """Return the dataset of columns over the one called ``along``, which ``about`` describes."""
    import xarray as xr

    from rollnip.heat.figures import COURSES

    def described(key: str) -> dict[str, str]:
        plain = key.removesuffix("_upper").removesuffix("_lower")
        if plain in COURSES:
            return COURSES[plain].described
        return about or {} if key == along else {"units": "1", "long_name": plain}

    rows = {
        key: [float("nan") if one is None else one for one in values]
        for key, values in columns.items()
    }
    variables = {key: (along, values, described(key)) for key, values in rows.items()}
    place = variables.pop(along)
    return xr.Dataset(variables, coords={along: place}, attrs=attributes)
