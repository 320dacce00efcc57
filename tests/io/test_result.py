"""The result tree is the contract's, and both kinds of file hold it."""

import json
import sys
from dataclasses import replace
from math import inf, nan

import numpy as np
import pytest

import rollnip as rn
from rollnip._errors import RollnipError
from rollnip.figures import CLAIMED
from rollnip.io import result_dict, result_text, write_result

KEYS = [
    "schema", "title", "converged", "geometry", "tolerance", "version", "case_hash", "case",
    "load", "approach", "traction", "creepage", "speed_ratio",
    "nip_width", "dwell_time", "peak_pressure", "peak_pressure_x", "mean_pressure",
    "torque_upper", "torque_lower", "rolling_resistance", "dissipation", "max_surface_strain",
    "contact", "zones", "error", "profiles", "solver", "warnings", "interfaces",
]  # fmt: skip
PROFILES = [
    "x", "pressure", "shear", "gap", "slip_velocity",
    "strain_upper", "strain_lower", "speed_upper", "speed_lower",
]  # fmt: skip


def test_the_keys_of_the_contract_in_its_order(solution):
    tree = result_dict(solution)
    assert list(tree) == KEYS
    assert list(tree["profiles"]) == PROFILES
    assert list(tree["dissipation"]) == ["friction", "viscous"]
    assert list(tree["error"]) == list(CLAIMED)
    assert set(tree["error"]) >= {"load", "approach", "creepage", "nip_width", "peak_pressure"}
    assert list(tree["solver"])[:5] == ["elements", "iterations", "residual", "seconds", "version"]
    assert tree["schema"] == 1
    assert tree["zones"] == [
        {"from": -3.5, "to": -3.0, "state": "slip", "direction": -1},
        {"from": -3.0, "to": 3.72, "state": "stick"},
    ]
    assert tree["contact"] == [[-3.5, 3.72]]


def test_only_plain_values(solution):
    changed = replace(solution, load=np.float64(2.0), converged=np.True_)
    tree = result_dict(changed)
    assert type(tree["load"]) is float
    assert tree["converged"] is True
    assert json.loads(json.dumps(tree, allow_nan=False)) == tree


def test_not_finite_or_not_defined_is_null(solution):
    profiles = replace(
        solution.profiles, slip_velocity=None, gap=np.where(solution.profiles.x > 0, nan, 1.0)
    )
    changed = replace(
        solution, approach=None, creepage=nan, dwell_time=inf, profiles=profiles, zones=()
    )
    tree = json.loads(result_text(changed))
    assert tree["approach"] is None
    assert tree["creepage"] is None
    assert tree["dwell_time"] is None
    assert tree["zones"] == []
    assert tree["profiles"]["slip_velocity"] is None
    assert tree["profiles"]["gap"][-1] is None
    assert tree["profiles"]["gap"][0] == 1.0


def test_totals_with_a_face_width(solution):
    wide = replace(solution, nip=replace(solution.nip, face_width=300.0))
    totals = result_dict(wide)["totals"]
    assert totals["load"] == pytest.approx(534.0)  # N
    assert totals["torque_upper"] == pytest.approx(8.34)  # N m
    assert totals["dissipation_friction"] == pytest.approx(1.434)  # W


def test_json_round_trip(solution, tmp_path):
    path = tmp_path / "result.json"
    write_result(solution, path)
    assert json.loads(path.read_text("utf-8")) == result_dict(solution)
    assert list(tmp_path.iterdir()) == [path]


def test_text_is_the_tree(solution):
    strange = replace(solution, nip=replace(solution.nip, title='"Nip" µ\n\x01'))
    assert json.loads(result_text(strange)) == result_dict(strange)


def test_netcdf_round_trip(solution, tmp_path):
    xarray = pytest.importorskip("xarray")
    path = tmp_path / "result.nc"
    wide = replace(solution, nip=replace(solution.nip, face_width=300.0), approach=None)
    write_result(wide, str(path))
    tree = result_dict(wide)
    with xarray.open_dataset(path, engine="h5netcdf") as data:
        for name in PROFILES:
            np.testing.assert_array_equal(data[name], tree["profiles"][name])
            assert data[name].dims == ("x",)
            assert "units" in data[name].attrs
        assert float(data["peak_pressure"]) == 0.353
        assert data["peak_pressure"].attrs["units"] == "MPa"
        assert np.isnan(data["approach"])
        assert data["zone_state"].values.tolist() == ["slip", "stick"]
        assert data["zone_from"].values.tolist() == [-3.5, -3.0]
        assert data["zone_direction"].values.tolist() == [-1, 0]
        assert data["contact"].dims == ("interval", "edge")
        assert data["contact"].sel(edge="leading").values.tolist() == [3.72]
        assert float(data["total_load"]) == pytest.approx(534.0)
        assert float(data["dissipation_friction"]) == 4.78
        assert data.attrs["title"] == "Made by hand"
        assert data.attrs["converged"] == 1
        assert data.attrs["solver_elements"] == 240
    assert list(tmp_path.iterdir()) == [path]


def test_netcdf_without_zones_speed_or_title(solution, tmp_path):
    xarray = pytest.importorskip("xarray")
    path = tmp_path / "result.nc"
    bare = replace(
        solution,
        nip=replace(solution.nip, title="", friction=0.0, tangential=rn.Traction(0.0)),
        zones=(),
        warnings=(),
        profiles=replace(solution.profiles, slip_velocity=None),
    )
    write_result(bare, path)
    with xarray.open_dataset(path, engine="h5netcdf") as data:
        assert data.sizes["zone"] == 0
        assert np.isnan(data["slip_velocity"]).all()


def test_an_unknown_ending_or_a_missing_extra_is_one_line(solution, tmp_path, monkeypatch):
    with pytest.raises(RollnipError, match=r"must end in \.json or \.nc"):
        write_result(solution, tmp_path / "result.csv")
    monkeypatch.setitem(sys.modules, "xarray", None)
    with pytest.raises(RollnipError, match=r"needs xarray, of the extra `netcdf`"):
        write_result(solution, tmp_path / "result.nc")
    assert list(tmp_path.iterdir()) == []
