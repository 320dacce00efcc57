"""Case files in three dimensions, the commands, JSON and the picture."""

from __future__ import annotations

import json
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import rollnip as rn
from rollnip._errors import CaseFileError
from rollnip._results.case import patch_case_tree
from rollnip.cli.app import app
from rollnip.io.patch_case import parse_patch_case, patch_hash, read_patch_case
from rollnip.io.patch_files import write_patch, write_stress
from rollnip.materials import shore_a_of_modulus
from rollnip.patch.ends import doubts
from rollnip.patch.report import patch_dict, patch_lines
from rollnip.plots import plot_patch

EXAMPLES = sorted((Path(__file__).parents[2] / "examples" / "patch").glob("*.toml"))
WHEEL = """
title = "Wheel"
[nip]
load = "0.2 kN"
traction = "10 N"
lateral_creepage = "0.1 %"
spin = "0.1 1/m"
friction = 0.6
speed = "1 m/s"
[patch]
grid = [16, 16]
[upper]
radius = "50 mm"
lateral_radius = "200 mm"
face = "40 mm"
end_radius = "2 mm"
[[upper.layers]]
thickness = "8 mm"
material = "rubber"
[lower]
radius = "inf"
[materials.rubber]
model = "elastic"
modulus = "5 MPa"
poisson = 0.5
"""


PRESSED = """
[nip]
load = "0.2 kN"
friction = 0
[patch]
grid = [12, 12]
""" + WHEEL[WHEEL.index("[upper]") :]
"""The same wheel without friction, on a few rectangles."""


def test_a_case_is_the_problem_that_it_says():
    case = parse_patch_case(WHEEL)
    patch = case.patch
    assert case.grid == (16, 16)
    assert patch.normal == rn.Force(200.0)
    assert patch.along == rn.Force(10.0)
    assert patch.across == rn.Creepage(0.001)
    assert patch.spin == pytest.approx(1e-4)
    assert patch.speed == 1000.0
    assert patch.across_upper == rn.Across(radius=200.0, face=40.0, end_radius=2.0)
    assert patch.upper.layers[0].material == rn.Elastic(modulus=5.0, poisson=0.5)
    assert patch.lower.curvature == 0.0


WRONG = [
    ("[patch]\ngrid = [16, 16]", "", "patch: is missing"),
    ('load = "0.2 kN"', 'load = "0.2 kN/m"', "nip.load: must be a force"),
    ('load = "0.2 kN"', "", "nip: must hold load or approach"),
    ('traction = "10 N"', 'traction = "10 N"\ncreepage = 0.1', "only one of traction, creepage"),
    ('traction = "10 N"', 'traction = "500 N"', "smaller than friction"),
    ('spin = "0.1 1/m"', 'spin = "0.1 deg"', "nip.spin: must be an angle per length"),
    ('face = "40 mm"', 'face = "3 mm"', "upper.end_radius: must have a `face`"),
    ('face = "40 mm"', 'fase = "40 mm"', 'did you mean "face"'),
    ('material = "rubber"', 'material = "ruber"', 'did you mean "rubber"'),
    ("[16, 16]", "[16]", "patch.grid: must hold two"),
    ("[patch]", '[model]\ngeometry = "finite"\n[patch]', "model.geometry: must be 'linear', got"),
    ('radius = "50 mm"', 'radius = "-50 mm"', "upper.radius: must be positive"),
    ('radius = "50 mm"', 'radius = "50 mm"\nlateral_profile = "p.csv"', "upper.lateral_profile"),
]


@pytest.mark.parametrize(("old", "new", "message"), WRONG)
def test_wrong_cases_are_one_line_with_the_key(old, new, message):
    assert old in WHEEL
    with pytest.raises(CaseFileError, match=r"^case: ") as caught:
        parse_patch_case(WHEEL.replace(old, new))
    assert message in str(caught.value)


def test_the_geometry_may_be_said_to_be_the_linear_one():
    said = parse_patch_case(WHEEL.replace("[patch]", '[model]\ngeometry = "linear"\n[patch]'))
    assert said.patch == parse_patch_case(WHEEL).patch


def test_a_measured_profile_along_the_axis(tmp_path):
    (tmp_path / "p.csv").write_text("x [mm], height [um]\n-20, 0\n0, 5\n20, 0\n")
    path = tmp_path / "case.toml"
    text = WHEEL.replace('face = "40 mm"', 'face = "40 mm"\nlateral_profile = "p.csv"')
    path.write_text(text)
    depth = read_patch_case(path).patch.across_upper.depth(np.array([0.0, 10.0]))
    np.testing.assert_allclose(depth, [-0.005, 0.25 - 0.0025])


def test_plane_cases_send_patches_to_their_command(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(WHEEL)
    with pytest.raises(CaseFileError, match="rollnip patch"):
        rn.read_case(path)


@pytest.fixture(scope="module")
def solved():
    case = parse_patch_case(WHEEL)
    return rn.solve_patch(case.patch, grid=case.grid)


def test_the_tree_holds_every_figure_and_field(solved):
    tree = json.loads(json.dumps(patch_dict(solved, fields=True), allow_nan=False))
    part = tree["patch"]
    assert part["load"] == pytest.approx(200.0)
    assert set(solved.figures) | {"spin", "friction_resistance"} <= set(part)
    assert set(part["error"]) == set(solved.figures) | {
        "friction_resistance",
        "rolling_resistance",
    }
    assert len(tree["fields"]["y"]) == len(tree["fields"]["pressure"]) == 16
    assert tree["fields"]["gap"][8][8] == pytest.approx(0.0, abs=1e-3)
    assert "fields" not in patch_dict(solved)


@pytest.mark.parametrize(
    ("key", "said"),
    [
        ("gird", 'patch.gird: is not a known key; did you mean "grid"?'),
        ("spni", 'did you mean "spin" in [nip]?'),
        ("lateral_crepage", 'did you mean "lateral_creepage" in [nip]?'),
        ("radus", 'did you mean "radius" in [upper] or [lower]?'),
        ("load", "patch.load: is not a known key here; it belongs to [nip]."),
    ],
)
def test_a_key_that_no_patch_has_is_told_the_nearest(key, said):
    with pytest.raises(CaseFileError) as refused:
        parse_patch_case(WHEEL.replace("[patch]\n", f"[patch]\n{key} = 3\n"))
    assert said in str(refused.value)


def test_a_misspelt_table_of_a_patch_is_told_its_name():
    with pytest.raises(CaseFileError, match=r'pach: is not a known key; did you mean "patch"\?'):
        rn.io.parse_case(WHEEL.replace("[patch]", "[pach]"))


def test_the_case_of_a_result_gives_the_same_result(solved):
    tree = patch_dict(solved)
    case = parse_patch_case(tree["case"])
    assert case.patch == solved.patch
    assert patch_hash(case) == tree["case_hash"]
    again = rn.solve_patch(case.patch, tolerance=case.tolerance, grid=case.grid)
    assert patch_dict(again) == tree
    assert (tree["tolerance"], tree["version"]) == (solved.tolerance, rn.__version__)


@pytest.mark.parametrize(
    "change",
    [
        {"normal": rn.Approach(0.3)},
        {"along": rn.Creepage(0.01), "across": rn.Force(-3.0)},
        {
            "across_upper": rn.Across(radius=80.0),
            "across_lower": rn.Across(radius=-900.0, face=12.0),
        },
        {"upper": rn.Roller(radius=50.0, core=rn.Elastic(modulus=3.0, poisson=0.4))},
    ],
    ids=["approach", "motions", "shapes", "half-space"],
)
def test_every_kind_of_patch_survives_as_a_case(solved, change):
    patch = replace(solved.patch, **change)
    assert parse_patch_case(patch_case_tree(patch, 0.01)).patch == patch


def test_the_summary_says_figures_with_units_and_errors(solved):
    lines = list(patch_lines(solved))
    assert lines[0] == "Wheel"
    assert any("peak pressure" in line and "MPa" in line for line in lines)
    assert any("friction loss" in line and "W" in line for line in lines)


@pytest.mark.parametrize("style", ["light", "dark"])
def test_the_picture_has_four_panels(solved, style, faint_words):
    figure = plot_patch(solved, style=style)
    assert faint_words(figure) == []
    titles = [ax.get_title(loc="left") for ax in figure.axes]
    assert {"pressure", "stick, slip, and shear on the upper roller"} <= set(titles)
    assert "Wheel" in figure.get_suptitle()


@pytest.mark.slow
def test_the_command_prints_json_and_draws(tmp_path):
    path, picture = tmp_path / "case.toml", tmp_path / "patch.png"
    path.write_text(WHEEL)
    done = CliRunner().invoke(app, ["patch", "solve", str(path), "--json", "--plot", str(picture)])
    assert done.exit_code == 1  # one grid claims no error, and so nothing is verified
    tree = json.loads(done.stdout)
    assert tree["converged"] is False
    assert tree["status"].startswith("With a single grid no error can be estimated")
    assert picture.stat().st_size > 10_000


@pytest.mark.parametrize("ending", ["json", pytest.param("nc", marks=pytest.mark.slow)])
def test_files_hold_the_fields(solved, tmp_path, ending):
    path = tmp_path / f"patch.{ending}"
    write_patch(solved, path)
    if ending == "json":
        tree = json.loads(path.read_text())
        np.testing.assert_allclose(tree["fields"]["pressure"], solved.pressure)
        return
    xarray = pytest.importorskip("xarray")
    with xarray.open_dataset(path, engine="h5netcdf") as read:
        np.testing.assert_allclose(read["pressure"], solved.pressure)
        assert read["pressure"].dims == ("y", "x")
        assert read["shear_x"].attrs["units"] == "MPa"
        assert float(read["load"]) == pytest.approx(200.0)
        assert read["load"].attrs["units"] == "N"
        assert float(read["patch_length"]) == float(read["nip_width"]) == solved.length
        assert "error_load" in read
        assert "patch_error_load" in read
        assert read.attrs["status"] == solved.status
        assert (read.attrs["schema"], read.attrs["geometry"]) == (1, "linear")
        assert read.attrs["solver_rectangles"].tolist() == [16, 16]
        assert read.attrs["case_hash"] == patch_dict(solved)["case_hash"]
        assert json.loads(read.attrs["case"]) == patch_dict(solved)["case"]


def vtr(path):
    """The places and the values of a .vtr file by name."""
    import base64
    from xml.etree import ElementTree

    found = {}
    for one in ElementTree.parse(path).iter("DataArray"):
        raw = base64.b64decode(one.text)
        assert int.from_bytes(raw[:8], "little") == len(raw) - 8
        kind = "<i4" if one.attrib["type"] == "Int32" else "<f8"
        found[one.attrib["Name"]] = np.frombuffer(raw[8:], kind)
    return found


def test_paraview_files_hold_the_surface_and_the_stresses(solved, tmp_path):
    write_patch(solved, tmp_path / "surface.vtr")
    surface = vtr(tmp_path / "surface.vtr")
    np.testing.assert_array_equal(surface["pressure"].reshape(16, 16), solved.pressure)
    np.testing.assert_array_equal(surface["shear"].reshape(16, 16, 3)[..., 1], solved.shear_y)
    np.testing.assert_array_equal(surface["x"], solved.x)
    write_stress(solved, "upper", [3.0, 5.0], tmp_path / "stress.vtr")
    body = vtr(tmp_path / "stress.vtr")
    want = solved.stress("upper", [3.0, 5.0])
    np.testing.assert_array_equal(body["von_mises"].reshape(2, 16, 16), want.von_mises)
    np.testing.assert_array_equal(body["z"], [3.0, 5.0])


def test_stresses_of_a_lower_roller_stand_below(solved, tmp_path):
    """Turned over, the same wheel: z is negative, and shear on planes z turns its sign."""
    patch = solved.patch
    turned = replace(
        patch,
        upper=patch.lower,
        lower=patch.upper,
        across_upper=patch.across_lower,
        across_lower=patch.across_upper,
    )
    below = replace(solved, patch=turned)
    write_stress(below, "lower", [3.0, 5.0], tmp_path / "lower.vtr")
    body, want = vtr(tmp_path / "lower.vtr"), below.stress("lower", [3.0, 5.0])
    np.testing.assert_array_equal(body["z"], [-5.0, -3.0])
    np.testing.assert_array_equal(body["s_xz"].reshape(2, 16, 16), -want.s_xz[::-1])
    np.testing.assert_array_equal(body["s_xx"].reshape(2, 16, 16), want.s_xx[::-1])


def test_solve_takes_a_case_with_a_patch(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(PRESSED)
    done = CliRunner().invoke(app, ["solve", str(path), "--json"])
    assert done.exit_code == 1  # one grid
    part = json.loads(done.stdout)["patch"]
    assert set(part) >= {
        *("load", "approach", "length", "width", "area", "peak_pressure", "traction_x"),
        *("traction_y", "spin_moment", "creepage", "lateral_creepage", "spin"),
    }
    refused = CliRunner().invoke(app, ["solve", str(path), "--geometry", "second"])
    assert refused.exit_code == 2
    assert "`--geometry` must be linear for a case with [patch]" in refused.stderr


def test_stresses_and_ends_have_commands(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(PRESSED)
    done = CliRunner().invoke(app, ["patch", "stress", str(path), "--depth", "4 mm", "--json"])
    (row,) = json.loads(done.stdout)["depths"]
    assert row["z"] == 4.0
    assert 0.0 < row["bond_shear"] <= row["max_shear"] <= row["von_mises"]
    refused = CliRunner().invoke(app, ["patch", "ends", str(path)])
    assert "`--approach` must be given" in refused.stderr


def end_at(share, **given):
    """Return the parts of a `FaceEnd` that say what is in doubt, at a share of 8 mm of rubber."""
    rubber = rn.Elastic(modulus=5.0, poisson=0.5, **given)
    upper = rn.Roller(radius=50.0, layers=[rn.Layer(8.0, rubber)])
    return doubts(upper, rn.Roller(radius=50.0), 8.0 * share)


def test_the_end_of_a_face_says_where_its_covering_is_pressed_in_far():
    """With the limits and the sentences of `patch solve`."""
    assert end_at(0.14) == {"status": "", "warnings": ()}
    deep = end_at(0.3)
    assert deep["status"] == ""
    assert "strains count as small" in deep["warnings"][0]
    assert "8 mm thick, are pressed in by 83 % of that" in end_at(0.83)["status"]
    assert "strain energy (Gent)" in end_at(0.1, energy=rn.Gent(limit=30.0))["warnings"][0]


@pytest.mark.slow
@pytest.mark.parametrize("given", [[], ["--covering"]])
def test_an_end_that_is_pressed_in_too_far_is_not_converged(tmp_path, given):
    path = tmp_path / "case.toml"
    path.write_text(WHEEL.replace('end_radius = "2 mm"', ""))
    deep = ["patch", "ends", str(path), "--approach", "6.64 mm", *given]
    done = CliRunner().invoke(app, deep)
    assert done.exit_code == 1
    assert "note: The approach is more than 15 % of the coverings' thickness" in done.stdout
    assert "not converged: The coverings, 8 mm thick, are pressed in by 83 %" in done.stderr
    tree = json.loads(CliRunner().invoke(app, [*deep, "--json"]).stdout)
    assert tree["converged"] is False
    assert tree["status"].startswith("The coverings, 8 mm thick")
    assert len(tree["warnings"]) == 1


def test_stresses_are_printed_with_the_notes_of_their_patch(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(PRESSED.replace('load = "0.2 kN"', 'approach = "2 mm"'))
    given = ["patch", "stress", str(path), "--depth", "4 mm"]
    note = "The approach is more than 15 % of the coverings' thickness"
    assert f"  note: {note}" in CliRunner().invoke(app, given).stdout
    tree = json.loads(CliRunner().invoke(app, [*given, "--json"]).stdout)
    assert any(line.startswith(note) for line in tree["warnings"])


@pytest.mark.parametrize(
    ("given", "start"),
    [
        (("stress", "--depth", "-1 mm"), "`--depth` must be positive, got -1 mm."),
        (("stress", "--depth", "9 mm"), "--depth: `z` must not exceed the bottom 8.0, got 9.0."),
        (("stress", "--roller", "lower"), "`--roller` must name a roller that deforms; the lower"),
        (("hardness", "--roller", "lower"), "`--roller` must name a roller that deforms"),
        (("ends", "--approach", "9 mm"), "--approach: `approach` must be smaller than"),
        (("solve", "--tolerance", "0"), "--tolerance: `tolerance` must be positive"),
    ],
)
def test_a_wrong_option_is_named(tmp_path, given, start):
    path = tmp_path / "case.toml"
    path.write_text(PRESSED)
    done = CliRunner().invoke(app, ["patch", given[0], str(path), *given[1:]])
    assert done.exit_code == 2
    assert done.stdout == ""
    assert done.stderr.startswith(f"rollnip: {start}")


def test_a_viscoelastic_covering_has_no_hardness_and_its_case_is_named(tmp_path):
    path = tmp_path / "case.toml"
    solid = 'model = "standard-linear-solid"\nstiffening = "1 MPa"\nrelaxation_time = "1 ms"'
    path.write_text(WHEEL.replace('model = "elastic"', solid))
    done = CliRunner().invoke(app, ["patch", "hardness", str(path)])
    assert done.exit_code == 2
    assert f"{path}: `layers` must be elastic" in done.stderr


@pytest.mark.slow
def test_the_end_of_a_face_is_printed(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(WHEEL)
    done = CliRunner().invoke(app, ["patch", "ends", str(path), "--approach", "0.3 mm", "--json"])
    tree = json.loads(done.stdout)
    assert tree["load"][-1] == pytest.approx(1.0, abs=0.01)
    assert tree["added_length"] < 0.0  # rubber gives way sideways
    free = ["patch", "ends", str(path), "--approach", "0.3 mm", "--covering", "--json"]
    assert "`end_radius` must be left out" in CliRunner().invoke(app, free).stderr
    path.write_text(WHEEL.replace('end_radius = "2 mm"', ""))
    assert json.loads(CliRunner().invoke(app, free).stdout)["added_length"] < tree["added_length"]
    path.write_text(WHEEL)
    shown = CliRunner().invoke(app, ["patch", "ends", str(path), "--approach", "0.3 mm"]).stdout
    assert "Length that the end adds to the load" in shown


def test_a_strain_energy_is_said_to_be_left_out():
    material = rn.Elastic(modulus=5.0, poisson=0.5, energy=rn.Gent(limit=30.0))
    patch = parse_patch_case(PRESSED).patch
    stiff = rn.Roller(radius=50.0, layers=[rn.Layer(8.0, material)])
    solved = rn.solve_patch(replace(patch, upper=stiff), grid=(8, 8))
    assert any("has a strain energy (Gent)" in line for line in solved.warnings)


def test_sweeps_have_the_figures_of_patches():
    tree = tomllib.loads(PRESSED)
    study = {
        "case": tree,
        "results": ["patch.peak_pressure", "patch.error.load"],
        "parameters": [{"path": "upper.lateral_radius", "values": ["100 mm", "400 mm"]}],
    }
    table = rn.sweep(study, workers=1)
    peaks = table["patch.peak_pressure"]
    assert peaks[0] > peaks[1] > 0.0
    case = parse_patch_case(tree | {"title": "another"})
    assert patch_hash(case) == patch_hash(parse_patch_case(tree))
    assert patch_hash(case) != patch_hash(replace(case, tolerance=0.01))
    wrong = study | {"results": ["load"]}
    with pytest.raises(CaseFileError, match=r'there is no "load"; known: patch\.load, '):
        rn.sweep(wrong, workers=1)


def test_other_endings_are_refused(solved, tmp_path):
    with pytest.raises(rn.RollnipError, match="json"):
        write_patch(solved, tmp_path / "patch.txt")


def test_the_command_refuses_wrong_input(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(WHEEL.replace("friction = 0.6", "friction = -1"))
    done = CliRunner().invoke(app, ["patch", "solve", str(path)])
    assert done.exit_code == 2
    assert "nip.friction: must be zero or positive" in done.stderr


@pytest.mark.slow
def test_hardness_of_a_covering(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(WHEEL)
    done = CliRunner().invoke(app, ["patch", "hardness", str(path)])
    assert done.exit_code == 0
    *readings, thickness, note = done.stdout.splitlines()
    covering, block = (float(line.split(": ")[1]) for line in readings)
    assert block < covering < block + 3.0
    assert thickness.endswith(" mm on.")
    assert "Gent's formula" in note
    by_gent = shore_a_of_modulus(5.0)
    assert f"has Shore A {by_gent:.1f} for this layer" in note
    assert block < by_gent < block + 6.0  # its punch is wider than the tip
    assert CliRunner().invoke(app, ["patch", "hardness", str(path), "--roller", "x"]).exit_code == 2


def test_there_are_examples():
    assert {path.stem for path in EXAMPLES} >= {
        "polyurethane-wheel",
        "crowned-pull-roller",
        "durometer",
        "castor",
    }


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples_read_and_say_what_is_assumed(path):
    assert read_patch_case(path).patch.title
    assert "ssumed" in path.read_text("utf-8")


@pytest.mark.slow
@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples_solve(path):
    solution = rn.solve_patch(read_patch_case(path).patch, tolerance=0.01)
    assert solution.converged, solution.status
    assert not solution.warnings


@pytest.mark.parametrize("command", [("solve",), ("patch", "solve"), ("patch", "stress")])
def test_a_tolerance_of_zero_is_refused(tmp_path, command):
    case = tmp_path / "wheel.toml"
    case.write_text(PRESSED, "utf-8")
    found = CliRunner().invoke(app, [*command, str(case), "--tolerance", "0"])
    assert found.exit_code == 2
    assert "`tolerance` must be positive and finite, got 0.0." in found.stderr


def test_stresses_that_are_not_verified_say_why(tmp_path):
    """The table alone looks as right as any other."""
    path = tmp_path / "deep.toml"
    path.write_text(WHEEL.replace("0.2 kN", "20 kN"), "utf-8")
    done = CliRunner().invoke(app, ["patch", "stress", str(path), "--depth", "4 mm"])
    assert done.exit_code == 1
    assert "largest stresses in the upper roller" in done.stdout
    assert done.stderr.startswith(f"rollnip: {path}: not converged: The coverings, 8 mm thick, are")
