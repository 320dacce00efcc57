"""Files of a nip in thermal balance: JSON and netCDF."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from rollnip._files import write_whole
from rollnip.heat import Branch, HeatSolution, WarmUp
from rollnip.heat.report import branch_dict, heat_dict, heat_parts, warm_up_dict
from rollnip.io.netcdf import write_netcdf
from rollnip.io.result import check_result_target, result_dict

_UNITS = {
    "r": ("mm", "radius"),
    "temperature": ("degC", "temperature"),
    "time": ("s", "time"),
    "hot_spot": ("degC", "highest temperature"),
    "surface": ("degC", "temperature of the surface"),
    "bond": ("degC", "temperature of the bond"),
    "power": ("mW mm-1", "heat of the nip"),
}


def heat_tree_of(
    solution: HeatSolution, course: WarmUp | None = None, branch: Branch | None = None
) -> dict[str, Any]:
    """Return the result of the warm nip with the keys "heat", "warm_up" and "branch"."""
    tree = {**result_dict(solution.warm), **heat_parts(solution)}
    tree["title"] = solution.nip.title
    if course is not None:
        tree["warm_up"] = warm_up_dict(course)
    if branch is not None:
        tree["branch"] = branch_dict(branch)
    return tree


def heat_text(
    solution: HeatSolution, course: WarmUp | None = None, branch: Branch | None = None
) -> str:
    """Return the result as JSON, a line for each key."""
    tree = heat_tree_of(solution, course, branch)
    lines = [f"{json.dumps(key)}: {json.dumps(one, allow_nan=False)}" for key, one in tree.items()]
    return "{\n  " + ",\n  ".join(lines) + "\n}\n"


def write_heat(
    solution: HeatSolution,
    path: str | Path,
    course: WarmUp | None = None,
    branch: Branch | None = None,
) -> None:
    """Write a nip in thermal balance to a file, all or nothing.

    Parameters
    ----------
    solution : what `solve_heat` returned.
    path : ends in .json, or in .nc (netCDF): the root holds the warm nip, the groups ``upper``
        and ``lower`` the temperatures over the radius, ``warm_up`` and ``branch`` the rest.
    course, branch : what `warm_up` and `follow_heat` returned; None: without.

    Raises
    ------
    RollnipError
        where the ending is another, the extra is missing, or the file cannot be written; a file
        of that name stays as it was.
    """
    target = Path(path)
    check_result_target(target)
    if target.suffix.lower() == ".nc":
        write_whole(target, lambda file: _write_netcdf(solution, file, course, branch))
    else:
        text = heat_text(solution, course, branch)
        write_whole(target, lambda file: file.write_text(text, encoding="utf-8", newline="\n"))


def _write_netcdf(
    solution: HeatSolution, path: Path, course: WarmUp | None, branch: Branch | None
) -> None:
    write_netcdf(result_dict(solution.warm), path)
    tree = heat_dict(solution)
    for side in ("upper", "lower"):
        one = tree[side]
        attributes = {key: value for key, value in one.items() if isinstance(value, float)}
        _group(path, side, "r", {name: one[name] for name in ("r", "temperature")}, attributes)
    if course is not None:
        rows = warm_up_dict(course)
        columns = {"time": rows["time"], "power": rows["power"]}
        for side in ("upper", "lower"):
            parts = rows[side].items()
            columns |= {f"{name}_{side}": value for name, value in parts if value is not None}
        _group(path, "warm_up", "time", columns, {"status": course.status})
    if branch is not None:
        found = branch_dict(branch)
        points = found["points"]
        names = ("value", "hot_spot", "rise", "power")
        columns = {name: [point[name] for point in points] for name in names}
        columns["stable"] = [int(point["stable"]) for point in points]
        said: dict[str, Any] = {name: found[name] for name in ("parameter", "unit", "status")}
        if branch.turning is not None:
            said["turning"] = branch.turning.value
        _group(path, "branch", "value", columns, said)


def _group(
    path: Path, name: str, along: str, columns: dict[str, Any], attributes: dict[str, Any]
) -> None:
    import xarray as xr

    variables = {
        key: (along, values, _described(key)) for key, values in columns.items() if key != along
    }
    coordinates = {along: (along, columns[along], _described(along))}
    dataset = xr.Dataset(variables, coords=coordinates, attrs=attributes)
    dataset.to_netcdf(path, mode="a", group=name, engine="h5netcdf")


def _described(name: str) -> dict[str, str]:
    plain = name.removesuffix("_upper").removesuffix("_lower")
    unit, text = _UNITS.get(plain, ("1", plain.replace("_", " ")))
    return {"units": unit, "long_name": text}
