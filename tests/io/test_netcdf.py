"""netCDF files are made in memory: a disk without room is an error of one line, no crash."""

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import pytest

from rollnip import RollnipError
from rollnip.io import result_dict, write_result
from rollnip.io.netcdf import result_groups, write_netcdf

resource = pytest.importorskip("resource")  # POSIX only
xr = pytest.importorskip("xarray")
pytest.importorskip("h5netcdf")

# Writing beyond a limit fails as on a full disk, in the middle of a file. HDF5 ended the process
# at the two larger ones.
ROOMS = (0, 4096, 9216)


@contextmanager
def largest_file(size: int) -> Iterator[None]:
    """Let no file grow beyond a size in bytes; pytest writes its own report to one, too."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


def datasets():
    x = np.linspace(0.0, 1.0, 2000)
    root = xr.Dataset({"p": ("x", np.sin(x))}, coords={"x": x}, attrs={"title": "root"})
    return {"/": root, "upper": root.assign_attrs(title="upper"), "lower": root * 2.0}


@pytest.mark.parametrize("room", ROOMS)
def test_no_room_leaves_the_old_file(tmp_path, room):
    path = tmp_path / "a.nc"
    path.touch()
    cannot = pytest.raises(RollnipError, match=r"a\.nc: cannot write: File too large\.$")
    with cannot, largest_file(room):
        write_netcdf(datasets(), path)
    assert path.stat().st_size == 0
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("room", ROOMS)
def test_no_room_for_a_result(solution, tmp_path, room):
    with pytest.raises(RollnipError, match="File too large"), largest_file(room):
        write_result(solution, tmp_path / "a.nc")
    assert list(tmp_path.iterdir()) == []


def test_groups_are_read_back(tmp_path):
    path = tmp_path / "a.nc"
    write_netcdf(datasets(), path)
    for name, given in datasets().items():
        with xr.open_dataset(path, group=name, engine="h5netcdf") as read:
            expected = given.assign_attrs(Conventions="CF-1.11") if name == "/" else given
            xr.testing.assert_identical(read.load(), expected)


def test_a_result_follows_the_cf_conventions(solution, tmp_path):
    path = tmp_path / "a.nc"
    write_result(solution, path)
    with xr.open_dataset(path) as found:
        assert found.attrs["Conventions"].startswith("CF-")
        for name, one in found.variables.items():
            assert one.attrs["long_name"], name
            assert "units" in one.attrs or one.dtype.kind not in "if", name
        for name in found.coords:
            assert "_FillValue" not in found[name].encoding, name


def test_a_warm_up_and_a_branch_lose_nothing(solution):
    """Their groups hold what the JSON holds, list by list and number by number."""
    side = {"hot_spot": [23.0, 40.0], "surface": [23.0, 30.0], "bond": None}
    point = {"value": 2.0, "rise": 9.0, "hot_spot": 40.0, "bond_upper": 30.0}
    point |= {"bond_lower": None, "power": 5.0, "stable": False}
    tree = result_dict(solution) | {
        "warm_up": {"converged": True, "status": "warm", "half_time": None, "error": 0.01}
        | {"time": [0.0, 9.0], "power": [5.0, 6.0], "upper": side, "lower": side},
        "branch": {"parameter": "speed", "unit": "mm/s", "status": "runs away", "reached": False}
        | {"turning": point, "points": [point, point | {"value": 3.0}], "solves": 7},
    }
    groups = result_groups(tree)
    course, branch = groups["warm_up"], groups["branch"]
    assert (course.attrs["converged"], course.attrs["error"]) == (1, 0.01)
    assert np.isnan(course.attrs["half_time"])
    assert course["surface_lower"].values.tolist() == side["surface"]
    assert (branch.attrs["reached"], branch.attrs["solves"]) == (0, 7)
    assert branch.attrs["turning"] == branch.attrs["turning_value"] == 2.0
    assert branch.attrs["turning_stable"] == 0
    assert np.isnan(branch.attrs["turning_bond_lower"])
    assert branch["bond_upper"].values.tolist() == [30.0, 30.0]
    assert np.isnan(branch["bond_lower"]).all()
    assert branch["value"].values.tolist() == [2.0, 3.0]
