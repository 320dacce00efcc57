"""A solution says what was solved and what came out: a line, a summary, HTML, a dataset."""

import json
from dataclasses import replace

import numpy as np
import pytest

import rollnip as rn
from rollnip.io import parse_case, result_dict, write_result


@pytest.fixture(scope="module")
def solved():
    rubber = rn.Elastic(modulus=0.91, poisson=0.5)
    nip = rn.Nip(
        upper=rn.Roller(radius=50, layers=[rn.Layer(2.0, rubber)]),
        lower=rn.Roller(radius=25),
        normal=rn.LineLoad(0.74),
        friction=2.7,
        speed=100,
        title="<Nip> & co",
    )
    return rn.solve(nip, rn.Model(geometry="linear", tolerance=2e-3))


def test_repr_is_one_useful_line(solved):
    text = repr(solved)
    assert "\n" not in text
    assert len(text) < 200
    width = f"{solved.nip_width:.3f}"
    for part in ("Solution", '"<Nip> & co"', "converged", "linear", f"nip width {width} mm"):
        assert part in text
    assert "NOT CONVERGED" in repr(replace(solved, converged=False))


def test_the_summary_holds_every_section(solved):
    text = solved.summary()
    for part in ("converged and verified", "Nip", "Drive", "Losses", "Stick and slip", "±"):
        assert part in text
    lines = [line.split() for line in text.splitlines() if "torque, upper axle" in line]
    assert [line[:-1] for line in lines] == [["torque,", "upper", "axle", "0", "N", "mm/mm", "±"]]
    assert 0.0 < float(lines[0][-1]) < 1e-2  # of a free roller, exactly 0: what the mesh leaves


def test_html_of_a_notebook_is_escaped_and_closed(solved):
    from xml.etree import ElementTree

    html = solved._repr_html_()
    assert "&lt;Nip&gt; &amp; co" in html
    root = ElementTree.fromstring(f"<div>{html.replace('<br>', '<br/>')}</div>")
    assert len(root.findall(".//td")) > 30


def test_json_and_solution_hold_the_case(solved):
    tree = json.loads(json.dumps(result_dict(solved)))
    case = parse_case(tree["case"])
    assert (case.nip, case.model) == (solved.nip, solved.model)
    assert tree["case"] == solved.case
    assert tree["case_hash"] == solved.case_hash
    assert tree["tolerance"] == 2e-3
    assert tree["version"] == tree["solver"]["version"] == rn.__version__


def test_xarray_is_what_the_netcdf_file_holds(solved, tmp_path):
    xarray = pytest.importorskip("xarray")
    write_result(solved, tmp_path / "nip.nc")
    with xarray.open_dataset(tmp_path / "nip.nc", engine="h5netcdf") as read:
        made = solved.to_xarray(interfaces=True)
        assert set(read.variables) == set(made.variables)
        assert np.array_equal(read["pressure"], made["pressure"])
        assert read.attrs["case_hash"] == solved.case_hash
        assert read.attrs["tolerance"] == 2e-3
        case = parse_case(json.loads(read.attrs["case"]))
        assert (case.nip, case.model) == (solved.nip, solved.model)
        bond = read["interface_shear_range"]
        assert bond.attrs["units"] == "MPa"
        assert float(bond[0]) == solved.interfaces[0].shear_range
    assert "interface_depth" not in solved.to_xarray()
