"""Field files read back: values, units, one global frame."""

import base64
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest

import rollnip as rn
from rollnip.io.fields import write_fields

xr = pytest.importorskip("xarray")
pytest.importorskip("h5netcdf")


@pytest.fixture(scope="module")
def solved():
    rubber = rn.Elastic(modulus=0.91, poisson=0.5)
    lossy = rn.StandardLinearSolid(modulus=2.0, stiffening=3.0, relaxation_time=0.007, poisson=0.4)
    nip = rn.Nip(
        upper=rn.Roller(
            radius=50.0, layers=[rn.Layer(0.5, rn.Elastic(modulus=9.0, poisson=0.3)),
                                 rn.Layer(2.0, rubber)],
        ),
        lower=rn.Roller(radius=25.0, layers=[rn.Layer(2.7, lossy)]),
        normal=rn.LineLoad(1.78),
        tangential=rn.Traction(0.3),
        friction=0.8,
        speed=100.0,
        title="A <title> -- with é",
    )  # fmt: skip
    return rn.solve(nip, rn.Model(geometry="second"))


def arrays(path):
    tree = ET.parse(path)
    out = {}
    for node in tree.iter("DataArray"):
        raw = base64.b64decode(node.text)
        size = int.from_bytes(raw[:8], "little")
        assert len(raw) == 8 + size
        kind = {"Float64": "<f8", "Int32": "<i4"}[node.attrib["type"]]
        values = np.frombuffer(raw[8:], kind)
        components = int(node.attrib["NumberOfComponents"])
        out[node.attrib["Name"]] = values.reshape(-1, components) if components > 1 else values
    return tree, out


def test_vtr(solved, tmp_path):
    path = tmp_path / "fields.vtr"
    write_fields(solved, path)
    assert [p.name for p in tmp_path.iterdir()] == ["fields.vtr"]
    tree, data = arrays(path)
    x, z = data["x"], data["z"]
    grid = tree.getroot().find("RectilinearGrid")
    assert grid.attrib["WholeExtent"] == f"0 {x.size - 1} 0 0 0 {z.size - 1}"
    assert np.all(np.diff(x) > 0.0)
    assert np.all(np.diff(z) >= 0.0)
    assert (z[0], z[-1]) == (-2.7, 2.5)
    shape = (z.size, x.size)
    part = {k: v.reshape(shape) for k, v in data.items() if v.size == z.size * x.size}
    displacement = data["displacement"].reshape(*shape, 3)
    upper = part["roller"][:, 0] == 1
    assert np.all(z[upper] >= 0.0)
    assert np.all(z[~upper] <= 0.0)
    top, bottom = np.flatnonzero(upper)[0], np.flatnonzero(~upper)[-1]
    # Across the contact the tractions go on: action and reaction in one frame.
    assert part["s_zz"][top] == pytest.approx(part["s_zz"][bottom], abs=1e-9)
    assert part["s_xz"][top] == pytest.approx(part["s_xz"][bottom], abs=1e-9)
    # The upper surface is pushed up, the lower one down.
    middle = np.argmin(np.abs(x))
    assert displacement[top, middle, 2] > 0.0 > displacement[bottom, middle, 2]
    assert np.all(displacement[..., 1] == 0.0)
    assert sorted(set(part["layer"][upper, 0])) == [0, 1]
    assert np.all(np.diff(part["layer"][upper, 0]) >= 0)
    field = solved.interior("lower", -z[5], x)
    assert part["s_xz"][5] == pytest.approx(-field.s_xz[0], abs=1e-8)
    assert part["von_mises"][5] == pytest.approx(field.von_mises[0], abs=1e-8)


def test_netcdf(solved, tmp_path):
    path = tmp_path / "fields.nc"
    write_fields(solved, path)
    assert [p.name for p in tmp_path.iterdir()] == ["fields.nc"]
    with xr.open_dataset(path, engine="h5netcdf") as root:
        assert float(root["load"]) == pytest.approx(1.78)
        assert root["pressure"].attrs["units"] == "MPa"
    for name in ("upper", "lower"):
        with xr.open_dataset(path, group=name, engine="h5netcdf") as group:
            assert all("units" in group[key].attrs for key in group.variables)
            z, x = group["z"].values, group["x"].values
            assert np.all(np.diff(z) > 0.0)
            field = solved.interior(name, z[3:5], x)
            for key in ("u_x", "s_xx", "s_xz", "von_mises", "loss_density"):
                scale = float(np.max(np.abs(group[key]))) or 1.0
                assert group[key].values[3:5] == pytest.approx(
                    getattr(field, key), abs=1e-7 * scale
                )
            surface = np.interp(x, solved.final.nodes, np.pad(solved.pressure, 1))
            assert group["s_zz"].values[0] == pytest.approx(-surface, abs=1e-9)
    with xr.open_dataset(path, group="upper", engine="h5netcdf") as upper:
        first = int(np.argmax(upper["layer"].values == 1))
        jump = upper["s_xx"].values[first] - upper["s_xx"].values[first - 1]
        assert np.max(np.abs(jump)) > 0.01
        flow = upper["s_zz"].values[first] - upper["s_zz"].values[first - 1]
        assert np.max(np.abs(flow)) < 1e-8


def test_one_rigid_roller_and_a_half_space(tmp_path):
    nip = rn.Nip(
        upper=rn.Roller(radius=50.0, core=rn.Elastic(modulus=10.0, poisson=0.3)),
        lower=rn.Roller(radius=25.0),
        normal=rn.LineLoad(1.0),
        friction=0.0,
    )
    solution = rn.solve(nip, rn.Model(geometry="linear"))
    write_fields(solution, tmp_path / "half.vtr")
    _, data = arrays(tmp_path / "half.vtr")
    assert set(data["roller"]) == {1}
    assert data["z"][-1] == pytest.approx(2.0 * solution.nip_width)
    write_fields(solution, tmp_path / "half.nc")
    with pytest.raises(OSError, match="lower"):
        xr.open_dataset(tmp_path / "half.nc", group="lower", engine="h5netcdf")


@pytest.mark.parametrize("name", ["fields.csv", "missing/fields.vtr"])
def test_bad_targets(solved, tmp_path, name):
    with pytest.raises(rn.RollnipError):
        write_fields(solved, tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def test_a_failure_leaves_the_old_file(solved, tmp_path, monkeypatch):
    path = tmp_path / "fields.nc"
    path.write_text("old")

    def fail(*_):
        raise OSError("no space")

    monkeypatch.setattr(Path, "write_bytes", fail)
    with pytest.raises(rn.RollnipError, match="no space"):
        write_fields(solved, path)
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]
