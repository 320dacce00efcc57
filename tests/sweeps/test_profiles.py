"""Profiles of all cases in one file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rollnip._errors import RollnipError
from rollnip.io import parse_case
from rollnip.solver import solve
from rollnip.sweeps import read_study
from rollnip.sweeps.profiles import write_profiles
from rollnip.sweeps.run import OpenCases, run
from rollnip.sweeps.store import About, Store

xarray = pytest.importorskip("xarray")


@pytest.mark.parametrize("wanted", [["pressure"], []])
def test_profiles_are_those_of_the_solutions(
    tree: dict[str, Any], tmp_path: Path, wanted: list[str]
) -> None:
    study = read_study(tree | {"profiles": wanted})
    with Store(None, About.of(study, "1")) as store:
        run(OpenCases(study, store), store)
        cases = OpenCases(study, store, with_profiles=True)
        assert cases.count == 4  # what was solved without them, but not what was refused
        run(cases, store)
        write_profiles(store, tmp_path / "a.nc")
    with xarray.open_dataset(tmp_path / "a.nc", engine="h5netcdf") as data:
        assert ("shear" in data) == (not wanted)
        assert data["pressure"].attrs["units"] == "MPa"
        assert list(data["nip.load"].values[:3]) == [0.5, -1.0, 1.0]
        for position in range(6):
            pressure = data["pressure"].values[position]
            if position % 3 == 1:
                assert np.isnan(pressure).all()
                continue
            case = parse_case(study.case(position))
            profiles = solve(case.nip, case.model).profiles
            known = ~np.isnan(data["x"].values[position])
            assert np.array_equal(data["x"].values[position][known], profiles.x)
            assert np.array_equal(pressure[known], profiles.pressure)


def test_profiles_that_were_not_kept_are_not_written(tree: dict[str, Any], tmp_path: Path) -> None:
    study = read_study(tree)
    with Store(None, About.of(study, "1")) as store:
        run(OpenCases(study, store), store)
        with pytest.raises(RollnipError, match=r"holds no profiles to write to .*a\.nc"):
            write_profiles(store, tmp_path / "a.nc")
    assert not (tmp_path / "a.nc").exists()
